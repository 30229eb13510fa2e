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
constexpr int kLitLine = 40; // pixels of a line that are lit: enough to count it
constexpr double kFewestEdges = 60.0;

/// One bit of an axis, and what its stripes look like.
struct BitStripes {
    int bit = 0;
    int pattern = 0, inverse = 0;    ///< images
    double across = 0.0, down = 0.0; ///< edges met walking along rows, and along columns
    double strength = 0.0;           ///< mean contrast, as a share of the light
    double lines = 0.0;              ///< edges of its own, whatever other bits do there, a lit line that is walked

    [[nodiscard]] double edges() const { return across + down; }
};

/// Two neighbouring pixels that differ in one bit: its place, and the Gray codes of both; the finest resolved bit is
/// the lowest.
struct StripeEdge {
    int bit = 0;
    unsigned one = 0, other = 0;
};

class StripeWalk {
public:
    StripeWalk(const std::vector<cv::Mat>& images, const CaptureOrder& order, PatternAxis axis) : images_(images) {
        for (int i = 0; i < static_cast<int>(order.images.size()); ++i) {
            const auto* gray = std::get_if<GrayBit>(&order.images[static_cast<std::size_t>(i)]);
            if (gray == nullptr || gray->axis != axis || gray->inverse) continue;
            const auto found = std::ranges::find(order.images, PatternImage(GrayBit{axis, gray->bit, true}));
            if (found != order.images.end())
                bits_.push_back({gray->bit, i, static_cast<int>(found - order.images.begin()), 0, 0, 0});
        }
        std::ranges::sort(bits_, std::greater<>(), &BitStripes::bit);
        if (bits_.size() < 3) return;
        const cv::Size size = images.front().size();
        cv::Mat1b most(size, 0); // some bit shows all the light, in whatever order they are
        for (const BitStripes& bit : bits_) {
            cv::Mat here;
            cv::absdiff(image(bit.pattern), image(bit.inverse), here);
            cv::max(most, here, most);
        }
        most.convertTo(range_, CV_32F);
        for (BitStripes& bit : bits_) measure(bit);
        all_ = bits_;
        const auto weak = std::ranges::find_if(bits_, [](const BitStripes& b) { return b.strength < kResolvedShare; });
        bits_.erase(weak, bits_.end());
        for (int y = 0; y < size.height; y += kRows)
            for (int x = 0; x + kStep < size.width; ++x) look({x, y}, {x + kStep, y}, &BitStripes::across);
        for (int x = 0; x < size.width; x += kRows)
            for (int y = 0; y + kStep < size.height; ++y) look({x, y}, {x, y + kStep}, &BitStripes::down);
    }

    /// The coarsest first, without those that are not resolved.
    [[nodiscard]] const std::vector<BitStripes>& bits() const { return bits_; }
    /// With those.
    [[nodiscard]] const std::vector<BitStripes>& all() const { return all_; }
    [[nodiscard]] const std::vector<StripeEdge>& edges() const { return edges_; }

private:
    [[nodiscard]] const cv::Mat1b& image(int i) const {
        return static_cast<const cv::Mat1b&>(images_[static_cast<std::size_t>(i)]);
    }
    [[nodiscard]] float difference(const BitStripes& bit, cv::Point at) const {
        return static_cast<float>(image(bit.pattern)(at)) - static_cast<float>(image(bit.inverse)(at));
    }

    /// How strong a bit's stripes are, and how many.
    void measure(BitStripes& bit) const {
        double sum = 0.0;
        double count = 0.0;
        double lines = 0.0;
        for (int y = 0; y < range_.rows; y += kRows) {
            int lit = 0;
            for (int x = 0; x < range_.cols; ++x) {
                if (range_(y, x) < kLeastRangeOfPixel) continue;
                const float share = difference(bit, {x, y}) / range_(y, x);
                if (x % kRows == 0) sum += std::min(1.0F, std::abs(share)), count += 1.0;
                ++lit;
                if (x + kStep >= range_.cols || range_(y, x + kStep) < kLeastRangeOfPixel) continue;
                const float next = difference(bit, {x + kStep, y}) / range_(y, x + kStep);
                bit.lines += std::abs(share) > kClear && std::abs(next) > kClear && (share > 0.0F) != (next > 0.0F);
            }
            lines += lit > kLitLine;
        }
        for (int x = 0; x < range_.cols; x += kRows)
            for (int y = 0; y + kStep < range_.rows; ++y) {
                if (range_(y, x) < kLeastRangeOfPixel || range_(y + kStep, x) < kLeastRangeOfPixel) continue;
                const float share = difference(bit, {x, y}) / range_(y, x);
                const float next = difference(bit, {x, y + kStep}) / range_(y + kStep, x);
                bit.lines += std::abs(share) > kClear && std::abs(next) > kClear && (share > 0.0F) != (next > 0.0F);
            }
        bit.strength = count > 0.0 ? sum / count : 0.0;
        bit.lines /= std::max(1.0, kStep * lines); // each edge is met by so many pairs
    }

