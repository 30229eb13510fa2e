#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "calibration/lab/lab.h"
#include "core/rig/rig.h"
#include "core/scene/installation.h"

namespace lumorph {

/// A place on the device or the table, where a ray met it.
struct SurfacePoint {
    bool isOnDevice = false;    ///< else on the table
    std::uint32_t triangle = 0; ///< of its mesh
    glm::dvec3 point{0.0};      ///< world metres
    glm::dvec3 normal{0.0};     ///< of length 1, towards where the ray came from
};

/// Device and table as an installation has them while the device stands at some strokes: for rays, and for how the
/// surface moves with its actuators. Immutable.
class RoomSurface {
public:
    /// Of rigs with more actuators than that, motions by stroke are not known (`velocities` gives none).
    static constexpr std::size_t kMostServos = 32;

    /// `strokes`: where the actuators really stand, in [0, 1], one each; others throw InvalidInput.
    RoomSurface(const Installation& room, const Rig& rig, std::span<const double> strokes);

    [[nodiscard]] std::optional<SurfacePoint> trace(const glm::dvec3& origin, const glm::dvec3& direction) const;
    /// Whether nothing stands between a place on it and another in the world.
    [[nodiscard]] bool sees(const SurfacePoint& from, const glm::dvec3& place) const;
    /// How the place moves when one actuator's stroke grows, world metres a stroke: one an actuator, zero on the table.
    [[nodiscard]] std::vector<glm::dvec3> velocities(const SurfacePoint& at) const;
    /// The same material place, found on `other`, as it lies on this one: of one rig, standing otherwise.
    [[nodiscard]] SurfacePoint counterpart(const RoomSurface& other, const SurfacePoint& there) const;

private:
    [[nodiscard]] const TriangleMesh& meshOf(const SurfacePoint& at) const { return at.isOnDevice ? device_ : table_; }

    TriangleMesh device_, table_;
    std::vector<std::vector<glm::vec3>> byStroke_; ///< one an actuator: of each vertex, world metres a stroke
    std::shared_ptr<const Lab> lab_;
};

/// Whether it is known that actuators came from below, as for a check, which raises them from rest.
enum class StrokesFrom { below, anywhere };
/// Where actuators stand that were told `commanded`, as an installation has measured its servos; from anywhere: half
/// way between coming from below and from above. Those that were not measured do what they are told.
[[nodiscard]] std::vector<double> standingStrokes(const Installation& room, const Rig& rig,
                                                  std::span<const double> commanded,
                                                  StrokesFrom from = StrokesFrom::below);

} // namespace lumorph
