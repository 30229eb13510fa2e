#include "app/studio/calibration/table_bench.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <map>
#include <numbers>
#include <optional>
#include <span>
#include <thread>
#include <utility>

#include <QCoreApplication>
#include <QPointer>
#include <QTimer>

#include "calibration/capture/boards_at_table.h"
#include "calibration/capture/picture_light.h"
#include "calibration/capture/pose_capture.h"
#include "calibration/delays/flash_capture.h"
#include "calibration/light/camera_light.h"
#include "calibration/servos/servo_measurement.h"
#include "core/base/error.h"
#include "core/loop/tracked_room.h"

namespace lumorph::studio {
namespace {

constexpr int kAskMilliseconds = 30;
constexpr int kTries = 3;                                // at a photograph that was disturbed
constexpr auto kCalms = std::chrono::milliseconds(700);  // before the next
constexpr auto kStands = std::chrono::milliseconds(400); // after the last command nothing trembles any more
constexpr auto kPause = std::chrono::milliseconds(20);
constexpr Microseconds kLies{600'000}, kMostRestless{10'000'000};
constexpr std::size_t kFewestPoses = 8; // in that time
constexpr double kStillWithin = 5e-4;   // metres between the means of its halves, and as many radians a tenth of one

/// Runs `work` in the window's thread some time soon; never waits for it, as the window may wait for a measurement.
template <class Work> void inWindow(Work work) {
    QMetaObject::invokeMethod(qApp, std::move(work), Qt::QueuedConnection);
}

/// What is connected, as the thread that measures may know of it.
struct Driven {
    std::atomic<int> told = 0; ///< tickets of commands that the service has
    std::atomic<bool> isLive = true, isMoving = false;
};

/// Lives in the window's thread: hands commands to the service and looks how it goes.
class Driver : public QObject {
public:
    Driver(DeviceService& devices, std::shared_ptr<Driven> driven) : devices_(&devices), driven_(std::move(driven)) {
        auto* timer = new QTimer(this);
        connect(timer, &QTimer::timeout, this, [this] { look(); });
        timer->start(kAskMilliseconds);
    }
    ~Driver() override {
        if (devices_) devices_->endTest();
    }
    void tell(int ticket, const std::vector<double>& strokes) {
        for (std::size_t i = 0; devices_ && i < strokes.size(); ++i) devices_->test(i, strokes[i]);
        look();
        driven_->told = ticket;
    }

private:
    void look() {
        driven_->isLive = devices_ && devices_->status().phase == LinkPhase::live;
        driven_->isMoving = devices_ && devices_->movesToTest();
    }

    QPointer<DeviceService> devices_;
    std::shared_ptr<Driven> driven_;
};

/// Something that may be over when one looks again.
bool isPassing(Cause cause) {
    return cause == Cause::rigMoved || cause == Cause::exposureDrifts || cause == Cause::handInView ||
           cause == Cause::wrongOrder; // as a person in the light is called
}

void waitFor(std::chrono::milliseconds calm, const Progress& progress) {
    for (auto waited = std::chrono::milliseconds{0}; waited < calm; waited += kPause) {
        progress.throwIfCancelled();
        std::this_thread::sleep_for(kPause);
    }
}

/// Deleted in the window's thread, whoever lets go of it last.
template <class Owned> std::shared_ptr<Owned> ownedByWindow(std::unique_ptr<Owned> owned) {
    return std::shared_ptr<Owned>(owned.release(), [](Owned* last) { inWindow([last] { delete last; }); });
}

/// Bodies of a table that moves and is photographed: servos, projectors and the room's first camera.
class DeviceOnTable final : public DeviceBench {
public:
    DeviceOnTable(const TableParts& parts, const Installation& room)
        : open_(parts.openCamera), clock_(parts.clock), address_(room.cameras.front().address),
          driver_(ownedByWindow(std::make_unique<Driver>(*parts.devices, driven_))) {
        for (std::size_t k = 0; k < room.projectors.size(); ++k)
            if (room.projectors[k].enabled) displays_[k] = ownedByWindow(parts.openDisplay(k));
    }

    [[nodiscard]] CaptureCamera& camera() {
        if (!camera_) camera_ = open_(address_);
        return *camera_;
    }
    /// Null: it is off.
    [[nodiscard]] PatternDisplay* display(std::size_t projector) const {
        const auto found = displays_.find(projector);
        return found == displays_.end() ? nullptr : found->second.get();
    }
    [[nodiscard]] const std::shared_ptr<const Clock>& clock() const { return clock_; }

    /// By a projector's white, once: a camera that was off since it was calibrated has forgotten it.
    void findExposureBy(PatternDisplay& display, const Progress& progress) {
        if (std::exchange(isExposed_, true)) return;
        display.show(cv::Mat(display.size(), CV_8U, cv::Scalar(255)), progress);
        CaptureCamera& eye = camera();
        waitFor(kCalms, progress); // how late a picture is, nobody has measured yet
        (void)findExposure(eye, progress);
    }

    void stand(std::span<const double> commanded, const Progress& progress) override {
        progress.report(0.0, "hands off: the servos move");
        const int ticket = ++tickets_;
        inWindow([driver = driver_, ticket, strokes = std::vector<double>(commanded.begin(), commanded.end())] {
            driver->tell(ticket, strokes);
        });
        auto still = std::chrono::steady_clock::now();
        while (driven_->told != ticket || driven_->isMoving || std::chrono::steady_clock::now() - still < kStands) {
            progress.throwIfCancelled();
            if (!driven_->isLive)
                throw DeviceError("servos", "they are not driven any more", "start them in Devices, and measure again");
            if (driven_->told != ticket || driven_->isMoving) still = std::chrono::steady_clock::now();
            std::this_thread::sleep_for(kPause);
        }
    }

    [[nodiscard]] std::vector<cv::Mat> photograph(std::size_t projector, const CaptureOrder& order,
                                                  const Progress& progress) override {
        const auto lit = displays_.find(projector);
        if (lit == displays_.end())
            throw InvalidInput("projector " + std::to_string(projector + 1), "it is switched off", "switch it on");
        for (auto& [k, display] : displays_)
            if (k != projector) display->show(cv::Mat::zeros(display->size(), CV_8U), progress);
        findExposureBy(*lit->second, progress);
        auto& [captured, capture] = captures_[projector];
        if (!capture || !(captured == order)) {
            PoseCaptureSettings settings;
            settings.order = captured = order;
            settings.clock = clock_;
            settings.triesWhenLate = kTries;
            capture = std::make_unique<PoseCapture>(camera(), *lit->second, std::move(settings));
        }
        // Whoever measures for minutes, alone, is not to begin anew for somebody who walked past once.
        for (int left = kTries - 1;; --left) {
            progress.report(0.0, "photographing");
            CapturedPose pose = capture->capture("check", progress);
            if (pose.isSound()) return std::move(pose.images);
            if (left == 0 || !isPassing(pose.findings.refusal->cause)) throw CaptureRefused(*pose.findings.refusal);
            waitFor(kCalms, progress);
        }
    }

private:
    std::function<std::unique_ptr<CaptureCamera>(const std::string&)> open_;
    std::shared_ptr<const Clock> clock_;
    std::string address_;
    std::shared_ptr<Driven> driven_ = std::make_shared<Driven>();
    std::shared_ptr<Driver> driver_;
    int tickets_ = 0;
    bool isExposed_ = false;
    std::map<std::size_t, std::shared_ptr<PatternDisplay>> displays_;
    std::unique_ptr<CaptureCamera> camera_; ///< opened by the first photograph
    std::map<std::size_t, std::pair<CaptureOrder, std::unique_ptr<PoseCapture>>> captures_;
};

/// What is connected as a bench of the stages.
class TableBench final : public Bench {
public:
    TableBench(const TableParts& parts, const Installation& room, bool isMoved)
        : table_(parts, room), isSimulated_(isSimulatedCamera(room.cameras.front().address) ||
                                            (isMoved && parts.devices->profile().address.starts_with("sim://"))),
          camera_(room.cameras.front().address), board_(parts.board), drawSeconds_(parts.drawSeconds()) {}

    [[nodiscard]] RecordingSource source() const override {
        return {isSimulated_ ? RecordingSource::Kind::rehearsal : RecordingSource::Kind::table, "camera " + camera_,
                utcDate(), 0};
    }
    [[nodiscard]] BoardsCapture recordBoards(const StageSite& site, const Progress& progress) override {
        BoardsAtTable boards;
        boards.camera = &table_.camera();
        boards.cameraName = site.room.cameras.front().name;
        for (std::size_t k = 0; k < site.room.projectors.size(); ++k)
            if (PatternDisplay* display = table_.display(k))
                boards.projectors.push_back({site.room.projectors[k].name, display});
        if (!boards.projectors.empty()) table_.findExposureBy(*boards.projectors.front().display, progress);
        boards.board = board_;
        boards.clock = table_.clock();
        return captureBoards(boards, progress);
    }
    [[nodiscard]] std::vector<ProjectorPoint> look(const StageSite& site, const std::vector<double>& commanded,
                                                   const Progress& progress) override {
        return lookBy(table_, site.room, commanded, progress);
    }
    [[nodiscard]] int picturesOfLook(const StageSite& site) const override {
        return lumorph::picturesOfLook(site.room);
    }
    [[nodiscard]] DeviceBench& device(const StageSite&) override { return table_; }
    [[nodiscard]] LightBench& light(const StageSite& site, const std::optional<WhiteSheet>&,
                                    const Progress& progress) override {
        std::vector<PatternDisplay*> displays;
        std::vector<std::string> names;
        for (std::size_t k = 0; k < site.room.projectors.size(); ++k) {
            displays.push_back(table_.display(k));
            names.push_back(site.room.projectors[k].name);
        }
        return light_.emplace(table_.camera(), std::move(displays), std::move(names), progress, table_.clock());
    }
    /// Of light alone: who would turn a board and carry a mark is not guided here.
    [[nodiscard]] DelaysCapture recordDelays(const StageSite&, const Progress& progress) override {
        PatternDisplay* display = table_.display(0);
        if (!display) throw InvalidInput("projector 1", "it is switched off", "switch it on");
        if (!(drawSeconds_ > 0.0))
            throw DeviceError("the show", "nothing was drawn yet, so nobody knows how long that takes",
                              "let it run on the projector for some seconds, then measure again");
        DelaysCapture capture;
        capture.flashes = recordFlashes(table_.camera(), *display, drawSeconds_, progress);
        capture.seconds = capture.flashes.pictures.empty() ? 0.0 : capture.flashes.pictures.back().seconds;
        return capture;
    }

private:
    DeviceOnTable table_;
    std::optional<CameraLight> light_; ///< before the table goes
    bool isSimulated_;
    std::string camera_, board_;
    double drawSeconds_;
};

/// What stands in the way of a measurement.
struct Missing {
    QString why, remedy;
};
std::optional<Missing> missingOn(const Installation& room, const DeviceService& devices, bool isMoved) {
    if (room.projectors.empty())
        return Missing{QObject::tr("The room has no projector"), QObject::tr("add one in Scene")};
    if (room.cameras.empty() || room.cameras.front().address.empty())
        return Missing{QObject::tr("The room has no camera of this machine"),
                       QObject::tr("calibrate projector and camera with it first")};
    if (isMoved && devices.status().phase != LinkPhase::live)
        return Missing{QObject::tr("The servos are not driven"), QObject::tr("connect and start them in Devices")};
    return std::nullopt;
}

/// Of poses that are much alike.
Pose meanOf(std::span<const PoseSample> samples) {
    Pose mean{glm::dvec3(0.0), glm::dquat(0.0, 0.0, 0.0, 0.0)};
    for (const PoseSample& one : samples) {
        mean.position += one.pose.position / static_cast<double>(samples.size());
        const double sign = glm::dot(one.pose.rotation, samples.front().pose.rotation) < 0.0 ? -1.0 : 1.0;
        mean.rotation += sign * one.pose.rotation;
    }
    mean.rotation = glm::normalize(mean.rotation);
    return mean;
}

/// Where it lay, if it lay still all that time.
std::optional<Pose> restOf(std::span<const PoseSample> samples) {
    if (samples.size() < kFewestPoses) return std::nullopt;
    const std::size_t half = samples.size() / 2;
    const Pose before = meanOf(samples.first(half)), after = meanOf(samples.subspan(half));
    const double turn = glm::angle(glm::normalize(after.rotation * glm::inverse(before.rotation)));
    const double off =
        glm::distance(before.position, after.position) + 0.1 * std::min(turn, 2.0 * std::numbers::pi - turn);
    if (off > kStillWithin) return std::nullopt;
    return meanOf(samples);
}

} // namespace

Installation withRestingDevice(Installation room, const PoseBoard& poses, const Progress& progress) {
    const std::vector<PoseBoard::Entry> entries = poses.entries();
    const auto device = std::ranges::find(entries, PoseRole::device, &PoseBoard::Entry::role);
    if (device == entries.end())
        throw DeviceError("the device", "no tracker sees it", "bring it into sight, and measure again");
    progress.report(0.0, "waiting for the device to lie still");
    std::vector<PoseSample> seen;
    const auto begun = std::chrono::steady_clock::now();
    while (std::chrono::steady_clock::now() - begun < kMostRestless) {
        progress.throwIfCancelled();
        std::this_thread::sleep_for(kPause);
        const std::optional<PoseSample> now = device->stream->latest();
        if (!now || !now->valid || (!seen.empty() && now->time <= seen.back().time)) continue;
        seen.push_back(*now);
        if (now->time - seen.front().time < kLies) continue;
        if (const std::optional<Pose> rest = restOf(seen)) {
            room.worldFromDevice = glm::mat4(matrixOf(inRoom(room, PoseRole::device, *rest)));
            return room;
        }
        std::erase_if(seen, [&](const PoseSample& one) { return one.time < now->time - kLies; });
    }
    throw DeviceError("the device", seen.empty() ? "the tracker does not see it" : "it does not come to rest",
                      "put it down where the tracker sees it, keep your hands off, and measure again");
}

QString tableObstacle(const Installation& room, const DeviceService& devices, bool isMoved) {
    const std::optional<Missing> missing = missingOn(room, devices, isMoved);
    return missing ? QObject::tr("%1: %2.").arg(missing->why, missing->remedy) : QString();
}

std::shared_ptr<Bench> openTable(const TableParts& parts, const Installation& room, bool isMoved) {
    if (const std::optional<Missing> missing = missingOn(room, *parts.devices, isMoved))
        throw DeviceError("device on the table", missing->why.toStdString(), missing->remedy.toStdString());
    return std::make_shared<TableBench>(parts, room, isMoved);
}

} // namespace lumorph::studio
