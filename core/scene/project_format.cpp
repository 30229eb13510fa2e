#include "core/scene/project_format.h"

#include <array>
#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/rig/rig_validation.h"

namespace lumorph {
namespace {

using nlohmann::json;

/// Drafts of the format had no version and called the rig a model.
void fromDraft(json& document) {
    const auto model = document.find("model");
    if (model == document.end() || document.contains("rig")) return;
    json rig = std::move(*model);
    document.erase(model);
    document["rig"] = std::move(rig);
}

using Migration = void (*)(json& document);
/// The step at index i takes a document from schema i to i + 1.
constexpr std::array<Migration, kProjectSchema> kMigrations = {&fromDraft};

std::string shortest(double value) { return json(value).dump(); }

/// One JSON object of a project and where it stands. What has been read is taken out, so that the rest is what this
/// version does not know.
class Section {
public:
    Section(json& object, std::string prefix, const std::string& file)
        : object_(object), prefix_(std::move(prefix)), file_(file) {}

    void text(const char* key, std::string& value) {
        if (const json* found = find(key)) {
            if (!found->is_string()) refuse(key, "is not a text", "put it in quotes, or remove it");
            value = found->get<std::string>();
            object_.erase(key);
        }
    }
    void flag(const char* key, bool& value) {
        if (const json* found = find(key)) {
            if (!found->is_boolean()) refuse(key, "is neither true nor false", "write true or false, or remove it");
            value = found->get<bool>();
            object_.erase(key);
        }
    }
    void number(const char* key, double& value, double min, double max) {
        if (const json* found = find(key)) {
            value = numberIn(*found, key, min, max);
            object_.erase(key);
        }
    }
    void wholeNumber(const char* key, int& value, int max) {
        if (const json* found = find(key)) {
            if (!found->is_number_integer() || !(found->get<double>() >= 0.0 && found->get<double>() <= max))
                refuse(key, "is not a whole number from 0 to " + std::to_string(max), "correct it, or remove it");
            value = found->get<int>();
            object_.erase(key);
        }
    }
    /// Numbers; `count` of them where it is given, at most `most` where not.
    void numbers(const char* key, std::vector<double>& values, double min, double max, std::size_t most,
                 bool exactly = false) {
        const json* found = find(key);
        if (!found) return;
        if (!found->is_array() || found->size() > most || (exactly && found->size() != most))
            refuse(key,
                   "is not a list of " + std::string(exactly ? "" : "at most ") + std::to_string(most) + " numbers",
                   "correct it, or remove it");
        values.clear();
        for (const json& value : *found)
            values.push_back(numberIn(value, std::string(key) + "[" + std::to_string(values.size()) + "]", min, max));
        object_.erase(key);
    }
    /// Reads what lies under `key`; of that object only what is not known stays.
    template <typename Read> void section(const char* key, Read read) {
        if (!find(key)) return;
        json& inner = object_[key];
        if (!inner.is_object()) refuse(key, "is not an object", "write it in { }, or remove it");
        read(Section(inner, prefix_ + key + ".", file_));
        if (inner.empty()) object_.erase(key);
    }

    [[noreturn]] void refuse(const std::string& key, const std::string& why, const std::string& remedy) const {
        throw DataError(file_, prefix_ + key + ": " + why, remedy);
    }

private:
    [[nodiscard]] const json* find(const char* key) const {
        const auto found = object_.find(key);
        return found == object_.end() ? nullptr : &*found;
    }
    [[nodiscard]] double numberIn(const json& value, const std::string& key, double min, double max) const {
        const double number = value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
        if (!(number >= min && number <= max))
            refuse(key, "is not a number from " + shortest(min) + " to " + shortest(max), "correct it, or remove it");
        return number;
    }

