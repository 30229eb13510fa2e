#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "app/sound/sound_board.h"
#include "core/loop/show_sound.h"

namespace lumorph {

/// What frames let be heard, mixed into two channels. Whoever has a frame calls `play`, from any thread and once for
/// each frame; whoever plays the samples calls `mix`, from one thread. A sound that is heard once waits until the next
/// `mix`, so none is lost where frames come faster than blocks; one that goes on follows the newest frame, and fades
/// where that does not name it, or no frame comes any more. The sum never clips: a limiter that sees ahead turns it
/// down.
class SoundMixer {
public:
    static constexpr std::size_t kMostVoices = 64;
    static constexpr double kPatience = 0.4;  ///< seconds without a frame until what goes on fades
    static constexpr double kReach = 0.12;    ///< metres beside the device's middle at which a sound is quite aside
    static constexpr double kCeiling = 0.94;  ///< of the largest sample
    static constexpr std::size_t kChunk = 64; ///< samples of a channel by which the limiter sees ahead

    /// Without a board all is silent.
    void setBoard(std::shared_ptr<const SoundBoard> board);
    /// Samples a second that are asked for; `kSoundRate` at first.
    void setRate(int rate);
    /// Off: fades to silence, and what comes meanwhile is not heard later.
    void setOn(bool on);
    void setLoudness(double share); ///< 0 to 1, as the ear takes it

    /// The sounds of one frame, none too. Costs next to nothing.
    void play(std::span<const ShowSound> sounds);
    /// One that is heard once, whatever frames let be heard.
    void signal(const ShowSound& sound);
    /// What waits is not heard any more: it came long ago. Of frames alone: signals are heard though they had to wait.
    void forget();
    void forgetFrames();

    /// The next samples, left and right by turns; an even number of them.
    void mix(std::span<std::int16_t> samples);
    /// Whether nothing is heard and nothing waits.
    [[nodiscard]] bool silent() const;

private:
    /// Something that is heard now.
    struct Heard {
        const SoundVoice* voice = nullptr;
        double at = 0.0; ///< in its samples
        double speed = 1.0;
        std::array<float, 2> gain{};   ///< as it is
        std::array<float, 2> wanted{}; ///< as it will be
        bool named = true;             ///< by the newest frame
    };
    using Chunk = std::array<float, 2 * kChunk>;

    void takeNews();
    Heard& begin(const SoundVoice& voice, const ShowSound& sound);
    void goOn(std::span<const ShowSound> sounds);
    void render(Heard& heard, Chunk& chunk) const;
    [[nodiscard]] float limited(float begin, const Chunk& now, const Chunk& next) const;
    void nextChunk();
    [[nodiscard]] static std::array<float, 2> gainsOf(const SoundVoice& voice, const ShowSound& sound);

    mutable std::mutex mutex_; ///< guards what comes from outside
    std::shared_ptr<const SoundBoard> board_;
    std::vector<ShowSound> waiting_; ///< heard once
    std::vector<ShowSound> signals_; ///< likewise
    std::vector<ShowSound> going_;   ///< of the newest frame
    bool fresh_ = false;             ///< a frame came
    bool on_ = true;
    double loudness_ = 1.0;
    double rate_ = kSoundRate;
    bool quiet_ = true; ///< nothing is heard

    // Of the thread that mixes.
    std::shared_ptr<const SoundBoard> playing_;
    std::vector<Heard> heard_;
    double pace_ = 1.0; ///< samples of a voice for one that goes out
    double sinceFrame_ = 0.0;
    float master_ = 1.0F, masterWanted_ = 1.0F;
    float limit_ = 1.0F; ///< by which the chunk before ended
    Chunk ahead_{};      ///< rendered, not yet limited
    Chunk ready_{};
    std::size_t used_ = 2 * kChunk; ///< of `ready_`
};

} // namespace lumorph
