#include "calibration/solve/procam_calibration.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <sstream>
#include <utility>

#include <Eigen/Dense>
#include <glm/geometric.hpp>

#include "calibration/solve/board_shape.h"
#include "calibration/solve/first_guess.h"
#include "calibration/solve/held_out.h"

namespace lumorph {

namespace {

constexpr int kFewestViews = 3;
constexpr double kWorthALook = 6.0;       // what a term must take off the sum of squares in units of noise: chance is 1
constexpr double kGain = 2.0;             // likewise, off that of the views left out
constexpr double kLeastTurnDegrees = 8.0; // between the two boards that are turned most against one another
constexpr double kWorstFocal = 0.05;      // standard deviation of a focal length, as a share of it
constexpr double kWorstPrincipal = 0.1;   // of a principal point, as a share of the image's width
constexpr double kWorstCorner = 0.02;     // what a distortion term may be uncertain by at the image's corner, likewise
constexpr int kPointsForChoice = 150;     // of a view
constexpr int kPointsForSolution = 600;
constexpr double kLeastSigma = 0.01; // pixels
constexpr double kStray = 3.0;       // standard deviations
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

/// Mean squares of the errors of single points, and of patches of some number of them: where neighbours err alike, a
/// patch counts for fewer than it has.
class PatchErrors {
public:
    explicit PatchErrors(double inPatch) : inPatch_(inPatch) {}

    void add(const std::vector<cv::Point2d>& places, const std::vector<cv::Point2d>& errors, double most) {
        if (static_cast<double>(errors.size()) < 4.0 * inPatch_) return;
        cv::Rect2d box(places.front(), cv::Size2d(1.0, 1.0));
        for (const cv::Point2d& place : places) box |= cv::Rect2d(place, cv::Size2d(1.0, 1.0));
        const double side = std::sqrt(box.area() * inPatch_ / static_cast<double>(errors.size()));
        std::map<std::pair<int, int>, std::pair<cv::Point2d, double>> patches;
        for (std::size_t i = 0; i < errors.size(); ++i) {
            if (errors[i].dot(errors[i]) > most * most) continue;
            const cv::Point2d at = places[i] - box.tl();
            auto& [sum, count] = patches[{static_cast<int>(at.x / side), static_cast<int>(at.y / side)}];
            sum += errors[i];
            count += 1.0;
            single_ += errors[i].dot(errors[i]);
        }
        for (const auto& [place, patch] : patches) {
            scaled_ += patch.first.dot(patch.first); // of independent errors: the sum of the squares of all
            if (patch.second > 0.5 * inPatch_) patches_ += 1.0;
        }
    }

    /// How many points err as one; 1 where nothing speaks against independence.
    [[nodiscard]] double alike() const {
        if (patches_ < 4.0 || !(single_ > 0.0)) return 1.0;
        return std::max(1.0, scaled_ / single_ - 2.0 / std::sqrt(patches_));
    }

private:
    double inPatch_;
    double single_ = 0.0, scaled_ = 0.0, patches_ = 0.0;
};

std::string pixels(double value) {
    std::ostringstream text;
    text.precision(2);
    text << std::fixed << value << " pixels";
    return text.str();
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
        solveCameraAlone();
        if (dropOutliers()) {
            beginAnew();
            solveCameraAlone();
        }
        report(false);
        return std::move(result_);
    }

    ProcamCalibration both() {
        solveBoth();
        if (dropOutliers()) {
            beginAnew();
            solveBoth();
        }
        report(true);
        return std::move(result_);
    }

private:
    void solveCameraAlone() {
        solveCamera();
        if (options_.judge) chooseBoard();
        settle(false);
    }

    void solveBoth() {
        solveCamera();
        solveProjector();
        if (options_.judge) chooseBoard();
        bundle_.most = kPointsForSolution;
        settle(true);
    }

    /// Outliers mislead the choice of a model, which asks for errors on views left out: without them it is made again.
    void beginAnew() {
        const cv::Size camera = result_.camera.size, projector = result_.projector.size;
        result_ = {};
        result_.camera.size = camera;
        result_.projector.size = projector;
        bundle_ = {};
        state_ = {};
        cameraFreedom_ = projectorFreedom_ = 0.0;
    }

