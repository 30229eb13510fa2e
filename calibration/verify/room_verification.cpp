#include "calibration/verify/room_verification.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

#include "calibration/lab/board_lab.h"
#include "core/base/error.h"

namespace lumorph {

namespace {

constexpr double kHalfRaised = 0.5;
constexpr double kFreshBend = 0.3; // of all actuators

/// Lenses as they were before the pictures were made smaller.
Installation withLensesOf(Installation room, const Installation& original) {
    for (std::size_t i = 0; i < std::min(room.cameras.size(), original.cameras.size()); ++i) {
        const glm::dmat4 pose = room.cameras[i].camera.cameraFromWorld;
        room.cameras[i].camera = original.cameras[i].camera;
        room.cameras[i].camera.cameraFromWorld = pose;
    }
    return room;
}

class Verification {
public:
    Verification(const Rig& rig, const Installation& believed, DeviceBench& bench, const Progress& progress,
                 const VerifyOptions& options)
        : rig_(rig), original_(believed), believed_(photographedRoom(believed, options.cameraWidth)), bench_(bench),
          progress_(progress), options_(options) {}

    VerifiedRoom measure() {
        const std::vector<std::vector<double>> bends = checkBends(rig_);
        const double share = 0.7 / static_cast<double>(bends.size());
        std::vector<LitShot> shots;
        for (std::size_t i = 0; i < bends.size(); ++i) {
            const auto from = static_cast<double>(i);
            shots.push_back(photograph(believed_, bends[i], progress_.part(share * from, share * (from + 1.0))));
            if (!obstacle_) continue;
            result_.check = withoutVerdict(believed_, *obstacle_);
            return finished();
        }
        result_.check = checkRoom(rig_, believed_, shots, {}, progress_.part(0.7, 0.85));
        if (options_.isJudged && result_.check.verdict != RoomCheck::Verdict::none) judge();
        return finished();
    }

private:
    /// The light of all projectors on one bend, read as a room believes it to be.
    LitShot photograph(const Installation& believed, const std::vector<double>& commanded, const Progress& progress) {
        LitShot shot{standingStrokes(believed, rig_, commanded), {}};
        // All servos come from below: what the room believes of their play is so, too.
        bench_.stand(std::vector<double>(commanded.size(), 0.0), progress.part(0.0, 0.05));
        bench_.stand(commanded, progress.part(0.05, 0.1));
        const auto lamps = static_cast<double>(believed.projectors.size());
        for (std::size_t p = 0; p < believed.projectors.size() && !obstacle_; ++p) {
            if (!believed.projectors[p].enabled) continue;
            const double from = static_cast<double>(p) / lamps;
            const Progress part = progress.part(0.1 + 0.9 * from, 0.1 + 0.9 * (from + 1.0 / lamps));
            const glm::ivec2 panel = believed.projectors[p].camera.size;
            const CaptureOrder order = parsePattern(options_.pattern, {panel.x, panel.y});
            std::vector<cv::Mat> images = bench_.photograph(p, order, part);
            for (cv::Mat& image : images)
                fitPicture(image, original_.cameras.front().camera.size, believed_.cameras.front().camera.size);
            result_.photographs += static_cast<int>(images.size());
            ReadPass pass = readPass(images, order, expectedLight(rig_, believed, shot.strokes, p), p);
            obstacle_ = std::move(pass.obstacle);
            shot.points.insert(shot.points.end(), pass.points.begin(), pass.points.end());
        }
        return shot;
    }

    /// No correction is called good by the light that it was made from.
    void judge() {
        const Installation& room = result_.check.installation;
        const std::vector<double> bend(rig_.actuatorCount(), kFreshBend);
        const std::vector<LitShot> shots{photograph(room, bend, progress_.part(0.85, 1.0))};
        if (obstacle_) {
            result_.figures.push_back("what is left was not judged on another bend: " + sentenceOf(*obstacle_));
            return;
        }
        const std::vector<std::vector<double>> strokes{shots.front().strokes};
        constexpr double kStray = 0.02; // metres
        result_.fresh = summaryOf(lightErrors(rig_, room, room, shots, strokes, 0, kStray));
        char text[160];
        std::snprintf(text, sizeof text,
                      "on a bend that the check did not see the light is off by %.2f mm (median), "
                      "%.2f mm in 95 of 100 places",
                      1e3 * result_.fresh.median, 1e3 * result_.fresh.most);
        result_.figures.emplace_back(text);
    }

    VerifiedRoom finished() {
        result_.installation = withLensesOf(result_.check.installation, original_);
        result_.check.installation = result_.installation;
        return std::move(result_);
    }

    const Rig& rig_;
    Installation original_, believed_;
    DeviceBench& bench_;
    const Progress& progress_;
    const VerifyOptions& options_;
    std::optional<NoVerdict> obstacle_;
    VerifiedRoom result_;
};

} // namespace

std::vector<std::vector<double>> checkBends(const Rig& rig) {
    const std::size_t count = rig.actuatorCount();
    std::vector<std::vector<double>> bends(count > 1 ? 2 : 1, std::vector<double>(count, 0.0));
    for (std::size_t i = 0; i < count; ++i) bends[i % bends.size()][i] = kHalfRaised;
    return bends;
}

Installation photographedRoom(Installation room, int width) {
    if (room.projectors.empty()) throw InvalidInput("installation", "it has no projector", "add one in the studio");
    if (room.cameras.empty())
        throw InvalidInput("installation", "it has no camera", "calibrate projector and camera first");
    CalibratedCamera& camera = room.cameras.front().camera;
    if (camera.size.x > width) {
        const double height = static_cast<double>(width) * camera.size.y / camera.size.x;
        camera = withSize(camera, {width, static_cast<int>(std::lround(height))});
    }
    return room;
}

VerifiedRoom verifyRoom(const Rig& rig, const Installation& believed, DeviceBench& bench, const Progress& progress,
                        const VerifyOptions& options) {
    return Verification(rig, believed, bench, progress, options).measure();
}

} // namespace lumorph
