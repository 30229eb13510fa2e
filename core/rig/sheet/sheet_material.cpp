#include "core/rig/sheet/sheet_material.h"

#include <algorithm>
#include <array>
#include <string>

#include "core/base/error.h"
#include "core/base/text.h"

namespace lumorph {
namespace {

constexpr std::array kMaterials{
    // NinjaTek's data sheet of NinjaFlex 85A: tensile modulus 12 MPa (ASTM D638), Shore 85A. It gives no Poisson ratio:
    // assumed, that of a nearly incompressible elastomer.
    SheetMaterial{"NinjaFlex", 12e6, 0.48},
    // Shapeways' page "TPU SLS": tensile modulus 60 MPa (ISO 527), Shore 86A. Poisson ratio as above.
    SheetMaterial{"sintered TPU", 60e6, 0.48},
    // Printing paper: 2.9 GPa in Sci. Rep. 4, 6275 (2014), table 2, read as if its columns of modulus and strength were
    // interchanged: only then both are those of paper. Poisson ratio 1/3 in Schulgasser, "The in-plane Poisson ratio of
    // paper", Fibre Sci. Technol. 19 (1983) 297-309.
    SheetMaterial{"printing paper", 2.9e9, 1.0 / 3.0},
    // DuPont Teijin Films' bulletin H-37232-3 "Mylar, physical-thermal properties": modulus 490 and 510 kgf/mm^2 along
    // and across the web (their mean), Poisson ratio 0.38 before yield.
    SheetMaterial{"Mylar", 500.0 * 9.80665e6, 0.38},
};

void require(bool good, std::string_view material, const char* why, const char* remedy) {
    if (!good) throw InvalidInput("sheet layer " + inQuotes(material), why, remedy);
}

} // namespace

std::span<const SheetMaterial> sheetMaterials() { return kMaterials; }

const SheetMaterial& sheetMaterial(std::string_view name) {
    const std::string wanted = lowerCase(name);
    const auto found = std::ranges::find_if(
        kMaterials, [&](const SheetMaterial& material) { return lowerCase(material.name) == wanted; });
    if (found != kMaterials.end()) return *found;
    std::string names;
    for (const SheetMaterial& material : kMaterials) names += (names.empty() ? "" : ", ") + std::string(material.name);
    throw InvalidInput(inQuotes(name), "there is no such material in the table", "choose one of " + names);
}

void checkLayers(std::span<const SheetLayer> layers) {
    for (const auto& [material, thickness, loose] : layers) {
        require(material.youngsModulus >= 1e4 && material.youngsModulus <= 1e12, material.name,
                "Young's modulus is not between 10 kPa and 1 TPa", "give it in pascals");
        require(material.poissonRatio > -0.99 && material.poissonRatio < 0.5, material.name,
                "the Poisson ratio is not between -0.99 and 0.5", "an incompressible material has 0.49");
        require(thickness >= 1e-5 && thickness <= 5e-3, material.name, "the thickness is not between 0.01 and 5 mm",
                "give it in metres, or choose another");
    }
    if (std::ranges::none_of(layers, [](const SheetLayer& layer) { return !layer.loose; }))
        throw InvalidInput("sheet layers", "none carries membrane forces", "add a layer that is not loose");
}

} // namespace lumorph
