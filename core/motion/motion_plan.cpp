#include "core/motion/motion_plan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/base/error.h"

namespace lumorph {
namespace {

constexpr std::size_t kPositions = 65;
constexpr std::size_t kVelocities = 13; // odd, so that rest is one of them
constexpr std::size_t kCommands = 33;
constexpr std::size_t kNodes = kPositions * kVelocities;
/// Gain that a whole stroke of way must bring: an actuator does not go to and fro for next to nothing.
constexpr double kCostOfWay = 0.02;

double shareOf(std::size_t index, std::size_t count) {
    return static_cast<double>(index) / static_cast<double>(count - 1);
}

/// Linear between evenly spaced values over [0, 1].
double interpolated(std::span<const float> values, double at) {
    const double place = std::clamp(at, 0.0, 1.0) * static_cast<double>(values.size() - 1);
    const std::size_t low = std::min(static_cast<std::size_t>(place), values.size() - 2);
    const double share = place - static_cast<double>(low);
    return (1.0 - share) * static_cast<double>(values[low]) + share * static_cast<double>(values[low + 1]);
}

std::size_t framesOf(std::span<const float> gains, std::size_t count) {
    if (count >= 2 && gains.size() % count == 0) return gains.size() / count;
    throw InvalidInput("gains of a motion", std::to_string(gains.size()) + " for " + std::to_string(count) + " strokes",
                       "give one for each stroke and frame");
}

} // namespace

MotionPlanner::MotionPlanner(const MotionLimits& limits, double seconds) : limits_(limits), seconds_(seconds) {
    moves_.reserve(kNodes * kCommands);
    for (std::size_t p = 0; p < kPositions; ++p)
        for (std::size_t v = 0; v < kVelocities; ++v) {
            const MotionState from{shareOf(p, kPositions), limits.maxVelocity * (2.0 * shareOf(v, kVelocities) - 1.0)};
            for (std::size_t c = 0; c < kCommands; ++c) {
                const MotionState to = advance(from, shareOf(c, kCommands), seconds, limits);
                moves_.push_back(moveTo(to, std::abs(to.position - from.position)));
            }
        }
}

MotionPlanner::Move MotionPlanner::moveTo(const MotionState& state, double way) const {
    const double position = state.position * static_cast<double>(kPositions - 1);
    const double velocity =
        std::clamp(0.5 + 0.5 * state.velocity / limits_.maxVelocity, 0.0, 1.0) * static_cast<double>(kVelocities - 1);
    const std::size_t p = std::min(static_cast<std::size_t>(position), kPositions - 2);
    const std::size_t v = std::min(static_cast<std::size_t>(velocity), kVelocities - 2);
    return {static_cast<std::uint32_t>(p * kVelocities + v), static_cast<float>(position - static_cast<double>(p)),
            static_cast<float>(velocity - static_cast<double>(v)), static_cast<float>(kCostOfWay * way)};
}

namespace {

float blend(const float* node, float upPosition, float upVelocity) {
    const float low = node[0] + upVelocity * (node[1] - node[0]);
    const float high = node[kVelocities] + upVelocity * (node[kVelocities + 1] - node[kVelocities]);
    return low + upPosition * (high - low);
}

} // namespace

float MotionPlanner::valueAt(std::span<const float> values, const MotionState& state) const {
    const Move at = moveTo(state, 0.0);
    return blend(&values[at.node], at.upPosition, at.upVelocity);
}

void MotionPlanner::stepBack(std::span<const float> after, std::span<float> before) const {
    const Move* move = moves_.data();
    for (float& value : before) {
        value = std::numeric_limits<float>::lowest();
        for (std::size_t c = 0; c < kCommands; ++c, ++move)
            value = std::max(value, blend(&after[move->node], move->upPosition, move->upVelocity) - move->cost);
    }
}

MotionPlan MotionPlanner::plan(MotionState start, std::span<const float> gains, std::size_t count) const {
    const std::size_t frames = framesOf(gains, count);
    // What follows the end of each frame is worth, and a copy with what that end itself gains.
    std::vector<float> worth(frames * kNodes, 0.0F);
    std::vector<float> whole(kNodes);
    for (std::size_t k = frames; k-- > 1;) {
        const std::span<const float> row = gains.subspan(k * count, count);
        for (std::size_t p = 0; p < kPositions; ++p) {
            const auto gain = static_cast<float>(interpolated(row, shareOf(p, kPositions)));
            for (std::size_t v = 0; v < kVelocities; ++v)
                whole[p * kVelocities + v] = gain + worth[k * kNodes + p * kVelocities + v];
        }
        stepBack(whole, std::span(worth).subspan((k - 1) * kNodes, kNodes));
    }
    std::vector<double> commands;
    MotionState now = start;
    for (std::size_t k = 0; k < frames; ++k) {
        const std::span<const float> row = gains.subspan(k * count, count);
        const std::span<const float> later = std::span<const float>(worth).subspan(k * kNodes, kNodes);
        double best = now.position, highest = std::numeric_limits<double>::lowest();
        MotionState next = now;
        const auto consider = [&](double command) {
            const MotionState to = advance(now, command, seconds_, limits_);
            const double value = interpolated(row, to.position) + static_cast<double>(valueAt(later, to)) -
                                 kCostOfWay * std::abs(to.position - now.position);
            if (value <= highest) return;
            highest = value;
            best = command;
            next = to;
        };
        consider(now.position); // first: of commands that gain the same it is the one that moves least
        for (std::size_t c = 0; c < kCommands; ++c) consider(shareOf(c, kCommands));
        for (double step = 0.5 / static_cast<double>(kCommands - 1); step > 1e-3; step *= 0.5) {
            const double middle = best;
            consider(std::max(0.0, middle - step));
            consider(std::min(1.0, middle + step));
        }
        commands.push_back(best);
        now = next;
    }
    return follow(start, commands, gains, count);
}

MotionPlan MotionPlanner::follow(MotionState start, std::span<const double> commands, std::span<const float> gains,
                                 std::size_t count) const {
    if (framesOf(gains, count) != commands.size())
        throw InvalidInput("commands of a motion",
                           std::to_string(commands.size()) + ", but the gains are of another "
                                                             "number of frames",
                           "give one for each frame");
    MotionPlan plan;
    plan.commands.assign(commands.begin(), commands.end());
    for (std::size_t k = 0; k < commands.size(); ++k) {
        const MotionState to = advance(start, commands[k], seconds_, limits_);
        plan.gain += interpolated(gains.subspan(k * count, count), to.position) -
                     kCostOfWay * std::abs(to.position - start.position);
        plan.states.push_back(to);
        start = to;
    }
    return plan;
}

} // namespace lumorph
