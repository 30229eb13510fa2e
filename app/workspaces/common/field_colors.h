#pragma once

#include "app/studio/look/palette.h"
#include "app/workspaces/common/field_scene.h"

namespace lumorph::studio {

/// A colour of the palette as scenes take it, sRGB in [0, 1].
[[nodiscard]] inline glm::vec3 sceneColor(const QColor& color) {
    return {static_cast<float>(color.redF()), static_cast<float>(color.greenF()), static_cast<float>(color.blueF())};
}

/// What a scene needs of a theme's palette.
[[nodiscard]] inline FieldSceneColors fieldSceneColors(Theme theme) {
    const Palette& palette = paletteOf(theme);
    FieldSceneColors colors;
    colors.theme = theme;
    colors.target = colors.accent = sceneColor(palette.accent);
    colors.unmatched = sceneColor(palette.unmatched);
    colors.overfilled = sceneColor(palette.overfilled);
    colors.levelLow = sceneColor(palette.levelLow);
    colors.levelHigh = sceneColor(palette.levelHigh);
    return colors;
}

} // namespace lumorph::studio
