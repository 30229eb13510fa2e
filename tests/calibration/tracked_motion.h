#pragma once

#include <array>
#include <cmath>
#include <fstream>
#include <functional>
#include <random>
#include <sstream>
#include <string>

#include <glm/geometric.hpp>

#include "calibration/registration/pose_track.h"

/// Tracked bodies with known truth.
namespace lumorph::test {

/// A hand that moves and turns a body about, in its world: sums of slow waves by seed. `turns` scales the turn about
/// each of the world's axes.
class HandMotion {
public:
    explicit HandMotion(unsigned seed, glm::dvec3 turns = glm::dvec3(0.6)) : turns_(turns) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> phase(0.0, 6.28), speed(0.5, 2.2);
        for (auto& wave : waves_) wave = {phase(random), speed(random)};
    }
    [[nodiscard]] Pose at(double seconds) const {
        const auto wave = [&](std::size_t i) {
            return std::sin(waves_[i][0] + waves_[i][1] * seconds) + 0.5 * std::sin(1.7 * waves_[i][1] * seconds);
        };
        const glm::dvec3 turn = turns_ * glm::dvec3(wave(0), wave(1), wave(2));
        return {{0.3 * wave(3), 1.2 + 0.2 * wave(4), 0.25 * wave(5)},
                rotationOfTurn({0.0, turn.y, 0.0}) * rotationOfTurn({turn.x, 0.0, 0.0}) *
                    rotationOfTurn({0.0, 0.0, turn.z})};
    }

private:
    glm::dvec3 turns_;
    std::array<std::array<double, 2>, 6> waves_{};
};

/// A tracker's normal noise, of each axis.
struct TrackerNoise {
    double metres = 0.001, radians = 0.2 * 3.14159265358979 / 180.0;
};

/// Poses of `motion` from time 0 on.
inline PoseTrack trackOf(const std::function<Pose(double)>& motion, double seconds, double rate, unsigned seed,
                         TrackerNoise noise = {}) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    const auto vector = [&] { return glm::dvec3(normal(random), normal(random), normal(random)); };
    PoseTrack track;
    for (double t = 0.0; t < seconds; t += 1.0 / rate) {
        Pose pose = motion(t);
        pose.position += noise.metres * vector();
        pose.rotation = pose.rotation * rotationOfTurn(noise.radians * vector());
        track.poses.push_back({t, pose});
    }
    return track;
}

inline std::string textOfFile(const std::string& path) {
    std::ifstream file(path);
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
}

} // namespace lumorph::test
