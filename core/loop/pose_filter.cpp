#include "core/loop/pose_filter.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace lumorph {

namespace {

constexpr double kPlaceNoise = 0.25e-3; // metres, of a good tracker
constexpr double kTurnNoise = 2e-3;     // radians, likewise
constexpr double kTurnUnit = 6.0;       // radians that a hand turns while it moves by a metre
constexpr double kRestWay = 0.44e-3;    // metres
constexpr double kRestSpeed = 0.015;    // metres a second
constexpr double kRestTurn = 3e-3;      // radians
constexpr double kRestTurning = 0.1;    // radians a second

constexpr double kRestSeconds = 0.15;      // over which samples are averaged at rest
constexpr double kLongRest = 0.7;          // likewise, of what has rested for as long
constexpr double kNoiseSeconds = 0.7;      // over which the noise of samples is averaged
constexpr double kSlowestNoise = 0.055;    // seconds between samples that tell their noise
constexpr double kMostNoise = 8.0;         // times what is expected
constexpr double kCalmSeconds = 0.2;       // in which motion is forgotten
constexpr double kJump = 0.02;             // metres that no motion makes between two samples
constexpr double kJumpTurn = 0.5;          // radians, likewise
constexpr double kMostAcceleration = 30.0; // metres a second squared
constexpr double kMostTurning = 300.0;     // radians a second squared

glm::dvec3 turnBetween(const glm::dquat& from, const glm::dquat& to) {
    glm::dquat way = to * glm::conjugate(from);
    if (way.w < 0.0) way = -way;
    const glm::dvec3 axis(way.x, way.y, way.z);
    const double sine = glm::length(axis);
    return sine > 1e-12 ? axis * (2.0 * std::atan2(sine, way.w) / sine) : 2.0 * axis;
}

glm::dquat turned(const glm::dvec3& turn, const glm::dquat& rotation) {
    const double angle = glm::length(turn);
    if (!(angle > 0.0)) return rotation;
    return glm::normalize(glm::angleAxis(angle, turn / angle) * rotation);
}

} // namespace

double NoiseJudge::leftSquare() const {
    // Divided difference: weights 1 / product of (t_i - t_j).
    double squares = 0.0;
    glm::dvec3 left(0.0);
    for (const Earlier& sample : samples_) {
        double weight = 1.0;
        for (const Earlier& other : samples_)
            if (&other != &sample) weight *= samples_.back().seconds / (sample.seconds - other.seconds);
        left += weight * sample.place;
        squares += weight * weight;
    }
    return glm::dot(left, left) / (3.0 * squares);
}

void NoiseJudge::look(const glm::dvec3& way, double seconds) {
    for (Earlier& sample : samples_) {
        sample.seconds += seconds;
        sample.place -= way;
    }
    std::rotate(samples_.begin(), samples_.end() - 1, samples_.end());
    samples_[0] = {};
    count_ = std::min(count_ + 1, samples_.size());
    slow_ = seconds > kSlowestNoise;
    if (count_ < samples_.size() || samples_.back().seconds > 5.0 * kSlowestNoise) return;
    const double square = std::min(leftSquare(), 9.0 * square_); // one that is far off is a jump, no noise
    const double most = kMostNoise * kMostNoise * least_ * least_;
    square_ = std::min(most, square_ + (1.0 - std::exp(-seconds / kNoiseSeconds)) * (square - square_));
}

double NoiseJudge::sigma() const { return slow_ ? least_ : std::max(least_, std::sqrt(square_)); }

void RestJudge::look(double way, double speed, double seconds, double noise) {
    excess_ = std::max({way / (noise * way_), speed / (noise * speed_), excess_ * std::exp(-seconds / kCalmSeconds)});
    rested_ = excess_ > 1.0 ? 0.0 : rested_ + seconds;
}

double RestJudge::motion() const {
    const double share = std::clamp(0.5 * (excess_ - 1.0), 0.0, 1.0);
    return share * share * (3.0 - 2.0 * share);
}

double RestJudge::share(double seconds) const {
    return 1.0 - std::exp(-seconds / std::clamp(rested_, kRestSeconds, kLongRest));
}

PoseFilter::PoseFilter()
    : moving_(kPlaceNoise, 1.0), moves_(kRestWay, kRestSpeed), places_(kPlaceNoise), turning_(kTurnNoise, kTurnUnit),
      turns_(kRestTurn, kRestTurning), rotations_(kTurnNoise) {}

void PoseFilter::restart(const Pose& pose) {
    restartPosition(pose.position);
    restartRotation(pose.rotation);
}

void PoseFilter::restartPosition(const glm::dvec3& measured) {
    moving_.restart(measured);
    moves_.restart();
    places_.restart();
    restPosition_ = measuredPosition_ = measured;
}

void PoseFilter::restartRotation(const glm::dquat& measured) {
    turnSum_ = glm::dvec3(0.0);
    turning_.restart(turnSum_);
    turns_.restart();
    rotations_.restart();
    restRotation_ = measuredRotation_ = measured;
}

void PoseFilter::add(const Pose& pose, double seconds) {
    const HandSteps passed = handStepsOf(seconds);
    addPosition(pose.position, passed);
    addRotation(pose.rotation, passed);
}

void PoseFilter::addPosition(const glm::dvec3& measured, const HandSteps& passed) {
    const double seconds = passed.seconds;
    const double off = glm::distance(measured, moving_.after(passed));
    if (off > kJump + 0.5 * kMostAcceleration * seconds * seconds) return restartPosition(measured);
    places_.look(measured - measuredPosition_, seconds);
    measuredPosition_ = measured;
    moving_.setMeasured(places_.sigma());
    moving_.add(measured, passed);
    restPosition_ += moves_.share(seconds) * (measured - restPosition_);
    moves_.look(glm::distance(moving_.before(0.0), restPosition_), glm::length(moving_.velocity()), seconds,
                places_.excess());
}

void PoseFilter::addRotation(const glm::dquat& measured, const HandSteps& passed) {
    const double seconds = passed.seconds;
    const glm::dvec3 turn = turnBetween(measuredRotation_, measured);
    const double off = glm::distance(turnSum_ + turn, turning_.after(passed));
    if (off > kJumpTurn + 0.5 * kMostTurning * seconds * seconds) return restartRotation(measured);
    rotations_.look(turn, seconds);
    measuredRotation_ = measured;
    turnSum_ += turn;
    turning_.setMeasured(rotations_.sigma());
    turning_.add(turnSum_, passed);
    restRotation_ = turned(turns_.share(seconds) * turnBetween(restRotation_, measured), restRotation_);
    turns_.look(glm::length(turnBetween(restRotation_, rotationAt(turning_.before(0.0)))),
                glm::length(turning_.velocity()), seconds, rotations_.excess());
}

glm::dquat PoseFilter::rotationAt(const glm::dvec3& turnSum) const {
    return turned(turnSum - turnSum_, measuredRotation_);
}

Pose PoseFilter::at(double seconds) const {
    const bool ahead = seconds > 0.0;
    const HandSteps steps = ahead ? handStepsOf(seconds) : HandSteps();
    const glm::dvec3 place = ahead ? moving_.after(steps) : moving_.before(-seconds);
    const glm::dquat rotation = rotationAt(ahead ? turning_.after(steps) : turning_.before(-seconds));
    return {glm::mix(restPosition_, place, moves_.motion()),
            turned(turns_.motion() * turnBetween(restRotation_, rotation), restRotation_)};
}

} // namespace lumorph
