#include "calibration/doctor/sequence_check.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>

#include "calibration/decode/pattern_decoder.h"
#include "calibration/doctor/uneven_light.h"

namespace lumorph {

namespace {

constexpr int kEvery = 4;              // pixels that are looked at, along both sides
constexpr double kUneven = 0.08;       // of the light that is switched: above, a set makes no even light
constexpr double kAlike = 0.04;        // below, two images show the same
constexpr double kMostShare = 0.8;     // of sets that must agree
constexpr double kLeastRange = 12.0;   // grey levels
constexpr double kOverexposed = 254.0; // grey levels
constexpr double kMostClipped = 0.4;   // of the lit pixels: above, nothing but that can be said

/// The images of a pose at some of the pixels that the projector lights well.
class SampledStack {
public:
    SampledStack(const std::vector<cv::Mat>& images, const CaptureOrder& order) : images_(images) {
        for (const std::vector<int>& set : evenSets(order)) sets_.push_back({set.front(), set.back()});
        choosePixels();
    }

    [[nodiscard]] bool isLit() const { return !pixels_.empty() && !sets_.empty(); }
    [[nodiscard]] int setCount() const { return static_cast<int>(sets_.size()); }
    [[nodiscard]] int firstImageOf(int set) const { return sets_[static_cast<std::size_t>(set)].first; }
    [[nodiscard]] int lastImageOf(int set) const { return sets_[static_cast<std::size_t>(set)].last; }

    /// Whether the images `shift` after those of the set make even light; false past the last.
    [[nodiscard]] bool isEven(int set, int shift) const {
        const auto [first, last] = sets_[static_cast<std::size_t>(set)];
        if (first + shift < 0 || last + shift >= static_cast<int>(images_.size())) return false;
        double sum = 0.0;
        for (const Pixel& pixel : pixels_) {
            double light = 0.0;
            for (int i = first + shift; i <= last + shift; ++i) light += grey(i, pixel);
            sum += std::abs(light / (last - first + 1) - pixel.mean) / pixel.range;
        }
        return sum / static_cast<double>(pixels_.size()) < kUneven;
    }

    [[nodiscard]] bool areAlike(int one, int other) const {
        double sum = 0.0;
        for (const Pixel& pixel : pixels_) sum += std::abs(grey(one, pixel) - grey(other, pixel)) / pixel.range;
        return sum / static_cast<double>(pixels_.size()) < kAlike;
    }

    [[nodiscard]] bool areIdentical(int one, int other) const {
        return cv::norm(image(one), image(other), cv::NORM_INF) == 0.0;
    }

    /// How much brighter the one image is, of the light that is switched.
    [[nodiscard]] double brighterBy(int one, int other) const {
        double sum = 0.0;
        for (const Pixel& pixel : pixels_) sum += (grey(one, pixel) - grey(other, pixel)) / pixel.range;
        return sum / static_cast<double>(pixels_.size());
    }

    /// Share of the pixels that are overexposed in some image.
    [[nodiscard]] double clippedShare() const {
        const auto clipped = std::ranges::count_if(pixels_, &Pixel::isClipped);
        return static_cast<double>(clipped) / static_cast<double>(std::max<std::size_t>(1, pixels_.size()));
    }

private:
    struct Pixel {
        int x = 0, y = 0;
        double mean = 0.0;  ///< over all images: nearly the even light, in whatever order they are
        double range = 1.0; ///< from the darkest to the brightest
        bool isClipped = false;
    };
    struct Set {
        int first = 0, last = 0;
    };

    [[nodiscard]] const cv::Mat& image(int i) const { return images_[static_cast<std::size_t>(i)]; }
    [[nodiscard]] double grey(int i, const Pixel& pixel) const { return image(i).at<std::uint8_t>(pixel.y, pixel.x); }

    void choosePixels() {
        for (int y = 0; y < images_.front().rows; y += kEvery)
            for (int x = 0; x < images_.front().cols; x += kEvery) {
                Pixel pixel{x, y, 0.0, 0.0};
                double least = 255.0;
                double most = 0.0;
                for (int i = 0; i < static_cast<int>(images_.size()); ++i) {
                    const double value = grey(i, pixel);
                    least = std::min(least, value);
                    most = std::max(most, value);
                    pixel.mean += value / static_cast<double>(images_.size());
                }
                pixel.range = most - least;
                pixel.isClipped = most >= kOverexposed;
                if (pixel.range > kLeastRange) pixels_.push_back(pixel);
            }
        if (pixels_.empty()) return;
        const auto high = pixels_.begin() + static_cast<std::ptrdiff_t>(pixels_.size() * 9 / 10);
        std::ranges::nth_element(pixels_, high, {}, &Pixel::range);
        const double least = 0.4 * high->range;
        std::erase_if(pixels_, [least](const Pixel& pixel) { return pixel.range < least; });
    }

