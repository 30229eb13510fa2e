#include "app/applications/ice/meltwater.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "app/applications/ice/fracture.h"

namespace lumorph::ice {
namespace {

constexpr int kNoFloe = 0; ///< floes count from 1
constexpr double kWaterStep = 1.0 / 60.0;
constexpr double kMostWaterSteps = 15;
constexpr float kWaterRim = 0.55F;      ///< of a field's shape: beyond, water drips
constexpr float kWholeIce = 0.9F;       ///< of a field's shape
constexpr double kWeeps = 7.0;          ///< drops a second under warmth of power 1
constexpr double kPuddlesApart = 0.008; ///< metres: nearer warmth feeds a puddle that is there
constexpr double kFills = 5.0;          ///< drops a second under warmth of power 1
constexpr double kRunsOver = 2.2;       ///< drops that a puddle holds
constexpr double kSeeps = 0.35;         ///< drops a second that it loses without warmth
constexpr double kDownhill = 0.16;      ///< metres a second for each unit of slope
constexpr double kOutward = 0.018;      ///< metres a second towards the rim where the top bends down
constexpr double kWanders = 0.006;      ///< metres a second to the side
constexpr double kGetsGoing = 0.18;     ///< seconds, by a factor of e
constexpr double kPointsApart = 0.0009; ///< metres
constexpr double kMeets = 0.0016;       ///< metres between two that become one
constexpr std::size_t kMostPoints = 60;
constexpr double kLongest = 9.0;                         ///< seconds that one runs
constexpr double kThawDrops = 3.0, kThawFaster = 1600.0; ///< drops a second of a thaw, and more for each metre a second

const Floe* floeNumbered(const IceCover& ice, int number) {
    const auto found = std::ranges::find(ice.floes(), number, &Floe::number);
    return found == ice.floes().end() ? nullptr : &*found;
}

/// Water of a floe that has broken is on the part under it.
void adopt(const IceCover& ice, int& floe, const glm::dvec2& home) {
    if (floeNumbered(ice, floe)) return;
    floe = kNoFloe;
    for (int plate = 0; plate < std::ssize(ice.floes()); ++plate)
        if (ice.sheet().cellAt(plate, home) >= 0) floe = ice.floes()[static_cast<std::size_t>(plate)].number;
}

glm::dvec2 turned(const glm::dvec2& direction, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    return {c * direction.x - s * direction.y, s * direction.x + c * direction.y};
}

} // namespace

double Meltwater::radiusOf(const Puddle& puddle) noexcept { return 0.0022 * std::sqrt(puddle.volume); }

void Meltwater::advance(const IceCover& ice, const Fields& fields, const MeltingWeather& weather, double seconds) {
    left_ = std::min(left_ + std::max(seconds, 0.0), kMostWaterSteps * kWaterStep);
    for (; left_ >= kWaterStep; left_ -= kWaterStep) step(ice, fields, weather);
}

void Meltwater::step(const IceCover& ice, const Fields& fields, const MeltingWeather& weather) {
    dry(ice);
    if (ice.freezing()) return;
    for (const Floe& floe : ice.floes()) {
        const FloeField* field = fields(floe.number);
        if (!field || field->shape.empty()) continue;
        for (const Warmth& warmth : weather.warmths)
            if (glm::distance(warmth.place, centreNow(floe)) < floe.radius) gather(floe, *field, warmth);
        drain(floe, *field);
    }
    thaw(ice, weather);
    for (Rivulet& rivulet : rivulets_) {
        if (!rivulet.runs) continue;
        const Floe* floe = floeNumbered(ice, rivulet.floe);
        const FloeField* field = floe ? fields(rivulet.floe) : nullptr;
        if (field) run(rivulet, *floe, *field, weather.lean);
    }
    for (Rivulet& rivulet : rivulets_)
        if (rivulet.runs) join(rivulet);
}

void Meltwater::gather(const Floe& floe, const FloeField& field, const Warmth& warmth) {
    const glm::dvec2 home = homeOf(floe.motion.placement, warmth.place);
    if (field.between(field.shape, home) < kWholeIce) return weep(floe, field, home, warmth);
    auto puddle = std::ranges::find_if(puddles_, [&](const Puddle& one) {
        return one.floe == floe.number && glm::distance(one.home, home) < kPuddlesApart;
    });
    if (puddle == puddles_.end()) {
        if (puddles_.size() >= kMostPuddles) return;
        puddles_.push_back({floe.number, home, 0.0});
        puddle = puddles_.end() - 1;
    }
    puddle->home += 0.03 * (home - puddle->home);
    puddle->volume = std::min(kMostPuddle, puddle->volume + kFills * warmth.power * kWaterStep);
}

/// Warmth over a hole draws water from the ice about it.
void Meltwater::weep(const Floe& floe, const FloeField& field, const glm::dvec2& home, const Warmth& warmth) {
    if (chance(random_) > kWeeps * warmth.power * kWaterStep) return;
    const double angle = 2.0 * std::numbers::pi * chance(random_);
    const double away = warmth.radius * (0.5 + 1.0 * chance(random_)), volume = 0.6 + 0.8 * chance(random_);
    const glm::dvec2 from = home + away * glm::dvec2(std::cos(angle), std::sin(angle));
    if (field.between(field.shape, from) > kWholeIce) begin(floe, from, volume);
}

/// A full puddle runs over; one over a hole falls through.
void Meltwater::drain(const Floe& floe, const FloeField& field) {
    for (Puddle& puddle : puddles_) {
        if (puddle.floe != floe.number) continue;
        if (field.between(field.shape, puddle.home) < kWaterRim) {
            drip(placed(floe.motion.placement, puddle.home), puddle.volume);
            puddle.volume = -1.0;
            continue;
        }
        puddle.volume -= kSeeps * kWaterStep;
        if (puddle.volume < kRunsOver || chance(random_) > 3.0 * kWaterStep) continue;
        const double volume = 0.7 + 0.8 * chance(random_), angle = 2.0 * std::numbers::pi * chance(random_);
        const glm::dvec2 from = puddle.home + 0.8 * radiusOf(puddle) * glm::dvec2(std::cos(angle), std::sin(angle));
        if (field.between(field.shape, from) < kWaterRim) continue;
        puddle.volume -= volume;
        begin(floe, from, volume);
    }
}

/// Mild air: drops come anywhere on what floats.
void Meltwater::thaw(const IceCover& ice, const MeltingWeather& weather) {
    if (weather.thaw <= 0.0) return;
    due_ += (kThawDrops + kThawFaster * weather.thaw) * kWaterStep;
    for (; due_ >= 1.0; due_ -= 1.0) {
        const auto count = static_cast<double>(ice.sheet().cells().size());
        const auto number = static_cast<std::size_t>(chance(random_) * count);
        const Cell& cell = ice.sheet().cells()[std::min(number, ice.sheet().cells().size() - 1)];
        const double volume = 0.5 + 0.5 * chance(random_);
        if (cell.outline.empty() || cell.plate < 0 || cell.plate >= std::ssize(ice.floes())) continue;
        const Floe& floe = ice.floes()[static_cast<std::size_t>(cell.plate)];
        if (!floe.fixed) begin(floe, centreOf(cell.outline), volume);
    }
}

void Meltwater::begin(const Floe& floe, const glm::dvec2& home, double volume) {
    if (rivulets_.size() >= kMostRivulets) return;
    Rivulet rivulet;
    rivulet.floe = floe.number;
    rivulet.volume = volume;
    rivulet.home = home;
    rivulet.wander = 2.0 * std::numbers::pi * chance(random_);
    rivulet.way.push_back({home, 0.0});
    rivulets_.push_back(std::move(rivulet));
}

/// Down the slope of its floe and of the device, out where the top bends down, in bends and by starts.
void Meltwater::run(Rivulet& rivulet, const Floe& floe, const FloeField& field, const glm::dvec2& lean) {
    const glm::dvec2 downhill = turned(lean - floe.bob.tilt, -floe.motion.placement.turn);
    const glm::dvec2 in = field.slope(field.inland, rivulet.home);
    const double steep = glm::length(in);
    const glm::dvec2 out = steep > 1e-6 ? -in / steep * std::min(1.0, steep / 20.0) : glm::dvec2(0.0);
    glm::dvec2 wanted = kDownhill * downhill + kOutward * out;
    rivulet.wander += 4.0 * kWaterStep * (0.5 + chance(random_));
    if (const double speed = glm::length(wanted); speed > 1e-9)
        wanted += kWanders * std::sin(rivulet.wander) * glm::dvec2(-wanted.y, wanted.x) / speed;
    wanted *= std::sqrt(rivulet.volume) * (0.65 + 0.35 * std::sin(1.7 * rivulet.wander));
    rivulet.velocity += (1.0 - std::exp(-kWaterStep / kGetsGoing)) * (wanted - rivulet.velocity);
    rivulet.home += kWaterStep * rivulet.velocity;
    if (glm::distance(rivulet.home, rivulet.way.back().home) > kPointsApart && rivulet.way.size() < kMostPoints)
        rivulet.way.push_back({rivulet.home, 0.0});
    if (field.between(field.shape, rivulet.home) < kWaterRim) {
        rivulet.way.push_back({rivulet.home, 0.0});
        rivulet.runs = false;
        drip(placed(floe.motion.placement, rivulet.home), rivulet.volume);
    } else if (rivulet.age > kLongest) {
        rivulet.runs = false;
    }
}

/// Into the way of another, nearest to its head, whose water it becomes.
void Meltwater::join(Rivulet& rivulet) {
    if (rivulet.age < 0.4) return; // those of one puddle part first
    for (Rivulet& other : rivulets_) {
        if (&other == &rivulet || !other.runs || other.floe != rivulet.floe || other.age < rivulet.age) continue;
        const auto met = std::ranges::find_if(other.way, [&](const Rivulet::Point& point) {
            return glm::distance(point.home, rivulet.home) < kMeets && point.age < 0.8 * kWayLasts;
        });
        if (met == other.way.end()) continue;
        rivulet.way.push_back({met->home, 0.0});
        rivulet.runs = false;
        other.volume = std::min(4.0, other.volume + rivulet.volume);
        for (auto point = met; point != other.way.end(); ++point) point->age = std::min(point->age, 0.3);
        return;
    }
}

/// What is over, and what was on floes that are gone.
void Meltwater::dry(const IceCover& ice) {
    for (Drip& one : drips_) one.age += kWaterStep;
    std::erase_if(drips_, [](const Drip& one) { return one.age > kDripLasts; });
    for (Rivulet& rivulet : rivulets_) {
        rivulet.age += kWaterStep;
        for (Rivulet::Point& point : rivulet.way) point.age += kWaterStep;
        while (rivulet.way.size() > 1 && rivulet.way.front().age > kWayLasts) rivulet.way.erase(rivulet.way.begin());
    }
    for (Rivulet& rivulet : rivulets_) adopt(ice, rivulet.floe, rivulet.home);
    for (Puddle& puddle : puddles_) adopt(ice, puddle.floe, puddle.home);
    std::erase_if(rivulets_, [&](const Rivulet& one) {
        return one.floe == kNoFloe || (!one.runs && one.way.back().age > kWayLasts);
    });
    std::erase_if(puddles_, [](const Puddle& one) { return one.volume < 0.0 || one.floe == kNoFloe; });
}

void Meltwater::drip(const glm::dvec2& place, double volume) {
    if (drips_.size() < kMostDrips) drips_.push_back({place, volume, 0.0});
}

} // namespace lumorph::ice
