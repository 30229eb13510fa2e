#pragma once

#include <array>
#include <cstddef>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace lumorph {

/// One way in which a hand moves: a point that a spring draws to its middle of late and whose velocity fades, driven
/// by white noise. The fourth derivative of its way from the middle is -(poles) + noise, with two pairs of poles.
struct HandModel {
    double fast = 0.0, fastDamping = 0.0; ///< natural frequency, radians a second, and damping ratio of the first pair
    double slow = 0.0, slowDamping = 0.0; ///< of the second; a damping below 1 is a hand that goes to and fro
    double drive = 0.0;                   ///< square root of the spectral density of the noise, metres / s^3.5
};

/// Of a step in time, for the state (way from the middle, velocity, acceleration, jerk) along one axis.
struct HandStep {
    glm::dmat4 transition{1.0};
    glm::dmat4 wander{0.0}; ///< covariance that unit noise adds
};
/// Of each way in which hands move. Takes some microseconds.
struct HandSteps {
    static constexpr std::size_t kModels = 4;
    double seconds = 0.0;
    std::array<HandStep, kModels> steps;
};
/// Of so many seconds, 0 and more.
[[nodiscard]] HandSteps handStepsOf(double seconds);

/// Kalman filter of a point in space that moves as a model has it; the same for each of the three axes. A jolt that the
/// state cannot explain opens the velocity, so that it is found again at once.
class MotionFilter {
public:
    /// The same units as the drive of its model.
    void restart(const glm::dvec3& place, double measured, double unit);
    /// Time passes; `drive` is that of its model.
    void advance(const HandStep& step, double drive, double seconds);
    void correct(const glm::dvec3& place, double measured);

    /// Where it is after a time of which this is the transition.
    [[nodiscard]] glm::dvec3 after(const glm::dmat4& transition) const;
    /// Where it was `seconds` ago.
    [[nodiscard]] glm::dvec3 before(double seconds) const;
    [[nodiscard]] const glm::dvec3& velocity() const noexcept { return state_[1]; }

private:
    glm::dvec3 middle_{0.0};            ///< where it has been of late, on average
    std::array<glm::dvec3, 4> state_{}; ///< way from the middle and its derivatives
    glm::dmat4 covariance_{0.0};        ///< along one axis
    double step_ = 0.0;                 ///< seconds of the last advance
};

/// Predicts the motion of a point from noisy samples at any times: a bank of Kalman filters, one for each way in which
/// hands move and each liveliness. What is predicted is their mean, weighted by how well each has predicted of late.
/// Takes some microseconds a sample.
class MotionPredictor {
public:
    /// Standard deviation of a sample per axis; `unit` is what a metre of a hand's way corresponds to, 1 for metres.
    MotionPredictor(double measured, double unit);

    /// It has just been found there, and nothing is known of its motion.
    void restart(const glm::dvec3& place);
    /// Samples are noisier than was thought, or less.
    void setMeasured(double sigma) noexcept { measured_ = sigma; }
    /// Was measured so long after the last sample, more than 0 seconds.
    void add(const glm::dvec3& place, const HandSteps& passed);
    /// Where it is so long after the last sample.
    [[nodiscard]] glm::dvec3 after(const HandSteps& steps) const;
    /// Where it was `seconds` before the last sample, 0 and more.
    [[nodiscard]] glm::dvec3 before(double seconds) const;
    [[nodiscard]] glm::dvec3 velocity() const;

    static constexpr std::size_t kLivelinesses = 3;
    static constexpr std::size_t kFilters = HandSteps::kModels * kLivelinesses;

private:
    using Places = std::array<glm::dvec3, kFilters>;
    /// What was predicted, to be judged when its time has come.
    struct Promise {
        double seconds = 0.0; ///< from the last sample until then
        Places places;
    };
    void judge(const glm::dvec3& place, double seconds);
    void weigh();

    double measured_, unit_;
    std::array<MotionFilter, kFilters> filters_;
    std::array<double, kFilters> weights_{};     ///< their sum is 1
    std::array<double, kFilters> squares_{};     ///< of late, of what each predicted wrongly
    static constexpr std::size_t kPromises = 10; ///< more than are open at a time
    std::array<Promise, kPromises> promises_;    ///< the earliest first; no memory is asked for between two samples
    std::size_t open_ = 0;                       ///< of them, that are not judged yet
    glm::dvec3 place_{0.0};                      ///< of the last sample
};

} // namespace lumorph
