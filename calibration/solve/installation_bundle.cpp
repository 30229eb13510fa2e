#include "calibration/solve/installation_bundle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>

#include <Eigen/Eigenvalues>
#include <ceres/ceres.h>
#include <ceres/normal_prior.h>

#include "calibration/solve/sight.h"

namespace lumorph {

namespace {

constexpr double kUnseen = 1e-14;   // of the largest eigenvalue: a direction that the data do not tell
constexpr double kMissed = 1e3;     // standard deviations: the error of a point that its ray misses
constexpr double kMostMissed = 0.1; // of what a camera has on a body: with more the state itself is impossible
constexpr int kSightBlocks[] = {kLensParameters, 6, 6, kBoardParameters, 3, kLensParameters, 6};

std::size_t at(int index) { return static_cast<std::size_t>(index); }

template <typename Numbers> Numbers numbersAt(const double* block) {
    Numbers numbers;
    std::copy_n(block, numbers.size(), numbers.begin());
    return numbers;
}

/// A loss of squared errors in standard deviations: Huber's, or Cauchy's for light, of which more is astray.
class RobustLoss {
public:
    RobustLoss(bool isCauchy, double bend) : isCauchy_(isCauchy), bend_(bend * bend) {
        // Both coordinates of normal noise together, s is exponential with mean 2, and the mean of 1 / (1 + s / b) is
        // b/2 exp(b/2) E1(b/2), with E1(x) = -Ei(-x).
        if (isCauchy) mean_ = -0.5 * bend_ * std::exp(0.5 * bend_) * std::expint(-0.5 * bend_);
    }

    /// Makes the half square of an error its loss: error and slopes, scaled.
    void apply(Eigen::Vector2d& error, SightSlopes* slopes) const {
        const double s = error.squaredNorm();
        if (s < 1e-12) return;
        const double value = valueOf(s);
        const double scale = std::sqrt(value / s);
        if (slopes) {
            const double bend = (slopeOf(s) * s - value) / (s * s) / scale; // twice the derivative of `scale` by s
            *slopes = scale * *slopes + (bend * error) * (error.transpose() * *slopes);
        }
        error *= scale;
    }

    /// What the loss lets an error count, in units of what errors of normal noise count in the mean: so noise alone
    /// counts in full, and what is far off next to nothing. Huber's bend lies where that mean is nearly 1.
    [[nodiscard]] double weightOf(const Eigen::Vector2d& error) const { return slopeOf(error.squaredNorm()) / mean_; }

private:
    [[nodiscard]] double valueOf(double s) const {
        if (isCauchy_) return bend_ * std::log1p(s / bend_);
        return s <= bend_ ? s : 2.0 * std::sqrt(bend_ * s) - bend_;
    }
    [[nodiscard]] double slopeOf(double s) const {
        if (isCauchy_) return 1.0 / (1.0 + s / bend_);
        return s <= bend_ ? 1.0 : std::sqrt(bend_ / s);
    }

