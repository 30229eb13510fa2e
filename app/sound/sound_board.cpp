#include "app/sound/sound_board.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace lumorph {
namespace {

constexpr double kSeam = 0.25; ///< seconds over which a loop's end is laid under its beginning

/// A bell's partials over its tone.
void addBell(Samples& samples, double frequency, double amplitude, double decay, double at) {
    const std::array rings{Ring{frequency, amplitude, decay, at},
                           Ring{2.0 * frequency, 0.45 * amplitude, 0.7 * decay, at},
                           Ring{2.76 * frequency, 0.30 * amplitude, 0.4 * decay, at},
                           Ring{5.40 * frequency, 0.14 * amplitude, 0.15 * decay, at}};
    add(samples, rings);
}

/// A ball on wood: a low rumble, and the grain of the boards under it.
Samples rolling() {
    Samples rumble = noise(2.4, 11), grain = silence(2.4);
    lowPass(rumble, 220.0, 1.1);
    std::mt19937 random(12);
    for (double at = 0.0; at < 2.38; at += 0.006 + 0.020 * static_cast<double>(random()) * 0x1p-32)
        add(grain, Ring{520.0 + 420.0 * static_cast<double>(random()) * 0x1p-32, 0.3, 0.004, at});
    Samples mixed = toPower(std::move(rumble), 0.14);
    add(mixed, toPower(std::move(grain), 0.07), 0.0, 1.0);
    return toPower(looped(mixed, kSeam), 0.16);
}

/// A ball against wood.
Samples knock() {
    Samples samples = silence(0.30), click = noise(0.012, 21);
    const std::array rings{Ring{285.0, 1.0, 0.055}, Ring{640.0, 0.6, 0.030}, Ring{1390.0, 0.35, 0.014},
                           Ring{2650.0, 0.2, 0.007}};
    add(samples, rings);
    shape(click, 0.0005, 0.002);
    add(samples, click, 0.0, 0.5);
    return toPeak(std::move(samples), 0.75);
}

Samples gem() {
    Samples samples = silence(0.7);
    addBell(samples, 659.3, 0.7, 0.16, 0.0);
    addBell(samples, 987.8, 1.0, 0.22, 0.07);
    return toPeak(std::move(samples), 0.5);
}

/// Down a hole, and it lands.
Samples falling() {
    Samples samples = silence(0.9), thud = noise(0.25, 31);
    add(samples, Ring{760.0, 0.8, 0.22, 0.0, 130.0});
    lowPass(thud, 140.0, 1.0);
    shape(thud, 0.002, 0.05);
    add(samples, toPeak(std::move(thud), 0.9), 0.48, 1.0);
    return toPeak(std::move(samples), 0.6);
}

Samples fanfare() {
    Samples samples = silence(1.8);
    const std::array notes{523.3, 659.3, 784.0, 1046.5};
    for (std::size_t k = 0; k < notes.size(); ++k) addBell(samples, notes[k], 0.8, 0.5, 0.10 * static_cast<double>(k));
    addBell(samples, 261.6, 0.5, 0.7, 0.3);
    return toPeak(std::move(samples), 0.65);
}

/// Drops by the hundred on a hiss of those far away.
Samples rain() {
    Samples hiss = noise(4.3, 41), drops = silence(4.3);
    highPass(hiss, 1800.0);
    lowPass(hiss, 9000.0);
    std::mt19937 random(42);
    const auto chance = [&random] { return static_cast<double>(random()) * 0x1p-32; };
    for (double at = 0.0; at < 4.27; at += 0.016 * chance() + 0.001) {
        const double tone = 900.0 + 3800.0 * chance() * chance();
        add(drops, Ring{tone, 0.15 + 0.85 * chance() * chance(), 0.004, at, 1.3 * tone});
    }
    Samples mixed = toPower(std::move(hiss), 0.09);
    add(mixed, toPower(std::move(drops), 0.06), 0.0, 1.0);
    return toPower(looped(mixed, kSeam), 0.11);
}

Samples wind() {
    Samples howl = noise(8.3, 51), breath = noise(8.3, 52);
    wanderingBand(howl, 260.0, 620.0, 5.0, 3);
    swell(howl, 0.35, 2);
    lowPass(breath, 420.0);
    Samples mixed = toPower(std::move(howl), 0.1);
    add(mixed, toPower(std::move(breath), 0.08), 0.0, 1.0);
    return toPower(looped(mixed, kSeam), 0.13);
}

/// A sea that comes and goes.
Samples waves() {
    Samples surf = noise(9.3, 61), deep = noise(9.3, 62);
    wanderingBand(surf, 500.0, 2200.0, 0.8, 2);
    swell(surf, 0.15, 2);
    lowPass(deep, 260.0);
    Samples mixed = toPower(std::move(surf), 0.1);
    add(mixed, toPower(std::move(deep), 0.08), 0.0, 1.0);
    return toPower(looped(mixed, kSeam), 0.13);
}

Samples thunder() {
    Samples samples = silence(4.0);
    std::mt19937 random(71);
    const auto chance = [&random] { return static_cast<double>(random()) * 0x1p-32; };
    double at = 0.0;
    for (int k = 0; k < 7; ++k) {
        Samples roll = noise(2.0, 72 + static_cast<std::uint32_t>(k));
        lowPass(roll, k == 0 ? 900.0 : 90.0 + 190.0 * chance());
        shape(roll, k == 0 ? 0.004 : 0.06 + 0.1 * chance(), 0.25 + 0.45 * chance());
        add(samples, toPower(std::move(roll), 0.1), at, k == 0 ? 0.8 : 0.5 + 0.5 * chance());
        at += 0.05 + 0.4 * chance();
    }
    return toPeak(std::move(samples), 0.8);
}

/// Ice that breaks: a crackle, and the whistle that a sheet sends ahead of its bass.
Samples cracking() {
    Samples samples = silence(0.9);
    std::mt19937 random(81);
    const auto chance = [&random] { return static_cast<double>(random()) * 0x1p-32; };
    for (double at = 0.0; at < 0.16; at += 0.004 + 0.03 * chance()) {
        Samples snap = noise(0.02, 82 + static_cast<std::uint32_t>(at * 1e4));
        highPass(snap, 1400.0);
        shape(snap, 0.0003, 0.003);
        add(samples, snap, at, 0.3 + 0.7 * chance());
    }
    add(samples, Ring{3600.0, 0.45, 0.05, 0.01, 300.0});
    add(samples, Ring{210.0, 0.35, 0.16, 0.03, 150.0});
    return toPeak(std::move(samples), 0.75);
}

Samples floes() {
    Samples samples = silence(0.4), scrape = noise(0.09, 91);
    const std::array rings{Ring{165.0, 1.0, 0.07}, Ring{395.0, 0.5, 0.05}, Ring{930.0, 0.25, 0.03}};
    add(samples, rings);
    bandPass(scrape, 2300.0, 1.2);
    shape(scrape, 0.004, 0.02);
    add(samples, scrape, 0.0, 0.7);
    return toPeak(std::move(samples), 0.7);
}

Samples dripping() {
    Samples samples = silence(0.35);
    add(samples, Ring{780.0, 0.7, 0.05, 0.0, 1750.0});
    add(samples, Ring{1180.0, 0.35, 0.04, 0.07, 2100.0});
    return toPeak(std::move(samples), 0.45);
}

Samples splashing() {
    Samples samples = silence(0.9), spray = noise(0.85, 101);
    wanderingBand(spray, 700.0, 2600.0, 0.7, 1);
    shape(spray, 0.012, 0.14);
    add(samples, toPeak(std::move(spray), 1.0), 0.0, 0.8);
    std::mt19937 random(102);
    const auto chance = [&random] { return static_cast<double>(random()) * 0x1p-32; };
    for (double at = 0.08; at < 0.6; at += 0.03 + 0.06 * chance()) {
        const double tone = 420.0 + 700.0 * chance();
        add(samples, Ring{tone, 0.25 * (0.7 - at), 0.025, at, 1.8 * tone});
    }
    return toPeak(std::move(samples), 0.65);
}

/// Air that streams past.
Samples flying() {
    Samples air = noise(5.3, 111);
    wanderingBand(air, 420.0, 900.0, 1.1, 2);
    swell(air, 0.6, 3);
    return toPower(looped(air, kSeam), 0.12);
}

/// Three even tones that everybody takes as a call to look up.
Samples warning() {
    Samples samples = silence(1.0);
    for (int k = 0; k < 3; ++k) {
        Samples tone = silence(0.2);
        add(tone, Ring{880.0, 1.0, 0.5});
        add(tone, Ring{1320.0, 0.5, 0.4});
        shape(tone, 0.01, 0.12);
        add(samples, toPeak(std::move(tone), 1.0), 0.3 * k, 1.0);
    }
    return toPeak(std::move(samples), 0.7);
}

SoundVoice once(const char* name, Samples samples, double from, double to, double softest) {
    SoundVoice voice;
    voice.name = name;
    voice.samples = std::move(samples);
    voice.from = from;
    voice.to = to;
    voice.softest = softest;
    return voice;
}

SoundVoice loop(const char* name, Samples samples, double from, double to, double slow, double fast) {
    SoundVoice voice = once(name, std::move(samples), from, to, 0.0);
    voice.continuous = true;
    voice.slow = slow;
    voice.fast = fast;
    return voice;
}

/// Of how far a strength has come from one end to the other.
double shareOf(double strength, double from, double to) {
    return std::isfinite(strength) ? std::clamp((strength - from) / (to - from), 0.0, 1.0) : 0.0;
}

} // namespace

