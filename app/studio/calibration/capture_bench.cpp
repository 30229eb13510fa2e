#include "app/studio/calibration/capture_bench.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <glm/gtc/matrix_transform.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "calibration/capture/picture_light.h"
#include "calibration/lab/lab_capture.h"
#include "calibration/lab/true_room.h"
#include "core/base/clock.h"
#include "core/base/error.h"

namespace lumorph::studio {
namespace {

constexpr int kLabSpare = 6; // poses beyond those that are wanted
constexpr int kLabCameraWidth = 1280;
constexpr std::uint32_t kLabSeed = 20;
constexpr double kGuideFocal = 1.3;  // of the picture's width, while nothing is known
constexpr double kGuideAspect = 1.6; // of a usual picture, for which the outlines were drawn
constexpr double kRadians = std::numbers::pi / 180.0;

cv::Mat whiteOf(cv::Size size) { return {size, CV_8U, cv::Scalar(255)}; }

/// The lab has a time of its own: a picture takes a tenth of a second, however long it takes to work it out.
class LabTimeCamera final : public CaptureCamera {
public:
    LabTimeCamera(BoardLab& lab, std::shared_ptr<ManualClock> clock)
        : camera_(openLabCamera(lab)), clock_(std::move(clock)) {}
    [[nodiscard]] cv::Mat grab(const Progress& progress) override {
        cv::Mat picture = camera_->grab(progress);
        clock_->advance(Microseconds{100'000});
        return picture;
    }
    [[nodiscard]] std::string name() const override { return camera_->name(); }
    [[nodiscard]] cv::Size size() const override { return camera_->size(); }

private:
    std::unique_ptr<CaptureCamera> camera_;
    std::shared_ptr<ManualClock> clock_;
};

class LabBench final : public CaptureBench {
public:
    LabBench(const CalibrationSetup& setup, const Installation& room, const Progress& progress)
        : setup_(setup), saidSpacing_(setup.board.spacing), truth_(labTruth(room, setup.installed)),
          lab_(truth_, setup.board, {}, kLabSeed), camera_(lab_, clock_), display_(openLabDisplay(lab_)),
          poses_(lab_.proposePoses(setup.poses + kLabSpare, progress.part(0.1, 0.9))) {
        if (!setup.fault) return;
        LabCapture capture;
        capture.room = truth_;
        capture.board = boardText(setup.board);
        capture.pattern = setup.pattern;
        capture.poses = setup.poses;
        capture.seed = kLabSeed;
        capture.fault = setup.fault;
        faulty_ = std::make_unique<LabCapturer>(std::move(capture));
    }

    [[nodiscard]] CapturedPose capture(int pose, const std::function<void(const Shot&)>& onShot,
                                       const Progress& progress) override {
        lab_.lay(wanted_.value_or(poses_[indexOf(pose)]));
        // Once the fault was told it is mended: what is photographed again is sound.
        if (faulty_ && pose == faultyPoses_ && pose < setup_.poses) return captureFaulty(pose, onShot, progress);
        if (!capturer_) {
            const glm::ivec2 size = lab_.projector().camera.size;
            PoseCaptureSettings settings;
            settings.order = parsePattern(setup_.pattern, {size.x, size.y});
            settings.board = setup_.board;
            settings.clock = clock_;
            settings.onShot = [this](const Shot& shot) {
                if (onShot_) onShot_(shot);
            };
            capturer_ = std::make_unique<PoseCapture>(camera_, *display_, std::move(settings));
        }
        onShot_ = onShot;
        CapturedPose captured = capturer_->capture(nameOfPose(pose), progress);
        onShot_ = nullptr;
        return captured;
    }

    [[nodiscard]] cv::Mat look(const Progress& progress) override {
        display_->show(whiteOf(display_->size()), progress);
        cv::Mat picture = camera_.grab(progress);
        display_->clear();
        return picture;
    }
    [[nodiscard]] bool isLive() const override { return false; }

    [[nodiscard]] BoardOutline ghost(int pose, const cv::Rect& /*lit*/) const override {
        BoardOutline outline;
        for (const cv::Point3d& corner : cornersOf(setup_.board)) {
            const double metres = lab_.options().metresPerUnit;
            const glm::dvec4 point(metres * corner.x, metres * corner.y, 0.0, 1.0);
            if (const auto pixel = lab_.cameraPixel(glm::dvec3(wanted_.value_or(poses_[indexOf(pose)]) * point)))
                outline.emplace_back(pixel->x, pixel->y);
        }
        return outline;
    }
    [[nodiscard]] const Installation* truth() const override { return &truth_; }
    void setBoard(const CalibrationBoard& board) override { saidSpacing_ = board.spacing; }
    void setWanted(const std::optional<PoseVector>& cameraFromBoard) override {
        wanted_.reset();
        if (!cameraFromBoard) return;
        const PoseVector& pose = *cameraFromBoard;
        cv::Matx33d turn;
        cv::Rodrigues(cv::Vec3d(pose[0], pose[1], pose[2]), turn);
        glm::dmat4 matrix(1.0);
        for (int row = 0; row < 3; ++row) {
            for (int column = 0; column < 3; ++column) matrix[column][row] = turn(row, column);
            // The lab's board is as large as it was printed, whatever is said of it later.
            matrix[3][row] = lab_.options().metresPerUnit * setup_.board.spacing / saidSpacing_ *
                             pose[3 + static_cast<std::size_t>(row)];
        }
        wanted_ = glm::inverse(lab_.camera().cameraFromWorld) * matrix;
    }

private:
    [[nodiscard]] CapturedPose captureFaulty(int pose, const std::function<void(const Shot&)>& onShot,
                                             const Progress& progress) {
        ++faultyPoses_;
        CapturedPose captured;
        captured.name = nameOfPose(pose);
        const std::vector<LabShot> shots = faulty_->takeNext(progress);
        const glm::ivec2 size = lab_.projector().camera.size;
        ShotCheck check(parsePattern(setup_.pattern, {size.x, size.y}), captured.name, setup_.board);
        for (const LabShot& shot : shots) {
            progress.throwIfCancelled();
            captured.images.push_back(shot.grey);
            captured.files.push_back(shot.file);
            if (!check.findings().refusal) check.look(shot.grey, shot.file);
        }
        if (!check.findings().refusal) check.finish();
        captured.findings = check.findings();
        if (!shots.empty() && onShot)
            onShot({static_cast<int>(shots.size()) - 1, static_cast<int>(shots.size()), shots.back().grey,
                    shots.back().file});
        return captured;
    }

    [[nodiscard]] std::size_t indexOf(int pose) const {
        return static_cast<std::size_t>(std::max(0, pose)) % poses_.size();
    }

    CalibrationSetup setup_;
    double saidSpacing_; ///< of the board, which may be another than it truly has
    Installation truth_;
    BoardLab lab_;
    std::shared_ptr<ManualClock> clock_ = std::make_shared<ManualClock>();
    LabTimeCamera camera_;
    std::unique_ptr<PatternDisplay> display_;
    std::vector<glm::dmat4> poses_;
    std::optional<glm::dmat4> wanted_; ///< the world from the board, metres
    std::unique_ptr<LabCapturer> faulty_;
    int faultyPoses_ = 0;
    std::function<void(const Shot&)> onShot_;
    std::unique_ptr<PoseCapture> capturer_;
};

/// Lit areas may be high and narrow, or low and wide, and so may boards.
BoardOutline movedInto(const cv::Rect& area, BoardOutline outline) {
    const auto [left, right] = std::ranges::minmax(outline, {}, &cv::Point2d::x);
    const auto [top, bottom] = std::ranges::minmax(outline, {}, &cv::Point2d::y);
    const double scale = std::min({1.0, area.width / (right.x - left.x), area.height / (bottom.y - top.y)});
    const cv::Point2d middle(0.5 * (left.x + right.x), 0.5 * (top.y + bottom.y));
    const cv::Point2d half(0.5 * scale * (right.x - left.x), 0.5 * scale * (bottom.y - top.y));
    const auto between = [](double at, double least, double most) { return std::max(least, std::min(at, most)); };
    const cv::Point2d moved(between(middle.x, area.x + half.x, area.x + area.width - half.x),
                            between(middle.y, area.y + half.y, area.y + area.height - half.y));
    for (cv::Point2d& point : outline) point = moved + scale * (point - middle);
    return outline;
}

class CameraBench final : public CaptureBench {
public:
    CameraBench(const CalibrationSetup& setup, const CameraOpener& open, std::shared_ptr<PatternDisplay> display)
        : setup_(setup), display_(std::move(display)), camera_(open(setup.camera)) {}

    [[nodiscard]] CapturedPose capture(int pose, const std::function<void(const Shot&)>& onShot,
                                       const Progress& progress) override {
        if (!capturer_) {
            PoseCaptureSettings settings;
            settings.order = parsePattern(setup_.pattern, display_->size());
            settings.board = setup_.board;
            settings.triesWhenLate = 3;
            settings.onShot = [this](const Shot& shot) {
                if (onShot_) onShot_(shot);
            };
            capturer_ = std::make_unique<PoseCapture>(*camera_, *display_, std::move(settings));
        }
        if (!isExposed_) light(progress);
        isLit_ = false;
        onShot_ = onShot;
        CapturedPose captured = capturer_->capture(nameOfPose(pose), progress);
        onShot_ = nullptr;
        try {
            light(progress);
        } catch (const std::exception&) { // the pose is kept; whoever looks next is told
        }
        return captured;
    }

    [[nodiscard]] cv::Mat look(const Progress& progress) override {
        if (!isLit_) light(progress);
        cv::Mat picture = greyOf(camera_->grab(progress)).clone();
        size_ = picture.size();
        return picture;
    }
    void setBoard(const CalibrationBoard& board) override {
        if (board == setup_.board) return;
        setup_.board = board;
        capturer_.reset();
    }
    [[nodiscard]] bool isLive() const override { return camera_->isLive(); }
    [[nodiscard]] BoardOutline ghost(int pose, const cv::Rect& lit) const override {
        const cv::Size size = size_.empty() ? camera_->size() : size_;
        if (size.empty()) return {};
        return guideOutline(setup_.board, lit.empty() ? cv::Rect({}, size) : lit, kGuideFocal * size.width, pose);
    }
    [[nodiscard]] std::vector<std::string> automatics() const override { return camera_->automatics(); }

private:
    /// White light, also between two photographs: drawing the show would take time from the solver. The first time the
    /// exposure is set by it, and kept.
    void light(const Progress& progress) {
        display_->show(whiteOf(display_->size()), progress);
        isLit_ = true;
        if (!isExposed_) (void)findExposure(*camera_, progress);
        isExposed_ = true;
    }

    CalibrationSetup setup_;
    std::shared_ptr<PatternDisplay> display_;
    std::unique_ptr<CaptureCamera> camera_;
    std::function<void(const Shot&)> onShot_;
    std::unique_ptr<PoseCapture> capturer_;
    bool isLit_ = false;
    bool isExposed_ = false;
    cv::Size size_;
};

} // namespace

std::vector<cv::Point3d> cornersOf(const CalibrationBoard& board) {
    const std::vector<cv::Point3d> points = pointsOf(board);
    double right = 0.0, bottom = 0.0;
    for (const cv::Point3d& point : points) right = std::max(right, point.x), bottom = std::max(bottom, point.y);
    return {{0.0, 0.0, 0.0}, {right, 0.0, 0.0}, {right, bottom, 0.0}, {0.0, bottom, 0.0}};
}

BoardOutline guideOutline(const CalibrationBoard& board, const cv::Rect& area, double focal, int pose) {
    struct Guide {
        double aboutX, aboutY, aboutZ; // degrees
        double x, y;                   // of its middle, shares of the area from its middle
        double width;                  // share of the area's
    };
    static constexpr std::array kGuides{Guide{0, 0, 0, 0, 0, 0.5},
                                        Guide{32, 0, 0, 0, -0.12, 0.5},
                                        Guide{-32, 0, 0, 0, 0.12, 0.5},
                                        Guide{0, 32, 0, -0.14, 0, 0.5},
                                        Guide{0, -32, 0, 0.14, 0, 0.5},
                                        Guide{22, 22, 25, -0.15, -0.12, 0.42},
                                        Guide{-22, -22, -25, 0.15, 0.12, 0.42},
                                        Guide{22, -22, 0, 0.15, -0.12, 0.42},
                                        Guide{-22, 22, 0, -0.15, 0.12, 0.42}};
    const Guide& guide = kGuides[static_cast<std::size_t>(pose) % kGuides.size()];
    std::vector<cv::Point3d> corners = cornersOf(board);
    const cv::Point3d far = corners[2];
    const double widest = std::min<double>(area.width, kGuideAspect * area.height);
    const double distance = focal * far.x / (guide.width * widest);
    cv::Mat about[3];
    cv::Rodrigues(cv::Vec3d(guide.aboutX * kRadians, 0, 0), about[0]);
    cv::Rodrigues(cv::Vec3d(0, guide.aboutY * kRadians, 0), about[1]);
    cv::Rodrigues(cv::Vec3d(0, 0, guide.aboutZ * kRadians), about[2]);
    const cv::Matx33d turn = cv::Mat(about[2] * about[1] * about[0]);
    BoardOutline outline;
    for (const cv::Point3d& corner : corners) {
        const cv::Vec3d point =
            turn * cv::Vec3d(corner.x - 0.5 * far.x, corner.y - 0.5 * far.y, 0.0) + cv::Vec3d(0, 0, distance);
        outline.emplace_back(area.x + (0.5 + guide.x) * area.width + focal * point[0] / point[2],
                             area.y + (0.5 + guide.y) * area.height + focal * point[1] / point[2]);
    }
    return movedInto(area, std::move(outline));
}

std::shared_ptr<CaptureBench> openLabBench(const CalibrationSetup& setup, const Installation& room,
                                           const Progress& progress) {
    progress.report(0.1, "setting up the lab");
    return std::make_shared<LabBench>(setup, room, progress);
}

std::shared_ptr<CaptureBench> openCameraBench(const CalibrationSetup& setup, const CameraOpener& open,
                                              std::shared_ptr<PatternDisplay> display, const Progress& progress) {
    progress.report(0.1, "opening the camera");
    return std::make_shared<CameraBench>(setup, open, std::move(display));
}

} // namespace lumorph::studio
