#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/rig/sheet/sheet_mesh.h"

namespace lumorph {

/// A shape of the sheet. The director of an edge is the unit normal of the surface at its middle; it is perpendicular
/// to the edge.
struct SheetState {
    std::vector<glm::dvec3> positions; ///< one a node, metres
    std::vector<glm::dvec3> directors; ///< one an edge
};

[[nodiscard]] SheetState flatState(const SheetMesh& mesh);
/// The mirror image of a state.
[[nodiscard]] SheetState mirrored(const SheetMesh& mesh, const MeshMirror& mirror, const SheetState& state);

/// What holds and loads the sheet.
struct SheetSupports {
    enum Axis : std::uint8_t { x = 1, y = 2, z = 4, all = 7 };
    std::vector<std::uint8_t> heldAxes;      ///< one a node: a union of Axis
    std::vector<std::uint8_t> heldDirectors; ///< one an edge: not 0 where it is clamped
    std::vector<glm::dvec3> loads;           ///< one a node: forces that keep their direction, newtons
    /// Height of what the sheet lies on, metres: springs of kGroundStiffness push up what sinks below.
    double ground = -std::numeric_limits<double>::infinity();
};

inline constexpr double kGroundStiffness = 2e4; ///< of a node, newtons a metre: some tips of a sheet sink by 0.1 mm

/// Nothing held, no loads, no ground.
[[nodiscard]] SheetSupports noSupports(const SheetMesh& mesh);

struct SheetGradient {
    std::vector<glm::dvec3> forces; ///< energy by position, newtons
    std::vector<double> moments;    ///< energy by right-handed rotation of a director about its edge, newton metres
};

struct SheetEquilibrium {
    SheetState state;
    double energy = 0.0;               ///< elastic, joules
    std::vector<glm::dvec3> reactions; ///< one a node: the force with which its support holds it, newtons
    int iterations = 0;
    bool converged = false; ///< the last step moved no node by more than 1 um
    bool stable = false;    ///< the Hessian is positive definite: a local minimum
};

/// The principal strain of largest size, in the middle surface and on the faces of the thickest bonded layer.
struct SheetStrain {
    double middle = 0.0; ///< share; positive where stretched
    double face = 0.0;
    std::uint32_t middleTriangle = 0;
    std::uint32_t faceTriangle = 0;
};

/// Static equilibrium of an elastic thin shell that is flat at rest.
///
/// Membrane: St. Venant-Kirchhoff on constant strain triangles. Green strain is measured by squared lengths of edges,
/// to which the arc of a curved edge adds a twelfth of the square of its total turn times its length; without that a
/// mesh of chords locks. Bending: the mid-edge-normal shape operator with one director an edge (Grinspun, Gingold,
/// Reisman and Zorin 2006, "Computing discrete shape operators on general meshes"), which for small deflections is the
/// Morley plate element. Newton's method takes the stress in the geometric stiffness from the last linear step instead
/// of from the positions (Magisano, Leonetti and Garcea 2017, "How to improve efficiency and robustness of the Newton
/// method in geometrically non-linear structural problem discretized via displacement-based finite elements"):
/// positions that rotate by a straight step seem stretched, which makes plain Newton crawl. Where that Hessian is
/// indefinite, it is shifted along its diagonal. A solver belongs to one thread at a time.
class SheetSolver {
public:
    /// Throws InvalidInput when the layers fail `checkLayers`, sizes disagree or a triangle has no area.
    SheetSolver(const SheetMesh& mesh, std::span<const SheetLayer> layers, SheetSupports supports);
    ~SheetSolver();
    SheetSolver(SheetSolver&&) noexcept;
    SheetSolver& operator=(SheetSolver&&) noexcept;

    /// Elastic energy, joules.
    [[nodiscard]] double energy(const SheetState& state) const;
    [[nodiscard]] SheetGradient gradient(const SheetState& state) const;
    [[nodiscard]] SheetStrain strain(const SheetState& state) const;

    /// The equilibrium that Newton's method reaches from `start` when held coordinates take their values in `held` (one
    /// a node; free coordinates are ignored). The first step moves held nodes and lets the rest follow by the tangent,
    /// so that a small change of `held` is one step of a quasi-static continuation. Throws InvalidInput when the
    /// supports leave a rigid motion.
    [[nodiscard]] SheetEquilibrium solve(const SheetState& start, std::span<const glm::dvec3> held,
                                         int mostIterations = 40);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace lumorph
