#include "calibration/decode/pattern_decoder.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "core/base/error.h"

namespace lumorph {

namespace {

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
constexpr double kLeastNoise = 0.4;   // grey levels: rounding alone makes 0.29
constexpr double kLeastLight = 4.0;   // grey levels
constexpr double kResolved = 0.45;    // contrast that the median pixel shows of a stripe that the camera resolves
constexpr float kLeastDirect = 0.25F; // of the light that is switched on and off
constexpr int kCoarser = 2;           // bits, that are tried where the finest stripes are narrower than pixels
constexpr double kSkips = 0.1;        // of neighbours in neighbouring stripes: noise makes fewer
constexpr float kSameEdge = 2.0F;     // camera pixels within which crossings of one edge are noise of each other
constexpr float kOrderDoubt = 0.35F;  // periods by which a cue may miss the next finer set
constexpr double kMedianToSigma = 1.4826;

/// Pattern and inverse of one bit.
struct GrayPair {
    int bit = 0;
    int pattern = -1;
    int inverse = -1; ///< -1: none, then the mean of white and black stands for it
};

/// The images of one set of phases, by step.
struct PhaseSet {
    int periods = 1;
    std::vector<int> images;
};

/// What the order says of one axis.
struct AxisImages {
    std::vector<GrayPair> bits;   ///< the finest first
    std::vector<PhaseSet> phases; ///< the fewest periods first
};

PatternAxis axisOf(const PatternImage& image) {
    const auto* gray = std::get_if<GrayBit>(&image);
    return gray != nullptr ? gray->axis : std::get<PhaseStep>(image).axis;
}

AxisImages imagesOf(const CaptureOrder& order, PatternAxis axis) {
    std::map<int, GrayPair> bits;
    std::map<int, PhaseSet> sets;
    for (int i = 0; i < static_cast<int>(order.images.size()); ++i) {
        const PatternImage& image = order.images[static_cast<std::size_t>(i)];
        const auto* gray = std::get_if<GrayBit>(&image);
        const auto* phase = std::get_if<PhaseStep>(&image);
        if ((gray == nullptr && phase == nullptr) || axisOf(image) != axis) continue;
        if (gray != nullptr) {
            GrayPair& pair = bits[gray->bit];
            pair.bit = gray->bit;
            (gray->inverse ? pair.inverse : pair.pattern) = i;
        } else {
            PhaseSet& set = sets[phase->periods];
            set.periods = phase->periods;
            set.images.resize(static_cast<std::size_t>(phase->steps), -1);
            if (phase->step < static_cast<int>(set.images.size()))
                set.images[static_cast<std::size_t>(phase->step)] = i;
        }
    }
    AxisImages all;
    for (const auto& [bit, pair] : bits) all.bits.push_back(pair);
    for (const auto& [periods, set] : sets) all.phases.push_back(set);
    return all;
}

int flatImage(const CaptureOrder& order, bool white) {
    const auto found = std::ranges::find(order.images, PatternImage(FlatField{white}));
    return found == order.images.end() ? -1 : static_cast<int>(found - order.images.begin());
}

void checkAxis(const AxisImages& images, const CaptureOrder& order) {
    const auto refuse = [](const std::string& why, const std::string& remedy) {
        throw InvalidInput("capture order", why, remedy);
    };
    if (images.bits.empty() && images.phases.empty())
        refuse("nothing tells the projector's columns, or nothing its rows", "project patterns of both");
    const bool hasFlat = flatImage(order, true) >= 0 && flatImage(order, false) >= 0;
    for (std::size_t i = 0; i < images.bits.size(); ++i) {
        const GrayPair& pair = images.bits[i];
        if (pair.bit != static_cast<int>(i) || pair.pattern < 0)
            refuse("bit " + std::to_string(i) + " is missing", "project all bits of the Gray code");
        if (pair.inverse < 0 && !hasFlat)
            refuse("bit " + std::to_string(i) + " has no inverse", "project the inverses, or white and black");
    }
    for (const PhaseSet& set : images.phases)
        if (std::ranges::find(set.images, -1) != set.images.end())
            refuse("a step of " + std::to_string(set.periods) + " periods is missing", "project all steps");
}

cv::Mat1f meanOf(const std::vector<cv::Mat>& images, const std::vector<int>& which) {
    cv::Mat1f sum = cv::Mat1f::zeros(images.front().size());
    for (const int i : which) cv::accumulate(images[static_cast<std::size_t>(i)], sum);
    return sum / static_cast<double>(which.size());
}

} // namespace

std::vector<std::vector<int>> evenSets(const CaptureOrder& order) {
    std::vector<std::vector<int>> sets;
    for (const PatternAxis axis : {PatternAxis::columns, PatternAxis::rows}) {
        const AxisImages images = imagesOf(order, axis);
        for (const GrayPair& pair : images.bits)
            if (pair.pattern >= 0 && pair.inverse >= 0) sets.push_back({pair.pattern, pair.inverse});
        for (const PhaseSet& set : images.phases)
            if (std::ranges::find(set.images, -1) == set.images.end()) sets.push_back(set.images);
    }
    std::ranges::sort(sets, {}, [](const auto& set) { return set.front(); });
    return sets;
}

namespace {

double medianOf(std::vector<float>& values) {
    if (values.empty()) return 0.0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
}

/// Standard deviation from distances to the middle: their mean, without those that lie far outside of the median. Greys
/// are whole numbers, of which the median alone is too coarse.
double spreadOf(std::vector<float>& distances) {
    const double most = 3.0 * kMedianToSigma * medianOf(distances) + 0.5;
    double sum = 0.0;
    double count = 0.0;
    for (const float distance : distances) {
        if (distance > most) continue;
        sum += distance;
        count += 1.0;
    }
    return count > 0.0 ? std::sqrt(0.5 * std::numbers::pi) * sum / count : 0.0;
}

/// Of one image's grey: images under even light differ by nothing else. A flicker of all the light is no noise.
double noiseOf(const std::vector<cv::Mat>& images, const CaptureOrder& order, const cv::Mat1f& light) {
    const auto sets = evenSets(order);
    std::vector<float> estimates;
    for (std::size_t i = 0; i + 1 < sets.size(); i += 2) {
        const cv::Mat1f change = meanOf(images, sets[i]) - meanOf(images, sets[i + 1]);
        std::vector<float> values;
        for (int y = 0; y < change.rows; y += 3)
            for (int x = 0; x < change.cols; x += 3)
                if (light(y, x) > kLeastLight) values.push_back(change(y, x));
        const auto centre = static_cast<float>(medianOf(values));
        for (float& value : values) value = std::abs(value - centre);
        const double share = 1.0 / static_cast<double>(sets[i].size()) + 1.0 / static_cast<double>(sets[i + 1].size());
        estimates.push_back(static_cast<float>(spreadOf(values) / std::sqrt(share)));
    }
    return std::max(kLeastNoise, medianOf(estimates));
}

/// One axis of a pose, decoded.
struct DecodedAxis {
    cv::Mat1f coordinate;
    cv::Mat1f contrast; ///< of the weakest pattern but the one that may be in doubt, grey levels
    cv::Mat1f direct;   ///< grey levels
    int cell = 1;
};

/// Not by !=: for OpenCV, where it works with vectors, no number differs from a NaN.
cv::Mat1b unknownIn(const cv::Mat1f& coordinate) { return ~(coordinate == coordinate); }

/// Reads the Gray code of one axis.
class GrayReader {
public:
    GrayReader(const std::vector<cv::Mat>& images, const std::vector<GrayPair>& bits, const cv::Mat1b& white,
               const cv::Mat1b& black, double noise)
        : size_(images.front().size()), doubt_(static_cast<float>(2.5 * noise * std::numbers::sqrt2)) {
        cv::subtract(white, black, light_, cv::noArray(), CV_32F);
        for (const GrayPair& pair : bits) {
            cv::Mat1s difference;
            const cv::Mat& pattern = images[static_cast<std::size_t>(pair.pattern)];
            if (pair.inverse >= 0)
                cv::subtract(pattern, images[static_cast<std::size_t>(pair.inverse)], difference, cv::noArray(),
                             CV_16S);
            else
                cv::addWeighted(pattern, 2.0, white + black, -1.0, 0.0, difference, CV_16S);
            differences_.push_back(difference);
        }
        while (first_ + 2 < static_cast<int>(differences_.size()) && !isResolved(first_)) ++first_;
    }

