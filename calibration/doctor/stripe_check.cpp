#include "calibration/doctor/stripe_check.h"

#include <algorithm>
#include <cmath>

namespace lumorph {

namespace {

constexpr int kRows = 4;                    // every so many rows and columns are walked along
constexpr int kStep = 2;                    // pixels between the two sides of an edge
constexpr float kClear = 0.25F;             // of the light: a stripe's side that is no edge
constexpr float kLeastRangeOfPixel = 16.0F; // grey levels
constexpr double kResolvedShare = 0.6;
constexpr double kFewestEdges = 60.0;

/// One bit of an axis, and what its stripes look like.
struct BitStripes {
    int bit = 0;
    int pattern = 0, inverse = 0;    ///< images
    double across = 0.0, down = 0.0; ///< edges met walking along rows, and along columns
    double strength = 0.0;           ///< mean contrast, as a share of the light
    std::vector<int> jumps; ///< how far codes differ over each of its edges, stripes of the finest resolved bit

    [[nodiscard]] double edges() const { return across + down; }
};

class StripeWalk {
public:
    StripeWalk(const std::vector<cv::Mat>& images, const CaptureOrder& order, PatternAxis axis) : images_(images) {
        for (int i = 0; i < static_cast<int>(order.images.size()); ++i) {
            const auto* gray = std::get_if<GrayBit>(&order.images[static_cast<std::size_t>(i)]);
            if (gray == nullptr || gray->axis != axis || gray->inverse) continue;
            const auto found = std::ranges::find(order.images, PatternImage(GrayBit{axis, gray->bit, true}));
            if (found != order.images.end())
                bits_.push_back({gray->bit, i, static_cast<int>(found - order.images.begin()), 0, 0, 0, {}});
        }
        std::ranges::sort(bits_, std::greater<>(), &BitStripes::bit);
        if (bits_.size() < 3) return;
        const cv::Size size = images.front().size();
        cv::Mat coarsest; // shows all the light
        cv::absdiff(image(bits_[0].pattern), image(bits_[0].inverse), coarsest);
        coarsest.convertTo(range_, CV_32F);
        dropUnresolved();
        for (int y = 0; y < size.height; y += kRows)
            for (int x = 0; x + kStep < size.width; ++x) look({x, y}, {x + kStep, y}, &BitStripes::across);
        for (int x = 0; x < size.width; x += kRows)
            for (int y = 0; y + kStep < size.height; ++y) look({x, y}, {x, y + kStep}, &BitStripes::down);
    }

    /// The coarsest first, without those that are not resolved.
    [[nodiscard]] const std::vector<BitStripes>& bits() const { return bits_; }

private:
    [[nodiscard]] const cv::Mat1b& image(int i) const {
        return static_cast<const cv::Mat1b&>(images_[static_cast<std::size_t>(i)]);
    }
    [[nodiscard]] float difference(const BitStripes& bit, cv::Point at) const {
        return static_cast<float>(image(bit.pattern)(at)) - static_cast<float>(image(bit.inverse)(at));
    }

    void dropUnresolved() {
        for (BitStripes& bit : bits_) {
            double sum = 0.0;
            double count = 0.0;
            for (int y = 0; y < range_.rows; y += kRows)
                for (int x = 0; x < range_.cols; x += kRows) {
                    if (range_(y, x) < kLeastRangeOfPixel) continue;
                    sum += std::min(1.0F, std::abs(difference(bit, {x, y})) / range_(y, x));
                    count += 1.0;
                }
            bit.strength = count > 0.0 ? sum / count : 0.0;
        }
        const auto weak = std::ranges::find_if(bits_, [](const BitStripes& b) { return b.strength < kResolvedShare; });
        bits_.erase(weak, bits_.end());
    }

    /// Two pixels near one another: the one bit in which they differ, if it is one alone.
    void look(cv::Point a, cv::Point b, double BitStripes::*direction) {
        if (range_(a) < kLeastRangeOfPixel || range_(b) < kLeastRangeOfPixel) return;
        BitStripes* edge = nullptr;
        int codeA = 0;
        int codeB = 0;
        bool lastA = false;
        bool lastB = false;
        for (BitStripes& bit : bits_) {
            const float da = difference(bit, a) / range_(a);
            const float db = difference(bit, b) / range_(b);
            if (std::abs(da) < kClear || std::abs(db) < kClear) return;
            if ((da > 0.0F) != (db > 0.0F)) {
                if (edge != nullptr) return;
                edge = &bit;
            }
            lastA = lastA != (da > 0.0F);
            lastB = lastB != (db > 0.0F);
            codeA = 2 * codeA + (lastA ? 1 : 0);
            codeB = 2 * codeB + (lastB ? 1 : 0);
        }
        if (edge == nullptr) return;
        edge->*direction += 1.0;
        edge->jumps.push_back(std::abs(codeA - codeB));
    }

