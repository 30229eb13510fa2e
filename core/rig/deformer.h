#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/base/units.h"

namespace lumorph {

/// Turns its part rigidly about a line, right-handed about `axis`. Lengths of axes do not matter.
struct Hinge {
    glm::vec3 origin{0.0F}; ///< a point of the axis, device coordinates, metres
    glm::vec3 axis{1.0F, 0.0F, 0.0F};
    Angle min;
    Angle max;
    bool operator==(const Hinge&) const = default;
};

/// Bends like a flexible sheet: straight up to the bend line, an arc of `length` metres, straight
/// again. Distances along the neutral surface and across it are kept (a developable bend).
/// `direction` is the way from the bend line to the free end and is perpendicular to `axis`; the
/// rotation is right-handed about `axis`. The neutral surface passes through `origin`. The rest mesh
/// is the flat sheet, so `min` is 0; a sheet that bends to the other side has its axis turned round.
struct Bend {
    glm::vec3 origin{0.0F};
    glm::vec3 axis{1.0F, 0.0F, 0.0F};
    glm::vec3 direction{0.0F, 0.0F, 1.0F};
    double length = 0.01; ///< metres of arc
    Angle min;
    Angle max;
    bool operator==(const Bend&) const = default;
};

/// Moves its part along a line.
struct Slide {
    glm::vec3 direction{0.0F, 1.0F, 0.0F};
    double min = 0.0; ///< metres
    double max = 0.0;
    bool operator==(const Slide&) const = default;
};

/// Moves each vertex along a polyline of its own: a morph target (one key at stroke 1) or one mesh
/// per deformation state (a key for each). Displacements are from the rest mesh and linear between
/// the keys; strokes before the first key run linearly from rest.
struct MorphTarget {
    std::string target;      ///< its name in the file
    std::vector<float> keys; ///< strokes in (0, 1], ascending
    /// displacements[k][i] belongs to keys[k] and the i-th influence of the actuator, metres.
    std::vector<std::vector<glm::vec3>> displacements;
    bool operator==(const MorphTarget&) const = default;
};

/// Turns or moves one joint of the model's skin; the vertices follow by linear blend skinning.
struct SkinJoint {
    int joint = -1; ///< index into Skeleton::joints
    enum class Motion { rotate, translate } motion = Motion::rotate;
    glm::vec3 axis{1.0F, 0.0F, 0.0F}; ///< in the joint's local frame
    double min = 0.0;                 ///< radians or metres
    double max = 0.0;
    bool operator==(const SkinJoint&) const = default;
};

/// Lifts the rig's sheet by one of the levers under it. What follows, and how, is `SheetMotion`'s; the actuator has no
/// influences of its own.
struct SheetLift {
    int axis = -1;       ///< of the sheet's grid, index into SheetModes::strokes
    Angle min;           ///< of the lever at stroke 0; describes it, moves nothing
    Angle max;           ///< at stroke 1
    double torque = 0.0; ///< the largest that its servo holds in a state of the grid, newton metres; 0: not known
    bool operator==(const SheetLift&) const = default;
};

using Deformer = std::variant<Hinge, Bend, Slide, MorphTarget, SkinJoint, SheetLift>;

} // namespace lumorph