    bool isCauchy_;
    double bend_, mean_ = 1.0;
};

int projectorOf(const SeenPoint&) { return -1; }
int projectorOf(const SeenLight& seen) { return seen.projector; }

/// What one camera saw on one body, of it or of one projector's light.
template <typename Seen> using SightGroup = std::vector<const Seen*>;

template <typename Seen> std::vector<SightGroup<Seen>> groupsOf(const std::vector<Seen>& all) {
    std::map<std::array<int, 3>, SightGroup<Seen>> groups;
    for (const Seen& seen : all) groups[{seen.body, seen.camera, projectorOf(seen)}].push_back(&seen);
    std::vector<SightGroup<Seen>> list;
    for (auto& [key, group] : groups) list.push_back(std::move(group));
    return list;
}

/// Calls `take` with each block of a state's numbers, in the order of `InstallationPlaces`.
template <typename State, typename Take> void forEachBlock(State& state, const Take& take) {
    for (auto* devices : {&state.cameras, &state.projectors})
        for (auto& device : *devices) {
            take(device.lens);
            take(device.fromWorld);
        }
    take(state.board.terms);
    take(state.mirror);
    for (auto& body : state.worldFromBody) take(body);
}

std::vector<double> numbersOf(const InstallationState& state) {
    std::vector<double> all;
    forEachBlock(state, [&](const auto& block) { all.insert(all.end(), block.begin(), block.end()); });
    return all;
}

void takeNumbers(const std::vector<double>& numbers, InstallationState& state) {
    auto next = numbers.begin();
    forEachBlock(state, [&](auto& block) {
        std::copy_n(next, block.size(), block.begin());
        next += static_cast<std::ptrdiff_t>(block.size());
    });
}

/// Of all numbers, those that a group's errors depend on, block by block as in `SightColumn`.
template <typename Seen>
std::vector<double*> blocksOf(const Seen& seen, const InstallationPlaces& places, std::vector<double>& numbers) {
    std::vector<int> starts = {places.camera(at(seen.camera)), places.camera(at(seen.camera)) + kLensParameters,
                               places.body(at(seen.body)), places.board, places.mirror};
    if constexpr (std::is_same_v<Seen, SeenLight>)
        for (const int after : {0, kLensParameters}) starts.push_back(places.projector(at(seen.projector)) + after);
    std::vector<double*> blocks;
    for (const int start : starts) blocks.push_back(numbers.data() + start);
    return blocks;
}

/// Places of what may move.
std::vector<int> freePlaces(const InstallationFree& free, const InstallationState& state) {
    const InstallationPlaces all(state);
    std::vector<int> places;
    const auto add = [&places](int first, const auto& mask) {
        for (std::size_t i = 0; i < mask.size(); ++i)
            if (mask[i]) places.push_back(first + static_cast<int>(i));
    };
    const auto addDevice = [&](int first, const InstallationFree::Device& device) {
        add(first, device.lens);
        add(first + kLensParameters, std::vector<bool>(6, device.pose));
    };
    for (std::size_t i = 0; i < free.cameras.size(); ++i) addDevice(all.camera(i), free.cameras[i]);
    for (std::size_t i = 0; i < free.projectors.size(); ++i) addDevice(all.projector(i), free.projectors[i]);
    add(all.board, free.board);
    add(all.mirror, std::vector<bool>(3, free.mirror));
    for (std::size_t i = 0; i < free.bodies.size(); ++i) add(all.body(i), std::vector<bool>(6, free.bodies[i]));
    return places;
}

template <typename Seen> Sight sightAt(double const* const* blocks, const BoardShape& frame) {
    constexpr bool kIsLight = std::is_same_v<Seen, SeenLight>;
    BoardShape board = frame;
    std::copy_n(blocks[3], kBoardParameters, board.terms.begin());
    return {numbersAt<Lens>(blocks[0]),
            kIsLight ? numbersAt<Lens>(blocks[5]) : Lens{},
            PoseMatrix(numbersAt<PoseVector>(blocks[1])),
            PoseMatrix(numbersAt<PoseVector>(blocks[2])),
            PoseMatrix(kIsLight ? numbersAt<PoseVector>(blocks[6]) : PoseVector{}),
            board,
            Eigen::Vector3d(blocks[4][0], blocks[4][1], blocks[4][2])};
}

/// All errors of a group in standard deviations, as one block: its rotations are worked out once.
template <typename Seen> class GroupError : public ceres::CostFunction {
public:
    GroupError(const SightGroup<Seen>& group, const InstallationNoise& noise, const BoardShape& frame)
        : group_(group), sigma_(kIsLight ? noise.projector : noise.camera), loss_(kIsLight, noise.robust),
          frame_(frame) {
        set_num_residuals(static_cast<int>(2 * group.size()));
        for (std::size_t i = 0; i < kBlocks; ++i) mutable_parameter_block_sizes()->push_back(kSightBlocks[i]);
    }

    bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
        int row = 0;
        const auto byLoss = [this](Eigen::Vector2d& error, SightSlopes* slopes) { loss_.apply(error, slopes); };
        return forEach(parameters, byLoss, jacobians != nullptr,
                       [&](const Eigen::Vector2d& error, const SightSlopes& slopes) {
                           residuals[row] = error.x();
                           residuals[row + 1] = error.y();
                           if (jacobians) copy(slopes, row, jacobians);
                           row += 2;
                       });
    }

    void addNormal(double const* const* parameters, Counts counts, Eigen::MatrixXd& normal) const {
        const auto scale = [&](Eigen::Vector2d& error, SightSlopes* slopes) {
            if (counts == Counts::asLossLets) *slopes *= std::sqrt(loss_.weightOf(error));
        };
        forEach(parameters, scale, true, [&](const Eigen::Vector2d&, const SightSlopes& slopes) {
            normal.noalias() += slopes.transpose() * slopes;
        });
    }

private:
    static constexpr bool kIsLight = std::is_same_v<Seen, SeenLight>;
    static constexpr std::size_t kBlocks = kIsLight ? 7 : 5;