    const std::vector<cv::Mat>& images_;
    cv::Mat1f range_;
    std::vector<BitStripes> bits_;
};

std::string fileOf(const CapturedView& view, int image) {
    return view.files[static_cast<std::size_t>(image)].filename().string();
}

std::optional<Finding> wrongDirection(const std::vector<BitStripes>& bits, const CapturedView& view,
                                      const CaptureOrder& order) {
    const auto runsAcross = [](const BitStripes& bit) { return bit.across > 2.0 * bit.down; };
    const auto runsDown = [](const BitStripes& bit) { return bit.down > 2.0 * bit.across; };
    const bool mostAcross = std::ranges::count_if(bits, runsAcross) > std::ranges::count_if(bits, runsDown);
    for (const BitStripes& bit : bits) {
        if (bit.edges() < kFewestEdges) continue;
        const bool turned = mostAcross ? runsDown(bit) : runsAcross(bit);
        if (!turned) continue;
        return Finding{Cause::wrongOrder, view.name, fileOf(view, bit.pattern),
                       "its stripes run the other way than those of '" +
                           wordsOf(order.images[static_cast<std::size_t>(bit.pattern)]) + "'",
                       "put the images into the order of the patterns, or correct the order file"};
    }
    return std::nullopt;
}

std::optional<Finding> wrongWidth(const std::vector<BitStripes>& bits, const CapturedView& view,
                                  const CaptureOrder& order) {
    for (std::size_t i = 0; i + 1 < bits.size(); ++i) {
        if (bits[i].edges() < 1.3 * bits[i + 1].edges() + kFewestEdges) continue;
        return Finding{Cause::wrongOrder, view.name, fileOf(view, bits[i].pattern),
                       "its stripes are finer than those of '" +
                           wordsOf(order.images[static_cast<std::size_t>(bits[i].pattern)]) + "'",
                       "put the images into the order of the patterns, or correct the order file"};
    }
    return std::nullopt;
}

std::optional<Finding> exchangedPair(const std::vector<BitStripes>& bits, const CapturedView& view,
                                     const CaptureOrder& order) {
    // The finest bit over whose edges codes do not follow one another: the pair below it is exchanged.
    for (std::size_t i = bits.size(); i-- > 0;) {
        std::vector<int> jumps = bits[i].jumps;
        if (static_cast<double>(jumps.size()) < kFewestEdges) continue;
        const auto middle = jumps.begin() + static_cast<std::ptrdiff_t>(jumps.size() / 2);
        std::ranges::nth_element(jumps, middle);
        if (*middle == 1) continue;
        const std::size_t below = i + 1;
        const int ofOne = (1 << (bits.size() - below + 1)) - 1; // what exchanging that pair alone makes
        if (below >= bits.size() || *middle != ofOne)
            return Finding{Cause::inverseSwapped, view.name, "", "patterns and their inverses are exchanged",
                           "name the images in the order pattern, inverse, or say so in an order file"};
        return Finding{Cause::inverseSwapped, view.name, fileOf(view, bits[below].pattern),
                       "this image and its inverse are exchanged: '" +
                           wordsOf(order.images[static_cast<std::size_t>(bits[below].pattern)]) + "'",
                       "exchange the two images, or say so in an order file"};
    }
    return std::nullopt;
}

} // namespace

std::optional<Finding> checkStripes(const CapturedView& view, const std::vector<cv::Mat>& images,
                                    const CaptureOrder& order) {
    for (const PatternAxis axis : {PatternAxis::columns, PatternAxis::rows}) {
        const StripeWalk walk(images, order, axis);
        for (const auto& check : {wrongDirection, wrongWidth, exchangedPair})
            if (const auto finding = check(walk.bits(), view, order)) return finding;
    }
    return std::nullopt;
}

} // namespace lumorph
