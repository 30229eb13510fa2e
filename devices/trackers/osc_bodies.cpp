#include "devices/trackers/osc_bodies.h"

#include <algorithm>

namespace lumorph {

namespace {

constexpr std::size_t kMostBodies = 32;
constexpr Microseconds kRotationsStopped{200'000};

} // namespace

OscBodies::Halves* OscBodies::of(const std::string& name) {
    const auto found =
        std::ranges::find(halves_, name, [](const Halves& h) -> const std::string& { return h.body.name; });
    if (found != halves_.end()) return &*found;
    if (halves_.size() == kMostBodies) return nullptr;
    Halves halves;
    halves.body.id = static_cast<std::int32_t>(halves_.size());
    halves.body.name = name;
    halves.body.valid = true;
    halves_.push_back(halves);
    return &halves_.back();
}

const TrackerFrame* OscBodies::take(std::span<const osc::PosePart> parts, Microseconds now) {
    for (const osc::PosePart& part : parts) {
        Halves* halves = of(part.body);
        if (halves == nullptr) continue;
        if (part.kind == osc::PosePart::Kind::position) {
            halves->body.pose.position = osc::positionOf(part.value);
            halves->freshPosition = halves->positioned = true;
        } else {
            halves->body.pose.rotation = osc::rotationOf(part.value);
            halves->freshRotation = halves->everRotated = true;
            halves->rotated = now;
        }
    }
    frame_.bodies.clear();
    for (Halves& halves : halves_) {
        const bool rotates = halves.everRotated && now - halves.rotated < kRotationsStopped;
        if (!halves.freshPosition || (rotates && !halves.freshRotation)) continue;
        halves.freshPosition = halves.freshRotation = false;
        frame_.bodies.push_back(halves.body);
    }
    if (frame_.bodies.empty()) return nullptr;
    frame_.measured = frame_.arrived = now;
    ++frame_.number;
    return &frame_;
}

bool OscBodies::onlyRotations() const { return !halves_.empty() && std::ranges::none_of(halves_, &Halves::positioned); }

} // namespace lumorph