    void solveCamera() {
        if (options_.start)
            takeStart();
        else
            state_ = firstCamera(views_, use_, result_.camera.size, options_.cameraFocal);
        requireTilt();
        if (static_cast<int>(views_.size()) < kFewestViews)
            throw CaptureRefused({Cause::tooFewViews, "", "",
                                  std::to_string(views_.size()) + " poses of the board, but three are needed",
                                  "capture the board in more poses, tilted differently; six are good"});
        bundle_.projectorPoints = false;
        chooseModel(cameraPart(), options_.cameraModel, 0.02, 0.3);
        takeBoundedSigmas();
        if (boundedDoubt(0, state_.camera) > 2.0 * kWorstFocal) throw frontal();
    }

    void solveProjector() {
        dropMissed();
        if (!options_.start) addFirstProjector(views_, use_, result_.projector.size, options_.projectorFocal, state_);
        bundle_.projectorPoints = true;
        bundle_.most = kPointsForChoice;
        bundle_.projector = lensModelOf("k1");
        refine(views_, use_, bundle_, state_);
        estimateNoise();
        chooseModel(projectorPart(), options_.projectorModel, 0.3, 0.6);
    }

    void takeStart() {
        state_ = *options_.start;
        for (std::size_t v = state_.cameraFromBoard.size(); v < views_.size(); ++v)
            state_.cameraFromBoard.push_back(poseFromCamera(views_[v], state_.camera));
        state_.cameraFromBoard.resize(views_.size());
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

    /// Lets go of one distortion term after another that predicts views left out better, from the pinhole on; the
    /// part's mask and the state are left with them. Or of those in `wanted`.
    void chooseModel(const Part& part, const std::string& wanted, double from, double to) {
        if (!wanted.empty()) {
            part.mask = lensModelOf(wanted);
            resetHeld();
            refine(views_, use_, bundle_, state_);
            return;
        }
        part.mask = lensModelOf("pinhole");
        resetHeld();
        lockPrincipalPoint(part);
        std::optional<double> heldOut;
        double step = 0.0;
        for (const std::vector<LensParameter>& terms : lensTerms()) {
            progress_.report(std::lerp(from, to, step++ / static_cast<double>(lensTerms().size())),
                             "choosing a lens model");
            letGo(part.mask, terms, heldOut, [&] { return !isDistortionInDoubt(part); });
        }
    }

    /// Lets go of terms of a lens or the board if they lower the error on views left out, for which what they do for
    /// the views that are in must be more than chance. `heldOut`: that error before, nothing if not known yet. Returns
    /// whether they stay free.
    template <typename Mask, typename Term, typename Sound>
    bool letGo(Mask& mask, const std::vector<Term>& terms, std::optional<double>& heldOut, const Sound& isSound) {
        progress_.throwIfCancelled();
        const BundleState before = state_;
        const BundleOptions noise = bundle_;
        const auto set = [&](bool free) {
            for (const Term term : terms) mask[static_cast<std::size_t>(term)] = free;
        };
        const double cost = refine(views_, use_, bundle_, state_);
        const BundleState settled = std::isfinite(cost) ? state_ : before;
        set(true);
        const double lower = refine(views_, use_, bundle_, state_);
        const bool looked = 2.0 * (cost - lower) > kWorthALook * static_cast<double>(terms.size()) && isSound();
        bundle_ = noise; // which the look may have estimated anew
        set(false);
        if (looked) {
            if (!heldOut) heldOut = heldOutError(settled);
            set(true);
            const double error = heldOutError(state_);
            if (error * error * (1.0 + kGain / independentErrors()) < *heldOut * *heldOut) {
                heldOut = error;
                estimateNoise();
                return true;
            }
            set(false);
        }
        state_ = settled;
        return false;
    }

    /// Of views left out: of their corners, or where there is a projector, of their transfers.
    [[nodiscard]] double heldOutError(const BundleState& state) const {
        return rmsOfNumbers(bundle_.projectorPoints ? heldOutTransfers(views_, use_, bundle_, state)
                                                    : heldOutCorners(views_, use_, bundle_, state));
    }

    /// How many coordinates of errors are independent.
    [[nodiscard]] double independentErrors() const {
        double count = 0.0;
        for (const ViewObservations& view : views_)
            count += bundle_.projectorPoints
                         ? std::min<double>(bundle_.most,
                                            bundle_.independentPoints * static_cast<double>(view.projector.size()))
                         : bundle_.independentCorners * static_cast<double>(view.corners.seen.size());
        return std::max(1.0, 2.0 * count);
    }

    /// Lets the board bend where that predicts views left out better, and tells how far it is bent.
    void chooseBoard() {
        progress_.report(0.65, "looking whether the board is flat");
        std::optional<double> heldOut;
        const auto always = [] { return true; };
        if (letGo(bundle_.board, std::vector{kBendUU, kBendUV, kBendVV}, heldOut, always))
            letGo(bundle_.board, std::vector{kBendUUU, kBendUUV, kBendUVV, kBendVVV}, heldOut, always);
        letGo(bundle_.board, std::vector{kBoardStretch}, heldOut, always);
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

    /// Uncertainties of a solution whose model may still be too poor: what it leaves is neither all noise nor outliers,
    /// so that noise is bounded and all points count in full.
    [[nodiscard]] Eigen::MatrixXd boundedCovariance() const {
        BundleOptions bounded = bundle_;
        bounded.cameraSigma = std::min(bounded.cameraSigma, kMostNoise);
        bounded.projectorSigma = std::min(bounded.projectorSigma, kMostNoise);
        Eigen::MatrixXd covariance = covarianceOf(views_, use_, bounded, state_).matrix;
        std::vector<Eigen::Index> free;
        for (Eigen::Index i = 0; i < covariance.rows(); ++i)
            if (covariance(i, i) > 0.0) free.push_back(i);
        covariance(free, free) = inverseOfNormal(normalMatrixOf(views_, use_, bounded, state_)(free, free));
        return covariance;
    }

    void takeBoundedSigmas() {
        estimateNoise();
        takeSigmas(boundedCovariance(), bundle_.projectorPoints);
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
            for (const int b : use_) least = std::min(least, std::abs(glm::dot(normalOf(a), normalOf(b))));
        if (std::acos(std::min(least, 1.0)) * 180.0 / kPi < kLeastTurnDegrees) throw frontal();
    }

    [[nodiscard]] static CaptureRefused frontal() {
        return CaptureRefused({Cause::frontalViews, "", "",
                               "the board lies nearly the same way in all poses, so that any focal length fits",
                               "capture it tilted by 20 to 45 degrees, to different sides"});
    }

    [[nodiscard]] glm::dvec3 normalOf(int view) const {
        return Rigid::exp(state_.cameraFromBoard[static_cast<std::size_t>(view)]).rotation[2];
    }

    /// From what is left of the observations: their noise, and how far neighbours err alike.
    void estimateNoise() {
        std::vector<cv::Point2d> corners, points;
        PatchErrors ofCorners(9.0);
        PatchErrors ofPoints(16.0);
        for (const int v : use_) {
            const auto& view = views_[static_cast<std::size_t>(v)];
            const PoseVector& pose = state_.cameraFromBoard[static_cast<std::size_t>(v)];
            const auto inCamera = cameraErrors(view, state_, pose);
            corners.insert(corners.end(), inCamera.begin(), inCamera.end());
            ofCorners.add(view.corners.seen, inCamera, kStray * bundle_.cameraSigma);
            if (!bundle_.projectorPoints) continue;
            const auto inProjector = projectorErrors(view, state_, pose);
            points.insert(points.end(), inProjector.begin(), inProjector.end());
            std::vector<cv::Point2d> places;
            for (const ProjectorPoint& point : view.projector) places.push_back(point.camera);
            ofPoints.add(places, inProjector, kStray * bundle_.projectorSigma);
        }
        bundle_.cameraSigma = std::max(kLeastSigma, sigmaOf(corners, cameraFreedom_));
        bundle_.independentCorners = 1.0 / ofCorners.alike();
        if (!bundle_.projectorPoints) return;
        bundle_.projectorSigma = std::max(kLeastSigma, sigmaOf(points, projectorFreedom_));
        bundle_.independentPoints = 1.0 / ofPoints.alike();
    }

    /// Solves with what was chosen; locks what the data cannot tell, one after another.
    void settle(bool projector) {
        for (;;) {
            progress_.throwIfCancelled();
            progress_.report(projector ? 0.75 : 0.5, "solving");
            for (int round = 0; round < 2; ++round) {
                refine(views_, use_, bundle_, state_);
                takeFreedom();
                estimateNoise();
            }
            refine(views_, use_, bundle_, state_);
            result_.covariance = covarianceOf(views_, use_, bundle_, state_).matrix;
            takeSigmas(result_.covariance, projector);
            const auto order = {kK3, kAspect, kP2, kP1, kK2, kK1, kPrincipalX, kPrincipalY};
            if (!lockOne(cameraPart(), order) && !(projector && lockOne(projectorPart(), order))) return;
        }
    }

    /// Points whose rays miss the board, before a projector is known.
    void dropMissed() {
        for (const int v : use_) {
            const auto at = static_cast<std::size_t>(v);
            ViewObservations& view = views_[at];
            Outliers missed;
            for (const ProjectorPoint& point : view.projector) {
                const double depth =
                    pointOnBoard(point.camera, state_.camera, state_.cameraFromBoard[at], state_.board).z;
                missed.isOut.push_back(!(depth > 0.0) || !std::isfinite(depth));
            }
            const auto count = std::ranges::count(missed.isOut, true);
            if (count == 0) continue;
            dropped_.push_back({Cause::pointSuspicious, view.name, "",
                                std::to_string(count) + " of " + std::to_string(missed.isOut.size()) +
                                    " decoded points lie on rays that miss the board",
                                "nothing: they were left out"});
            missed.eraseFrom(view.projector);
        }
    }

    /// Returns whether there were any; what they were is among the warnings.
    bool dropOutliers() {
        const std::size_t before = dropped_.size();
        const auto find = [&](const std::vector<cv::Point2d>& errors, double sigma, const char* what,
                              const std::string& view) {
            Outliers outliers = outliersOf(errors, sigma);
            if (outliers.count > 0) dropped_.push_back(findingOf(outliers, what, view));
            return outliers;
        };
        for (const int v : use_) {
            ViewObservations& view = views_[static_cast<std::size_t>(v)];
            const PoseVector& pose = state_.cameraFromBoard[static_cast<std::size_t>(v)];
            const Outliers corners =
                find(cameraErrors(view, state_, pose), bundle_.cameraSigma, "points of the board", view.name);
            corners.eraseFrom(view.corners.board);
            corners.eraseFrom(view.corners.seen);
            if (bundle_.projectorPoints)
                find(projectorErrors(view, state_, pose), bundle_.projectorSigma, "decoded points", view.name)
                    .eraseFrom(view.projector);
        }
        return dropped_.size() > before;
    }

    void takeFreedom() {
        const BundleCovariance covariance = covarianceOf(views_, use_, bundle_, state_);
        cameraFreedom_ = covariance.cameraFreedom;
        projectorFreedom_ = covariance.projectorFreedom;
    }

    void takeSigmas(const Eigen::MatrixXd& covariance, bool projector) {
        const auto sigma = [&covariance](int i) { return std::sqrt(std::max(0.0, covariance(i, i))); };
        for (int i = 0; i < kLensParameters; ++i) {
            result_.camera.sigma[static_cast<std::size_t>(i)] = sigma(i);
            result_.projector.sigma[static_cast<std::size_t>(i)] = sigma(kLensParameters + i);
        }
        if (!projector) return;
        for (int i = 0; i < 6; ++i)
            result_.projectorFromCameraSigma[static_cast<std::size_t>(i)] = sigma(2 * kLensParameters + i);
    }

    /// Uncertainty of a focal length as a share of it, as far as noise makes it.
    double boundedDoubt(int place, const Lens& lens) const {
        return std::sqrt(boundedCovariance()(place, place)) / lens[kFocalLength];
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
        result_.warnings.insert(result_.warnings.begin(), dropped_.begin(), dropped_.end());
        finish(result_.camera, state_.camera, bundle_.camera);
        finish(result_.projector, state_.projector, bundle_.projector);
        result_.state = state_;
        result_.bundle = bundle_;
        takeInformation();
        result_.projectorFromCamera = state_.projectorFromCamera;
        const std::vector<double> held = !options_.judge ? std::vector<double>()
                                         : projector     ? heldOutTransfers(views_, use_, bundle_, state_)
                                                         : heldOutCorners(views_, use_, bundle_, state_);
        for (std::size_t v = 0; v < views_.size(); ++v) {
            const PoseVector& pose = state_.cameraFromBoard[v];
            result_.views.push_back({views_[v].name, rmsOf(cameraErrors(views_[v], state_, pose)),
                                     projector ? rmsOf(projectorErrors(views_[v], state_, pose)) : 0.0,
                                     held.empty() ? std::optional<double>() : held[v]});
        }
        result_.camera.rms = rmsOverViews(&ViewQuality::cameraRms);
        result_.projector.rms = rmsOverViews(&ViewQuality::projectorRms);
        result_.rms = projector ? std::sqrt(0.5 * (result_.camera.rms * result_.camera.rms +
                                                   result_.projector.rms * result_.projector.rms))
                                : result_.camera.rms;
        result_.worstView = std::ranges::max_element(result_.views, {}, [](const ViewQuality& view) {
                                return std::hypot(view.cameraRms, view.projectorRms, view.heldOut.value_or(0.0));
                            })->name;
        result_.boardBend = bendOf(state_.board, views_);
        judge(projector);
    }

    void takeInformation() {
        result_.information = Eigen::MatrixXd::Zero(kPosePlace, kPosePlace);
        for (const int v : use_) {
            const auto index = static_cast<std::size_t>(v);
            result_.information += informationOf(views_[index], bundle_, state_, state_.cameraFromBoard[index]);
            const auto count = static_cast<double>(views_[index].projector.size());
            result_.pointsOfView +=
                std::min<double>(bundle_.most, count * bundle_.independentPoints) / static_cast<double>(use_.size());
        }
    }

    static void finish(CalibratedDevice& device, const Lens& lens, const LensMask& free) {
        device.lens = lens;
        device.free = free;
        device.model = lensModelName(free);
    }

    [[nodiscard]] double rmsOverViews(double ViewQuality::*error) const {
        std::vector<double> all;
        for (const ViewQuality& view : result_.views) all.push_back(view.*error);
        return rmsOfNumbers(all);
    }

    void judge(bool projector) {
        // First what the poses are worth: without tilt any lens fits or none, whichever was found.
        if (std::max(boundedDoubt(0, state_.camera),
                     projector ? boundedDoubt(kProjectorPlace, state_.projector) : 0.0) > kWorstFocal)
            throw frontal();
        const std::optional<Finding> misfit = misfitOf(result_);
        if (misfit && options_.judgesFit) throw CaptureRefused(*misfit);
        if (options_.judge && options_.judgesFit) judgeBoard(); // else the caller has causes of its own to compare
        if (!projector || !options_.judge) return;
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

    void judgeBoard() {
        const BoardMeasurement board = measureBoard(views_, result_);
        std::ostringstream text;
        text.precision(2);
        if (board.isWarped()) {
            text << std::fixed << "the board is bent by " << board.bend << " +- " << board.bendSigma
                 << " in its own unit of length";
            result_.warnings.push_back({Cause::boardWarped, "", "", text.str(), "mount it on glass or a stiff panel"});
        } else if (board.isStretched()) {
            text << std::fixed << "the board's squares are " << 100.0 * board.stretch
                 << " % longer along its rows than along its columns";
            result_.warnings.push_back(
                {Cause::squareSize, "", "", text.str(), "print it without scaling to the page and measure both sides"});
        }
    }

    std::vector<ViewObservations> views_; // without what was left out
    std::vector<Finding> dropped_;        // what those were
    ViewChoice use_;
    Progress progress_;
    SolveOptions options_;
    BundleOptions bundle_;
    BundleState state_;
    double cameraFreedom_ = 0.0, projectorFreedom_ = 0.0;
    ProcamCalibration result_;
};

} // namespace

std::optional<Finding> misfitOf(const ProcamCalibration& result) {
    if (result.rms < kFits) return std::nullopt;
    return Finding{Cause::modelDoesNotFit, result.worstView, "",
                   "no lens explains the capture: " + pixels(result.rms) + " of error remain",
                   "look at this pose first; check the board's kind and that it is flat"};
}

ProcamCalibration calibrateProcam(const std::vector<ViewObservations>& views, cv::Size camera, cv::Size projector,
                                  const SolveOptions& options, const Progress& progress) {
    return ProcamSolver(views, camera, projector, options, progress).both();
}

ProcamCalibration calibrateIntrinsics(const std::vector<ViewObservations>& views, cv::Size camera,
                                      const SolveOptions& options, const Progress& progress) {
    return ProcamSolver(views, camera, {}, options, progress).camera();
}

} // namespace lumorph
