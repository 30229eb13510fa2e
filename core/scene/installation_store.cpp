#include "core/scene/installation_store.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <span>
#include <system_error>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <nlohmann/json.hpp>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/json_check.h"
#include "core/scene/json_section.h"
#include "core/scene/scene_format.h"

namespace lumorph {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* kChooseAnother = "choose another file, or restore this one from a copy";
constexpr std::string_view kEarlier = "installation-";

constexpr std::string_view kVersion = "version-";
constexpr std::size_t kMostFigures = 200;
constexpr std::size_t kMostInputs = 100;
constexpr double kLargestFigure = 1e12;

void checkSchema(json& document, const std::string& name, std::string_view wanted = "installation") {
    std::string kind;
    JsonSection root(document, "", name);
    root.text("lumorph", kind);
    if (kind != wanted) throw DataError(name, "is not an " + std::string(wanted) + " of Lumorph", kChooseAnother);
    const auto version = document.find("schemaVersion");
    if (version == document.end() || !version->is_number_unsigned())
        throw DataError(name, "schemaVersion: is not a whole number from 0 up",
                        "write " + std::to_string(kInstallationSchema));
    if (version->get<std::uint64_t>() > kInstallationSchema)
        throw DataError(name,
                        "schemaVersion: was written by a newer Lumorph (schema " + version->dump() +
                            "; this one reads up to " + std::to_string(kInstallationSchema) + ")",
                        "open it with the newest Lumorph");
}

/// Whoever only walks the simulated eye around must not push ten calibrations out.
bool describesSameRoom(const fs::path& file, const Installation& installation) {
    try {
        return isSameRoom(InstallationStore::read(file), installation);
    } catch (const Error&) {
        return false;
    }
}

/// JSON as the text of a file. Throws InvalidInput where a name is not UTF-8.
std::string textOf(const json& document) {
    try {
        return document.dump(2) + "\n";
    } catch (const json::exception&) {
        throw InvalidInput("installation", "holds text that is not UTF-8", "rename its projectors and cameras");
    }
}

json parsed(std::string_view text, const std::string& name, std::string_view kind) {
    if (const std::string problem = jsonProblem(text); !problem.empty()) throw DataError(name, problem, kChooseAnother);
    json document = json::parse(text);
    if (!document.is_object())
        throw DataError(name, "is not an installation: its JSON is not an object", kChooseAnother);
    checkSchema(document, name, kind);
    return document;
}

/// A name in `folder` that sorts after all others of its kind: their date, and a number among those of one second.
fs::path datedFile(const fs::path& folder, std::string_view kind, std::string date,
                   const std::vector<fs::path>& others) {
    std::erase(date, ':');
    const std::string stem = std::string(kind) + date + "-";
    int number = 0;
    for (const fs::path& other : others) // the newest of this second comes first
        if (const std::string name = other.stem().string(); name.starts_with(stem)) {
            number = std::atoi(name.c_str() + stem.size()) + 1;
            break;
        }
    std::string digits = std::to_string(number);
    digits.insert(0, 6 - std::min<std::size_t>(digits.size(), 6), '0');
    return folder / (stem + digits + ".json");
}

std::vector<fs::path> datedFiles(const fs::path& folder, std::string_view kind) {
    std::vector<fs::path> files;
    std::error_code failed;
    for (fs::directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed))
        if (at->path().filename().string().starts_with(kind) && at->path().extension() == ".json")
            files.push_back(at->path());
    std::ranges::sort(files, std::greater{}); // dates sort as text
    return files;
}

template <typename Device>
void compareAll(const std::vector<Device>& before, const std::vector<Device>& after,
                std::vector<DeviceChange>& changes) {
    for (const Device& now : after) {
        const auto then = std::ranges::find(before, now.name, &Device::name);
        if (then == before.end()) continue;
        const CalibratedCamera& a = then->camera;
        const CalibratedCamera& b = now.camera;
        const glm::dmat3 turn = glm::dmat3(b.cameraFromWorld) * glm::transpose(glm::dmat3(a.cameraFromWorld));
        const glm::dvec3 axis(turn[1][2] - turn[2][1], turn[2][0] - turn[0][2], turn[0][1] - turn[1][0]);
        changes.push_back({now.name, glm::length(positionOf(b) - positionOf(a)),
                           std::atan2(glm::length(axis), turn[0][0] + turn[1][1] + turn[2][2] - 1.0),
                           b.focal.x / a.focal.x - 1.0, glm::length(b.principal - a.principal)});
    }
}

} // namespace

Installation parseInstallation(std::string_view text, const std::string& name) {
    json document = parsed(text, name, "installation");
    Installation installation = defaultInstallation();
    JsonSection(document, "", name).section("installation", [&](const JsonSection& section) {
        readInstallation(section, installation);
    });
    return installation;
}

std::string installationText(const Installation& installation) {
    checkInstallation(installation);
    return textOf({{"lumorph", "installation"},
                   {"schemaVersion", kInstallationSchema},
                   {"installation", documentOf(installation)}});
}

