#include "app/applications/ice/fish.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "app/applications/ice/fracture.h"

namespace lumorph::ice {
namespace {

constexpr double kStep = 1.0 / 60.0; ///< seconds
constexpr double kMostSwum = 0.25;   ///< seconds
constexpr double kCruise = 0.016;    ///< metres a second
constexpr double kFlight = 0.075;    ///< metres a second, at most
constexpr double kTurns = 1.5;       ///< radians a second, at leisure
constexpr double kFear = 0.045;      ///< metres from warmth
constexpr double kBankRoom = 0.022;  ///< metres from the bank at which it turns away
constexpr double kRoom = 0.030;      ///< metres between two fish
constexpr double kBeat = 3.2;        ///< tail strokes in a second at leisure

} // namespace

School::School(const Polygon& shore, int count, std::uint64_t seed) : shore_(shore) {
    std::mt19937_64 random(seed ^ 0x9E3779B97F4A7C15ULL);
    for (const glm::dvec2& site : evenSites(shore, count, random)) {
        Fish fish;
        fish.place = 0.8 * site;
        fish.heading = 2.0 * std::numbers::pi * chance(random);
        fish.depth = 0.25 + 0.5 * chance(random);
        fish.stroke = 2.0 * std::numbers::pi * chance(random);
        fish.length = 0.027 + 0.011 * chance(random);
        fish.mood = 10.0 * chance(random);
        fish_.push_back(fish);
    }
}

void School::advance(double seconds, std::span<const Warmth> warmths, std::span<const glm::dvec2> openings,
                     const glm::dvec2& current) {
    if (std::isfinite(seconds)) left_ += std::clamp(seconds, 0.0, kMostSwum);
    for (; left_ >= kStep; left_ -= kStep) {
        seconds_ += kStep;
        for (std::size_t k = 0; k < fish_.size(); ++k) {
            swim(k, kStep, wishOf(k, warmths, openings));
            const glm::dvec2 carried = fish_[k].place + current * kStep;
            if (holds(shore_, carried)) fish_[k].place = carried;
        }
    }
}

School::Wish School::wishOf(std::size_t k, std::span<const Warmth> warmths,
                            std::span<const glm::dvec2> openings) const {
    const Fish& fish = fish_[k];
    const double roam =
        fish.heading + 1.1 * std::sin(0.37 * seconds_ + fish.mood) + 0.5 * std::sin(0.91 * seconds_ + 2.0 * fish.mood);
    Wish wish;
    glm::dvec2& way = wish.way;
    way = {std::cos(roam), std::sin(roam)};
    if (!openings.empty()) { // each looks at one for a while, and then at the next
        const auto turn = static_cast<std::size_t>(0.06 * seconds_ + fish.mood);
        const glm::dvec2 there = openings[turn % openings.size()] - fish.place;
        way += 0.9 * there / (0.015 + glm::length(there));
    }
    const glm::dvec2 bank = nearestOnRim(shore_, fish.place);
    const double room = glm::distance(bank, fish.place);
    if (room < kBankRoom && room > 0.0) way += 2.5 * (1.0 - room / kBankRoom) * (fish.place - bank) / room;
    for (std::size_t other = 0; other < fish_.size(); ++other) {
        const glm::dvec2 from = fish.place - fish_[other].place;
        const double far = glm::length(from);
        if (other != k && far > 1e-6 && far < kRoom) way += 1.2 * (1.0 - far / kRoom) * from / far;
    }
    for (const Warmth& warmth : warmths) {
        const glm::dvec2 from = fish.place - warmth.place;
        const double far = glm::length(from);
        if (!(far > 1e-6 && far < kFear && warmth.power > 0.0)) continue;
        const double fear = (1.0 - far / kFear) * std::min(1.0, warmth.power);
        way += 4.0 * fear * from / far;
        wish.hurry = std::max(wish.hurry, fear);
    }
    return wish;
}

void School::swim(std::size_t k, double seconds, const Wish& wish) {
    Fish& fish = fish_[k];
    const auto& [way, hurry] = wish;
    const double off = std::remainder(std::atan2(way.y, way.x) - fish.heading, 2.0 * std::numbers::pi);
    const double most = kTurns * (1.0 + 3.0 * hurry) * seconds;
    fish.heading = std::remainder(fish.heading + std::clamp(off, -most, most), 2.0 * std::numbers::pi);
    const double cruise = kCruise * (1.0 + 0.5 * std::sin(0.53 * seconds_ + 3.0 * fish.mood));
    const double wanted = cruise + hurry * (kFlight - cruise);
    fish.speed += (wanted - fish.speed) * seconds / (wanted > fish.speed ? 0.15 : 0.8);
    fish.place += fish.speed * seconds * glm::dvec2(std::cos(fish.heading), std::sin(fish.heading));
    const glm::dvec2 half = 0.5 * fish.length * glm::dvec2(std::cos(fish.heading), std::sin(fish.heading));
    if (!holds(shore_, fish.place + half) || !holds(shore_, fish.place - half))
        fish.place *= 0.995; // from head to tail, the middle of the pond is home
    fish.depth = 0.5 + 0.28 * std::sin(0.21 * seconds_ + 5.0 * fish.mood) - 0.2 * hurry;
    const double beat = kBeat * (0.5 + fish.speed / kCruise * 0.5);
    fish.stroke = std::remainder(fish.stroke + std::min(beat, 9.0) * seconds * 2.0, 2.0 * std::numbers::pi);
}

} // namespace lumorph::ice
