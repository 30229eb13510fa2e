#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/rig/sheet/sheet_solver.h"

namespace lumorph {

/// What a lever does in an equilibrium.
struct LeverLoad {
    double force = 0.0;  ///< with which it lifts its line, newtons; negative where it holds it down
    double torque = 0.0; ///< at its servo's shaft, newton metres
};

/// A stable equilibrium of the sheet with all levers at some strokes.
struct SheetPose {
    std::vector<double> strokes;
    SheetState state;
    double energy = 0.0; ///< joules
    std::vector<LeverLoad> loads;
    SheetStrain strain;
    int iterations = 0; ///< of Newton's method, over all steps from the pose it started from
};

/// A sheet, its mesh and its levers: equilibria by stroke. Belongs to one thread at a time.
class LeveredSheet {
public:
    /// Throws InvalidInput as `checkSheet` and `SheetSolver` do. The mesh is `meshSheet`'s.
    LeveredSheet(const ElasticSheet& sheet, const SheetMesh& mesh);

    [[nodiscard]] const SheetMesh& mesh() const noexcept { return mesh_; }
    /// Flat, all strokes 0.
    [[nodiscard]] SheetPose rest() const;
    /// The equilibrium at these strokes that is reached from a pose by quasi-static continuation along the straight way
    /// between the strokes: in one step of Newton's method, or in halves where that does not converge. Where the way
    /// ends at a limit point or a saddle, the sheet snaps to a minimum that Newton's shifted steps lead to. Throws
    /// InvalidInput when the strokes are not one a lever in [0, 1], when levers pull against each other (the middle
    /// surface would stretch by more than 30 %), and when no equilibrium is found.
    [[nodiscard]] SheetPose moved(const SheetPose& from, std::span<const double> strokes);
    /// The same, from a guess of the shape that is near the equilibrium already. Empty where Newton's method leaves it.
    [[nodiscard]] std::optional<SheetPose> polished(const SheetState& guess, std::span<const double> strokes);
    /// The equilibrium at these strokes, followed from rest along t x strokes in equal steps of t.
    [[nodiscard]] SheetPose followed(std::span<const double> strokes, int steps = 4);

private:
    [[nodiscard]] std::optional<SheetPose> solved(const SheetState& start, std::span<const double> strokes);
    [[nodiscard]] std::vector<glm::dvec3> heldAt(std::span<const double> strokes) const;
    [[nodiscard]] std::optional<SheetPose> continued(const SheetPose& from, std::span<const double> strokes,
                                                     int halvings);
    void checkStrokes(std::span<const double> strokes) const;
    /// "'a' at 50 %, 'b' at 100 %".
    [[nodiscard]] std::string namesAndStrokes(std::span<const double> strokes) const;
    [[nodiscard]] std::string strongestLevers(const SheetPose& pose) const;

    std::vector<SheetLever> levers_;
    SheetMesh mesh_;
    SheetSolver solver_;
};

} // namespace lumorph
