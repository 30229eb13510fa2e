#pragma once

#include <functional>
#include <memory>

#include "app/studio/devices/pad_inputs.h"

namespace lumorph::studio {

/// All game controllers that are plugged in (SDL, its joysticks alone: no window, no sound, no signal handler), read
/// sixty times a second in a thread of its own while somebody wants to know. They come and go as they like; without one
/// nothing happens.
class Gamepads {
public:
    /// `told` is called in that thread, an input at a time.
    explicit Gamepads(std::function<void(const ShowInput&)> told);
    ~Gamepads();
    Gamepads(const Gamepads&) = delete;
    Gamepads& operator=(const Gamepads&) = delete;

    /// What is held when polling ends is let go.
    void setPolling(bool polls);

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph::studio
