#include "calibration/verify/moved_part.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include <Eigen/Dense>

#include "core/base/error.h"

namespace lumorph {

namespace {

constexpr double kFreedom = 3.0;         // of Student's distribution, by which strays count little
constexpr double kMostIndependent = 300; // points: neighbours share their errors
constexpr double kWorthwhile = 10.0;     // log likelihood by which a cause must explain more
constexpr double kAlike = 6.0;           // log likelihood within which two causes are not told apart
constexpr int kFitSteps = 9;
constexpr double kTurnKnown = 0.03; // radians, shift metres, strokes: that nobody believes to be exceeded
constexpr double kShiftKnown = 0.05;
constexpr double kStrokeKnown = 0.3;
constexpr double kMoves = 1e-6;  // square metres by unit: what moves less stands still
constexpr double kFarOff = 20.0; // standard deviations that a point which misses everything counts as

struct FitSystem {
    Eigen::MatrixXd matrix; ///< normal matrix of what is free, likewise the others
    Eigen::VectorXd vector;
    Eigen::MatrixXd beside;  ///< mean of beside' beside, by part on its diagonal
    Eigen::VectorXd seen;    ///< weight with which each number was seen
    double likelihood = 0.0; ///< negative logarithm, of all points
    std::vector<double> errors;
    std::vector<double> onSurface; ///< metres
};

/// What is added up: on the way to a solution its equations are enough, at its end one asks what it is worth.
enum class Sums { equations, all };

struct Fit {
    Eigen::VectorXd motion;
    FitSystem at;
};

class MotionSearch {
public:
    MotionSearch(const Rig& rig, const Installation& believed, std::span<const LitShot> shots,
                 const MovedPartOptions& options, const Progress& progress)
        : rig_(rig), believed_(believed), options_(options), progress_(progress), parts_(partsOf(believed, rig)) {
        check(shots);
        keepSome(shots);
        for (const LitShot& shot : shots_) {
            points_ += shot.points.size();
            unmoved_.emplace_back(believed, rig, shot.strokes);
        }
    }

    MovedParts search() {
        progress_.report(0.05, "looking for what moved");
        std::vector<RoomPart> all;
        for (const RoomPart& part : parts_.all())
            if (isSeen(part)) all.push_back(part);
        noise_ = 4.0 * options_.leastNoise;
        const Eigen::VectorXd still = Eigen::VectorXd::Zero(parts_.size());
        for (int i = 0; i < 2; ++i) noise_ = std::max(options_.leastNoise, 0.85 * median(fit(all, still).at.errors));
        chooseParts(all);
        dropStill();
        return result();
    }

private:
    void check(std::span<const LitShot> shots) const {
        if (options_.camera >= believed_.cameras.size())
            throw InvalidInput("installation", "it has no such camera", "add one in the studio");
        for (const LitShot& shot : shots)
            for (const LitPoint& point : shot.points)
                if (point.projector >= believed_.projectors.size())
                    throw InvalidInput("light that was seen", "it is of a projector that the room does not have",
                                       "count projectors from 0");
    }

    /// Evenly thinned, so that many causes are compared quickly.
    void keepSome(std::span<const LitShot> shots) {
        std::size_t count = 0;
        for (const LitShot& shot : shots) count += shot.points.size();
        const std::size_t most = std::max<std::size_t>(1, options_.mostPoints);
        const std::size_t step = std::max<std::size_t>(1, (count + most - 1) / most);
        for (const LitShot& shot : shots) {
            LitShot& some = shots_.emplace_back(LitShot{shot.strokes, {}});
            for (std::size_t i = 0; i < shot.points.size(); i += step) some.points.push_back(shot.points[i]);
        }
    }

    [[nodiscard]] bool isSeen(const RoomPart& part) const {
        if (part.kind != RoomPart::Kind::projector) return true;
        return std::ranges::any_of(shots_, [&](const LitShot& shot) {
            return std::ranges::any_of(shot.points, [&](const LitPoint& p) { return p.projector == part.index; });
        });
    }

    static double median(std::vector<double> values) {
        if (values.empty()) return 0.0;
        const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
        std::ranges::nth_element(values, middle);
        return *middle;
    }