    [[nodiscard]] DecodedAxis read() {
        DecodedAxis axis = readStripes();
        // Where stripes are narrower than a pixel, as on what is tilted away, some are passed over; coarser ones tell.
        const int count = static_cast<int>(differences_.size());
        for (int tries = 0; tries < kCoarser && first_ + 2 < count && skips_ > kSkips * steps_; ++tries) {
            ++first_;
            const DecodedAxis coarser = readStripes();
            const cv::Mat1b unknown = unknownIn(axis.coordinate);
            coarser.coordinate.copyTo(axis.coordinate, unknown);
            coarser.contrast.copyTo(axis.contrast, unknown);
        }
        return axis;
    }

private:
    [[nodiscard]] DecodedAxis readStripes() {
        DecodedAxis axis{cv::Mat1f(size_, kUnknown), cv::Mat1f::zeros(size_), cv::Mat1f::zeros(size_), 1 << first_};
        steps_ = skips_ = 0.0;
        codes_ = cv::Mat1i(size_, -1);
        for (int y = 0; y < size_.height; ++y)
            for (int x = 0; x < size_.width; ++x) readPixel(axis, y, x);
        const bool alongRows = stripesCross(0, 1) >= stripesCross(1, 0);
        const int lines = alongRows ? size_.height : size_.width;
        for (int line = 0; line < lines; ++line) interpolate(axis, alongRows, line);
        return axis;
    }

