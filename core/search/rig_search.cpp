#include "core/search/rig_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <random>

#include <pagmo/algorithm.hpp>
#include <pagmo/algorithms/nsga2.hpp>
#include <pagmo/batch_evaluators/member_bfe.hpp>
#include <pagmo/bfe.hpp>
#include <pagmo/population.hpp>
#include <pagmo/problem.hpp>
#include <pagmo/utils/multi_objective.hpp>
#include <tbb/parallel_for.h>

namespace lumorph {
namespace {

using Genes = SheetDesigns::Gene;
constexpr std::size_t kGenes = SheetDesigns::kGenes;
constexpr std::size_t kKept = 6; ///< designs that are kept for each cost
constexpr double kGravity = 9.80665;

/// A number of its own for each seed, generation and purpose (splitmix64's finaliser).
std::uint64_t mixed(std::uint64_t seed, std::uint64_t generation, std::uint64_t purpose) {
    std::uint64_t z = seed + 0x9E3779B97F4A7C15ULL * (4 * generation + purpose + 1);
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31U);
}

/// Random numbers that are the same with every standard library.
class Chance {
public:
    explicit Chance(std::uint64_t seed) : random_(seed) {}
    double share() { return static_cast<double>(random_() >> 11U) * 0x1.0p-53; }
    std::size_t below(std::size_t count) {
        return std::min(count - 1, static_cast<std::size_t>(share() * static_cast<double>(count)));
    }
    double normal() { // Box and Muller
        const double radius = std::sqrt(-2.0 * std::log(1.0 - share()));
        return radius * std::cos(6.283185307179586 * share());
    }

private:
    std::mt19937_64 random_;
};

using Line = std::array<double, kGenes>;

std::vector<Line> linesIn(const DesignPoint& point) {
    std::vector<Line> lines;
    for (std::size_t k = 0; k * kGenes < point.size(); ++k) {
        if (point[k * kGenes + Genes::kThere] < 0.5) continue;
        std::copy_n(point.begin() + static_cast<std::ptrdiff_t>(k * kGenes), kGenes, lines.emplace_back().begin());
    }
    return lines;
}

DesignPoint pointWith(const std::vector<Line>& lines, std::size_t dimension) {
    DesignPoint point(dimension, 0.0);
    for (std::size_t k = 0; k < std::min(lines.size(), dimension / kGenes); ++k) {
        std::ranges::copy(lines[k], point.begin() + static_cast<std::ptrdiff_t>(k * kGenes));
        point[k * kGenes + Genes::kThere] = 1.0;
    }
    return point;
}

Line randomLine(Chance& chance) {
    Line line{1.0, chance.share(), chance.share(), chance.share(), chance.share(), chance.share()};
    // Devices are drawn square to their edges, or across their corners, more often than not.
    if (chance.share() < 0.5) line[Genes::kDirection] = static_cast<double>(chance.below(8)) / 8.0;
    return line;
}

double wrapped(double turns) { return turns - std::floor(turns); }

Line mirrored(const Line& line, std::size_t way) {
    Line other = line;
    if (way != 1) other[Genes::kMiddleX] = 1.0 - line[Genes::kMiddleX];
    if (way != 0) other[Genes::kMiddleZ] = 1.0 - line[Genes::kMiddleZ];
    // The flap stays on the left of its line: a mirrored line runs backwards.
    const double turned = line[Genes::kDirection];
    other[Genes::kDirection] = wrapped(way == 0 ? -turned : way == 1 ? 0.5 - turned : 0.5 + turned);
    return other;
}

void shift(Line& line, Chance& chance) {
    const double size = std::pow(10.0, -0.6 - 2.2 * chance.share());
    for (const Genes gene : {Genes::kMiddleX, Genes::kMiddleZ, Genes::kDirection, Genes::kLength}) {
        if (chance.share() < 0.4) continue;
        const double moved = line[gene] + size * chance.normal();
        line[gene] = gene == Genes::kDirection ? wrapped(moved) : std::clamp(moved, 0.0, 1.0);
    }
    if (chance.share() < 0.05) line[Genes::kEnds] = 1.0 - line[Genes::kEnds];
}

/// Moves of whole lines.
DesignPoint varied(const DesignPoint& parent, const DesignPoint& other, const std::vector<ScoredDesign>& known,
                   std::size_t dimension, Chance& chance) {
    const auto goodLine = [&] {
        if (known.empty() || chance.share() < 0.25) return randomLine(chance);
        const double rank = chance.share();
        Line line = linesIn(known[chance.below(known.size())].point).front();
        if (rank < 0.5) shift(line, chance);
        return line;
    };
    std::vector<Line> lines = linesIn(parent);
    const std::size_t most = dimension / kGenes;
    const double move = chance.share();
    if (lines.empty() || (move < 0.10 && lines.size() < most)) {
        lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(chance.below(lines.size() + 1)), goodLine());
    } else if (move < 0.22 && lines.size() < most) {
        lines.push_back(mirrored(lines[chance.below(lines.size())], chance.below(3)));
    } else if (move < 0.30) {
        lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(chance.below(lines.size())));
    } else if (move < 0.36) {
        lines[chance.below(lines.size())] = goodLine();
    } else if (move < 0.40) {
        std::swap(lines[chance.below(lines.size())], lines[chance.below(lines.size())]);
    } else if (move < 0.50) {
        for (const Line& line : linesIn(other))
            if (chance.share() < 0.5) {
                if (lines.size() < most && chance.share() < 0.5)
                    lines.push_back(line);
                else
                    lines[chance.below(lines.size())] = line;
            }
    } else {
        do shift(lines[chance.below(lines.size())], chance);
        while (chance.share() < 0.3);
    }
    return pointWith(lines, dimension);
}

