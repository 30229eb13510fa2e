#include "calibration/delays/flash_delay.h"

#include <algorithm>
#include <limits>
#include <random>

namespace lumorph {

namespace {

constexpr int kFewestFlashes = 8;
constexpr int kRows = 4;              ///< of the region that stand for all
constexpr double kScan = 0.001;       ///< seconds
constexpr double kElsewhere = 0.03;   ///< seconds from the best delay: another one
constexpr double kFollows = 0.6;      ///< of the brightness's variance that the flashes explain at least
constexpr double kOneOfSeveral = 1.5; ///< times the cost of the best delay: as good
constexpr double kLostSeconds = 0.25; ///< without a picture: a flash that is within is not seen

/// Seconds of [from, to] that lie in [on, off].
double overlap(double from, double to, double on, double off) {
    return std::max(0.0, std::min(to, off) - std::max(from, on));
}

class FlashFit {
public:
    explicit FlashFit(const FlashRecording& recording) : all_(recording) {
        double usual = 1.0;
        for (std::size_t i = 1; i < recording.pictures.size(); ++i)
            usual = std::min(usual, recording.pictures[i].seconds - recording.pictures[i - 1].seconds);
        for (std::size_t k = 0; k < recording.flashes.size(); ++k)
            if (isWatched(recording.flashes[k])) flashes_.push_back(k);
        // Each picture belongs to the flash that began last before it, or to the first.
        for (const FlashRecording::Picture& picture : recording.pictures) {
            const auto next =
                std::ranges::upper_bound(recording.flashes, picture.seconds - 0.03, {}, &FlashRecording::Flash::on);
            owner_.push_back(
                next == recording.flashes.begin() ? 0 : static_cast<std::size_t>(next - recording.flashes.begin()) - 1);
        }
    }

    [[nodiscard]] const std::vector<std::size_t>& flashes() const { return flashes_; }

    struct Cost {
        double square = 0.0, variance = 0.0, pictures = 0.0, gain = 0.0;
    };
    /// Of pictures whose flash `use` takes.
    template <typename Use> [[nodiscard]] Cost at(double delay, const Use& use) const {
        double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, yy = 0.0, xy = 0.0;
        for (std::size_t i = 0; i < all_.pictures.size(); ++i) {
            if (!use(owner_[i])) continue;
            const double share = lit(i, delay), bright = all_.pictures[i].brightness - all_.pictures.front().brightness;
            n += 1.0;
            x += share;
            y += bright;
            xx += share * share;
            yy += bright * bright;
            xy += share * bright;
        }
        if (n < 3.0) return {};
        const double varX = xx - x * x / n, varY = yy - y * y / n, both = xy - x * y / n;
        const double gain = varX > 1e-9 ? both / varX : 0.0;
        return {gain > 0.0 ? varY - gain * both : varY, varY, n, gain}; // light that darkens is none
    }

private:
    /// Share of a picture's exposure at which light was on.
    [[nodiscard]] double lit(std::size_t picture, double delay) const {
        const std::size_t owner = owner_[picture];
        double share = 0.0;
        for (int row = 0; row < kRows; ++row) {
            const double at = (row + 0.5) / kRows;
            const double from = all_.pictures[picture].seconds + all_.firstRow + at * (all_.lastRow - all_.firstRow);
            for (std::size_t k = owner < 4 ? 0 : owner - 4; k <= owner + 1 && k < all_.flashes.size(); ++k)
                share += overlap(from, from + all_.exposure, all_.flashes[k].on + delay, all_.flashes[k].off + delay);
        }
        return share / (kRows * all_.exposure);
    }
    /// There are pictures of it from its light to the dark after it, whatever the delay is.
    [[nodiscard]] bool isWatched(const FlashRecording::Flash& flash) const {
        double last = flash.on - kLostSeconds;
        const auto first = std::ranges::lower_bound(all_.pictures, last, {}, &FlashRecording::Picture::seconds);
        for (auto picture = first; picture != all_.pictures.end(); ++picture) {
            if (picture->seconds - last > kLostSeconds) return false;
            last = picture->seconds;
            if (last > flash.off + 0.2) return true;
        }
        return false;
    }

