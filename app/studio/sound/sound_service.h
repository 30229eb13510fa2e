#pragma once

#include <memory>
#include <mutex>

#include <QObject>

#include "app/studio/base/settings.h"
#include "app/studio/document/studio_loop.h"
#include "app/studio/sound/sound_output.h"

namespace lumorph::studio {

/// What applications let be heard, and signals of the studio itself: each frame's sounds go from the loop's own thread
/// into the mixer, also those of frames that the window leaves out, and each once. How loud, and whether at all, is a
/// setting.
class SoundService : public QObject {
    Q_OBJECT
public:
    SoundService(Settings& settings, StudioLoop& loop);
    ~SoundService() override;

    /// From here on it is heard where there is an output. The program calls it; whoever does not stays silent.
    void open();
    /// Lets a sound be heard once, by its name. Returns at once; nothing happens where there is no output.
    void signal(const char* name);
    [[nodiscard]] SoundMixer& mixer() noexcept { return *mixer_; }

private:
    void follow();
    void take(const MatchFrame& frame); ///< in the loop's thread
    void wake();

    Settings& settings_;
    StudioLoop& loop_;
    std::shared_ptr<SoundMixer> mixer_ = std::make_shared<SoundMixer>();
    std::mutex opening_; ///< guards the output from the loop's thread
    std::unique_ptr<SoundOutput> output_;
    int tap_ = 0;
};

} // namespace lumorph::studio
