#pragma once

#include <algorithm>

#include "app/studio/look/palette.h"
#include "app/workspaces/common/field_scene.h"

namespace lumorph::studio {

/// A colour of the palette as scenes take it, sRGB in [0, 1].
[[nodiscard]] inline glm::vec3 sceneColor(const QColor& color) {
    return {static_cast<float>(color.redF()), static_cast<float>(color.greenF()), static_cast<float>(color.blueF())};
}

/// Green is good (1), red is bad (0); in between the hue tells.
[[nodiscard]] inline QColor gradeColor(double goodness) {
    return QColor::fromHsvF(static_cast<float>(0.38 * std::clamp(goodness, 0.0, 1.0)), 0.62F, 0.85F);
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
