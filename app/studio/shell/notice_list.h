#pragma once

#include <set>
#include <vector>

#include <QWidget>

#include "app/studio/base/notices.h"

namespace lumorph::studio {

/// All notices with their place and remedy, and further warnings as sentences; a popup over `window` that closes by Esc
/// or a click elsewhere. objectName "notices.list".
[[nodiscard]] QWidget* makeNoticeList(Notices& notices, const std::set<QString>& places,
                                      const std::vector<QString>& warnings, QWidget* window);
/// The further warnings as they are now.
void updateNoticeList(QWidget& list, const std::vector<QString>& warnings);
/// Shows it with its bottom right corner at a point of its window.
void openNoticeList(QWidget& list, const QPoint& corner);

} // namespace lumorph::studio
