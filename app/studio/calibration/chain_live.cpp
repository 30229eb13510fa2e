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

std::vector<LiveStep> trackerSteps(const Rig& rig, const Installation& room) {
    return dotSteps(rig, room, kDots + kFresh, "dot",
                    QObject::tr("Touch the lit dot with the tip, and rest: %1 of %2"));
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

std::vector<LiveStep> eyeSteps(const Rig& rig, const Installation& room) {
    return dotSteps(
        rig, room, kAlignments + kFresh, "mark",
        QObject::tr("Close one eye, cover the lit dot with the tip a good way above it, and rest: %1 of %2"));
}

RecordingSource LiveBench::source() const {
    return {isSimulated_ ? RecordingSource::Kind::rehearsal : RecordingSource::Kind::table,
            isSimulated_ ? "a simulated tracker" : "a tracked pointer", utcDate(), 0};
}

Touch LiveBench::touchOf(std::size_t step, std::optional<PoseRole> body) const {
    const LiveTake& take = takes_.at(step);
    Touch touch{plan_.steps.at(step).name, take.at(PoseRole::pointer), std::nullopt};
    if (body) touch.body = take.at(*body);
    return touch;
}

/// How many of the steps the fit may see.
std::size_t LiveBench::fitted() const {
    if (takes_.size() <= kFresh)
        throw InvalidInput("the plan", "it has no more than " + std::to_string(takes_.size()) + " points",
                           "make room on the lit table beside the device");
    return takes_.size() - kFresh;
}

PointerCapture LiveBench::recordPointer(const StageSite&, const Progress&) {
    PointerCapture capture;
    capture.swings = takes_.at(0).at(PoseRole::pointer);
    for (std::size_t k = 1; k + 1 < takes_.size(); k += 2)
        capture.fresh.push_back({touchOf(k, std::nullopt), touchOf(k + 1, std::nullopt)});
    return capture;
}

DotCapture LiveBench::recordDots(const StageSite&, const Progress&) {
    DotCapture capture;
    for (std::size_t k = 0; k < takes_.size(); ++k)
        (k < fitted() ? capture.dots : capture.fresh)
            .push_back({0, plan_.steps.at(k).dot.value().pixel, touchOf(k, std::nullopt)});
    return capture;
}

LandmarkCapture LiveBench::recordLandmarks(const StageSite&, const Progress&) {
    LandmarkCapture capture;
    for (std::size_t k = 0; k < takes_.size(); ++k) {
        const PlannedLandmark& corner = plan_.steps.at(k).corner.value();
        (k < fitted() ? capture.touches : capture.fresh)
            .push_back({corner.onModel, corner.outward, touchOf(k, PoseRole::device)});
    }
    return capture;
}

EyeCapture LiveBench::recordEye(const StageSite&, const Progress&) {
    EyeCapture capture;
    for (std::size_t k = 0; k < takes_.size(); ++k)
        (k < fitted() ? capture.alignments : capture.fresh)
            .push_back({plan_.steps.at(k).dot.value().place, touchOf(k, PoseRole::head)});
    return capture;
}

} // namespace lumorph::studio
