#include "core/scene/installation_store.h"

#include <algorithm>
#include <cstdlib>
#include <span>
#include <system_error>

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

void checkSchema(json& document, const std::string& name) {
    std::string kind;
    JsonSection root(document, "", name);
    root.text("lumorph", kind);
    if (kind != "installation") throw DataError(name, "is not an installation of Lumorph", kChooseAnother);
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

} // namespace

Installation parseInstallation(std::string_view text, const std::string& name) {
    if (const std::string problem = jsonProblem(text); !problem.empty()) throw DataError(name, problem, kChooseAnother);
    json document = json::parse(text);
    if (!document.is_object())
        throw DataError(name, "is not an installation: its JSON is not an object", kChooseAnother);
    checkSchema(document, name);
    Installation installation = defaultInstallation();
    JsonSection(document, "", name).section("installation", [&](const JsonSection& section) {
        readInstallation(section, installation);
    });
    return installation;
}

std::string installationText(const Installation& installation) {
    checkInstallation(installation);
    const json document = {{"lumorph", "installation"},
                           {"schemaVersion", kInstallationSchema},
                           {"installation", documentOf(installation)}};
    try {
        return document.dump(2) + "\n";
    } catch (const json::exception&) {
        throw InvalidInput("installation", "holds text that is not UTF-8", "rename its projectors and cameras");
    }
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

std::vector<fs::path> InstallationStore::earlier() const {
    std::vector<fs::path> files;
    std::error_code failed;
    for (fs::directory_iterator at(folder_, failed), end; !failed && at != end; at.increment(failed))
        if (at->path().filename().string().starts_with(kEarlier) && at->path().extension() == ".json")
            files.push_back(at->path());
    std::ranges::sort(files, std::greater{}); // dates sort as text
    return files;
}

/// A copy, so that the file itself is there at every moment.
void InstallationStore::putAside() const {
    std::error_code failed;
    if (!fs::exists(file(), failed)) return;
    std::string date = utcDate();
    std::erase(date, ':');
    // Several within a second are numbered on from the newest, so that their names sort as they came.
    const std::string stem = std::string(kEarlier) + date + "-";
    int number = 0;
    if (const auto before = earlier(); !before.empty())
        if (const std::string newest = before.front().stem().string(); newest.starts_with(stem))
            number = std::atoi(newest.c_str() + stem.size()) + 1;
    std::string digits = std::to_string(number);
    digits.insert(0, 6 - std::min<std::size_t>(digits.size(), 6), '0');
    const fs::path aside = folder_ / (stem + digits + ".json");
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

} // namespace lumorph
