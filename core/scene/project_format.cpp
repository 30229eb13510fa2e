#include "core/scene/project_format.h"

#include <algorithm>
#include <array>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/rig/rig_validation.h"
#include "core/scene/json_section.h"
#include "core/scene/scene_format.h"

namespace lumorph {
namespace {

using nlohmann::json;

constexpr std::array kDriverKeys = {std::pair(Driver::target, "target"), std::pair(Driver::sceneItem, "sceneItem"),
                                    std::pair(Driver::hand, "hand")};

const char* driverKey(Driver driver) {
    const auto* found = std::ranges::find(kDriverKeys, driver, &std::pair<Driver, const char*>::first);
    if (found == kDriverKeys.end())
        throw InvalidInput("driver of the servos", "a project keeps only target, scene item and hand",
                           "give one of these");
    return found->second;
}

constexpr std::array kEasingKeys = {std::pair(Easing::linear, "linear"), std::pair(Easing::smooth, "smooth"),
                                    std::pair(Easing::minimumJerk, "minimumJerk")};

const char* easingKey(Easing easing) {
    return std::ranges::find(kEasingKeys, easing, &std::pair<Easing, const char*>::first)->second;
}

void readEasing(JsonSection& section, Easing& easing) {
    std::string key = easingKey(easing);
    section.text("easing", key);
    const auto* found = std::ranges::find_if(kEasingKeys, [&](const auto& one) { return key == one.second; });
    if (found == kEasingKeys.end())
        section.refuse("easing", "is " + inQuotes(key) + ", not a way to move",
                       R"(write "linear", "smooth" or "minimumJerk")");
    easing = found->first;
}

PoseStep readPoseStep(JsonSection section) {
    PoseStep step;
    section.text("pose", step.pose);
    section.number("travelSeconds", step.travelSeconds, 0.0, kMaxStepSeconds);
    section.number("holdSeconds", step.holdSeconds, 0.0, kMaxStepSeconds);
    readEasing(section, step.easing);
    return step;
}

PoseBook readPoses(JsonSection section) {
    PoseBook book;
    section.texts("actuators", book.actuators, kMaxActuators);
    section.sections("named", kMaxPoses, [&](JsonSection entry) {
        NamedPose& pose = book.sequence.poses.emplace_back();
        entry.text("name", pose.name);
        entry.numbers("strokes", pose.strokes, 0.0, 1.0, kMaxActuators);
    });
    section.sections("steps", kMaxPoseSteps,
                     [&](JsonSection entry) { book.sequence.steps.push_back(readPoseStep(std::move(entry))); });
    section.flag("loop", book.sequence.loop);
    try {
        requireSound(book);
    } catch (const InvalidInput& error) {
        section.refuse(error.subject(), error.why(), error.remedy());
    }
    return book;
}

json posesDocument(const PoseBook& book) {
    json named = json::array();
    for (const NamedPose& pose : book.sequence.poses) named.push_back({{"name", pose.name}, {"strokes", pose.strokes}});
    json steps = json::array();
    for (const PoseStep& step : book.sequence.steps)
        steps.push_back({{"pose", step.pose},
                         {"travelSeconds", step.travelSeconds},
                         {"holdSeconds", step.holdSeconds},
                         {"easing", easingKey(step.easing)}});
    return {{"actuators", book.actuators}, {"named", named}, {"steps", steps}, {"loop", book.sequence.loop}};
}

void readDriver(JsonSection& section, Driver& driver) {
    if (!section.has("driver")) return;
    std::string key;
    section.text("driver", key);
    for (const auto& [kept, name] : kDriverKeys)
        if (key == name) {
            driver = kept;
            return;
        }
    section.refuse("driver", "is '" + key + "', not who can move the servos",
                   "write \"target\", \"sceneItem\" or \"hand\"");
}

/// Drafts of the format had no version and called the rig a model.
void fromDraft(json& document, const std::string& /*file*/) {
    const auto model = document.find("model");
    if (model == document.end() || document.contains("rig")) return;
    json rig = std::move(*model);
    document.erase(model);
    document["rig"] = std::move(rig);
}

/// The first schema knew no scene: what it matched is drawn, and the servos go on following it.
void addScene(json& document, const std::string& /*file*/) {
    if (document.contains("scene")) return;
    Scene scene = defaultScene();
    const auto target = document.find("target");
    if (target != document.end() && target->is_string() && !target->get_ref<const std::string&>().empty()) {
        SceneItem item;
        item.id = scene.items.back().id + 1;
        item.name = "Target";
        item.role = ItemRole::physical;
        item.kind = TargetItem{};
        scene.items.push_back(std::move(item));
    }
    document["scene"] = documentOf(scene);
}

/// Moves what stands under `from` in one object to `to` in another.
void move(json& from, const char* key, json& to, const char* newKey) {
    if (!from.is_object()) return;
    const auto found = from.find(key);
    if (found == from.end()) return;
    json value = std::move(*found);
    from.erase(found);
    to[newKey] = std::move(value);
}

/// The second schema's scene held what stands in the room, too.
void separateInstallation(json& document, const std::string& /*file*/) {
    const auto scene = document.find("scene");
    if (scene == document.end() || !scene->is_object() || document.contains("installation")) return;
    json installation = json::object();
    for (const char* key : {"projectors", "eye", "worldFromDevice", "viewer", "compensation", "predictionSeconds"})
        move(*scene, key, installation, key);
    if (const auto table = scene->find("table"); table != scene->end()) {
        move(*table, "size", installation, "tableSize");
        move(*table, "surfaceColor", installation, "tableColor");
    }
    if (const auto device = scene->find("device"); device != scene->end())
        move(*device, "surfaceColor", installation, "deviceColor");
    document["installation"] = std::move(installation);
}

/// The third schema knew only whether servos follow something; whom, the scene said.
void nameDriver(json& document, const std::string& file) {
    if (!document.contains("matching")) document["matching"] = json::object();
    json& matching = document["matching"];
    if (!matching.is_object() || matching.contains("driver")) return;
    bool live = true;
    JsonSection(matching, "matching.", file).flag("live", live);
    matching.erase("live");
    Scene scene;
    if (document.contains("scene") && document["scene"].is_object()) {
        json copy = document["scene"];
        readScene(JsonSection(copy, "scene.", file), scene);
    }
    matching["driver"] = driverKey(live ? driverOf(scene) : Driver::hand);
}

using Migration = void (*)(json& document, const std::string& file);
/// The step at index i takes a document from schema i to i + 1.
constexpr std::array<Migration, kProjectSchema> kMigrations = {&fromDraft, &addScene, &separateInstallation,
                                                               &nameDriver};

Placement readPlacement(JsonSection section) {
    constexpr double kFar = 1e6; // metres, and radians: many turns
    Placement placement;
    section.number("scale", placement.scale, 1e-6, 1e6);
    double yaw = 0.0;
    section.number("yaw", yaw, -kFar, kFar);
    placement.yaw = Angle::radians(yaw);
    std::vector<double> translation(3, 0.0);
    section.numbers("translation", translation, -kFar, kFar, 3, true);
    for (int axis = 0; axis < 3; ++axis) placement.translation[axis] = static_cast<float>(translation[axis]);
    section.flag("relief", placement.relief);
    std::vector<double> turn{0.0, 0.0, 0.0, 1.0};
    section.numbers("orientation", turn, -1.0, 1.0, 4, true);
    const glm::dquat orientation(turn[3], turn[0], turn[1], turn[2]);
    const double length = glm::length(orientation);
    if (!(length > 0.5)) section.refuse("orientation", "is no rotation", "write a unit quaternion as x, y, z, w");
    placement.orientation = glm::quat(std::abs(length - 1.0) < 1e-5 ? orientation : orientation / length);
    return placement;
}

/// `values` over what `document` holds under `key`, object by object: what is not known there stays.
void merge(json& document, const char* key, const json& values) {
    json& section = document[key];
    if (!section.is_object()) section = json::object();
    section.update(values, true);
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
    for (; version < kProjectSchema; ++version) kMigrations.at(version)(document, file);
    document["schemaVersion"] = kProjectSchema;
    return document;
}

Project projectOf(json document, const std::string& file) {
    constexpr int kMaxAnimation = 100'000;
    Project project;
    JsonSection root(document, "", file);
    document.erase("schemaVersion");
    root.asset("rig", project.rig);
    if (project.rig.empty())
        root.refuse("rig", "is missing", "name the rig, for example \"resource:models/tablet.glb\"");
    root.asset("field", project.field);
    root.asset("target", project.target);
    root.wholeNumber("animation", project.animation, 0, kMaxAnimation);
    root.section("placement", [&](JsonSection section) { project.placement = readPlacement(std::move(section)); });
    root.numbers("strokes", project.strokes, 0.0, 1.0, kMaxActuators);
    root.section("matching", [&](JsonSection section) {
        readDriver(section, project.matching.driver);
        section.flag("refined", project.matching.refined);
        section.number("budgetMilliseconds", project.matching.budgetMilliseconds, 0.1, 10'000.0);
    });
    root.section("playback", [&](JsonSection section) {
        section.flag("playing", project.playback.playing);
        section.number("spin", project.playback.spin, -100.0, 100.0);
    });
    root.section("poses", [&](JsonSection section) { project.poses = readPoses(std::move(section)); });
    root.section("scene", [&](const JsonSection& section) { readScene(section, project.scene); });
    root.section("installation", [&](const JsonSection& section) { readInstallation(section, project.installation); });
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
    const glm::quat& q = project.placement.orientation;
    merge(document, "placement",
          {{"scale", project.placement.scale},
           {"yaw", project.placement.yaw.inRadians()},
           {"translation", {t.x, t.y, t.z}},
           {"orientation", {q.x, q.y, q.z, q.w}},
           {"relief", project.placement.relief}});
    merge(document, "matching",
          {{"driver", driverKey(project.matching.driver)},
           {"refined", project.matching.refined},
           {"budgetMilliseconds", project.matching.budgetMilliseconds}});
    merge(document, "playback", {{"playing", project.playback.playing}, {"spin", project.playback.spin}});
    if (document.contains("poses") || project.poses != PoseBook())
        merge(document, "poses", posesDocument(project.poses));
    merge(document, "scene", documentOf(project.scene));
    merge(document, "installation", documentOf(project.installation));
    document.erase("view");
    if (!project.view.is_null()) document["view"] = project.view;
    return document;
}

} // namespace lumorph
