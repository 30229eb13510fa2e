#include "core/mdf/sampling.h"

#include <string>

#include <boost/random/sobol.hpp>

#include "core/base/error.h"

namespace lumorph {

namespace {

/// SplitMix64 (Steele, Lea and Flood 2014): a well-mixed number for each counter value.
std::uint64_t mixed(std::uint64_t value) {
    value += 0x9E3779B97F4A7C15U;
    value = (value ^ (value >> 30U)) * 0xBF58476D1CE4E5B9U;
    value = (value ^ (value >> 27U)) * 0x94D049BB133111EBU;
    return value ^ (value >> 31U);
}

} // namespace

std::vector<State> quasiRandomStates(std::size_t actuators, int levels, std::size_t count, std::uint64_t seed) {
    constexpr std::size_t kDimensions = 3667;
    if (actuators > kDimensions)
        throw InvalidInput(std::to_string(actuators) + " actuators", "the sampling sequence has 3667 dimensions",
                           "split the rig into parts that do not touch");
    std::vector<State> states(count, State(actuators));
    if (actuators == 0) return states;
    boost::random::sobol sequence(actuators);
    for (State& state : states)
        for (std::size_t i = 0; i < actuators; ++i) {
            const std::uint64_t bits = sequence() ^ mixed(seed * kDimensions + i);
            // The high half is uniform in [0, 2^32): scale it to the levels without a division's bias.
            state[i] = Level{static_cast<int>(((bits >> 32U) * static_cast<std::uint64_t>(levels)) >> 32U)};
        }
    return states;
}

std::vector<State> allStates(std::size_t actuators, int levels) {
    std::vector<State> states{State(actuators)};
    for (std::size_t i = 0; i < actuators; ++i) {
        const std::size_t known = states.size();
        for (int level = 1; level < levels; ++level)
            for (std::size_t k = 0; k < known; ++k) {
                states.push_back(states[k]);
                states.back()[i] = Level{level};
            }
    }
    return states;
}

std::uint64_t jointStateCount(std::size_t actuators, int levels, std::uint64_t limit) noexcept {
    std::uint64_t count = 1;
    for (std::size_t i = 0; i < actuators; ++i) {
        count *= static_cast<std::uint64_t>(levels);
        if (count >= limit) return limit;
    }
    return count;
}

} // namespace lumorph
