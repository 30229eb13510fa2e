#include "app/workspaces/field/pose_desk.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "core/motion/rig_motion.h"

namespace lumorph::studio {

namespace {

QString stepsText(const std::vector<int>& steps) {
    QStringList numbers;
    for (const int step : steps) numbers << QString::number(step + 1);
    const QString last = numbers.takeLast();
    return numbers.isEmpty() ? last : numbers.join(", ") + " and " + last;
}

QString namesText(const std::vector<std::string>& names) {
    constexpr std::size_t kMost = 4;
    QStringList words;
    for (std::size_t k = 0; k < std::min(names.size(), kMost); ++k) words << QString::fromStdString(names[k]);
    const QString text = words.join(", ");
    return names.size() > kMost ? text + QString(" and %1 more").arg(names.size() - kMost) : text;
}

} // namespace

PoseDesk::PoseDesk(Studio& studio, QObject* parent)
    : QObject(parent), studio_(studio), hand_(studio.document, studio.loop) {
    connect(&studio.document, &StudioDocument::changed, this, &PoseDesk::onChanged);
    connect(&studio.loop, &StudioLoop::posePlayChanged, this, &PoseDesk::changed);
    connect(&studio.loop, &StudioLoop::framed, this, &PoseDesk::onFrame);
    connect(&studio.loop, &StudioLoop::stopOrdered, this, &PoseDesk::stop);
}

const PoseBook& PoseDesk::book() const { return *studio_.document.state().poses; }

std::vector<std::string> PoseDesk::actuatorNames() const {
    std::vector<std::string> names;
    if (const auto& rig = studio_.document.state().rig.rig)
        for (const Actuator& actuator : rig->actuators()) names.push_back(actuator.name);
    return names;
}

PoseDesk::State PoseDesk::state() const {
    const auto& play = studio_.loop.posePlay();
    return !play ? State::stopped : play->heldAt ? State::paused : State::playing;
}

/// Of the rig and of the servos as they are set up, whichever is slower.
std::vector<PoseLimits> PoseDesk::limits() const {
    const auto& rig = studio_.document.state().rig.rig;
    std::vector<PoseLimits> limits = poseLimits(motionLimits(*rig));
    const std::vector<ServoSetup>& servos = studio_.devices.profile().servos;
    if (servos.size() != limits.size()) return limits;
    for (std::size_t k = 0; k < limits.size(); ++k)
        limits[k] = {std::min(limits[k].maxVelocity, servos[k].maxVelocity), servos[k].maxAcceleration};
    return limits;
}

std::optional<PoseSequence> PoseDesk::plannedFrom(const std::vector<double>& from) const {
    if (!studio_.document.state().rig.rig || book().sequence.steps.empty()) return std::nullopt;
    return withinLimits(sequenceFor(book(), actuatorNames()), from, limits());
}

std::optional<PoseSequence> PoseDesk::planned() const {
    const auto& play = studio_.loop.posePlay();
    return plannedFrom(play ? play->from : hand_.strokes());
}

QString PoseDesk::slowedText() const {
    const auto plan = planned();
    if (!plan) return {};
    std::vector<int> slowed;
    QStringList seconds;
    for (std::size_t k = 0; k < plan->steps.size(); ++k) {
        if (plan->steps[k].travelSeconds <= book().sequence.steps[k].travelSeconds) continue;
        slowed.push_back(static_cast<int>(k));
        seconds << QString::number(plan->steps[k].travelSeconds, 'f', 2) + " s";
    }
    if (slowed.empty()) return {};
    if (slowed.size() == 1)
        return tr("The way of step %1 takes %2 instead of %3 s: the servos may go no faster.")
            .arg(stepsText(slowed), seconds.front())
            .arg(book().sequence.steps[static_cast<std::size_t>(slowed.front())].travelSeconds, 0, 'f', 2);
    return tr("The ways of steps %1 take longer than they are set to (%2): the servos may go no faster.")
        .arg(stepsText(slowed), seconds.join(", "));
}

QString PoseDesk::fitText() const {
    if (!studio_.document.state().rig.rig) return {};
    const PoseFit fit = fitOf(book(), actuatorNames());
    QStringList sentences;
    if (!fit.atRest.empty())
        sentences << tr("The poses were taken without %1, which rests in them.").arg(namesText(fit.atRest));
    if (!fit.kept.empty())
        sentences << tr("What they say of %1, which this device does not have, is kept.").arg(namesText(fit.kept));
    return sentences.join(' ');
}

void PoseDesk::play() {
    if (state() == State::playing || studio_.loop.stopped()) return; // after STOP one resumes first
    const Microseconds now = SteadyClock().now();
    auto play = std::make_shared<PosePlay>();
    if (state() == State::paused) {
        *play = *studio_.loop.posePlay();
        play->since = now - Microseconds(std::llround(1e6 * *std::exchange(play->heldAt, std::nullopt)));
        return studio_.loop.setPosePlay(play);
    }
    play->from = hand_.strokes();
    const auto plan = plannedFrom(play->from);
    if (!plan) return;
    if (studio_.document.previewing()) studio_.document.cancelPreview();
    studio_.driver.choose(Driver::hand);
    play->sequence = *plan;
    play->since = now;
    studio_.loop.setPosePlay(play);
}

void PoseDesk::pause() {
    if (state() != State::playing) return;
    auto held = std::make_shared<PosePlay>(*studio_.loop.posePlay());
    held->heldAt = secondsOf(*held, SteadyClock().now());
    studio_.loop.setPosePlay(held);
}

void PoseDesk::stop() {
    if (state() == State::stopped) return;
    const std::vector<double> strokes = hand_.strokes();
    studio_.loop.setPosePlay(nullptr);
    hand_.moveAll(tr("Play the poses"), strokes);
}

std::optional<double> PoseDesk::seconds() const {
    const auto& play = studio_.loop.posePlay();
    if (!play) return std::nullopt;
    const double round = durationOf(play->sequence);
    const double seconds = secondsOf(*play, SteadyClock().now());
    if (!(round > 0.0)) return 0.0;
    return play->sequence.loop ? std::fmod(seconds, round) : std::min(seconds, round);
}

/// A sequence that is no loop has ended once a frame shows its last pose.
void PoseDesk::onFrame() {
    const auto& play = studio_.loop.posePlay();
    const auto& frame = studio_.loop.frame();
    if (!play || play->heldAt || play->sequence.loop || !frame->poseSeconds || frame->time < play->since) return;
    if (*frame->poseSeconds >= durationOf(play->sequence)) stop();
}

void PoseDesk::onChanged(StateParts parts) {
    if (!(parts & (StatePart::poses | StatePart::rig | StatePart::rigEdited))) return;
    settleChoice();
    // What plays follows an edit; motion limits hold whatever the edit was.
    if (const auto before = studio_.loop.posePlay()) {
        auto play = std::make_shared<PosePlay>(*before);
        if (const auto plan = plannedFrom(play->from)) {
            play->sequence = *plan;
            if (!(*play == *before)) studio_.loop.setPosePlay(play);
        } else {
            stop();
        }
    }
    emit changed();
}

void PoseDesk::settleChoice() {
    pose_ = std::min(pose_, static_cast<int>(book().sequence.poses.size()) - 1);
    step_ = std::min(step_, static_cast<int>(book().sequence.steps.size()) - 1);
}

void PoseDesk::choosePose(int index) {
    if (std::exchange(pose_, index) == index) return;
    settleChoice();
    emit changed();
}

void PoseDesk::chooseStep(int index) {
    if (std::exchange(step_, index) == index) return;
    settleChoice();
    emit changed();
}

void PoseDesk::edit(const QString& what, const std::function<void(PoseBook&)>& edit) {
    auto edited = std::make_shared<PoseBook>(book());
    try {
        edit(*edited);
        requireSound(*edited);
    } catch (const InvalidInput& error) {
        studio_.notices.post(kPosePlace, noticeOf(error));
        emit changed(); // a field that shows the refused value shows the old one again
        return;
    }
    studio_.notices.dismissAll(kPosePlace);
    studio_.document.change(what, [&](StudioState& state) { state.poses = edited; });
}

void PoseDesk::keep() {
    if (!studio_.document.state().rig.rig) return;
    const std::string name = freePoseName(book(), "Pose " + std::to_string(book().sequence.poses.size() + 1));
    const std::vector<double> strokes = hand_.strokes();
    const std::size_t before = book().sequence.poses.size();
    edit(tr("Keep a pose"), [&](PoseBook& poses) { keepPose(poses, name, actuatorNames(), strokes); });
    if (book().sequence.poses.size() == before) return;
    choosePose(static_cast<int>(before));
    emit kept(static_cast<int>(before));
}

void PoseDesk::update() {
    if (pose_ < 0) return;
    const std::string name = book().sequence.poses[static_cast<std::size_t>(pose_)].name;
    edit(tr("Take %1 again").arg(QString::fromStdString(name)),
         [&](PoseBook& poses) { keepPose(poses, name, actuatorNames(), hand_.strokes()); });
}

void PoseDesk::rename(int pose, const QString& name) {
    const std::string before = book().sequence.poses.at(static_cast<std::size_t>(pose)).name;
    const std::string after = name.simplified().toStdString();
    if (before == after) return emit changed();
    edit(tr("Rename a pose"), [&](PoseBook& poses) { renamePose(poses, before, after); });
}

void PoseDesk::remove() {
    if (pose_ < 0) return;
    const std::string name = book().sequence.poses[static_cast<std::size_t>(pose_)].name;
    edit(tr("Delete %1").arg(QString::fromStdString(name)), [&](PoseBook& poses) { removePose(poses, name); });
}

void PoseDesk::go() {
    if (pose_ < 0) return;
    const PoseSequence sequence = sequenceFor(book(), actuatorNames());
    const NamedPose& pose = sequence.poses[static_cast<std::size_t>(pose_)];
    hand_.moveAll(tr("Go to %1").arg(QString::fromStdString(pose.name)), pose.strokes);
}

void PoseDesk::addStep() {
    if (pose_ < 0) return;
    const int at = step_ < 0 ? static_cast<int>(book().sequence.steps.size()) : step_ + 1;
    edit(tr("Add a step"), [&](PoseBook& poses) {
        PoseStep step;
        step.pose = poses.sequence.poses[static_cast<std::size_t>(pose_)].name;
        step.holdSeconds = 0.5;
        poses.sequence.steps.insert(poses.sequence.steps.begin() + at, step);
    });
    chooseStep(at);
}

void PoseDesk::removeStep() {
    if (step_ < 0) return;
    edit(tr("Remove a step"),
         [at = step_](PoseBook& poses) { poses.sequence.steps.erase(poses.sequence.steps.begin() + at); });
}

void PoseDesk::moveStep(int from, int to) {
    const int count = static_cast<int>(book().sequence.steps.size());
    if (from < 0 || from >= count || to < 0 || to >= count || from == to) return;
    edit(tr("Move a step"), [&](PoseBook& poses) {
        const auto first = poses.sequence.steps.begin();
        if (from < to)
            std::rotate(first + from, first + from + 1, first + to + 1);
        else
            std::rotate(first + to, first + from, first + from + 1);
    });
    chooseStep(to);
}

void PoseDesk::editStep(const QString& what, const std::function<void(PoseStep&)>& change) {
    if (step_ < 0) return;
    edit(what, [&](PoseBook& poses) { change(poses.sequence.steps[static_cast<std::size_t>(step_)]); });
}

void PoseDesk::previewStep(const std::function<void(PoseStep&)>& change) {
    if (step_ < 0) return;
    studio_.document.preview([&](StudioState& state) {
        auto edited = std::make_shared<PoseBook>(*state.poses);
        change(edited->sequence.steps[static_cast<std::size_t>(step_)]);
        state.poses = edited;
    });
}

void PoseDesk::setLoop(bool loop) {
    edit(tr("Loop the poses"), [&](PoseBook& poses) { poses.sequence.loop = loop; });
}

} // namespace lumorph::studio
