#include <algorithm>
#include <cmath>
#include <memory>

#include "core/base/error.h"
#include "core/base/resources.h"
#include "core/base/statistics.h"
#include "core/loop/match_loop.h"
#include "core/rig/rig_file.h"
#include "tests/bench/bench_groups.h"
#include "tests/bench/bench_inputs.h"
#include "tests/bench/bench_timing.h"
#include "tests/support/animated_target.h"

namespace lumorph::bench {

namespace {

std::shared_ptr<const MatchTarget> movingTarget() {
    constexpr int kSamples = 60;
    auto model = std::make_shared<const Model>(test::animatedEllipsoid());
    const Model::Animation& animation = model->animations.front();
    MatchTarget target;
    target.name = "moving ellipsoid";
    target.solid = makeTarget(flatten(*model, animation, 0.0));
    target.duration = animation.duration();
    target.box = boxOverAnimation(*model, animation, kSamples, kSamples / target.duration);
    target.model = std::move(model);
    target.animation = 0;
    return std::make_shared<const MatchTarget>(std::move(target));
}

MatchWish liveWish() {
    const auto device = makeDevice("tablet.glb", 33);
    MatchWish wish;
    wish.field = std::make_shared<const MatchField>(device->field);
    wish.rig = std::make_shared<const Rig>(wish.field->rig);
    wish.target = movingTarget();
    wish.placement = fitPlacement(wish.field->field, wish.target->box);
    return wish;
}

/// Medians of the stages over all frames, and the share of frames whose refinement ran to its end in time.
std::string noteOf(const std::vector<MatchTimes>& frames) {
    struct Stage {
        const char* name;
        double MatchTimes::*of;
    };
    constexpr Stage kStages[] = {
        {"track", &MatchTimes::track},   {"pose", &MatchTimes::pose},     {"voxelise", &MatchTimes::voxelize},
        {"match", &MatchTimes::match},   {"refine", &MatchTimes::refine}, {"rule", &MatchTimes::rule},
        {"motion", &MatchTimes::motion}, {"deform", &MatchTimes::deform}, {"in all", &MatchTimes::total}};
    std::string note = "medians of " + std::to_string(frames.size()) + " frames, ms:";
    double longest = 0.0;
    for (const Stage& stage : kStages) {
        std::vector<double> values;
        for (const MatchTimes& frame : frames) values.push_back(frame.*stage.of);
        note += std::string(" ") + stage.name + " " + fixed(median(values), 3);
        longest = *std::max_element(values.begin(), values.end());
    }
    return note + "; longest " + fixed(longest, 1);
}

constexpr int kFramesMatched = 240;

/// Water whose slow part the servos carry, and edges that bend for whoever is tracked.
MatchWish sceneWish() {
    Scene scene = defaultScene();
    scene.items.clear();
    SceneItem water;
    water.id = 1;
    water.role = ItemRole::split;
    water.position.y = 0.02F;
    HeightItem surface;
    surface.waves = {{0.01, 0.3, 6.0, Angle{}, Angle{}},
                     {0.004, 0.08, 1.5, Angle::degrees(40.0), Angle{}},
                     {0.002, 0.03, 0.5, Angle::degrees(-70.0), Angle{}}};
    water.kind = surface;
    scene.items.push_back(water);
    scene.viewDependence.on = true;
    MatchWish wish;
    wish.rig = std::make_shared<const Rig>(readRig(resourceFile("models/tablet.glb")));
    wish.driver = driverOf(scene);
    wish.scene = std::make_shared<const Scene>(std::move(scene));
    wish.installation = std::make_shared<const Installation>(defaultInstallation());
    wish.assets = std::make_shared<const SceneAssets>();
    return wish;
}

void benchScene(Report& report) {
    MatchWish wish = sceneWish();
    const auto board = std::make_shared<PoseBoard>();
    const auto head = board->stream("viewer", PoseRole::head);
    wish.poses = board;
    const SteadyClock clock;
    MatchLoop loop(clock);
    std::vector<MatchTimes> times;
    for (int k = 0; k <= kFramesMatched; ++k) {
        const double angle = 0.01 * k;
        (void)head->push({clock.now(), true, {{0.5 * std::sin(angle), 0.4, 0.5 * std::cos(angle)}, {1, 0, 0, 0}}});
        const MatchTimes ms = loop.step(wish, 1.0 / 60.0)->ms;
        if (k > 0) times.push_back(ms); // the first one samples the device's surface
    }
    std::vector<double> totals;
    for (const MatchTimes& frame : times) totals.push_back(frame.total);
    report.add({"loop-scene",
                "live loop without drawing: tracked head, view dependence, water split between servos and light",
                median(totals),
                "ms",
                atMost(3.0),
                atMost(1.0),
                {noteOf(times)}});
}

} // namespace

void benchLive(const Filter& filter, Report& report) {
    if (filter.wants("loop-scene")) benchScene(report);
    if (!filter.wants("loop-live")) return;
    const MatchWish wish = liveWish();
    const SteadyClock clock;
    MatchLoop loop(clock);
    std::vector<MatchTimes> times;
    double iou = 0.0;
    const double seconds = secondsOf([&] {
        for (int k = 0; k < kFramesMatched; ++k) {
            const auto frame = loop.step(wish, 1.0 / 60.0);
            times.push_back(frame->ms);
            iou += frame->iouWanted / kFramesMatched;
        }
    });
    report.add({"loop-live",
                "live loop without drawing: animated target of 70,000 triangles, refined for at most 8 ms",
                kFramesMatched / seconds,
                "matches/s",
                atLeast(30.0),
                atLeast(60.0),
                {noteOf(times), "mean IoU wanted " + fixed(iou, 3)}});
}

} // namespace lumorph::bench