/// pagmo's view of a batch.
struct DesignProblem {
    std::shared_ptr<const ScoreBatch> score;
    std::shared_ptr<std::vector<ScoredDesign>> seen; ///< all that were scored
    std::size_t dimension = 1;

    [[nodiscard]] std::pair<pagmo::vector_double, pagmo::vector_double> get_bounds() const {
        return {pagmo::vector_double(dimension, 0.0), pagmo::vector_double(dimension, 1.0)};
    }
    [[nodiscard]] pagmo::vector_double::size_type get_nobj() const { return 2; }
    [[nodiscard]] pagmo::vector_double fitness(const pagmo::vector_double& x) const { return batch_fitness(x); }
    [[nodiscard]] pagmo::vector_double batch_fitness(const pagmo::vector_double& all) const {
        std::vector<DesignPoint> points;
        for (auto at = all.begin(); at != all.end(); at += static_cast<std::ptrdiff_t>(dimension))
            points.emplace_back(at, at + static_cast<std::ptrdiff_t>(dimension));
        const std::vector<DesignScore> scores = (*score)(points);
        pagmo::vector_double fitness;
        for (std::size_t k = 0; k < points.size(); ++k) {
            seen->push_back({points[k], scores[k]});
            fitness.insert(fitness.end(), {scores[k].cost, -scores[k].fit});
        }
        return fitness;
    }
};

void keepBest(SearchState& state, const ScoredDesign& design) {
    std::vector<ScoredDesign>& kept = state.best[std::llround(100.0 * design.score.cost)];
    if (std::ranges::any_of(kept, [&](const ScoredDesign& k) { return k.score.fit == design.score.fit; })) return;
    const auto place = std::ranges::find_if(kept, [&](const auto& k) { return k.score.fit < design.score.fit; });
    if (place == kept.end() && kept.size() >= kKept) return;
    kept.insert(place, design);
    if (kept.size() > kKept) kept.pop_back();
}

std::vector<ScoredDesign> scored(const std::vector<DesignPoint>& points, const ScoreBatch& score) {
    const std::vector<DesignScore> scores = score(points);
    std::vector<ScoredDesign> designs;
    designs.reserve(points.size());
    for (std::size_t k = 0; k < points.size(); ++k) designs.push_back({points[k], scores[k]});
    return designs;
}

/// NSGA-II's own selection among designs, of which equal ones count once.
std::vector<ScoredDesign> selected(const std::vector<ScoredDesign>& among, std::size_t count) {
    std::vector<ScoredDesign> different;
    std::vector<ScoredDesign> same;
    for (const ScoredDesign& design : among) {
        const bool known = std::ranges::any_of(different, [&](const auto& d) {
            return d.score.cost == design.score.cost && d.score.fit == design.score.fit;
        });
        (known ? same : different).push_back(design);
    }
    if (different.size() <= count) {
        for (std::size_t k = 0; different.size() < count; ++k) different.push_back(same[k]);
        return different;
    }
    std::vector<pagmo::vector_double> fitness;
    fitness.reserve(different.size());
    for (const ScoredDesign& design : different) fitness.push_back({design.score.cost, -design.score.fit});
    std::vector<ScoredDesign> chosen;
    for (const auto k : pagmo::select_best_N_mo(fitness, count)) chosen.push_back(different[k]);
    return chosen;
}

