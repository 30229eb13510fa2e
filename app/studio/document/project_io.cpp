#include "app/studio/document/project_io.h"

#include <cmath>
#include <functional>
#include <map>

#include "app/studio/document/scene_files.h"
#include "app/studio/document/state_rules.h"
#include "core/base/error.h"
#include "core/geometry/model.h"
#include "core/mdf/field_file.h"
#include "core/rig/rig_file.h"
#include "core/scene/project.h"

namespace lumorph::studio {

namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::byte>;

// In the project's view: the field was built before the rig was edited, and is kept until it is built anew.
constexpr const char* kEarlierRig = "fieldOfEarlierRig";

bool isFieldOfEarlierRig(const ProjectExtras& extras) {
    return extras.view.is_object() && extras.view.contains(kEarlierRig) && extras.view[kEarlierRig] == true;
}

void loadField(const fs::path& file, const std::string& asset, LoadedProject& loaded) {
    try {
        auto field = readFieldAsset(assetPath(file, asset));
        const bool earlier = isFieldOfEarlierRig(loaded.extras);
        if (earlier || isFieldOf(*field.asset.field, *loaded.state.rig.rig)) {
            const Rig& built = earlier ? field.asset.field->rig : *loaded.state.rig.rig;
            const std::shared_ptr<const void> owner =
                earlier ? std::shared_ptr<const void>(field.asset.field) : loaded.state.rig.rig;
            field.asset.builtFor = {owner, &built.parts()};
            loaded.state.field = std::move(field.asset);
            loaded.stamps.field = field.stamp;
        } else {
            loaded.warnings.emplace_back("Its field was built for another rig and is built again.");
        }
    } catch (const DataError& error) {
        loaded.warnings.push_back("Its field is built again: " + error.why() + ".");
    }
}

StudioState stateOf(const Project& project) {
    StudioState state;
    state.placement = project.placement;
    state.strokes = project.strokes;
    state.matching.driver = project.matching.driver;
    state.matching.method = project.matching.refined ? MatchMethod::refined : MatchMethod::voting;
    state.matching.budget = Microseconds(std::llround(1000.0 * project.matching.budgetMilliseconds));
    state.playback = {project.playback.playing, project.playback.spin};
    state.poses = std::make_shared<const PoseBook>(project.poses);
    return state;
}

Project projectOf(const ProjectSource& source) {
    const StudioState& state = source.state;
    Project project;
    if (state.target.target) project.animation = std::max(0, state.target.target->animation);
    project.placement = state.placement;
    project.strokes = state.strokes;
    project.matching = {state.matching.driver, state.matching.method == MatchMethod::refined,
                        static_cast<double>(state.matching.budget.count()) / 1000.0};
    project.playback = {state.playback.playing, state.playback.spin};
    if (state.poses) project.poses = *state.poses;
    if (state.installation) project.installation = *state.installation;
    project.view = source.extras.view;
    if (project.view.is_object()) project.view.erase(kEarlierRig);
    if (state.field.stale) project.view[kEarlierRig] = true;
    project.unknown = source.extras.unknown;
    return project;
}

/// A name that is safe in any folder.
std::string fileStem(const fs::path& path, const std::string& name) {
    std::string stem = path.empty() ? name : path.stem().string();
    std::erase_if(stem, [](unsigned char c) { return c < ' ' || c == '/' || c == '\\' || c == ':'; });
    return stem.empty() || stem.front() == '.' ? "asset" : stem;
}

/// Takes the file where it is still what was read; else what is in memory.
std::string take(const fs::path& project, const fs::path& path, const std::optional<FileStamp>& stamp,
                 const std::string& name, const std::function<Bytes()>& bytes, const Progress& progress) {
    if (!path.empty() && stamp && stamp->there && stampOf(path) == *stamp) return takeAsset(project, path, progress);
    return takeAsset(project, name, bytes(), progress);
}

Bytes targetBytes(const MatchTarget& target) {
    return writeGlb(target.model ? *target.model : modelOf(target.solid.mesh, target.name));
}

/// The rig as its parts say; while they cannot be compiled, the last one that could.
Rig rigToSave(const StudioState::RigAsset& rig) {
    if (rig.compiled || !rig.parts) return *rig.rig;
    try {
        return Rig(*rig.parts);
    } catch (const InvalidInput&) {
        return *rig.rig;
    }
}

/// A rig or field that was saved with this project before and that nothing names any more.
void dropOld(const fs::path& file, const std::string& before, const std::string& now) {
    const std::string own = file.stem().string() + " files/";
    if (before.empty() || before == now || !before.starts_with(own)) return;
    std::error_code ignored;
    fs::remove(file.parent_path() / before, ignored);
}

Project savedBefore(const fs::path& file) {
    try {
        return readProject(file);
    } catch (const Error&) {
        return {};
    }
}

} // namespace

