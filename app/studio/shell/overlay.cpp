#include "app/studio/shell/overlay.h"

#include <QApplication>
#include <QEvent>
#include <QPainter>

#include "app/studio/look/palette.h"
#include "app/studio/shell/escape_twice.h"

namespace lumorph::studio {

Overlay::Overlay(QWidget& window) : QWidget(&window), hadKeyboard_(QApplication::focusWidget()) {
    setFocusPolicy(Qt::StrongFocus);
    setProperty("noFocusRing", true);
    EscapeTwice::setCloses(*this);
    window.installEventFilter(this);
}

void Overlay::open() {
    setGeometry(parentWidget()->rect());
    coverAllBut({});
    arrange();
    show();
    raise();
}

void Overlay::coverAllBut(const QRegion& open) {
    QRegion lit = open;
    if (const auto* stop = parentWidget()->findChild<QWidget*>("stop"); stop != nullptr && stop->isVisible())
        lit += QRect(stop->mapTo(parentWidget(), QPoint()), stop->size());
    setMask(QRegion(rect()) - lit);
}

void Overlay::leave() {
    if (isHidden()) return;
    hide();
    if (hadKeyboard_) hadKeyboard_->setFocus(Qt::PopupFocusReason);
    setObjectName({}); // one that is on its way out is not found
    deleteLater();
}

bool Overlay::eventFilter(QObject* watched, QEvent* event) {
    if (watched == parentWidget() && event->type() == QEvent::Resize && isVisible()) {
        setGeometry(parentWidget()->rect());
        coverAllBut({});
        arrange();
    }
    return QWidget::eventFilter(watched, event);
}

void Overlay::paintEvent(QPaintEvent* /*event*/) { QPainter(this).fillRect(rect(), dimming()); }

QColor Overlay::dimming() { return currentTheme() == Theme::dark ? QColor(0, 0, 0, 120) : QColor(20, 26, 32, 70); }

} // namespace lumorph::studio
