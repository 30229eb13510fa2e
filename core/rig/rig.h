#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include "core/base/units.h"
#include "core/geometry/triangle_mesh.h"
#include "core/rig/deformer.h"
#include "core/rig/pulse_curve.h"
#include "core/rig/sheet_modes.h"

namespace lumorph {

/// How much of an actuator's motion a vertex follows: its deformer is applied with stroke x weight.
struct Influence {
    std::uint32_t vertex = 0;
    float weight = 1.0F;
    bool operator==(const Influence&) const = default;
};

/// The servo or motor behind an actuator, as far as a controller needs to know it.
struct ActuatorDrive {
    int channel = -1;
    double pulseMin = 1000.0; ///< microseconds at rest
    double pulseMax = 2000.0; ///< microseconds at full stroke
    std::string servo{};      ///< its kind, by the name in the table of `servo_types`; empty: not said
    PulseCurve curve{};       ///< how the pulse goes from rest to full stroke
    bool operator==(const ActuatorDrive&) const = default;
};

/// One degree of freedom. Its stroke is a number in [0, 1]: 0 is rest, 1 the end of its range.
struct Actuator {
    std::string name;
    Deformer deformer;
    std::vector<Influence> influences; ///< ascending by vertex; unused by SkinJoint and SheetLift
    int levels = 33;                   ///< suggested level count m
    double maxVelocity = 1.0;          ///< strokes a second
    double dampingRatio = 1.0;         ///< 1 is critical
    ActuatorDrive drive;
    bool operator==(const Actuator&) const = default;
};

/// Joints of a skinned model, for SkinJoint actuators. A parent stands before its children. The rest
/// mesh is the bind pose: with every joint at `localRest` each vertex is where the mesh says.
struct Skeleton {
    struct Joint {
        int parent = -1;
        /// `parentFromJoint` at rest (`deviceFromJoint` without a parent); a rotation, a translation
        /// and a uniform scale.
        glm::mat4 localRest{1.0F};
        bool operator==(const Joint&) const = default;
    };
    std::vector<Joint> joints;
    std::vector<glm::u16vec4> vertexJoints; ///< one a vertex of the rest mesh
    std::vector<glm::vec4> vertexWeights;   ///< normalised
    bool operator==(const Skeleton&) const = default;
};

/// The parts a rig is made of.
struct RigParts {
    std::string name;
    TriangleMesh restMesh; ///< closed solid at stroke 0, device coordinates, metres
    std::vector<Actuator> actuators;
    std::optional<Skeleton> skeleton;
    /// For SheetLift actuators. Its vertices follow no other actuator, and a rig has a skeleton or a sheet, not both.
    std::optional<SheetMotion> sheet;
    /// True when the solid at a state holds all it passed on the way from rest (its skirt follows
    /// the path), so that the covered volume needs no sweep. `shapeReport` measures it.
    bool pathInside = false;
    /// What the rig was drawn as, so that the drawing can be taken up again: a text that only `parseSheetDevice`
    /// reads. Empty for a rig that was not drawn. Later edits of the rig leave it as it was.
    std::string drawing;
    bool operator==(const RigParts&) const = default;
};

/// Whether both are the same solid in every joint state, so that a field of the one is a field of the other: names,
/// suggested levels, velocity limits, damping, drives, angles of levers and drawing may differ, because V(s) depends on
/// none of them.
[[nodiscard]] bool deformAlike(const RigParts& a, const RigParts& b);

class DeformProgram;

/// A shape-changing device: a closed mesh and the actuators that deform it (R4).
///
/// The rest mesh is the shape at the lower end of every range; a stroke x weight of 1 has moved a
/// vertex by max - min. Deformation order: morph targets (added to the rest positions), then the skin,
/// then hinges, bends and slides in the actuators' order, each acting on what came before as a map of
/// space. Vertices of a sheet follow its levers alone. Immutable; safe to share between threads. Copies share their
/// data.
class Rig {
    struct Compiled;

public:
    /// Throws InvalidInput when the parts do not fit together (indices, weights, axes, ranges).
    explicit Rig(RigParts parts);

    [[nodiscard]] const RigParts& parts() const noexcept;
    [[nodiscard]] const std::string& name() const noexcept { return parts().name; }
    [[nodiscard]] const TriangleMesh& restMesh() const noexcept { return parts().restMesh; }
    [[nodiscard]] std::span<const Actuator> actuators() const noexcept { return parts().actuators; }
    [[nodiscard]] std::size_t actuatorCount() const noexcept { return parts().actuators.size(); }
    [[nodiscard]] const std::optional<Skeleton>& skeleton() const noexcept { return parts().skeleton; }
    [[nodiscard]] bool pathInside() const noexcept { return parts().pathInside; }

    /// The actuators that can move this vertex, ascending. Of a sheet's levers those that move it by more than
    /// kSheetStill in some state of the grid; others are left out of its motion, so that the list is exact.
    [[nodiscard]] std::span<const std::uint16_t> actuatorsOf(std::uint32_t vertex) const noexcept;
    /// The vertices that this actuator can move, ascending.
    [[nodiscard]] std::span<const std::uint32_t> verticesOf(std::size_t actuator) const noexcept;

    /// Positions of all vertices. `strokes` has one entry in [0, 1] an actuator, `out` one a vertex.
    void deform(std::span<const double> strokes, std::span<glm::vec3> out) const noexcept;
    /// Positions of the listed vertices only: out[k] is that of vertices[k]. Costs in proportion to
    /// their number; for a list used again and again a Subset is several times as fast.
    void deform(std::span<const double> strokes, std::span<const std::uint32_t> vertices,
                std::span<glm::vec3> out) const noexcept;

    /// A list of vertices, compiled once to be deformed many times: bit for bit what `Rig::deform`
    /// gives. Shares the rig's data; immutable, safe to share between threads.
    class Subset {
    public:
        [[nodiscard]] std::size_t size() const noexcept;
        /// out[k] is the position of the k-th listed vertex.
        void deform(std::span<const double> strokes, std::span<glm::vec3> out) const noexcept;

    private:
        friend class Rig;
        explicit Subset(std::shared_ptr<const DeformProgram> program) : program_(std::move(program)) {}
        std::shared_ptr<const DeformProgram> program_;
    };
    /// Throws InvalidInput when a vertex is out of range.
    [[nodiscard]] Subset subset(std::span<const std::uint32_t> vertices) const;

    /// A box that holds this vertex in every joint state (conservative: never too small).
    [[nodiscard]] const Box& reachOf(std::uint32_t vertex) const noexcept { return reaches()[vertex]; }
    /// The same for all vertices.
    [[nodiscard]] std::span<const Box> reaches() const noexcept;
    /// The box of the whole rig over all joint states (R7).
    [[nodiscard]] const Box& reach() const noexcept;

private:
    std::shared_ptr<const Compiled> compiled_;
};

/// The mesh at the given strokes.
[[nodiscard]] TriangleMesh deformed(const Rig& rig, std::span<const double> strokes);

/// Strokes of a joint state with `levels` levels an actuator. Throws InvalidInput when the state has
/// the wrong size or a level is out of range.
[[nodiscard]] std::vector<double> strokesOf(const Rig& rig, const State& state, int levels);

} // namespace lumorph
