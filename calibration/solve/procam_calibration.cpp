#include "calibration/solve/procam_calibration.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <sstream>
#include <utility>

#include <opencv2/calib3d.hpp>

#include "calibration/solve/first_guess.h"
#include "calibration/solve/held_out.h"

namespace lumorph {

namespace {

constexpr int kFewestViews = 3;
constexpr double kSimpler = 1.02;         // a model must be that much better on views left out to be worth its numbers
constexpr double kLeastTurnDegrees = 8.0; // between the two boards that are turned most against one another
constexpr double kWorstFocal = 0.05;      // standard deviation of a focal length, as a share of it
constexpr double kWorstPrincipal = 0.1;   // of a principal point, as a share of the image's width
constexpr double kWorstCorner = 0.02;     // what a distortion term may be uncertain by at the image's corner, likewise
constexpr int kPointsForChoice = 150;     // of a view
constexpr int kPointsForSolution = 600;
constexpr double kLeastSigma = 0.01; // pixels
constexpr double kMostNoise = 1.0;   // pixels: more than any noise
constexpr double kFits = 2.0;        // pixels: above, the model does not fit
constexpr double kPi = std::numbers::pi;

constexpr const char* kParameterNames[] = {"f", "aspect", "cx", "cy", "k1", "k2", "p1", "p2", "k3"};

ViewChoice allOf(const std::vector<ViewObservations>& views) {
    ViewChoice use(views.size());
    std::iota(use.begin(), use.end(), 0);
    return use;
}

double rmsOfNumbers(const std::vector<double>& numbers) {
    double sum = 0.0;
    for (const double number : numbers) sum += number * number;
    return numbers.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(numbers.size()));
}

/// Solves a capture step by step; the state is what is known so far.
class ProcamSolver {
public:
    ProcamSolver(const std::vector<ViewObservations>& views, cv::Size camera, cv::Size projector,
                 const SolveOptions& options, const Progress& progress)
        : views_(views), use_(allOf(views)), progress_(progress), options_(options) {
        result_.camera.size = camera;
        result_.projector.size = projector;
    }

    ProcamCalibration camera() {
        solveCamera();
        settle(false);
        report(false);
        return std::move(result_);
    }

    ProcamCalibration both() {
        solveCamera();
        solveProjector();
        settle(true);
        report(true);
        return std::move(result_);
    }

private:
    void solveCamera() {
        state_ = firstCamera(views_, use_, result_.camera.size, options_.cameraFocal);
        requireTilt();
        if (static_cast<int>(views_.size()) < kFewestViews)
            throw CaptureRefused({Cause::tooFewViews, "", "",
                                  std::to_string(views_.size()) + " poses of the board, but three are needed",
                                  "capture the board in more poses, tilted differently; six are good"});
        bundle_.projectorPoints = false;
        const auto held = [this] { return heldOutCorners(views_, use_, bundle_, state_); };
        result_.camera.model = chooseModel(cameraPart(), held, 0.02, 0.3);
        estimateNoise();
    }

    void solveProjector() {
        addFirstProjector(views_, use_, result_.projector.size, options_.projectorFocal, state_);
        bundle_.projectorPoints = true;
        bundle_.most = kPointsForChoice;
        bundle_.projector = lensModels()[1].free;
        refine(views_, use_, bundle_, state_);
        estimateNoise();
        const auto held = [this] { return heldOutTransfers(views_, use_, bundle_, state_); };
        result_.projector.model = chooseModel(projectorPart(), held, 0.3, 0.7);
        bundle_.most = kPointsForSolution;
    }

    /// One of the two devices: what is known of it, and what of it may move.
    struct Part {
        CalibratedDevice& device;
        LensMask& mask;
        Lens& lens;
        const char* name;
    };
    Part cameraPart() { return {result_.camera, bundle_.camera, state_.camera, "camera"}; }
    Part projectorPart() { return {result_.projector, bundle_.projector, state_.projector, "projector"}; }

