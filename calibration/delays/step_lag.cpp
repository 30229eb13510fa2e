#include "calibration/delays/step_lag.h"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <random>

#include "core/base/statistics.h"

namespace lumorph {

namespace {

constexpr double kRestShare = 0.25; ///< of a hold, at its end: the part rests
constexpr double kDeadShare = 0.15; ///< of what was told: it does not move
constexpr double kJammedShare =
    0.35;                          ///< of a step, whose curve may be steep elsewhere and whose play is not crossed yet
constexpr double kMostPlay = 0.12; ///< strokes
constexpr double kStiffness = 0.5; ///< pictures of a motion that a bend has to be worth
constexpr int kFewestSteps = 4;

/// One step as it was seen.
struct Seen {
    double told = 0.0;                          ///< strokes from the level before, with their sign
    double from = 0.0, to = 0.0;                ///< where the part rests before and after
    int levelFrom = 0, levelTo = 0;             ///< commands, hundredths of a stroke
    bool turns = false;                         ///< the step before went the other way
    std::vector<StepRecording::Sample> samples; ///< seconds after the command
};

struct StepModel {
    double lag = 0.1, velocity = 1.0, play = 0.0;
};

/// Share of its way that the part has made so long after the command.
double progressAt(const StepModel& model, const Seen& step, double seconds) {
    const double way = std::abs(step.told), play = step.turns ? std::min(model.play, 0.9 * way) : 0.0;
    const double horn = std::clamp(model.velocity * (seconds - model.lag), 0.0, way);
    return std::clamp((horn - play) / (way - play), 0.0, 1.0);
}

/// Between two levels the part does not go evenly where the servo's curve is bent, and goes the same way up and down:
/// by the levels in hundredths of a stroke, what its bend explains.
struct Bend {
    double product = 0.0, square = 0.0;
};
using Bends = std::map<int, Bend>;

int bendOf(const Seen& step) {
    return std::min(step.levelFrom, step.levelTo) * 1000 + std::max(step.levelFrom, step.levelTo);
}

/// Square of what model and a straight way leave, and what of it a bend explains.
double squareOf(const StepModel& model, const Seen& step, Bends& bends) {
    double sum = 0.0;
    Bend& bend = bends[bendOf(step)];
    for (const StepRecording::Sample& sample : step.samples) {
        const double share = progressAt(model, step, sample.seconds), bow = 4.0 * share * (1.0 - share);
        const double off = sample.stroke - step.from - (step.to - step.from) * share;
        sum += off * off;
        bend.product += off * bow;
        bend.square += bow * bow;
    }
    return sum;
}

class StepFit {
public:
    explicit StepFit(const std::vector<Seen>& steps) : steps_(steps) {
        for (const Seen& step : steps) turnsAndGoesOn_ |= step.turns != steps.front().turns;
    }

