#pragma once

#include <vector>

#include "core/rig/compiled_sheet.h"

namespace lumorph {

/// Boxes that hold the displacement of a row along a path in every joint state. In Bernstein form a polynomial stays
/// within its coefficients (Farin, Curves and Surfaces for CAGD, convex hull property); they are halved by de Casteljau
/// until the bounds are within about 2 % of the box of values that are reached, on either side.
class SheetReach {
public:
    explicit SheetReach(const CompiledSheet& sheet);

    /// Displacements from rest, metres; with room for the rounding of the displacement itself.
    [[nodiscard]] Box of(std::uint16_t path, std::uint32_t row) const;

private:
    /// The mode coefficients of a path as Bernstein coefficients over its strokes.
    struct Form {
        std::vector<std::size_t> sizes;  ///< of the axes that move it: degree + 1
        std::vector<float> coefficients; ///< laid out as SheetModes::coefficients
        std::vector<double> rounding;    ///< one a mode, metres a metre of mode
    };
    static Form formOf(const SheetModes& modes, const SheetPath& path);
    static std::vector<double> roundingOf(const SheetModes& modes, const std::vector<float>& bernstein);

    const CompiledSheet& sheet_;
    std::vector<Form> forms_; ///< one a path
};

} // namespace lumorph
