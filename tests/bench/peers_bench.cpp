#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <utility>

#include <Eigen/Dense>
#include <nlopt.h>
#include <pagmo/algorithm.hpp>
#include <pagmo/algorithms/cmaes.hpp>
#include <pagmo/population.hpp>
#include <pagmo/problem.hpp>

#include "core/base/clock.h"
#include "core/base/statistics.h"
#include "core/mdf/refine.h"
#include "tests/bench/bench_groups.h"
#include "tests/bench/bench_inputs.h"
#include "tests/bench/bench_timing.h"

namespace lumorph::bench {

namespace {

constexpr double kBudgetSeconds = 2e-3;
constexpr int kKnownEvaluations = 10'000;
constexpr int kRuns = 5; ///< of each peer on each target; the median counts
constexpr double kNoLimit = std::numeric_limits<double>::infinity();

/// Processor time of this thread, so that other work of the machine does not shorten a budget.
class ThreadClock final : public Clock {
public:
    [[nodiscard]] Microseconds now() const override {
        return Microseconds(static_cast<std::int64_t>(1e6 * threadSeconds()));
    }
};

struct SearchEnd : std::exception {};

/// The IoU of strokes, rounded to levels, by the pieces that the coverage keeps; remembers the best and ends the search
/// when its time or its evaluations are used up.
class Evaluation {
public:
    Evaluation(const Coverage& coverage, const BitColumns& target)
        : coverage_(coverage), target_(target), wanted_(target.count()) {}

    void begin(double seconds, int evaluations) {
        best_ = 0.0;
        count_ = 0;
        most_ = evaluations;
        until_ = threadSeconds() + seconds;
    }
    /// Throws SearchEnd.
    double iou(std::span<const double> strokes) {
        spend();
        State state(strokes.size());
        for (std::size_t i = 0; i < state.size(); ++i)
            state[i].index = static_cast<int>(std::lround(std::clamp(strokes[i], 0.0, 1.0) * (coverage_.levels() - 1)));
        coverage_.covered(state, covered_, scratch_);
        const std::size_t both = covered_.countAnd(target_), either = covered_.count() + wanted_ - both;
        const double iou = either == 0 ? 0.0 : static_cast<double>(both) / static_cast<double>(either);
        if (iou > best_) {
            best_ = iou;
            bestStrokes_.assign(strokes.begin(), strokes.end());
        }
        return iou;
    }
    /// For work that costs as much as an evaluation. Throws SearchEnd.
    void spend() {
        if (count_ >= most_ || threadSeconds() >= until_) throw SearchEnd();
        ++count_;
    }
    [[nodiscard]] double best() const { return best_; }
    [[nodiscard]] const std::vector<double>& bestStrokes() const { return bestStrokes_; }

private:
    const Coverage& coverage_;
    const BitColumns& target_;
    std::size_t wanted_;
    CoverageScratch scratch_;
    BitColumns covered_;
    double best_ = 0.0;
    std::vector<double> bestStrokes_;
    int count_ = 0;
    int most_ = 0;
    double until_ = 0.0;
};

/// Searches from a start until SearchEnd; a local search that ends earlier begins again.
using Peer = std::function<void(Evaluation&, const std::vector<double>& start, unsigned seed)>;

/// Again and again from the best so far, each time with another first step.
void searchByNlopt(nlopt_algorithm algorithm, Evaluation& evaluation, const std::vector<double>& start, unsigned seed) {
    struct Call {
        Evaluation& evaluation;
        nlopt_opt search;
        bool ended = false;
    };
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> step(0.05, 0.4);
    const auto count = static_cast<unsigned>(start.size());
    std::vector<double> from = start;
    while (true) {
        const std::unique_ptr<nlopt_opt_s, void (*)(nlopt_opt)> search(nlopt_create(algorithm, count), nlopt_destroy);
        Call call{evaluation, search.get()};
        nlopt_set_lower_bounds1(search.get(), 0.0);
        nlopt_set_upper_bounds1(search.get(), 1.0);
        nlopt_set_initial_step1(search.get(), step(random));
        nlopt_set_xtol_abs1(search.get(), 1.0 / 64.0);
        const nlopt_func objective = [](unsigned n, const double* x, double*, void* data) {
            Call& of = *static_cast<Call*>(data);
            try {
                return -of.evaluation.iou({x, n});
            } catch (const SearchEnd&) { // not through a C library
                of.ended = true;
                nlopt_force_stop(of.search);
                return 0.0;
            }
        };
        nlopt_set_min_objective(search.get(), objective, &call);
        double value = 0.0;
        nlopt_optimize(search.get(), from.data(), &value);
        if (call.ended) throw SearchEnd();
        from = evaluation.bestStrokes().empty() ? start : evaluation.bestStrokes();
    }
}

/// What pagmo copies.
struct StrokesProblem {
    Evaluation* evaluation = nullptr;
    std::size_t count = 1;

