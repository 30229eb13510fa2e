#include "calibration/solve/mirror_calibration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <sstream>
#include <utility>

#include <Eigen/Dense>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "calibration/solve/first_guess.h"
#include "calibration/solve/installation_bundle.h"

namespace lumorph {

namespace {

constexpr std::size_t kLightsOfMirrorView = 600;
constexpr double kLeastNoise = 0.01; // pixels
constexpr double kMirrorFits = 2.0;  // pixels
constexpr double kFewestDirect = 4;  // points of a board

/// The picture of a mirror image, turned left for right, is an ordinary picture by this lens.
Lens leftForRight(Lens lens, cv::Size size) {
    lens[kPrincipalX] = size.width - 1 - lens[kPrincipalX];
    lens[kP2] = -lens[kP2];
    return lens;
}

Eigen::Matrix3d eigenOf(const glm::dmat3& matrix) { return Eigen::Map<const Eigen::Matrix3d>(&matrix[0][0]); }

class MirrorSolver {
public:
    MirrorSolver(const std::vector<MirrorView>& views, cv::Size camera, cv::Size projector, const Progress& progress)
        : views_(views), camera_(camera), projector_(projector), progress_(progress) {}

    MirrorCalibration solve() {
        turned_ = turnedViews();
        result_.procam = calibrateProcam(turned_, camera_, projector_, {}, progress_.part(0.0, 0.8));
        result_.procam.camera.lens = leftForRight(result_.procam.camera.lens, camera_);
        result_.procam.state.camera = result_.procam.camera.lens;
        if (const auto mirror = firstMirror()) {
            refineWith(*mirror);
        } else {
            result_.procam.warnings.push_back(
                {Cause::mirrorUnknown, "", "",
                 "no pose was seen both in the mirror and past it, so that the projector's lens is known but not where "
                 "it stands",
                 "place the board once so that the camera sees it directly too"});
        }
        return std::move(result_);
    }

private:
    [[nodiscard]] std::vector<ViewObservations> turnedViews() const {
        std::vector<ViewObservations> turned;
        const auto turn = [this](cv::Point2d pixel) { return cv::Point2d(camera_.width - 1 - pixel.x, pixel.y); };
        for (const MirrorView& view : views_) {
            turned.push_back({view.name, view.mirrored, view.light});
            for (cv::Point2d& pixel : turned.back().corners.seen) pixel = turn(pixel);
            for (ProjectorPoint& point : turned.back().projector) point.camera = turn(point.camera);
        }
        return turned;
    }

    [[nodiscard]] static bool seenDirectly(const MirrorView& view) {
        return static_cast<double>(view.direct.seen.size()) >= kFewestDirect;
    }

    /// What takes the camera's frame to that of its mirror image, turned left for right, and back to the right.
    struct Reflection {
        Eigen::Matrix3d turn;
        Eigen::Vector3d shift;
    };

    /// A board's pose b -> D b in the camera, and b -> M b in its image turned left for right by F = diag(-1, 1, 1),
    /// differ by the reflection S: M = F S D, so S = F M D^-1.
    [[nodiscard]] Reflection reflectionOf(std::size_t v, const BoardPoints& direct) const {
        const Eigen::DiagonalMatrix<double, 3> flip(-1.0, 1.0, 1.0);
        const PoseVector pose = poseFromCamera({views_[v].name, direct, {}}, result_.procam.camera.lens);
        const Rigid both = Rigid::exp(result_.procam.state.cameraFromBoard[v]) * Rigid::exp(pose).inverse();
        const glm::dvec3& way = both.translation;
        return {flip * eigenOf(both.rotation), flip * Eigen::Vector3d(way.x, way.y, way.z)};
    }

    /// How far it is from a reflection: such a one is symmetric, and shifts along the direction that it turns round.
    [[nodiscard]] static double oddness(const Reflection& seen) {
        return (seen.turn - seen.turn.transpose()).norm() +
               (seen.turn * seen.shift + seen.shift).norm() / std::max(seen.shift.norm(), 1e-12);
    }