    template <typename Use> [[nodiscard]] double cost(const StepModel& model, const Use& use) const {
        double sum = 0.0;
        Bends bends;
        for (std::size_t k = 0; k < steps_.size(); ++k)
            if (use(k)) sum += squareOf(model, steps_[k], bends);
        for (const auto& [levels, bend] : bends) sum -= bend.product * bend.product / (bend.square + kStiffness);
        return sum;
    }
    /// Every lag, speed and play, coarsely.
    [[nodiscard]] StepModel coarse(const Progress& progress) const {
        const auto every = [](std::size_t) { return true; };
        StepModel best;
        double least = std::numeric_limits<double>::infinity();
        for (double lag = 0.0; lag < kLongestDelay; lag += 0.01) {
            progress.throwIfCancelled();
            for (double velocity = 0.2; velocity < 15.0; velocity *= 1.2)
                for (const double play : {0.0, 0.03, 0.06}) {
                    const StepModel model{lag, velocity, play};
                    if (const double at = cost(model, every); at < least) {
                        least = at;
                        best = model;
                    }
                }
        }
        return best;
    }
    /// Downhill along one after the other, each as far as it goes (Powell's way without directions): the cost has
    /// corners where a motion begins and ends between two pictures.
    template <typename Use> [[nodiscard]] StepModel refined(StepModel model, const Use& use) const {
        const auto along = [&](double StepModel::*what, double reach, double low, double high) {
            model.*what = delays::smallestBetween(std::max(low, model.*what - reach),
                                                  std::min(high, model.*what + reach), 1e-3 * reach, [&](double value) {
                                                      StepModel other = model;
                                                      other.*what = value;
                                                      return cost(other, use);
                                                  });
        };
        double before = cost(model, use);
        for (int round = 0; round < 40; ++round) {
            along(&StepModel::lag, 0.02, 0.0, kLongestDelay + 0.1);
            along(&StepModel::velocity, 0.15 * model.velocity, 0.05, 30.0);
            if (turnsAndGoesOn_) along(&StepModel::play, 0.02, 0.0, kMostPlay);
            // Lag against speed, and lag against play, are what the steps tell worst: the valleys along them.
            alongBoth(model, use, -1.0);
            if (turnsAndGoesOn_) alongPlay(model, use);
            const double now = cost(model, use);
            if (before - now < 1e-6 * before) break;
            before = now;
        }
        return model;
    }

private:
    /// The middle of all motions stays where it is.
    template <typename Use> void alongBoth(StepModel& model, const Use& use, double sign) const {
        double way = 0.0;
        for (const Seen& step : steps_) way += 0.5 * std::abs(step.told) / double(steps_.size());
        const auto moved = [&](double by) {
            StepModel other = model;
            other.lag = std::clamp(model.lag + by, 0.0, kLongestDelay + 0.1);
            const double middle = way / model.velocity + sign * by;
            other.velocity = middle > 1e-3 ? std::clamp(way / middle, 0.05, 30.0) : 30.0;
            return other;
        };
        model = moved(delays::smallestBetween(-0.02, 0.02, 1e-5, [&](double by) { return cost(moved(by), use); }));
    }
    /// The begin of the motions after a turn stays where it is.
    template <typename Use> void alongPlay(StepModel& model, const Use& use) const {
        const auto moved = [&](double by) {
            StepModel other = model;
            other.lag = std::clamp(model.lag + by, 0.0, kLongestDelay + 0.1);
            other.play = std::clamp(model.play - by * model.velocity, 0.0, kMostPlay);
            return other;
        };
        model = moved(delays::smallestBetween(-0.02, 0.02, 1e-5, [&](double by) { return cost(moved(by), use); }));
    }

