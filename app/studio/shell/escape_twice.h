#pragma once

#include <QObject>

#include "app/studio/shell/press_twice.h"

namespace lumorph::studio {

/// Esc twice within 600 ms, anywhere in the program, whatever has the keyboard: docks, floating docks, dialogs, menus.
class EscapeTwice : public QObject {
    Q_OBJECT
public:
    /// `clock` outlives it.
    explicit EscapeTwice(const Clock& clock, QObject* parent = nullptr);

signals:
    void pressed();

protected:
    bool eventFilter(QObject* watched, QEvent* event) override;

private:
    void press();

    const Clock& clock_;
    bool down_ = false;
    Microseconds downAt_{0};
    PressTwice twice_;
};

} // namespace lumorph::studio