    /// From all boards that were seen both ways: the direction that is turned round, and half the shift along it.
    std::optional<std::array<double, 3>> firstMirror() {
        Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
        Eigen::Vector3d shift = Eigen::Vector3d::Zero();
        double count = 0.0;
        for (std::size_t v = 0; v < views_.size(); ++v) {
            if (!seenDirectly(views_[v])) continue;
            Reflection seen = reflectionOf(v, views_[v].direct);
            if (const auto turned = turnedBoard(views_[v].direct.board)) {
                const Reflection other = reflectionOf(v, {*turned, views_[v].direct.seen});
                if (oddness(other) < oddness(seen)) seen = other;
            }
            sum += seen.turn;
            shift += seen.shift;
            count += 1.0;
        }
        if (count == 0.0) return std::nullopt;
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solved(0.5 * (sum + sum.transpose()) / count);
        const Eigen::Vector3d normal = solved.eigenvectors().col(0);
        const Eigen::Vector3d nearest = 0.5 * normal.dot(shift / count) * normal;
        if (!(nearest.norm() > 0.0)) return std::nullopt;
        return std::array<double, 3>{nearest.x(), nearest.y(), nearest.z()};
    }

    /// Poses of the image turned left for right as they truly are: behind F S.
    void refineWith(const std::array<double, 3>& mirror) {
        InstallationState state;
        state.mirror = mirror;
        state.board = result_.procam.state.board;
        const glm::dvec3 nearest(mirror[0], mirror[1], mirror[2]);
        const glm::dvec3 normal = glm::normalize(nearest);
        glm::dmat3 flip(1.0);
        flip[0][0] = -1.0;
        const Rigid turnedFromCamera(flip * (glm::dmat3(1.0) - 2.0 * glm::outerProduct(normal, normal)),
                                     flip * (2.0 * nearest));
        const ProcamCalibration& procam = result_.procam;
        state.cameras = {{procam.camera.lens, PoseVector{}}};
        state.projectors = {{procam.projector.lens, (Rigid::exp(procam.projectorFromCamera) * turnedFromCamera).log()}};
        for (const PoseVector& board : procam.state.cameraFromBoard)
            state.worldFromBody.push_back((turnedFromCamera.inverse() * Rigid::exp(board)).log());
        nameBoards(state);
        gather();
        InstallationFree free;
        free.cameras = {{procam.camera.free, false}};
        free.projectors = {{procam.projector.free, true}};
        free.bodies.assign(views_.size(), true);
        free.mirror = true;
        InstallationNoise noise;
        InstallationNames names{{"the camera"}, {"the projector"}, {}};
        for (const MirrorView& view : views_) names.bodies.push_back(view.name);
        // What was left out before is here again, and is named again.
        std::erase_if(result_.procam.warnings, [](const Finding& w) { return w.cause == Cause::pointSuspicious; });
        for (int round = 0; round < 2; ++round) {
            progress_.throwIfCancelled();
            progress_.report(0.8 + 0.05 * round, "solving with the mirror");
            refineInstallation(observations_, free, noise, state);
            noise.camera = std::max(kLeastNoise, sigmaOf(errorsOfSeen(observations_.points, state), 0.0));
            noise.projector = std::max(kLeastNoise, sigmaOf(errorsOfSeen(observations_.lights, state), 0.0));
            const std::vector<Finding> dropped = dropOutliers(observations_, state, noise, names);
            result_.procam.warnings.insert(result_.procam.warnings.end(), dropped.begin(), dropped.end());
        }
        takeResult(state, installationSigmas(observations_, free, noise, state));
    }

    /// A board that looks the same when turned may have been found so in one of both ways.
    void nameBoards(const InstallationState& state) {
        direct_.clear();
        for (std::size_t v = 0; v < views_.size(); ++v) {
            direct_.push_back(views_[v].direct);
            if (!seenDirectly(views_[v])) continue;
            const auto error = [&](const BoardPoints& corners) {
                return rmsOf(cameraErrors({views_[v].name, corners, {}},
                                          {state.cameras[0].lens, {}, {}, result_.procam.state.board, {}},
                                          state.worldFromBody[v]));
            };
            if (auto turned = turnedBoard(views_[v].direct.board)) {
                BoardPoints other{std::move(*turned), views_[v].direct.seen};
                if (error(other) < error(direct_[v])) direct_[v] = std::move(other);
            }
        }
    }

