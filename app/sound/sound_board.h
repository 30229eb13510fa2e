#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "app/sound/synthesis.h"

namespace lumorph {

/// A sound that applications may name in ShowContent::sounds, ready to be played.
struct SoundVoice {
    std::string name;        ///< "labyrinth.bump"
    bool continuous = false; ///< a loop that is heard as long as frames name it; else once from its beginning
    Samples samples;         ///< one channel, `kSoundRate` a second

    /// What a sound's strength does: it is as quiet as `softest` (0 to 1) at `from` and below, full at `to`.
    double from = 0.0;
    double to = 1.0;
    double softest = 0.0;
    double slow = 1.0; ///< how fast it is played at `from`
    double fast = 1.0; ///< and at `to`
    /// Instead of these two, how fast at a strength of 1, 2, 3, ...: a tune that climbs. Empty: none.
    std::vector<double> steps;

    [[nodiscard]] double loudness(double strength) const noexcept; ///< 0 to 1
    [[nodiscard]] double speed(double strength) const noexcept;    ///< 1: as it was made
};

/// Of the studio itself: servos are about to move by themselves.
inline constexpr auto kHandsOffSound = "studio.hands_off";

/// All sounds there are, made by our own formulas: no file, no chance.
class SoundBoard {
public:
    /// Takes some tenths of a second: for a thread beside.
    [[nodiscard]] static SoundBoard synthesised();

    explicit SoundBoard(std::vector<SoundVoice> voices) : voices_(std::move(voices)) {}
    /// Null for a name that nothing is known of.
    [[nodiscard]] const SoundVoice* find(std::string_view name) const noexcept;
    [[nodiscard]] const std::vector<SoundVoice>& voices() const noexcept { return voices_; }

private:
    std::vector<SoundVoice> voices_;
};

} // namespace lumorph