    template <typename Scale, typename Take>
    bool forEach(double const* const* parameters, const Scale& scale, bool wantSlopes, const Take& take) const {
        const Sight sight = sightAt<Seen>(parameters, frame_);
        Eigen::Vector2d error;
        SightSlopes storage;
        SightSlopes* slopes = wantSlopes ? &storage : nullptr;
        std::size_t missed = 0;
        for (const Seen* seen : group_) {
            if (sight.error(*seen, error, slopes)) {
                error /= sigma_;
                if (slopes) *slopes /= sigma_;
            } else { // a single one that cannot be there counts as one far off, which no small step mends
                if (static_cast<double>(++missed) > kMostMissed * static_cast<double>(group_.size())) return false;
                error = {kMissed, 0.0};
                if (slopes) slopes->setZero();
            }
            scale(error, slopes);
            if (seen->weight != 1.0) {
                error *= std::sqrt(seen->weight);
                if (slopes) *slopes *= std::sqrt(seen->weight);
            }
            take(error, storage);
        }
        return true;
    }

    static void copy(const SightSlopes& slopes, int row, double** jacobians) {
        int column = 0;
        for (std::size_t block = 0; block < kBlocks; ++block) {
            const int size = kSightBlocks[block];
            if (jacobians[block])
                for (int r = 0; r < 2; ++r)
                    for (int c = 0; c < size; ++c) jacobians[block][(row + r) * size + c] = slopes(r, column + c);
            column += size;
        }
    }

    const SightGroup<Seen> group_;
    const double sigma_;
    const RobustLoss loss_;
    const BoardShape frame_;
};

/// The problem around one state. Its numbers lie side by side, because Ceres orders blocks by their addresses: so the
/// same observations give the same bits.
class InstallationProblem {
public:
    InstallationProblem(const InstallationObservations& observations, const InstallationFree& free,
                        const InstallationNoise& noise, const InstallationState& state)
        : places_(state), numbers_(numbersOf(state)) {
        addGroups(observations.points, noise, state.board);
        addGroups(observations.lights, noise, state.board);
        for (std::size_t i = 0; i < std::min(free.cameras.size(), noise.cameras.size()); ++i)
            addKnown(noise.cameras[i], free.cameras[i].lens, places_.camera(i));
        for (std::size_t i = 0; i < std::min(free.projectors.size(), noise.projectors.size()); ++i)
            addKnown(noise.projectors[i], free.projectors[i].lens, places_.projector(i));
        holdAllBut(freePlaces(free, state));
    }

    /// Returns the cost.
    double solve(int steps, InstallationState& into) {
        ceres::Solver::Options how;
        how.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
        if (bodiesMove_) { // each error sees one body: those are eliminated first
            how.linear_solver_type = ceres::DENSE_SCHUR;
            how.linear_solver_ordering = std::make_shared<ceres::ParameterBlockOrdering>();
            for (double* block : blocks()) how.linear_solver_ordering->AddElementToGroup(block, isBody(block) ? 0 : 1);
        }
        how.max_num_iterations = steps;
        how.function_tolerance = 1e-9;
        how.logging_type = ceres::SILENT;
        how.num_threads = 1;
        ceres::Solver::Summary summary;
        ceres::Solve(how, &problem_, &summary);
        takeNumbers(numbers_, into);
        return summary.termination_type == ceres::FAILURE ? std::numeric_limits<double>::infinity()
                                                          : summary.final_cost;
    }

private:
    [[nodiscard]] std::vector<double*> blocks() const {
        std::vector<double*> all;
        problem_.GetParameterBlocks(&all);
        return all;
    }
    [[nodiscard]] bool isBody(const double* block) const { return block - numbers_.data() >= places_.bodies; }

    template <typename Seen>
    void addGroups(const std::vector<Seen>& all, const InstallationNoise& noise, const BoardShape& frame) {
        for (const SightGroup<Seen>& group : groupsOf(all))
            problem_.AddResidualBlock(new GroupError<Seen>(group, noise, frame), nullptr,
                                      blocksOf(*group.front(), places_, numbers_));
    }

    void addKnown(const InstallationNoise::Known& known, const LensMask& free, int place) {
        if (std::ranges::none_of(free, [](bool moves) { return moves; })) return;
        ceres::Matrix scale = ceres::Matrix::Zero(kLensParameters, kLensParameters);
        for (int i = 0; i < kLensParameters; ++i)
            if (known.sigma[at(i)] > 0.0) scale(i, i) = 1.0 / known.sigma[at(i)];
        const Eigen::Map<const ceres::Vector> middle(known.lens.data(), kLensParameters);
        problem_.AddResidualBlock(new ceres::NormalPrior(scale, middle), nullptr, numbers_.data() + place);
    }