    /// The simplest model that predicts views it has not seen about as well as the best; the part's mask and the state
    /// are left with it. Models with a distortion that the data cannot tell are not tried: they would lead astray.
    template <typename HeldOut>
    std::string chooseModel(const Part& part, const HeldOut& heldOut, double from, double to) {
        struct Try {
            BundleState state;
            double error = 0.0;
        };
        std::vector<Try> tries;
        LensMask determined;
        determined.fill(true);
        for (const LensModel& model : lensModels()) {
            progress_.throwIfCancelled();
            progress_.report(std::lerp(from, to, static_cast<double>(tries.size()) / std::size(lensModels())),
                             "choosing a lens model");
            for (std::size_t i = 0; i < part.mask.size(); ++i) part.mask[i] = model.free[i] && determined[i];
            if (tries.empty()) {
                resetHeld();
                lockPrincipalPoint(part);
                determined[kPrincipalX] = part.mask[kPrincipalX];
                determined[kPrincipalY] = part.mask[kPrincipalY];
            } else if (!std::isfinite(refine(views_, use_, bundle_, state_)) || isDistortionInDoubt(part))
                break;
            tries.push_back({state_, rmsOfNumbers(heldOut())});
        }
        const auto best = std::ranges::min_element(tries, {}, &Try::error);
        std::size_t chosen = 0;
        while (tries[chosen].error > kSimpler * best->error) ++chosen;
        state_ = tries[chosen].state;
        for (std::size_t i = 0; i < part.mask.size(); ++i) part.mask[i] = lensModels()[chosen].free[i] && determined[i];
        return std::string(lensModels()[chosen].name);
    }

    /// Solves for a pinhole, whose principal point is locked where the data cannot tell it.
    void lockPrincipalPoint(const Part& part) {
        do refine(views_, use_, bundle_, state_);
        while (takeBoundedSigmas(), lockOne(part, {kPrincipalX, kPrincipalY}));
    }

    bool isDistortionInDoubt(const Part& part) {
        takeBoundedSigmas();
        return std::ranges::any_of(std::initializer_list<int>{kK3, kAspect, kP2, kP1, kK2, kK1}, [&part](int i) {
            return part.mask[static_cast<std::size_t>(i)] && doubtOf(part, i) > 1.0;
        });
    }

    /// Uncertainties of a solution whose model may still be too poor: what it leaves is not all noise.
    void takeBoundedSigmas() {
        estimateNoise();
        BundleOptions bounded = bundle_;
        bounded.cameraSigma = std::min(bounded.cameraSigma, kMostNoise);
        bounded.projectorSigma = std::min(bounded.projectorSigma, kMostNoise);
        takeSigmas(covarianceOf(views_, use_, bounded, state_), bounded.projectorPoints);
    }

    /// What a model does not have is that of a pinhole.
    void resetHeld() {
        const auto reset = [](Lens& lens, const LensMask& free) {
            for (int i = 0; i < kLensParameters; ++i)
                if (!free[static_cast<std::size_t>(i)] && i != kFocalLength && i != kPrincipalX && i != kPrincipalY)
                    lens[static_cast<std::size_t>(i)] = i == kAspect ? 1.0 : 0.0;
        };
        reset(state_.camera, bundle_.camera);
        if (bundle_.projectorPoints) reset(state_.projector, bundle_.projector);
    }

    /// Refuses boards that all lie the same way: any focal length fits them.
    void requireTilt() const {
        double least = 1.0;
        for (const int a : use_)
            for (const int b : use_) least = std::min(least, std::abs(normalOf(a).dot(normalOf(b))));
        if (std::acos(std::min(least, 1.0)) * 180.0 / kPi < kLeastTurnDegrees) throw frontal();
    }

    [[nodiscard]] static CaptureRefused frontal() {
        return CaptureRefused({Cause::frontalViews, "", "",
                               "the board lies nearly the same way in all poses, so that any focal length fits",
                               "capture it tilted by 20 to 45 degrees, to different sides"});
    }

    [[nodiscard]] cv::Vec3d normalOf(int view) const {
        const PoseVector& pose = state_.cameraFromBoard[static_cast<std::size_t>(view)];
        cv::Matx33d rotation;
        cv::Rodrigues(cv::Vec3d(pose[0], pose[1], pose[2]), rotation);
        return {rotation(0, 2), rotation(1, 2), rotation(2, 2)};
    }

    /// From what is left of the observations: their noise, and how far neighbours err alike.
    void estimateNoise() {
        std::vector<cv::Point2d> corners, points;
        double independent = 0.0;
        for (const int v : use_) {
            const auto& view = views_[static_cast<std::size_t>(v)];
            const PoseVector& pose = state_.cameraFromBoard[static_cast<std::size_t>(v)];
            const auto inCamera = cameraErrors(view, state_.camera, pose);
            corners.insert(corners.end(), inCamera.begin(), inCamera.end());
            if (!bundle_.projectorPoints) continue;
            const auto inProjector = projectorErrors(view, state_, pose);
            points.insert(points.end(), inProjector.begin(), inProjector.end());
            independent += independentShare(view, inProjector) / static_cast<double>(use_.size());
        }
        const double parameters =
            static_cast<double>(6 * use_.size()) + static_cast<double>(std::ranges::count(bundle_.camera, true));
        const double freedom = std::max(1.0, 2.0 * static_cast<double>(corners.size()) - parameters);
        const double sum = rmsOf(corners) * rmsOf(corners) * static_cast<double>(corners.size());
        bundle_.cameraSigma = std::max(kLeastSigma, std::sqrt(sum / freedom));
        if (!bundle_.projectorPoints) return;
        bundle_.projectorSigma = std::max(kLeastSigma, rmsOf(points) / std::numbers::sqrt2);
        bundle_.independent = independent;
    }

