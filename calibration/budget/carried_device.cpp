#include "calibration/budget/carried_device.h"

#include <cmath>
#include <random>

#include <glm/gtc/quaternion.hpp>

#include "core/base/error.h"
#include "core/loop/pose_stream.h"

namespace lumorph {
namespace {

constexpr double kSettles = 2.0, kFollowed = 40.0; // seconds: at rest errors last nearly one
constexpr double kPhase = 0.5;                     // of the time between two samples: when a frame asks, in the mean

glm::dvec3 placeAt(const CarryingHand& hand, double seconds) {
    const double angle = hand.speed / hand.radius * seconds;
    return hand.radius * glm::dvec3(std::cos(angle), 0.0, std::sin(angle));
}

Eigen::Vector3d spaceVector(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

/// Radians about the axes.
glm::dvec3 turnOf(glm::dquat q) {
    if (q.w < 0.0) q = -q;
    return 2.0 * glm::dvec3(q.x, q.y, q.z); // of small ones
}

} // namespace

PoseMoments predictionLeaves(const CarryingHand& hand, const PoseError& noise, double ahead, std::uint32_t seed) {
    if (!(hand.speed >= 0.0) || !(hand.speed <= 10.0) || !(hand.radius > 0.0) || !(hand.samplesASecond >= 1.0))
        throw InvalidInput("hand that carries the device", "its speed is not from 0 to 10 m/s, or its circle is none",
                           "give another speed");
    std::mt19937 engine(seed);
    std::normal_distribution<double> normal;
    const auto dice = [&](double sigma) {
        const double x = normal(engine), y = normal(engine), z = normal(engine);
        return sigma * glm::dvec3(x, y, z);
    };
    PoseStream stream;
    PoseMoments moments;
    double count = 0.0;
    const double step = 1.0 / hand.samplesASecond;
    const auto clock = [](double seconds) { return Microseconds(std::llround(1e6 * seconds)); };
    for (int k = 0; k * step < kSettles + kFollowed; ++k) {
        const double now = k * step;
        const glm::dvec3 tilt = dice(noise.radians);
        const glm::dquat turn = glm::normalize(glm::dquat(1.0, 0.5 * tilt.x, 0.5 * tilt.y, 0.5 * tilt.z));
        stream.push({clock(now), true, {placeAt(hand, now) + dice(noise.metres), turn}});
        if (now < kSettles) continue;
        const double asked = now + kPhase * step, then = asked + ahead;
        const std::optional<Pose> told = stream.at(clock(then), clock(asked));
        if (!told) continue;
        const Eigen::Vector3d off = spaceVector(told->position - placeAt(hand, then));
        const Eigen::Vector3d turned = spaceVector(turnOf(told->rotation));
        moments.place += off * off.transpose();
        moments.turn += turned * turned.transpose();
        count += 1.0;
    }
    moments.place /= count;
    moments.turn /= count;
    return moments;
}

} // namespace lumorph
