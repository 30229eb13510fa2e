#include "core/rig/sheet/joint_states.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <optional>
#include <utility>

#include <Eigen/Eigenvalues>
#include <glm/geometric.hpp>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "core/base/error.h"

namespace lumorph {
namespace {

/// Shapes whose nodes differ by less are the same equilibrium, metres.
constexpr double kSameShape = 1e-3;
constexpr int kSteps = 3;

/// A grid of joint states, numbered with the last lever's level running fastest.
struct StateGrid {
    std::size_t levers;
    int levels;

    [[nodiscard]] std::size_t size() const {
        std::size_t size = 1;
        for (std::size_t l = 0; l < levers; ++l) size *= static_cast<std::size_t>(levels);
        return size;
    }
    [[nodiscard]] std::vector<int> levelsOf(std::size_t state) const {
        std::vector<int> result(levers);
        for (std::size_t l = levers; l-- > 0; state /= static_cast<std::size_t>(levels))
            result[l] = static_cast<int>(state % static_cast<std::size_t>(levels));
        return result;
    }
    [[nodiscard]] std::size_t numberOf(const std::vector<int>& state) const {
        std::size_t number = 0;
        for (const int level : state)
            number = number * static_cast<std::size_t>(levels) + static_cast<std::size_t>(level);
        return number;
    }
    [[nodiscard]] std::vector<double> strokesOf(std::size_t state) const {
        std::vector<double> strokes;
        for (const int level : levelsOf(state)) strokes.push_back(level / double(levels - 1));
        return strokes;
    }
    [[nodiscard]] std::size_t mirrored(std::size_t state, const MeshMirror& mirror) const {
        const std::vector<int> from = levelsOf(state);
        std::vector<int> to(levers);
        for (std::size_t l = 0; l < levers; ++l) to[mirror.levers[l]] = from[l];
        return numberOf(to);
    }
    /// The highest lever one level lower, the first of those as high.
    [[nodiscard]] std::size_t lowerNeighbour(std::size_t state) const {
        std::vector<int> lower = levelsOf(state);
        --*std::ranges::max_element(lower);
        return numberOf(lower);
    }
};

/// Whether levers that are mirror images lift alike.
bool leversAlike(const std::vector<SheetLever>& levers, const MeshMirror& mirror) {
    for (std::size_t l = 0; l < levers.size(); ++l) {
        const SheetLever& image = levers[mirror.levers[l]];
        if (image.arm != levers[l].arm || image.rest != levers[l].rest || image.end != levers[l].end) return false;
    }
    return true;
}

double farthestNode(const SheetState& a, const SheetState& b) {
    double largest = 0.0;
    for (std::size_t k = 0; k < a.positions.size(); ++k)
        largest = std::max(largest, glm::distance(a.positions[k], b.positions[k]));
    return largest;
}

class Baker {
public:
    Baker(const ElasticSheet& sheet, const BakeSettings& settings, const Progress& progress)
        : sheet_(sheet), settings_(settings), progress_(progress),
          mesh_(meshSheet(sheet, settings.edgeLength)), grid_{sheet.levers.size(), settings.levels},
          solvers_([this] { return LeveredSheet(sheet_, mesh_); }) {
        for (const MeshMirror& mirror : mesh_.mirrors)
            if (leversAlike(sheet.levers, mirror)) mirrors_.push_back(mirror);
        chooseStates();
    }

    JointStates bake() {
        solve();
        findSeconds();
        progress_.report(kModesBegin, "modes");
        JointStates result{mesh_, modes(), {}, {}};
        result.seconds = std::move(seconds_);
        summarise(result);
        return result;
    }

private:
    static constexpr double kSecondsBegin = 0.7;
    static constexpr double kModesBegin = 0.95;

    /// Of states that are mirror images of one another, the one with the lowest number is solved.
    void chooseStates() {
        source_.resize(grid_.size());
        for (std::size_t state = 0; state < grid_.size(); ++state) {
            Source& source = source_[state];
            source.state = state;
            for (std::size_t images = 1; images < std::size_t{1} << mirrors_.size(); ++images) {
                std::size_t image = state;
                for (std::size_t m = 0; m < mirrors_.size(); ++m)
                    if ((images >> m & 1) != 0) image = grid_.mirrored(image, mirrors_[m]);
                if (image < source.state) source = {image, images};
            }
            if (source.state == state) chosen_.push_back(state);
        }
        poses_.resize(grid_.size());
        hasSecond_.resize(grid_.size());
    }

