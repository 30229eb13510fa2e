#pragma once

#include <QString>

#include "app/studio/look/palette.h"

namespace lumorph::studio {

/// The boxes of the look (fills, borders, distances on the 8-pixel grid); what a style sheet cannot draw sharply is in
/// StudioStyle. Widgets choose a look by the dynamic property "look": "primary", "danger", "flat", "card", "muted",
/// "heading", "title", "badge".
[[nodiscard]] QString styleSheet(const Palette& palette);

} // namespace lumorph::studio
