#include "core/loop/prediction_replay.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/base/error.h"

namespace lumorph {

namespace {

constexpr double kSettleReplay = 1.0;    ///< seconds until a filter knows the motion
constexpr double kRadiansPerMetre = 4.0; ///< of noise
constexpr double kWindowStep = 0.01;     ///< seconds
constexpr double kShortestWindow = 0.02;
constexpr double kLongestWindow = 0.25;
constexpr double kGapShare = 3.0; ///< of the usual time between samples: what is longer is a gap

struct Timed {
    double seconds = 0.0;
    Pose pose;
};

double turnAngle(const glm::dquat& a, const glm::dquat& b) {
    const glm::dquat way = a * glm::conjugate(b);
    return 2.0 * std::atan2(glm::length(glm::dvec3(way.x, way.y, way.z)), std::abs(way.w));
}

/// The recording with times from its beginning.
std::vector<Timed> timed(std::span<const PoseSample> recording) {
    std::vector<Timed> all;
    for (const PoseSample& sample : recording)
        if (sample.valid)
            all.push_back({1e-6 * static_cast<double>((sample.time - recording.front().time).count()), sample.pose});
    return all;
}

double longestStep(const std::vector<Timed>& track) {
    std::vector<double> steps;
    for (std::size_t k = 1; k < track.size(); ++k) steps.push_back(track[k].seconds - track[k - 1].seconds);
    const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
    std::ranges::nth_element(steps, middle);
    return kGapShare * *middle;
}

/// Poses at `ahead` seconds after each; none in a gap and where the recording has ended.
std::vector<std::optional<Pose>> truthOf(const std::vector<Timed>& track, double ahead) {
    const double longest = longestStep(track);
    std::vector<std::optional<Pose>> truth(track.size());
    std::size_t after = 0;
    for (std::size_t k = 0; k < track.size(); ++k) {
        const double then = track[k].seconds + ahead;
        while (after < track.size() && track[after].seconds < then) ++after;
        if (after == track.size()) break;
        if (track[k].seconds < kSettleReplay) continue;
        const Timed& to = track[after];
        const Timed& from = track[after == 0 ? 0 : after - 1];
        const double step = to.seconds - from.seconds;
        if (step > longest) continue;
        const double share = step > 0.0 ? (then - from.seconds) / step : 1.0;
        truth[k] = Pose{glm::mix(from.pose.position, to.pose.position, share),
                        glm::slerp(from.pose.rotation, to.pose.rotation, share)};
    }
    return truth;
}

std::vector<Timed> withNoise(std::vector<Timed> track, double sigma, std::uint32_t seed) {
    std::mt19937 dice(seed);
    std::normal_distribution<double> normal;
    const auto vector = [&] { return sigma * glm::dvec3(normal(dice), normal(dice), normal(dice)); };
    for (Timed& sample : track) {
        sample.pose.position += vector();
        const glm::dvec3 turn = 0.5 * kRadiansPerMetre * vector();
        sample.pose.rotation = glm::normalize(sample.pose.rotation * glm::dquat(1.0, turn.x, turn.y, turn.z));
    }
    return track;
}

PlaceError errorOf(std::vector<double> distances) {
    double squares = 0.0;
    for (const double distance : distances) squares += distance * distance;
    std::ranges::sort(distances);
    const auto count = static_cast<double>(distances.size());
    return {std::sqrt(squares / count), distances[static_cast<std::size_t>(0.95 * (count - 1.0))]};
}

/// The first sample of the last `window` seconds before each.
std::vector<std::size_t> firstOf(const std::vector<Timed>& noisy, double window) {
    std::vector<std::size_t> first(noisy.size());
    for (std::size_t k = 1; k < noisy.size(); ++k) {
        first[k] = first[k - 1];
        while (first[k] + 1 < k && noisy[k].seconds - noisy[first[k]].seconds > window + 1e-4) ++first[k];
    }
    return first;
}

glm::dvec3 lineAt(std::span<const Timed> samples, double ahead) {
    const double newest = samples.back().seconds;
    const auto count = static_cast<double>(samples.size());
    double time = 0.0;
    glm::dvec3 place(0.0);
    for (const Timed& sample : samples) {
        time += (sample.seconds - newest) / count;
        place += sample.pose.position / count;
    }
    double square = 0.0;
    glm::dvec3 product(0.0);
    for (const Timed& sample : samples) {
        const double off = sample.seconds - newest - time;
        square += off * off;
        product += off * (sample.pose.position - place);
    }
    return square > 0.0 ? place + (ahead - time) / square * product : place;
}

/// Places by one of the two kinds of constant velocity, and their distances from the truth.
template <typename Place>
std::vector<double> distancesOf(const std::vector<std::optional<Pose>>& truth, const Place& place) {
    std::vector<double> distances;
    for (std::size_t k = 0; k < truth.size(); ++k)
        if (truth[k]) distances.push_back(glm::distance(place(k), truth[k]->position));
    return distances;
}

double constantTurn(const std::vector<Timed>& noisy, const std::vector<std::optional<Pose>>& truth,
                    const std::vector<std::size_t>& first, double ahead) {
    double squares = 0.0, count = 0.0;
    for (std::size_t k = 1; k < noisy.size(); ++k) {
        if (!truth[k]) continue;
        const Timed& from = noisy[first[k]];
        const glm::dquat& now = noisy[k].pose.rotation;
        const double times = ahead / (noisy[k].seconds - from.seconds);
        glm::dquat way = now * glm::conjugate(from.pose.rotation);
        if (way.w < 0.0) way = -way;
        const glm::dvec3 axis(way.x, way.y, way.z);
        const double sine = glm::length(axis);
        const double angle = times * 2.0 * std::atan2(sine, way.w);
        const glm::dquat then = sine > 0.0 ? glm::angleAxis(angle, axis / sine) * now : now;
        squares += std::pow(turnAngle(then, truth[k]->rotation), 2);
        count += 1.0;
    }
    return std::sqrt(squares / count);
}

void compareVelocities(const std::vector<Timed>& noisy, const std::vector<std::optional<Pose>>& truth, double ahead,
                       PredictionReplay& replay) {
    for (double window = kShortestWindow; window < kLongestWindow + 1e-6; window += kWindowStep) {
        const std::vector<std::size_t> first = firstOf(noisy, window);
        const PlaceError velocity = errorOf(distancesOf(truth, [&](std::size_t k) {
            const Timed& from = noisy[first[k]];
            const glm::dvec3& now = noisy[k].pose.position;
            return now + ahead / (noisy[k].seconds - from.seconds) * (now - from.pose.position);
        }));
        if (replay.velocitySeconds == 0.0 || velocity.rms < replay.constantVelocity.rms) {
            replay.constantVelocity = velocity;
            replay.velocitySeconds = window;
        }
        const PlaceError line = errorOf(distancesOf(
            truth, [&](std::size_t k) { return lineAt(std::span(noisy).subspan(first[k], k - first[k] + 1), ahead); }));
        if (replay.lineSeconds == 0.0 || line.rms < replay.line.rms) {
            replay.line = line;
            replay.lineSeconds = window;
        }
        const double turn = constantTurn(noisy, truth, first, ahead);
        if (window == kShortestWindow || turn < replay.constantTurnRms) replay.constantTurnRms = turn;
    }
}

void comparePredicted(const std::vector<Timed>& noisy, const std::vector<std::optional<Pose>>& truth, double ahead,
                      PredictionReplay& replay) {
    PoseStream stream;
    std::vector<double> distances;
    double turns = 0.0;
    for (std::size_t k = 0; k < noisy.size(); ++k) {
        const Microseconds now(std::llround(1e6 * noisy[k].seconds));
        (void)stream.push({now, true, noisy[k].pose});
        if (!truth[k]) continue;
        const std::optional<Pose> pose = stream.at(now + Microseconds(std::llround(1e6 * ahead)), now);
        if (!pose) continue;
        distances.push_back(glm::distance(pose->position, truth[k]->position));
        turns += std::pow(turnAngle(pose->rotation, truth[k]->rotation), 2);
    }
    replay.count = distances.size();
    replay.turnRms = std::sqrt(turns / static_cast<double>(replay.count));
    replay.predicted = errorOf(std::move(distances));
}

} // namespace

PredictionReplay replayPrediction(std::span<const PoseSample> recording, double ahead, double noiseMetres,
                                  std::uint32_t seed) {
    if (!(ahead >= 0.0) || !(noiseMetres >= 0.0) || !std::isfinite(ahead) || !std::isfinite(noiseMetres))
        throw InvalidInput("replay", "the time ahead or the noise is negative or no number", "give 0 or more");
    const std::vector<Timed> track = timed(recording);
    if (track.size() < 3 || track.back().seconds - kSettleReplay <= ahead)
        throw InvalidInput("recording",
                           "it ends before anything predicted can be compared: it must be a second longer than the "
                           "time ahead",
                           "look less far ahead, or record longer");
    const std::vector<std::optional<Pose>> truth = truthOf(track, ahead);
    if (std::ranges::none_of(truth, [](const auto& pose) { return pose.has_value(); }))
        throw InvalidInput("recording", "it has gaps wherever something predicted would be compared",
                           "record at an even rate");
    const std::vector<Timed> noisy = withNoise(track, noiseMetres, seed);
    PredictionReplay replay;
    comparePredicted(noisy, truth, ahead, replay);
    compareVelocities(noisy, truth, ahead, replay);
    return replay;
}

} // namespace lumorph
