#include "calibration/solve/installation_calibration.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <sstream>
#include <utility>

#include "calibration/solve/first_guess.h"

namespace lumorph {

namespace {

constexpr int kFewestShared = 3; // poses in which a camera must see a projector's light to be placed by it
constexpr std::size_t kLightsOfView = 250;
constexpr double kWorstFit = 2.0;  // pixels
constexpr double kSteady = 0.01;   // pixels: no noise is less
constexpr double kNotThere = 50.0; // pixels: an error that counts no further when places are compared

class InstallationSolver {
public:
    InstallationSolver(std::vector<InstallationView> views, const std::vector<NamedDevice>& cameras,
                       const std::vector<NamedDevice>& projectors, const Progress& progress)
        : views_(std::move(views)), cameras_(cameras), projectors_(projectors), progress_(progress) {
        checkLists();
        result_.cameras.resize(cameras.size());
        result_.projectors.resize(projectors.size());
        state_.cameras.resize(cameras.size());
        state_.projectors.resize(projectors.size());
        state_.worldFromBody.resize(views_.size());
        cameraPlaced_.resize(cameras.size());
        projectorPlaced_.resize(projectors.size());
        boardPlaced_.resize(views_.size());
        boards_.resize(cameras.size());
    }

    InstallationCalibration solve() {
        for (std::size_t c = 0; c < cameras_.size(); ++c) solveCamera(c);
        placeCamera(0, {});
        while (placeNext()) progress_.throwIfCancelled();
        requireAll();
        refineAll();
        report();
        return std::move(result_);
    }

private:
    void checkLists() const {
        if (cameras_.empty())
            throw InvalidInput("installation", "it has no camera", "capture with at least one camera");
        for (const InstallationView& view : views_) {
            bool agree =
                view.corners.size() == cameras_.size() && (view.light.empty() || view.light.size() == cameras_.size());
            for (const auto& ofCamera : view.light) agree = agree && ofCamera.size() == projectors_.size();
            for (const BoardPoints& corners : view.corners)
                agree = agree && corners.board.size() == corners.seen.size();
            if (!agree)
                throw InvalidInput("view " + view.name, "it has not one entry for each camera and projector",
                                   "leave what was not seen empty");
        }
    }

    [[nodiscard]] bool sees(std::size_t camera, std::size_t view) const {
        return views_[view].corners[camera].seen.size() >= 4;
    }
    [[nodiscard]] const std::vector<ProjectorPoint>& lightOf(std::size_t view, std::size_t camera,
                                                             std::size_t projector) const {
        static const std::vector<ProjectorPoint> kNone;
        return views_[view].light.empty() || !sees(camera, view) ? kNone : views_[view].light[camera][projector];
    }
    [[nodiscard]] int sharedPoses(std::size_t camera, std::size_t projector) const {
        int count = 0;
        for (std::size_t v = 0; v < views_.size(); ++v) count += !lightOf(v, camera, projector).empty();
        return count;
    }

    /// Refusals of a part name the device.
    template <typename Solve> static auto named(const std::string& name, const Solve& solve) {
        try {
            return solve();
        } catch (const CaptureRefused& refused) {
            Finding finding = refused.finding();
            finding.why = name + ": " + finding.why;
            throw CaptureRefused(finding);
        }
    }

    /// Lens and boards of a camera by itself.
    void solveCamera(std::size_t c) {
        std::vector<ViewObservations> alone;
        std::vector<std::size_t> places;
        for (std::size_t v = 0; v < views_.size(); ++v)
            if (sees(c, v)) {
                alone.push_back({views_[v].name, views_[v].corners[c], {}});
                places.push_back(v);
            }
        const ProcamCalibration solved = named(
            cameras_[c].name, [&] { return calibrateIntrinsics(alone, cameras_[c].size, {}, progress_.part(0, 0)); });
        result_.cameras[c] = solved.camera;
        state_.cameras[c].lens = solved.camera.lens;
        takeWarnings(solved.warnings, cameras_[c].name);
        boards_[c].resize(views_.size());
        for (std::size_t i = 0; i < places.size(); ++i)
            boards_[c][places[i]] = Rigid::exp(solved.state.cameraFromBoard[i]);
        progress_.report(0.3 * static_cast<double>(c + 1) / static_cast<double>(cameras_.size()), "cameras");
    }

    void takeWarnings(const std::vector<Finding>& warnings, const std::string& name) {
        for (Finding warning : warnings) {
            if (warning.cause != Cause::undetermined) continue; // what else there is, the whole decides
            warning.why = name + ": " + warning.why;
            result_.warnings.push_back(warning);
        }
    }

