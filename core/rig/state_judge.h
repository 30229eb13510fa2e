#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "core/rig/rig_check.h"

namespace lumorph {

/// Whether two boxes share a point.
[[nodiscard]] bool meet(const Box& a, const Box& b);

/// Something wrong in one joint state that is not wrong at rest.
struct StateFault {
    RigFinding::Kind kind = RigFinding::Kind::open;
    std::vector<std::size_t> actuators; ///< ascending; of those that have moved, the ones that can have to do with it
    double amount = 0.0;
    glm::vec3 place{0.0F};
};

/// What is known of a rig's mesh at rest, for judging it in other states. Immutable.
class RestShape {
public:
    RestShape(const Rig& rig, const RigCheckOptions& options);

    [[nodiscard]] const Rig& rig() const noexcept { return rig_; }
    /// What is wrong at rest already, as faults of no actuator.
    [[nodiscard]] std::vector<StateFault> faults() const;

private:
    friend class StateJudge;
    struct Edge {
        std::uint32_t from, to;
        double length;
    };
    struct Piece {
        bool closed = false;
        double volume = 0.0;
    };

    void findEdges();
    void findSeams();
    /// Whether two triangles cross at rest, or belong to pieces that do, which then overlap in all states.
    [[nodiscard]] bool crossesAtRest(const std::pair<std::uint32_t, std::uint32_t>& triangles) const;

    Rig rig_;
    RigCheckOptions options_;
    std::vector<Edge> shown_;                                    ///< edges of the surface that looks up at rest
    std::vector<std::pair<std::uint32_t, std::uint32_t>> seams_; ///< vertices at one place that hold the mesh closed
    std::vector<std::pair<std::uint32_t, std::uint32_t>> holes_; ///< edges with one triangle
    std::vector<Piece> pieces_;
    std::vector<std::uint32_t> pieceOf_; ///< one a triangle; none for those that belong to no piece
    std::vector<std::size_t> inward_;    ///< pieces that look inwards at rest
    std::vector<bool> flat_;             ///< triangles
    std::set<std::pair<std::uint32_t, std::uint32_t>> crossing_;    ///< pairs of triangles, the lower number first
    std::set<std::pair<std::uint32_t, std::uint32_t>> overlapping_; ///< pairs of pieces
    Box crossingBox_;
};

/// Judges joint states in which only some actuators move. Not to be shared between threads; copies are.
class StateJudge {
public:
    StateJudge(const RestShape& rest, std::span<const std::size_t> actuators);

    /// One fault of a kind for each set of actuators. All strokes but those of the judge's actuators are zero.
    [[nodiscard]] std::vector<StateFault> faultsAt(std::span<const double> strokes);
    /// The fastest point while this actuator alone moves at its velocity limit; with the amount in metres a second,
    /// whether that is too fast or not.
    [[nodiscard]] StateFault fastestAt(std::span<const double> strokes, std::size_t actuator);

private:
    void move(std::span<const double> strokes);
    [[nodiscard]] std::vector<std::size_t> moving(std::span<const std::uint32_t> vertices,
                                                  std::span<const double> strokes) const;
    [[nodiscard]] std::vector<std::size_t> movingTriangle(std::uint32_t triangle,
                                                          std::span<const double> strokes) const;
    class Gathered;
    void findOpen(std::span<const double> strokes, Gathered& out) const;
    void findInverted(std::span<const double> strokes, Gathered& out) const;
    void findStretched(std::span<const double> strokes, Gathered& out) const;
    void findCrossing(std::span<const double> strokes, Gathered& out) const;

    const RestShape* rest_;
    std::vector<std::uint32_t> vertices_;
    Rig::Subset subset_;
    std::vector<glm::vec3> moved_;         ///< one a listed vertex
    TriangleMesh mesh_;                    ///< as it stands now
    std::vector<std::uint32_t> triangles_; ///< with a vertex that moves
    std::vector<std::uint32_t> near_;      ///< others that those can reach
    std::vector<std::size_t> edges_;       ///< of RestShape::shown_
    std::vector<std::size_t> seams_;
};

} // namespace lumorph