Installation InstallationStore::read(const fs::path& file) {
    const std::vector<std::byte> bytes = readFile(file, JsonLimits{}.bytes);
    return parseInstallation({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, file.string());
}

std::optional<Installation> InstallationStore::load() const {
    std::error_code failed;
    if (!fs::exists(file(), failed)) return std::nullopt;
    return read(file());
}

std::vector<fs::path> InstallationStore::earlier() const { return datedFiles(folder_, kEarlier); }

/// A copy, so that the file itself is there at every moment.
void InstallationStore::putAside() const {
    std::error_code failed;
    if (!fs::exists(file(), failed)) return;
    const fs::path aside = datedFile(folder_, kEarlier, utcDate(), earlier());
    fs::copy_file(file(), aside, failed);
    if (failed) throwWriteError(aside, failed.value());
    const std::vector<fs::path> files = earlier();
    for (std::size_t i = kKept; i < files.size(); ++i) fs::remove(files[i], failed);
}

void InstallationStore::keep(const Installation& installation) {
    const std::string text = installationText(installation);
    std::error_code failed;
    fs::create_directories(folder_, failed);
    if (failed) throwWriteError(folder_, failed.value());
    if (!describesSameRoom(file(), installation)) putAside();
    writeFileAtomically(file(), std::as_bytes(std::span(text)));
}

std::vector<fs::path> InstallationStore::versionFiles() const { return datedFiles(folder_ / "versions", kVersion); }

fs::path InstallationStore::keepVersion(const InstallationVersion& version) {
    checkInstallation(version.installation);
    // Its date becomes the name of a file.
    if (version.date.empty() || version.date.size() > 40 ||
        version.date.find_first_not_of("0123456789-:TZ") != std::string::npos)
        throw InvalidInput("version of the installation", "has no date", "give it the date of today in UTC");
    json figures = json::array();
    for (const VersionFigure& figure : version.figures)
        figures.push_back({{"name", figure.name}, {"value", figure.value}, {"unit", figure.unit}});
    if (figures.size() > kMostFigures || version.inputs.size() > kMostInputs)
        throw InvalidInput("version of the installation", "has too many figures or inputs", "leave some out");
    json document = {{"lumorph", "installation version"},
                     {"schemaVersion", kInstallationSchema},
                     {"date", version.date},
                     {"title", version.title},
                     {"figures", figures},
                     {"inputs", version.inputs},
                     {"result", version.result},
                     {"installation", documentOf(version.installation)}};
    if (version.isSimulated) document["simulated"] = true;
    const std::string text = textOf(document);
    const fs::path folder = folder_ / "versions";
    std::error_code failed;
    fs::create_directories(folder, failed);
    if (failed) throwWriteError(folder, failed.value());
    const fs::path place = datedFile(folder, kVersion, version.date, versionFiles());
    writeFileAtomically(place, std::as_bytes(std::span(text)));
    const std::vector<fs::path> files = versionFiles();
    for (std::size_t i = kKeptVersions; i < files.size(); ++i) fs::remove(files[i], failed);
    return place;
}

InstallationVersion InstallationStore::readVersion(const fs::path& file) {
    const std::vector<std::byte> bytes = readFile(file, JsonLimits{}.bytes);
    const std::string name = file.string();
    json document = parsed({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, name, "installation version");
    InstallationVersion version;
    JsonSection root(document, "", name);
    root.text("date", version.date);
    root.text("title", version.title);
    root.text("result", version.result);
    root.flag("simulated", version.isSimulated);
    root.sections("figures", kMostFigures, [&](JsonSection section) {
        VersionFigure& figure = version.figures.emplace_back();
        section.text("name", figure.name);
        section.text("unit", figure.unit);
        section.number("value", figure.value, -kLargestFigure, kLargestFigure);
    });
    if (const auto inputs = document.find("inputs"); inputs != document.end()) {
        if (!inputs->is_array() || inputs->size() > kMostInputs ||
            !std::ranges::all_of(*inputs, [](const json& input) { return input.is_string(); }))
            root.refuse("inputs", "is no list of texts", "remove it");
        version.inputs = inputs->get<std::vector<std::string>>();
    }
    version.installation = defaultInstallation();
    if (!root.has("installation")) root.refuse("installation", "is missing", kChooseAnother);
    root.section("installation", [&](const JsonSection& section) { readInstallation(section, version.installation); });
    return version;
}

std::vector<KeptVersion> InstallationStore::versions(std::vector<std::string>* broken) const {
    std::vector<KeptVersion> all;
    for (const fs::path& file : versionFiles()) try {
            all.push_back({file, readVersion(file)});
        } catch (const Error& error) {
            if (broken != nullptr) broken->emplace_back(error.what());
        }
    return all;
}

void InstallationStore::removeVersion(const fs::path& file) {
    std::error_code failed;
    fs::remove(file, failed);
    if (failed) throw DeviceError(file.string(), "cannot be removed (" + failed.message() + ")", "check its folder");
}

std::vector<FigureChange> compareFigures(const InstallationVersion& before, const InstallationVersion& after) {
    std::vector<FigureChange> changes;
    for (const VersionFigure& figure : after.figures)
        changes.push_back({figure.name, figure.unit, std::nullopt, figure.value});
    for (const VersionFigure& figure : before.figures) {
        const auto same = std::ranges::find_if(changes, [&](const FigureChange& change) {
            return change.name == figure.name && change.unit == figure.unit && !change.before;
        });
        if (same != changes.end())
            same->before = figure.value;
        else
            changes.push_back({figure.name, figure.unit, figure.value, std::nullopt});
    }
    return changes;
}

std::vector<DeviceChange> compareDevices(const Installation& before, const Installation& after) {
    std::vector<DeviceChange> changes;
    compareAll(before.projectors, after.projectors, changes);
    compareAll(before.cameras, after.cameras, changes);
    return changes;
}

} // namespace lumorph
