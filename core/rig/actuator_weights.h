#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <glm/vec3.hpp>

#include "core/base/progress.h"
#include "core/rig/rig.h"

namespace lumorph {

/// How much of an actuator's motion each vertex of the rest mesh follows, 0 to 1, one a vertex. Of a joint of the skin:
/// the vertex's own share of that joint, without those of joints that hang on it. Of a lever of the sheet: how far it
/// moves the vertex, as a share of the farthest.
[[nodiscard]] std::vector<float> actuatorWeights(const RigParts& parts, std::size_t actuator);

/// Whether a vertex can follow the actuator at all, one a vertex: a morph target moves only what its shape moves, a
/// lever of the sheet is led by mechanics alone and takes none, all else moves any vertex that follows no sheet.
[[nodiscard]] std::vector<bool> canFollow(const RigParts& parts, std::size_t actuator);

/// Sets them, in whole thousandths: what follows alike is deformed together. A vertex that cannot follow stays as it
/// is. Shares of other joints make room for a joint's in proportion, or take what it leaves; where it was the only one,
/// its parent takes that, and a joint without parent keeps all. Throws InvalidInput when there is not one weight a
/// vertex, or one is not within 0 and 1, and for levers of the sheet.
void setActuatorWeights(RigParts& parts, std::size_t actuator, std::span<const float> weights);

/// How an influence ends with the distance from where it begins, metres.
struct WeightFalloff {
    double full = 0.02;  ///< up to there all follows
    double range = 0.02; ///< from there to nothing, smoothly
};
/// 1 up to `full`, then 1 - 3 t² + 2 t³ over `range`. Throws InvalidInput for lengths that are negative or not finite.
[[nodiscard]] std::vector<float> weightsByDistance(std::span<const float> metres, const WeightFalloff& falloff);

/// What is at most so thick, metres, is a sheet: its two sides go together, those of a thicker body do not.
inline constexpr double kSheetThickness = 0.006;

/// Weights of all vertices by the distance along the surface from a place of it, of a sheet on both its sides. Throws
/// as `surfaceDistances` and `weightsByDistance` do.
[[nodiscard]] std::vector<float> weightsAround(const TriangleMesh& mesh, const glm::vec3& place,
                                               const WeightFalloff& falloff, const Progress& progress = {});
/// The same from a bend line or axis, from one end to the other, to one of its sides: nothing on the other one follows.
[[nodiscard]] std::vector<float> weightsBeside(const TriangleMesh& mesh, const std::array<glm::vec3, 2>& ends,
                                               const glm::vec3& side, const WeightFalloff& falloff,
                                               const Progress& progress = {});

/// What a brush does to weights within its radius.
struct WeightBrush {
    enum class Tool { paint, erase, smooth } tool = Tool::paint;
    double radius = 0.01;  ///< metres, straight through the solid: both sides of a sheet go together, but what looks
                           ///< away from the brush deeper than a sheet's thickness is left alone
    double strength = 0.3; ///< of a dab in its middle, 0 to 1
};

/// One stroke of a brush: dabs along a way over the rest mesh.
class WeightStroke {
public:
    /// `parts` is copied from, not kept.
    WeightStroke(const RigParts& parts, std::size_t actuator);

    /// From the last place to this one (rest mesh, metres) by dabs a quarter of the radius apart; the first one dabs
    /// where it is. `normal` is the surface's there, of length 1.
    void moveTo(const glm::vec3& place, const glm::vec3& normal, const WeightBrush& brush);
    [[nodiscard]] const std::vector<float>& weights() const noexcept { return weights_; }

private:
    void dab(const glm::vec3& place, const glm::vec3& normal, const WeightBrush& brush);
    void findNeighbours();
    [[nodiscard]] float meanAround(std::uint32_t vertex) const;

    TriangleMesh mesh_;
    std::vector<glm::vec3> normals_; ///< of the vertices, not of length 1
    std::vector<float> weights_;
    std::vector<bool> follows_;
    std::vector<std::uint32_t> places_; ///< one a vertex: equal where positions are; empty until something is smoothed
    std::vector<std::uint32_t> start_, neighbours_; ///< vertices around each place
    std::vector<std::pair<std::uint32_t, float>> changed_;
    bool begun_ = false;
    glm::vec3 last_{0.0F};
};

} // namespace lumorph
