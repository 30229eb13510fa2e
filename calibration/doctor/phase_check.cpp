#include "calibration/doctor/phase_check.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <string>

#include <opencv2/imgproc.hpp>

namespace lumorph {

namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr float kLeastAmplitude = 0.3F; // of what bright pixels have
constexpr double kCountsDiffer = 0.35;  // periods
constexpr double kAgree = 0.75;     // mean cosine between a set and the next coarser one: above, they belong together
constexpr double kContradict = 0.5; // below, they do not
constexpr int kFewestPlaces = 200;
constexpr int kApart = 4; // pixels between the places whose phases are compared

/// One set of phases, by step.
struct StepImages {
    int periods = 1;
    std::vector<int> images;
};

/// A step of phase at a place, and one at a neighbour: where a fine set turns once, a coarse one turns a part.
struct Turns {
    cv::Mat1f turns;     ///< 0 to 1
    cv::Mat1f amplitude; ///< grey levels
};

std::vector<StepImages> setsOfAxis(const CaptureOrder& order, PatternAxis axis) {
    std::map<int, StepImages> sets;
    for (int i = 0; i < static_cast<int>(order.images.size()); ++i)
        if (const auto* phase = std::get_if<PhaseStep>(&order.images[static_cast<std::size_t>(i)]);
            phase != nullptr && phase->axis == axis) {
            StepImages& set = sets[phase->periods];
            set.periods = phase->periods;
            set.images.resize(static_cast<std::size_t>(phase->steps), -1);
            if (phase->step < phase->steps) set.images[static_cast<std::size_t>(phase->step)] = i;
        }
    std::vector<StepImages> all;
    for (const auto& [periods, set] : sets)
        if (std::ranges::find(set.images, -1) == set.images.end()) all.push_back(set);
    return all;
}

Turns turnsOf(const std::vector<cv::Mat>& images, const std::vector<int>& steps) {
    cv::Mat1f sine = cv::Mat1f::zeros(images.front().size());
    cv::Mat1f cosine = cv::Mat1f::zeros(images.front().size());
    for (std::size_t k = 0; k < steps.size(); ++k) {
        const double angle = kTurn * static_cast<double>(k) / static_cast<double>(steps.size());
        cv::Mat1f grey;
        images[static_cast<std::size_t>(steps[k])].convertTo(grey, CV_32F, 2.0 / static_cast<double>(steps.size()));
        sine += std::sin(angle) * grey;
        cosine += std::cos(angle) * grey;
    }
    Turns turns;
    cv::Mat1f angle;
    cv::cartToPolar(cosine, sine, turns.amplitude, angle);
    turns.turns = angle / kTurn;
    return turns;
}

/// The same of blurred images: a coarse set changes slowly, and noise is what turns it over.
Turns smoothTurnsOf(const std::vector<cv::Mat>& images, const std::vector<int>& steps) {
    std::vector<cv::Mat> smooth;
    std::vector<int> order;
    for (const int step : steps) {
        cv::GaussianBlur(images[static_cast<std::size_t>(step)], smooth.emplace_back(), {}, 2.0);
        order.push_back(static_cast<int>(order.size()));
    }
    return turnsOf(smooth, order);
}

float wrapped(float turns) { return turns - std::round(turns); }

/// Above this amplitude a phase is known.
float leastOf(const cv::Mat1f& amplitude) {
    std::vector<float> values;
    for (int y = 0; y < amplitude.rows; y += kApart)
        for (int x = 0; x < amplitude.cols; x += kApart) values.push_back(amplitude(y, x));
    const auto bright = values.begin() + static_cast<std::ptrdiff_t>(values.size() * 9 / 10);
    std::ranges::nth_element(values, bright);
    return std::max(2.0F, kLeastAmplitude * *bright);
}

/// How many times a fine set turns while a coarser one turns once, from neighbouring pixels; nothing where too few are
/// known or they do not agree.
std::optional<double> turnsByOne(const Turns& coarse, const Turns& fine) {
    const float leastCoarse = leastOf(coarse.amplitude);
    const float leastFine = leastOf(fine.amplitude);
    double mixed = 0.0;
    double square = 0.0;
    int count = 0;
    const auto known = [&](int y, int x) {
        return coarse.amplitude(y, x) > leastCoarse && fine.amplitude(y, x) > leastFine;
    };
    const auto take = [&](int y, int x, int down, int right) {
        if (!known(y, x) || !known(y + down, x + right)) return;
        const float byFine = wrapped(fine.turns(y + down, x + right) - fine.turns(y, x));
        const float byCoarse = wrapped(coarse.turns(y + down, x + right) - coarse.turns(y, x));
        if (std::abs(byFine) > 0.3F || std::abs(byCoarse) > 0.1F) return; // may have turned farther than it seems
        mixed += byFine * byCoarse;
        square += byCoarse * byCoarse;
        ++count;
    };
    // Along the way in which the fine set turns; along the other both only have noise.
    for (const bool down : {false, true})
        for (int y = 0; y + kApart < fine.turns.rows; y += 2)
            for (int x = 0; x + kApart < fine.turns.cols; x += 2) take(y, x, down ? kApart : 0, down ? 0 : kApart);
    if (count < kFewestPlaces || !(square > 0.0)) return std::nullopt;
    return mixed / square;
}

/// Mean cosine between a fine set and a coarse one that turns `periods` times as slowly.
double agreementOf(const Turns& coarse, const Turns& fine, double periods) {
    const float leastCoarse = leastOf(coarse.amplitude);
    const float leastFine = leastOf(fine.amplitude);
    double sum = 0.0;
    int count = 0;
    for (int y = 0; y < fine.turns.rows; y += 3)
        for (int x = 0; x < fine.turns.cols; x += 3) {
            if (coarse.amplitude(y, x) < leastCoarse || fine.amplitude(y, x) < leastFine) continue;
            sum += std::cos(kTurn * (periods * coarse.turns(y, x) - fine.turns(y, x)));
            ++count;
        }
    return count < kFewestPlaces ? 1.0 : sum / count;
}

/// The number of periods by which a fine set agrees best with a coarse one of one period: a whole number.
int periodsThatAgree(const Turns& coarse, const Turns& fine, int most, double& agreement) {
    int best = 1;
    agreement = -1.0;
    for (int periods = 1; periods <= most; ++periods)
        if (const double here = agreementOf(coarse, fine, periods); here > agreement) agreement = here, best = periods;
    return best;
}

/// Orders in which steps are met by mistake: two neighbours exchanged, begun at another step, backwards.
std::vector<std::vector<int>> mixedOrders(int steps) {
    std::vector<std::vector<int>> all;
    std::vector<int> usual(static_cast<std::size_t>(steps));
    std::iota(usual.begin(), usual.end(), 0);
    for (std::size_t k = 0; k + 1 < usual.size(); ++k) {
        std::vector<int> other = usual;
        std::swap(other[k], other[k + 1]);
        all.push_back(other);
    }
    for (std::size_t k = 1; k < usual.size(); ++k) {
        std::vector<int> other = usual;
        std::rotate(other.begin(), other.begin() + static_cast<std::ptrdiff_t>(k), other.end());
        all.push_back(other);
    }
    std::vector<int> back = usual;
    std::reverse(back.begin() + 1, back.end());
    all.push_back(back);
    return all;
}

std::vector<int> inOrder(const std::vector<int>& images, const std::vector<int>& order) {
    std::vector<int> all;
    all.reserve(order.size());
    for (const int k : order) all.push_back(images[static_cast<std::size_t>(k)]);
    return all;
}

/// Whether a set of one period turns over within the picture: from the last to the first between neighbours. It begins
/// at the projector's one end and ends at the other.
bool turnsOver(const Turns& coarse) {
    constexpr float kJump = 0.6F;
    constexpr int kFewestJumps = 100;
    const cv::Point kAcross(kApart, 0), kDown(0, kApart);
    const float least = leastOf(coarse.amplitude);
    const cv::Rect all(cv::Point(), coarse.turns.size());
    const auto isLit = [&](cv::Point at) { return all.contains(at) && coarse.amplitude(at) > least; };
    // Past the projector's picture it is dark; at its rim noise turns over as well.
    const auto isInside = [&](cv::Point at) {
        return isLit(at) && isLit(at + 3 * kAcross) && isLit(at - 3 * kAcross) && isLit(at + 3 * kDown) &&
               isLit(at - 3 * kDown);
    };
    int jumps = 0;
    for (int y = 0; y < coarse.turns.rows; y += 2)
        for (int x = 0; x < coarse.turns.cols; x += 2) {
            if (!isInside({x, y})) continue;
            for (const cv::Point way : {kAcross, kDown})
                jumps += isLit(cv::Point(x, y) + way) &&
                         std::abs(coarse.turns(cv::Point(x, y) + way) - coarse.turns(y, x)) > kJump;
        }
    return jumps > kFewestJumps;
}

std::string axisWords(PatternAxis axis) { return axis == PatternAxis::columns ? "columns" : "rows"; }

/// Light swings by its mean at most, from none to twice of it; what swings more went through a curve.
std::optional<Finding> bentByCurve(const CapturedView& view, const std::vector<cv::Mat>& images,
                                   const std::vector<StepImages>& sets) {
    constexpr float kMostSwing = 1.08F, kCut = 1.5F;
    constexpr double kMostCut = 0.9; // a strong gamma makes black of much as well
    for (const StepImages& set : sets) {
        if (set.images.size() > 3) continue; // four steps or more bear it
        const cv::Mat1f amplitude = turnsOf(images, set.images).amplitude;
        const float least = leastOf(amplitude);
        std::vector<float> swings;
        double cut = 0.0;
        for (int y = 0; y < amplitude.rows; y += 3)
            for (int x = 0; x < amplitude.cols; x += 3) {
                if (amplitude(y, x) < least) continue;
                float mean = 0.0F;
                bool isCut = false;
                for (const int i : set.images) {
                    const float grey = images[static_cast<std::size_t>(i)].at<uchar>(y, x);
                    mean += grey / static_cast<float>(set.images.size());
                    isCut = isCut || grey < kCut;
                }
                swings.push_back(amplitude(y, x) / std::max(mean, 1.0F));
                cut += isCut;
            }
        if (std::ssize(swings) < kFewestPlaces) continue;
        const double share = cut / static_cast<double>(swings.size());
        const auto middle = swings.begin() + static_cast<std::ptrdiff_t>(swings.size() / 2);
        std::ranges::nth_element(swings, middle);
        if (*middle < kMostSwing) continue;
        const std::string file = view.files.at(static_cast<std::size_t>(set.images.front())).filename().string();
        if (share > kMostCut)
            return Finding{Cause::clipped, view.name, file,
                           std::to_string(std::lround(100.0 * share)) + " % of what is seen is cut off at black",
                           "expose for longer, or lower the camera's black level"};
        return Finding{Cause::projectorGamma, view.name, file,
                       "the phases swing by " + std::to_string(std::lround(100.0F * *middle)) +
                           " % of their mean, which only a gamma does",
                       "set the response of projector and camera to linear, or use Gray code"};
    }
    return std::nullopt;
}

class AxisCheck {
public:
    AxisCheck(const CapturedView& view, const std::vector<cv::Mat>& images, const CaptureOrder& order, PatternAxis axis)
        : view_(view), images_(images), axis_(axis), sets_(setsOfAxis(order, axis)) {}

