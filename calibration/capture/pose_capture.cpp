#include "calibration/capture/pose_capture.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <system_error>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "core/base/atomic_file.h"
#include "core/base/confined_path.h"
#include "core/base/error.h"
#include "core/base/image.h"
#include "core/base/text.h"

namespace lumorph {

namespace {

constexpr int kSwitches = 6;
constexpr Microseconds kLearning{400'000}; // how long the first two pictures are watched at least
constexpr int kLearningFrames = 4;
constexpr int kMostFrames = 500;
constexpr int kStillFrames = 2;         // complete ones in a row end a switch
constexpr double kIncomplete = 0.04;    // of the change; below, it is seen completely
constexpr double kLeastContrast = 10.0; // grey levels

cv::Mat flat(cv::Size size, bool white) { return {size, CV_8U, cv::Scalar(white ? 255 : 0)}; }

/// Gives the screen back whatever happens.
class ScreenLoan {
public:
    explicit ScreenLoan(PatternDisplay& display) : display_(display) {}
    ScreenLoan(const ScreenLoan&) = delete;
    ScreenLoan& operator=(const ScreenLoan&) = delete;
    ~ScreenLoan() {
        try {
            display_.clear();
        } catch (const std::exception&) { // what went wrong before is told
        }
    }

private:
    PatternDisplay& display_;
};

/// How bright each frame is between black and white, where the projector's light falls.
class LightMeter {
public:
    LightMeter(const cv::Mat& black, const cv::Mat& white) {
        cv::Mat1f dark, bright;
        black.convertTo(dark, CV_32F);
        white.convertTo(bright, CV_32F);
        const cv::Mat1f change = bright - dark;
        double most = 0.0;
        cv::Mat1f calm; // single hot pixels
        cv::blur(change, calm, {5, 5});
        cv::minMaxLoc(calm, nullptr, &most);
        lit_ = calm > std::max(kLeastContrast, 0.5 * most);
        if (cv::countNonZero(lit_) * 500 < static_cast<int>(lit_.total())) return;
        dark_ = cv::mean(dark, lit_)[0];
        contrast_ = cv::mean(change, lit_)[0];
    }
    [[nodiscard]] double contrast() const { return contrast_; }
    [[nodiscard]] double levelOf(const cv::Mat& frame) const {
        if (frame.size() != lit_.size()) return -1.0;
        return (cv::mean(frame, lit_)[0] - dark_) / contrast_;
    }

private:
    cv::Mat1b lit_;
    double dark_ = 0.0, contrast_ = 0.0;
};

std::string fileNameOf(int index, const PatternImage& pattern) {
    char number[32];
    std::snprintf(number, sizeof number, "shot_%03d_", index);
    std::string words = wordsOf(pattern);
    std::ranges::replace(words, ' ', '-');
    return number + words + ".png";
}

} // namespace

PoseCapture::PoseCapture(CaptureCamera& camera, PatternDisplay& display, PoseCaptureSettings settings)
    : camera_(camera), display_(display), settings_(std::move(settings)) {
    if (settings_.order.images.empty())
        throw InvalidInput("capture", "has no patterns", "choose Gray code or phase shift");
    if (camera_.isLive() && display_.size() != settings_.order.projector)
        throw InvalidInput("capture", "the patterns are for another size than the projector's",
                           "make the patterns for this projector");
}

const SettleTime& PoseCapture::measureSettle(const Progress& progress) {
    if (!camera_.isLive()) return settle_.emplace();
    const ScreenLoan loan(display_);
    const Clock& clock = *settings_.clock;
    const auto tooSlow = [&](const std::string& why) {
        throw CaptureRefused({Cause::lateFrame, "", "", why,
                              "switch picture improvement off in the projector and automatics off in the camera"});
    };
    // What black and white look like once nothing changes any more.
    cv::Mat still[2];
    for (const bool white : {false, true}) {
        display_.show(flat(display_.size(), white), progress);
        const Microseconds shown = clock.now();
        cv::Mat before;
        for (int frame = 0;; ++frame) {
            progress.throwIfCancelled();
            cv::Mat now = greyOf(camera_.grab(progress)).clone();
            const bool isStill = !before.empty() && now.size() == before.size() &&
                                 std::abs(cv::mean(now)[0] - cv::mean(before)[0]) < 1.0;
            before = now;
            const Microseconds waited = clock.now() - shown;
            if (isStill && frame >= kLearningFrames && (waited >= kLearning || frame >= kMostFrames / 10)) break;
            if (waited > settings_.longestSettle + kLearning || frame >= kMostFrames)
                tooSlow("the picture does not come to rest");
        }
        still[white ? 1 : 0] = before;
        progress.report(white ? 0.4 : 0.2, "measuring how late the camera sees the projector");
    }
    if (still[0].size() != still[1].size())
        throw CaptureRefused(
            {Cause::imageSize, "", "", "the camera changes the size of its pictures", "fix its size, then try again"});
    const LightMeter meter(still[0], still[1]);
    if (meter.contrast() < kLeastContrast)
        throw CaptureRefused({Cause::boardUnlit, "", "", "white and black of the projector look the same to the camera",
                              "check that the projector shows this window, that its light falls into the camera's "
                              "picture, and that the camera exposes long enough"});
    SettleTime measured;
    measured.contrast = meter.contrast();
    for (int change = 0; change < kSwitches; ++change) {
        const bool white = change % 2 != 0; // white is on the screen
        display_.show(flat(display_.size(), white), progress);
        const Microseconds shown = clock.now();
        int late = 0;
        int steady = 0;
        Microseconds complete{0};
        for (int frame = 0; steady < kStillFrames; ++frame) {
            progress.throwIfCancelled();
            const Microseconds begun = clock.now() - shown;
            const double level = meter.levelOf(greyOf(camera_.grab(progress)));
            if (std::abs(level - (white ? 1.0 : 0.0)) < kIncomplete) {
                if (steady++ == 0) complete = begun;
            } else {
                steady = 0;
                late = frame + 1;
            }
            // Once it is seen, a camera may take its time to show it again.
            if (steady == 0 && (begun > settings_.longestSettle || frame >= kMostFrames))
                tooSlow("a new picture takes longer than " + std::to_string(settings_.longestSettle.count() / 1000) +
                        " ms to be seen completely");
        }
        measured.delay = std::max(measured.delay, complete);
        measured.lateFrames = std::max(measured.lateFrames, late);
        ++measured.switches;
        progress.report(0.4 + 0.1 * measured.switches, "measuring how late the camera sees the projector");
    }
    // A few switches need not have met the worst moment between two frames.
    measured.delay += measured.delay / 4;
    return settle_.emplace(measured);
}

cv::Mat PoseCapture::shoot(const cv::Mat& picture, const Progress& progress) {
    if (!camera_.isLive()) return greyOf(camera_.grab(progress));
    display_.show(picture, progress);
    const Microseconds due = settings_.clock->now() + settle_->delay;
    // Frames that come before are looked at by nobody; they are waited for, so that nothing sleeps here.
    for (int frame = 0; frame < settle_->lateFrames || settings_.clock->now() < due; ++frame) {
        progress.throwIfCancelled();
        (void)camera_.grab(progress);
        if (frame >= kMostFrames) break;
    }
    return greyOf(camera_.grab(progress)).clone();
}

std::optional<Finding> PoseCapture::scaling(const cv::Mat& white, const cv::Mat& black, const Progress& progress) {
    cv::Mat1b board(display_.size());
    for (int y = 0; y < board.rows; ++y)
        for (int x = 0; x < board.cols; ++x) board(y, x) = (x + y) % 2 != 0 ? 255 : 0;
    const cv::Mat one = shoot(board, progress);
    const cv::Mat other = shoot(255 - board, progress);
    if (one.size() != white.size() || other.size() != white.size()) return std::nullopt;
    return checkScaling(one, other, white, black);
}

void PoseCapture::capturePatterns(CapturedPose& pose, const Progress& progress) {
    ShotCheck check(settings_.order, pose.name, settings_.board);
    const auto count = static_cast<int>(settings_.order.images.size());
    if (camera_.isLive()) {
        const cv::Mat white = shoot(flat(display_.size(), true), progress);
        const cv::Mat black = shoot(flat(display_.size(), false), progress);
        check.lookAtLight(white, black);
        if (settings_.isScalingChecked && !isScalingKnown_ && !check.findings().refusal) {
            scalingWarning_ = scaling(white, black, progress);
            isScalingKnown_ = true;
        }
    }
    for (int i = 0; i < count && !check.findings().refusal; ++i) {
        progress.throwIfCancelled();
        const PatternImage& pattern = settings_.order.images[static_cast<std::size_t>(i)];
        const std::string file = fileNameOf(i, pattern);
        const cv::Mat image =
            shoot(camera_.isLive() ? drawPattern(pattern, settings_.order.projector) : cv::Mat(), progress);
        check.look(image, file);
        pose.images.push_back(image);
        pose.files.push_back(file);
        if (settings_.onShot) settings_.onShot({i, count, image, file});
        progress.report(static_cast<double>(i + 1) / (count + 1), wordsOf(pattern));
    }
    check.finish();
    pose.evenLight = check.evenLight();
    pose.findings = check.findings();
    if (scalingWarning_) {
        pose.findings.warnings.push_back(*scalingWarning_);
        pose.findings.warnings.back().view = pose.name;
    }
}

CapturedPose PoseCapture::capture(const std::string& name, const Progress& progress) {
    if (!settle_) measureSettle(progress.part(0.0, 0.1));
    for (int left = settings_.triesWhenLate - 1;; --left) {
        CapturedPose pose = captureOnce(name, progress.part(0.1, 1.0));
        if (left <= 0 || !camera_.isLive() || pose.isSound() || pose.findings.refusal->cause != Cause::lateFrame)
            return pose;
        // A machine that is busier than before shows its pictures later.
        const SettleTime before = *settle_;
        measureSettle(progress.part(0.0, 0.1));
        settle_->delay = std::max(settle_->delay, before.delay + before.delay / 2);
        settle_->lateFrames = std::max(settle_->lateFrames, before.lateFrames + 1);
    }
}

CapturedPose PoseCapture::captureOnce(const std::string& name, const Progress& progress) {
    CapturedPose pose;
    pose.name = name;
    const ScreenLoan loan(display_);
    try {
        capturePatterns(pose, progress);
    } catch (const CaptureRefused& refused) { // a file that cannot be read
        pose.findings.refusal = refused.finding();
        pose.findings.refusal->view = name;
    } catch (const DataError& error) { // a recording that ends too early
        pose.findings.refusal = Finding{Cause::missingImage, name, "", error.why(), error.remedy()};
    }
    return pose;
}

void savePose(const std::filesystem::path& folder, const CapturedPose& pose, const Progress& progress) {
    namespace fs = std::filesystem;
    const fs::path relative(pose.name);
    if (pose.name.empty() || pose.name.front() == '.' || !staysInside(relative) ||
        std::distance(relative.begin(), relative.end()) != 1)
        throw InvalidInput("pose " + inQuotes(pose.name), "is no name of a folder", "name it pose_1 or so");
    if (pose.images.empty() || pose.images.size() != pose.files.size())
        throw InvalidInput("pose " + inQuotes(pose.name), "has no images", "capture it first");
    std::error_code failed;
    fs::create_directories(folder, failed);
    if (failed) throwWriteError(folder, failed.value());
    // Names with a dot are no poses.
    const fs::path partial = folder / ("." + pose.name + ".partial");
    const fs::path before = folder / ("." + pose.name + ".before");
    fs::remove_all(partial, failed);
    try {
        if (!fs::create_directory(partial, failed)) throwWriteError(partial, failed.value());
        for (std::size_t i = 0; i < pose.images.size(); ++i) {
            progress.throwIfCancelled();
            writePng(imageOfGrey(pose.images[i]), partial / pose.files[i]);
            progress.report(static_cast<double>(i + 1) / static_cast<double>(pose.images.size()), "saving the pose");
        }
        fs::remove_all(before, failed);
        if (fs::exists(folder / relative)) {
            fs::rename(folder / relative, before, failed);
            if (failed) throwWriteError(folder / relative, failed.value());
        }
        fs::rename(partial, folder / relative, failed);
        if (failed) {
            const int reason = failed.value();
            fs::rename(before, folder / relative, failed);
            throwWriteError(folder / relative, reason);
        }
        fs::remove_all(before, failed);
    } catch (...) {
        fs::remove_all(partial, failed);
        throw;
    }
}

} // namespace lumorph