    [[nodiscard]] float difference(int bit, int y, int x) const {
        return differences_[static_cast<std::size_t>(bit)](y, x);
    }

    [[nodiscard]] bool isResolved(int bit) const {
        std::vector<float> shares;
        for (int y = 0; y < size_.height; y += 3)
            for (int x = 0; x < size_.width; x += 3)
                if (light_(y, x) > 4.0F * doubt_) shares.push_back(std::abs(difference(bit, y, x)) / light_(y, x));
        return shares.empty() || medianOf(shares) > kResolved;
    }

    void readPixel(DecodedAxis& axis, int y, int x) {
        const int count = static_cast<int>(differences_.size());
        float weakest = std::numeric_limits<float>::max();
        float second = weakest;
        int code = 0;
        bool bit = false;
        for (int b = count - 1; b >= first_; --b) {
            const float d = difference(b, y, x);
            bit = bit != (d > 0.0F); // a Gray code's bit tells whether the binary one changes
            code = 2 * code + (bit ? 1 : 0);
            const float strength = std::abs(d);
            second = std::min(second, std::max(weakest, strength));
            weakest = std::min(weakest, strength);
        }
        const int next = std::min(first_ + 1, count - 1);
        const float direct = std::max(std::abs(difference(first_, y, x)), std::abs(difference(next, y, x)));
        axis.direct(y, x) = direct;
        if (direct < 1.6F * doubt_ || direct < kLeastDirect * light_(y, x) || second < doubt_) return;
        axis.contrast(y, x) = second;
        codes_(y, x) = code;
    }

    /// How many neighbours in this direction lie in the next stripe.
    [[nodiscard]] int stripesCross(int down, int right) const {
        int crossings = 0;
        for (int y = 0; y + down < size_.height; y += 2)
            for (int x = 0; x + right < size_.width; x += 2) {
                const int a = codes_(y, x);
                const int b = codes_(y + down, x + right);
                crossings += a >= 0 && b >= 0 && std::abs(a - b) == 1;
            }
        return crossings;
    }

    /// Where on a line an edge between two stripes lies, and the coordinate there.
    struct Edge {
        float at = 0.0F;
        float coordinate = 0.0F;
        int crossings = 1;
    };

