#pragma once

#include <QString>

#include "core/scene/installation.h"
#include "core/scene/scene.h"

namespace lumorph::studio {

/// What an item is, in a word ("Box", "Water", "Sun"), and its icon.
[[nodiscard]] QString kindWord(const SceneItem& item);
[[nodiscard]] QString kindIcon(const SceneItem& item);
/// "Physical", "Light" or "Split", and what it means in one plain sentence.
[[nodiscard]] QString roleWord(ItemRole role);
[[nodiscard]] QString roleSentence(ItemRole role);
/// Whether servos can take its shape at all.
[[nodiscard]] bool canBePhysical(const SceneItem& item);
/// Whether it has a surface, and so a material.
[[nodiscard]] bool hasMaterial(const SceneItem& item);

/// "assumed", "entered by hand on 24 Nov 2026", "measured (structured light) on 24 Nov 2026",
/// "simulated in the virtual lab (flat light) on 24 Nov 2026".
[[nodiscard]] QString originWords(const Origin& origin);

} // namespace lumorph::studio
