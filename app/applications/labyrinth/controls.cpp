#include "app/applications/labyrinth/controls.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "app/applications/labyrinth/game.h"

namespace lumorph::labyrinth {
namespace {

constexpr double kHandRests = 0.03; ///< radians: a device that lies or is held level
constexpr double kStickRests = 0.08;

double stick(double value) { return std::isfinite(value) ? std::clamp(value, -1.0, 1.0) : 0.0; }

} // namespace

void Controls::take(const ShowMoment& moment) {
    active_ = restart_ = next_ = false;
    for (const ShowInput& input : moment.inputs) take(input);
    follow(moment);
    active_ = active_ || glm::length(device_) > kHandRests || glm::length(pad_) > kStickRests ||
              glm::length(positive_ - negative_) > 0.0;
}

void Controls::take(const ShowInput& input) {
    const double held = input.value > 0.5 ? 1.0 : 0.0;
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
        pointer_.x = stick(input.value);
    else if (input.name == "pointer.y")
        pointer_.y = stick(input.value);
    else if (input.name == "pad.x")
        pad_.x = stick(input.value);
    else if (input.name == "pad.y")
        pad_.y = stick(input.value);
    else if (input.name == "key.restart")
        restart_ = restart_ || held > 0.0;
    else if (input.name == "key.next")
        next_ = next_ || held > 0.0;
}

void Controls::follow(const ShowMoment& moment) {
    device_ = {};
    for (const ShowBody& body : moment.bodies)
        if (body.role == PoseRole::device) device_ = leanOf(moment.worldFromDevice);
}

glm::dvec2 Controls::lean() const noexcept {
    const glm::dvec2 resting = glm::length(pad_) > kStickRests ? pad_ : glm::dvec2(0.0);
    const glm::dvec2 share = glm::clamp(positive_ - negative_ + pointer_ + resting, -1.0, 1.0);
    const glm::dvec2 lean = device_ + Game::kMostLean * share;
    const double length = glm::length(lean);
    return length > Game::kMostLean ? lean * (Game::kMostLean / length) : lean;
}

glm::dvec2 leanOf(const glm::mat4& worldFromDevice) noexcept {
    const glm::dvec3 down = glm::transpose(glm::dmat3(glm::mat3(worldFromDevice))) * glm::dvec3(0.0, -1.0, 0.0);
    const double deep = std::max(-down.y, 1e-3);
    const glm::dvec2 lean(std::atan(down.x / deep), std::atan(down.z / deep));
    const double length = glm::length(lean);
    return length > Game::kMostLean ? lean * (Game::kMostLean / length) : lean;
}

} // namespace lumorph::labyrinth