    [[nodiscard]] std::optional<Finding> finding() const {
        if (auto bent = bentByCurve(view_, images_, sets_)) return bent;
        if (sets_.size() < 2 || sets_.front().periods != 1) return std::nullopt; // beats tell no more than they need
        for (std::size_t s = 0; s + 1 < sets_.size(); ++s)
            if (auto found = compared(sets_[s], sets_[s + 1])) return found;
        const StepImages& coarse = sets_.front();
        if (turnsOver(smoothTurnsOf(images_, coarse.images)))
            return exchanged(coarse, "the " + axisWords(axis_) +
                                         " turn over within the picture: the steps begin elsewhere or are exchanged");
        return std::nullopt;
    }

private:
    [[nodiscard]] std::optional<Finding> compared(const StepImages& coarse, const StepImages& fine) const {
        const double ratio = static_cast<double>(fine.periods) / coarse.periods;
        const Turns slow = turnsOf(images_, coarse.images);
        const Turns quick = turnsOf(images_, fine.images);
        if (agreementOf(slow, quick, ratio) > kContradict) return std::nullopt;
        if (coarse.periods == 1) {
            double agreement = 0.0;
            const int periods = periodsThatAgree(slow, quick, 3 * fine.periods + 8, agreement);
            if (agreement > kAgree && periods != fine.periods) return otherCount(fine, periods);
        } else if (const auto seen = turnsByOne(slow, quick); seen && std::abs(*seen - ratio) > kCountsDiffer) {
            return otherCount(fine, static_cast<int>(std::lround(std::abs(*seen) * coarse.periods)));
        }
        for (const bool isFine : {true, false})
            for (const auto& mixed : mixedOrders(static_cast<int>((isFine ? fine : coarse).images.size()))) {
                const Turns other = turnsOf(images_, inOrder((isFine ? fine : coarse).images, mixed));
                if (agreementOf(isFine ? slow : other, isFine ? other : quick, ratio) > kAgree)
                    return exchanged(isFine ? fine : coarse, "steps of " +
                                                                 std::to_string((isFine ? fine : coarse).periods) +
                                                                 " periods stand in another order than those of " +
                                                                 std::to_string((isFine ? coarse : fine).periods));
            }
        return std::nullopt; // dark, blurred, or bent by gamma: others find out
    }