    void placeCamera(std::size_t c, const Rigid& fromWorld) {
        state_.cameras[c].fromWorld = fromWorld.log();
        cameraPlaced_[c] = true;
        const Rigid toWorld = fromWorld.inverse();
        for (std::size_t v = 0; v < views_.size(); ++v)
            if (sees(c, v) && !boardPlaced_[v]) {
                state_.worldFromBody[v] = (toWorld * boards_[c][v]).log();
                boardPlaced_[v] = true;
            }
    }

    bool placeNext() {
        for (std::size_t c = 0; c < cameras_.size(); ++c)
            if (!cameraPlaced_[c] && placeByBoards(c)) return true;
        for (std::size_t p = 0; p < projectors_.size(); ++p)
            if (!projectorPlaced_[p] && placeProjector(p)) return true;
        for (std::size_t c = 0; c < cameras_.size(); ++c)
            if (!cameraPlaced_[c] && placeByLight(c)) return true;
        return false;
    }

    /// By boards whose place is known, each of which the camera may have found turned.
    bool placeByBoards(std::size_t c) {
        double best = std::numeric_limits<double>::infinity();
        Rigid place;
        for (std::size_t v = 0; v < views_.size(); ++v) {
            if (!boardPlaced_[v] || !sees(c, v)) continue;
            const auto tryBoard = [&](const BoardPoints& corners) {
                const PoseVector fromBoard = poseFromCamera({views_[v].name, corners, {}}, state_.cameras[c].lens);
                const Rigid fromWorld = Rigid::exp(fromBoard) * Rigid::exp(state_.worldFromBody[v]).inverse();
                const double error = placeError(c, fromWorld);
                if (!(error < best)) return;
                best = error;
                place = fromWorld;
            };
            tryBoard(views_[v].corners[c]);
            if (auto turned = turnedBoard(views_[v].corners[c].board))
                tryBoard({std::move(*turned), views_[v].corners[c].seen});
        }
        if (!std::isfinite(best)) return false;
        for (std::size_t v = 0; v < views_.size(); ++v) {
            if (!boardPlaced_[v] || !sees(c, v)) continue;
            if (auto turned = turnedBoard(views_[v].corners[c].board)) {
                BoardPoints other{std::move(*turned), views_[v].corners[c].seen};
                if (boardError(c, v, other, place) < boardError(c, v, views_[v].corners[c], place))
                    views_[v].corners[c] = std::move(other);
            }
        }
        placeCamera(c, place);
        return true;
    }

    [[nodiscard]] double boardError(std::size_t c, std::size_t v, const BoardPoints& corners,
                                    const Rigid& cameraFromWorld) const {
        const ViewObservations view{views_[v].name, corners, {}};
        const double error = rmsOf(cameraErrors(view, {state_.cameras[c].lens, {}, {}, state_.board, {}},
                                                (cameraFromWorld * Rigid::exp(state_.worldFromBody[v])).log()));
        return std::isfinite(error) ? std::min(error, kNotThere) : kNotThere;
    }

    /// Of all boards that are placed, and of the light on them.
    [[nodiscard]] double placeError(std::size_t c, const Rigid& fromWorld) const {
        InstallationState there = state_;
        there.cameras[c].fromWorld = fromWorld.log();
        double sum = 0.0;
        for (std::size_t v = 0; v < views_.size(); ++v) {
            if (!boardPlaced_[v] || !sees(c, v)) continue;
            double error = boardError(c, v, views_[v].corners[c], fromWorld);
            if (const auto turned = turnedBoard(views_[v].corners[c].board))
                error = std::min(error, boardError(c, v, {*turned, views_[v].corners[c].seen}, fromWorld));
            sum += error;
            for (std::size_t p = 0; p < projectors_.size(); ++p)
                if (projectorPlaced_[p]) sum += lightError(c, p, v, there);
        }
        return sum;
    }

    [[nodiscard]] double lightError(std::size_t c, std::size_t p, std::size_t v, const InstallationState& there) const {
        std::vector<SeenLight> light;
        for (const ProjectorPoint& pixels : lightOf(v, c, p)) light.push_back(seenLight(c, p, v, pixels));
        double sum = 0.0;
        for (const auto& error : errorsOf(light, there))
            sum += error ? std::min(cv::norm(*error), kNotThere) : kNotThere;
        return light.empty() ? 0.0 : sum / static_cast<double>(light.size());
    }

