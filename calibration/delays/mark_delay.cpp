#include "calibration/delays/mark_delay.h"

#include <algorithm>
#include <limits>
#include <optional>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <glm/geometric.hpp>

namespace lumorph {

namespace {

constexpr double kMarkSmooth = 0.12; ///< seconds to both sides
constexpr double kGap = 0.15;        ///< seconds without a picture: nothing is known within
constexpr double kLeastWay = 0.02;   ///< metres
constexpr double kLeastSpeed = 0.03; ///< metres a second, root mean square
constexpr double kMarkFollows = 0.8; ///< of the mark's variance
constexpr double kMarkScan = 0.005;  ///< seconds
constexpr double kOtherLag = 0.1;    ///< seconds from the best lag: another one
constexpr double kAsGood = 2.0;      ///< times the cost of the best lag: as good
constexpr int kBlocks = 10;

using Way = glm::dvec3 MarkRecording::Picture::*;

/// Place and velocity of body or mark at any time: by a parabola through what was seen shortly before and after.
struct Smooth {
    glm::dvec3 place{0.0}, velocity{0.0};
};
std::optional<Smooth> smoothAt(const std::vector<MarkRecording::Picture>& seen, Way way, double seconds) {
    const auto first = std::ranges::lower_bound(seen, seconds - kMarkSmooth, {}, &MarkRecording::Picture::seconds);
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d right = Eigen::Matrix3d::Zero();
    double before = -1.0, after = -1.0; // seconds to the nearest picture on each side
    int count = 0;
    for (auto picture = first; picture != seen.end() && picture->seconds <= seconds + kMarkSmooth; ++picture) {
        const double t = picture->seconds - seconds, reach = std::abs(t) / kMarkSmooth;
        const double weight = std::pow(1.0 - reach * reach * reach, 3.0);
        const Eigen::Vector3d row(1.0, t, t * t);
        const glm::dvec3& place = (*picture).*way;
        normal += weight * row * row.transpose();
        right += weight * row * Eigen::RowVector3d(place.x, place.y, place.z);
        if (t <= 0.0) before = -t;
        if (t >= 0.0 && after < 0.0) after = t;
        ++count;
    }
    if (count < 4 || before < 0.0 || after < 0.0 || before + after > kGap) return std::nullopt;
    const Eigen::Matrix3d solved = normal.ldlt().solve(right);
    return Smooth{{solved(0, 0), solved(0, 1), solved(0, 2)}, {solved(1, 0), solved(1, 1), solved(1, 2)}};
}

/// How well the mark goes where the body was `lag` before.
class MarkFit {
public:
    explicit MarkFit(const MarkRecording& recording) : seen_(recording.pictures) {
        for (std::size_t i = 0; i < seen_.size(); ++i)
            if (const auto mark = smoothAt(seen_, &MarkRecording::Picture::mark, seen_[i].seconds))
                marks_.push_back({i, mark->place});
    }
    struct Cost {
        double square = 0.0, variance = 0.0, pictures = 0.0;
        [[nodiscard]] double share() const { return square / std::max(variance, 1e-12); }
    };
    /// Of pictures that `use` takes.
    template <typename Use> [[nodiscard]] Cost at(double lag, const Use& use) const {
        glm::dvec3 sum(0.0), sumMark(0.0);
        double squares = 0.0, squaresMark = 0.0, n = 0.0;
        for (const Mark& mark : marks_) {
            if (!use(mark.picture)) continue;
            const auto body = smoothAt(seen_, &MarkRecording::Picture::body, seen_[mark.picture].seconds - lag);
            if (!body) continue;
            const glm::dvec3 beside = mark.place - body->place, place = mark.place - marks_.front().place;
            n += 1.0;
            sum += beside;
            squares += glm::dot(beside, beside);
            sumMark += place;
            squaresMark += glm::dot(place, place);
        }
        if (n < 20.0) return {std::numeric_limits<double>::infinity(), 0.0, n};
        return {squares - glm::dot(sum, sum) / n, squaresMark - glm::dot(sumMark, sumMark) / n, n};
    }

private:
    struct Mark {
        std::size_t picture = 0;
        glm::dvec3 place{0.0};
    };
    const std::vector<MarkRecording::Picture>& seen_;
    std::vector<Mark> marks_;
};

void check(const MarkRecording& recording) {
    const char* what = "moved mark";
    std::vector<double> times;
    glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-std::numeric_limits<double>::infinity());
    for (const MarkRecording::Picture& picture : recording.pictures) {
        for (int axis = 0; axis < 3; ++axis)
            if (!std::isfinite(picture.body[axis]) || !std::isfinite(picture.mark[axis]))
                delays::refuse(Cause::notANumber, what, "a place is no number", "record it again");
        times.push_back(picture.seconds);
        low = glm::min(low, picture.body);
        high = glm::max(high, picture.body);
    }
    delays::checkPictures(times, what);
    double square = 0.0, count = 0.0;
    for (const double t : times)
        if (const auto body = smoothAt(recording.pictures, &MarkRecording::Picture::body, t)) {
            square += glm::dot(body->velocity, body->velocity);
            count += 1.0;
        }
    if (glm::distance(low, high) < kLeastWay || !(square > kLeastSpeed * kLeastSpeed * count))
        delays::refuse(Cause::nothingMoves, what, "the body hardly moves",
                       "carry it to and fro over a hand's breadth, twice a second, for ten seconds");
}

} // namespace