    [[nodiscard]] Finding otherCount(const StepImages& fine, int seen) const {
        return {Cause::periodCount, view_.name, fileOf(fine),
                std::to_string(fine.periods) + " periods were said for the " + axisWords(axis_) + ", but " +
                    std::to_string(seen) + " are seen",
                "give the number that was projected, such as --pattern phase:" + std::to_string(seen) + "x" +
                    std::to_string(fine.images.size()) + "+1x" + std::to_string(fine.images.size())};
    }

    [[nodiscard]] Finding exchanged(const StepImages& set, const std::string& why) const {
        return {Cause::phaseOrder, view_.name, fileOf(set), why,
                "put the images into the order of the steps, or say their order in an order file"};
    }

    [[nodiscard]] std::string fileOf(const StepImages& set) const {
        return view_.files.at(static_cast<std::size_t>(set.images.front())).filename().string();
    }

    const CapturedView& view_;
    const std::vector<cv::Mat>& images_;
    PatternAxis axis_;
    std::vector<StepImages> sets_;
};

} // namespace

std::optional<Finding> checkPhases(const CapturedView& view, const std::vector<cv::Mat>& images,
                                   const CaptureOrder& order) {
    for (const PatternAxis axis : {PatternAxis::columns, PatternAxis::rows})
        if (auto found = AxisCheck(view, images, order, axis).finding()) return found;
    return std::nullopt;
}

std::optional<FineContrast> fineContrast(const std::vector<cv::Mat>& images, const CaptureOrder& order,
                                         PatternAxis axis) {
    const std::vector<StepImages> sets = setsOfAxis(order, axis);
    if (sets.size() < 2) return std::nullopt;
    const cv::Mat1f coarse = turnsOf(images, sets.front().images).amplitude;
    const cv::Mat1f fine = turnsOf(images, sets.back().images).amplitude;
    const float least = leastOf(coarse);
    std::vector<float> ratios;
    for (int y = 0; y < coarse.rows; y += 3)
        for (int x = 0; x < coarse.cols; x += 3)
            if (coarse(y, x) > least) ratios.push_back(fine(y, x) / coarse(y, x));
    if (ratios.empty()) return std::nullopt;
    const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
    std::ranges::nth_element(ratios, middle);
    return FineContrast{*middle, sets.back().periods};
}

} // namespace lumorph
