#pragma once

#include <cmath>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "core/base/units.h"
#include "core/rig/sheet/sheet_material.h"

namespace lumorph {

/// A servo's arm whose nose is captive in a straight slot under the sheet: it holds the slot's line at its height, up
/// and down, while the sheet slides along it in the plane. Lines are drawn on the flat sheet, (x, z), metres.
struct SheetLever {
    std::string name;
    glm::dvec2 from{0.0};
    glm::dvec2 to{0.0};
    double arm = 0.026; ///< metres from the shaft to the nose
    Angle rest;         ///< of the arm above level at stroke 0
    Angle end;          ///< at stroke 1

    [[nodiscard]] double angleAt(double stroke) const {
        return rest.inRadians() + stroke * (end.inRadians() - rest.inRadians());
    }
    /// How far the line is above the flat sheet, metres.
    [[nodiscard]] double heightAt(double stroke) const {
        return arm * (std::sin(angleAt(stroke)) - std::sin(rest.inRadians()));
    }
    bool operator==(const SheetLever&) const = default;
};

/// A flat elastic sheet in the plane y = 0: its rim is free, its pad clamped, its levers lift their lines.
struct ElasticSheet {
    std::vector<glm::dvec2> outline; ///< (x, z), metres, a simple polygon in either direction
    std::vector<glm::dvec2> pad;     ///< the same; inside the outline
    std::vector<SheetLayer> layers;
    std::vector<SheetLever> levers;
    bool operator==(const ElasticSheet&) const = default;
};

} // namespace lumorph