/// Random lines, each improved by itself; of those that have become alike the best.
std::vector<ScoredDesign> goodLines(std::size_t dimension, const ScoreBatch& score, Chance& chance) {
    constexpr std::size_t kLines = 256;
    constexpr int kSteps = 48;
    constexpr std::size_t kGood = 48;
    constexpr double kAlike = 0.04;
    std::vector<Line> lines(kLines);
    for (Line& line : lines) line = randomLine(chance);
    std::vector<ScoredDesign> designs;
    for (int step = 0; step <= kSteps; ++step) {
        std::vector<DesignPoint> points;
        for (const Line& line : lines) {
            Line next = line;
            if (step > 0) shift(next, chance);
            points.push_back(pointWith({next}, dimension));
        }
        std::vector<ScoredDesign> now = scored(points, score);
        if (step == 0) designs = now;
        for (std::size_t k = 0; k < kLines; ++k)
            if (now[k].score.gain > designs[k].score.gain) {
                designs[k] = std::move(now[k]);
                lines[k] = linesIn(designs[k].point).front();
            }
    }
    std::ranges::stable_sort(designs, [](const auto& a, const auto& b) { return a.score.gain > b.score.gain; });
    std::vector<ScoredDesign> good;
    const auto alike = [&](const ScoredDesign& a, const ScoredDesign& b) {
        const double turned = std::abs(a.point[Genes::kDirection] - b.point[Genes::kDirection]);
        return std::abs(a.point[Genes::kMiddleX] - b.point[Genes::kMiddleX]) < kAlike &&
               std::abs(a.point[Genes::kMiddleZ] - b.point[Genes::kMiddleZ]) < kAlike &&
               std::min(turned, 1.0 - turned) < kAlike;
    };
    for (const ScoredDesign& design : designs)
        if (good.size() < kGood && design.score.gain > 0.0 &&
            std::ranges::none_of(good, [&](const auto& g) { return alike(g, design); }))
            good.push_back(design);
    return good;
}

/// Designs of good lines, added one after another, better ones earlier more often, while the fit grows.
std::vector<ScoredDesign> putTogether(SearchState& state, std::size_t count, const ScoreBatch& score, Chance& chance) {
    constexpr std::size_t kAdded = 32;
    std::vector<std::vector<std::size_t>> orders(count);
    for (auto& order : orders) {
        std::vector<std::pair<double, std::size_t>> keys;
        for (std::size_t k = 0; k < state.lines.size(); ++k)
            keys.emplace_back(-state.lines[k].score.gain * (0.3 + chance.share()), k);
        std::ranges::sort(keys);
        for (std::size_t k = 0; k < std::min(kAdded, keys.size()); ++k) order.push_back(keys[k].second);
    }
    std::vector<ScoredDesign> designs(count, {DesignPoint(state.dimension, 0.0), {}});
    for (std::size_t step = 0; step < std::min(kAdded, state.lines.size()); ++step) {
        std::vector<DesignPoint> points;
        for (std::size_t d = 0; d < count; ++d) {
            std::vector<Line> lines = linesIn(designs[d].point);
            if (lines.size() < state.dimension / kGenes)
                lines.push_back(linesIn(state.lines[orders[d][step]].point).front());
            points.push_back(pointWith(lines, state.dimension));
        }
        const std::vector<ScoredDesign> now = scored(points, score);
        for (std::size_t d = 0; d < count; ++d)
            if (now[d].score.fit > designs[d].score.fit + 0.001) {
                designs[d] = now[d];
                keepBest(state, now[d]);
            }
    }
    return designs;
}

} // namespace

double DesignScorer::priceOf(const std::vector<Flap>& flaps) const {
    double price = 0.0;
    for (const Flap& flap : flaps) {
        // Weight acts at the flap's middle, the push at its tip; both are farthest from the line at rest.
        double area = 0.0;
        double moment = 0.0;
        double tip = 0.0;
        for (std::size_t k = 0; k + 1 < flap.rim.size(); ++k) {
            const glm::dvec2 a = 1e-3 * flap.rim[k];
            const glm::dvec2 b = 1e-3 * flap.rim[k + 1];
            area += 0.5 * (a.y + b.y) * (b.x - a.x);
            moment += (a.y * a.y + a.y * b.y + b.y * b.y) * (b.x - a.x) / 6.0;
            tip = std::max({tip, a.y, b.y});
        }
        const ServoType* servo = cheapestServo(load_.arealDensity * kGravity * moment + load_.push * tip);
        price += servo != nullptr ? servo->price : 3.0 * servoTypes().back().price;
    }
    return price;
}