    /// Two pixels near one another, if they differ in one bit alone.
    void look(cv::Point a, cv::Point b, double BitStripes::*direction) {
        if (range_(a) < kLeastRangeOfPixel || range_(b) < kLeastRangeOfPixel) return;
        StripeEdge edge{-1, 0, 0};
        for (std::size_t i = 0; i < bits_.size(); ++i) {
            const float da = difference(bits_[i], a) / range_(a);
            const float db = difference(bits_[i], b) / range_(b);
            if (std::abs(da) < kClear || std::abs(db) < kClear) return;
            const bool differs = (da > 0.0F) != (db > 0.0F);
            if (differs && edge.bit >= 0) return;
            if (differs) edge.bit = static_cast<int>(bits_.size() - 1 - i);
            edge.one = 2 * edge.one + (da > 0.0F ? 1 : 0);
            edge.other = 2 * edge.other + (db > 0.0F ? 1 : 0);
        }
        if (edge.bit < 0) return;
        bits_[bits_.size() - 1 - static_cast<std::size_t>(edge.bit)].*direction += 1.0;
        edges_.push_back(edge);
    }

    const std::vector<cv::Mat>& images_;
    cv::Mat1f range_;
    std::vector<BitStripes> bits_, all_;
    std::vector<StripeEdge> edges_;
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

/// A finer bit of a Gray code has twice as many stripes as the next coarser one, and blur takes the finest first. Two
/// bits, or all, are named where the numbers of stripes rise once they are put back: a bit that somebody moved in has
/// edges of its own.
std::optional<Finding> wrongFineness(const std::vector<BitStripes>& bits, const CapturedView& view,
                                     const CaptureOrder& order) {
    constexpr double kUnseen = 0.35, kSureStrength = 0.75, kWeaker = 0.6, kRising = 0.8;
    constexpr double kFewestLines = 3.0;
    if (bits.size() < 3) return std::nullopt;
    std::vector<double> lines; // the coarsest first; of those that are seen
    std::vector<std::size_t> seen;
    for (std::size_t i = 0; i < bits.size(); ++i)
        if (bits[i].strength > kUnseen) lines.push_back(bits[i].lines), seen.push_back(i);
    const auto isRising = [](const std::vector<double>& all) {
        double most = 0.0;
        for (const double here : all) {
            if (here < kRising * most && most > kFewestLines) return false;
            most = std::max(most, here);
        }
        return true;
    };
    const auto words = [&](std::size_t bit) {
        return "'" + wordsOf(order.images[static_cast<std::size_t>(bits[bit].pattern)]) + "'";
    };
    const auto found = [&](std::size_t bit, const std::string& why, const std::string& remedy) {
        return Finding{Cause::bitOrder, view.name, fileOf(view, bits[bit].pattern), why, remedy};
    };
    constexpr const char* kPutInOrder = "put the images into the order of the patterns, or correct the order file";
    const bool isOrdered = isRising(lines);
    const bool isReversed = lines.size() > 3 && !isOrdered && isRising({lines.rbegin(), lines.rend()});
    // The coarsest of all is blurred away, though finer ones are not.
    const bool isFinestFirst =
        bits.front().strength < kUnseen && bits.back().strength > kSureStrength && bits.back().lines < kFewestLines;
    if (isReversed || isFinestFirst)
        return found(0, "the bits stand in reverse: the finest stripes come first",
                     "say so in an order file: bit 0 first");
    for (std::size_t i = 0; i < bits.size(); ++i)
        for (std::size_t k = i + 1; k < bits.size(); ++k)
            if (bits[i].strength < kResolvedShare && bits[k].strength > kSureStrength &&
                bits[i].strength < kWeaker * bits[k].strength)
                return found(i, words(i) + " has finer stripes than " + words(k), kPutInOrder);
    if (isOrdered) return std::nullopt;
    for (std::size_t i = 0; i < lines.size(); ++i)
        for (std::size_t k = i + 1; k < lines.size(); ++k) {
            std::vector<double> exchanged = lines;
            std::swap(exchanged[i], exchanged[k]);
            if (isRising(exchanged))
                return found(seen[i], words(seen[i]) + " has finer stripes than " + words(seen[k]), kPutInOrder);
        }
    return std::nullopt;
}

int stripeOf(unsigned gray) {
    for (unsigned shift = 1; shift < 32; shift *= 2) gray ^= gray >> shift;
    return static_cast<int>(gray);
}

/// What may have been done to the images of an axis.
struct Mixup {
    unsigned exchanged = 0;           ///< bits whose pattern and inverse are
    int swapped = -1, swappedBy = -1; ///< bits that are

