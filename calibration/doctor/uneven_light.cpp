#include "calibration/doctor/uneven_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include <Eigen/Dense>
#include <opencv2/imgproc.hpp>

#include "calibration/decode/pattern_decoder.h"

namespace lumorph {

namespace {

constexpr int kGrid = 4;                 // pixels that are looked at, along both sides
constexpr double kEvenLight = 0.08;      // of the light: below, a set makes even light
constexpr double kLeastGreys = 12.0;     // grey levels between a pixel's darkest and brightest
constexpr double kShareOfBright = 0.4;   // of the light of bright pixels: below, a pixel is not looked at
constexpr double kSteadyGain = 0.03;     // by which gains may differ
constexpr double kMostGain = 4.0;        // beyond, an image shows something else
constexpr double kFewestUnclipped = 0.1; // of pixels: below, what is cut off leaves nothing to compare
constexpr double kChanged = 0.15;        // of the light: above, a pixel shows something else
constexpr int kBlock = 16;               // pixels a side

/// The images of a pose at pixels that the projector lights well.
struct Samples {
    std::vector<std::vector<int>> sets; ///< that make even light, by image
    Eigen::MatrixXf grey;               ///< pixels down, images across
    Eigen::VectorXf range;              ///< of each pixel, from its darkest to its brightest

    [[nodiscard]] bool isLit() const { return grey.rows() > 100 && sets.size() > 2; }

