#include "core/mdf/level_gains.h"

#include <algorithm>

namespace lumorph {

ActuatorLevels levelsOf(const Coverage& coverage, std::size_t actuator) {
    const Coverage::Window window = coverage.window(coverage.columnsMovedBy(actuator));
    ActuatorLevels made{window.range, {}, {}};
    if (window.range.empty()) return made;
    CoverageScratch scratch;
    State state(coverage.rig().actuatorCount());
    const auto words = static_cast<std::size_t>(coverage.body().wordsPerColumn());
    for (int level = 0; level < coverage.levels(); ++level) {
        state[actuator] = Level{level};
        std::vector<std::uint64_t>& covered = made.words.emplace_back(window.range.size() * words);
        coverage.covered(state, window, covered, scratch);
        made.covered.push_back(static_cast<int>(countBits(covered)));
    }
    return made;
}

void countGains(const ActuatorLevels& levels, const BitColumns& wanted, std::vector<LevelGain>& gains) {
    gains.assign(levels.words.size(), {});
    const auto words = static_cast<std::size_t>(wanted.wordsPerColumn());
    const std::size_t count = static_cast<std::size_t>(std::max(0, levels.range.width())) * words;
    for (std::size_t level = 0; level < gains.size(); ++level) {
        std::size_t both = 0;
        const std::span<const std::uint64_t> covered = levels.words[level];
        for (int z = levels.range.z0; z <= levels.range.z1; ++z)
            both += countBitsAnd(covered.subspan(static_cast<std::size_t>(z - levels.range.z0) * count, count),
                                 wanted.words().subspan(wanted.columnIndex(levels.range.x0, z) * words, count));
        gains[level] = {levels.covered[level], static_cast<int>(both)};
    }
    for (std::size_t level = gains.size(); level-- > 0;) {
        gains[level].covered -= gains.front().covered;
        gains[level].both -= gains.front().both;
    }
}

SumState bestBySums(const LevelGains& gains, int both, int covered, int wanted) {
    SumState best{State(gains.size()), -1.0};
    for (;;) {
        const double aim = std::max(0.0, best.iou);
        int allBoth = both;
        int allCovered = covered;
        State next(gains.size());
        for (std::size_t a = 0; a < gains.size(); ++a) {
            if (gains[a].empty()) continue;
            double most = 0.0;
            for (std::size_t level = 1; level < gains[a].size(); ++level) {
                const LevelGain& gain = gains[a][level];
                const double worth = gain.both - aim * (gain.covered - gain.both);
                if (worth <= most) continue;
                most = worth;
                next[a].index = static_cast<int>(level);
            }
            const LevelGain& taken = gains[a][static_cast<std::size_t>(next[a].index)];
            allBoth += taken.both;
            allCovered += taken.covered;
        }
        const int either = allCovered + wanted - allBoth;
        const double reached = either > 0 ? static_cast<double>(allBoth) / either : 0.0;
        if (reached <= best.iou) return best;
        best = {std::move(next), reached};
    }
}

} // namespace lumorph