    /// All equations at a motion, added up with the weights of Student's distribution at this noise.
    [[nodiscard]] FitSystem systemAt(const Eigen::VectorXd& motion, double noise, Sums sums = Sums::equations) const {
        const Eigen::Index size = parts_.size();
        FitSystem system{Eigen::MatrixXd::Zero(size, size),
                         Eigen::VectorXd::Zero(size),
                         Eigen::MatrixXd::Zero(size, size),
                         Eigen::VectorXd::Zero(size),
                         0.0,
                         {},
                         {}};
        const Installation room = movedBy(believed_, parts_, motion, options_.camera);
        const LightModel model(room, parts_, options_.camera);
        // Most causes move light and camera alone: then the surface is the one that was believed.
        const Eigen::Index first = parts_.device().first;
        const bool isUnmoved = (motion.tail(size - first).array() == 0.0).all();
        for (std::size_t s = 0; s < shots_.size(); ++s) {
            std::optional<RoomSurface> moved;
            if (!isUnmoved) moved.emplace(room, rig_, movedBy(shots_[s].strokes, parts_, motion));
            const RoomSurface& surface = isUnmoved ? unmoved_[s] : *moved;
            for (const LitPoint& point : shots_[s].points) {
                const auto equation = model.equation(surface, point);
                equation ? add(system, *equation, point, noise, sums) : addMissing(system);
            }
        }
        return system;
    }

    static void addMissing(FitSystem& system) {
        system.likelihood += 0.5 * (kFreedom + 2.0) * std::log1p(kFarOff * kFarOff / kFreedom);
    }

    void add(FitSystem& system, const LightEquation& equation, const LitPoint& point, double noise, Sums sums) const {
        const Eigen::Matrix2d information = point.information / (noise * noise);
        const Eigen::Vector2d weighted = information * equation.error;
        const double squared = equation.error.dot(weighted);
        const double weight = (kFreedom + 2.0) / (kFreedom + squared);
        system.likelihood += 0.5 * (kFreedom + 2.0) * std::log1p(squared / kFreedom);
        system.matrix.noalias() += weight * equation.byMotion.transpose() * information * equation.byMotion;
        system.vector.noalias() -= weight * equation.byMotion.transpose() * weighted;
        system.errors.push_back(noise * std::sqrt(squared));
        if (sums == Sums::equations) return;
        const Eigen::MatrixXd spread = equation.beside.transpose() * equation.beside;
        const double sound = std::min(1.0, weight);
        system.beside += sound * spread;
        system.seen += sound * spread.diagonal().unaryExpr([](double s) { return s > kMoves ? 1.0 : 0.0; });
        // A pixel's width on the surface is how far one pixel of the error reaches there.
        const Eigen::Index shift = parts_.projector(point.projector).first + 3;
        system.onSurface.push_back(equation.error.norm() * equation.beside.middleCols<3>(shift).norm() /
                                   std::max(1e-9, equation.byMotion.middleCols<3>(shift).norm()));
    }

    [[nodiscard]] double knownTo(const RoomPart& part, Eigen::Index number) const {
        if (part.kind == RoomPart::Kind::servo) return kStrokeKnown;
        return number < 3 ? kTurnKnown : kShiftKnown;
    }

    /// The normal matrix of free parts, with what is known beforehand; all else is held.
    [[nodiscard]] Eigen::MatrixXd heldMatrix(const FitSystem& system, const std::vector<RoomPart>& free) const {
        Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(parts_.size(), parts_.size());
        for (const RoomPart& row : free)
            for (const RoomPart& column : free)
                matrix.block(row.first, column.first, row.count, column.count) =
                    system.matrix.block(row.first, column.first, row.count, column.count);
        for (const RoomPart& part : free)
            for (Eigen::Index i = 0; i < part.count; ++i)
                matrix(part.first + i, part.first + i) += 1.0 / (knownTo(part, i) * knownTo(part, i));
        return matrix;
    }

    [[nodiscard]] Fit fit(const std::vector<RoomPart>& free, const Eigen::VectorXd& start) const {
        Fit fit{start, {}};
        for (const RoomPart& part : parts_.all())
            if (std::ranges::find(free, part) == free.end()) fit.motion.segment(part.first, part.count).setZero();
        double scale = 0.0;
        for (int step = 0; step < kFitSteps && !free.empty(); ++step) {
            progress_.throwIfCancelled();
            // From afar every point is a stray; the yardstick is as long as what is left, until that is noise.
            if (step == 0) scale = std::max(noise_, median(systemAt(fit.motion, noise_).errors));
            const FitSystem system = systemAt(fit.motion, scale);
            Eigen::VectorXd vector = Eigen::VectorXd::Zero(parts_.size());
            for (const RoomPart& part : free)
                for (Eigen::Index i = part.first; i < part.first + part.count; ++i) {
                    const double known = knownTo(part, i - part.first);
                    vector[i] = system.vector[i] - fit.motion[i] / (known * known);
                }
            const Eigen::VectorXd move = heldMatrix(system, free).ldlt().solve(vector);
            fit.motion += move;
            const double before = scale;
            scale = std::max(noise_, std::min(scale, 0.85 * median(system.errors)));
            if (move.norm() < 1e-6 && scale == before) break;
        }
        fit.at = systemAt(fit.motion, noise_, Sums::all);
        return fit;
    }

