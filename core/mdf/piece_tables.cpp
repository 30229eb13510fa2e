#include "core/mdf/piece_tables.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

namespace lumorph {
namespace {

/// A function of the levels of some actuators.
struct Factor {
    std::vector<std::size_t> actuators; ///< ascending
    std::vector<double> values;         ///< the last actuator varies fastest
};

/// What is needed to find an actuator's best level once those of `others` are known.
struct Eliminated {
    std::size_t actuator = 0;
    std::vector<std::size_t> others;
    std::vector<std::uint8_t> levels; ///< one a state of the others
};

std::size_t power(std::size_t base, std::size_t exponent) {
    std::size_t value = 1;
    for (std::size_t i = 0; i < exponent; ++i) {
        if (value > std::numeric_limits<std::size_t>::max() / base) return std::numeric_limits<std::size_t>::max();
        value *= base;
    }
    return value;
}

std::vector<std::size_t> united(const std::vector<std::size_t>& a, const std::vector<std::size_t>& b) {
    std::vector<std::size_t> all;
    std::ranges::set_union(a, b, std::back_inserter(all));
    return all;
}

/// The factor of the others that holds, for each of their states, the most that the sum reaches over the actuator.
Factor maximised(const std::vector<const Factor*>& sum, std::size_t actuator, std::size_t levels, Eliminated& choice) {
    std::vector<std::size_t> all;
    for (const Factor* factor : sum) all = united(all, factor->actuators);
    choice.actuator = actuator;
    choice.others = all;
    std::erase(choice.others, actuator);
    Factor result{choice.others, std::vector<double>(power(levels, choice.others.size()))};
    choice.levels.resize(result.values.size());
    // Of each factor the step in its values for one level of each of the others, and of the actuator.
    std::vector<std::vector<std::size_t>> steps(sum.size(), std::vector<std::size_t>(choice.others.size(), 0));
    std::vector<std::size_t> ownSteps(sum.size(), 0);
    for (std::size_t f = 0; f < sum.size(); ++f) {
        std::size_t step = 1;
        for (std::size_t k = sum[f]->actuators.size(); k-- > 0; step *= levels) {
            const std::size_t of = sum[f]->actuators[k];
            if (of == actuator)
                ownSteps[f] = step;
            else
                steps[f][static_cast<std::size_t>(std::ranges::find(choice.others, of) - choice.others.begin())] = step;
        }
    }
    for (std::size_t index = 0; index < result.values.size(); ++index) {
        std::vector<std::size_t> offsets(sum.size(), 0);
        std::size_t left = index;
        for (std::size_t k = choice.others.size(); k-- > 0; left /= levels)
            for (std::size_t f = 0; f < sum.size(); ++f) offsets[f] += left % levels * steps[f][k];
        double most = -std::numeric_limits<double>::infinity();
        for (std::size_t level = 0; level < levels; ++level) {
            double value = 0.0;
            for (std::size_t f = 0; f < sum.size(); ++f) value += sum[f]->values[offsets[f] + level * ownSteps[f]];
            if (value <= most) continue;
            most = value;
            choice.levels[index] = static_cast<std::uint8_t>(level);
        }
        result.values[index] = most;
    }
    return result;
}

} // namespace

PieceTables::PieceTables(const Coverage& coverage, const BitColumns& target, std::vector<PieceTable> tables)
    : coverage_(coverage), target_(target), tables_(std::move(tables)), state_(coverage.rig().actuatorCount()) {
    const auto width = static_cast<std::size_t>(target.dimensions().x);
    const auto words = static_cast<std::size_t>(target.wordsPerColumn());
    for (PieceTable& table : tables_) {
        ColumnRange range;
        for (const std::size_t column : table.columns) {
            const int x = static_cast<int>(column % width);
            const int z = static_cast<int>(column / width);
            range.include({x, x, z, z});
            wanted_ += countBits(target.words().subspan(column * words, words));
        }
        windows_.push_back(coverage.window(range));
        const std::size_t states = power(static_cast<std::size_t>(coverage.levels()), table.actuators.size());
        table.both.resize(states);
        table.overfill.resize(states);
    }
}

bool PieceTables::count(const std::function<bool()>& stop) {
    for (; nextTable_ < tables_.size(); ++nextTable_, nextState_ = 0) {
        for (; nextState_ < tables_[nextTable_].both.size(); ++nextState_) {
            if (stop()) return false;
            countState(nextTable_, nextState_);
        }
        for (const std::size_t actuator : tables_[nextTable_].actuators) state_[actuator] = Level{};
    }
    return true;
}

void PieceTables::countState(std::size_t t, std::size_t index) {
    PieceTable& table = tables_[t];
    const auto levels = static_cast<std::size_t>(coverage_.levels());
    std::size_t left = index;
    for (std::size_t k = table.actuators.size(); k-- > 0; left /= levels)
        state_[table.actuators[k]] = Level{static_cast<int>(left % levels)};
    const ColumnRange& range = windows_[t].range;
    const auto words = static_cast<std::size_t>(target_.wordsPerColumn());
    words_.resize(range.size() * words);
    coverage_.covered(state_, windows_[t], words_, scratch_);
    const auto gridWidth = static_cast<std::size_t>(target_.dimensions().x);
    const auto corner = static_cast<std::size_t>(range.z0) * gridWidth + static_cast<std::size_t>(range.x0);
    const auto width = static_cast<std::size_t>(range.width());
    int both = 0;
    int covered = 0;
    for (const std::size_t column : table.columns) {
        const std::size_t here = ((column - corner) / gridWidth * width + (column - corner) % gridWidth) * words;
        for (std::size_t word = 0; word < words; ++word) {
            covered += std::popcount(words_[here + word]);
            both += std::popcount(words_[here + word] & target_.words()[column * words + word]);
        }
    }
    table.both[index] = static_cast<std::uint32_t>(both);
    table.overfill[index] = static_cast<std::uint32_t>(covered - both);
}

PieceTables::Best PieceTables::best(double lambda, State& state) const {
    const auto levels = static_cast<std::size_t>(coverage_.levels());
    std::vector<Factor> factors;
    std::vector<std::size_t> open;
    for (const PieceTable& table : tables_) {
        Factor& factor = factors.emplace_back(Factor{table.actuators, std::vector<double>(table.both.size())});
        for (std::size_t i = 0; i < factor.values.size(); ++i)
            factor.values[i] = static_cast<double>(table.both[i]) - lambda * static_cast<double>(table.overfill[i]);
        open = united(open, table.actuators);
    }
    Best best;
    std::vector<Eliminated> eliminated;
    while (!open.empty()) {
        // The actuator with the fewest others beside it makes the smallest table.
        std::size_t next = 0;
        std::size_t fewest = std::numeric_limits<std::size_t>::max();
        for (std::size_t k = 0; k < open.size() && fewest > 1; ++k) {
            std::vector<std::size_t> beside;
            for (const Factor& factor : factors)
                if (std::ranges::binary_search(factor.actuators, open[k])) beside = united(beside, factor.actuators);
            if (beside.size() < fewest) next = k, fewest = beside.size();
        }
        const std::size_t actuator = open[next];
        open.erase(open.begin() + static_cast<std::ptrdiff_t>(next));
        std::vector<Factor> about;
        std::erase_if(factors, [&](Factor& factor) {
            const bool has = std::ranges::binary_search(factor.actuators, actuator);
            if (has) about.push_back(std::move(factor));
            return has;
        });
        // Maxima of parts of a sum are a bound of the maximum of the sum.
        for (std::size_t first = 0; first < about.size();) {
            std::vector<const Factor*> sum{&about[first]};
            std::vector<std::size_t> all = about[first].actuators;
            std::size_t last = first + 1;
            for (; last < about.size(); ++last) {
                std::vector<std::size_t> more = united(all, about[last].actuators);
                if (power(levels, more.size()) > kMostEntries) break;
                all = std::move(more);
                sum.push_back(&about[last]);
            }
            best.exact = best.exact && first == 0 && last == about.size();
            Factor result = maximised(sum, actuator, levels, eliminated.emplace_back());
            if (result.actuators.empty())
                best.value += result.values.front();
            else
                factors.push_back(std::move(result));
            first = last;
        }
    }
    for (std::size_t k = eliminated.size(); k-- > 0;) {
        std::size_t index = 0;
        for (const std::size_t other : eliminated[k].others)
            index = index * levels + static_cast<std::size_t>(state[other].index);
        state[eliminated[k].actuator] = Level{eliminated[k].levels[index]};
    }
    return best;
}

} // namespace lumorph