MeasuredDelay solveMarkDelay(const MarkRecording& recording, const Progress& progress) {
    const char* what = "moved mark";
    check(recording);
    const MarkFit fit(recording);
    const auto every = [](std::size_t) { return true; };
    std::vector<double> costs;
    for (double lag = -0.05; lag < kLongestDelay; lag += kMarkScan) {
        progress.throwIfCancelled();
        const MarkFit::Cost cost = fit.at(lag, every);
        costs.push_back(cost.pictures > 0.0 ? cost.square / cost.pictures : cost.square);
    }
    const auto best = std::ranges::min_element(costs);
    const double near = -0.05 + kMarkScan * static_cast<double>(best - costs.begin());
    const MarkFit::Cost found = fit.at(near, every);
    if (!(found.share() < 1.0 - kMarkFollows))
        delays::refuse(Cause::modelDoesNotFit, what, "the mark does not go the way of the body",
                       "look whether both were taken for what they are, and whether the tracker sees the body");
    for (std::size_t i = 0; i < costs.size(); ++i)
        if (std::abs(-0.05 + kMarkScan * static_cast<double>(i) - near) > kOtherLag &&
            costs[i] < kAsGood * *best + 1e-8)
            delays::refuse(Cause::motionPeriodic, what,
                           "the motion repeats itself so evenly that several lags explain it",
                           "move the body unevenly: now fast, now slow, and to all sides");
    const auto solved = [&](const auto& use) {
        return delays::smallestBetween(near - 3.0 * kMarkScan, near + 3.0 * kMarkScan, 1e-5,
                                       [&](double lag) { return fit.at(lag, use).square; });
    };
    MeasuredDelay delay;
    const double lag = solved(every);
    delay.seconds = lag - 0.5 * recording.shownSeconds;
    const MarkFit::Cost last = fit.at(lag, every);
    delay.residual = std::sqrt(last.square / last.pictures);
    delay.events = static_cast<int>(last.pictures);
    const std::size_t pictures = recording.pictures.size();
    std::vector<double> without;
    for (std::size_t block = 0; block < kBlocks; ++block) {
        progress.throwIfCancelled();
        without.push_back(solved([&](std::size_t i) { return i * kBlocks / pictures != block; }));
    }
    delay.sigma = delays::jackknife(without);
    delay.halvesDiffer = std::abs(solved([&](std::size_t i) { return 2 * i < pictures; }) -
                                  solved([&](std::size_t i) { return 2 * i >= pictures; }));
    return delay;
}

} // namespace lumorph