    void gather() {
        for (std::size_t v = 0; v < views_.size(); ++v) {
            const int body = static_cast<int>(v);
            const auto add = [&](const BoardPoints& corners, bool mirrored) {
                for (std::size_t i = 0; i < corners.seen.size(); ++i)
                    observations_.points.push_back({0, body, mirrored, corners.board[i], corners.seen[i]});
            };
            add(views_[v].mirrored, true);
            const auto& light = views_[v].light;
            const std::size_t used = std::min(light.size(), kLightsOfMirrorView);
            for (std::size_t i = 0; i < used; ++i)
                observations_.lights.push_back({0, 0, body, true, light[i * light.size() / used]});
            if (seenDirectly(views_[v])) add(direct_[v], false);
        }
    }

    template <typename Seen>
    static std::vector<cv::Point2d> errorsOfSeen(std::vector<Seen> all, const InstallationState& state, int body = -1) {
        if (body >= 0) std::erase_if(all, [body](const Seen& seen) { return seen.body != body; });
        std::vector<cv::Point2d> errors;
        for (const auto& error : errorsOf(all, state)) errors.push_back(error.value_or(cv::Point2d(100.0, 100.0)));
        return errors;
    }

    void takeResult(const InstallationState& state, const InstallationState& sigma) {
        ProcamCalibration& procam = result_.procam;
        procam.camera.lens = state.cameras[0].lens;
        procam.camera.sigma = sigma.cameras[0].lens;
        procam.camera.rms = rmsOf(errorsOfSeen(observations_.points, state));
        procam.projector.lens = state.projectors[0].lens;
        procam.projector.sigma = sigma.projectors[0].lens;
        procam.projector.rms = rmsOf(errorsOfSeen(observations_.lights, state));
        procam.projectorFromCamera = state.projectors[0].fromWorld;
        procam.projectorFromCameraSigma = sigma.projectors[0].fromWorld;
        procam.rms = std::hypot(procam.camera.rms, procam.projector.rms) / std::numbers::sqrt2;
        procam.state = {procam.camera.lens, procam.projector.lens, procam.projectorFromCamera, procam.state.board,
                        state.worldFromBody};
        double worst = -1.0;
        for (std::size_t v = 0; v < views_.size(); ++v) {
            ViewQuality& view = procam.views[v];
            view.cameraRms = rmsOf(errorsOfSeen(observations_.points, state, static_cast<int>(v)));
            view.projectorRms = rmsOf(errorsOfSeen(observations_.lights, state, static_cast<int>(v)));
            const double error = std::hypot(view.cameraRms, view.projectorRms);
            if (error > worst) procam.worstView = view.name;
            worst = std::max(worst, error);
        }
        const cv::Vec3d nearest(state.mirror[0], state.mirror[1], state.mirror[2]);
        const cv::Vec3d spread(sigma.mirror[0], sigma.mirror[1], sigma.mirror[2]);
        const double distance = cv::norm(nearest);
        result_.mirror = MirrorPlane{nearest / distance, distance, cv::norm(spread) / distance, cv::norm(spread)};
        if (procam.rms < kMirrorFits) return;
        std::ostringstream why;
        why.precision(2);
        why << std::fixed << "what is seen directly contradicts what is seen in the mirror: " << procam.rms
            << " pixels remain";
        throw CaptureRefused(
            {Cause::modelDoesNotFit, procam.worstView, "", why.str(),
             "check that mirror and camera stood still and that the mirror is flat; board points of the "
             "mirror image must be found in the picture turned left for right"});
    }

    const std::vector<MirrorView>& views_;
    cv::Size camera_, projector_;
    const Progress& progress_;
    std::vector<ViewObservations> turned_; ///< the pictures turned left for right
    std::vector<BoardPoints> direct_;
    InstallationObservations observations_;
    MirrorCalibration result_;
};

} // namespace

MirrorCalibration calibrateMirrored(const std::vector<MirrorView>& views, cv::Size camera, cv::Size projector,
                                    const Progress& progress) {
    return MirrorSolver(views, camera, projector, progress).solve();
}

} // namespace lumorph
