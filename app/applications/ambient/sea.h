#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>

#include "core/scene/scene.h"

namespace lumorph::ambient {

/// What drives the waves.
struct SeaState {
    double wind = 0.0;            ///< metres a second
    glm::dvec2 towards{1.0, 0.0}; ///< where it blows to, in x and z of the device; length 1
    bool operator==(const SeaState&) const = default;
};

/// Waves as wind makes them, small enough for a tablet: travelling sines of fixed lengths whose amplitudes share out
/// the energy of a JONSWAP spectrum (Hasselmann et al. 1973). More wind makes them higher, longer and slower; they
/// travel with it, each a little aside. Their phases go on whatever the wind does.
class Sea {
public:
    static constexpr int kWaves = 20;
    static constexpr double kMostHeight = 0.027;  ///< significant height in a storm, metres
    static constexpr double kServoLength = 0.105; ///< waves from here on are for servos too, metres

    explicit Sea(std::uint64_t seed);

    /// All of them as they stand at a moment, each a sine that rests (Wave::period 0).
    [[nodiscard]] std::vector<Wave> waves(const SeaState& state, double seconds) const;
    /// The long ones so much ahead of their time, and so much higher, that who follows them through two equal
    /// low-passes of half the lag each (CausalSplit) shows them as they are at the moment.
    [[nodiscard]] std::vector<Wave> slowWaves(const SeaState& state, double seconds, double lag) const;

    [[nodiscard]] static double significantHeight(double wind) noexcept; ///< metres
    [[nodiscard]] static double peakLength(double wind) noexcept;        ///< metres
    [[nodiscard]] static double periodOf(double length) noexcept;        ///< seconds

private:
    struct Component {
        double length, period; ///< metres, seconds
        double band;           ///< Hz for which it stands
        double aside, phase;   ///< radians
    };
    [[nodiscard]] std::vector<double> amplitudes(const SeaState& state) const;
    [[nodiscard]] static Wave waveOf(const Component& component, const SeaState& state, double amplitude,
                                     double seconds);

    std::vector<Component> components_; ///< the longest first
};

/// The height of resting sines at a place, metres.
[[nodiscard]] double heightOf(const std::vector<Wave>& waves, const glm::dvec2& place) noexcept;

} // namespace lumorph::ambient
