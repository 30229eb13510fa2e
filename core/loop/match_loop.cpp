#include "core/loop/match_loop.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/loop/dance.h"
#include "core/loop/drive_stage.h"
#include "core/loop/frame_source.h"
#include "core/loop/item_fit_stage.h"
#include "core/loop/match_stage.h"
#include "core/loop/motion_stage.h"
#include "core/loop/program_stage.h"
#include "core/loop/scene_clock.h"
#include "core/loop/stage_timer.h"
#include "core/loop/target_stage.h"
#include "core/loop/viewer_stage.h"
#include "core/motion/rig_motion.h"
#include "core/motion/stroke_lead.h"

namespace lumorph {

namespace {

bool matchesTarget(const MatchWish& wish) { return wish.driver == Driver::target && wish.target && wish.field; }

/// Of a wish whose driver has been worked out: whether voxels are followed.
bool isMatched(const MatchWish& wish) { return wish.driver == Driver::target || wish.driver == Driver::program; }

void requireFinite(const char* what, double value) {
    if (!std::isfinite(value)) throw InvalidInput(what, "it is not a finite number", "give a finite number");
}

void checkPlacement(const Placement& placement) {
    requireFinite("yaw of the target", placement.yaw.inRadians());
    requireFinite("orientation of the target", static_cast<double>(glm::length(placement.orientation)));
    for (int axis = 0; axis < 3; ++axis)
        requireFinite("position of the target", static_cast<double>(placement.translation[axis]));
    if (!(placement.scale > 0.0) || !std::isfinite(placement.scale))
        throw InvalidInput("scale of the target", "it must be a finite number above zero", "give a larger scale");
}

void checkStrokes(const MatchWish& wish) {
    const std::size_t count = wish.rig->actuatorCount();
    if (wish.strokes.size() != count)
        throw InvalidInput("strokes",
                           std::to_string(wish.strokes.size()) + " for " + std::to_string(count) + " actuators",
                           "give one for each actuator");
    for (const double stroke : wish.strokes) requireFinite("stroke", stroke);
}

void checkPosePlay(const MatchWish& wish) {
    if (wish.driver != Driver::hand || !wish.posePlay) return;
    requirePlayable(wish.posePlay->sequence, wish.rig->actuatorCount());
    if (wish.posePlay->from.size() != wish.rig->actuatorCount())
        throw InvalidInput("poses", "they begin with another number of actuators than the device has",
                           "play them again");
    for (const double stroke : wish.posePlay->from) requireFinite("stroke", stroke);
}

void checkWish(const MatchWish& wish, double sinceLast) {
    if (!wish.rig) throw InvalidInput("device", "there is no rig", "open one first");
    if (wish.field && wish.field->rig.actuatorCount() != wish.rig->actuatorCount())
        throw InvalidInput("field", "it belongs to a rig with another number of actuators",
                           "build the field of this rig");
    if (!(sinceLast >= 0.0) || !std::isfinite(sinceLast))
        throw InvalidInput("time step", "it is negative or not finite",
                           "use a finite time that does not run backwards");
    if ((wish.scene || wish.program) && !wish.installation)
        throw InvalidInput("scene", "there is no installation to show it in", "give it one, such as the virtual lab's");
    if (wish.driver == Driver::program && !wish.program)
        throw InvalidInput("show program", "there is none", "choose one first");
    requireFinite("spin", wish.spin);
    if (wish.seek) requireFinite("animation time", *wish.seek);
    if (wish.sceneSeek) requireFinite("scene time", *wish.sceneSeek);
    if (wish.target) checkPlacement(wish.placement);
    if (wish.budget <= Microseconds{0})
        throw InvalidInput("time for refinement", "it must be more than zero", "give it at least a microsecond");
    // With a program the driver may turn out to have nothing to follow.
    const bool holds = !matchesTarget(wish) && DriveStage::modeOf(wish) == DriveStage::Mode::asWished;
    if (wish.program || holds) checkStrokes(wish);
    checkPosePlay(wish);
}

State nearestLevels(const std::vector<double>& strokes, int levels) {
    State state;
    for (const double stroke : strokes) state.push_back(Level{static_cast<int>(std::lround(stroke * (levels - 1)))});
    return state;
}

} // namespace

struct MatchLoop::Data {
    explicit Data(const Clock& c) : clock(c) {}

