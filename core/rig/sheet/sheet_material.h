#pragma once

#include <span>
#include <string_view>

namespace lumorph {

/// A linear elastic, isotropic material.
struct SheetMaterial {
    std::string_view name;
    double youngsModulus = 0.0; ///< pascals
    double poissonRatio = 0.0;
    bool operator==(const SheetMaterial&) const = default;
};

/// The table of sheet materials, ordered by stiffness. Its comments give the source of each number.
[[nodiscard]] std::span<const SheetMaterial> sheetMaterials();
/// By its name in any case. Throws InvalidInput naming those there are.
[[nodiscard]] const SheetMaterial& sheetMaterial(std::string_view name);

/// One layer of a sheet.
struct SheetLayer {
    SheetMaterial material;
    double thickness = 0.0; ///< metres
    /// Lies on the sheet without being glued to it, as paper does: it adds its bending stiffness about its own middle
    /// surface, but takes no membrane force.
    bool loose = false;
    bool operator==(const SheetLayer&) const = default;
};

/// Throws InvalidInput when no layer carries membrane forces, or a modulus, Poisson ratio or thickness is outside what
/// a thin elastic shell may have.
void checkLayers(std::span<const SheetLayer> layers);

} // namespace lumorph
