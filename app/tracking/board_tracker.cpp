#include "app/tracking/board_tracker.h"

#include <algorithm>
#include <utility>

#include "calibration/tracking/camera_source.h"
#include "calibration/tracking/camera_tracker.h"
#include "devices/trackers/tracker_log.h"

namespace lumorph {

namespace {

std::string nameOf(const std::string& source) {
    if (!isCameraPath(source)) return "the video " + source;
    const auto cameras = listCameras();
    const auto found = std::ranges::find(cameras, source, &CameraInfo::path);
    return (found == cameras.end() ? "a camera" : found->name) + " at " + source;
}

TrackerFrame frameOf(const BoardAddress& address) {
    TrackerFrame frame;
    frame.bodies = {{0, address.body, false, {}}};
    return frame;
}

class BoardTracker final : public Tracker {
public:
    BoardTracker(const BoardAddress& address, const std::string& uri, TrackerOptions options)
        : options_(std::move(options)), source_(nameOf(address.source)), log_(uri, options_.clock),
          frame_(frameOf(address)),
          camera_({address, options_.clock, [this](const BoardPicture& picture) { take(picture); }}) {}

    [[nodiscard]] TrackerStatus status() const override {
        TrackerStatus status = log_.status();
        const CameraTrackerStatus seen = camera_.status();
        status.advice = seen.advice;
        if (seen.open) status.source = source_;
        auto camera = std::make_shared<TrackerCamera>();
        camera->size = seen.size;
        camera->picturesPerSecond = seen.picturesPerSecond;
        camera->foundShare = seen.foundShare;
        if (seen.sighting) camera->reprojectionError = seen.sighting->reprojectionError;
        camera->lens = seen.assumptions;
        camera->preview = seen.preview;
        status.camera = std::move(camera);
        return status;
    }

private:
    void take(const BoardPicture& picture);

    TrackerOptions options_;
    std::string source_;
    TrackerLog log_;
    TrackerFrame frame_;
    CameraTracker camera_; ///< last: its thread ends before what it uses
};

void BoardTracker::take(const BoardPicture& picture) {
    TrackedBody& body = frame_.bodies.front();
    frame_.number = picture.number;
    frame_.measured = picture.seen;
    frame_.arrived = options_.clock->now();
    body.valid = picture.pose.has_value();
    if (picture.pose) body.pose = *picture.pose;
    log_.notePacket();
    log_.noteFrame(frame_, 1e-3 * static_cast<double>((frame_.arrived - frame_.measured).count()));
    if (options_.onFrame) options_.onFrame(frame_);
}

} // namespace

std::unique_ptr<Tracker> openBoard(const BoardAddress& address, const std::string& uri, TrackerOptions options) {
    return std::make_unique<BoardTracker>(address, uri, std::move(options));
}

} // namespace lumorph