    [[nodiscard]] static SeenLight seenLight(std::size_t c, std::size_t p, std::size_t v,
                                             const ProjectorPoint& pixels) {
        return {static_cast<int>(c), static_cast<int>(p), static_cast<int>(v), false, pixels};
    }

    /// A camera and a projector by themselves.
    ProcamCalibration solvePair(std::size_t c, std::size_t p) const {
        std::vector<ViewObservations> both;
        for (std::size_t v = 0; v < views_.size(); ++v)
            if (!lightOf(v, c, p).empty()) both.push_back({views_[v].name, views_[v].corners[c], lightOf(v, c, p)});
        return named(projectors_[p].name + " seen by " + cameras_[c].name, [&] {
            return calibrateProcam(both, cameras_[c].size, projectors_[p].size, {}, progress_.part(0.3, 0.3));
        });
    }

    bool placeProjector(std::size_t p) {
        std::optional<std::size_t> best;
        for (std::size_t c = 0; c < cameras_.size(); ++c)
            if (cameraPlaced_[c] && sharedPoses(c, p) >= kFewestShared &&
                (!best || sharedPoses(c, p) > sharedPoses(*best, p)))
                best = c;
        if (!best) return false;
        const ProcamCalibration pair = solvePair(*best, p);
        result_.projectors[p] = pair.projector;
        state_.projectors[p].lens = pair.projector.lens;
        state_.projectors[p].fromWorld =
            (Rigid::exp(pair.projectorFromCamera) * Rigid::exp(state_.cameras[*best].fromWorld)).log();
        projectorPlaced_[p] = true;
        takeWarnings(pair.warnings, projectors_[p].name);
        if (*best == 0) state_.board = pair.state.board; // the boards are called as the first camera calls them
        return true;
    }

    bool placeByLight(std::size_t c) {
        for (std::size_t p = 0; p < projectors_.size(); ++p) {
            if (!projectorPlaced_[p] || sharedPoses(c, p) < kFewestShared) continue;
            const ProcamCalibration pair = solvePair(c, p);
            placeCamera(c, Rigid::exp(pair.projectorFromCamera).inverse() * Rigid::exp(state_.projectors[p].fromWorld));
            return true;
        }
        return false;
    }

    void requireAll() const {
        std::string names;
        const auto add = [&](const std::string& name) { names += (names.empty() ? "" : ", ") + name; };
        for (std::size_t c = 0; c < cameras_.size(); ++c)
            if (!cameraPlaced_[c]) add(cameras_[c].name);
        for (std::size_t p = 0; p < projectors_.size(); ++p)
            if (!projectorPlaced_[p]) add(projectors_[p].name);
        if (names.empty()) return;
        throw CaptureRefused({Cause::disconnected, "", "",
                              names + " cannot be put into one world with " + cameras_.front().name,
                              "capture poses of the board that cameras of both groups see, and at least three of them "
                              "in each projector's light"});
    }

    void gather() {
        for (std::size_t v = 0; v < views_.size(); ++v)
            for (std::size_t c = 0; c < cameras_.size(); ++c) {
                if (!sees(c, v)) continue;
                const BoardPoints& corners = views_[v].corners[c];
                for (std::size_t i = 0; i < corners.seen.size(); ++i)
                    observations_.points.push_back(
                        {static_cast<int>(c), static_cast<int>(v), false, corners.board[i], corners.seen[i]});
                for (std::size_t p = 0; p < projectors_.size(); ++p) {
                    const auto& light = lightOf(v, c, p);
                    const std::size_t used = std::min(light.size(), kLightsOfView);
                    for (std::size_t i = 0; i < used; ++i)
                        observations_.lights.push_back(seenLight(c, p, v, light[i * light.size() / used]));
                }
            }
    }