    void holdAllBut(const std::vector<int>& free) {
        std::vector<bool> moves(numbers_.size());
        for (const int place : free) moves[at(place)] = true;
        for (double* block : blocks()) {
            const auto place = block - numbers_.data();
            const int size = problem_.ParameterBlockSize(block);
            std::vector<int> held;
            for (int i = 0; i < size; ++i)
                if (!moves[static_cast<std::size_t>(place + i)]) held.push_back(i);
            if (static_cast<int>(held.size()) == size)
                problem_.SetParameterBlockConstant(block);
            else if (!held.empty())
                problem_.SetManifold(block, new ceres::SubsetManifold(size, held));
            bodiesMove_ = bodiesMove_ || (isBody(block) && held.empty());
        }
    }

    const InstallationPlaces places_;
    std::vector<double> numbers_; ///< of the state
    ceres::Problem problem_;
    bool bodiesMove_ = false;
};

/// Places in a normal matrix of all of a group's columns.
template <typename Seen> std::vector<int> placesOf(const Seen& seen, const InstallationPlaces& all) {
    std::vector<int> places;
    const auto add = [&places](int first, int count) {
        for (int i = 0; i < count; ++i) places.push_back(first + i);
    };
    add(all.camera(at(seen.camera)), InstallationPlaces::kOfDevice);
    add(all.body(at(seen.body)), 6);
    add(all.board, kBoardParameters);
    add(all.mirror, 3);
    // Of a point the last columns are zero, wherever they are added.
    add(std::is_same_v<Seen, SeenLight> ? all.projector(at(std::max(0, projectorOf(seen)))) : 0,
        InstallationPlaces::kOfDevice);
    return places;
}

template <typename Seen>
Eigen::MatrixXd normalOf(const std::vector<Seen>& observations, const InstallationNoise& noise,
                         const InstallationState& state, Counts counts) {
    const InstallationPlaces places(state);
    std::vector<double> numbers = numbersOf(state);
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(places.count, places.count);
    for (const SightGroup<Seen>& group : groupsOf(observations)) {
        const std::vector<double*> blocks = blocksOf(*group.front(), places, numbers);
        Eigen::MatrixXd own = Eigen::MatrixXd::Zero(kSightColumns, kSightColumns);
        GroupError<Seen>(group, noise, state.board).addNormal(blocks.data(), counts, own);
        const std::vector<int> columns = placesOf(*group.front(), places);
        normal(columns, columns) += own;
    }
    return normal;
}

template <typename Seen>
std::vector<std::optional<cv::Point2d>> errorsOfAll(const std::vector<Seen>& all, const InstallationState& state) {
    const InstallationPlaces places(state);
    std::vector<double> numbers = numbersOf(state);
    std::vector<std::optional<cv::Point2d>> errors;
    std::vector<double*> before;
    std::optional<Sight> sight;
    for (const Seen& seen : all) {
        if (const std::vector<double*> blocks = blocksOf(seen, places, numbers); blocks != before) {
            sight.emplace(sightAt<Seen>(blocks.data(), state.board));
            before = blocks;
        }
        Eigen::Vector2d error;
        errors.push_back(sight->error(seen, error, nullptr) ? std::optional(cv::Point2d(error.x(), error.y()))
                                                            : std::nullopt);
    }
    return errors;
}

template <typename Seen, typename NameOf>
void dropFrom(std::vector<Seen>& all, const InstallationState& state, double sigma, const InstallationNames& names,
              const NameOf& nameOf, std::vector<Finding>& findings) {
    std::vector<Seen> kept;
    for (const SightGroup<Seen>& group : groupsOf(all)) {
        std::vector<Seen> ours;
        for (const Seen* seen : group) ours.push_back(*seen);
        std::vector<cv::Point2d> errors;
        for (const auto& error : errorsOf(ours, state)) errors.push_back(error.value_or(cv::Point2d(kMissed, 0.0)));
        const Outliers outliers = outliersOf(errors, sigma);
        if (outliers.count > 0)
            findings.push_back(findingOf(outliers, nameOf(ours.front()), names.bodies[at(ours.front().body)]));
        outliers.eraseFrom(ours);
        kept.insert(kept.end(), ours.begin(), ours.end());
    }
    all = std::move(kept);
}

} // namespace

double refineInstallation(const InstallationObservations& observations, const InstallationFree& free,
                          const InstallationNoise& noise, InstallationState& state, int steps) {
    return InstallationProblem(observations, free, noise, state).solve(steps, state);
}