    void fill(const MatchWish& wish, double sinceLast, MatchFrame& frame);
    /// The same, once what is shown is known.
    void fillShown(const MatchWish& wish, double sinceLast, MatchFrame& frame);
    /// The scene's part of a frame, and its time.
    void look(const MatchWish& wish, double sinceLast, MatchFrame& frame);
    /// What scene and program make of what the servos are to do: the driver that is left is target or program where
    /// voxels are followed, else hand or dance.
    MatchWish driven(const MatchWish& wish, double sinceLast, MatchFrame& frame);
    void hold(const MatchWish& wish, double sinceLast, MatchFrame& frame);
    void joinBends(const MatchWish& wish, MatchFrame& frame);
    /// `servos` as driven() returns it.
    void move(const MatchWish& servos, double sinceLast, MatchFrame& frame);
    /// The strokes that the actuators are commanded: ahead of a moving target by their lag.
    [[nodiscard]] std::vector<double> aims(const MatchWish& servos, double sinceLast, const MatchFrame& frame);
    void judgeItem(const MatchWish& wish, MatchFrame& frame);
    [[nodiscard]] std::shared_ptr<const MatchFrame> shown(const MatchWish& wish);
    [[nodiscard]] bool restsAfter(const MatchWish& wish, const MatchFrame& frame) const;

