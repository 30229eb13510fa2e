#include "calibration/verify/output_watch.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/error.h"

namespace lumorph {

namespace {

constexpr int kBlock = 8; // pixels
constexpr std::size_t kFewestBlocks = 12;
constexpr double kLeastContrast = 3.0;         // grey levels: content below is too dark or too even
constexpr double kHealthy = 0.7, kLost = 0.35; // correlations
constexpr double kBlackGain = 0.2;             // of the usual
constexpr double kFlat = 0.3;                  // of the contrast that should be there
constexpr std::size_t kFewestChanging = 6;
constexpr double kStill = 0.3, kMoving = 0.6; // of the change that should be seen
constexpr double kLearns = 0.1;
constexpr double kSameBend = 0.01; // strokes

double meanOf(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) /
           std::max<double>(1.0, static_cast<double>(values.size()));
}

double medianOf(std::vector<double>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
}

const char* sentenceFor(OutputReport::State state) {
    switch (state) {
    case OutputReport::State::watching:
        return "Watching.";
    case OutputReport::State::shown:
        return "What is sent is seen.";
    case OutputReport::State::black:
        return "The projector shows nothing: look whether it is on, its input is right, and nothing covers its lens.";
    case OutputReport::State::frozen:
        return "The projector's picture stands still while the show goes on: look at its input and at the graphics "
               "driver.";
    case OutputReport::State::blind:
        return "The watch cannot tell whether the projector shows what is sent.";
    }
    return "";
}

} // namespace

const char* wordOf(OutputReport::State state) {
    switch (state) {
    case OutputReport::State::watching:
        return "watching";
    case OutputReport::State::shown:
        return "shown";
    case OutputReport::State::black:
        return "black";
    case OutputReport::State::frozen:
        return "frozen";
    case OutputReport::State::blind:
        return "blind";
    }
    return "";
}

OutputWatch::OutputWatch(const Rig& rig, const Installation& believed, const OutputWatchOptions& options)
    : options_(options), prediction_(rig, believed, options.width, options.camera) {}

std::optional<OutputWatch::Blocks> OutputWatch::blocksOf(const ShowLook& show, const Progress& progress) {
    const cv::Mat1f predicted = prediction_.predict(show.sent, show.strokes);
    progress.throwIfCancelled();
    if (show.photograph.empty()) return std::nullopt;
    cv::Mat1f seen;
    try {
        seen = prediction_.shrink(show.photograph);
    } catch (const InvalidInput&) {
        return std::nullopt;
    }
    cv::Mat1f lit = cv::Mat1f::zeros(predicted.size());
    for (const cv::Mat1f& share : prediction_.sight(show.strokes).share) lit += share;
    Blocks blocks{show.seconds, show.strokes, {}, {}};
    for (int y = 0; y + kBlock <= lit.rows; y += kBlock)
        for (int x = 0; x + kBlock <= lit.cols; x += kBlock) {
            const cv::Rect place(x, y, kBlock, kBlock);
            if (cv::countNonZero(lit(place)) != place.area()) continue;
            blocks.predicted.push_back(cv::mean(predicted(place))[0]);
            blocks.seen.push_back(cv::mean(seen(place))[0]);
        }
    if (blocks.seen.size() < kFewestBlocks) return std::nullopt;
    return blocks;
}

OutputWatch::Match OutputWatch::matchOf(const Blocks& blocks) {
    Match match;
    const double light = meanOf(blocks.predicted);
    match.seenMean = meanOf(blocks.seen);
    double lights = 0.0, greys = 0.0, both = 0.0;
    for (std::size_t i = 0; i < blocks.seen.size(); ++i) {
        const double p = blocks.predicted[i] - light, s = blocks.seen[i] - match.seenMean;
        lights += p * p;
        greys += s * s;
        both += p * s;
    }
    const auto count = static_cast<double>(blocks.seen.size());
    match.predictedSpread = std::sqrt(lights / count);
    match.seenSpread = std::sqrt(greys / count);
    if (lights > 0.0) match.gain = both / lights;
    if (lights > 0.0 && greys > 0.0) match.alike = both / std::sqrt(lights * greys);
    return match;
}

/// Light should be there with all its contrast, and what is there has nothing of it.
bool OutputWatch::isBlack(const Match& match) const {
    if (gain_ > 0.0) return match.gain < kBlackGain * gain_ && match.seenSpread < kFlat * gain_ * match.predictedSpread;
    // Nothing healthy was ever seen: a picture of light has more contrast than a room without.
    return match.alike < kLost && match.seenSpread < 0.2 * match.seenMean + 1.0;
}

/// Of the places whose light changed since some seconds ago, what share of that was seen; nothing where too few did.
std::optional<bool> OutputWatch::isFrozen(const Blocks& now) const {
    const auto before = std::ranges::find_if(history_, [&](const Blocks& then) {
        const double age = now.seconds - then.seconds;
        return age <= 1.6 * options_.window && age > 0.0 && then.seen.size() == now.seen.size() &&
               std::ranges::equal(then.strokes, now.strokes,
                                  [](double a, double b) { return std::abs(a - b) < kSameBend; });
    });
    if (before == history_.end() || !(gain_ > 0.0)) return std::nullopt;
    std::vector<double> shares;
    for (std::size_t i = 0; i < now.seen.size(); ++i) {
        const double should = gain_ * (now.predicted[i] - before->predicted[i]);
        if (std::abs(should) > kLeastContrast) shares.push_back((now.seen[i] - before->seen[i]) / should);
    }
    if (shares.size() < kFewestChanging) return std::nullopt;
    const double share = medianOf(shares);
    if (share < kStill) return true;
    return share > kMoving ? std::optional(false) : std::nullopt;
}

void OutputWatch::conclude(OutputReport::State seen, double now) {
    const bool isFault = seen == OutputReport::State::black || seen == OutputReport::State::frozen;
    if (seen != suspect_) suspectSince_ = now;
    suspect_ = seen;
    if (isFault && now - suspectSince_ < options_.patience) return;
    report_ = {seen, sentenceFor(seen)};
}

const OutputReport& OutputWatch::look(const ShowLook& show, const Progress& progress) {
    std::optional<Blocks> blocks = blocksOf(show, progress);
    progress.throwIfCancelled();
    if (!blocks) {
        conclude(OutputReport::State::blind, show.seconds);
        return report_;
    }
    const Match match = matchOf(*blocks);
    const double expected = (gain_ > 0.0 ? gain_ : 1e3) * match.predictedSpread; // unknown: whatever has structure
    const bool isDarkContent = expected < kLeastContrast;
    const std::optional<bool> frozen = isFrozen(*blocks);
    OutputReport::State state = report_.state;
    if (!isDarkContent && isBlack(match)) {
        state = OutputReport::State::black;
    } else if (frozen && *frozen) {
        state = OutputReport::State::frozen;
    } else if (isDarkContent) {
        state = OutputReport::State::blind;
    } else if (match.alike > kHealthy && (!frozen || !*frozen)) {
        state = OutputReport::State::shown;
        gain_ = gain_ > 0.0 ? gain_ + kLearns * (match.gain - gain_) : match.gain;
    }
    conclude(state, show.seconds);
    history_.push_back(std::move(*blocks));
    while (history_.front().seconds < show.seconds - 1.6 * options_.window) history_.pop_front();
    return report_;
}

} // namespace lumorph
