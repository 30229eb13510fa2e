#pragma once

#include <cstdint>
#include <span>
#include <vector>

/// Parts of which sounds are made: tones that ring out, noise through filters, loops without a seam. One channel of
/// samples at `kSoundRate`; frequencies in hertz, times in seconds. The same calls give the same samples.
namespace lumorph {

inline constexpr int kSoundRate = 48'000; ///< samples a second

using Samples = std::vector<float>;

[[nodiscard]] Samples silence(double seconds);

/// A tone that begins at `at` and rings out to a 1/e in `decay`; its frequency glides to `to` with the same decay
/// (0: it stays).
struct Ring {
    double frequency = 440.0;
    double amplitude = 1.0;
    double decay = 0.1;
    double at = 0.0;
    double to = 0.0;
};
void add(Samples& samples, const Ring& ring);
void add(Samples& samples, std::span<const Ring> rings);
/// Another sound into this one from `at` on; what would lie behind its end is left out.
void add(Samples& samples, const Samples& other, double at, double amplitude);

/// Even noise, -1 to 1.
[[nodiscard]] Samples noise(double seconds, std::uint32_t seed);
/// Second-order filters; `quality` 0.7 has no peak.
void lowPass(Samples& samples, double frequency, double quality = 0.7);
void highPass(Samples& samples, double frequency, double quality = 0.7);
void bandPass(Samples& samples, double frequency, double quality);
/// A band whose middle wanders between two frequencies, whole times to and fro over the length.
void wanderingBand(Samples& samples, double low, double high, double quality, int times);

/// Fades in over `attack` and rings out to 1/e in each `decay` after it.
void shape(Samples& samples, double attack, double decay);
/// Swells from `least` to 1 and back, whole times over the length.
void swell(Samples& samples, double least, int times);

/// Begins where it ends: its last `fade` seconds are laid under its first ones, and it is shorter by them.
[[nodiscard]] Samples looped(const Samples& samples, double fade);

/// So that the loudest sample is `peak`, or the mean power that of `rms`; silence stays silence. The end of `toPeak`
/// fades within 5 ms, so that it never clicks.
[[nodiscard]] Samples toPeak(Samples samples, double peak);
[[nodiscard]] Samples toPower(Samples samples, double rms);

} // namespace lumorph
