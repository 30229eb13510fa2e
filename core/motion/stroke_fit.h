#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "core/motion/surface_heights.h"
#include "core/rig/rig.h"

namespace lumorph {

/// The rig's uppermost surface as a height field over fixed points (x and z), at any strokes.
class TopSurface {
public:
    /// Points over which the rig at rest has no surface are left out.
    TopSurface(const Rig& rig, std::span<const glm::vec2> points);

    [[nodiscard]] const Rig& rig() const noexcept { return rig_; }
    [[nodiscard]] const std::vector<glm::vec2>& points() const noexcept { return points_; }
    [[nodiscard]] const std::vector<float>& restHeights() const noexcept { return rest_; }
    /// Where the surface has drawn back from a point: the height of the device's bottom.
    [[nodiscard]] float floor() const noexcept { return floor_; }
    /// The true surface: the rig deformed, seen from above.
    void heights(std::span<const double> strokes, std::span<float> out) const;

private:
    Rig rig_;
    float floor_ = 0.0F;
    std::vector<glm::vec2> points_;
    std::vector<float> rest_;
};

/// Least-squares fit of heights by strokes in [0, 1]. What an actuator alone does to the surface is sampled at many
/// strokes, since a flap that turns by 90 degrees is far from linear; changes by several actuators at one point add up,
/// which is exact for flaps side by side and for lifts along y. Each actuator in turn takes its best stroke of all,
/// until no one finds a better one.
class StrokeFit {
public:
    explicit StrokeFit(const TopSurface& surface);

    /// Improves `strokes`, from where they stand, towards wished heights over rest at the surface's points.
    void improve(std::span<const double> lifts, std::span<double> strokes) const;
    /// What the fit takes for the heights over rest at these strokes.
    void lifts(std::span<const double> strokes, std::span<double> out) const;

private:
    static constexpr int kSteps = 32;

    /// What one actuator does: curve[k * points.size() + p] is the lift of its p-th point at stroke k / kSteps.
    struct Response {
        std::vector<std::uint32_t> points;
        std::vector<double> curve;
    };
    static Response responseOf(const TopSurface& surface, std::size_t actuator);
    static void addLift(const Response& response, double stroke, double factor, std::span<double> lifts);
    static double best(const Response& response, std::span<const double> wanted);

    std::vector<Response> responses_;
};

} // namespace lumorph