    void interpolate(DecodedAxis& axis, bool alongRows, int line) {
        const int length = alongRows ? size_.width : size_.height;
        const auto pixel = [&](int i) { return alongRows ? cv::Point(i, line) : cv::Point(line, i); };
        const auto width = static_cast<float>(axis.cell);
        std::optional<Edge> before;
        std::optional<Edge> last;
        const auto fill = [&] { // between two neighbouring edges, now that nothing is added to either
            if (!before || !last || std::abs(std::abs(last->coordinate - before->coordinate) - width) > 0.01F) return;
            const float slope = (last->coordinate - before->coordinate) / (last->at - before->at);
            for (int i = static_cast<int>(std::ceil(before->at)); static_cast<float>(i) <= last->at; ++i)
                axis.coordinate(pixel(i)) = before->coordinate + slope * (static_cast<float>(i) - before->at);
        };
        for (int i = 0; i + 1 < length; ++i) {
            const std::optional<Edge> edge = edgeBetween(pixel(i), pixel(i + 1), static_cast<float>(i), width);
            const int a = codes_(pixel(i));
            const int b = codes_(pixel(i + 1));
            if (a >= 0 && b >= 0) (std::abs(a - b) > 1 ? skips_ : steps_) += a != b;
            if (edge && last && edge->coordinate == last->coordinate && edge->at - last->at < kSameEdge) {
                const auto n = static_cast<float>(last->crossings);
                last->at = (n * last->at + edge->at) / (n + 1.0F);
                ++last->crossings;
            } else if (edge) {
                fill();
                before = last;
                last = edge;
            } else if (a < 0 || b < 0 || a != b) {
                fill();
                before = last = std::nullopt;
            }
        }
        fill();
    }

    [[nodiscard]] std::optional<Edge> edgeBetween(cv::Point here, cv::Point there, float at, float width) const {
        const int a = codes_(here);
        const int b = codes_(there);
        if (a < 0 || b < 0 || std::abs(a - b) != 1) return std::nullopt;
        const int upper = std::max(a, b);
        const int bit = std::min(first_ + std::countr_zero(static_cast<unsigned>(upper)),
                                 static_cast<int>(differences_.size()) - 1); // the one bit in which they differ
        const float from = difference(bit, here.y, here.x);
        const float to = difference(bit, there.y, there.x);
        const float part = from == to ? 0.5F : std::clamp(from / (from - to), 0.0F, 1.0F);
        return Edge{at + part, static_cast<float>(upper) * width - 0.5F};
    }

    cv::Size size_;
    float doubt_;                      ///< a difference below is no more than noise
    int first_ = 0;                    ///< finest bit that the camera resolves
    double steps_ = 0.0, skips_ = 0.0; ///< neighbours in neighbouring stripes, and in stripes further apart
    cv::Mat1f light_;
    std::vector<cv::Mat1s> differences_;
    cv::Mat1i codes_; ///< of stripes of the finest bit that is resolved; -1: not known
};

/// Phase in periods [0, 1), amplitude and mean of one set.
struct Phase {
    cv::Mat1f turns, amplitude, mean;
    int periods = 1;
};

Phase phaseOf(const std::vector<cv::Mat>& images, const PhaseSet& set) {
    const auto count = static_cast<double>(set.images.size());
    cv::Mat1f sine = cv::Mat1f::zeros(images.front().size());
    cv::Mat1f cosine = cv::Mat1f::zeros(images.front().size());
    for (std::size_t k = 0; k < set.images.size(); ++k) {
        const double angle = 2.0 * std::numbers::pi * static_cast<double>(k) / count;
        const cv::Mat& image = images[static_cast<std::size_t>(set.images[k])];
        cv::Mat1f part;
        image.convertTo(part, CV_32F, std::sin(angle) * 2.0 / count);
        sine += part;
        image.convertTo(part, CV_32F, std::cos(angle) * 2.0 / count);
        cosine += part;
    }
    Phase phase{{}, {}, meanOf(images, set.images), set.periods};
    cv::Mat1f angle;
    cv::cartToPolar(cosine, sine, phase.amplitude, angle);
    phase.turns = angle / (2.0 * std::numbers::pi);
    return phase;
}

/// The phase of one period, taken from two sets whose numbers of periods differ by one.
std::optional<Phase> beatOf(const std::vector<Phase>& phases) {
    for (const Phase& one : phases)
        for (const Phase& other : phases) {
            if (other.periods != one.periods + 1) continue;
            Phase beat{other.turns - one.turns, cv::min(one.amplitude, other.amplitude), one.mean, 1};
            for (float& turns : beat.turns) turns -= std::floor(turns);
            return beat;
        }
    return std::nullopt;
}

DecodedAxis readPhases(const std::vector<cv::Mat>& images, const std::vector<PhaseSet>& sets, int length,
                       double noise) {
    std::vector<Phase> phases;
    phases.reserve(sets.size() + 1);
    for (const PhaseSet& set : sets) phases.push_back(phaseOf(images, set));
    if (phases.front().periods != 1) {
        const auto beat = beatOf(phases);
        if (!beat)
            throw InvalidInput("capture order", "nothing tells one period from the next", "add a set of one period");
        phases.insert(phases.begin(), *beat);
    }
    const cv::Size size = images.front().size();
    DecodedAxis axis{cv::Mat1f(size, kUnknown), cv::Mat1f::zeros(size), 2.0 * phases.back().amplitude, 1};
    const auto least = static_cast<float>(std::max(kLeastLight, 4.0 * noise));
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
            float share = phases.front().turns(y, x); // of the whole length
            float weakest = phases.front().amplitude(y, x);
            bool certain = true;
            for (std::size_t k = 1; k < phases.size(); ++k) {
                const auto periods = static_cast<float>(phases[k].periods);
                const float period = share * periods - phases[k].turns(y, x);
                certain = certain && std::abs(period - std::round(period)) < kOrderDoubt;
                share = (std::round(period) + phases[k].turns(y, x)) / periods;
                weakest = std::min(weakest, phases[k].amplitude(y, x));
            }
            if (!certain || 2.0F * weakest < least || share < 0.0F || share > 1.0F) continue;
            axis.contrast(y, x) = 2.0F * weakest;
            axis.coordinate(y, x) = share * static_cast<float>(length) - 0.5F;
        }
    return axis;
}

/// White and black as they were captured, else worked out.
std::pair<cv::Mat1b, cv::Mat1b> flatFields(const std::vector<cv::Mat>& images, const CaptureOrder& order,
                                           const AxisImages& columns) {
    const int white = flatImage(order, true);
    const int black = flatImage(order, false);
    if (white >= 0 && black >= 0)
        return {images[static_cast<std::size_t>(white)], images[static_cast<std::size_t>(black)]};
    cv::Mat1b most, least;
    if (!columns.phases.empty()) {
        const Phase phase = phaseOf(images, columns.phases.front());
        cv::Mat1f(phase.mean + phase.amplitude).convertTo(most, CV_8U);
        cv::Mat1f(phase.mean - phase.amplitude).convertTo(least, CV_8U);
        return {most, least};
    }
    most = images.front().clone();
    least = images.front().clone();
    for (const cv::Mat& image : images) {
        cv::max(most, image, most);
        cv::min(least, image, least);
    }
    return {most, least};
}

} // namespace