    json& object_;
    std::string prefix_;
    const std::string& file_;
};

void readAsset(Section& section, const char* key, std::string& asset) {
    section.text(key, asset);
    if (asset.empty() || isAssetName(asset)) return;
    section.refuse(key, "\"" + asset.substr(0, 80) + "\" leads out of the project's folder",
                   "put the file beside the project and name it relative to it");
}

Placement readPlacement(Section section) {
    constexpr double kFar = 1e6; // metres, and radians: many turns
    Placement placement;
    section.number("scale", placement.scale, 1e-6, 1e6);
    double yaw = 0.0;
    section.number("yaw", yaw, -kFar, kFar);
    placement.yaw = Angle::radians(yaw);
    std::vector<double> translation(3, 0.0);
    section.numbers("translation", translation, -kFar, kFar, 3, true);
    for (int axis = 0; axis < 3; ++axis) placement.translation[axis] = static_cast<float>(translation[axis]);
    return placement;
}

/// `values` over what `document` holds under `key`: what is not known there stays.
void merge(json& document, const char* key, const json& values) {
    json& section = document[key];
    if (!section.is_object()) section = json::object();
    section.update(values);
}

} // namespace

json migrated(json document, const std::string& file) {
    const auto stated = document.find("schemaVersion");
    std::uint64_t version = 0;
    if (stated != document.end()) {
        if (!stated->is_number_unsigned())
            throw DataError(file, "schemaVersion: is not a whole number from 0 up",
                            "write " + std::to_string(kProjectSchema) + ", or save the project again");
        version = stated->get<std::uint64_t>();
    }
    if (version > kProjectSchema)
        throw DataError(file,
                        "schemaVersion: was written by a newer Lumorph (schema " + std::to_string(version) +
                            "; this one reads up to " + std::to_string(kProjectSchema) + ")",
                        "open it with the newest Lumorph");
    for (; version < kProjectSchema; ++version) kMigrations.at(version)(document);
    document["schemaVersion"] = kProjectSchema;
    return document;
}

Project projectOf(json document, const std::string& file) {
    constexpr int kMaxAnimation = 100'000;
    Project project;
    Section root(document, "", file);
    document.erase("schemaVersion");
    readAsset(root, "rig", project.rig);
    if (project.rig.empty())
        root.refuse("rig", "is missing", "name the rig, for example \"resource:models/tablet.glb\"");
    readAsset(root, "field", project.field);
    readAsset(root, "target", project.target);
    root.wholeNumber("animation", project.animation, kMaxAnimation);
    root.section("placement", [&](Section section) { project.placement = readPlacement(section); });
    root.numbers("strokes", project.strokes, 0.0, 1.0, kMaxActuators);
    root.section("matching", [&](Section section) {
        section.flag("live", project.matching.live);
        section.flag("refined", project.matching.refined);
        section.number("budgetMilliseconds", project.matching.budgetMilliseconds, 0.1, 10'000.0);
    });
    root.section("playback", [&](Section section) {
        section.flag("playing", project.playback.playing);
        section.number("spin", project.playback.spin, -100.0, 100.0);
    });
    if (const auto view = document.find("view"); view != document.end()) {
        if (!view->is_object()) root.refuse("view", "is not an object", "write it in { }, or remove it");
        project.view = std::move(*view);
        document.erase(view);
    }
    project.unknown = std::move(document);
    return project;
}

json documentOf(const Project& project) {
    json document = project.unknown.is_object() ? project.unknown : json::object();
    document["schemaVersion"] = kProjectSchema;
    document["rig"] = project.rig;
    document["field"] = project.field;
    document["target"] = project.target;
    document["animation"] = project.animation;
    document["strokes"] = project.strokes;
    const glm::vec3& t = project.placement.translation;
    merge(document, "placement",
          {{"scale", project.placement.scale},
           {"yaw", project.placement.yaw.inRadians()},
           {"translation", {t.x, t.y, t.z}}});
    merge(document, "matching",
          {{"live", project.matching.live},
           {"refined", project.matching.refined},
           {"budgetMilliseconds", project.matching.budgetMilliseconds}});
    merge(document, "playback", {{"playing", project.playback.playing}, {"spin", project.playback.spin}});
    document.erase("view");
    if (!project.view.is_null()) document["view"] = project.view;
    return document;
}

} // namespace lumorph
