#include "calibration/servos/servo_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <random>
#include <utility>

#include "core/base/error.h"

namespace lumorph {

namespace {

constexpr std::size_t kMostActuators = 64;
constexpr double kAlone = 0.5; // of a stroke: far enough to tell who moves, and seen by everybody
constexpr double kStillSeen = 0.85;
constexpr std::array kLooks = {0.25, 0.5, 0.75, 1.0};

bool shareVertices(const Rig& rig, std::size_t a, std::size_t b) {
    const auto first = rig.verticesOf(a), second = rig.verticesOf(b);
    std::size_t i = 0, k = 0;
    while (i < first.size() && k < second.size()) {
        if (first[i] == second[k]) return true;
        first[i] < second[k] ? ++i : ++k;
    }
    return false;
}

/// Whether all of a group are still seen when they stand alike.
bool seesAll(const std::vector<std::size_t>& group, std::size_t actuators, const auto& seen, const auto& alone) {
    for (std::size_t look = 0; look < kLooks.size(); ++look) {
        std::vector<double> together(actuators, 0.0);
        for (const std::size_t i : group) together[i] = kLooks[look];
        const std::vector<int> now = seen(together);
        for (const std::size_t i : group)
            if (now[i] < kStillSeen * alone[look][i]) return false;
    }
    return true;
}

void check(const Rig& rig, const std::vector<std::vector<std::size_t>>& groups, const ServoPlanOptions& options) {
    const std::size_t count = rig.actuatorCount();
    if (count == 0 || count > kMostActuators)
        throw InvalidInput("rig", "it has " + std::to_string(count) + " actuators", "measure 1 to 64 servos");
    if (options.steps < 4 || options.steps > 200 || options.fresh < 0 || options.fresh > 100)
        throw InvalidInput("plan of servos", "its steps are out of range", "use 4 to 200, and up to 100 fresh states");
    const bool timed = options.velocity > 0.0 && options.settleSeconds >= 0.0 && options.pictureSeconds >= 0.0;
    if (!timed || !std::isfinite(options.velocity + options.settleSeconds + options.pictureSeconds) ||
        options.pictures < 1)
        throw InvalidInput("plan of servos", "its times are out of range", "use finite times above zero");
    std::vector<std::size_t> named, each(count);
    for (const auto& group : groups) named.insert(named.end(), group.begin(), group.end());
    std::ranges::sort(named);
    std::iota(each.begin(), each.end(), 0U);
    if (named != each)
        throw InvalidInput("plan of servos", "its groups do not name each actuator once", "use servoGroups");
}

} // namespace

std::vector<std::vector<std::size_t>>
servoGroups(const Rig& rig, const std::function<std::vector<int>(std::span<const double> strokes)>& seen) {
    const std::size_t count = rig.actuatorCount();
    std::vector<std::vector<int>> alone(kLooks.size(), std::vector<int>(count, 0));
    for (std::size_t look = 0; look < kLooks.size(); ++look)
        for (std::size_t i = 0; i < count; ++i) {
            std::vector<double> strokes(count, 0.0);
            strokes[i] = kLooks[look];
            alone[look][i] = seen(strokes)[i];
        }
    std::vector<std::vector<std::size_t>> groups;
    for (std::size_t i = 0; i < count; ++i) {
        const auto joins = [&](std::vector<std::size_t> group) {
            if (std::ranges::any_of(group, [&](std::size_t k) { return shareVertices(rig, i, k); })) return false;
            group.push_back(i);
            return seesAll(group, count, seen, alone);
        };
        const auto found = std::ranges::find_if(groups, joins);
        if (found == groups.end())
            groups.push_back({i});
        else
            found->push_back(i);
    }
    return groups;
}

double secondsOf(const ServoPlanOptions& options, std::span<const double> from, std::span<const double> to) {
    double farthest = 0.0;
    for (std::size_t i = 0; i < to.size() && i < from.size(); ++i)
        farthest = std::max(farthest, std::abs(to[i] - from[i]));
    return farthest / options.velocity + options.settleSeconds + options.pictures * options.pictureSeconds;
}

ServoPlan planServos(const Rig& rig, std::vector<std::vector<std::size_t>> groups, const ServoPlanOptions& options) {
    check(rig, groups, options);
    const std::size_t count = rig.actuatorCount();
    const std::vector<double> rest(count, 0.0);
    ServoPlan plan;
    plan.steps.push_back({ServoStep::Kind::rest, {}, rest});
    for (std::size_t i = 0; i < count; ++i) {
        std::vector<double> one = rest;
        one[i] = kAlone;
        plan.steps.push_back({ServoStep::Kind::find, {i}, one});
    }
    for (const auto& group : groups)
        // The group before has ended at rest, and a servo that moved alone has not.
        for (int k = &group == &groups.front() ? 0 : 1; k <= 2 * options.steps; ++k) {
            const int level = std::min(k, 2 * options.steps - k);
            std::vector<double> commanded = rest;
            for (const std::size_t i : group) commanded[i] = static_cast<double>(level) / options.steps;
            plan.steps.push_back({ServoStep::Kind::level, group, commanded});
        }
    std::mt19937 dice(options.seed * 2654435761U + 17U);
    for (int k = 0; k < options.fresh; ++k) {
        std::vector<double> commanded;
        for (std::size_t i = 0; i < count; ++i)
            commanded.push_back(std::uniform_real_distribution<double>(0.05, 0.85)(dice));
        plan.steps.push_back({ServoStep::Kind::fresh, {}, commanded});
    }
    std::vector<double> from = rest;
    for (const ServoStep& step : plan.steps) {
        plan.seconds += secondsOf(options, from, step.commanded);
        from = step.commanded;
    }
    plan.groups = std::move(groups);
    return plan;
}

} // namespace lumorph
