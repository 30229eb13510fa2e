#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "core/loop/pose_stream.h"

namespace lumorph {

/// Kalman filter of a point in space whose acceleration wanders and fades: the more, the livelier it has been of late.
/// Its state is where it is, seen from where it was thought to be, its velocity and its acceleration. The same for each
/// of the three axes. A jolt that the state cannot explain opens the velocity, so that it is found again at once.
class MotionFilter {
public:
    struct Noise {
        double measured = 0.0; ///< standard deviation of a sample, per axis
        double jerk = 0.0;     ///< square root of its spectral density, of slow motion
        double lively = 0.0;   ///< by how much the jerk grows with each unit of acceleration, as a share
        double velocity = 0.0; ///< what is expected of a thing just found, standard deviation
        double acceleration = 0.0;
    };
    explicit MotionFilter(const Noise& noise) : noise_(noise) { restart(); }
    /// Samples are noisier than was thought, or less: their standard deviation per axis.
    void setMeasured(double sigma) noexcept { noise_.measured = sigma; }

    /// It has just been found, and nothing is known of its motion.
    void restart();
    /// Time passes; gives the way made meanwhile.
    glm::dvec3 advance(double seconds);
    /// It was measured `off` from where it was thought to be; gives the way that it is put right by.
    glm::dvec3 correct(const glm::dvec3& off);

    /// Way from now to `seconds` later.
    [[nodiscard]] glm::dvec3 wayIn(double seconds) const;
    [[nodiscard]] const glm::dvec3& velocity() const noexcept { return velocity_; }

private:
    Noise noise_;
    glm::dvec3 velocity_{0.0};
    glm::dvec3 acceleration_{0.0};
    glm::dmat3 covariance_{0.0}; ///< of place, velocity and acceleration along one axis
    double usual_ = 0.0;         ///< length of the acceleration of late
    double step_ = 0.0;          ///< seconds of the last advance
};

/// How noisy samples are: by their third differences, in which no motion of a hand is left at 40 samples a second and
/// more. A filter that trusts a noisy tracker too much swings when it looks ahead.
class NoiseJudge {
public:
    /// Never less than `least`, which is also what slower samples are taken to have.
    explicit NoiseJudge(double least) : least_(least), square_(least * least) {}
    /// Nothing before counts, but for the noise.
    void restart() noexcept { count_ = 0; }
    /// The way from the sample before, which was so many seconds earlier.
    void look(const glm::dvec3& way, double seconds);
    /// Standard deviation per axis.
    [[nodiscard]] double sigma() const;
    /// How many times noisier samples are than was expected, 1 and more.
    [[nodiscard]] double excess() const { return sigma() / least_; }

private:
    double least_, square_;
    glm::dvec3 before_{0.0}, beforeThat_{0.0}; ///< ways
    double seconds_ = 0.0;                     ///< of the last
    int count_ = 0;                            ///< of ways in even times, at most 2
};

/// Tells rest from motion, so that a thing at rest is still: its samples are averaged for long, and nothing is
/// predicted.
class RestJudge {
public:
    /// Ways below `way` and speeds below `speed` are noise; it is wholly in motion at three times as much.
    RestJudge(double way, double speed) : way_(way), speed_(speed) {}
    void restart() { excess_ = 0.0; }
    /// `way` from where it rested, `speed` as the motion filter has it; samples are `noise` times noisier than
    /// expected, and so are both.
    void look(double way, double speed, double seconds, double noise);
    /// 0 at rest, 1 in motion.
    [[nodiscard]] double motion() const;

private:
    double way_;
    double speed_;
    double excess_ = 0.0; ///< 1 where noise ends
};

/// The filter behind a PoseStream.
class PoseFilter {
public:
    PoseFilter();
    /// Takes the first pose, or one after which nothing before counts.
    void restart(const Pose& pose);
    /// A pose measured `seconds` after the last. One that cannot be reached by moving restarts what it concerns.
    void add(const Pose& pose, double seconds);
    /// `seconds` after the last sample; negative: before it.
    [[nodiscard]] Pose at(double seconds) const;

private:
    void addPosition(const glm::dvec3& measured, double seconds);
    void addRotation(const glm::dquat& measured, double seconds);

    MotionFilter moving_;
    RestJudge moves_;
    NoiseJudge places_;
    glm::dvec3 measuredPosition_{0.0};
    glm::dvec3 position_{0.0};
    glm::dvec3 restPosition_{0.0};
    MotionFilter turning_;
    RestJudge turns_;
    NoiseJudge rotations_;
    glm::dquat measuredRotation_{1.0, 0.0, 0.0, 0.0};
    glm::dquat rotation_{1.0, 0.0, 0.0, 0.0};
    glm::dquat restRotation_{1.0, 0.0, 0.0, 0.0};
};

} // namespace lumorph