    /// Mean of each set at each pixel; pixels down, sets across.
    [[nodiscard]] Eigen::MatrixXf means(const Eigen::MatrixXf& of) const {
        Eigen::MatrixXf all = Eigen::MatrixXf::Zero(of.rows(), static_cast<Eigen::Index>(sets.size()));
        for (std::size_t s = 0; s < sets.size(); ++s)
            for (const int i : sets[s])
                all.col(static_cast<Eigen::Index>(s)) += of.col(i) / static_cast<float>(sets[s].size());
        return all;
    }
};

Samples samplesOf(const std::vector<cv::Mat>& images, const CaptureOrder& order) {
    Samples samples;
    samples.sets = evenSets(order);
    struct Place {
        cv::Point at;
        float range = 0.0F;
    };
    std::vector<Place> places;
    cv::Mat1b least = images.front().clone();
    cv::Mat1b most = images.front().clone();
    for (const cv::Mat& image : images) {
        cv::min(least, image, least);
        cv::max(most, image, most);
    }
    for (int y = 0; y < least.rows; y += kGrid)
        for (int x = 0; x < least.cols; x += kGrid)
            if (const int range = most(y, x) - least(y, x); range > kLeastGreys)
                places.push_back({{x, y}, static_cast<float>(range)});
    if (places.empty()) return samples;
    const auto bright = places.begin() + static_cast<std::ptrdiff_t>(places.size() * 9 / 10);
    std::ranges::nth_element(places, bright, {}, &Place::range);
    const auto enough = static_cast<float>(kShareOfBright * bright->range);
    std::erase_if(places, [enough](const Place& place) { return place.range < enough; });
    samples.grey.resize(static_cast<Eigen::Index>(places.size()), static_cast<Eigen::Index>(images.size()));
    samples.range.resize(static_cast<Eigen::Index>(places.size()));
    for (std::size_t p = 0; p < places.size(); ++p) {
        samples.range[static_cast<Eigen::Index>(p)] = places[p].range;
        for (std::size_t i = 0; i < images.size(); ++i)
            samples.grey(static_cast<Eigen::Index>(p), static_cast<Eigen::Index>(i)) =
                images[i].at<uchar>(places[p].at);
    }
    return samples;
}

float medianOfRow(std::vector<float>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
}

/// How far each set is from the even light that most sets make, as a share of the light; mean over pixels. Those that
/// are not to be looked at are not a number.
Eigen::VectorXf unevenness(const Eigen::MatrixXf& means, const Eigen::VectorXf& range) {
    Eigen::VectorXf sum = Eigen::VectorXf::Zero(means.cols());
    Eigen::VectorXf count = Eigen::VectorXf::Zero(means.cols());
    std::vector<float> known;
    for (Eigen::Index p = 0; p < means.rows(); ++p) {
        known.clear();
        for (Eigen::Index s = 0; s < means.cols(); ++s)
            if (std::isfinite(means(p, s))) known.push_back(means(p, s));
        if (known.size() < 2) continue;
        const float even = medianOfRow(known);
        for (Eigen::Index s = 0; s < means.cols(); ++s) {
            if (!std::isfinite(means(p, s))) continue;
            sum[s] += std::abs(means(p, s) - even) / range[p];
            count[s] += 1.0F;
        }
    }
    for (Eigen::Index s = 0; s < sum.size(); ++s)
        sum[s] = count[s] > static_cast<float>(kFewestUnclipped) * static_cast<float>(means.rows())
                     ? sum[s] / count[s]
                     : std::numeric_limits<float>::quiet_NaN();
    return sum;
}

/// Whether all sets that can be judged, two of three at least, make even light.
bool areEven(const Eigen::VectorXf& uneven) {
    int judged = 0;
    for (const float value : uneven) {
        if (!std::isfinite(value)) continue;
        ++judged;
        if (value >= static_cast<float>(kEvenLight)) return false;
    }
    return 3 * judged >= 2 * static_cast<int>(uneven.size());
}

std::vector<double> gainsIn(const Samples& samples) {
    const auto images = samples.grey.cols();
    const auto setCount = static_cast<Eigen::Index>(samples.sets.size());
    Eigen::MatrixXd averaging = Eigen::MatrixXd::Zero(setCount, images);
    for (Eigen::Index s = 0; s < setCount; ++s)
        for (const int i : samples.sets[static_cast<std::size_t>(s)])
            averaging(s, i) = 1.0 / static_cast<double>(samples.sets[static_cast<std::size_t>(s)].size());
    averaging.rowwise() -= averaging.colwise().mean().eval();
    const Eigen::MatrixXf scaled = samples.range.cwiseInverse().asDiagonal() * samples.grey;
    const Eigen::MatrixXd gram = (scaled.transpose() * scaled).cast<double>();
    Eigen::MatrixXd normal = (averaging.transpose() * averaging).cwiseProduct(gram);
    std::vector<int> used;
    for (const auto& set : samples.sets) used.insert(used.end(), set.begin(), set.end());
    const auto count = static_cast<Eigen::Index>(used.size());
    Eigen::MatrixXd some(count, count);
    for (Eigen::Index i = 0; i < count; ++i)
        for (Eigen::Index k = 0; k < count; ++k)
            some(i, k) = normal(used[static_cast<std::size_t>(i)], used[static_cast<std::size_t>(k)]);
    some.diagonal().array() += 1e-5 * some.trace() / static_cast<double>(count); // towards no change
    Eigen::VectorXd undo = some.ldlt().solve(Eigen::VectorXd::Ones(count));
    undo /= undo.mean();
    std::vector<double> gains(static_cast<std::size_t>(images), 1.0);
    for (Eigen::Index i = 0; i < count; ++i)
        gains[static_cast<std::size_t>(used[static_cast<std::size_t>(i)])] = 1.0 / undo[i];
    return gains;
}

Eigen::MatrixXf withoutGains(const Samples& samples, const std::vector<double>& gains) {
    Eigen::MatrixXf all = samples.grey;
    for (Eigen::Index i = 0; i < all.cols(); ++i) all.col(i) /= static_cast<float>(gains[static_cast<std::size_t>(i)]);
    return all;
}

std::string percent(double share) { return std::to_string(static_cast<int>(std::lround(100.0 * share))) + " %"; }

std::string fileOfImage(const CapturedView& view, int image) {
    return view.files.at(static_cast<std::size_t>(image)).filename().string();
}

std::optional<Finding> driftIn(const CapturedView& view, const Samples& samples) {
    const std::vector<double> gains = gainsIn(samples);
    const auto [least, most] = std::ranges::minmax(gains);
    if (!(least > 0.0) || most > kMostGain * least || most < (1.0 + kSteadyGain) * least) return std::nullopt;
    if (!areEven(unevenness(samples.means(withoutGains(samples, gains)), samples.range))) return std::nullopt;
    int at = 0; // where it changes most
    double step = 0.0;
    int before = -1;
    for (const auto& set : samples.sets)
        for (const int i : set) {
            const auto here = static_cast<std::size_t>(i);
            if (before >= 0 && std::abs(gains[here] - gains[static_cast<std::size_t>(before)]) > step)
                step = std::abs(gains[here] - gains[static_cast<std::size_t>(before)]), at = i;
            before = i;
        }
    return driftFinding(view.name, fileOfImage(view, at), most / least - 1.0);
}

/// The most uneven of the sets that can be judged; infinite where too few can.
float mostUneven(const Eigen::VectorXf& uneven) {
    float most = 0.0F;
    int judged = 0;
    for (const float value : uneven)
        if (std::isfinite(value)) most = std::max(most, value), ++judged;
    return 3 * judged >= 2 * static_cast<int>(uneven.size()) ? most : std::numeric_limits<float>::infinity();
}

std::optional<Finding> curveIn(const CapturedView& view, const Samples& samples) {
    constexpr std::array kPowers = {0.25, 0.33, 0.4, 0.45, 0.55, 0.7, 1.4, 1.8, 2.2, 2.8};
    double best = 1.0;
    auto least = static_cast<float>(kEvenLight);
    for (const double power : kPowers) {
        const auto straight = [power](float grey) {
            return static_cast<float>(255.0 * std::pow(std::max(0.0F, grey) / 255.0, power));
        };
        const Eigen::MatrixXf grey = samples.grey.unaryExpr(straight);
        const Eigen::VectorXf range = grey.rowwise().maxCoeff() - grey.rowwise().minCoeff();
        if (const float here = mostUneven(unevenness(samples.means(grey), range)); here < least)
            least = here, best = power;
    }
    if (best == 1.0) return std::nullopt;
    std::string exponent = std::to_string(1.0 / best);
    exponent.resize(exponent.find('.') + 2);
    return Finding{Cause::projectorGamma, view.name, "",
                   "the greys follow a curve, a gamma of about " + exponent +
                       ": patterns and their inverses do not add up",
                   "switch off gamma and contrast corrections in the camera; for phases set the projector's response "
                   "to linear"};
}

/// A Gray code under any curve, cut off or not: where a pixel is clearly lit or dark, pattern and inverse still add up;
/// at the edges of stripes they do not, and the finest stripes are edges all over.
std::optional<Finding> bentEdges(const CapturedView& view, const Samples& samples, const CaptureOrder& order) {
    constexpr float kClearly = 0.6F, kMostlyClear = 0.65F, kDark = 1.5F;
    constexpr int kFinest = 1;
    const Eigen::VectorXf uneven = unevenness(samples.means(samples.grey), samples.range);
    Eigen::MatrixXf means = samples.means(samples.grey);
    double dark = 0.0;
    double edges = 0.0;
    std::array<bool, 2> isFinestBent{}; // of columns, of rows
    for (std::size_t s = 0; s < samples.sets.size(); ++s) {
        const auto at = static_cast<Eigen::Index>(s);
        const auto* bit = std::get_if<GrayBit>(&order.images[static_cast<std::size_t>(samples.sets[s].front())]);
        if (bit == nullptr) return std::nullopt;
        Eigen::Index clear = 0;
        for (Eigen::Index p = 0; p < samples.grey.rows(); ++p) {
            const float one = samples.grey(p, samples.sets[s].front());
            const float other = samples.grey(p, samples.sets[s].back());
            if (std::abs(one - other) > kClearly * samples.range[p]) {
                ++clear;
                continue;
            }
            means(p, at) = std::numeric_limits<float>::quiet_NaN();
            dark += std::min(one, other) < kDark; // at an edge neither is black
            edges += 1.0;
        }
        const bool isJudged = bit->bit > kFinest || uneven[at] < static_cast<float>(kEvenLight);
        isFinestBent[bit->axis == PatternAxis::rows ? 1 : 0] |= !isJudged;
        if (!isJudged)
            means.col(at).setConstant(std::numeric_limits<float>::quiet_NaN());
        else if (static_cast<float>(clear) < kMostlyClear * static_cast<float>(samples.grey.rows()) &&
                 bit->bit > kFinest)
            return std::nullopt;
    }
    if (!isFinestBent[0] || !isFinestBent[1]) return std::nullopt; // a single image, not a curve
    if (mostUneven(unevenness(means, samples.range)) >= static_cast<float>(kEvenLight)) return std::nullopt;
    constexpr double kMuch = 0.2;
    if (const double share = dark / std::max(1.0, edges); share > kMuch)
        return Finding{Cause::clipped, view.name, "", percent(share) + " of the edges of stripes are cut off at black",
                       "expose for longer, or lower the camera's black level"};
    return Finding{Cause::projectorGamma, view.name, "",
                   "the greys follow a curve: at the edges of stripes patterns and their inverses do not add up",
                   "switch off gamma and contrast corrections in camera and projector"};
}

std::optional<Finding> clippingIn(const CapturedView& view, const Samples& samples) {
    constexpr float kDark = 1.5F, kBright = 253.5F;
    Eigen::MatrixXf means = samples.means(samples.grey);
    double dark = 0.0;
    double bright = 0.0;
    for (Eigen::Index p = 0; p < means.rows(); ++p)
        for (std::size_t s = 0; s < samples.sets.size(); ++s) {
            const auto anyOf = [&](auto is) {
                return std::ranges::any_of(samples.sets[s], [&](int i) { return is(samples.grey(p, i)); });
            };
            const bool isDark = anyOf([](float grey) { return grey < kDark; });
            const bool isBright = anyOf([](float grey) { return grey > kBright; });
            dark += isDark;
            bright += isBright;
            if (isDark || isBright) means(p, static_cast<Eigen::Index>(s)) = std::numeric_limits<float>::quiet_NaN();
        }
    const double all = static_cast<double>(means.size());
    constexpr double kFewest = 0.05;
    if (std::max(dark, bright) < kFewest * all || !areEven(unevenness(means, samples.range))) return std::nullopt;
    const bool isBlack = dark > bright;
    return Finding{Cause::clipped, view.name, "",
                   percent((isBlack ? dark : bright) / all) + " of what is seen is cut off at " +
                       (isBlack ? "black" : "white") + ", so that the patterns are lost",
                   isBlack ? "expose for longer, or lower the camera's black level"
                           : "expose for less time until white is below 250 of 255"};
}

std::optional<Finding> noiseIn(const CapturedView& view, const Samples& samples, const std::vector<cv::Mat>& images,
                               const CaptureOrder& order) {
    constexpr double kExplained = 1.5; // times what noise alone makes
    const double sigma = pixelNoiseOf(images, order);
    const Eigen::VectorXf uneven = unevenness(samples.means(samples.grey), samples.range);
    const double light = samples.range.mean();
    const double byRange = samples.range.cwiseInverse().mean();
    for (std::size_t s = 0; s < samples.sets.size(); ++s) {
        // Mean distance of a normal value: sqrt(2/pi) of its sigma.
        const double made = 0.8 * sigma / std::sqrt(static_cast<double>(samples.sets[s].size())) * byRange;
        if (uneven[static_cast<Eigen::Index>(s)] > kExplained * made) return std::nullopt;
    }
    return Finding{Cause::noisy, view.name, "",
                   "the pictures have a noise of " + std::to_string(static_cast<int>(std::lround(sigma))) +
                       " grey levels, where light makes " + std::to_string(static_cast<int>(std::lround(light))),
                   "expose for longer with less gain, bring more light onto the board"};
}

/// Even light that each set makes, at full size.
std::vector<cv::Mat1f> evenLightOf(const std::vector<cv::Mat>& images, const std::vector<std::vector<int>>& sets) {
    std::vector<cv::Mat1f> all;
    for (const auto& set : sets) {
        cv::Mat1f sum = cv::Mat1f::zeros(images.front().size());
        for (const int i : set) cv::accumulate(images[static_cast<std::size_t>(i)], sum);
        all.push_back(sum / static_cast<double>(set.size()));
    }
    return all;
}

/// Whether the picture after a set is that before it, shifted.
bool hasMovedAt(const std::vector<cv::Mat1f>& even, std::size_t set) {
    constexpr double kShift = 0.5, kResponse = 0.2; // pixels; response of a phase correlation
    if (set < 1 || set + 1 >= even.size()) return false;
    const auto meanOf = [&even](std::size_t from, std::size_t end) {
        cv::Mat1f sum = cv::Mat1f::zeros(even.front().size());
        for (std::size_t s = from; s < end; ++s) sum += even[s];
        return cv::Mat1f(sum / static_cast<double>(end - from));
    };
    cv::Mat window;
    cv::createHanningWindow(window, even.front().size(), CV_32F);
    double response = 0.0;
    const cv::Point2d shift = cv::phaseCorrelate(meanOf(0, set), meanOf(set + 1, even.size()), window, &response);
    return cv::norm(shift) > kShift && response > kResponse;
}

/// By how much an image leaves what all others stay within, as a share of the light.
cv::Mat1f leavesOthers(const std::vector<cv::Mat>& images, std::size_t image) {
    // The second least and most of the others: one more of them may be wrong.
    cv::Mat1b least(images.front().size(), 255), second(images.front().size(), 255);
    cv::Mat1b most(images.front().size(), 0), next(images.front().size(), 0);
    for (std::size_t i = 0; i < images.size(); ++i) {
        if (i == image) continue;
        cv::Mat higher, lower; // not Mat1b, of which three are std::max with an order
        cv::max(least, images[i], higher);
        cv::min(second, higher, second);
        cv::min(least, images[i], least);
        cv::min(most, images[i], lower);
        cv::max(next, lower, next);
        cv::max(most, images[i], most);
    }
    cv::Mat1f change(images.front().size(), std::numeric_limits<float>::quiet_NaN());
    for (int y = 0; y < change.rows; ++y)
        for (int x = 0; x < change.cols; ++x) {
            const float light = next(y, x) - second(y, x);
            if (light < kLeastGreys) continue;
            const float grey = images[image].at<uchar>(y, x);
            change(y, x) =
                std::max({0.0F, static_cast<float>(second(y, x)) - grey, grey - static_cast<float>(next(y, x))}) /
                light;
        }
    return change;
}

} // namespace

Difference differenceIn(const cv::Mat1f& change) {
    int blocks = 0;
    int touched = 0;
    int quiet = 0;
    for (int top = 0; top + kBlock <= change.rows; top += kBlock)
        for (int left = 0; left + kBlock <= change.cols; left += kBlock) {
            int known = 0;
            int changed = 0;
            for (int y = top; y < top + kBlock; y += 2)
                for (int x = left; x < left + kBlock; x += 2) {
                    if (!std::isfinite(change(y, x))) continue;
                    ++known;
                    changed += std::abs(change(y, x)) > static_cast<float>(kChanged);
                }
            if (known < kBlock) continue;
            ++blocks;
            touched += changed > known / 3;
            quiet += changed < known / 20;
        }
    if (blocks == 0 || (touched < std::max(2, blocks / 200) && 10 * quiet > 9 * blocks)) return Difference::none;
    return 3 * quiet > blocks && touched > 0 ? Difference::inPart : Difference::allOver;
}

SteadiedImages steadied(const std::vector<cv::Mat>& images, const CaptureOrder& order) {
    const Samples samples = samplesOf(images, order);
    SteadiedImages all{images, 0.0};
    if (!samples.isLit()) return all;
    const std::vector<double> gains = gainsIn(samples);
    const auto [least, most] = std::ranges::minmax(gains);
    if (!(least > 0.0) || most > kMostGain * least) return all;
    for (std::size_t i = 0; i < images.size(); ++i) {
        cv::Mat steady; // its own, for a copied Mat shares its pixels
        images[i].convertTo(steady, CV_8U, 1.0 / gains[i]);
        all.images[i] = steady;
    }
    all.change = most / least - 1.0;
    return all;
}

Finding driftFinding(const std::string& view, const std::string& file, double change) {
    return {Cause::exposureDrifts, view, file, "the brightness changes by " + percent(change) + " within the pose",
            "switch off automatic exposure and gain in the camera, let the lamp warm up, and capture again"};
}

double pixelNoiseOf(const std::vector<cv::Mat>& images, const CaptureOrder& order) {
    const auto sets = evenSets(order);
    const std::vector<cv::Mat1f> even = evenLightOf(images, sets);
    std::vector<float> estimates;
    for (std::size_t s = 0; s + 1 < even.size(); ++s) {
        const cv::Mat1f change = even[s + 1] - even[s];
        std::vector<float> steps;
        for (int y = 0; y < change.rows; y += 3)
            for (int x = 0; x + 1 < change.cols; x += 3) steps.push_back(std::abs(change(y, x + 1) - change(y, x)));
        const double share = 1.0 / static_cast<double>(sets[s].size()) + 1.0 / static_cast<double>(sets[s + 1].size());
        estimates.push_back(static_cast<float>(1.4826 * medianOfRow(steps) / std::sqrt(2.0 * share)));
    }
    if (estimates.empty()) return 0.0;
    const auto low = estimates.begin() + static_cast<std::ptrdiff_t>(estimates.size() / 4); // some sets may be wrong
    std::ranges::nth_element(estimates, low);
    return *low;
}

std::optional<Finding> causeInGreys(const CapturedView& view, const std::vector<cv::Mat>& images,
                                    const CaptureOrder& order) {
    const Samples samples = samplesOf(images, order);
    if (!samples.isLit() || areEven(unevenness(samples.means(samples.grey), samples.range))) return std::nullopt;
    if (auto noise = noiseIn(view, samples, images, order)) return noise;
    if (auto clipping = clippingIn(view, samples)) return clipping;
    if (auto bent = bentEdges(view, samples, order)) return bent;
    if (auto drift = driftIn(view, samples)) return drift;
    return curveIn(view, samples);
}

std::optional<Finding> causeInImages(const CapturedView& view, const std::vector<cv::Mat>& images,
                                     const CaptureOrder& order) {
    const auto sets = evenSets(order);
    const std::vector<cv::Mat1f> even = evenLightOf(images, sets);
    if (even.size() < 4) return std::nullopt;
    cv::Mat1f usual(images.front().size());
    std::vector<float> values(even.size());
    for (int y = 0; y < usual.rows; ++y)
        for (int x = 0; x < usual.cols; ++x) {
            for (std::size_t s = 0; s < even.size(); ++s) values[s] = even[s](y, x);
            usual(y, x) = medianOfRow(values);
        }
    const auto ranges = samplesOf(images, order);
    if (!ranges.isLit()) return std::nullopt;
    const float bright = ranges.range.mean();
    std::vector<std::size_t> wrong;
    bool isInPart = true;
    for (std::size_t s = 0; s < even.size(); ++s) {
        cv::Mat1f change = (even[s] - usual) / std::max(bright * 0.5F, static_cast<float>(kLeastGreys));
        change.setTo(std::numeric_limits<float>::quiet_NaN(), usual < 0.15F * bright); // in the dark
        const Difference how = differenceIn(change);
        if (how == Difference::none) continue;
        wrong.push_back(s);
        isInPart = isInPart && how == Difference::inPart;
    }
    if (wrong.empty()) return std::nullopt;
    for (const std::size_t s : {wrong.front(), wrong.back()})
        if (hasMovedAt(even, s))
            return Finding{Cause::rigMoved, view.name, fileOfImage(view, sets[s].front()),
                           "camera or board moved: from about this image on the picture is shifted",
                           "fix both, touch nothing while patterns are shown, and capture this pose again"};
    if (2 * wrong.size() >= even.size()) return std::nullopt;
    // An image that shows what no other does at a place; one that was only exchanged stays within what others show.
    int left = -1;
    double most = 0.0;
    bool isForeign = false;
    for (const std::size_t s : wrong)
        for (const int i : sets[s]) {
            const cv::Mat1f change = leavesOthers(images, static_cast<std::size_t>(i));
            const double share = static_cast<double>(cv::countNonZero(change > kChanged)) /
                                 std::max(1, cv::countNonZero(change == change));
            if (share < most || share < 0.004) continue;
            most = share;
            left = i;
            isForeign = differenceIn(change) == Difference::allOver;
        }
    if (left < 0) return std::nullopt;
    const int first = sets[wrong.front()].front();
    if (isInPart && !isForeign)
        return Finding{Cause::handInView, view.name, fileOfImage(view, first),
                       "something covers a part of the picture in " + std::to_string(wrong.size()) +
                           (wrong.size() == 1 ? " pattern" : " patterns") + ", from about this image on",
                       "keep hands and cables out of the light, and capture this pose again"};
    if (wrong.size() <= 2)
        return Finding{Cause::foreignImage, view.name, fileOfImage(view, left),
                       "this image shows another place or pose than the others",
                       "put the right image there, or capture this pose again"};
    return Finding{
        Cause::noisy, view.name, fileOfImage(view, first),
        "some images are disturbed all over, from about this one on: flicker or moire",
        "set the camera's exposure to whole periods of the projector's picture, and capture this pose again"};
}

} // namespace lumorph
