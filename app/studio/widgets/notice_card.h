#pragma once

#include <QWidget>

#include "app/studio/base/notices.h"

namespace lumorph::studio {

/// One notice: what it is about, why, the remedy in words and as buttons, and a button that dismisses it. `heading`
/// stands above it when it is told away from its place, such as in the list of all. One that is not `dismissible` goes
/// by itself when its cause does.
[[nodiscard]] QWidget* makeNoticeCard(Notices& notices, const QString& place, const Notice& notice,
                                      const QString& heading = {}, QWidget* parent = nullptr, bool dismissible = true);

} // namespace lumorph::studio
