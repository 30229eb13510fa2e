#include "app/sound/synthesis.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace lumorph {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kPeriod = 1.0 / kSoundRate;

std::size_t countOf(double seconds) { return static_cast<std::size_t>(std::lround(seconds * kSoundRate)); }

/// The usual second-order section (R. Bristow-Johnson's formulas), normalised by a0.
class Biquad {
public:
    enum class Kind { low, high, band };

    Biquad(Kind kind, double frequency, double quality) { tune(kind, frequency, quality); }
    void tune(Kind kind, double frequency, double quality) {
        const double w = kTurn * frequency * kPeriod;
        const double c = std::cos(w), alpha = std::sin(w) / (2.0 * quality), a0 = 1.0 + alpha;
        a1_ = -2.0 * c / a0;
        a2_ = (1.0 - alpha) / a0;
        const double edge = kind == Kind::low ? (1.0 - c) / 2.0 : (1.0 + c) / 2.0;
        b0_ = (kind == Kind::band ? alpha : edge) / a0;
        b1_ = (kind == Kind::band ? 0.0 : kind == Kind::low ? 1.0 - c : -(1.0 + c)) / a0;
        b2_ = (kind == Kind::band ? -alpha : edge) / a0;
    }
    double operator()(double x) noexcept {
        const double y = b0_ * x + s1_;
        s1_ = b1_ * x - a1_ * y + s2_;
        s2_ = b2_ * x - a2_ * y;
        return y;
    }

private:
    double b0_ = 0.0, b1_ = 0.0, b2_ = 0.0, a1_ = 0.0, a2_ = 0.0;
    double s1_ = 0.0, s2_ = 0.0;
};

void filter(Samples& samples, Biquad section) {
    for (float& sample : samples) sample = static_cast<float>(section(static_cast<double>(sample)));
}

/// 0 to 1 and back, `times` over the length.
double wave(std::size_t at, std::size_t count, int times) {
    return 0.5 - 0.5 * std::cos(kTurn * times * static_cast<double>(at) / static_cast<double>(count));
}

Samples scaled(Samples samples, double by) {
    for (float& sample : samples) sample = static_cast<float>(by * static_cast<double>(sample));
    return samples;
}

} // namespace

Samples silence(double seconds) { return Samples(countOf(seconds), 0.0F); }

void add(Samples& samples, const Ring& ring) {
    const double glide = ring.to > 0.0 ? ring.to - ring.frequency : 0.0;
    const double end = ring.frequency + glide;
    double phase = 0.0;
    const std::size_t begin = countOf(ring.at);
    for (std::size_t k = begin; k < samples.size(); ++k) {
        const double fading = std::exp(-static_cast<double>(k - begin) * kPeriod / ring.decay);
        samples[k] += static_cast<float>(ring.amplitude * fading * std::sin(phase));
        phase += kTurn * (end - glide * fading) * kPeriod;
    }
}

void add(Samples& samples, std::span<const Ring> rings) {
    for (const Ring& ring : rings) add(samples, ring);
}

void add(Samples& samples, const Samples& other, double at, double amplitude) {
    const std::size_t begin = std::min(countOf(at), samples.size());
    const std::size_t count = std::min(other.size(), samples.size() - begin);
    for (std::size_t k = 0; k < count; ++k) samples[begin + k] += static_cast<float>(amplitude) * other[k];
}

Samples noise(double seconds, std::uint32_t seed) {
    std::mt19937 random(seed);
    Samples samples(countOf(seconds));
    for (float& sample : samples) sample = static_cast<float>(static_cast<double>(random()) * 0x1p-31 - 1.0);
    return samples;
}

void lowPass(Samples& samples, double frequency, double quality) {
    filter(samples, Biquad(Biquad::Kind::low, frequency, quality));
}

void highPass(Samples& samples, double frequency, double quality) {
    filter(samples, Biquad(Biquad::Kind::high, frequency, quality));
}

void bandPass(Samples& samples, double frequency, double quality) {
    filter(samples, Biquad(Biquad::Kind::band, frequency, quality));
}

void wanderingBand(Samples& samples, double low, double high, double quality, int times) {
    constexpr std::size_t kTuned = 64; // samples between two tunings
    Biquad section(Biquad::Kind::band, low, quality);
    for (std::size_t k = 0; k < samples.size(); ++k) {
        if (k % kTuned == 0) {
            const double share = wave(k, samples.size(), times);
            section.tune(Biquad::Kind::band, low * std::pow(high / low, share), quality);
        }
        samples[k] = static_cast<float>(section(static_cast<double>(samples[k])));
    }
}

void shape(Samples& samples, double attack, double decay) {
    for (std::size_t k = 0; k < samples.size(); ++k) {
        const double t = static_cast<double>(k) * kPeriod;
        const double level = t < attack ? t / attack : std::exp(-(t - attack) / decay);
        samples[k] = static_cast<float>(level * static_cast<double>(samples[k]));
    }
}

void swell(Samples& samples, double least, int times) {
    for (std::size_t k = 0; k < samples.size(); ++k) {
        const double level = least + (1.0 - least) * wave(k, samples.size(), times);
        samples[k] = static_cast<float>(level * static_cast<double>(samples[k]));
    }
}

Samples looped(const Samples& samples, double fade) {
    const std::size_t under = std::min(countOf(fade), samples.size() / 2);
    Samples loop(samples.begin(), samples.end() - static_cast<std::ptrdiff_t>(under));
    for (std::size_t k = 0; k < under; ++k) {
        // Parts of noise that know nothing of each other: their powers add up.
        const double share = static_cast<double>(k) / static_cast<double>(under);
        loop[k] = static_cast<float>(std::sqrt(share) * static_cast<double>(loop[k]) +
                                     std::sqrt(1.0 - share) * static_cast<double>(samples[loop.size() + k]));
    }
    return loop;
}

Samples toPeak(Samples samples, double peak) {
    const std::size_t fade = std::min(countOf(0.005), samples.size());
    for (std::size_t k = 0; k < fade; ++k)
        samples[samples.size() - 1 - k] *= static_cast<float>(k) / static_cast<float>(fade);
    float loudest = 0.0F;
    for (const float sample : samples) loudest = std::max(loudest, std::abs(sample));
    return loudest > 0.0F ? scaled(std::move(samples), peak / static_cast<double>(loudest)) : samples;
}

Samples toPower(Samples samples, double rms) {
    double power = 0.0;
    for (const float sample : samples) power += static_cast<double>(sample) * static_cast<double>(sample);
    if (power == 0.0) return samples;
    const double mean = std::sqrt(power / static_cast<double>(samples.size()));
    return scaled(std::move(samples), rms / mean);
}

} // namespace lumorph