InstallationPlaces::InstallationPlaces(const InstallationState& state)
    : projectors(kOfDevice * static_cast<int>(state.cameras.size())),
      board(projectors + kOfDevice * static_cast<int>(state.projectors.size())), mirror(board + kBoardParameters),
      bodies(mirror + 3), count(bodies + 6 * static_cast<int>(state.worldFromBody.size())) {}

InstallationNormals installationNormals(const InstallationObservations& observations, const InstallationNoise& noise,
                                        const InstallationState& state, Counts counts) {
    InstallationState here = state;
    InstallationNormals normals{
        normalOf(observations.points, noise, here, counts), normalOf(observations.lights, noise, here, counts), {}};
    const InstallationPlaces places(state);
    normals.known = Eigen::MatrixXd::Zero(places.count, places.count);
    const auto add = [&](int first, const InstallationNoise::Known& known) {
        for (int i = 0; i < kLensParameters; ++i)
            if (known.sigma[at(i)] > 0.0) normals.known(first + i, first + i) = std::pow(known.sigma[at(i)], -2.0);
    };
    for (std::size_t i = 0; i < noise.cameras.size(); ++i) add(places.camera(i), noise.cameras[i]);
    for (std::size_t i = 0; i < noise.projectors.size(); ++i) add(places.projector(i), noise.projectors[i]);
    return normals;
}

Eigen::MatrixXd inverseOfNormal(const Eigen::MatrixXd& normal) {
    const Eigen::VectorXd scale = normal.diagonal().cwiseMax(1e-30).cwiseSqrt().cwiseInverse();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solved(scale.asDiagonal() * normal * scale.asDiagonal());
    const Eigen::VectorXd values = solved.eigenvalues().cwiseMax(kUnseen * solved.eigenvalues().maxCoeff());
    return scale.asDiagonal() * solved.eigenvectors() * values.cwiseInverse().asDiagonal() *
           solved.eigenvectors().transpose() * scale.asDiagonal();
}

InstallationState installationSigmas(const InstallationObservations& observations, const InstallationFree& free,
                                     const InstallationNoise& noise, const InstallationState& state) {
    const InstallationNormals normals = installationNormals(observations, noise, state, Counts::asLossLets);
    const std::vector<int> places = freePlaces(free, state);
    std::vector<double> sigmas(at(InstallationPlaces(state).count), 0.0);
    if (!places.empty()) {
        const Eigen::MatrixXd all = normals.points + normals.lights + normals.known;
        const Eigen::VectorXd variances = inverseOfNormal(all(places, places)).diagonal();
        for (std::size_t i = 0; i < places.size(); ++i)
            sigmas[at(places[i])] = std::sqrt(std::max(0.0, variances[static_cast<Eigen::Index>(i)]));
    }
    InstallationState result = state;
    takeNumbers(sigmas, result);
    return result;
}

std::vector<std::optional<cv::Point2d>> errorsOf(const std::vector<SeenPoint>& seen, const InstallationState& state) {
    return errorsOfAll(seen, state);
}

std::vector<std::optional<cv::Point2d>> errorsOf(const std::vector<SeenLight>& seen, const InstallationState& state) {
    return errorsOfAll(seen, state);
}

std::vector<Finding> dropOutliers(InstallationObservations& observations, const InstallationState& state,
                                  const InstallationNoise& noise, const InstallationNames& names) {
    std::vector<Finding> findings;
    dropFrom(
        observations.points, state, noise.camera, names,
        [&](const SeenPoint& seen) { return "points of the board that " + names.cameras[at(seen.camera)] + " saw"; },
        findings);
    dropFrom(
        observations.lights, state, noise.projector, names,
        [&](const SeenLight& seen) {
            return "points of the light of " + names.projectors[at(seen.projector)] + " that " +
                   names.cameras[at(seen.camera)] + " saw";
        },
        findings);
    return findings;
}

std::optional<std::vector<cv::Point3d>> turnedBoard(const std::vector<cv::Point3d>& board) {
    cv::Point3d sum(0, 0, 0);
    for (const cv::Point3d& point : board) sum += (2.0 / static_cast<double>(board.size())) * point;
    std::vector<cv::Point3d> turned;
    double extent = 0.0;
    for (const cv::Point3d& point : board) {
        turned.push_back({sum.x - point.x, sum.y - point.y, point.z});
        extent = std::max(extent, cv::norm(point - 0.5 * sum));
    }
    for (const cv::Point3d& point : turned)
        if (std::ranges::none_of(board, [&](const auto& other) { return cv::norm(other - point) < 1e-6 * extent; }))
            return std::nullopt;
    return turned;
}

} // namespace lumorph