    [[nodiscard]] unsigned undo(unsigned gray) const {
        gray ^= exchanged;
        if (swapped < 0 || ((gray >> swapped) & 1U) == ((gray >> swappedBy) & 1U)) return gray;
        return gray ^ (1U << swapped) ^ (1U << swappedBy);
    }
};

/// How well codes on both sides of edges follow one another once a mix-up is undone: the share of edges,
/// of the bit with the least.
double orderUnder(const Mixup& mixup, const std::vector<StripeEdge>& edges, std::size_t bits) {
    std::vector<double> good(bits, 0.0), all(bits, 0.0);
    for (const StripeEdge& edge : edges) {
        const auto bit = static_cast<std::size_t>(edge.bit);
        all[bit] += 1.0;
        good[bit] += std::abs(stripeOf(mixup.undo(edge.one)) - stripeOf(mixup.undo(edge.other))) == 1;
    }
    double least = 1.0;
    for (std::size_t bit = 0; bit < bits; ++bit)
        if (all[bit] >= kFewestEdges) least = std::min(least, good[bit] / all[bit]);
    return least;
}

/// The finest first where two explain as much, as one bit alone is likelier than all.
std::vector<Mixup> mixupsOf(int bits) {
    std::vector<Mixup> all;
    all.reserve(static_cast<std::size_t>(bits));
    for (int bit = 0; bit < bits; ++bit) all.push_back({1U << bit, -1, -1});
    for (int bit = 0; bit < bits; ++bit)
        for (int other = bit + 1; other < bits; ++other) all.push_back({0, other, bit});
    all.push_back({(1U << bits) - 1U, -1, -1});
    return all;
}

std::optional<Finding> wrongCodes(const StripeWalk& walk, const CapturedView& view, const CaptureOrder& order) {
    constexpr double kOrdered = 0.6;
    const std::vector<BitStripes>& bits = walk.bits();
    if (bits.empty() || orderUnder({}, walk.edges(), bits.size()) >= kOrdered) return std::nullopt;
    const auto count = static_cast<int>(bits.size());
    Mixup best;
    double most = kOrdered;
    for (const Mixup& mixup : mixupsOf(count)) {
        const double ordered = orderUnder(mixup, walk.edges(), bits.size());
        if (ordered > most + 0.01) most = ordered, best = mixup;
    }
    const auto imageOfBit = [&](int bit) { return bits[static_cast<std::size_t>(count - 1 - bit)].pattern; };
    const auto words = [&](int bit) {
        return "'" + wordsOf(order.images[static_cast<std::size_t>(imageOfBit(bit))]) + "'";
    };
    if (best.swapped >= 0)
        return Finding{Cause::bitOrder, view.name, fileOf(view, imageOfBit(best.swapped)),
                       "the images of " + words(best.swapped) + " and of " + words(best.swappedBy) + " are exchanged",
                       "put the images into the order of the patterns, or correct the order file"};
    if (best.exchanged == (1U << count) - 1U)
        return Finding{Cause::inverseSwapped, view.name, "", "patterns and their inverses are exchanged",
                       "name the images in the order pattern, inverse, or say so in an order file"};
    for (int bit = 0; bit < count; ++bit)
        if (best.exchanged == 1U << bit)
            return Finding{Cause::inverseSwapped, view.name, fileOf(view, imageOfBit(bit)),
                           words(bit) + " and its inverse are exchanged",
                           "exchange the two images, or say so in an order file"};
    return std::nullopt; // several things at once, or no Gray code of a projector: others find out
}

} // namespace

std::optional<Finding> checkStripes(const CapturedView& view, const std::vector<cv::Mat>& images,
                                    const CaptureOrder& order) {
    for (const PatternAxis axis : {PatternAxis::columns, PatternAxis::rows}) {
        const StripeWalk walk(images, order, axis);
        if (auto misplaced = wrongFineness(walk.all(), view, order)) return misplaced;
        if (auto turned = wrongDirection(walk.bits(), view, order)) return turned;
        if (auto mixed = wrongCodes(walk, view, order)) return mixed;
    }
    return std::nullopt;
}

} // namespace lumorph