    const std::vector<Seen>& steps_;
    bool turnsAndGoesOn_ = false; ///< there are steps of both kinds, without which play is not told
};

void check(const StepRecording& recording) {
    std::vector<double> times;
    for (const StepRecording::Sample& sample : recording.samples) {
        if (!std::isfinite(sample.stroke))
            delays::refuse(Cause::notANumber, recording.servo, "an angle is no number", "record it again");
        times.push_back(sample.seconds);
    }
    delays::checkPictures(times, recording.servo);
    double before = -std::numeric_limits<double>::infinity();
    for (const StepRecording::Step& step : recording.steps) {
        if (!std::isfinite(step.seconds) || !std::isfinite(step.commanded))
            delays::refuse(Cause::notANumber, recording.servo, "a command is no number", "record it again");
        if (!(step.seconds > before))
            delays::refuse(Cause::clockJumps, recording.servo, "a command is as old as the one before, or older",
                           "record it again with times by one clock");
        before = step.seconds;
    }
}

/// Where the part rests at the end of each hold; empty where too little was seen of it.
std::vector<std::optional<double>> restsOf(const StepRecording& recording) {
    std::vector<std::optional<double>> rests;
    const auto& steps = recording.steps;
    for (std::size_t k = 0; k < steps.size(); ++k) {
        const double end = k + 1 < steps.size() ? steps[k + 1].seconds : recording.samples.back().seconds + 1e-6;
        const double from = end - kRestShare * (end - steps[k].seconds);
        // A mean is less noisy than a median, and nothing else is in these pictures.
        double sum = 0.0, count = 0.0;
        for (const StepRecording::Sample& sample : recording.samples)
            if (sample.seconds >= from && sample.seconds < end) {
                sum += sample.stroke;
                count += 1.0;
            }
        rests.push_back(count >= 3.0 ? std::optional(sum / count) : std::nullopt);
    }
    return rests;
}

std::vector<Seen> seenSteps(const StepRecording& recording, const std::vector<std::optional<double>>& rests) {
    std::vector<Seen> seen;
    const auto& steps = recording.steps;
    for (std::size_t k = 1; k < steps.size(); ++k) {
        if (!rests[k - 1] || !rests[k]) continue;
        const double told = steps[k].commanded - steps[k - 1].commanded;
        if (std::abs(told) < 0.05) continue;
        const double before = k > 1 ? steps[k - 1].commanded - steps[k - 2].commanded : 0.0;
        Seen step{told,
                  *rests[k - 1],
                  *rests[k],
                  static_cast<int>(std::lround(100.0 * steps[k - 1].commanded)),
                  static_cast<int>(std::lround(100.0 * steps[k].commanded)),
                  told * before < 0.0,
                  {}};
        const double end = k + 1 < steps.size() ? steps[k + 1].seconds : recording.samples.back().seconds + 1e-6;
        const double span = end - steps[k].seconds;
        // A gap in the pictures within a step hides its motion.
        double last = -0.05;
        bool gap = false;
        for (const StepRecording::Sample& sample : recording.samples) {
            const double t = sample.seconds - steps[k].seconds;
            if (t < -0.05 || t >= span) continue;
            gap |= t - last > 0.15;
            last = t;
            step.samples.push_back({t, sample.stroke});
        }
        if (!gap) seen.push_back(std::move(step));
    }
    return seen;
}

/// Names what is wrong with the servo.
void judge(const StepRecording& recording, const std::vector<Seen>& steps) {
    double told = 0.0, made = 0.0, worst = 1.0;
    for (const Seen& step : steps) {
        const double share = (step.to - step.from) / step.told;
        told += std::abs(step.told);
        made += share * std::abs(step.told);
        worst = std::min(worst, share);
    }
    const double share = made / told;
    const std::string& who = recording.servo;
    if (share < -kDeadShare)
        delays::refuse(Cause::servoReversed, who, "it runs down when it is told to go up",
                       "reverse it in Devices, Set-up, then measure again");
    if (share < kDeadShare)
        delays::refuse(Cause::servoDead, who, "its part does not follow its steps",
                       "look after its plug, its supply and its lever, then measure again");
    if (worst < kJammedShare)
        delays::refuse(Cause::servoJammed, who,
                       "of a step it makes only " + std::to_string(std::lround(100.0 * std::max(worst, 0.0))) +
                           " hundredths of the way",
                       "free its part or narrow its range, then measure again");
}

} // namespace

double restAfter(double way, double velocity) { return kLongestDelay + 1.3 * way / velocity; }

std::vector<StepRecording::Step> planSteps(double velocity, double begin, unsigned seed, const StepRange& range,
                                           int rounds) {
    std::mt19937 dice(seed);
    std::uniform_real_distribution<double> any(0.0, 0.1);
    std::vector<StepRecording::Step> steps;
    double now = begin, at = 0.0;
    const auto go = [&](double level) {
        steps.push_back({now, level});
        now += restAfter(std::abs(level - at), velocity) / (1.0 - kRestShare) + any(dice);
        at = level;
    };
    const double middle = 0.5 * (range.low + range.high);
    go(range.low);
    for (int round = 0; round < rounds; ++round)
        for (const double level : {middle, range.high, middle, range.low}) go(level);
    return steps;
}

StepLag solveStepLag(const StepRecording& recording, const Progress& progress) {
    check(recording);
    const std::vector<Seen> steps = seenSteps(recording, restsOf(recording));
    if (steps.size() < kFewestSteps)
        delays::refuse(Cause::tooFewViews, recording.servo,
                       "the camera's pictures show " + std::to_string(steps.size()) + " of " +
                           std::to_string(recording.steps.size()) + " steps: it lost pictures or was unplugged",
                       "look after the camera, then step again");
    judge(recording, steps);
    const StepFit fit(steps);
    const auto every = [](std::size_t) { return true; };
    const StepModel model = fit.refined(fit.coarse(progress), every);
    StepLag found;
    found.lag.seconds = model.lag;
    found.velocity = model.velocity;
    found.play = model.play;
    double samples = 0.0;
    for (const Seen& step : steps) samples += double(step.samples.size());
    found.lag.residual = std::sqrt(fit.cost(model, every) / samples);
    found.lag.events = static_cast<int>(steps.size());
    std::vector<double> without;
    for (std::size_t left = 0; left < steps.size(); ++left) {
        progress.throwIfCancelled();
        without.push_back(fit.refined(model, [left](std::size_t k) { return k != left; }).lag);
    }
    found.lag.sigma = delays::jackknife(without);
    const std::size_t half = steps.size() / 2;
    found.lag.halvesDiffer = std::abs(fit.refined(model, [half](std::size_t k) { return k < half; }).lag -
                                      fit.refined(model, [half](std::size_t k) { return k >= half; }).lag);
    return found;
}

} // namespace lumorph
