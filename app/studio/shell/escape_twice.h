#pragma once

#include <optional>

#include <QObject>

#include "core/base/clock.h"

namespace lumorph::studio {

/// Esc twice within 600 ms, anywhere in the program, whatever has the keyboard: docks, floating docks, dialogs, menus.
class EscapeTwice : public QObject {
    Q_OBJECT
public:
    static constexpr Microseconds kWithin{600'000};

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
    std::optional<Microseconds> firstAt_;
};

} // namespace lumorph::studio