    /// Calls `work` with a solver for each chosen state, in parallel.
    template <typename Work> void forEachChosen(double begin, double end, const char* stage, Work&& work) {
        std::atomic<std::size_t> done = 0;
        std::mutex reporting;
        tbb::parallel_for(std::size_t{0}, chosen_.size(), [&](std::size_t k) {
            progress_.throwIfCancelled();
            work(solvers_.local(), chosen_[k]);
            const std::lock_guard lock(reporting);
            progress_.report(begin + (end - begin) * double(++done) / double(chosen_.size()), stage);
        });
    }

    void solve() {
        forEachChosen(0.0, kSecondsBegin, "joint states", [this](LeveredSheet& solver, std::size_t state) {
            poses_[state] = solver.followed(grid_.strokesOf(state), kSteps);
        });
    }

    void findSeconds() {
        std::mutex adding;
        forEachChosen(kSecondsBegin, kModesBegin, "second equilibria", [&](LeveredSheet& solver, std::size_t state) {
            if (state == 0) return;
            SheetPose from = *poses_[source_[grid_.lowerNeighbour(state)].state];
            const SheetPose& first = *poses_[state];
            from.state = mirroredState(from.state, source_[grid_.lowerNeighbour(state)].images);
            const auto second = solver.polished(from.state, first.strokes);
            if (!second) return;
            const std::lock_guard lock(adding);
            iterations_ += second->iterations;
            const double distance = farthestNode(second->state, first.state);
            if (distance <= kSameShape) return;
            seconds_.push_back({first.strokes, distance, second->energy - first.energy});
            hasSecond_[state] = true;
        });
        std::ranges::sort(seconds_, {}, &SecondEquilibrium::strokes);
    }

    /// The image of a state under the mirrors whose bits are set.
    [[nodiscard]] SheetState mirroredState(SheetState state, std::size_t images) const {
        for (std::size_t m = 0; m < mirrors_.size(); ++m)
            if ((images >> m & 1) != 0) state = mirrored(mesh_, mirrors_[m], state);
        return state;
    }

    /// One column a grid state, three rows a node.
    [[nodiscard]] Eigen::MatrixXd displacements() const {
        const std::vector<glm::dvec3> rest = flatState(mesh_).positions;
        Eigen::MatrixXd all(static_cast<Eigen::Index>(3 * rest.size()), static_cast<Eigen::Index>(grid_.size()));
        for (std::size_t state = 0; state < grid_.size(); ++state) {
            const auto& [source, images] = source_[state];
            const SheetState shape = mirroredState(poses_[source]->state, images);
            for (std::size_t v = 0; v < rest.size(); ++v)
                for (int axis = 0; axis < 3; ++axis)
                    all(static_cast<Eigen::Index>(3 * v) + axis, static_cast<Eigen::Index>(state)) =
                        shape.positions[v][axis] - rest[v][axis];
        }
        return all;
    }

    /// Singular vectors of the displacements, by the eigenvectors of their Gram matrix, until the rest is small enough.
    [[nodiscard]] SheetModes modes() const {
        const Eigen::MatrixXd all = displacements();
        const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> gram(all.transpose() * all);
        Eigen::MatrixXd rest = all;
        std::vector<Eigen::VectorXd> shapes, coefficients;
        const auto most = std::min<Eigen::Index>(
            all.cols(), std::min(SheetModes::kMostModes, SheetModes::kMostCoefficients / grid_.size()));
        for (Eigen::Index k = 0; k < most && farthest(rest) > settings_.truncation; ++k) {
            shapes.emplace_back((all * gram.eigenvectors().col(all.cols() - 1 - k)).normalized());
            coefficients.emplace_back(all.transpose() * shapes.back());
            rest -= shapes.back() * coefficients.back().transpose();
        }
        SheetModes modes;
        modes.strokes.assign(grid_.levers, strokesOf(grid_.levels));
        modes.modeCount = shapes.size();
        for (Eigen::Index state = 0; state < all.cols(); ++state)
            for (const Eigen::VectorXd& values : coefficients)
                modes.coefficients.push_back(static_cast<float>(values[state]));
        for (Eigen::Index v = 0; v < all.rows(); v += 3)
            for (const Eigen::VectorXd& shape : shapes) modes.modes.emplace_back(shape[v], shape[v + 1], shape[v + 2]);
        for (const Source& source : source_) modes.secondStates += hasSecond_[source.state] ? 1 : 0;
        for (const SecondEquilibrium& second : seconds_)
            modes.secondDistance = std::max(modes.secondDistance, static_cast<float>(second.distance));
        return modes;
    }

