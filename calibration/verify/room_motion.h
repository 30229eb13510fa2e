#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "calibration/verify/room_surface.h"
#include "core/rig/rig.h"
#include "core/scene/installation.h"

namespace lumorph {

/// Something of a room that can stand elsewhere than one believes.
struct RoomPart {
    enum class Kind { projector, camera, device, servo };
    Kind kind = Kind::projector;
    std::size_t index = 0;             ///< of projectors and servos
    Eigen::Index first = 0, count = 6; ///< its numbers in a motion
    bool operator==(const RoomPart&) const = default;
};

/// All parts of a room that one camera watches, and the places of their numbers in a motion, which is a vector: for
/// each projector, the camera and the device a turn (radians about x, y, z) and a shift (metres) in its own frame, the
/// device's as it is in its world; for each servo how much farther its actuator stands (strokes).
class RoomParts {
public:
    RoomParts() = default;
    RoomParts(std::size_t projectors, std::size_t servos);

    [[nodiscard]] const std::vector<RoomPart>& all() const noexcept { return parts_; }
    [[nodiscard]] const RoomPart& projector(std::size_t index) const { return parts_[index]; }
    [[nodiscard]] const RoomPart& camera() const { return parts_[projectors_]; }
    [[nodiscard]] const RoomPart& device() const { return parts_[projectors_ + 1]; }
    [[nodiscard]] const RoomPart& servo(std::size_t index) const { return parts_[projectors_ + 2 + index]; }
    [[nodiscard]] std::size_t servos() const noexcept { return parts_.size() - projectors_ - 2; }
    [[nodiscard]] Eigen::Index size() const noexcept { return size_; }

private:
    std::size_t projectors_ = 0;
    Eigen::Index size_ = 0;
    std::vector<RoomPart> parts_;
};
/// Those of an installation and its device. Of a device with very many actuators servos are left out.
[[nodiscard]] RoomParts partsOf(const Installation& room, const Rig& rig);

/// "projector", or with its name among several; "camera", "device", "servo of NAME".
[[nodiscard]] std::string nameOf(const RoomPart& part, const Installation& room, const Rig& rig);

/// A room with a motion, servos apart: they belong to a moment's strokes.
[[nodiscard]] Installation movedBy(Installation room, const RoomParts& parts, const Eigen::VectorXd& motion,
                                   std::size_t camera = 0);
/// Strokes with those of a motion, within [0, 1].
[[nodiscard]] std::vector<double> movedBy(std::span<const double> strokes, const RoomParts& parts,
                                          const Eigen::VectorXd& motion);

/// A camera pixel that saw a projector's pixel, and how sure that is.
struct LitPoint {
    std::size_t projector = 0;
    glm::dvec2 camera{0.0};
    glm::dvec2 panel{0.0};                                     ///< the projector's pixel
    Eigen::Matrix2d information = Eigen::Matrix2d::Identity(); ///< of `panel`, up to a factor for all, 1/pixel^2
};

/// What one such point says of a motion, to first order.
struct LightEquation {
    std::size_t projector = 0;
    SurfacePoint at;           ///< where the camera sees the light, as the room is believed
    Eigen::Vector2d error;     ///< pixels: where the projector would light that place, less what lights it
    Eigen::Matrix2Xd byMotion; ///< by how much a motion changes `error`
    /// How far a motion puts beside what belongs together, along the surface, metres: a projector its light, the camera
    /// what it is taken to see; device and servos move the surface itself.
    Eigen::Matrix3Xd beside;
};

/// The camera and the projectors of a room, ready to write equations.
class LightModel {
public:
    LightModel(const Installation& room, const RoomParts& parts, std::size_t camera = 0);
    /// Nothing where the camera looks past everything, or surface and ray nearly graze.
    [[nodiscard]] std::optional<LightEquation> equation(const RoomSurface& surface, const LitPoint& seen) const;

private:
    struct Optics {
        Eigen::Matrix3d turn; ///< from the world
        Eigen::Vector3d shift, place;
    };
    static Optics opticsOf(const CalibratedCamera& camera);

    RoomParts parts_;
    CalibratedCamera camera_;
    std::vector<CalibratedCamera> projectors_;
    Optics cameraOptics_;
    std::vector<Optics> projectorOptics_;
    Eigen::Matrix3d deviceTurn_;
    Eigen::Vector3d devicePlace_;
};

} // namespace lumorph
