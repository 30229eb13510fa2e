#include "core/loop/motion_predictor.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_access.hpp>
#include <glm/matrix.hpp>

namespace lumorph {

namespace {

// Fitted to the first halves of recordings of hands at 0.2 and 0.3 m/s, with 1 mm of noise: a hand that goes to and
// fro, one that carries what it holds about a room, one that reaches and rests, and a thing that glides on.
constexpr std::array<HandModel, HandSteps::kModels> kWays = {{
    {.fast = 31.838, .fastDamping = 2.323, .slow = 1.827, .slowDamping = 0.157, .drive = 221.0},
    {.fast = 9.943, .fastDamping = 12.04, .slow = 2.107, .slowDamping = 1.638, .drive = 256.8},
    {.fast = 9.652, .fastDamping = 0.831, .slow = 1.917, .slowDamping = 0.998, .drive = 57.6},
    {.fast = 20.0, .fastDamping = 1.6, .slow = 0.02, .slowDamping = 1.0, .drive = 40.0},
}};
constexpr std::array<double, MotionPredictor::kLivelinesses> kLiveliness = {0.5, 1.0, 2.0};

constexpr double kMiddleSeconds = 4.0; // over which places are averaged to a middle
constexpr double kJudgedAhead = 0.067; // seconds: what the delays of a room add up to
constexpr double kJudgedEvery = 0.008; // seconds between predictions that are judged, at least
constexpr double kJudgedSeconds = 1.0; // over which errors are averaged
constexpr double kChoice = 0.1;        // by which share more squared error a filter weighs a third
constexpr double kJolt = 10.0;         // mean square off, as a multiple of what is expected
constexpr double kShort = 0.3;         // radians of the fastest pole, for which a series is short

/// By columns, as glm has it: column j is what becomes of the j-th derivative.
glm::dmat4 rateOf(const HandModel& model) {
    const double a0 = model.fast * model.fast, a1 = 2.0 * model.fastDamping * model.fast;
    const double b0 = model.slow * model.slow, b1 = 2.0 * model.slowDamping * model.slow;
    glm::dmat4 rate(0.0);
    rate[1][0] = rate[2][1] = rate[3][2] = 1.0;
    rate[0][3] = -a0 * b0;
    rate[1][3] = -(a0 * b1 + a1 * b0);
    rate[2][3] = -(a0 + a1 * b1 + b0);
    rate[3][3] = -(a1 + b1);
    return rate;
}

/// Of four integrators in a row that noise drives: t^(i+j+1) / (i! j! (i+j+1)), i and j counted from the jerk.
glm::dmat4 shortWander(double t) {
    constexpr double kFactorial[4] = {1.0, 1.0, 2.0, 6.0};
    const double power[4] = {1.0, t, t * t, t * t * t};
    glm::dmat4 wander;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j)
            wander[3 - i][3 - j] = power[i] * power[j] * t / (kFactorial[i] * kFactorial[j] * (i + j + 1));
    return wander;
}

/// A short step by its series, doubled until it is as long as asked.
HandStep stepOf(const HandModel& model, double seconds) {
    const glm::dmat4 rate = rateOf(model);
    const double fastest = 2.0 * model.fastDamping * model.fast + model.fast + model.slow;
    int doublings = 0;
    for (; seconds * fastest > kShort; seconds *= 0.5) ++doublings;
    HandStep step{glm::dmat4(1.0), shortWander(seconds)};
    glm::dmat4 term(1.0);
    for (int k = 1; k <= 5; ++k) {
        term = term * rate * (seconds / k);
        step.transition += term;
    }
    for (; doublings > 0; --doublings) {
        step.wander += step.transition * step.wander * glm::transpose(step.transition);
        step.transition = step.transition * step.transition;
    }
    return step;
}

/// To the time at which predictions are judged.
const HandSteps& judgedSteps() {
    static const HandSteps steps = handStepsOf(kJudgedAhead);
    return steps;
}

} // namespace

HandSteps handStepsOf(double seconds) {
    HandSteps steps;
    steps.seconds = seconds;
    std::ranges::transform(kWays, steps.steps.begin(), [&](const HandModel& model) { return stepOf(model, seconds); });
    return steps;
}

void MotionFilter::restart(const glm::dvec3& place, double measured, double unit) {
    middle_ = place;
    state_.fill(glm::dvec3(0.0));
    covariance_ = glm::dmat4(0.0);
    covariance_[0][0] = measured * measured;
    covariance_[1][1] = 0.09 * unit * unit; // 0.3 m/s, 3 m/s^2, 30 m/s^3
    covariance_[2][2] = 9.0 * unit * unit;
    covariance_[3][3] = 900.0 * unit * unit;
}

void MotionFilter::advance(const HandStep& step, double drive, double seconds) {
    const glm::dmat4& transition = step.transition;
    std::array<glm::dvec3, 4> next{};
    for (int to = 0; to < 4; ++to)
        for (int from = 0; from < 4; ++from) next[to] += transition[from][to] * state_[from];
    state_ = next;
    covariance_ = transition * covariance_ * glm::transpose(transition) + drive * drive * step.wander;
    step_ = seconds;
}

