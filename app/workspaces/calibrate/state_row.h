#pragma once

#include <QLabel>

#include "app/studio/widgets/icon_label.h"

namespace lumorph::studio {

/// One of several things that are done one after the other, as it is read.
struct StateRowText {
    QString icon;
    IconRole role = IconRole::muted;
    QString title, state; ///< "Pointer tip", "Measured"
    QString words;        ///< why, or when
    int number = 0;       ///< in its list; 0: none is shown
};

/// Such a row: icon, number and title, state, and words below. Fills a widget of any kind, which may be a button; its
/// parts are called after that widget: NAME.how and NAME.words.
class StateRow {
public:
    StateRow(QWidget& host, const QMargins& margins);
    void show(const StateRowText& text);

private:
    QWidget& host_;
    IconLabel* icon_;
    QLabel *title_, *how_, *words_;
};

} // namespace lumorph::studio