    /// Log likelihood lost, as if points were so few that they are independent.
    [[nodiscard]] double costOf(const Fit& fit) const {
        const double share = std::min(1.0, kMostIndependent / std::max(1.0, static_cast<double>(points_)));
        return share * fit.at.likelihood;
    }

    void chooseParts(const std::vector<RoomPart>& all) {
        best_ = fit({}, Eigen::VectorXd::Zero(parts_.size()));
        while (free_.size() < options_.mostParts) {
            std::optional<Fit> next;
            RoomPart chosen;
            std::vector<std::pair<RoomPart, double>> costs;
            for (const RoomPart& part : all) {
                if (std::ranges::find(free_, part) != free_.end()) continue;
                std::vector<RoomPart> more = free_;
                more.push_back(part);
                Fit tried = fit(more, best_.motion);
                costs.emplace_back(part, costOf(tried));
                if (next && costOf(*next) <= costs.back().second) continue;
                next = std::move(tried);
                chosen = part;
            }
            if (!next || costOf(best_) - costOf(*next) < kWorthwhile + 0.5 * static_cast<double>(chosen.count)) return;
            best_ = std::move(*next);
            free_.push_back(chosen);
            alike_.clear();
            for (const auto& [part, cost] : costs)
                if (part != chosen && cost - costOf(best_) < kAlike) alike_.push_back(part);
        }
    }

    [[nodiscard]] PartMotion motionOf(const RoomPart& part, const std::vector<RoomPart>& free) const {
        const auto block = [&](const Eigen::MatrixXd& of) {
            return of.block(part.first, part.first, part.count, part.count);
        };
        const double seen = std::max(1e-9, best_.at.seen.segment(part.first, part.count).maxCoeff());
        const Eigen::MatrixXd mean = block(best_.at.beside) / seen;
        const Eigen::VectorXd motion = best_.motion.segment(part.first, part.count);
        const double share = std::min(1.0, kMostIndependent / std::max(1.0, static_cast<double>(points_)));
        const Eigen::MatrixXd all = heldMatrix(best_.at, free).inverse() / share;
        return {part, std::sqrt(std::max(0.0, motion.dot(mean * motion))),
                std::sqrt(std::max(0.0, (mean * block(all)).trace()))};
    }

    /// What was freed first may have been mistaken for what was freed later.
    void dropStill() {
        for (std::size_t i = free_.size(); i-- > 0;) {
            const PartMotion motion = motionOf(free_[i], free_);
            if (motion.beside >= std::max(options_.least, 3.0 * motion.sigma)) continue;
            std::vector<RoomPart> fewer = free_;
            fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(i));
            best_ = fit(fewer, best_.motion);
            free_ = std::move(fewer);
        }
    }

    [[nodiscard]] MovedParts result() const {
        MovedParts moved;
        for (const RoomPart& part : free_) moved.parts.push_back(motionOf(part, free_));
        std::ranges::sort(moved.parts, std::greater{}, &PartMotion::beside);
        if (free_.size() == 1) moved.couldAlsoBe = alike_;
        moved.motion = best_.motion;
        moved.noise = noise_;
        moved.unexplained = median(best_.at.onSurface);
        moved.compared = points_;
        const double most = 8.0 * noise_;
        moved.points = static_cast<std::size_t>(
            std::ranges::count_if(best_.at.errors, [&](double error) { return error < most; }));
        return moved;
    }

    const Rig& rig_;
    const Installation& believed_;
    MovedPartOptions options_;
    const Progress& progress_;
    RoomParts parts_;
    std::vector<LitShot> shots_;
    std::vector<RoomSurface> unmoved_; ///< one a shot, as it is believed to stand
    std::size_t points_ = 0;
    double noise_ = 0.15;
    Fit best_;
    std::vector<RoomPart> free_, alike_;
};

} // namespace

MovedParts movedParts(const Rig& rig, const Installation& believed, std::span<const LitShot> shots,
                      const MovedPartOptions& options, const Progress& progress) {
    return MotionSearch(rig, believed, shots, options, progress).search();
}

} // namespace lumorph
