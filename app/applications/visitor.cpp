#include "app/applications/visitor.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

namespace lumorph {
namespace {

constexpr double kHandRests = 0.03; ///< radians: a device that lies or is held level
constexpr double kStickRests = 0.08;
constexpr double kPointerCounts = 0.6; ///< seconds after it was moved

double stick(double value) { return std::isfinite(value) ? std::clamp(value, -1.0, 1.0) : 0.0; }

glm::dvec2 limited(const glm::dvec2& lean) {
    const double length = glm::length(lean);
    return length > Visitor::kMostLean ? lean * (Visitor::kMostLean / length) : lean;
}

} // namespace

void Visitor::take(const ShowMoment& moment) {
    active_ = restart_ = next_ = attract_ = false;
    for (const ShowInput& input : moment.inputs) take(input);
    pointerRests_ = holds_ ? 0.0 : pointerRests_ + moment.step;
    device_ = {};
    for (const ShowBody& body : moment.bodies)
        if (body.role == PoseRole::device) device_ = leanOf(moment.worldFromDevice);
    active_ = active_ || glm::length(device_) > kHandRests || glm::length(push()) > 0.0;
    decide(moment.step);
}

void Visitor::take(const ShowInput& input) {
    const double held = input.value > 0.5 ? 1.0 : 0.0;
    if (input.name == "key.attract") {
        attract_ = attract_ || held > 0.0;
        return; // who leaves it to itself does not play
    }
    active_ = active_ || input.value != 0.0;
    if (input.name == "key.left")
        negative_.x = held;
    else if (input.name == "key.right")
        positive_.x = held;
    else if (input.name == "key.up")
        negative_.y = held;
    else if (input.name == "key.down")
        positive_.y = held;
    else if (input.name == "pointer.x")
        point(input.value, &glm::dvec2::x);
    else if (input.name == "pointer.y")
        point(input.value, &glm::dvec2::y);
    else if (input.name == "pointer.over" && held == 0.0)
        pointer_.reset();
    else if (input.name == "pointer.held")
        holds_ = held > 0.0;
    else if (input.name == "pad.x")
        pad_.x = stick(input.value);
    else if (input.name == "pad.y")
        pad_.y = stick(input.value);
    else if (input.name == "key.restart")
        restart_ = restart_ || held > 0.0;
    else if (input.name == "key.next")
        next_ = next_ || held > 0.0;
}

void Visitor::point(double value, double glm::dvec2::*axis) {
    if (!pointer_) pointer_.emplace(0.0);
    (*pointer_).*axis = stick(value);
    pointerRests_ = 0.0;
}

void Visitor::decide(double step) {
    const bool wasThere = there_;
    silence_ = active_ ? 0.0 : silence_ + step;
    there_ = !attract_ && (active_ || (there_ && silence_ <= kSilence));
    came_ = there_ && !wasThere;
    left_ = wasThere && !there_;
}

glm::dvec2 Visitor::push() const noexcept {
    const glm::dvec2 pad = glm::length(pad_) > kStickRests ? pad_ : glm::dvec2(0.0);
    return glm::clamp(positive_ - negative_ + pad, -1.0, 1.0);
}

glm::dvec2 Visitor::lean() const noexcept {
    return limited(device_ + kMostLean * glm::clamp(push() + pointer_.value_or(glm::dvec2(0.0)), -1.0, 1.0));
}

glm::dvec2 Visitor::lively() const noexcept {
    const bool counts = pointer_ && pointerRests_ < kPointerCounts;
    return limited(device_ + kMostLean * glm::clamp(push() + (counts ? *pointer_ : glm::dvec2(0.0)), -1.0, 1.0));
}

glm::dvec2 leanOf(const glm::mat4& worldFromDevice) noexcept {
    const glm::dvec3 down = glm::transpose(glm::dmat3(glm::mat3(worldFromDevice))) * glm::dvec3(0.0, -1.0, 0.0);
    const double deep = std::max(-down.y, 1e-3);
    return limited({std::atan(down.x / deep), std::atan(down.z / deep)});
}

} // namespace lumorph
