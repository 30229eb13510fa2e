#include "app/studio/calibration/chain_live.h"

#include <string>
#include <utility>

#include "calibration/registration/touch_plan.h"
#include "core/base/error.h"

namespace lumorph::studio {
namespace {

constexpr std::size_t kDots = 12, kLandmarks = 16, kAlignments = 8, kFresh = 4, kDimples = 3;

/// "Touch dot 3 of 16".
QString counted(const QString& words, std::size_t index, std::size_t count) { return words.arg(index + 1).arg(count); }

std::vector<LiveStep> dotSteps(const Rig& rig, const Installation& room, std::size_t count, const char* name,
                               const QString& words) {
    std::vector<LiveStep> steps;
    const std::vector<PlannedDot> dots = planDots(room, 0, rig, count);
    for (std::size_t k = 0; k < dots.size(); ++k)
        steps.push_back({std::string(name) + ' ' + std::to_string(k + 1), counted(words, k, dots.size()),
                         LiveStep::Ends::atNewPlace, dots[k], std::nullopt});
    return steps;
}

Touch touchOf(const LiveTask& task, std::size_t step, std::optional<PoseRole> body) {
    const LiveTake& take = task.takes.at(step);
    Touch touch{task.plan.steps.at(step).name, take.at(PoseRole::pointer), std::nullopt};
    if (body) touch.body = take.at(*body);
    return touch;
}

/// How many of so many steps the fit may see.
std::size_t fitted(const LiveTask& task) {
    if (task.takes.size() <= kFresh)
        throw InvalidInput("the plan", "it has no more than " + std::to_string(task.takes.size()) + " points",
                           "make room on the lit table beside the device");
    return task.takes.size() - kFresh;
}

} // namespace

std::vector<LiveStep> pointerSteps(const Rig&, const Installation&) {
    std::vector<LiveStep> steps;
    steps.push_back({"swings", QObject::tr("Set the tip into a dimple, and swing the pointer to all sides"),
                     LiveStep::Ends::swung, std::nullopt, std::nullopt});
    for (std::size_t k = 0; k < kDimples; ++k) {
        const std::string name = "dimple " + std::to_string(k + 1);
        steps.push_back({name, counted(QObject::tr("Hold it still in another dimple: %1 of %2"), k, kDimples),
                         LiveStep::Ends::atNewPlace, std::nullopt, std::nullopt});
        steps.push_back({name, QObject::tr("Leave the tip there, lean the pointer otherwise, and hold it still"),
                         LiveStep::Ends::heldOtherwise, std::nullopt, std::nullopt});
    }
    return steps;
}

Registration pointerFromLive(const LiveTask& task, const Progress& progress) {
    PointerCapture capture;
    capture.swings = task.takes.at(0).at(PoseRole::pointer);
    for (std::size_t k = 1; k + 1 < task.takes.size(); k += 2)
        capture.fresh.push_back({touchOf(task, k, std::nullopt), touchOf(task, k + 1, std::nullopt)});
    return registerPointer(capture, task.believed, progress);
}

std::vector<LiveStep> trackerSteps(const Rig& rig, const Installation& room) {
    return dotSteps(rig, room, kDots + kFresh, "dot",
                    QObject::tr("Touch the lit dot with the tip, and rest: %1 of %2"));
}

Registration trackerFromLive(const LiveTask& task, const Progress& progress) {
    DotCapture capture;
    for (std::size_t k = 0; k < task.takes.size(); ++k)
        (k < fitted(task) ? capture.dots : capture.fresh)
            .push_back({0, task.plan.steps.at(k).dot.value().pixel, touchOf(task, k, std::nullopt)});
    return registerTracker(capture, task.believed, progress);
}

std::vector<LiveStep> deviceSteps(const Rig& rig, const Installation&) {
    std::vector<LiveStep> steps;
    const std::vector<PlannedLandmark> corners = planLandmarks(rig, kLandmarks + kFresh);
    const QString words = QObject::tr("Touch the marked corner of the device, and rest: %1 of %2");
    for (std::size_t k = 0; k < corners.size(); ++k)
        steps.push_back({"corner " + std::to_string(k + 1), counted(words, k, corners.size()),
                         LiveStep::Ends::atNewPlace, std::nullopt, corners[k]});
    return steps;
}

Registration deviceFromLive(const LiveTask& task, const Progress& progress) {
    LandmarkCapture capture;
    for (std::size_t k = 0; k < task.takes.size(); ++k) {
        const PlannedLandmark& corner = task.plan.steps.at(k).corner.value();
        (k < fitted(task) ? capture.touches : capture.fresh)
            .push_back({corner.onModel, corner.outward, touchOf(task, k, PoseRole::device)});
    }
    return registerDevice(capture, task.believed, progress);
}

std::vector<LiveStep> eyeSteps(const Rig& rig, const Installation& room) {
    return dotSteps(
        rig, room, kAlignments + kFresh, "mark",
        QObject::tr("Close one eye, cover the lit dot with the tip a good way above it, and rest: %1 of %2"));
}

Registration eyeFromLive(const LiveTask& task, const Progress& progress) {
    EyeCapture capture;
    for (std::size_t k = 0; k < task.takes.size(); ++k)
        (k < fitted(task) ? capture.alignments : capture.fresh)
            .push_back({task.plan.steps.at(k).dot.value().place, touchOf(task, k, PoseRole::head)});
    return registerEye(capture, task.believed, progress);
}

} // namespace lumorph::studio
