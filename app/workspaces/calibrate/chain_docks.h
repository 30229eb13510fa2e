#pragma once

#include <QWidget>

#include "app/workspaces/calibrate/calibrate_docks.h"

namespace lumorph::studio {

// The whole chain beside the sequence of projector and camera: its links, the chosen one, and what that came to.
[[nodiscard]] QWidget* makeChainLinks(const CalibrateParts& parts);
[[nodiscard]] QWidget* makeChainView(const CalibrateParts& parts);
/// Where the chosen link is measured: in the lab, or from recordings, which are chosen here.
[[nodiscard]] QWidget* makeChainSource(const CalibrateParts& parts, QWidget* parent);
/// In place of the chosen link: what is connected, how good it is, and what is missing.
[[nodiscard]] QWidget* makeConnectedView(const CalibrateParts& parts);
/// In place of the chosen link: where the millimetres come from.
[[nodiscard]] QWidget* makeBudgetView(const CalibrateParts& parts);
[[nodiscard]] QWidget* makeChainResult(const CalibrateParts& parts);

} // namespace lumorph::studio
