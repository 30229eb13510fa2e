#include "app/applications/ice/ice_cover.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>

#include "app/applications/ice/fracture.h"

namespace lumorph::ice {
namespace {

constexpr std::size_t kMostEvents = 100; ///< that nobody has asked for
constexpr double kMostAtOnce = 0.25;     ///< seconds
constexpr std::uint64_t kMeltEvery = 2;  ///< steps
constexpr std::uint64_t kShapeEvery = 12;
constexpr std::uint64_t kStrainEvery = 6;
constexpr double kStarReach = 0.016;   ///< metres around a blow: cells there are divided
constexpr double kCrackLength = 0.14;  ///< metres
constexpr double kLeastFloe = 14e-6;   ///< square metres: smaller ones melt away
constexpr double kHoldsToBank = 0.5;   ///< of the pond: smaller plates come off the bank
constexpr double kLeastThaw = 5e-5;    ///< metres at once: rims draw back in steps that nobody sees
constexpr double kLeavingThaw = 0.025; ///< of old ice, metres a second
constexpr double kSlides = 0.16;       ///< acceleration of floes a radian of lean, metres a second squared
constexpr double kCurrent = 0.0022;    ///< acceleration by the water's own motion, metres a second squared
constexpr double kSharpBend = 2.6;     ///< curvature that harms ice, 1 over metres
constexpr double kSteepLean = 0.10;    ///< radians that harm it
constexpr double kCalm = 1.6;          ///< seconds between two cracks by stress
constexpr double kRipple = 0.0005;     ///< of the water under floes, metres
constexpr double kRippleLength = 0.09;
constexpr double kRipplePeriod = 3.1;
constexpr double kLoudBump = 1.5e-6; ///< cubic metres a second

/// Slow eddies that keep floes on their way.
glm::dvec2 currentAt(const glm::dvec2& place, double seconds) {
    const double a = 42.0 * place.x + 0.21 * seconds, b = 55.0 * place.y - 0.17 * seconds;
    return kCurrent *
           glm::dvec2(std::sin(b) + 0.4 * std::sin(0.13 * seconds), std::sin(a) + 0.4 * std::cos(0.11 * seconds));
}

WaterLevel rippleAt(const glm::dvec2& place, double seconds) {
    const glm::dvec2 wave = 2.0 * std::numbers::pi / kRippleLength * glm::dvec2(0.8, 0.6);
    const double phase = glm::dot(wave, place) - 2.0 * std::numbers::pi * seconds / kRipplePeriod;
    return {kRipple * std::sin(phase), kRipple * wave * std::cos(phase)};
}

/// Without what is no number.
Surroundings sound(Surroundings around) {
    const auto isFinite = [](const glm::dvec2& v) { return std::isfinite(v.x) && std::isfinite(v.y); };
    std::erase_if(around.warmths, [&](const Warmth& warmth) {
        return !isFinite(warmth.place) || !(warmth.radius > 0.0) || !std::isfinite(warmth.radius) ||
               !(warmth.power > 0.0) || !std::isfinite(warmth.power);
    });
    std::erase_if(around.presses,
                  [&](const Press& press) { return !isFinite(press.place) || !std::isfinite(press.volume); });
    if (!isFinite(around.lean)) around.lean = {};
    if (!std::isfinite(around.thaw)) around.thaw = 0.0;
    return around;
}

} // namespace

glm::dvec2 centreNow(const Floe& floe) noexcept { return placed(floe.motion.placement, floe.centre); }

IceCover::IceCover(Polygon shore, std::uint64_t seed)
    : shore_(std::move(shore)), seed_(seed), random_(seed), sheet_(shore_, seed), cracks_(seed), world_(shore_) {
    beginWinter();
}

/// A new sheet, which nothing has touched.
void IceCover::beginWinter() {
    ++winter_;
    const std::uint64_t seed = seed_ * 1000 + winter_;
    random_.seed(seed);
    sheet_ = Sheet(shore_, seed);
    cracks_ = Cracks(seed);
    world_.clear();
    floes_.clear();
    frost_ = leaving_ = thawing_ = 0.0;
    calm_ = kCalm;
    frostBegins_.clear();
    for (const Cell& cell : sheet_.cells()) {
        const glm::dvec2 centre = centreOf(cell.outline);
        const double inland = glm::distance(nearestOnRim(shore_, centre), centre);
        frostBegins_.push_back(std::min(0.6, 9.0 * inland) * (0.7 + 0.3 * chance(random_)));
    }
    gather();
}

void IceCover::happened(IceEvent::Kind kind, double strength, const glm::dvec2& place) {
    if (events_.size() < kMostEvents) events_.push_back({kind, strength, place});
}

void IceCover::freeze() {
    if (freezing() || leaving_ > 0.0) return;
    leaving_ = kLeaving;
}

double IceCover::growth(int cell) const noexcept {
    if (!freezing()) return 1.0;
    const auto k = static_cast<std::size_t>(cell);
    const double share = k < frostBegins_.size() ? std::clamp((frost_ - frostBegins_[k]) / 0.4, 0.0, 1.0) : 1.0;
    return share * (2.0 - share);
}

Polygon IceCover::grown(int cell) const {
    Polygon outline = sheet_.cells()[static_cast<std::size_t>(cell)].outline;
    const double share = growth(cell);
    if (share >= 1.0 || outline.empty()) return outline;
    if (share <= 0.0) return {};
    const glm::dvec2 centre = centreOf(outline);
    for (glm::dvec2& corner : outline) corner = centre + share * (corner - centre);
    return outline;
}

double IceCover::iceArea() const noexcept {
    double area = 0.0;
    for (int k = 0; k < std::ssize(sheet_.cells()); ++k)
        area += std::pow(growth(k), 2.0) * areaOf(sheet_.cells()[static_cast<std::size_t>(k)].outline);
    return area;
}

double IceCover::melted() const noexcept { return freezing() ? sheet_.area() - iceArea() : sheet_.melted(); }

void IceCover::advance(double seconds, const Surroundings& given) {
    if (std::isfinite(seconds)) left_ += std::clamp(seconds, 0.0, kMostAtOnce);
    if (left_ < FloeWorld::kStep) return;
    const Surroundings around = sound(given);
    for (; left_ >= FloeWorld::kStep; left_ -= FloeWorld::kStep) step(around);
}

void IceCover::step(const Surroundings& around) {
    ++steps_;
    if (freezing()) {
        frost_ += FloeWorld::kStep / kFreezing;
        return;
    }
    if (leaving_ > 0.0 && (leaving_ -= FloeWorld::kStep) <= 0.0) return beginWinter();
    if (steps_ % kMeltEvery == 0) meltAll(around, kMeltEvery * FloeWorld::kStep);
    if (steps_ % kStrainEvery == 0) strain(around, kStrainEvery * FloeWorld::kStep);
    cracks_.advance(sheet_, shore_, FloeWorld::kStep);
    if (sheet_.isDirty()) gather();
    if (steps_ % kShapeEvery == 0) reshape();
    move(around);
}

void IceCover::meltAll(const Surroundings& around, double seconds) {
    thawing_ += (around.thaw + (leaving_ > 0.0 ? kLeavingThaw : 0.0)) * seconds;
    const double depth = thawing_ < kLeastThaw ? 0.0 : std::exchange(thawing_, 0.0);
    for (std::size_t k = 0; k < floes_.size(); ++k) {
        Floe& floe = floes_[k];
        if (depth > 0.0) thaw(sheet_, floe.cells, depth);
        std::vector<Warmth> near;
        for (const Warmth& warmth : around.warmths)
            if (glm::distance(warmth.place, centreNow(floe)) < floe.radius + warmth.radius) near.push_back(warmth);
        if (melt(sheet_, static_cast<int>(k), floe.motion.placement, near, seconds, random_))
            happened(IceEvent::Kind::drip, 1.0, near.front().place);
        measure(floe);
        if (floe.area > kLeastFloe) continue;
        for (const int cell : floe.cells) sheet_.remove(cell);
    }
}

/// Of the floe of a bond, by the device's bend and lean; above 0 it harms.
double IceCover::stressOn(const Bond& bond, const Surroundings& around) const {
    const Floe& floe = floeOf(bond);
    const double large = std::min(1.0, 4.0 * floe.area / sheet_.area());
    const double steep = std::max(0.0, glm::length(around.lean) / kSteepLean - 1.0);
    double stress = floe.fixed ? 1.2 * steep : 0.0; // what floats slides instead
    if (around.bending) {
        const glm::dvec2 from = placed(floe.motion.placement, bond.edge.from);
        const glm::dvec2 to = placed(floe.motion.placement, bond.edge.to);
        const glm::dvec2 along = (to - from) / glm::distance(from, to);
        const double bend = around.bending->curvatureAt(0.5 * (from + to), {-along.y, along.x});
        stress += std::max(0.0, std::abs(bend) / kSharpBend - 1.0);
    }
    return large * stress;
}

const Floe& IceCover::floeOf(const Bond& bond) const {
    return floes_[static_cast<std::size_t>(sheet_.cells()[static_cast<std::size_t>(bond.a)].plate)];
}

/// Bonds suffer from stress; the one that is farthest gone gives way, and a crack runs from there both ways.
void IceCover::strain(const Surroundings& around, double seconds) {
    calm_ -= seconds;
    std::size_t weakest = sheet_.bonds().size();
    double farthest = 0.0;
    for (std::size_t k = 0; k < sheet_.bonds().size(); ++k) {
        sheet_.addDamage(k, stressOn(sheet_.bonds()[k], around) * seconds);
        const Bond& bond = sheet_.bonds()[k];
        if (bond.damage - bond.strength <= farthest) continue;
        farthest = bond.damage - bond.strength;
        weakest = k;
    }
    if (weakest == sheet_.bonds().size() || calm_ > 0.0) return;
    calm_ = kCalm;
    const Segment edge = sheet_.bonds()[weakest].edge;
    happened(IceEvent::Kind::crack, 1.0, placed(floeOf(sheet_.bonds()[weakest]).motion.placement, edge.from));
    sheet_.breakBond(weakest);
    const glm::dvec2 along = glm::normalize(edge.to - edge.from);
    cracks_.start(edge.to, along, kCrackLength);
    cracks_.start(edge.from, -along, kCrackLength);
}

/// The ice at a place, or what is nearest to it within the reach of a blow.
IceCover::Target IceCover::nearestIce(const glm::dvec2& place) const {
    Target target;
    double least = kStarReach;
    for (std::size_t k = 0; k < floes_.size(); ++k) {
        const glm::dvec2 home = homeOf(floes_[k].motion.placement, place);
        for (const int cell : floes_[k].cells) {
            const Polygon& outline = sheet_.cells()[static_cast<std::size_t>(cell)].outline;
            if (outline.empty()) continue;
            if (holds(outline, home)) return {static_cast<int>(k), home};
            const glm::dvec2 nearest = nearestOnRim(outline, home);
            if (glm::distance(nearest, home) >= least) continue;
            least = glm::distance(nearest, home);
            target = {static_cast<int>(k), nearest};
        }
    }
    return target;
}

bool IceCover::strike(const glm::dvec2& place) {
    if (freezing() || leaving_ > 0.0 || !std::isfinite(place.x) || !std::isfinite(place.y)) return false;
    const Target target = nearestIce(place);
    if (target.floe < 0) return false;
    sheet_.divide(target.floe, target.home, kStarReach, starSites(target.home, random_));
    startStar(target.home);
    happened(IceEvent::Kind::crack, 1.5, place);
    if (sheet_.isDirty()) gather();
    return true;
}

/// Cracks on three sides, from the corner of cells that is nearest to the blow.
void IceCover::startStar(const glm::dvec2& home) {
    glm::dvec2 from = home;
    double least = kStarReach;
    for (const Bond& bond : sheet_.bonds())
        for (const glm::dvec2& end : {bond.edge.from, bond.edge.to})
            if (glm::distance(end, home) < least) least = glm::distance(from = end, home);
    const double first = 2.0 * std::numbers::pi * chance(random_);
    for (int k = 0; k < 3; ++k) {
        const double angle = first + 2.0 * std::numbers::pi * (k + 0.4 * chance(random_)) / 3.0;
        cracks_.start(from, {std::cos(angle), std::sin(angle)}, kCrackLength);
    }
}

std::vector<Polygon> IceCover::piecesOf(const Floe& floe) const {
    std::vector<Polygon> pieces;
    for (const int cell : floe.cells)
        if (!sheet_.cells()[static_cast<std::size_t>(cell)].outline.empty())
            pieces.push_back(sheet_.cells()[static_cast<std::size_t>(cell)].outline);
    return pieces;
}

/// Its area, middle and version, after its cells have changed.
void IceCover::measure(Floe& floe) const {
    std::uint64_t version = floe.cells.size();
    for (const int k : floe.cells)
        version = version * 6364136223846793005ULL + sheet_.cells()[static_cast<std::size_t>(k)].version +
                  static_cast<std::uint64_t>(k) * 1024 + 1;
    if (version == floe.version) return;
    floe.version = version;
    floe.area = floe.radius = 0.0;
    glm::dvec2 moment(0.0);
    const std::vector<Polygon> pieces = piecesOf(floe);
    for (const Polygon& piece : pieces) {
        floe.area += areaOf(piece);
        moment += areaOf(piece) * centreOf(piece);
    }
    if (floe.area > 0.0) floe.centre = moment / floe.area;
    for (const Polygon& piece : pieces)
        for (const glm::dvec2& corner : piece) floe.radius = std::max(floe.radius, glm::distance(corner, floe.centre));
}

/// What hangs together now; what is new goes on as that of which it was a part.
void IceCover::gather() {
    std::vector<int> before;
    for (const Cell& cell : sheet_.cells()) before.push_back(cell.plate);
    std::vector<Floe> old = std::exchange(floes_, {});
    for (std::vector<int>& cells : sheet_.gatherPlates()) {
        Floe floe;
        floe.cells = std::move(cells);
        floe.fixed =
            std::ranges::any_of(floe.cells, [&](int k) { return sheet_.cells()[static_cast<std::size_t>(k)].ashore; });
        measure(floe);
        const int parent = before[static_cast<std::size_t>(floe.cells.front())];
        inherit(floe, parent >= 0 && parent < std::ssize(old) ? &old[static_cast<std::size_t>(parent)] : nullptr);
        floes_.push_back(std::move(floe));
    }
    for (const Floe& floe : old)
        if (floe.body >= 0) world_.remove(floe.body);
    loosen();
}

/// Place and motion of the floe from which it came; its body too, where it is the same floe.
void IceCover::inherit(Floe& floe, Floe* from) {
    if (from) {
        floe.motion = from->motion;
        floe.bob = from->bob;
    }
    if (from && from->body >= 0 && from->cells == floe.cells && from->fixed == floe.fixed) {
        floe.body = std::exchange(from->body, -1);
        floe.shaped = from->shaped;
        floe.number = from->number;
        return;
    }
    if (from) {
        const glm::dvec2 aside = centreNow(floe) - centreNow(*from);
        floe.motion.velocity += from->motion.spin * glm::dvec2(-aside.y, aside.x);
    }
    if (from && !floe.fixed) { // it rocks as it comes off
        const double x = chance(random_), z = chance(random_);
        rock(floe.bob, floe.area, 0.01 * floe.area * (glm::dvec2(x, z) - 0.5));
    }
    floe.body = world_.add(piecesOf(floe), floe.motion, floe.fixed);
    floe.shaped = floe.version;
    floe.number = ++numbers_;
}

/// Only a plate that is large enough holds to the bank.
void IceCover::loosen() {
    bool any = false;
    for (const Floe& floe : floes_) {
        if (!floe.fixed || floe.area > kHoldsToBank * sheet_.area()) continue;
        for (const int cell : floe.cells)
            if (sheet_.cells()[static_cast<std::size_t>(cell)].ashore) sheet_.breakFromShore(cell);
        happened(IceEvent::Kind::splash, floe.area / sheet_.area(), centreNow(floe));
        any = true;
    }
    if (any) gather();
}

/// Bodies follow what has melted; until then they are a hair larger than the ice.
void IceCover::reshape() {
    for (Floe& floe : floes_) {
        measure(floe);
        if (floe.version == floe.shaped || floe.area <= kLeastFloe) continue;
        world_.reshape(floe.body, piecesOf(floe));
        floe.shaped = floe.version;
    }
}

void IceCover::move(const Surroundings& around) {
    const double seconds = static_cast<double>(steps_) * FloeWorld::kStep;
    for (const Floe& floe : floes_)
        if (!floe.fixed) world_.push(floe.body, kSlides * around.lean + currentAt(centreNow(floe), seconds));
    world_.step();
    for (Floe& floe : floes_) {
        if (floe.fixed) continue;
        floe.motion = world_.motion(floe.body);
        const glm::dvec2 centre = centreNow(floe);
        WaterLevel water = rippleAt(centre, seconds);
        if (around.lift) {
            const WaterLevel lifted = around.lift(centre);
            water.height += lifted.height;
            water.slope += lifted.slope;
        }
        FloeLoad load;
        for (const Press& press : around.presses) {
            if (glm::distance(press.place, centre) > floe.radius) continue;
            load.volume += press.volume;
            load.arm = press.place - centre;
        }
        bob(floe.bob, floe.area, water, load, FloeWorld::kStep);
    }
    readBumps();
}

void IceCover::readBumps() {
    for (const FloeBump& bump : world_.bumps()) {
        for (Floe& floe : floes_) {
            if (floe.fixed || (floe.body != bump.a && floe.body != bump.b)) continue;
            rock(floe.bob, floe.area, 0.3 * (floe.body == bump.b ? bump.impulse : -bump.impulse));
        }
        const double strength = glm::length(bump.impulse);
        if (strength > kLoudBump) happened(IceEvent::Kind::bump, strength / kLoudBump, bump.place);
    }
}

} // namespace lumorph::ice
