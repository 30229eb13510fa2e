#include "app/applications/ambient/sea.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace lumorph::ambient {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kLongest = 0.62, kShortest = 0.017; ///< metres
/// Seconds of a wave one metre long. Deep water would have 0.8; a servo and an eye want them slower, as those of a sea
/// fifty times as large.
constexpr double kPeriodOfAMetre = 5.6;
constexpr double kHeightByWind = 0.00145; ///< significant height for each metre a second of wind, metres
constexpr double kPeakedness = 3.3;       ///< gamma of JONSWAP

/// JONSWAP without its factor.
double spectrum(double frequency, double peak) {
    const double ratio = peak / frequency;
    const double width = frequency <= peak ? 0.07 : 0.09;
    const double off = (frequency / peak - 1.0) / width;
    return std::pow(frequency, -5.0) * std::exp(-1.25 * std::pow(ratio, 4.0)) *
           std::pow(kPeakedness, std::exp(-0.5 * off * off));
}

} // namespace

Sea::Sea(std::uint64_t seed) {
    std::mt19937_64 engine(seed);
    const auto share = [&] { return static_cast<double>(engine() >> 11U) * 0x1p-53; };
    const double ratio = std::pow(kShortest / kLongest, 1.0 / (kWaves - 1));
    for (int k = 0; k < kWaves; ++k) {
        // Off the even steps, so that no pattern comes again.
        const double length = kLongest * std::pow(ratio, k + 0.4 * (share() - 0.5));
        const double side = (k % 2 == 0 ? 1.0 : -1.0);
        const double spread = 0.2 + 0.5 * static_cast<double>(k) / kWaves; // short ones go more ways
        components_.push_back({length, periodOf(length), 0.0, side * spread * (0.3 + 0.9 * share()), kTurn * share()});
    }
    for (std::size_t k = 0; k < components_.size(); ++k) {
        const auto frequency = [&](std::size_t i) { return 1.0 / components_[i].period; };
        const double below = k > 0 ? frequency(k - 1) : frequency(0);
        const double above = k + 1 < components_.size() ? frequency(k + 1) : frequency(k);
        components_[k].band = 0.5 * (above - below);
    }
}

double Sea::periodOf(double length) noexcept { return kPeriodOfAMetre * std::sqrt(length); }

double Sea::significantHeight(double wind) noexcept {
    const double height = kHeightByWind * std::max(wind, 0.0) + 0.0009;
    return kMostHeight * std::tanh(height / kMostHeight);
}

double Sea::peakLength(double wind) noexcept { return std::clamp(0.055 + 0.021 * wind, 0.055, 0.42); }

std::vector<double> Sea::amplitudes(const SeaState& state) const {
    const double peak = 1.0 / periodOf(peakLength(state.wind));
    std::vector<double> variances;
    double sum = 0.0;
    for (const Component& component : components_) {
        variances.push_back(spectrum(1.0 / component.period, peak) * component.band);
        sum += variances.back();
    }
    // The significant height is four standard deviations of the surface.
    const double deviation = 0.25 * significantHeight(state.wind);
    for (double& variance : variances) variance = deviation * std::sqrt(2.0 * variance / sum);
    return variances;
}

Wave Sea::waveOf(const Component& component, const SeaState& state, double amplitude, double seconds) {
    const double direction = std::atan2(state.towards.y, state.towards.x) + component.aside;
    const double phase = component.phase - kTurn * std::fmod(seconds / component.period, 1.0);
    return {amplitude, component.length, 0.0, Angle::radians(direction), Angle::radians(phase)};
}

std::vector<Wave> Sea::waves(const SeaState& state, double seconds) const {
    const std::vector<double> heights = amplitudes(state);
    std::vector<Wave> waves;
    for (std::size_t k = 0; k < components_.size(); ++k)
        waves.push_back(waveOf(components_[k], state, heights[k], seconds));
    return waves;
}

std::vector<Wave> Sea::slowWaves(const SeaState& state, double seconds, double lag) const {
    const std::vector<double> heights = amplitudes(state);
    std::vector<Wave> waves;
    for (std::size_t k = 0; k < components_.size() && components_[k].length >= kServoLength; ++k) {
        const double turn = kTurn / components_[k].period * 0.5 * lag; // of one low-pass
        const double ahead = lag > 0.0 ? lag * std::atan(turn) / turn : 0.0;
        waves.push_back(waveOf(components_[k], state, heights[k] * (1.0 + turn * turn), seconds + ahead));
    }
    return waves;
}

double heightOf(const std::vector<Wave>& waves, const glm::dvec2& place) noexcept {
    double height = 0.0;
    for (const Wave& wave : waves) {
        const double along =
            place.x * std::cos(wave.direction.inRadians()) + place.y * std::sin(wave.direction.inRadians());
        height += wave.amplitude * std::sin(kTurn * along / wave.length + wave.phase.inRadians());
    }
    return height;
}

} // namespace lumorph::ambient
