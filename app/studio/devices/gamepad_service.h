#pragma once

#include <memory>

#include <QObject>

#include "app/studio/devices/gamepads.h"
#include "app/studio/document/studio_loop.h"

namespace lumorph::studio {

/// Hands what is done with a gamepad on to the application that shows. Where none shows, no pad is read.
class GamepadService : public QObject {
    Q_OBJECT
public:
    explicit GamepadService(StudioLoop& loop);

    /// From here on pads are read. The program calls it; whoever does not has none.
    void open();

private:
    void follow();

    StudioLoop& loop_;
    std::unique_ptr<Gamepads> pads_;
};

} // namespace lumorph::studio
