#include "core/loop/prediction_gain.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <random>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/base/error.h"
#include "core/loop/viewer_stage.h"

namespace lumorph {

namespace {

constexpr double kSettle = 1.0;    ///< seconds until the filter knows the motion
constexpr double kNearly = 0.9;    ///< of the greatest speed
constexpr double kHalfWidth = 0.1; ///< metres from the middle to where slip is looked at, as on a tablet

/// Sums of waves that do not repeat while one looks.
class Hand {
public:
    explicit Hand(const CarriedDevice& carried) {
        double fastest = 0.0;
        for (double t = 0.0; t < carried.seconds; t += 0.01) fastest = std::max(fastest, speedAt(t));
        size_ *= carried.speed / fastest;
    }
    [[nodiscard]] Pose at(double t) const {
        const glm::dquat turn = glm::angleAxis(0.15 * std::sin(2.3 * t), glm::dvec3(0.0, 1.0, 0.0));
        return {size_ * glm::dvec3(std::sin(3.1 * t) + 0.45 * std::sin(4.9 * t + 1.0), 0.1 * std::sin(2.1 * t),
                                   0.5 * std::sin(2.7 * t + 0.5) + 0.2 * std::sin(5.3 * t)),
                turn};
    }
    [[nodiscard]] double speedAt(double t) const {
        constexpr double kStep = 1e-4;
        return glm::distance(at(t + kStep).position, at(t - kStep).position) / (2.0 * kStep);
    }

private:
    double size_ = 1.0;
};

Microseconds micros(double seconds) { return Microseconds(std::llround(1e6 * seconds)); }

/// The delays of a room, and nothing else of it.
std::shared_ptr<const Installation> delaysOf(const Installation& room, bool predicts) {
    auto bare = std::make_shared<Installation>();
    bare->predictionSeconds = predicts ? room.predictionSeconds : 0.0;
    bare->trackerSeconds = room.trackerSeconds;
    return bare;
}

/// Where light falls beside what it is meant for: the middle of the device and its four sides.
double squareBeside(const glm::dmat4& shown, const glm::dmat4& real) {
    double sum = 0.0;
    constexpr std::array<glm::dvec4, 5> kPlaces = {glm::dvec4(0.0, 0.0, 0.0, 1.0),
                                                   {kHalfWidth, 0.0, 0.0, 1.0},
                                                   {-kHalfWidth, 0.0, 0.0, 1.0},
                                                   {0.0, 0.0, kHalfWidth, 1.0},
                                                   {0.0, 0.0, -kHalfWidth, 1.0}};
    for (const glm::dvec4& place : kPlaces) {
        const glm::dvec3 beside(shown * place - real * place);
        sum += glm::dot(beside, beside);
    }
    return sum / double(kPlaces.size());
}

LightSlip slipOf(const Hand& hand, const Installation& truth, std::shared_ptr<const Installation> believed,
                 const CarriedDevice& carried) {
    std::mt19937 dice(carried.seed);
    std::normal_distribution<double> noise;
    const auto vector = [&](double sigma) { return sigma * glm::dvec3(noise(dice), noise(dice), noise(dice)); };
    const auto board = std::make_shared<PoseBoard>();
    const auto stream = board->stream("device", PoseRole::device);
    MatchWish wish;
    wish.installation = std::move(believed);
    wish.poses = board;
    ViewerStage stage;
    MatchFrame frame;
    double all = 0.0, fast = 0.0, count = 0.0, fastCount = 0.0, fastest = 0.0;
    for (double t = 0.0; t < carried.seconds; t += 0.01) fastest = std::max(fastest, hand.speedAt(t));
    const double step = 1.0 / carried.rate;
    std::uniform_real_distribution<double> phase(0.0, 1.0);
    for (int k = 0; k * step < carried.seconds; ++k) {
        const double stamped = k * step;
        Pose pose = hand.at(stamped - truth.trackerSeconds);
        pose.position += vector(carried.noiseMetres);
        const glm::dvec3 turn = vector(carried.noiseRadians);
        pose.rotation = glm::normalize(pose.rotation * glm::dquat(1.0, 0.5 * turn.x, 0.5 * turn.y, 0.5 * turn.z));
        stream->push({micros(stamped), true, pose});
        const double now = stamped + phase(dice) * step; // pictures and poses keep no step
        frame.time = micros(now);
        stage.look(wish, step, frame);
        if (now < kSettle) continue;
        const double seen = now + truth.predictionSeconds;
        const double square = squareBeside(glm::dmat4(frame.worldFromDevice), matrixOf(hand.at(seen)));
        all += square;
        count += 1.0;
        if (hand.speedAt(seen) < kNearly * fastest) continue;
        fast += square;
        fastCount += 1.0;
    }
    return {std::sqrt(all / std::max(count, 1.0)), std::sqrt(fast / std::max(fastCount, 1.0))};
}

} // namespace

PredictionGain predictionGain(const Installation& believed, const Installation& truth, const CarriedDevice& carried) {
    if (!(carried.speed > 0.0) || !(carried.seconds > 2.0 * kSettle) || !(carried.rate > 0.0))
        throw InvalidInput("carried device", "its speed, time or rate is no positive number", "let it move");
    const Hand hand(carried);
    return {slipOf(hand, truth, delaysOf(believed, true), carried),
            slipOf(hand, truth, delaysOf(believed, false), carried)};
}

} // namespace lumorph