    /// Mean squares of the errors of single points, and of patches of about 16: where neighbours err alike, a patch
    /// counts for fewer than it has.
    static double independentShare(const ViewObservations& view, const std::vector<cv::Point2d>& errors) {
        constexpr double kPatch = 16.0;
        if (errors.size() < 4 * kPatch) return 1.0;
        cv::Rect2d box(view.projector.front().camera, cv::Size2d(1.0, 1.0));
        for (const ProjectorPoint& point : view.projector) box |= cv::Rect2d(point.camera, cv::Size2d(1.0, 1.0));
        const double side = std::sqrt(box.area() * kPatch / static_cast<double>(errors.size()));
        std::map<std::pair<int, int>, std::vector<cv::Point2d>> patches;
        for (std::size_t i = 0; i < errors.size(); ++i) {
            const cv::Point2d at = view.projector[i].camera - box.tl();
            patches[{static_cast<int>(at.x / side), static_cast<int>(at.y / side)}].push_back(errors[i]);
        }
        double scaled = 0.0;
        double count = 0.0;
        for (const auto& [place, inside] : patches) {
            const cv::Point2d sum = std::accumulate(inside.begin(), inside.end(), cv::Point2d());
            scaled += sum.dot(sum); // of independent errors: as many times the mean square as there are
            count += static_cast<double>(inside.size());
        }
        const double single = rmsOf(errors) * rmsOf(errors);
        return 1.0 / std::max(1.0, scaled / count / std::max(single, 1e-12));
    }

    /// Solves with what was chosen; locks what the data cannot tell, one after another.
    void settle(bool projector) {
        for (;;) {
            progress_.throwIfCancelled();
            progress_.report(projector ? 0.75 : 0.5, "solving");
            refine(views_, use_, bundle_, state_);
            estimateNoise();
            refine(views_, use_, bundle_, state_);
            const auto covariance = covarianceOf(views_, use_, bundle_, state_);
            takeSigmas(covariance, projector);
            const auto order = {kK3, kAspect, kP2, kP1, kK2, kK1, kPrincipalX, kPrincipalY};
            if (!lockOne(cameraPart(), order) && !(projector && lockOne(projectorPart(), order))) return;
        }
    }

    void takeSigmas(const Eigen::Matrix<double, 24, 24>& covariance, bool projector) {
        const auto sigma = [&covariance](int i) { return std::sqrt(std::max(0.0, covariance(i, i))); };
        for (int i = 0; i < kLensParameters; ++i) {
            result_.camera.sigma[static_cast<std::size_t>(i)] = sigma(i);
            result_.projector.sigma[static_cast<std::size_t>(i)] = sigma(kLensParameters + i);
        }
        if (!projector) return;
        for (int i = 0; i < 6; ++i)
            result_.projectorFromCameraSigma[static_cast<std::size_t>(i)] = sigma(2 * kLensParameters + i);
    }

    /// What a parameter's uncertainty is as a share of what is bearable.
    static double doubtOf(const Part& part, int parameter) {
        const auto& [device, mask, lens, name] = part;
        const double sigma = device.sigma[static_cast<std::size_t>(parameter)];
        const double width = device.size.width;
        const double corner = 0.5 * std::hypot(device.size.width, device.size.height) / lens[kFocalLength];
        const double shift = sigma * lens[kFocalLength] / (kWorstCorner * width);
        switch (parameter) {
        case kPrincipalX:
        case kPrincipalY:
            return sigma / (kWorstPrincipal * width);
        case kAspect:
            return sigma * corner * lens[kFocalLength] / (kWorstCorner * width);
        case kK1:
            return shift * std::pow(corner, 3.0);
        case kK2:
            return shift * std::pow(corner, 5.0);
        case kK3:
            return shift * std::pow(corner, 7.0);
        case kP1:
        case kP2:
            return shift * 3.0 * corner * corner;
        default:
            return 0.0;
        }
    }

