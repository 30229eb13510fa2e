#pragma once

#include <array>
#include <functional>

#include <glm/vec2.hpp>

#include "core/scene/scene.h"
#include "core/scene/scene_assets.h"

namespace lumorph::sea {

/// What a visitor may bring the boat to: a beacon in a ring of light. Once the boat is there it shines, and then comes
/// up elsewhere.
class Harbour {
public:
    static constexpr double kReach = 0.022; ///< of its ring, metres
    static constexpr double kShines = 3.2;  ///< seconds after the boat has come
    static constexpr double kRises = 0.9;   ///< seconds in which it comes up, or goes down
    static constexpr std::array<glm::dvec2, 4> kPlaces{
        {{0.070, -0.040}, {-0.070, 0.036}, {-0.066, -0.040}, {0.068, 0.038}}};

    /// True in the frame in which the boat comes.
    [[nodiscard]] bool advance(double seconds, const glm::dvec2& boat) noexcept;

    [[nodiscard]] const glm::dvec2& place() const noexcept { return kPlaces[number_ % kPlaces.size()]; }
    [[nodiscard]] bool shining() const noexcept { return reached_; }
    [[nodiscard]] double shone() const noexcept; ///< share of the time for which it does; 0 while it does not
    [[nodiscard]] double up() const noexcept;    ///< 0 below the water, 1 in its place
    [[nodiscard]] int visits() const noexcept { return visits_; }

private:
    std::size_t number_ = 0;
    int visits_ = 0;
    bool reached_ = false;
    double age_ = 0.0; ///< seconds since it came up, or since the boat came
};

// Models that are in memory alone.
inline constexpr const char* kBoatModel = "sea boat";
inline constexpr const char* kBeaconModel = "sea beacon";
inline constexpr const char* kLampModel = "sea lamp";
inline constexpr const char* kGlowModel = "sea glow";
inline constexpr double kBeaconHigh = 0.024; ///< of its lamp over the water, metres

void addHarbourModels(SceneAssets& assets);

/// A ring of light on the water, whose height at a place is `height`; radii in metres.
[[nodiscard]] std::shared_ptr<const SceneModel> glowModel(const glm::dvec2& place, double radius, double wide,
                                                          const std::function<double(const glm::dvec2&)>& height);

} // namespace lumorph::sea
