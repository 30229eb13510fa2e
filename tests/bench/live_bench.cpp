#include <algorithm>
#include <memory>

#include "core/base/error.h"
#include "core/loop/live_match.h"
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
    constexpr Stage kStages[] = {{"pose", &MatchTimes::pose},     {"voxelise", &MatchTimes::voxelize},
                                 {"match", &MatchTimes::match},   {"refine", &MatchTimes::refine},
                                 {"motion", &MatchTimes::motion}, {"deform", &MatchTimes::deform},
                                 {"in all", &MatchTimes::total}};
    std::string note = "medians of " + std::to_string(frames.size()) + " frames, ms:";
    double longest = 0.0;
    for (const Stage& stage : kStages) {
        std::vector<double> values;
        for (const MatchTimes& frame : frames) values.push_back(frame.*stage.of);
        note += std::string(" ") + stage.name + " " + fixed(medianOf(values), 3);
        longest = *std::max_element(values.begin(), values.end());
    }
    return note + "; longest " + fixed(longest, 1);
}

} // namespace

void benchLive(const Filter& filter, Report& report) {
    if (!filter.wants("loop-live")) return;
    constexpr int kFrames = 240;
    const MatchWish wish = liveWish();
    const SteadyClock clock;
    MatchLoop loop(clock);
    std::vector<MatchTimes> times;
    double iou = 0.0;
    const double seconds = secondsOf([&] {
        for (int k = 0; k < kFrames; ++k) {
            const auto frame = loop.step(wish, 1.0 / 60.0);
            times.push_back(frame->ms);
            iou += frame->iouWanted / kFrames;
        }
    });
    report.add({"loop-live",
                "live loop without drawing: animated target of 70,000 triangles, refined for at most 8 ms",
                kFrames / seconds,
                "matches/s",
                atLeast(30.0),
                atLeast(60.0),
                {noteOf(times), "mean IoU wanted " + fixed(iou, 3)}});
}

} // namespace lumorph::bench