    bool lockOne(const Part& part, std::initializer_list<LensParameter> order) {
        const auto& [device, mask, lens, name] = part;
        for (const LensParameter i : order) {
            const auto index = static_cast<std::size_t>(i);
            if (!mask[index] || doubtOf(part, i) <= 1.0) continue;
            mask[index] = false;
            lens[index] = i == kAspect       ? 1.0
                          : i == kPrincipalX ? 0.5 * (device.size.width - 1)
                          : i == kPrincipalY ? 0.5 * (device.size.height - 1)
                                             : 0.0;
            result_.degenerate = result_.degenerate || i == kPrincipalX || i == kPrincipalY;
            result_.warnings.push_back({Cause::undetermined, "", "",
                                        "the poses cannot tell " + std::string(kParameterNames[index]) + " of the " +
                                            name + ", which was locked",
                                        "capture more poses, tilted and towards the corners"});
            return true;
        }
        return false;
    }

    void report(bool projector) {
        progress_.report(0.85, "testing on views left out");
        finish(result_.camera, state_.camera, bundle_.camera);
        finish(result_.projector, state_.projector, bundle_.projector);
        result_.state = state_;
        result_.projectorFromCamera = state_.projectorFromCamera;
        const std::vector<double> held =
            projector ? heldOutTransfers(views_, use_, bundle_, state_) : heldOutCorners(views_, use_, bundle_, state_);
        for (std::size_t v = 0; v < views_.size(); ++v) {
            const PoseVector& pose = state_.cameraFromBoard[v];
            result_.views.push_back({views_[v].name, rmsOf(cameraErrors(views_[v], state_.camera, pose)),
                                     projector ? rmsOf(projectorErrors(views_[v], state_, pose)) : 0.0, held[v]});
        }
        result_.camera.rms = rmsOverViews(&ViewQuality::cameraRms);
        result_.projector.rms = rmsOverViews(&ViewQuality::projectorRms);
        result_.rms = projector ? std::sqrt(0.5 * (result_.camera.rms * result_.camera.rms +
                                                   result_.projector.rms * result_.projector.rms))
                                : result_.camera.rms;
        result_.worstView = std::ranges::max_element(result_.views, {}, [](const ViewQuality& view) {
                                return std::hypot(view.cameraRms, view.projectorRms, view.heldOut.value_or(0.0));
                            })->name;
        judge(projector);
    }

    static void finish(CalibratedDevice& device, const Lens& lens, const LensMask& free) {
        device.lens = lens;
        device.free = free;
    }

    [[nodiscard]] double rmsOverViews(double ViewQuality::*error) const {
        std::vector<double> all;
        for (const ViewQuality& view : result_.views) all.push_back(view.*error);
        return rmsOfNumbers(all);
    }

    void judge(bool projector) {
        if (!(result_.rms < kFits))
            throw CaptureRefused({Cause::modelDoesNotFit, result_.worstView, "",
                                  "no lens explains the capture: " + pixels(result_.rms) + " of error remain",
                                  "look at this pose first; check the board's kind and that it is flat"});
        const auto doubt = [](const CalibratedDevice& device) {
            return device.sigma[kFocalLength] / device.lens[kFocalLength];
        };
        if (doubt(result_.camera) > kWorstFocal || (projector && doubt(result_.projector) > kWorstFocal))
            throw frontal();
        if (!projector) return;
        if (views_.size() < 4) {
            result_.warnings.push_back({Cause::tooFewViews, "", "", "with three poses no two halves can be compared",
                                        "capture a fourth pose, better six"});
            return;
        }
        progress_.report(0.95, "comparing halves");
        const HalvesComparison halves = compareHalves(views_, use_, bundle_, state_);
        result_.halvesDiffer = halves.differ;
        result_.halvesAllowed = halves.allowed;
        if (halves.differ > halves.allowed)
            result_.warnings.push_back({Cause::modelDoesNotFit, result_.worstView, "",
                                        "two halves of the poses disagree by " + pixels(halves.differ) +
                                            ", more than the " + pixels(halves.allowed) +
                                            " that noise allows: the model does not fit",
                                        "check that the board is flat and that nothing moved or refocused"});
    }

    static std::string pixels(double value) {
        std::ostringstream text;
        text.precision(2);
        text << std::fixed << value << " pixels";
        return text.str();
    }

    const std::vector<ViewObservations>& views_;
    ViewChoice use_;
    Progress progress_;
    SolveOptions options_;
    BundleOptions bundle_;
    BundleState state_;
    ProcamCalibration result_;
};

} // namespace

ProcamCalibration calibrateProcam(const std::vector<ViewObservations>& views, cv::Size camera, cv::Size projector,
                                  const SolveOptions& options, const Progress& progress) {
    return ProcamSolver(views, camera, projector, options, progress).both();
}

ProcamCalibration calibrateIntrinsics(const std::vector<ViewObservations>& views, cv::Size camera,
                                      const SolveOptions& options, const Progress& progress) {
    return ProcamSolver(views, camera, {}, options, progress).camera();
}

} // namespace lumorph