double SoundVoice::loudness(double strength) const noexcept {
    return softest + (1.0 - softest) * shareOf(strength, from, to);
}

double SoundVoice::speed(double strength) const noexcept {
    if (steps.empty()) return slow + (fast - slow) * shareOf(strength, from, to);
    const double last = static_cast<double>(steps.size() - 1);
    return steps[static_cast<std::size_t>(last * shareOf(std::round(strength), 1.0, 1.0 + last))];
}

SoundBoard SoundBoard::synthesised() {
    std::vector<SoundVoice> voices;
    // Metres a second: a ball that crosses the tablet in a second rolls fast.
    voices.push_back(loop("labyrinth.roll", rolling(), 0.008, 0.25, 0.75, 1.35));
    voices.push_back(once("labyrinth.bump", knock(), 0.02, 0.30, 0.08));
    voices.push_back(once("labyrinth.pickup", gem(), 0.0, 1.0, 1.0));
    // Each one that was taken, a step higher on a scale of five tones.
    voices.back().steps = {1.0, 9.0 / 8.0, 5.0 / 4.0, 3.0 / 2.0, 5.0 / 3.0, 2.0, 9.0 / 4.0, 5.0 / 2.0, 3.0};
    voices.push_back(once("labyrinth.fall", falling(), 0.0, 1.0, 0.5));
    voices.push_back(once("labyrinth.goal", fanfare(), 0.0, 1.0, 0.5));
    voices.push_back(loop("ambient.rain", rain(), 0.0, 1.0, 0.95, 1.1));
    voices.push_back(loop("ambient.wind", wind(), 0.0, 1.0, 0.8, 1.25));
    voices.push_back(loop("ambient.wave", waves(), 0.0, 1.0, 0.9, 1.1));
    voices.push_back(once("ambient.thunder", thunder(), 0.0, 1.0, 0.15));
    voices.push_back(once("ice.crack", cracking(), 0.0, 1.0, 0.15));
    voices.push_back(once("ice.bump", floes(), 0.0, 1.0, 0.08));
    voices.push_back(once("ice.drip", dripping(), 0.0, 1.0, 0.3));
    voices.push_back(once("ice.splash", splashing(), 0.0, 1.0, 0.15));
    voices.push_back(once("water.drop", dripping(), 0.0, 1.0, 0.3));
    voices.push_back(once("water.splash", splashing(), 0.0, 1.0, 0.15));
    voices.push_back(once("water.harbour", fanfare(), 0.0, 1.0, 0.5));
    voices.push_back(loop("navigation.fly", flying(), 0.0, 1.0, 0.7, 1.4));
    voices.push_back(once(kHandsOffSound, warning(), 0.0, 1.0, 1.0));
    return SoundBoard(std::move(voices));
}

const SoundVoice* SoundBoard::find(std::string_view name) const noexcept {
    const auto found = std::ranges::find(voices_, name, &SoundVoice::name);
    return found == voices_.end() ? nullptr : &*found;
}

} // namespace lumorph