DesignScore DesignScorer::of(const DesignPoint& point) const {
    const std::vector<Flap> flaps = designs_.flapsOf(point);
    const double cost = cost_ == SearchCost::servos ? static_cast<double>(flaps.size()) : priceOf(flaps);
    const SheetFit::Worth worth = fit_.of(flaps);
    return {cost, worth.fit, worth.gain};
}

std::vector<DesignScore> DesignScorer::batch(const std::vector<DesignPoint>& points, const Progress& progress) const {
    std::vector<DesignScore> scores(points.size());
    tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t k) {
        progress.throwIfCancelled();
        scores[k] = of(points[k]);
    });
    return scores;
}

int usablePopulation(int wanted) noexcept { return std::max(8, (wanted + 3) / 4 * 4); }

SearchState beginSearch(const SheetDesigns& designs, int population, std::uint64_t seed,
                        const std::vector<DesignPoint>& given, const ScoreBatch& score) {
    SearchState state;
    state.seed = seed;
    state.dimension = designs.dimension();
    const auto count = static_cast<std::size_t>(usablePopulation(population));
    Chance chance(mixed(seed, 0, 0));
    const ScoreBatch counted = [&](const std::vector<DesignPoint>& points) {
        state.evaluations += points.size();
        return score(points);
    };
    state.lines = goodLines(state.dimension, counted, chance);
    std::vector<DesignPoint> points{DesignPoint(state.dimension, 0.0)};
    points.insert(points.end(), given.begin(), given.end());
    points.resize(std::min(points.size(), count / 4));
    std::vector<ScoredDesign> found = scored(points, counted);
    for (const ScoredDesign& design : state.lines) keepBest(state, design);
    for (const ScoredDesign& design : putTogether(state, count / 2, counted, chance)) found.push_back(design);
    points.clear();
    while (found.size() + points.size() < count) {
        std::vector<Line> lines(1 + chance.below(designs.mostLines()));
        for (Line& line : lines) line = randomLine(chance);
        points.push_back(pointWith(lines, state.dimension));
    }
    for (const ScoredDesign& design : scored(points, counted)) found.push_back(design);
    for (const ScoredDesign& design : found) keepBest(state, design);
    state.population = std::move(found);
    return state;
}

void nextGeneration(SearchState& state, const ScoreBatch& score) {
    SearchState next = state;
    const auto generation = static_cast<std::uint64_t>(++next.generation);
    auto seen = std::make_shared<std::vector<ScoredDesign>>();
    const DesignProblem design{std::make_shared<const ScoreBatch>(score), seen, state.dimension};
    pagmo::population people{pagmo::problem{design}, 0U, 0U};
    for (const ScoredDesign& one : state.population) people.push_back(one.point, {one.score.cost, -one.score.fit});
    pagmo::nsga2 nsga2(1U, 0.9, 10.0, 1.0 / static_cast<double>(state.dimension), 20.0,
                       static_cast<unsigned>(mixed(state.seed, generation, 1)));
    nsga2.set_bfe(pagmo::bfe{pagmo::member_bfe{}});
    people = nsga2.evolve(people);

    std::vector<ScoredDesign> all;
    const auto points = people.get_x();
    const auto fitness = people.get_f();
    for (std::size_t k = 0; k < points.size(); ++k) all.push_back({points[k], {fitness[k][0], -fitness[k][1], 0.0}});
    for (const ScoredDesign& one : *seen) keepBest(next, one);

    Chance chance(mixed(state.seed, generation, 2));
    std::vector<const std::vector<ScoredDesign>*> kept;
    for (const auto& [cost, designs] : next.best) kept.push_back(&designs);
    const auto parent = [&]() -> const DesignPoint& {
        const std::vector<ScoredDesign>& of = *kept[chance.below(kept.size())];
        return of[chance.share() < 0.5 ? 0 : chance.below(of.size())].point;
    };
    std::vector<DesignPoint> moved;
    while (moved.size() < state.population.size()) {
        const DesignPoint& first = parent();
        moved.push_back(varied(first, parent(), next.lines, state.dimension, chance));
    }
    const std::vector<ScoredDesign> more = scored(moved, score);
    all.insert(all.end(), more.begin(), more.end());
    for (const ScoredDesign& one : more) keepBest(next, one);
    next.evaluations += seen->size() + more.size();
    next.population = selected(all, state.population.size());
    state = std::move(next);
}

std::vector<ScoredDesign> frontOf(const SearchState& state) {
    std::vector<ScoredDesign> front;
    for (const auto& [cost, designs] : state.best)
        if (front.empty() || designs.front().score.fit > front.back().score.fit) front.push_back(designs.front());
    return front;
}

} // namespace lumorph
