#pragma once

#include <QWidget>

#include "app/studio/calibration/calibration_state.h"

namespace lumorph::studio {

/// One finding as a plate: what, where, and what to do.
[[nodiscard]] QWidget* makeFindingCard(const FindingWords& words, bool isRefusal, QWidget* parent);

} // namespace lumorph::studio
