#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <QCoreApplication>

#include "app/cli/commands.h"
#include "app/tracking/any_tracker.h"
#include "calibration/tracking/board_address.h"
#include "calibration/tracking/board_page.h"
#include "calibration/tracking/camera_source.h"
#include "core/base/error.h"

namespace lumorph::cli {

namespace {

constexpr std::chrono::milliseconds kTrackPause{50}; ///< how soon Ctrl-C is seen
constexpr std::chrono::milliseconds kLineEvery{1000};
constexpr std::size_t kMostWaiting = 4096;

struct MonitorArguments {
    std::string uri;
    int frames = 0; ///< 0: until it is stopped
    bool json = false;
    bool open = false;
};

/// Frames on their way from the tracker's thread to the one that prints.
class FrameQueue {
public:
    void put(const TrackerFrame& frame) {
        const std::scoped_lock lock(mutex_);
        if (frames_.size() == kMostWaiting) frames_.pop_front(); // whoever reads does not keep up
        frames_.push_back(frame);
        arrived_.notify_one();
    }
    /// All that have come, after a short wait for the first.
    std::deque<TrackerFrame> take() {
        std::unique_lock lock(mutex_);
        arrived_.wait_for(lock, kTrackPause, [this] { return !frames_.empty(); });
        return std::exchange(frames_, {});
    }

private:
    std::mutex mutex_;
    std::condition_variable arrived_;
    std::deque<TrackerFrame> frames_;
};

nlohmann::json jsonOf(const TrackedBody& body) {
    const Pose& pose = body.pose;
    return {{"id", body.id},
            {"name", body.name},
            {"valid", body.valid},
            {"position", {pose.position.x, pose.position.y, pose.position.z}},
            {"rotation", {pose.rotation.x, pose.rotation.y, pose.rotation.z, pose.rotation.w}}};
}

nlohmann::json jsonOf(const TrackerFrame& frame) {
    nlohmann::json bodies = nlohmann::json::array();
    for (const TrackedBody& body : frame.bodies) bodies.push_back(jsonOf(body));
    return {{"frame", frame.number}, {"time", 1e-6 * static_cast<double>(frame.measured.count())}, {"bodies", bodies}};
}

void printBody(const TrackedBody& body) {
    const glm::dvec3& p = body.pose.position;
    std::printf("  %-20s %5d  %-5s  %8.3f %8.3f %8.3f m\n", body.name.c_str(), body.id, body.valid ? "seen" : "lost",
                p.x, p.y, p.z);
}

void printCamera(const TrackerCamera& camera) {
    std::printf("  %d x %d pixels, %.1f pictures/s, the board in %.0f %% of them", camera.size.x, camera.size.y,
                camera.picturesPerSecond, 100.0 * camera.foundShare);
    if (camera.reprojectionError)
        std::printf(", reprojection error %.2f px (%s)", *camera.reprojectionError, fitWord(*camera.reprojectionError));
    std::printf("\n");
}

void printStatus(const TrackerStatus& status) {
    std::printf("%s%s: %.1f frames/s, %.1f packets/s, %llu rejected",
                status.source.empty() ? "nobody yet" : status.source.c_str(),
                status.verified ? "" : " (a version that was never tried with real software)", status.framesPerSecond,
                status.packetsPerSecond, static_cast<unsigned long long>(status.rejected));
    if (status.latencyMilliseconds) std::printf(", %.1f ms late", *status.latencyMilliseconds);
    std::printf("\n");
    if (status.camera && status.camera->size.x > 0) printCamera(*status.camera);
    if (!status.advice.empty()) std::printf("  ! %s\n", status.advice.c_str());
    for (const TrackedBody& body : status.bodies) printBody(body);
    finishOutput();
}

/// Where only frames go to standard output, advice goes beside it, each once.
void printAdvice(const std::string& advice, std::string& before) {
    if (advice == before) return;
    before = advice;
    if (!advice.empty()) printWarnings({advice});
}

/// Ctrl-C is how a monitor without an end is ended: that is no failure.
void tellEnd(const MonitorArguments& arguments, const TrackerStatus& status, int seen, double seconds) {
    std::fprintf(stderr, "lumorph: stopped after %.1f s: %d frames in %llu packets, %llu of them rejected\n", seconds,
                 seen, static_cast<unsigned long long>(status.packets),
                 static_cast<unsigned long long>(status.rejected));
    if (arguments.frames > 0)
        throw DeviceError("tracker " + arguments.uri,
                          "it was stopped after " + std::to_string(seen) + " of " + std::to_string(arguments.frames) +
                              " frames",
                          status.advice.empty() ? "give it more time" : status.advice);
}

void monitorTracker(const MonitorArguments& arguments, const Session& session) {
    int count = 1;
    char name[] = "lumorph";
    char* words[] = {name, nullptr};
    const QCoreApplication application(count, words); // sockets need it
    FrameQueue queue;
    TrackerOptions options;
    options.openToNetwork = arguments.open;
    options.onFrame = [&queue](const TrackerFrame& frame) { queue.put(frame); };
    const std::unique_ptr<Tracker> tracker = openAnyTracker(arguments.uri, std::move(options));
    std::string advice, lens;
    int seen = 0;
    const auto isDone = [&] { return arguments.frames > 0 && seen >= arguments.frames; };
    const auto began = std::chrono::steady_clock::now();
    try {
        for (auto next = began + kLineEvery; !isDone();) {
            session.throwIfCancelled();
            for (const TrackerFrame& frame : queue.take()) {
                if (isDone()) break;
                ++seen;
                if (arguments.json) printJson(jsonOf(frame));
            }
            if (std::chrono::steady_clock::now() < next && !isDone()) continue;
            next += kLineEvery;
            const TrackerStatus status = tracker->status();
            if (status.camera) printAdvice(status.camera->lens, lens);
            arguments.json ? printAdvice(status.advice, advice) : printStatus(status);
        }
    } catch (const Cancelled&) {
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began;
        tellEnd(arguments, tracker->status(), seen, took.count());
    }
}

void addMonitor(CLI::App& group, const Session& session) {
    auto arguments = std::make_shared<MonitorArguments>();
    CLI::App* command = group.add_subcommand("monitor", "Print what a tracker sends, and why nothing arrives");
    command
        ->add_option("uri", arguments->uri,
                     "natnet://HOST, opentrack://127.0.0.1:4242, osc://127.0.0.1:9000, sim://head, or "
                     "board://camera0?squares=5x7&size=30&marker=22 for a printed board before a camera or, with its "
                     "whole path, in a video")
        ->required();
    command->add_option("--frames", arguments->frames, "Stop after so many frames")
        ->check(CLI::Range(1, 1'000'000'000));
    command->add_flag("--json", arguments->json, "Print one JSON value a frame, a line each");
    command->add_flag("--open", arguments->open, "Take packets from other machines as well");
    command->callback([arguments, &session] { monitorTracker(*arguments, session); });
}

void addCameras(CLI::App& group) {
    CLI::App* command = group.add_subcommand("cameras", "List the cameras of this machine");
    auto json = std::make_shared<bool>(false);
    command->add_flag("--json", *json, "Print JSON");
    command->callback([json] {
        const std::vector<CameraInfo> cameras = listCameras();
        nlohmann::json all = nlohmann::json::array();
        for (const CameraInfo& camera : cameras) {
            all.push_back({{"path", camera.path}, {"name", camera.name}});
            if (!*json) std::printf("board://%s  %s\n", camera.path.c_str(), camera.name.c_str());
        }
        if (*json) printJson(all);
        if (cameras.empty() && !*json) std::printf("No camera is connected.\n");
        finishOutput();
    });
}

void addBoard(CLI::App& group) {
    CLI::App* command = group.add_subcommand("board", "Write a marker board to print, as PDF of true size");
    auto words = std::make_shared<std::string>();
    auto output = std::make_shared<std::string>();
    command->add_option("output", *output, "PDF to write, or - for standard output")->required();
    command->add_option("--board", *words, "Its measures as in an address, such as squares=5x7&size=30&marker=22");
    command->callback([words, output] {
        checkOutput(*output, {});
        const MarkerBoard board = parseBoardWords(*words);
        writeOutput(*output, bytesOfText(boardPdf(board)));
        if (*output == "-") return;
        std::printf("%s: %s\nPrint it at 100 %%, fix it flat to the device, and open board://camera0?%s\n",
                    output->c_str(), wordsOf(board).c_str(), queryOf(board).c_str());
        finishOutput();
    });
}

} // namespace

void addTrackCommand(CLI::App& app, Session& session) {
    CLI::App* group = app.add_subcommand("track", "Look at what trackers send, and at recorded motion");
    group->require_subcommand(1);
    addMonitor(*group, session);
    addCameras(*group);
    addBoard(*group);
    addTrackReplay(*group, session);
}

} // namespace lumorph::cli
