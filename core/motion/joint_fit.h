#pragma once

#include <span>
#include <vector>

#include "core/motion/stroke_fit.h"
#include "core/motion/surface_heights.h"

namespace lumorph {

/// Least-squares fit of heights by strokes for rigs whose actuators act on one another, as joints in a row do: it looks
/// at the surface that the rig truly has, stroke by stroke, by steps that grow smaller.
class JointFit {
public:
    explicit JointFit(const TopSurface& surface);

    /// Whether what several actuators do together differs from the sum of what each does alone, as `sum` takes it: by
    /// more than a hundredth of the energy, over some joint states.
    [[nodiscard]] bool differsFrom(const StrokeFit& sum);
    /// Improves `strokes`, from where they stand, towards heights over rest; looks at no more states than `most`, at
    /// first `step` apart.
    void improve(std::span<const double> lifts, std::span<double> strokes, double step, int most);
    /// Takes the best of `states` joint states spread over all there are, where it is better than `strokes`.
    void scan(std::span<const double> lifts, std::span<double> strokes, int states);
    /// Sum of the squares that these strokes leave over.
    [[nodiscard]] double errorAt(std::span<const double> lifts, std::span<const double> strokes);

private:
    void read(std::span<const double> strokes);

    const TopSurface* surface_;
    SurfaceHeights reader_;
    std::vector<glm::vec3> positions_; ///< buffers
    std::vector<float> heights_;
};

} // namespace lumorph