    const FlashRecording& all_;
    std::vector<std::size_t> flashes_; ///< that were watched
    std::vector<std::size_t> owner_;   ///< of each picture
};

void check(const FlashRecording& recording) {
    const char* what = "flashes";
    std::vector<double> times;
    for (const FlashRecording::Picture& picture : recording.pictures) {
        if (!std::isfinite(picture.brightness))
            delays::refuse(Cause::notANumber, what, "the brightness of a picture is no number", "record it again");
        times.push_back(picture.seconds);
    }
    delays::checkPictures(times, what, kSlowestForFlashes);
    double before = -std::numeric_limits<double>::infinity();
    for (const FlashRecording::Flash& flash : recording.flashes) {
        if (!std::isfinite(flash.on) || !std::isfinite(flash.off))
            delays::refuse(Cause::notANumber, what, "the time of a flash is no number", "record it again");
        if (!(flash.on > before) || !(flash.off > flash.on))
            delays::refuse(Cause::clockJumps, what, "a flash is asked for before the one before it ends",
                           "record it again with times by one clock");
        before = flash.off;
    }
    if (!(recording.exposure > 0.0) || !(recording.lastRow >= recording.firstRow))
        delays::refuse(Cause::notANumber, what, "the camera's exposure is no positive time", "say how long it exposes");
}

} // namespace

std::vector<FlashRecording::Flash> planFlashes(int count, double begin, unsigned seed) {
    std::mt19937 dice(seed);
    std::uniform_real_distribution<double> any(0.0, 1.0);
    std::vector<FlashRecording::Flash> flashes;
    double now = begin;
    for (int k = 0; k < count; ++k) {
        const double on = now, off = on + 0.1 + 0.05 * any(dice);
        flashes.push_back({on, off});
        now = off + 0.12 + 0.15 * any(dice);
    }
    return flashes;
}

MeasuredDelay solveFlashDelay(const FlashRecording& recording, const Progress& progress) {
    const char* what = "flashes";
    check(recording);
    const FlashFit fit(recording);
    const auto count = static_cast<int>(fit.flashes().size());
    if (count < kFewestFlashes)
        delays::refuse(Cause::tooFewViews, what,
                       "the camera's pictures show " + std::to_string(count) + " of " +
                           std::to_string(recording.flashes.size()) + " flashes: it lost pictures or was unplugged",
                       "look after the camera, then flash again");
    const auto every = [](std::size_t) { return true; };
    // All delays first: what is as good elsewhere tells nothing.
    std::vector<double> costs;
    for (double delay = -0.02; delay < kLongestDelay; delay += kScan) {
        progress.throwIfCancelled();
        costs.push_back(fit.at(delay, every).square);
    }
    const auto best = std::ranges::min_element(costs);
    const double near = -0.02 + kScan * static_cast<double>(best - costs.begin());
    const FlashFit::Cost found = fit.at(near, every);
    if (!(found.square < (1.0 - kFollows) * found.variance) || !(found.variance > 0.0))
        delays::refuse(Cause::flashNotSeen, what, "the brightness of the pictures does not follow the flashes",
                       "let the camera see where they fall, switch its automatic exposure off, and darken the room");
    for (std::size_t i = 0; i < costs.size(); ++i)
        if (std::abs(-0.02 + kScan * static_cast<double>(i) - near) > kElsewhere &&
            costs[i] < kOneOfSeveral * found.square + 0.02 * found.variance)
            delays::refuse(Cause::motionPeriodic, what, "the flashes come so evenly that several delays explain them",
                           "flash at times that do not repeat");

    const auto nearest = [&](const auto& use, double around) {
        return delays::smallestBetween(around - 2.0 * kScan, around + 2.0 * kScan, 1e-5,
                                       [&](double delay) { return fit.at(delay, use).square; });
    };
    /// The cost has small valleys where edges leave an exposure: each is looked into.
    const auto solved = [&](const auto& use) {
        double least = std::numeric_limits<double>::infinity(), at = near;
        for (double delay = near - 0.008; delay <= near + 0.008; delay += kScan)
            if (const double cost = fit.at(delay, use).square; cost < least) {
                least = cost;
                at = delay;
            }
        return nearest(use, at);
    };
    MeasuredDelay delay;
    delay.seconds = solved(every);
    const FlashFit::Cost last = fit.at(delay.seconds, every);
    delay.residual = std::sqrt(last.square / last.pictures) / last.gain;
    delay.events = count;
    std::vector<double> without;
    for (const std::size_t left : fit.flashes()) {
        progress.throwIfCancelled();
        without.push_back(solved([left](std::size_t owner) { return owner != left; }));
    }
    delay.sigma = std::hypot(delays::jackknife(without), recording.arrivalSigma);
    const std::size_t middle = fit.flashes()[fit.flashes().size() / 2];
    delay.halvesDiffer = std::abs(solved([middle](std::size_t owner) { return owner < middle; }) -
                                  solved([middle](std::size_t owner) { return owner >= middle; }));
    return delay;
}

} // namespace lumorph