    [[nodiscard]] pagmo::vector_double fitness(const pagmo::vector_double& x) const { return {-evaluation->iou(x)}; }
    [[nodiscard]] std::pair<pagmo::vector_double, pagmo::vector_double> get_bounds() const {
        return {pagmo::vector_double(count, 0.0), pagmo::vector_double(count, 1.0)};
    }
};

void searchByCmaEs(Evaluation& evaluation, const std::vector<double>& start, unsigned seed) {
    const auto size = static_cast<pagmo::population::size_type>(4 + 3 * std::log(static_cast<double>(start.size())));
    std::vector<double> from = start;
    for (unsigned again = 0;; ++again) {
        pagmo::population population(pagmo::problem(StrokesProblem{&evaluation, start.size()}), 0, seed + again);
        population.push_back(from);
        while (population.size() < std::max<pagmo::population::size_type>(size, 5))
            population.push_back(population.random_decision_vector());
        const pagmo::algorithm search(
            pagmo::cmaes(100'000, -1, -1, -1, -1, 0.25, 1e-9, 1e-3, false, true, seed + again));
        (void)search.evolve(population);
        from = population.random_decision_vector(); // it has come to rest; the best is remembered
    }
}

/// Distance of voxel centres to the border of a solid, voxels, below zero inside; linear between them.
class SignedDistance {
public:
    explicit SignedDistance(const BitColumns& solid) : size_(solid.dimensions()) {
        values_ = squaredDistances(solid, true);
        const std::vector<float> inside = squaredDistances(solid, false);
        for (std::size_t i = 0; i < values_.size(); ++i)
            values_[i] = values_[i] > 0.0F ? std::sqrt(values_[i]) - 0.5F : 0.5F - std::sqrt(inside[i]);
    }

    /// At a place in voxels whose centres lie at whole numbers, and the gradient there.
    float at(const glm::vec3& place, glm::vec3& gradient) const {
        const glm::vec3 p = glm::clamp(place, glm::vec3(0.0F), glm::vec3(size_ - 1) - 1e-3F);
        const glm::ivec3 low(p);
        const glm::vec3 t = p - glm::vec3(low);
        std::array<float, 8> c{};
        for (int k = 0; k < 8; ++k)
            c[static_cast<std::size_t>(k)] = value(low.x + (k & 1), low.y + ((k >> 1) & 1), low.z + (k >> 2));
        const auto mix = [](float a, float b, float share) { return a + share * (b - a); };
        const float x00 = mix(c[0], c[1], t.x), x10 = mix(c[2], c[3], t.x);
        const float x01 = mix(c[4], c[5], t.x), x11 = mix(c[6], c[7], t.x);
        const float y0 = mix(x00, x10, t.y), y1 = mix(x01, x11, t.y);
        gradient.x = mix(mix(c[1] - c[0], c[3] - c[2], t.y), mix(c[5] - c[4], c[7] - c[6], t.y), t.z);
        gradient.y = mix(x10 - x00, x11 - x01, t.z);
        gradient.z = y1 - y0;
        return mix(y0, y1, t.z);
    }

private:
    [[nodiscard]] std::size_t index(int x, int y, int z) const {
        return (static_cast<std::size_t>(z) * static_cast<std::size_t>(size_.y) + static_cast<std::size_t>(y)) *
                   static_cast<std::size_t>(size_.x) +
               static_cast<std::size_t>(x);
    }
    [[nodiscard]] float value(int x, int y, int z) const {
        return values_[index(std::min(x, size_.x - 1), std::min(y, size_.y - 1), std::min(z, size_.z - 1))];
    }

    /// To the nearest voxel that is set, or not, exactly, one axis after the other.
    [[nodiscard]] std::vector<float> squaredDistances(const BitColumns& solid, bool toSet) const {
        constexpr float kFar = 1e6F;
        std::vector<float> squared(static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y) *
                                   static_cast<std::size_t>(size_.z));
        for (int z = 0; z < size_.z; ++z)
            for (int y = 0; y < size_.y; ++y)
                for (int x = 0; x < size_.x; ++x) squared[index(x, y, z)] = solid.test(x, y, z) == toSet ? 0.0F : kFar;
        std::vector<float> line;
        for (int axis = 0; axis < 3; ++axis) {
            const int u = (axis + 1) % 3, w = (axis + 2) % 3;
            for (int a = 0; a < size_[u]; ++a)
                for (int b = 0; b < size_[w]; ++b) {
                    glm::ivec3 at(0);
                    at[u] = a;
                    at[w] = b;
                    line.clear();
                    for (at[axis] = 0; at[axis] < size_[axis]; ++at[axis])
                        line.push_back(squared[index(at.x, at.y, at.z)]);
                    for (at[axis] = 0; at[axis] < size_[axis]; ++at[axis]) {
                        float nearest = kFar;
                        for (int k = 0; k < size_[axis]; ++k) {
                            const auto d = static_cast<float>(k - at[axis]);
                            nearest = std::min(nearest, line[static_cast<std::size_t>(k)] + d * d);
                        }
                        squared[index(at.x, at.y, at.z)] = nearest;
                    }
                }
        }
        return squared;
    }

    glm::ivec3 size_;
    std::vector<float> values_;
};

/// Brings the moved vertices of the upper side onto the border of body and target together: Gauss-Newton, damped, on
/// their signed distances, with finite differences of Rig::deform. A deformation counts as an evaluation; to make the
/// distances is not counted. From another random start each time that it comes to rest.
class GaussNewton {
public:
    GaussNewton(const Device& device, const BitColumns& target) : device_(device), distance_(solidOf(device, target)) {
        const Rig& rig = device.coverage.rig();
        const float rest = device.field.restSurface - 0.25F * static_cast<float>(device.field.frame.voxelSize);
        std::vector<std::uint32_t> vertices;
        for (std::size_t i = 0; i < rig.actuatorCount(); ++i)
            for (const std::uint32_t v : rig.verticesOf(i))
                if (rig.restMesh().positions[v].y >= rest) vertices.push_back(v);
        std::ranges::sort(vertices);
        vertices.erase(std::ranges::unique(vertices).begin(), vertices.end());
        subset_.emplace(rig.subset(vertices));
    }

    void search(Evaluation& evaluation, const std::vector<double>& start, unsigned seed) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> anywhere(0.0, 1.0);
        std::vector<double> strokes = start;
        evaluation.iou(strokes);
        while (true) {
            descend(evaluation, strokes);
            for (double& of : strokes) of = anywhere(random);
        }
    }

private:
    static BitColumns solidOf(const Device& device, const BitColumns& target) {
        BitColumns solid = target;
        solid |= device.coverage.body();
        return solid;
    }

    void deform(Evaluation& evaluation, std::span<const double> strokes, std::vector<glm::vec3>& out) const {
        evaluation.spend();
        out.resize(subset_->size());
        subset_->deform(strokes, out);
        const VoxelFrame& frame = device_.field.frame;
        for (glm::vec3& p : out) p = (p - frame.origin) / static_cast<float>(frame.voxelSize) - 0.5F;
    }

    void descend(Evaluation& evaluation, std::vector<double>& strokes) {
        constexpr double kStep = 1e-2;
        const std::size_t n = strokes.size();
        double damping = 1e-2, before = kNoLimit;
        std::vector<double> kept = strokes;
        for (int iteration = 0; iteration < 20; ++iteration) {
            deform(evaluation, strokes, places_);
            std::vector<float> residuals(places_.size());
            gradients_.resize(places_.size());
            double sum = 0.0;
            for (std::size_t v = 0; v < places_.size(); ++v) {
                residuals[v] = distance_.at(places_[v], gradients_[v]);
                sum += static_cast<double>(residuals[v]) * static_cast<double>(residuals[v]);
            }
            if (sum >= before) { // the last step was too long
                damping *= 10.0;
                if (damping > 1e3) return;
                strokes = kept;
                before = kNoLimit;
                continue;
            }
            if (before - sum < 1e-4 * sum) return;
            before = sum;
            kept = strokes;
            damping = std::max(1e-6, 0.3 * damping);
            std::vector<double> jacobian(n * places_.size());
            for (std::size_t i = 0; i < n; ++i) {
                std::vector<double> moved = strokes;
                const double step = moved[i] + kStep <= 1.0 ? kStep : -kStep;
                moved[i] += step;
                deform(evaluation, moved, movedPlaces_);
                for (std::size_t v = 0; v < places_.size(); ++v)
                    jacobian[i * places_.size() + v] =
                        static_cast<double>(glm::dot(gradients_[v], movedPlaces_[v] - places_[v])) / step;
            }
            solve(jacobian, residuals, damping, strokes);
            evaluation.iou(strokes);
        }
    }

    /// Of (J J^T + damping diag) step = -J r; keeps strokes within [0, 1].
    static void solve(const std::vector<double>& jacobian, const std::vector<float>& residuals, double damping,
                      std::vector<double>& strokes) {
        const auto n = static_cast<Eigen::Index>(strokes.size()), count = static_cast<Eigen::Index>(residuals.size());
        const Eigen::Map<const Eigen::MatrixXd> columns(jacobian.data(), count, n);
        const Eigen::VectorXd errors = Eigen::Map<const Eigen::VectorXf>(residuals.data(), count).cast<double>();
        Eigen::MatrixXd normal = columns.transpose() * columns;
        normal.diagonal() = (1.0 + damping) * normal.diagonal().array() + 1e-9;
        const Eigen::VectorXd step = normal.ldlt().solve(-columns.transpose() * errors);
        for (Eigen::Index i = 0; i < n; ++i) {
            double& stroke = strokes[static_cast<std::size_t>(i)];
            stroke = std::clamp(stroke + step[i], 0.0, 1.0);
        }
    }

    const Device& device_;
    SignedDistance distance_;
    std::optional<Rig::Subset> subset_;
    std::vector<glm::vec3> places_;
    std::vector<glm::vec3> movedPlaces_;
    std::vector<glm::vec3> gradients_;
};

/// The best IoU that a peer has found when its budget ends, the median of some runs.
double foundBy(const Peer& peer, Evaluation& evaluation, const std::vector<double>& start, double seconds,
               int evaluations) {
    std::vector<double> found;
    for (unsigned run = 0; run < kRuns; ++run) {
        evaluation.begin(seconds, evaluations);
        try {
            peer(evaluation, start, 11 + 100 * run);
        } catch (const SearchEnd&) { // the usual end
        }
        found.push_back(evaluation.best());
    }
    return median(std::move(found));
}

constexpr const char* kPeers[] = {"BOBYQA", "SBPLX", "CMA-ES", "Gauss-Newton"};
constexpr const char* kRows[] = {"peers-bobyqa", "peers-sbplx", "peers-cma-es", "peers-gauss-newton"};
constexpr std::size_t kPeerCount = std::size(kPeers);

/// On one target.
struct Comparison {
    std::string name;
    double rest = 0.0;
    double refined = 0.0;
    double best = 0.0;
    double states = 0.0;
    std::array<double, kPeerCount> atTime{};
    std::array<double, kPeerCount> atEvaluations{};

