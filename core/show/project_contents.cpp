#include "core/show/project_contents.h"

#include <cmath>
#include <optional>
#include <utility>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/geometry/mesh_file.h"
#include "core/mdf/field_file.h"
#include "core/rig/rig_file.h"

namespace lumorph {
namespace {

namespace fs = std::filesystem;

void readField(const fs::path& file, ProjectContents& contents) {
    try {
        const fs::path path = assetPath(file, contents.project.field);
        auto field = std::make_shared<const MatchField>(parseField(readFile(path, kMaxFileBytes), path.string()));
        if (isFieldOf(*field, *contents.rig))
            contents.field = std::move(field);
        else
            contents.warnings.emplace_back("Its field was built for another rig and is left out.");
    } catch (const DataError& error) {
        contents.warnings.push_back("Its field is left out: " + error.why() + ".");
    }
}

} // namespace

ProjectContents readContents(Project project, const fs::path& file, const Progress& progress) {
    ProjectContents contents;
    contents.project = std::move(project);
    progress.report(0.0, "reading the rig");
    contents.rig = std::make_shared<const Rig>(readRig(assetPath(file, contents.project.rig)));
    progress.throwIfCancelled();
    progress.report(0.2, "reading the field");
    if (!contents.project.field.empty()) readField(file, contents);
    progress.throwIfCancelled();
    progress.report(0.4, "reading the target");
    if (!contents.project.target.empty()) {
        // 0 is also what a target without animations says.
        const int animation = contents.project.animation;
        contents.target =
            readMatchTarget(assetPath(file, contents.project.target),
                            animation > 0 ? std::optional(animation) : std::nullopt, progress.part(0.4, 0.7));
    }
    contents.assets = loadSceneAssets(contents.project.scene, file, nullptr, progress.part(0.7, 1.0));
    for (const auto& [asset, problem] : contents.assets->problems) contents.warnings.push_back(problem);
    return contents;
}

ProjectContents readContents(const fs::path& file, const Progress& progress) {
    return readContents(readProject(file), file, progress);
}

MatchWish wishOf(const ProjectContents& contents) {
    const Project& project = contents.project;
    MatchWish wish;
    wish.rig = contents.rig;
    wish.field = contents.field;
    wish.target = contents.target;
    wish.placement = project.placement;
    wish.method = project.matching.refined ? MatchMethod::refined : MatchMethod::voting;
    wish.budget = Microseconds(std::llround(1000.0 * project.matching.budgetMilliseconds));
    wish.strokes = project.strokes;
    wish.strokes.resize(contents.rig->actuatorCount(), 0.0);
    wish.playing = project.playback.playing;
    wish.spin = project.playback.spin;
    wish.scene = std::make_shared<const Scene>(project.scene);
    wish.installation = std::make_shared<const Installation>(project.installation);
    wish.assets = contents.assets;
    wish.driver = project.matching.driver;
    return wish;
}

} // namespace lumorph
