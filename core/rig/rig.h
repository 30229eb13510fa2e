#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>

#include "core/base/units.h"
#include "core/geometry/triangle_mesh.h"
#include "core/rig/deformer.h"

namespace lumorph {

/// How much of an actuator's motion a vertex follows: its deformer is applied with stroke x weight.
struct Influence {
    std::uint32_t vertex = 0;
    float weight = 1.0F;
};

/// The servo or motor behind an actuator, as far as a controller needs to know it.
struct ActuatorDrive {
    int channel = -1;
    double pulseMin = 1000.0; ///< microseconds at rest
    double pulseMax = 2000.0; ///< microseconds at full stroke
};

/// One degree of freedom. Its stroke is a number in [0, 1]: 0 is rest, 1 the end of its range.
struct Actuator {
    std::string name;
    Deformer deformer;
    std::vector<Influence> influences; ///< ascending by vertex; unused by SkinJoint
    int levels = 33;                   ///< suggested level count m
    double maxVelocity = 1.0;          ///< strokes a second
    double dampingRatio = 1.0;         ///< 1 is critical
    ActuatorDrive drive;
};

/// Joints of a skinned model, for SkinJoint actuators. A parent stands before its children.
struct Skeleton {
    struct Joint {
        int parent = -1;
        glm::mat4 localRest{1.0F};
        glm::mat4 inverseBind{1.0F};
    };
    std::vector<Joint> joints;
    std::vector<glm::u16vec4> vertexJoints; ///< one a vertex of the rest mesh
    std::vector<glm::vec4> vertexWeights;   ///< normalised
};

/// The parts a rig is made of.
struct RigParts {
    std::string name;
    TriangleMesh restMesh; ///< closed solid at stroke 0, device coordinates, metres
    std::vector<Actuator> actuators;
    std::optional<Skeleton> skeleton;
    /// True when the solid at a state holds all it passed on the way from rest (its skirt follows
    /// the path), so that the covered volume needs no sweep. Checked by `checkPathInside`.
    bool pathInside = false;
};

/// A shape-changing device: a closed mesh and the actuators that deform it (R4).
///
/// Deformation order: morph targets (added to the rest positions), then the skin, then hinges, bends
/// and slides in the actuators' order, each acting on what came before as a map of space.
/// Immutable; safe to share between threads. Copies share their data.
class Rig {
public:
    /// Throws InvalidInput when the parts do not fit together (indices, weights, axes, ranges).
    explicit Rig(RigParts parts);

    [[nodiscard]] const std::string& name() const noexcept { return data_->parts.name; }
    [[nodiscard]] const TriangleMesh& restMesh() const noexcept { return data_->parts.restMesh; }
    [[nodiscard]] std::span<const Actuator> actuators() const noexcept { return data_->parts.actuators; }
    [[nodiscard]] std::size_t actuatorCount() const noexcept { return data_->parts.actuators.size(); }
    [[nodiscard]] const std::optional<Skeleton>& skeleton() const noexcept { return data_->parts.skeleton; }
    [[nodiscard]] bool pathInside() const noexcept { return data_->parts.pathInside; }

    /// The actuators that can move this vertex, ascending.
    [[nodiscard]] std::span<const std::uint16_t> actuatorsOf(std::uint32_t vertex) const noexcept;

    /// Positions of all vertices. `strokes` has one entry an actuator, `out` one a vertex.
    void deform(std::span<const double> strokes, std::span<glm::vec3> out) const noexcept;
    /// Positions of the listed vertices only: out[k] is that of vertices[k].
    void deform(std::span<const double> strokes, std::span<const std::uint32_t> vertices,
                std::span<glm::vec3> out) const noexcept;

    /// A box that holds this vertex in every joint state (conservative: never too small).
    [[nodiscard]] const Box& reachOf(std::uint32_t vertex) const noexcept { return data_->reach[vertex]; }
    /// The box of the whole rig over all joint states (R7).
    [[nodiscard]] const Box& reach() const noexcept { return data_->totalReach; }

    struct Data; ///< the compiled form; see rig.cpp

private:
    struct Base {
        RigParts parts;
        std::vector<Box> reach;
        Box totalReach;
        std::vector<std::uint32_t> dependencyStart; ///< vertices + 1
        std::vector<std::uint16_t> dependencies;
    };
    std::shared_ptr<const Base> data_;
};

/// The mesh at the given strokes.
[[nodiscard]] TriangleMesh deformed(const Rig& rig, std::span<const double> strokes);

/// Strokes of a joint state with `levels` levels an actuator. Throws InvalidInput when the state has
/// the wrong size or a level is out of range.
[[nodiscard]] std::vector<double> strokesOf(const Rig& rig, const State& state, int levels);

} // namespace lumorph