std::vector<EvenlyLit> evenlyLit(const std::vector<cv::Mat>& images, const CaptureOrder& order) {
    std::vector<EvenlyLit> all;
    for (const std::vector<int>& set : evenSets(order)) all.push_back({set.front(), set.back(), meanOf(images, set)});
    return all;
}

DecodedView decodeView(const std::vector<cv::Mat>& images, const CaptureOrder& order) {
    if (images.size() != order.images.size())
        throw InvalidInput("captured pose",
                           std::to_string(images.size()) + " images for " + std::to_string(order.images.size()) +
                               " patterns",
                           "give one image for each pattern");
    const std::array<AxisImages, 2> which = {imagesOf(order, PatternAxis::columns), imagesOf(order, PatternAxis::rows)};
    for (const AxisImages& axis : which) checkAxis(axis, order);
    DecodedView view;
    std::tie(view.white, view.black) = flatFields(images, order, which[0]);
    cv::Mat1f light;
    cv::subtract(view.white, view.black, light, cv::noArray(), CV_32F);
    view.noise = noiseOf(images, order, light);
    const auto read = [&](const AxisImages& axis, int length) {
        if (!axis.phases.empty()) return readPhases(images, axis.phases, length, view.noise);
        return GrayReader(images, axis.bits, view.white, view.black, view.noise).read();
    };
    const DecodedAxis columns = read(which[0], order.projector.width);
    const DecodedAxis rows = read(which[1], order.projector.height);
    view.column = columns.coordinate;
    view.row = rows.coordinate;
    view.columnCell = columns.cell;
    view.rowCell = rows.cell;
    view.direct = cv::max(columns.direct, rows.direct);
    view.global = cv::max(cv::Mat1f(light - view.direct), 0.0F);
    cv::Mat1f share = cv::min(columns.contrast, rows.contrast) / cv::max(view.direct, 1.0F);
    view.confidence = cv::min(share, 1.0F);
    view.confidence.setTo(0.0F, unknownIn(view.column) | unknownIn(view.row));
    return view;
}

} // namespace lumorph
