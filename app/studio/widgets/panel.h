#pragma once

#include <QString>
#include <QVBoxLayout>
#include <QWidget>

#include "app/studio/base/commands.h"
#include "app/studio/base/jobs.h"
#include "app/studio/base/notices.h"

namespace lumorph::studio {

/// What a dock shows while it has nothing: what it is for, and the first action as an accent button.
[[nodiscard]] QWidget* makeEmptyState(const QString& icon, const QString& title, const QString& text, QAction* action,
                                      QWidget* parent = nullptr);

/// A heading with a hairline, for groups inside a dock.
[[nodiscard]] QWidget* makeHeading(const QString& text, QWidget* parent = nullptr);

/// The scrolling column of a dock: 8-pixel grid, contents stretch sideways only. Add to the returned layout.
struct Column {
    QWidget* widget = nullptr; ///< goes into the dock
    QVBoxLayout* layout = nullptr;
};
[[nodiscard]] Column makeColumn(QWidget* parent = nullptr);

/// A row "label ... control"; the label is the control's buddy and has its keyboard mnemonic.
[[nodiscard]] QWidget* makeRow(const QString& label, QWidget* control, QWidget* parent = nullptr);

/// Shows the newest notice of a place where its cause is, with the remedy as buttons; nothing while there is none.
[[nodiscard]] QWidget* makeNoticeBar(Notices& notices, const QString& place, QWidget* parent = nullptr);

/// Shows the jobs of a place that take longer than 0.2 s: title, stage, bar, cancel; nothing while there are none.
[[nodiscard]] QWidget* makeJobBar(Jobs& jobs, const QString& place, QWidget* parent = nullptr);

/// The same for the newest job of all places, in one line: for the status line.
[[nodiscard]] QWidget* makeJobLine(Jobs& jobs, QWidget* parent = nullptr);

} // namespace lumorph::studio
