#include "core/scene/project.h"

#include <span>
#include <system_error>

#include "core/base/atomic_file.h"
#include "core/base/confined_path.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/json_check.h"
#include "core/base/plain_text.h"
#include "core/base/text.h"
#include "core/scene/project_format.h"
#include "core/scene/scene_assets.h"

namespace lumorph {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* kReplace = "choose another file, or restore this one from a copy";

/// What a project names may have become a link since.
void refuseLinksOutside(const Project& project, const fs::path& file) {
    const auto refuse = [&file](const char* key, const std::string& asset) {
        if (asset.empty() || asset.starts_with("resource:") || confinedPath(projectFolder(file), asset)) return;
        throw DataError(file.string(),
                        std::string(key) + ": " + inQuotes(asset) + " leads out of the project's folder through a link",
                        "put the file itself beside the project");
    };
    refuse("rig", project.rig);
    refuse("field", project.field);
    refuse("target", project.target);
    for (const std::string& asset : assetNames(project.scene)) refuse("scene", asset);
}

} // namespace

Project parseProject(std::string_view text, const std::string& name) {
    if (const std::string problem = jsonProblem(text); !problem.empty()) throw DataError(name, problem, kReplace);
    json document = json::parse(text);
    if (!document.is_object()) throw DataError(name, "is not a project: its JSON is not an object", kReplace);
    return projectOf(migrated(std::move(document), name), name);
}

std::string projectText(const Project& project) {
    try {
        // Whatever could not be read back must not be written.
        json document = documentOf(project);
        std::string text = document.dump(2) + "\n";
        if (const std::string problem = jsonProblem(text); !problem.empty())
            throw DataError("project", problem, "keep less in it");
        (void)projectOf(std::move(document), "project");
        return text;
    } catch (const DataError& error) {
        throw InvalidInput(error.subject(), error.why(), error.remedy());
    } catch (const json::exception&) {
        throw InvalidInput("project", "holds text that is not UTF-8", "rename the file that it names");
    }
}

Project readProject(const fs::path& file) {
    std::error_code failed;
    // Reading a pipe or a device might never end.
    if (fs::exists(file, failed) && fs::is_other(file, failed))
        throw DataError(file.string(), "is not a file", "choose a .lumorph file");
    const std::vector<std::byte> bytes = readFile(file, JsonLimits{}.bytes);
    const PlainText text(bytes);
    Project project = parseProject(text.view(), file.string());
    refuseLinksOutside(project, file);
    return project;
}

void writeProject(const Project& project, const fs::path& file) {
    const std::string text = projectText(project);
    try {
        refuseLinksOutside(project, file);
    } catch (const DataError& error) {
        throw InvalidInput(error.subject(), error.why(), error.remedy());
    }
    writeFileAtomically(file, std::as_bytes(std::span(text)));
}

} // namespace lumorph
