#include "app/applications/ice/ice.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

#include "app/applications/demo_items.h"
#include "app/applications/ice/pond_bed.h"

namespace lumorph::ice {
namespace {

constexpr std::size_t kFish = 7;
constexpr double kCarries = 0.22;      ///< metres by which water that comes to slope by 1 carries fish along
constexpr double kFinger = 4e-7;       ///< cubic metres: how heavy a touch is
constexpr double kHandNear = 0.07;     ///< metres over the sheet from where on a hand warms
constexpr double kHandOn = 0.012;      ///< where it also presses
constexpr double kRests = 0.006;       ///< metres within which a pointer rests
constexpr double kUntilCrack = 0.8;    ///< seconds of rest
constexpr double kOpen = 0.10;         ///< share of ice below which the pond is open
constexpr double kUntilFrost = 5.0;    ///< seconds it stays so
constexpr double kVisitorsThaw = 6e-5; ///< metres a second: slow, so that there is room for floes to move

constexpr double kOpenings = 0.02; ///< metres between two that fish know of
constexpr std::size_t kMostOpenings = 6;

/// A show of its own, from one frost to the next.
struct OwnShow {
    static constexpr double kSunFrom = IceCover::kFreezing + 0.6, kSunUntil = 33.0;
    struct Strike {
        double seconds;
        glm::dvec2 place;
    };
    static constexpr Strike kStrikes[]{{9.0, {0.01, 0.012}},
                                       {12.0, {-0.05, -0.02}},
                                       {15.0, {0.055, -0.022}},
                                       {18.0, {0.03, 0.035}},
                                       {21.5, {-0.045, 0.03}}};
    static constexpr double kSwaysFrom = 14.0;
    static constexpr double kSlowThaw = 1.6e-4; ///< metres a second, from then on
    static constexpr double kThawFrom = 34.0;
    static constexpr double kThaw = 0.0016; ///< metres a second
    static constexpr double kUntil = 50.0;
};

/// The sun's spot goes slowly round, and stays a while where it is.
glm::dvec2 sunAt(double seconds) {
    const double t = seconds - OwnShow::kSunFrom;
    const double slow = t - 1.6 * std::sin(0.62 * t); // nearly stands still once in ten seconds
    return {0.062 * std::sin(0.21 * slow + 3.6), 0.034 * std::cos(0.34 * slow + 0.3)};
}

const char* soundOf(IceEvent::Kind kind) {
    switch (kind) {
    case IceEvent::Kind::crack:
        return "ice.crack";
    case IceEvent::Kind::bump:
        return "ice.bump";
    case IceEvent::Kind::drip:
        return "ice.drip";
    default:
        return "ice.splash";
    }
}

std::vector<ShowSound> soundsOf(const std::vector<IceEvent>& events) {
    std::vector<ShowSound> sounds;
    sounds.reserve(events.size());
    for (const IceEvent& event : events)
        sounds.push_back({soundOf(event.kind), event.strength, {glm::dvec3(event.place.x, kIceTop, event.place.y)}});
    return sounds;
}

} // namespace

IceProgram::IceProgram(std::uint64_t seed)
    : ice_(pondShore(), seed), school_(ice_.shore(), static_cast<int>(kFish), seed), pond_(ice_.shore(), kFish, seed) {}

ShowContent IceProgram::frame(const ShowMoment& moment) {
    visitor_.take(moment);
    around_.warmths.clear();
    around_.presses.clear();
    takeDevice(moment);
    takeHands(moment);
    alone_ = !visitor_.there() && around_.warmths.empty();
    if (alone_)
        play(moment.step);
    else
        takePointer(moment.step);
    turn();
    slosh_.advance(moment.step, around_.lean);
    around_.lift = [this](const glm::dvec2& place) { return waterAt(place); };
    ice_.advance(moment.step, around_);
    const std::vector<IceEvent> events = ice_.takeEvents();
    noteOpenings(events);
    school_.advance(moment.step, around_.warmths, openings_, kCarries * slosh_.slopeSpeed());
    if (bending_) swell_.advance(ice_, *bending_, moment.step);
    open_ = ice_.iceArea() < kOpen * ice_.sheet().area() && !ice_.freezing() ? open_ + moment.step : 0.0;
    if (open_ > kUntilFrost) freeze();
    ShowContent content;
    content.scene =
        pond_.show(ice_, school_, {around_.warmths, around_.lean, around_.thaw}, moment.step, slosh_.slope());
    content.assets = pond_.assets();
    content.target = swell_.heights();
    content.following = Following::split;
    content.sounds = soundsOf(events);
    return content;
}

void IceProgram::takeDevice(const ShowMoment& moment) {
    if (moment.rig && moment.rig != rig_) {
        rig_ = moment.rig;
        bending_.emplace(*rig_);
    }
    if (bending_) bending_->set(moment.strokes);
    deviceLean_ = {};
    for (const ShowBody& body : moment.bodies)
        if (body.role == PoseRole::device) deviceLean_ = leanOf(moment.worldFromDevice);
    if (!std::isfinite(deviceLean_.x + deviceLean_.y)) deviceLean_ = {};
    around_.bending = bending_ ? &*bending_ : nullptr;
}

/// Tracked hands near the sheet; poses that are no numbers are nobody's.
void IceProgram::takeHands(const ShowMoment& moment) {
    const glm::dmat4 deviceFromWorld = glm::inverse(glm::dmat4(moment.worldFromDevice));
    for (const ShowBody& body : moment.bodies) {
        if (body.role != PoseRole::pointer) continue;
        const glm::dvec4 at = deviceFromWorld * glm::dvec4(body.pose.position, 1.0);
        const double over = at.y - static_cast<double>(kSheet);
        const glm::dvec2 place(at.x, at.z);
        if (!std::isfinite(over + at.x + at.z) || over > kHandNear || !holds(ice_.shore(), place)) continue;
        const double near = std::clamp(1.0 - over / kHandNear, 0.0, 1.0);
        around_.warmths.push_back({place, 0.022, 1.3 * near});
        if (over < kHandOn) around_.presses.push_back({place, 2.0 * kFinger});
    }
}

/// The pointer is a warm finger; where it rests, the ice cracks.
void IceProgram::takePointer(double step) {
    played_ = 0.0;
    around_.lean = Visitor::kMostLean * visitor_.push() + deviceLean_;
    around_.thaw = ice_.floes().size() > 1 ? kVisitorsThaw : 0.0;
    if (!visitor_.pointer()) return rests_.reset();
    const glm::dvec2 place = *visitor_.pointer() * kPondHalf;
    if (!holds(ice_.shore(), place)) return rests_.reset();
    around_.warmths.push_back({place, 0.018, 1.0});
    around_.presses.push_back({place, kFinger});
    if (!rests_ || glm::distance(*rests_, place) > kRests) {
        rests_ = place;
        resting_ = 0.0;
    }
    const bool before = resting_ < kUntilCrack;
    resting_ += step;
    if (before && resting_ >= kUntilCrack) ice_.strike(place);
}

/// Nobody there: the sun melts holes, cracks run, floes drift and melt, and it freezes over again.
void IceProgram::play(double step) {
    const double before = played_;
    played_ += step;
    around_.lean = {};
    around_.thaw = played_ > OwnShow::kThawFrom    ? OwnShow::kThaw
                   : played_ > OwnShow::kSwaysFrom ? OwnShow::kSlowThaw
                                                   : 0.0;
    if (played_ > OwnShow::kSunFrom && played_ < OwnShow::kSunUntil)
        around_.warmths.push_back({sunAt(played_), 0.020, 1.25});
    for (const OwnShow::Strike& strike : OwnShow::kStrikes)
        if (before < strike.seconds && played_ >= strike.seconds) ice_.strike(strike.place);
    if (played_ > OwnShow::kSwaysFrom)
        around_.lean = 0.11 * glm::dvec2(std::sin(0.5 * played_), std::cos(0.37 * played_));
    if (played_ > OwnShow::kUntil) freeze();
}

/// Frost, and its own show begins with it.
void IceProgram::freeze() {
    ice_.freeze();
    played_ = -IceCover::kLeaving;
}

/// Mounds that servos lift, on water that stays level while the device leans.
WaterLevel IceProgram::waterAt(const glm::dvec2& place) const noexcept {
    WaterLevel water = swell_.at(place);
    water.height += slosh_.heightAt(place);
    water.slope += slosh_.slope();
    return water;
}

void IceProgram::noteOpenings(const std::vector<IceEvent>& events) {
    if (ice_.freezing()) openings_.clear();
    for (const IceEvent& event : events) {
        const auto known = [&](const glm::dvec2& place) { return glm::distance(place, event.place) < kOpenings; };
        if (event.kind != IceEvent::Kind::drip || std::ranges::any_of(openings_, known)) continue;
        if (openings_.size() == kMostOpenings) openings_.erase(openings_.begin());
        openings_.push_back(event.place);
    }
}

void IceProgram::turn() {
    if (visitor_.restart() || visitor_.left()) freeze();
    if (!visitor_.next()) return;
    const glm::dvec2 place = visitor_.pointer() ? *visitor_.pointer() * kPondHalf : glm::dvec2(0.0);
    if (!ice_.strike(place)) ice_.strike({});
}

Demo iceDemo() {
    return {.name = "ice",
            .title = {"Ice on a pond", "Eis auf einem Teich"},
            .sentence = {"Warm it, and it gets holes; tap it, and it cracks: floes drift and rise under your hands, "
                         "koi swim below.",
                         "Wärme es, und es bekommt Löcher; tippe darauf, und es bricht: Schollen treiben, heben sich, "
                         "und darunter schwimmen Koi."},
            .thumbnail = "thumbnails/ice.png",
            .open = bundledTablet,
            .program = [](const ProgramStart& start, const Progress&) -> std::unique_ptr<ShowProgram> {
                return std::make_unique<IceProgram>(start.seed);
            }};
}

} // namespace lumorph::ice
