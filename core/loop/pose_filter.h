#pragma once

#include <array>
#include <cstddef>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/loop/motion_predictor.h"
#include "core/loop/pose_stream.h"

namespace lumorph {

/// How noisy samples are: by what a polynomial of the fourth degree leaves of six of them, at any times. No motion of a
/// hand is left at 20 samples a second and more. A filter that trusts a noisy tracker too much swings when it looks
/// ahead.
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
    struct Earlier {
        double seconds = 0.0;  ///< before the newest sample
        glm::dvec3 place{0.0}; ///< from the newest
    };
    /// Variance per axis that the six samples speak for.
    [[nodiscard]] double leftSquare() const;

    double least_, square_;
    std::array<Earlier, 6> samples_{}; ///< the newest first
    std::size_t count_ = 0;            ///< of samples that count, less the first
    bool slow_ = false;
};

/// Tells rest from motion, so that a thing at rest is still: its samples are averaged for long, and nothing is
/// predicted.
class RestJudge {
public:
    /// Ways below `way` and speeds below `speed` are noise; it is wholly in motion at three times as much.
    RestJudge(double way, double speed) : way_(way), speed_(speed) {}
    void restart() { excess_ = rested_ = 0.0; }
    /// `way` from where it rested, `speed` as the predictor has it; samples are `noise` times noisier than
    /// expected, and so are both.
    void look(double way, double speed, double seconds, double noise);
    /// 0 at rest, 1 in motion.
    [[nodiscard]] double motion() const;
    /// By how much the mean of a thing at rest follows a sample: the less, the longer it has rested.
    [[nodiscard]] double share(double seconds) const;

private:
    double way_;
    double speed_;
    double excess_ = 0.0; ///< 1 where noise ends
    double rested_ = 0.0; ///< seconds
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
    void restartPosition(const glm::dvec3& measured);
    void restartRotation(const glm::dquat& measured);
    void addPosition(const glm::dvec3& measured, const HandSteps& passed);
    void addRotation(const glm::dquat& measured, const HandSteps& passed);
    /// At that place in the sum of all turns.
    [[nodiscard]] glm::dquat rotationAt(const glm::dvec3& turnSum) const;

    MotionPredictor moving_;
    RestJudge moves_;
    NoiseJudge places_;
    glm::dvec3 measuredPosition_{0.0};
    glm::dvec3 restPosition_{0.0};
    MotionPredictor turning_; ///< of the sum of all turns from sample to sample, rotation vectors in `world`
    RestJudge turns_;
    NoiseJudge rotations_;
    glm::dquat measuredRotation_{1.0, 0.0, 0.0, 0.0};
    glm::dvec3 turnSum_{0.0}; ///< of `measuredRotation_`
    glm::dquat restRotation_{1.0, 0.0, 0.0, 0.0};
};

} // namespace lumorph