    /// Of a lever: 0, 1 and equally spaced ones between.
    static std::vector<float> strokesOf(int levels) {
        std::vector<float> strokes(static_cast<std::size_t>(levels));
        for (int level = 0; level < levels; ++level)
            strokes[static_cast<std::size_t>(level)] = static_cast<float>(level) / static_cast<float>(levels - 1);
        return strokes;
    }

    /// The longest displacement of a node.
    static double farthest(const Eigen::MatrixXd& displacements) {
        double squared = 0.0;
        for (Eigen::Index state = 0; state < displacements.cols(); ++state)
            for (Eigen::Index v = 0; v < displacements.rows(); v += 3)
                squared = std::max(squared, displacements.col(state).segment<3>(v).squaredNorm());
        return std::sqrt(squared);
    }

    void summarise(JointStates& result) const {
        result.largestLoads.resize(grid_.levers);
        result.solved = static_cast<int>(chosen_.size());
        result.iterations = iterations_;
        for (const std::size_t state : chosen_) {
            const SheetPose& pose = *poses_[state];
            result.iterations += pose.iterations;
            result.largestStretch = std::max(result.largestStretch, pose.strain.middle);
            result.largestFaceStrain = std::max(result.largestFaceStrain, std::abs(pose.strain.face));
        }
        for (std::size_t state = 0; state < grid_.size(); ++state) {
            const auto& [source, images] = source_[state];
            for (std::size_t l = 0; l < grid_.levers; ++l) {
                std::size_t lever = l;
                for (std::size_t m = 0; m < mirrors_.size(); ++m)
                    if ((images >> m & 1) != 0) lever = mirrors_[m].levers[lever];
                const LeverLoad& load = poses_[source]->loads[lever];
                LeverLoad& largest = result.largestLoads[l];
                largest.force = std::max(largest.force, std::abs(load.force));
                largest.torque = std::max(largest.torque, std::abs(load.torque));
            }
        }
    }

    /// The chosen state that a state is the image of.
    struct Source {
        std::size_t state = 0;
        std::size_t images = 0; ///< the mirrors to apply, a bit each
    };

    const ElasticSheet& sheet_;
    const BakeSettings& settings_;
    const Progress& progress_;
    SheetMesh mesh_;
    StateGrid grid_;
    std::vector<MeshMirror> mirrors_;
    std::vector<Source> source_;
    std::vector<std::size_t> chosen_;
    std::vector<std::optional<SheetPose>> poses_; ///< of chosen states
    std::vector<SecondEquilibrium> seconds_;
    std::vector<bool> hasSecond_; ///< of chosen states
    int iterations_ = 0;
    tbb::enumerable_thread_specific<LeveredSheet> solvers_;
};

} // namespace

JointStates bakeJointStates(const ElasticSheet& sheet, const BakeSettings& settings, const Progress& progress) {
    if (sheet.levers.empty() || sheet.levers.size() > SheetModes::kMostActuators)
        throw InvalidInput("sheet", "it has no lever or more than 8", "change the number of its actuators");
    if (settings.levels < 2 || settings.levels > static_cast<int>(SheetModes::kMostLevels))
        throw InvalidInput("sheet", "the number of levels is not from 2 to 5", "choose another");
    return Baker(sheet, settings, progress).bake();
}

} // namespace lumorph