    const Clock& clock;
    ProgramStage program;
    ViewerStage viewer;
    SceneClock time;
    TargetStage target;
    DriveStage drive;
    ItemFitStage itemFit;
    MatchStage matching;
    MotionStage motion;
    std::optional<StrokeLead> lead; ///< of `ledRig` and `ledTarget`
    std::shared_ptr<const Rig> ledRig;
    std::shared_ptr<const MatchTarget> ledTarget;
    Dance dance;
    std::uint64_t number = 0;
    bool settled = false;
};

void MatchLoop::Data::fill(const MatchWish& wish, double sinceLast, MatchFrame& frame) {
    const StageTimer timer(clock, frame.ms.total);
    motion.follow(wish.rig, wish.rigOrigin);
    motion.use(wish.installation, wish.lightDelay);
    if (wish.installation && (wish.scene || wish.program)) {
        const StageTimer track(clock, frame.ms.track);
        viewer.look(wish, sinceLast, frame); // before the program, which may ask who looks
    }
    fillShown(program.ask(wish, sinceLast, motion.strokes(), clock, frame), sinceLast, frame);
}

void MatchLoop::Data::fillShown(const MatchWish& wish, double sinceLast, MatchFrame& frame) {
    look(wish, sinceLast, frame);
    target.play(wish, sinceLast);
    const bool newTarget = target.show(wish, clock, frame.ms);
    target.describe(frame);
    program.describe(frame);
    matching.use(wish.field, motion.reach());
    const MatchWish servos = driven(wish, sinceLast, frame);
    if (isMatched(servos))
        dance.end();
    else
        hold(servos, sinceLast, frame);
    const TargetVoxels& voxels = program.matches() ? program.voxels() : target.voxels();
    if (program.matches())
        matching.match(servos, voxels, wish.program, program.newVoxels(), clock, frame);
    else if (frame.matched)
        matching.match(servos, voxels, wish.target, newTarget, clock, frame);
    joinBends(wish, frame);
    move(servos, sinceLast, frame);
    if (frame.matched) matching.judge(wish, voxels, frame);
    judgeItem(wish, frame);
    settled = restsAfter(servos, frame);
}

void MatchLoop::Data::look(const MatchWish& wish, double sinceLast, MatchFrame& frame) {
    if (!wish.scene) return;
    frame.scene = wish.scene;
    frame.installation = wish.installation;
    frame.assets = wish.assets;
    time.step(wish, sinceLast);
    frame.sceneSeconds = time.seconds();
}

MatchWish MatchLoop::Data::driven(const MatchWish& wish, double sinceLast, MatchFrame& frame) {
    MatchWish servos = wish;
    const DriveStage::Mode mode = DriveStage::modeOf(wish);
    if (mode == DriveStage::Mode::asWished) {
        if (matchesTarget(wish) || program.matches() || wish.driver == Driver::dance) return servos;
        servos.driver = Driver::hand;
        if (wish.driver == Driver::hand && wish.posePlay) {
            frame.poseSeconds = secondsOf(*wish.posePlay, frame.time);
            servos.strokes = strokesAt(wish.posePlay->sequence, wish.posePlay->from, *frame.poseSeconds);
        }
        if (!program.splitStrokes().empty()) servos.strokes = frame.splitStrokes = program.splitStrokes();
        return servos;
    }
    servos.driver = Driver::hand;
    servos.strokes.assign(wish.rig->actuatorCount(), 0.0);
    if (mode == DriveStage::Mode::atRest) return servos;
    const StageTimer timer(clock, frame.ms.rule);
    servos.strokes = drive.strokes(wish, frame, sinceLast);
    if (drivingItem(*wish.scene)->role == ItemRole::split) frame.splitStrokes = servos.strokes;
    return servos;
}

void MatchLoop::Data::joinBends(const MatchWish& wish, MatchFrame& frame) {
    const StageTimer timer(clock, frame.ms.rule);
    frame.viewStrokes = drive.bends(wish, frame);
    if (!frame.viewStrokes.empty()) frame.unbentStrokes = frame.wantedStrokes;
    for (std::size_t i = 0; i < frame.viewStrokes.size(); ++i)
        frame.wantedStrokes[i] = std::max(frame.wantedStrokes[i], frame.viewStrokes[i]);
    if (frame.viewStrokes.empty() || !wish.field) return;
    const State levels = nearestLevels(frame.viewStrokes, wish.field->field.levels);
    for (std::size_t i = 0; i < levels.size(); ++i) frame.wanted[i] = std::max(frame.wanted[i], levels[i]);
}

bool MatchLoop::Data::restsAfter(const MatchWish& wish, const MatchFrame& frame) const {
    if (program.moves() || (wish.inputs && wish.program && !wish.inputs->empty())) return false;
    if (wish.scene && (viewer.moves() || time.moves())) return false;
    if (TargetStage::moves(wish)) return false;
    if (frame.poseSeconds && movesOn(*wish.posePlay, frame.time)) return false;
    if (!motion.stands() || (!wish.stopped && !motion.arrived(frame.wantedStrokes))) return false;
    if (!itemFit.current()) return false;
    return isMatched(wish) ? matching.converged() : wish.driver != Driver::dance;
}

void MatchLoop::Data::hold(const MatchWish& wish, double sinceLast, MatchFrame& frame) {
    const bool dances = wish.driver == Driver::dance;
    if (!dances) dance.end();
    frame.wantedStrokes = dances ? dance.step(wish.strokes, sinceLast) : wish.strokes;
    for (double& stroke : frame.wantedStrokes) stroke = std::clamp(stroke, 0.0, 1.0);
    if (wish.field) frame.wanted = nearestLevels(frame.wantedStrokes, wish.field->field.levels);
}

std::vector<double> MatchLoop::Data::aims(const MatchWish& servos, double sinceLast, const MatchFrame& frame) {
    if (servos.driver != Driver::target || !TargetStage::moves(servos) || servos.stopped) {
        lead.reset();
        return frame.wantedStrokes;
    }
    if (!lead || ledRig != servos.rig || ledTarget != servos.target) lead.emplace(motionLimits(*servos.rig));
    ledRig = servos.rig;
    ledTarget = servos.target;
    const auto commands = lead->step(frame.wantedStrokes, sinceLast);
    std::vector<double> within(commands.begin(), commands.end());
    motion.limit(within);
    return within;
}

void MatchLoop::Data::move(const MatchWish& servos, double sinceLast, MatchFrame& frame) {
    {
        const StageTimer timer(clock, frame.ms.motion);
        motion.limit(frame.wantedStrokes);
        motion.move(aims(servos, sinceLast, frame), sinceLast, servos.stopped);
        frame.estimatedStrokes.assign(motion.strokes().begin(), motion.strokes().end());
        frame.commandedStrokes.assign(motion.commands().begin(), motion.commands().end());
    }
    const StageTimer timer(clock, frame.ms.deform);
    frame.devicePositions = motion.deformed();
}

void MatchLoop::Data::judgeItem(const MatchWish& wish, MatchFrame& frame) {
    if (!wish.field || DriveStage::modeOf(wish) != DriveStage::Mode::byHeights) return itemFit.forget();
    const StageTimer timer(clock, frame.ms.match);
    itemFit.judge(drive.source(), drive.sourceSeconds(), wish.field, clock, frame);
}

/// A frame of another source. Whoever comes back from there goes on where its actuators stood.
std::shared_ptr<const MatchFrame> MatchLoop::Data::shown(const MatchWish& wish) {
    if (!wish.rig) throw InvalidInput("device", "there is no rig", "open one first");
    if (!wish.source) throw InvalidInput("recording", "there is none to show", "open one first");
    std::shared_ptr<const MatchFrame> frame = wish.source->frame(wish, clock.now());
    motion.follow(wish.rig, wish.rigOrigin);
    motion.use(wish.installation, wish.lightDelay);
    motion.standAt(frame->estimatedStrokes);
    settled = !wish.source->moves();
    return frame;
}

MatchLoop::MatchLoop(const Clock& clock) : data_(std::make_unique<Data>(clock)) {}
MatchLoop::~MatchLoop() = default;
MatchLoop::MatchLoop(MatchLoop&&) noexcept = default;
MatchLoop& MatchLoop::operator=(MatchLoop&&) noexcept = default;

std::shared_ptr<const MatchFrame> MatchLoop::step(const MatchWish& wish, double sinceLast) {
    data_->settled = false;
    if (wish.driver == Driver::recording) return data_->shown(wish);
    checkWish(wish, sinceLast);
    auto frame = std::make_shared<MatchFrame>();
    frame->number = ++data_->number;
    frame->time = data_->clock.now();
    frame->rig = wish.rig;
    frame->rigOrigin = wish.rigOrigin;
    frame->field = wish.field;
    frame->driver = wish.driver;
    data_->fill(wish, sinceLast, *frame);
    return frame;
}

void MatchLoop::rest(double seconds) { data_->motion.rest(seconds); }

bool MatchLoop::settled() const noexcept { return data_->settled; }

} // namespace lumorph
