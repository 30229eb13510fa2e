#include "app/cli/project_frame.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/resources.h"
#include "core/geometry/mesh_file.h"
#include "core/loop/match_loop.h"
#include "core/loop/show_stage.h"
#include "core/mdf/field_file.h"
#include "core/rig/rig_file.h"
#include "core/scene/project.h"

namespace lumorph::cli {

namespace {

constexpr std::string_view kResource = "resource:";
constexpr double kStepsPerSecond = 60.0;
constexpr int kDefaultLevels = 33;

MatchWish wishOf(const Project& project, const std::filesystem::path& file, const Session& session) {
    MatchWish wish;
    if (project.field.empty()) {
        wish.rig = std::make_shared<Rig>(readRig(assetPath(file, project.rig)));
    } else {
        const std::filesystem::path path = assetPath(file, project.field);
        const auto field = std::make_shared<MatchField>(parseField(readFile(path, kMaxFileBytes), path.string()));
        wish.field = field;
        wish.rig = std::shared_ptr<const Rig>(field, &field->rig);
    }
    session.throwIfCancelled();
    if (!project.target.empty())
        wish.target = readMatchTarget(assetPath(file, project.target), project.animation, session.progress());
    wish.placement = project.placement;
    wish.method = project.matching.refined ? MatchMethod::refined : MatchMethod::voting;
    wish.budget = Microseconds(static_cast<std::int64_t>(1000.0 * project.matching.budgetMilliseconds));
    wish.strokes = project.strokes;
    if (wish.strokes.empty()) wish.strokes.assign(wish.rig->actuatorCount(), 0.0);
    wish.playing = project.playback.playing;
    wish.spin = project.playback.spin;
    wish.showTint = false;
    return wish;
}

/// The loop by a clock that stands still while it works: what it finds does not depend on this machine's speed.
std::shared_ptr<const MatchFrame> follow(const MatchWish& wish, double seconds, const Session& session) {
    ManualClock clock;
    MatchLoop loop(clock);
    const Progress progress = session.progress();
    auto frame = loop.step(wish, 0.0);
    const auto steps = static_cast<int>(std::ceil(seconds * kStepsPerSecond));
    for (int i = 0; i < steps; ++i) {
        progress.throwIfCancelled();
        const double step = seconds / steps;
        clock.advance(Microseconds(static_cast<std::int64_t>(1e6 * step)));
        frame = loop.step(wish, step);
        progress.report(static_cast<double>(i) / steps, "following the show");
    }
    Session::endProgress();
    return frame;
}

/// The device held in a state at a moment of the show.
std::shared_ptr<const MatchFrame> hold(MatchWish wish, const State& state, double seconds) {
    const int levels = wish.field ? wish.field->field.levels : kDefaultLevels;
    const std::vector<double> strokes = strokesOf(*wish.rig, state, levels);
    wish.driver = Driver::hand;
    wish.strokes = strokes;
    wish.sceneSeek = seconds;
    wish.seek = seconds;
    const ManualClock clock;
    auto frame = std::make_shared<MatchFrame>(*MatchLoop(clock).step(wish, 0.0));
    frame->estimatedStrokes = strokes;
    frame->devicePositions = std::make_shared<std::vector<glm::vec3>>(deformed(*wish.rig, strokes).positions);
    return frame;
}

} // namespace

std::filesystem::path projectFile(const std::string& name) {
    if (!name.starts_with(kResource)) return name;
    if (!isAssetName(name))
        throw DataError(name, "it leaves the resources' folder",
                        "name a bundled project such as projects/water.lumorph");
    return resourceFile(std::string_view(name).substr(kResource.size()));
}

ProjectFrame readProjectFrame(const std::filesystem::path& file, const ProjectMoment& moment, const Session& session) {
    Project project = readProject(file);
    if (moment.eye) project.installation.eye = *moment.eye;
    MatchWish wish = wishOf(project, file, session);
    const auto scene = std::make_shared<const Scene>(std::move(project.scene));
    wish.scene = scene;
    wish.installation = std::make_shared<const Installation>(project.installation);
    wish.driver = driverOf(project.matching.live, scene.get());
    wish.assets = loadSceneAssets(*scene, file, nullptr, session.progress());
    Session::endProgress();

    const auto match = moment.state ? hold(wish, *moment.state, moment.seconds) : follow(wish, moment.seconds, session);
    ProjectFrame result{ShowStage().frame(*match), match->estimatedStrokes, {}};
    for (const auto& [asset, problem] : wish.assets->problems) result.warnings.push_back(problem);
    if (wish.target && project.matching.live && !wish.field && !moment.state)
        result.warnings.emplace_back("The project has no field, so the device does not follow its target.");
    return result;
}

} // namespace lumorph::cli
