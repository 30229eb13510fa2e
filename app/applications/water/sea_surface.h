#pragma once

#include <memory>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "app/applications/slosh.h"
#include "app/applications/water/ripples.h"
#include "core/scene/scene.h"
#include "core/scene/scene_assets.h"
#include "core/voxels/height_grid.h"

namespace lumorph::sea {

/// Where something lies in the water, for the foam along it: a rectangle with round corners, metres.
struct Waterline {
    glm::dvec2 place{0.0}, half{0.0};
    double radius = 0.0;
    double turn = 0.0; ///< from x to z, radians
};

/// The water over the tablet at one moment: its height from waves, lean and rings, the foam on it, and what is drawn of
/// it: the surface, the cut sides, and the foam as a veil.
class SeaSurface {
public:
    static constexpr int kColumns = 113, kRows = 81; ///< of the grid
    static constexpr double kLevel = 0.038;          ///< of still water, device metres
    static constexpr double kFloor = 0.002;          ///< to which its sides lead down

    SeaSurface();

    /// Waves of a sea that is as high as it is `storm`, at a time in seconds.
    void setHeights(std::span<const Wave> waves, double storm, double seconds, const Slosh& slosh,
                    const Ripples& ripples);
    /// Foam comes up at steep crests and along `lines`, and dissolves.
    void advanceFoam(double seconds, std::span<const Waterline> lines);
    /// White water, as where something fell in.
    void splash(const glm::dvec2& place, double radius);

    /// Over still water, metres; of the nearest place on it.
    [[nodiscard]] double heightAt(const glm::dvec2& place) const noexcept;
    /// Along x and z, over a distance that things afloat have.
    [[nodiscard]] glm::dvec2 slopeAt(const glm::dvec2& place) const noexcept;
    [[nodiscard]] double foamAt(const glm::dvec2& place) const noexcept; ///< 0 to 1
    /// Device metres.
    [[nodiscard]] HeightGrid heights() const;
    /// Its materials are `seaMaterials`.
    [[nodiscard]] std::shared_ptr<const SceneModel> model() const;

private:
    [[nodiscard]] double sampleAt(const std::vector<float>& values, const glm::dvec2& place) const noexcept;
    void addWaves(std::span<const Wave> waves, double storm, double seconds);
    void findSlopes();
    void addFoamAlong(const Waterline& line);
    [[nodiscard]] Model::Primitive top() const;
    [[nodiscard]] Model::Primitive sides() const;
    [[nodiscard]] Model::Primitive foam() const;

    std::vector<float> heights_;    ///< metres over still water
    std::vector<glm::vec2> slopes_; ///< along x and z
    std::vector<float> white_;      ///< foam that dissolves, 0 to 1
    std::vector<float> foam_;       ///< with that along waterlines and rim
    std::vector<float> rim_, lace_; ///< of the rim; the pattern's first coordinate
    std::vector<glm::uvec3> topTriangles_, sideTriangles_;
};

} // namespace lumorph::sea
