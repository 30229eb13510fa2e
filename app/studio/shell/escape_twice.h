#pragma once

#include <QObject>
#include <QSet>
#include <QWidget>

#include "app/studio/shell/press_twice.h"

namespace lumorph::studio {

/// Esc twice within 600 ms, anywhere in the program, whatever has the keyboard: docks, floating docks, dialogs, menus.
/// A press that closed a menu, a dialog or a sheet over the window does not count: who closes things does not mean
/// STOP.
class EscapeTwice : public QObject {
    Q_OBJECT
public:
    /// `clock` outlives it.
    explicit EscapeTwice(const Clock& clock, QObject* parent = nullptr);

    /// Marks a widget that is no window as one that Esc closes.
    static void setCloses(QWidget& widget, bool closes = true);

signals:
    void pressed();
    void single();              ///< one press, which closed nothing; another may follow and make it `pressed`
    void spent();               ///< a press that closed something
    void openChanged(bool any); ///< whether anything is open that Esc may close

protected:
    bool eventFilter(QObject* watched, QEvent* event) override;

private:
    void press();
    void settle();

    const Clock& clock_;
    QSet<QObject*> open_;    ///< what Esc may close
    bool closed_ = false;    ///< something, since the press
    bool unsettled_ = false; ///< a press is being handled

    bool down_ = false;
    Microseconds downAt_{0};
    PressTwice twice_;
};

} // namespace lumorph::studio