    [[nodiscard]] bool counts() const { return best - rest >= kWorthwhile; }
};

Comparison compareOn(const Device& device, Refiner& refiner, const TargetVolume& target) {
    const ThreadClock clock;
    Comparison of{target.name};
    of.rest = refiner.qualityOf(target.voxels, State(device.coverage.rig().actuatorCount())).iou();
    const State voted = device.voting.match(target.voxels).state();
    std::vector<double> refined, states;
    for (int run = 0; run < kRuns; ++run) {
        const Refinement found =
            refiner.refine(target.voxels, voted, Microseconds(static_cast<std::int64_t>(1e6 * kBudgetSeconds)), clock);
        refined.push_back(found.after.iou());
        states.push_back(found.statesSeen);
    }
    of.refined = median(refined);
    of.states = median(states);

    const std::vector<double> start = strokesOf(device.coverage.rig(), voted, device.coverage.levels());
    GaussNewton gaussNewton(device, target.voxels);
    const Peer peers[] = {
        [](Evaluation& e, const std::vector<double>& from, unsigned seed) {
            searchByNlopt(NLOPT_LN_BOBYQA, e, from, seed);
        },
        [](Evaluation& e, const std::vector<double>& from, unsigned seed) {
            searchByNlopt(NLOPT_LN_SBPLX, e, from, seed);
        },
        searchByCmaEs,
        [&](Evaluation& e, const std::vector<double>& from, unsigned seed) { gaussNewton.search(e, from, seed); }};
    Evaluation evaluation(device.coverage, target.voxels);
    of.best = of.refined;
    for (std::size_t p = 0; p < kPeerCount; ++p) {
        of.atTime[p] = foundBy(peers[p], evaluation, start, kBudgetSeconds, std::numeric_limits<int>::max());
        of.atEvaluations[p] = foundBy(peers[p], evaluation, start, kNoLimit, static_cast<int>(of.states));
        of.best = std::max({of.best, of.atTime[p], of.atEvaluations[p]});
    }
    evaluation.begin(kNoLimit, kKnownEvaluations);
    try {
        searchByCmaEs(evaluation, start, 5);
    } catch (const SearchEnd&) { // the usual end
    }
    of.best = std::max(of.best, evaluation.best());
    if (target.kind == TargetVolume::Kind::hidden) of.best = 1.0; // by the state that made the target
    return of;
}

std::string countOf(std::size_t part, std::size_t whole) {
    return std::to_string(part) + " of " + std::to_string(whole);
}

} // namespace

void benchPeers(const Filter& filter, Report& report) {
    const std::string refinedRow = "peers-refined", beatenRow = "peers-beaten";
    bool wanted = filter.wants(refinedRow) || filter.wants(beatenRow);
    for (const char* row : kRows) wanted |= filter.wants(row);
    if (!wanted) return;
    const auto device = makeDevice("tablet.glb", 33);
    Refiner refiner(device->coverage);
    std::vector<Comparison> all;
    for (const TargetVolume& target : allTargets(*device)) {
        Comparison of = compareOn(*device, refiner, target);
        if (of.counts()) all.push_back(std::move(of));
    }
    if (all.empty()) return report.fail(refinedRow, "no target counts");

    /// How clearly one is better than the other; below that they count as equal.
    constexpr double kBetter = 1e-6;
    std::vector<double> shares, states;
    std::string worst;
    for (const Comparison& of : all) {
        if (shares.empty() || of.refined / of.best < smallestOf(shares)) worst = of.name;
        shares.push_back(of.refined / of.best);
        states.push_back(of.states);
    }
    if (filter.wants(refinedRow))
        report.add(Row{refinedRow,
                       "refined within 2 ms, share of the best known (mean)",
                       meanOf(shares),
                       "",
                       atLeast(0.995),
                       {},
                       {std::to_string(all.size()) + " targets count; worst " + fixed(smallestOf(shares), 4) + " of " +
                            worst + "; median " + fixed(median(states), 0) + " states",
                        "best known: CMA-ES with 10,000 evaluations, or what any of them found; a hidden state is 1"}});
    std::size_t mostBeaten = 0;
    for (std::size_t p = 0; p < kPeerCount; ++p) {
        std::vector<double> atTime, atEvaluations;
        std::size_t beaten = 0, beatenAtEvaluations = 0;
        for (const Comparison& of : all) {
            atTime.push_back(of.atTime[p] / of.best);
            atEvaluations.push_back(of.atEvaluations[p] / of.best);
            beaten += of.atTime[p] > of.refined + kBetter;
            beatenAtEvaluations += of.atEvaluations[p] > of.refined + kBetter;
        }
        mostBeaten = std::max(mostBeaten, beaten);
        if (!filter.wants(kRows[p])) continue;
        report.add(
            Row{kRows[p],
                std::string(kPeers[p]) + " within 2 ms, share of the best known (mean)",
                meanOf(atTime),
                "",
                {},
                {},
                {"worst " + fixed(smallestOf(atTime), 4) + "; better than refined on " + countOf(beaten, all.size()),
                 "with as many evaluations: mean " + fixed(meanOf(atEvaluations), 4) + ", worst " +
                     fixed(smallestOf(atEvaluations), 4) + "; better on " + countOf(beatenAtEvaluations, all.size())}});
    }
    if (filter.wants(beatenRow))
        report.add(Row{beatenRow,
                       "share of targets on which the best of four peers is better at equal time",
                       static_cast<double>(mostBeaten) / static_cast<double>(all.size()),
                       "",
                       atMost(0.1),
                       {},
                       {"all start from the votes; peers see whole levels by kept pieces, with restarts; median of " +
                        std::to_string(kRuns) + " runs, processor time"}});
}

} // namespace lumorph::bench
