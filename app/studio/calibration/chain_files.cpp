#include "app/studio/calibration/chain_files.h"

#include <algorithm>
#include <string>

#include <glm/geometric.hpp>

#include "calibration/registration/dwells.h"
#include "calibration/registration/pivot.h"
#include "calibration/registration/pose_file.h"
#include "calibration/registration/time_unit.h"
#include "core/base/file.h"

namespace lumorph::studio {
namespace {

constexpr std::size_t kMostRecorded = 256'000'000; // bytes of one recording: hours of it
constexpr double kDwellSeconds = 0.8;
constexpr double kDwellRadius = 0.006; // metres: a tracker trembles by a millimetre, a long pointer enlarges it
constexpr double kSameDimple = 0.012;  // metres within which two rests are of one dimple

std::string recordedText(const FileTask& task, std::size_t file) {
    const std::vector<std::byte> bytes = readFile(task.files.at(file), kMostRecorded);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

PoseTrack recordedTrack(const FileTask& task, std::size_t file) {
    const std::string name = task.files.at(file).filename().string();
    return inKnownSeconds(parsePoseTrack(recordedText(task, file), name), name);
}

/// The rests of a tip in one recording, by the places where it rested.
std::vector<std::vector<Touch>> restsByDimple(const PoseTrack& track, const glm::dvec3& tip) {
    std::vector<TimedPlace> places;
    for (const TimedPose& at : track.poses) places.push_back({at.seconds, at.pose * tip});
    std::vector<std::vector<Touch>> dimples;
    std::vector<glm::dvec3> middles;
    for (const Dwell& dwell : findDwells(places, kDwellSeconds, kDwellRadius)) {
        const auto same = std::ranges::find_if(
            middles, [&](const glm::dvec3& at) { return glm::distance(at, dwell.place) < kSameDimple; });
        const auto number = static_cast<std::size_t>(same - middles.begin());
        if (same == middles.end()) {
            middles.push_back(dwell.place);
            dimples.emplace_back();
        }
        Touch touch;
        touch.name = "dimple " + std::to_string(number + 1);
        const auto first = track.poses.begin() + static_cast<std::ptrdiff_t>(dwell.first);
        touch.pointer.poses.assign(first, first + static_cast<std::ptrdiff_t>(dwell.count));
        dimples[number].push_back(std::move(touch));
    }
    return dimples;
}

} // namespace

Registration pointerFromFiles(const FileTask& task, const Progress& progress) {
    progress.report(0.0, "reading the recordings");
    PointerCapture capture;
    capture.swings = recordedTrack(task, 0);
    const PoseTrack rests = recordedTrack(task, 1);
    progress.report(0.3, "looking for rests");
    capture.fresh = restsByDimple(rests, solvePivot(capture.swings).tip);
    progress.throwIfCancelled();
    return registerPointer(capture, task.believed, progress.part(0.4, 1.0));
}

Registration trackerFromFiles(const FileTask& task, const Progress& progress) {
    progress.report(0.0, "reading the recordings");
    const BoardCapture capture{recordedTrack(task, 0), recordedTrack(task, 1)};
    progress.throwIfCancelled();
    return registerTracker(capture, task.believed, progress.part(0.2, 1.0));
}

Registration deviceFromFiles(const FileTask& task, const Progress& progress) {
    progress.report(0.0, "reading the recordings");
    RecordedLandmarks capture;
    capture.pointer = recordedTrack(task, 0);
    capture.body = recordedTrack(task, 1);
    capture.model = parseNamedPoints(recordedText(task, 2), task.files.at(2).filename().string());
    progress.throwIfCancelled();
    return registerDevice(capture, task.believed, progress.part(0.3, 1.0));
}

} // namespace lumorph::studio
