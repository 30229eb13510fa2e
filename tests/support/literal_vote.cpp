#include "tests/support/literal_vote.h"

#include <algorithm>
#include <cmath>

namespace lumorph::test {

LiteralVote literalVote(const Field& field, std::size_t actuator, const BitColumns& target) {
    LiteralVote vote;
    const std::vector<Ramp> ramps = denseRamps(field, actuator);
    std::size_t reachable = 0;
    for (int level = 0; level < field.levels; ++level) {
        double error = 0.0;
        double intersection = 0.0;
        reachable = 0;
        for (int z = 0; z < field.frame.dimensions.z; ++z)
            for (int x = 0; x < field.frame.dimensions.x; ++x)
                for (int y = 0; y < field.frame.dimensions.y; ++y) {
                    if (field.body.test(x, y, z)) continue;
                    const std::size_t v = field.voxelIndex(x, y, z);
                    const bool changed = ramps[v].v0 != kUnchanged;
                    const double expectation = changed ? expectationAt(ramps[v], level) : field.background[v] / 255.0;
                    const double wanted = target.test(x, y, z) ? 1.0 : 0.0;
                    error += std::abs(expectation - wanted);
                    intersection += expectation * wanted;
                    reachable += changed && target.test(x, y, z);
                }
        vote.errors.push_back(error);
        vote.intersections.push_back(intersection);
    }
    vote.least = std::max(1.0, 0.01 * static_cast<double>(reachable));
    double best = INFINITY;
    for (int level = 0; level < field.levels && reachable > 0; ++level) {
        const auto j = static_cast<std::size_t>(level);
        if (vote.intersections[j] < vote.least) continue;
        const double ratio = vote.errors[j] / vote.intersections[j];
        if (vote.reached && ratio >= best * (1.0 - 1e-9)) continue;
        best = ratio;
        vote.level = level;
        vote.reached = true;
    }
    return vote;
}

double literalStroke(const LiteralVote& vote) {
    const auto last = static_cast<double>(vote.errors.size() - 1);
    const auto j = static_cast<std::size_t>(vote.level);
    if (!vote.reached || j == 0 || j + 1 == vote.errors.size()) return vote.level / last;
    if (std::min(vote.intersections[j - 1], vote.intersections[j + 1]) < vote.least) return vote.level / last;
    const auto ratio = [&](std::size_t level) { return vote.errors[level] / vote.intersections[level]; };
    // Newton's form through three levels: its derivative is zero at `lowest`.
    const double first = ratio(j) - ratio(j - 1);
    const double second = 0.5 * (ratio(j + 1) - ratio(j) - first);
    if (!(second > 0.0)) return vote.level / last;
    const double lowest = vote.level - 0.5 - first / (2.0 * second);
    return std::clamp(lowest, vote.level - 0.5, vote.level + 0.5) / last;
}

} // namespace lumorph::test
