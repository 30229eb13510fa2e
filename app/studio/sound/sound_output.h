#pragma once

#include <memory>

#include "app/sound/sound_mixer.h"

namespace lumorph::studio {

/// Plays a mixer through the system's default output (Qt Multimedia). Sounds are made, and the output is opened and
/// fed, in a thread of its own: a sound server that hangs holds up nothing else. Where there is no output nothing
/// happens, and one that comes later is taken; after some seconds of silence it is let go.
class SoundOutput {
public:
    explicit SoundOutput(std::shared_ptr<SoundMixer> mixer);
    ~SoundOutput();
    SoundOutput(const SoundOutput&) = delete;
    SoundOutput& operator=(const SoundOutput&) = delete;

    /// There is something to be heard. From any thread; returns at once.
    void wake();

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph::studio
