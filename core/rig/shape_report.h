#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/geometry/mesh_check.h"
#include "core/rig/rig.h"

namespace lumorph {

/// What a rig can do and whether its mesh is sound in motion, for `lumorph rig info`.
/// The measures follow the shape-resolution vocabulary of Roudaut et al. (area, granularity,
/// curvature, amplitude, zero-crossings, closure, stretch, speed), as far as geometry tells them.
struct ShapeReport {
    MeshReport rest;
    Box reach;
    struct PerActuator {
        std::string name;
        std::string deformer;
        double rangeMin = 0.0; ///< radians, metres or weight
        double rangeMax = 0.0;
        std::string unit; ///< "rad", "m" or ""
        std::size_t vertices = 0;
        double amplitude = 0.0;         ///< metres, see amplitudeOf()
        double sweptArea = 0.0;         ///< square metres of rest surface that it moves
        double maxCurvature = 0.0;      ///< 1/metres at full stroke (0 where rigid)
        double fullStrokeSeconds = 0.0; ///< at its velocity limit
        double torque = 0.0;            ///< newton metres that its servo must hold; 0 where nothing tells it
        std::string servo;              ///< that it has, of the table
    };
    std::vector<PerActuator> actuators;
    double area = 0.0;        ///< square metres of rest surface that any actuator moves
    double granularity = 0.0; ///< actuators a square metre of that
    double maxStretch =
        0.0; ///< largest relative change of an edge of the surface that looks up at rest, over the sampled states
    /// Of a sheet: states of its grid that have another equilibrium, too, how many there are in all, and the metres
    /// between the two shapes.
    struct Seconds {
        std::size_t states = 0;
        std::size_t of = 0;
        double distance = 0.0;
    };
    std::optional<Seconds> seconds;
    double volumeMin = 0.0; ///< cubic metres over the sampled states
    double volumeMax = 0.0;
    int sampledStates = 0;
    int openStates = 0;         ///< sampled states in which the mesh is not closed
    int intersectingStates = 0; ///< ... crosses itself
    int invertedStates = 0;     ///< ... has triangles turned inside out: negative volume or zero area
    bool pathInside = false;
    double pathOutsideShare = 0.0;     ///< volume passed but not held, relative, over sampled states
    std::vector<std::string> warnings; ///< plain sentences (R42)
};

/// Whether a triangle is part of the surface that shows, the top: it looks up at rest, by 45 degrees or more.
[[nodiscard]] bool facesUp(const TriangleMesh& mesh, std::uint32_t triangle);

/// The farthest that a vertex gets from where it rests while this actuator alone goes through its stroke, metres, along
/// a straight line: not the way it goes round a bend. Looked at in 16 states.
[[nodiscard]] double amplitudeOf(const Rig& rig, std::size_t actuator);

/// Samples `states` joint states: full stroke of all, then random ones (seeded). Throws Cancelled.
[[nodiscard]] ShapeReport shapeReport(const Rig& rig, int states, std::uint64_t seed, const Progress& progress = {});

} // namespace lumorph