    void refineAll() {
        gather();
        InstallationFree free;
        for (std::size_t c = 0; c < cameras_.size(); ++c) free.cameras.push_back({result_.cameras[c].free, c > 0});
        for (const CalibratedDevice& projector : result_.projectors) free.projectors.push_back({projector.free, true});
        free.bodies.assign(views_.size(), true);
        for (std::size_t v = 0; v < views_.size(); ++v) free.bodies[v] = boardPlaced_[v];
        InstallationNoise noise;
        InstallationNames names;
        for (const NamedDevice& camera : cameras_) names.cameras.push_back(camera.name);
        for (const NamedDevice& projector : projectors_) names.projectors.push_back(projector.name);
        for (const InstallationView& view : views_) names.bodies.push_back(view.name);
        for (int round = 0; round < 2; ++round) {
            progress_.throwIfCancelled();
            progress_.report(0.7 + 0.1 * round, "solving for all together");
            refineInstallation(observations_, free, noise, state_);
            noise.camera =
                std::max(kSteady, sigmaOf(errorsOfKind(observations_.points, [](const auto&) { return true; }), 0.0));
            noise.projector =
                std::max(kSteady, sigmaOf(errorsOfKind(observations_.lights, [](const auto&) { return true; }), 0.0));
            const std::vector<Finding> dropped = dropOutliers(observations_, state_, noise, names);
            result_.warnings.insert(result_.warnings.end(), dropped.begin(), dropped.end());
        }
        progress_.throwIfCancelled();
        progress_.report(0.9, "uncertainties");
        result_.sigma = installationSigmas(observations_, free, noise, state_);
    }

    template <typename Seen, typename Which>
    [[nodiscard]] std::vector<cv::Point2d> errorsOfKind(const std::vector<Seen>& all, const Which& which) const {
        std::vector<Seen> chosen;
        std::ranges::copy_if(all, std::back_inserter(chosen), which);
        std::vector<cv::Point2d> errors;
        for (const auto& error : errorsOf(chosen, state_))
            errors.push_back(error.value_or(cv::Point2d(kNotThere, kNotThere)));
        return errors;
    }
    template <typename Seen, typename Which>
    [[nodiscard]] double rmsOfKind(const std::vector<Seen>& all, const Which& which) const {
        return rmsOf(errorsOfKind(all, which));
    }

    void report() {
        const auto take = [](CalibratedDevice& device, const InstallationState::Device& solved,
                             const InstallationState::Device& sigma, const NamedDevice& named, double rms) {
            device.size = named.size;
            device.lens = solved.lens;
            device.sigma = sigma.lens;
            device.rms = rms;
        };
        double squares = 0.0;
        for (std::size_t c = 0; c < cameras_.size(); ++c) {
            const double rms =
                rmsOfKind(observations_.points, [&](const auto& s) { return s.camera == static_cast<int>(c); });
            take(result_.cameras[c], state_.cameras[c], result_.sigma.cameras[c], cameras_[c], rms);
            squares += rms * rms;
        }
        for (std::size_t p = 0; p < projectors_.size(); ++p) {
            const double rms =
                rmsOfKind(observations_.lights, [&](const auto& s) { return s.projector == static_cast<int>(p); });
            take(result_.projectors[p], state_.projectors[p], result_.sigma.projectors[p], projectors_[p], rms);
            squares += rms * rms;
        }
        result_.rms = std::sqrt(squares / static_cast<double>(cameras_.size() + projectors_.size()));
        double worst = -1.0;
        for (std::size_t v = 0; v < views_.size(); ++v) {
            const auto ofView = [&](const auto& seen) { return seen.body == static_cast<int>(v); };
            result_.views.push_back({views_[v].name, rmsOfKind(observations_.points, ofView),
                                     rmsOfKind(observations_.lights, ofView), std::nullopt});
            const double error = std::hypot(result_.views.back().cameraRms, result_.views.back().projectorRms);
            if (error <= worst) continue;
            worst = error;
            result_.worstView = views_[v].name;
        }
        result_.state = state_;
        if (result_.rms < kWorstFit) return;
        std::ostringstream why;
        why.precision(2);
        why << std::fixed << "each camera fits by itself, but not all together: " << result_.rms << " pixels remain";
        throw CaptureRefused({Cause::modelDoesNotFit, result_.worstView, "", why.str(),
                              "check that the board rested while all cameras looked, and that no device was moved"});
    }

    std::vector<InstallationView> views_;
    const std::vector<NamedDevice>&cameras_, &projectors_;
    const Progress& progress_;
    std::vector<std::vector<Rigid>> boards_; ///< by camera and view, from the camera alone
    std::vector<bool> cameraPlaced_, projectorPlaced_, boardPlaced_;
    InstallationState state_;
    InstallationObservations observations_;
    InstallationCalibration result_;
};

} // namespace

InstallationCalibration calibrateInstallation(const std::vector<InstallationView>& views,
                                              const std::vector<NamedDevice>& cameras,
                                              const std::vector<NamedDevice>& projectors, const Progress& progress) {
    return InstallationSolver(views, cameras, projectors, progress).solve();
}

} // namespace lumorph