LoadedProject loadProjectWithoutAssets(const fs::path& file, const Progress& progress) {
    const Project project = readProject(file);
    LoadedProject loaded;
    loaded.state = stateOf(project);
    loaded.extras = {project.view, project.unknown};
    progress.report(0.1, "reading the rig");
    auto rig = readRigAsset(assetPath(file, project.rig));
    loaded.state.rig = std::move(rig.asset);
    loaded.stamps.rig = rig.stamp;
    progress.throwIfCancelled();
    progress.report(0.3, "reading the field");
    if (!project.field.empty()) loadField(file, project.field, loaded);
    progress.throwIfCancelled();
    progress.report(0.6, "reading the target");
    if (!project.target.empty()) {
        // 0 is also what a target without animations says.
        const std::optional<int> animation = project.animation > 0 ? std::optional(project.animation) : std::nullopt;
        auto target = readTargetAsset(assetPath(file, project.target), animation, progress.part(0.6, 1.0));
        loaded.state.target = std::move(target.asset);
        loaded.stamps.target = target.stamp;
    }
    loaded.state.scene = std::make_shared<const Scene>(withWholePaths(project.scene, file));
    loaded.installation = std::make_shared<const Installation>(project.installation);
    return loaded;
}

void loadAssets(LoadedProject& loaded, const fs::path& file, const Progress& progress) {
    loaded.state.assets = loadSceneAssets(*loaded.state.scene, file, nullptr, progress);
}

LoadedProject loadedProject(const ProjectContents& demo) {
    LoadedProject loaded;
    loaded.state = stateOf(demo.project);
    loaded.extras = {demo.project.view, demo.project.unknown};
    const auto add = [](const std::string& asset, auto& path, std::optional<FileStamp>& stamp) {
        path = assetPath({}, asset);
        stamp = stampOf(path);
    };
    loaded.state.rig.rig = demo.rig;
    add(demo.project.rig, loaded.state.rig.path, loaded.stamps.rig);
    if (demo.target) {
        loaded.state.target.target = demo.target;
        add(demo.project.target, loaded.state.target.path, loaded.stamps.target);
    }
    loaded.state.scene = std::make_shared<const Scene>(demo.project.scene);
    loaded.state.assets = demo.assets;
    return loaded;
}

LoadedProject loadProject(const fs::path& file, const Progress& progress) {
    LoadedProject loaded = loadProjectWithoutAssets(file, progress.part(0.0, 0.8));
    loadAssets(loaded, file, progress.part(0.8, 1.0));
    return loaded;
}

TakenAssets saveProject(const ProjectSource& source, const fs::path& file, const Progress& progress,
                        const TakenAssets& there) {
    const StudioState& state = source.state;
    if (!state.rig.rig) throw InvalidInput(file.string(), "there is no rig to save", "open a rig first");
    Project project = projectOf(source);
    const std::string rigName = fileStem(state.rig.path, state.rig.rig->name());
    const auto taken = [&](const std::string& already, const fs::path& path, const std::optional<FileStamp>& stamp,
                           const std::string& name, const std::function<Bytes()>& bytes) {
        return already.empty() ? take(file, path, stamp, name, bytes, progress) : already;
    };
    project.rig = taken(there.rig, state.rig.path, source.stamps.rig, rigName + ".glb",
                        [&] { return writeRigGlb(rigToSave(state.rig)); });
    if (state.field.field)
        project.field =
            taken(there.field, state.field.path, source.stamps.field, fileStem(state.field.path, rigName) + ".mdf",
                  [&] { return writeField(state.field.field->field); });
    if (const auto& target = state.target.target)
        project.target =
            taken(there.target, state.target.path, source.stamps.target,
                  fileStem(state.target.path, target->name) + ".glb", [&] { return targetBytes(*target); });
    std::map<std::string, std::string> names = there.scene;
    if (state.scene) project.scene = withTakenFiles(*state.scene, state.assets.get(), file, names, progress);
    const Project old = savedBefore(file);
    writeProject(project, file);
    dropOld(file, old.field, project.field);
    // The one that was opened is what undo leads back to.
    if (file.parent_path() / old.rig != state.rig.path) dropOld(file, old.rig, project.rig);
    return {project.rig, project.field, project.target, std::move(names)};
}

} // namespace lumorph::studio