    const std::vector<cv::Mat>& images_;
    std::vector<Set> sets_;
    std::vector<Pixel> pixels_;
};

/// The last number in a file's name; -1 for none.
int numberOf(const std::filesystem::path& file) {
    const std::string name = file.stem().string();
    std::size_t end = name.size();
    while (end > 0 && std::isdigit(static_cast<unsigned char>(name[end - 1])) == 0) --end;
    std::size_t begin = end;
    while (begin > 0 && std::isdigit(static_cast<unsigned char>(name[begin - 1])) != 0) --begin;
    if (begin == end || end - begin > 8) return -1;
    return std::stoi(name.substr(begin, end - begin));
}

/// The file before which a number is left out.
std::optional<std::size_t> gapIn(const CapturedView& view) {
    for (std::size_t i = 0; i + 1 < view.files.size(); ++i)
        if (numberOf(view.files[i]) >= 0 && numberOf(view.files[i + 1]) > numberOf(view.files[i]) + 1) return i + 1;
    return std::nullopt;
}

std::string nameIn(const CapturedView& view, int image) {
    const auto last = static_cast<int>(view.files.size()) - 1;
    return view.files[static_cast<std::size_t>(std::clamp(image, 0, last))].filename().string();
}

bool hasGrayCode(const CaptureOrder& order) {
    return std::ranges::any_of(order.images,
                               [](const PatternImage& image) { return std::holds_alternative<GrayBit>(image); });
}

std::string countText(const CapturedView& view, const CaptureOrder& order) {
    return std::to_string(view.files.size()) + " images, but the patterns are " + std::to_string(order.images.size());
}

const char* const kCaptureAgain = "capture this pose again";

/// An image that is there twice in a pose that has too many.
std::string doubledFile(const CapturedView& view) {
    cv::Mat before;
    for (const std::filesystem::path& file : view.files) {
        const cv::Mat here = readGrey(file, view.name);
        if (!before.empty() && here.size() == before.size() && cv::norm(here, before, cv::NORM_INF) == 0.0)
            return file.filename().string();
        before = here;
    }
    return {};
}

/// One image is missing and the names do not tell which: all sets but its own make even light, those after it one image
/// earlier. Of a pattern and its inverse the images themselves do not tell which of the two is left.
Finding missingOne(const CapturedView& view, const CaptureOrder& order) {
    Finding finding{Cause::missingImage, view.name, "", "holds " + countText(view, order), kCaptureAgain};
    const std::vector<cv::Mat> images = readImages(view);
    const SampledStack stack(images, order);
    if (!stack.isLit()) return finding;
    const int sets = stack.setCount();
    int best = sets;
    int most = -1;
    for (int missing = 0; missing <= sets; ++missing) { // `sets`: an image that is of none, such as white or black
        int even = 0;
        for (int set = 0; set < sets; ++set) even += set != missing && stack.isEven(set, set < missing ? 0 : -1);
        if (even > most) most = even, best = missing;
    }
    if (most < static_cast<int>(std::lround(kMostShare * (sets - 1)))) return finding;
    const auto words = [&order](int image) { return wordsOf(order.images[static_cast<std::size_t>(image)]); };
    if (best == sets) {
        finding.why += "; white or black is missing";
        finding.file = nameIn(view, static_cast<int>(view.files.size()) - 1);
        return finding;
    }
    const int first = stack.firstImageOf(best);
    finding.file = nameIn(view, first);
    finding.why += "; beside this one '" + words(first) + "' or '" + words(stack.lastImageOf(best)) + "' is missing";
    return finding;
}

Finding countFinding(const CapturedView& view, const CaptureOrder& order) {
    if (view.files.size() > order.images.size()) {
        const std::string file = doubledFile(view);
        const std::string which = file.empty() ? "" : "; this one is the same as the one before";
        return {Cause::doubledImage, view.name, file, "holds " + countText(view, order) + which,
                "remove what is there twice, or " + std::string(kCaptureAgain)};
    }
    if (const auto gap = gapIn(view))
        return {Cause::missingImage, view.name, nameIn(view, static_cast<int>(*gap)),
                "holds " + countText(view, order) + "; before this one a number is left out", kCaptureAgain};
    if (view.files.size() + 1 == order.images.size()) return missingOne(view, order);
    return {Cause::missingImage, view.name, "", "holds " + countText(view, order), kCaptureAgain};
}

/// From the first set that makes no even light on.
Finding brokenFrom(const SampledStack& stack, const CapturedView& view, int set) {
    const auto shareEven = [&](int shift) {
        int even = 0;
        int all = 0;
        for (int s = set + 1; s < stack.setCount(); ++s) {
            if (stack.lastImageOf(s) + shift >= static_cast<int>(view.files.size())) continue;
            ++all;
            even += stack.isEven(s, shift);
        }
        return all > 0 ? static_cast<double>(even) / all : 0.0;
    };
    int image = stack.firstImageOf(set); // the first that is not what it should be
    std::optional<int> twin;
    for (int i = std::max(1, image - 1); i <= stack.lastImageOf(set) && !twin; ++i)
        if (stack.areAlike(i, i - 1)) twin = i;
    if (twin) image = *twin;
    const std::string file = nameIn(view, image);
    if (twin && stack.areIdentical(*twin, *twin - 1))
        return {Cause::doubledImage, view.name, file, "is the same image as the one before", kCaptureAgain};
    if (shareEven(1) >= kMostShare && shareEven(0) < kMostShare)
        return {Cause::lateFrame, view.name, file, "from here on each image shows the pattern before its own",
                "let the projector settle longer before each shot, and capture this pose again"};
    if (twin)
        return {Cause::lateFrame, view.name, file, "shows the pattern before its own",
                "let the projector settle longer before each shot, and capture this pose again"};
    if (shareEven(-1) >= kMostShare && shareEven(0) < kMostShare)
        return {Cause::missingImage, view.name, file, "from here on each image shows the pattern after its own",
                kCaptureAgain};
    return {Cause::wrongOrder, view.name, file, "does not show what the order of the patterns says",
            "check --pattern or the order file, and that nobody stepped into the light"};
}

std::optional<Finding> checkFlatFields(const SampledStack& stack, const CapturedView& view, const CaptureOrder& order) {
    const auto indexOf = [&order](bool white) {
        const auto found = std::ranges::find(order.images, PatternImage(FlatField{white}));
        return found == order.images.end() ? -1 : static_cast<int>(found - order.images.begin());
    };
    const int white = indexOf(true);
    const int black = indexOf(false);
    if (white < 0 || black < 0) return std::nullopt;
    const std::string file = nameIn(view, white);
    const double difference = stack.brighterBy(white, black);
    if (difference < -0.5)
        return Finding{Cause::blackWhiteSwapped, view.name, file,
                       "the image called white is darker than the one called black",
                       "exchange the two images, or correct the order"};
    if (difference > 0.5) return std::nullopt;
    if (stack.areIdentical(white, black))
        return Finding{Cause::doubledImage, view.name, nameIn(view, std::max(white, black)),
                       "is the same image as white", kCaptureAgain};
    constexpr double kWhiteAndBlack = 0.85; // of the light
    // A camera that sees half of the projector's picture has pattern and inverse of the coarsest bit all bright or
    // dark.
    const auto areOnePair = [&order](int one, int other) {
        const auto* a = std::get_if<GrayBit>(&order.images[static_cast<std::size_t>(one)]);
        const auto* b = std::get_if<GrayBit>(&order.images[static_cast<std::size_t>(other)]);
        return a != nullptr && b != nullptr && a->axis == b->axis && a->bit == b->bit;
    };
    for (int one = 0; one < static_cast<int>(order.images.size()); ++one)
        for (const int other : {one - 1, one + 1})
            if (other >= 0 && other < static_cast<int>(order.images.size()) && !areOnePair(one, other) &&
                stack.brighterBy(one, other) > kWhiteAndBlack)
                return Finding{Cause::wrongOrder, view.name, nameIn(view, one),
                               "white and black are seen here, where '" +
                                   wordsOf(order.images[static_cast<std::size_t>(one)]) + "' was said",
                               "put the images into the order of the patterns, or say theirs in an order file"};
    return Finding{Cause::lateFrame, view.name, nameIn(view, std::max(white, black)),
                   "white and black are about equally bright",
                   "let the projector settle longer before each shot, and capture this pose again"};
}

} // namespace

std::optional<Finding> checkCounts(const std::vector<CapturedView>& views, const CaptureOrder& order) {
    const auto isWrong = [&order](const CapturedView& view) { return view.files.size() != order.images.size(); };
    const auto wrong = std::ranges::find_if(views, isWrong);
    if (wrong == views.end()) return std::nullopt;
    const bool allAlike = std::ranges::all_of(views, [&](const CapturedView& view) {
        return view.files.size() == views.front().files.size() && !gapIn(view);
    });
    if (!allAlike || views.front().files.size() % 2 != 0 || !hasGrayCode(order)) return countFinding(*wrong, order);
    return Finding{Cause::projectorSize, "", "",
                   "every pose holds " + countText(*wrong, order) + " of a projector of " +
                       std::to_string(order.projector.width) + " x " + std::to_string(order.projector.height),
                   "give the size of the projector that the patterns were made for"};
}

std::optional<Finding> checkSequence(const CapturedView& view, const std::vector<cv::Mat>& images,
                                     const CaptureOrder& order) {
    const SampledStack stack(images, order);
    if (!stack.isLit()) return std::nullopt; // told when nothing can be decoded
    for (int set = 0; set < stack.setCount(); ++set) {
        if (stack.isEven(set, 0)) continue;
        if (auto cause = causeInGreys(view, images, order)) return cause; // what all images have: it can be taken back
        const Finding broken = brokenFrom(stack, view, set);
        if (broken.cause != Cause::wrongOrder) return broken;
        if (stack.clippedShare() >= kMostClipped)
            return Finding{Cause::clipped, view.name, "",
                           std::to_string(static_cast<int>(std::lround(100.0 * stack.clippedShare()))) +
                               " % of what the projector lights are overexposed, so that the patterns are lost",
                           "expose for less time until white is below 250 of 255, and capture this pose again"};
        if (auto cause = causeInImages(view, images, order)) return cause;
        return broken;
    }
    return checkFlatFields(stack, view, order);
}

} // namespace lumorph