void MotionFilter::correct(const glm::dvec3& place, double measured) {
    const glm::dvec3 off = place - middle_ - state_[0];
    const double noise = measured * measured;
    const double square = glm::dot(off, off) / 3.0;
    if (square > kJolt * (covariance_[0][0] + noise)) {
        covariance_[0][0] += square;
        covariance_[0][1] += square / step_;
        covariance_[1][0] += square / step_;
        covariance_[1][1] += square / (step_ * step_);
    }
    const glm::dvec4 gain = covariance_[0] / (covariance_[0][0] + noise);
    for (int k = 0; k < 4; ++k) state_[k] += gain[k] * off;
    covariance_ -= glm::outerProduct(gain, glm::row(covariance_, 0));
    const glm::dvec3 drift = (1.0 - std::exp(-step_ / kMiddleSeconds)) * state_[0];
    middle_ += drift;
    state_[0] -= drift;
}

glm::dvec3 MotionFilter::after(const glm::dmat4& transition) const {
    glm::dvec3 place = middle_;
    for (int k = 0; k < 4; ++k) place += transition[k][0] * state_[k];
    return place;
}

glm::dvec3 MotionFilter::before(double seconds) const {
    return middle_ + state_[0] - seconds * state_[1] + 0.5 * seconds * seconds * state_[2];
}

MotionPredictor::MotionPredictor(double measured, double unit) : measured_(measured), unit_(unit) {
    restart(glm::dvec3(0.0));
}

void MotionPredictor::restart(const glm::dvec3& place) {
    for (MotionFilter& filter : filters_) filter.restart(place, measured_, unit_);
    squares_.fill(0.0);
    weights_.fill(1.0 / double(kFilters));
    open_ = 0;
    place_ = place;
}

void MotionPredictor::add(const glm::dvec3& place, const HandSteps& passed) {
    judge(place, passed.seconds);
    for (std::size_t k = 0; k < kFilters; ++k) {
        const std::size_t model = k / kLivelinesses;
        filters_[k].advance(passed.steps[model], unit_ * kWays[model].drive * kLiveliness[k % kLivelinesses],
                            passed.seconds);
        filters_[k].correct(place, measured_);
    }
    place_ = place;
    static_assert(double(kPromises - 1) * kJudgedEvery > kJudgedAhead);
    if (open_ > 0 && kJudgedAhead - promises_[open_ - 1].seconds < kJudgedEvery) return;
    Promise& promise = promises_[open_++];
    promise.seconds = kJudgedAhead;
    for (std::size_t k = 0; k < kFilters; ++k)
        promise.places[k] = filters_[k].after(judgedSteps().steps[k / kLivelinesses].transition);
}

void MotionPredictor::judge(const glm::dvec3& place, double seconds) {
    const double kept = std::exp(-seconds / kJudgedSeconds);
    for (double& square : squares_) square *= kept;
    std::size_t judged = 0;
    for (Promise& promise : std::span(promises_).first(open_)) {
        promise.seconds -= seconds;
        if (promise.seconds > 0.0) continue;
        ++judged;
        const glm::dvec3 then = place + (promise.seconds / seconds) * (place - place_);
        for (std::size_t k = 0; k < kFilters; ++k) {
            const glm::dvec3 off = promise.places[k] - then;
            squares_[k] += glm::dot(off, off);
        }
    }
    std::shift_left(promises_.begin(), promises_.begin() + std::ptrdiff_t(open_), std::ptrdiff_t(judged));
    open_ -= judged;
    weigh();
}

void MotionPredictor::weigh() {
    const double least = *std::ranges::min_element(squares_);
    if (!(least > 0.0)) return;
    double sum = 0.0;
    for (std::size_t k = 0; k < kFilters; ++k) {
        weights_[k] = std::exp(-(squares_[k] - least) / (kChoice * least));
        sum += weights_[k];
    }
    for (double& weight : weights_) weight /= sum;
}

glm::dvec3 MotionPredictor::after(const HandSteps& steps) const {
    glm::dvec3 place(0.0);
    for (std::size_t k = 0; k < kFilters; ++k)
        place += weights_[k] * filters_[k].after(steps.steps[k / kLivelinesses].transition);
    return place;
}

glm::dvec3 MotionPredictor::before(double seconds) const {
    glm::dvec3 place(0.0);
    for (std::size_t k = 0; k < kFilters; ++k) place += weights_[k] * filters_[k].before(seconds);
    return place;
}

glm::dvec3 MotionPredictor::velocity() const {
    glm::dvec3 velocity(0.0);
    for (std::size_t k = 0; k < kFilters; ++k) velocity += weights_[k] * filters_[k].velocity();
    return velocity;
}

} // namespace lumorph
