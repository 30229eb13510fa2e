#include "core/loop/pose_filter.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_access.hpp>

namespace lumorph {

namespace {

// A hand or a head: up to 2 Hz and 0.3 m/s, now and then much faster. A tracker: a few tenths of a millimetre.
constexpr MotionFilter::Noise kMoving{
    .measured = 0.25e-3, .jerk = 1.0, .lively = 3.0, .velocity = 0.3, .acceleration = 3.0};
constexpr MotionFilter::Noise kTurning{
    .measured = 2e-3, .jerk = 8.0, .lively = 0.4, .velocity = 1.5, .acceleration = 15.0};
constexpr double kRestWay = 0.6e-3;   // metres
constexpr double kRestSpeed = 0.03;   // metres a second
constexpr double kRestTurn = 5e-3;    // radians
constexpr double kRestTurning = 0.25; // radians a second

constexpr double kRestSeconds = 0.15;      // over which samples are averaged at rest
constexpr double kNoiseSeconds = 0.7;      // over which the noise of samples is averaged
constexpr double kSlowestNoise = 0.026;    // seconds between samples that tell their noise
constexpr double kMostNoise = 8.0;         // times what is expected
constexpr double kCalmSeconds = 0.12;      // in which motion is forgotten
constexpr double kFadeSeconds = 0.15;      // in which an acceleration fades
constexpr double kUsualSeconds = 0.25;     // over which the usual acceleration is averaged
constexpr double kJolt = 10.0;             // mean square off, as a multiple of what is expected
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

double restShare(double seconds) { return 1.0 - std::exp(-seconds / kRestSeconds); }

} // namespace

void MotionFilter::restart() {
    velocity_ = acceleration_ = glm::dvec3(0.0);
    usual_ = 0.0;
    covariance_ = glm::dmat3(0.0);
    covariance_[0][0] = noise_.measured * noise_.measured;
    covariance_[1][1] = noise_.velocity * noise_.velocity;
    covariance_[2][2] = noise_.acceleration * noise_.acceleration;
}

glm::dvec3 MotionFilter::wayIn(double seconds) const {
    return seconds * velocity_ + 0.5 * seconds * seconds * acceleration_;
}

glm::dvec3 MotionFilter::advance(double t) {
    const glm::dvec3 way = wayIn(t);
    const double fade = std::exp(-t / kFadeSeconds);
    usual_ += (1.0 - std::exp(-t / kUsualSeconds)) * (glm::length(acceleration_) - usual_);
    velocity_ += t * acceleration_;
    acceleration_ *= fade;
    step_ = t;
    const glm::dmat3 step(1.0, 0.0, 0.0, t, 1.0, 0.0, 0.5 * t * t, t, fade); // by columns
    const double jerk = noise_.jerk * (1.0 + noise_.lively * usual_);
    const double t2 = t * t;
    const double t3 = t2 * t;
    const glm::dmat3 wander(t3 * t2 / 20.0, t2 * t2 / 8.0, t3 / 6.0, t2 * t2 / 8.0, t3 / 3.0, t2 / 2.0, t3 / 6.0,
                            t2 / 2.0, t);
    covariance_ = step * covariance_ * glm::transpose(step) + jerk * jerk * wander;
    return way;
}

glm::dvec3 MotionFilter::correct(const glm::dvec3& off) {
    const double noise = noise_.measured * noise_.measured;
    const double square = glm::dot(off, off) / 3.0;
    if (step_ > 0.0 && square > kJolt * (covariance_[0][0] + noise)) {
        acceleration_ = glm::dvec3(0.0);
        covariance_[0][0] += square;
        covariance_[0][1] += square / step_;
        covariance_[1][0] += square / step_;
        covariance_[1][1] += square / (step_ * step_);
    }
    const glm::dvec3 gain = covariance_[0] / (covariance_[0][0] + noise);
    velocity_ += gain[1] * off;
    acceleration_ += gain[2] * off;
    covariance_ -= glm::outerProduct(gain, glm::row(covariance_, 0));
    return gain[0] * off;
}

void NoiseJudge::look(const glm::dvec3& way, double seconds) {
    if (seconds > kSlowestNoise || std::abs(seconds - seconds_) > 0.3 * seconds_) count_ = 0;
    seconds_ = seconds;
    if (count_ == 2) {
        const glm::dvec3 third = way - 2.0 * before_ + beforeThat_;
        // 1 + 9 + 9 + 1 times the variance of a sample; one that is far off is a jump, no noise.
        const double square = std::min(glm::dot(third, third) / (3.0 * 20.0), 9.0 * square_);
        const double most = kMostNoise * kMostNoise * least_ * least_;
        square_ = std::min(most, square_ + (1.0 - std::exp(-seconds / kNoiseSeconds)) * (square - square_));
    }
    beforeThat_ = before_;
    before_ = way;
    count_ = std::min(count_ + 1, 2);
}

double NoiseJudge::sigma() const { return seconds_ <= kSlowestNoise ? std::max(least_, std::sqrt(square_)) : least_; }

void RestJudge::look(double way, double speed, double seconds, double noise) {
    excess_ = std::max({way / (noise * way_), speed / (noise * speed_), excess_ * std::exp(-seconds / kCalmSeconds)});
}

double RestJudge::motion() const {
    const double share = std::clamp(0.5 * (excess_ - 1.0), 0.0, 1.0);
    return share * share * (3.0 - 2.0 * share);
}

PoseFilter::PoseFilter()
    : moving_(kMoving), moves_(kRestWay, kRestSpeed), places_(kMoving.measured), turning_(kTurning),
      turns_(kRestTurn, kRestTurning), rotations_(kTurning.measured) {}

void PoseFilter::restart(const Pose& pose) {
    moving_.restart();
    moves_.restart();
    places_.restart();
    position_ = restPosition_ = measuredPosition_ = pose.position;
    turning_.restart();
    turns_.restart();
    rotations_.restart();
    rotation_ = restRotation_ = measuredRotation_ = pose.rotation;
}

void PoseFilter::add(const Pose& pose, double seconds) {
    addPosition(pose.position, seconds);
    addRotation(pose.rotation, seconds);
}

void PoseFilter::addPosition(const glm::dvec3& measured, double seconds) {
    position_ += moving_.advance(seconds);
    const glm::dvec3 off = measured - position_;
    if (glm::length(off) > kJump + 0.5 * kMostAcceleration * seconds * seconds) {
        moving_.restart();
        moves_.restart();
        places_.restart();
        position_ = restPosition_ = measuredPosition_ = measured;
        return;
    }
    places_.look(measured - measuredPosition_, seconds);
    measuredPosition_ = measured;
    moving_.setMeasured(places_.sigma());
    position_ += moving_.correct(off);
    restPosition_ += restShare(seconds) * (measured - restPosition_);
    moves_.look(glm::distance(position_, restPosition_), glm::length(moving_.velocity()), seconds, places_.excess());
}

void PoseFilter::addRotation(const glm::dquat& measured, double seconds) {
    rotation_ = turned(turning_.advance(seconds), rotation_);
    const glm::dvec3 off = turnBetween(rotation_, measured);
    if (glm::length(off) > kJumpTurn + 0.5 * kMostTurning * seconds * seconds) {
        turning_.restart();
        turns_.restart();
        rotations_.restart();
        rotation_ = restRotation_ = measuredRotation_ = measured;
        return;
    }
    rotations_.look(turnBetween(measuredRotation_, measured), seconds);
    measuredRotation_ = measured;
    turning_.setMeasured(rotations_.sigma());
    rotation_ = turned(turning_.correct(off), rotation_);
    restRotation_ = turned(restShare(seconds) * turnBetween(restRotation_, measured), restRotation_);
    turns_.look(glm::length(turnBetween(restRotation_, rotation_)), glm::length(turning_.velocity()), seconds,
                rotations_.excess());
}

Pose PoseFilter::at(double seconds) const {
    const glm::dvec3 moved = position_ + moving_.wayIn(seconds);
    const glm::dquat turnedTo = turned(turning_.wayIn(seconds), rotation_);
    return {glm::mix(restPosition_, moved, moves_.motion()),
            turned(turns_.motion() * turnBetween(restRotation_, turnedTo), restRotation_)};
}

} // namespace lumorph
