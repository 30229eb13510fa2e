#include "calibration/patterns/capture_order.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <set>
#include <sstream>

#include "calibration/patterns/gray_code.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/text.h"

namespace lumorph {

namespace {

constexpr int kMostImages = 500;
constexpr int kMostSteps = 64;
constexpr int kLargestSide = 16384;
constexpr std::size_t kMostOrderBytes = 1 << 20;

std::optional<int> wholeNumber(std::string_view text) {
    int value = 0;
    const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
    if (text.empty() || read.ec != std::errc() || read.ptr != text.data() + text.size()) return std::nullopt;
    return value;
}

/// The two numbers of "16x3".
std::optional<std::pair<int, int>> numberPair(std::string_view text) {
    const std::size_t cross = text.find('x');
    if (cross == std::string_view::npos) return std::nullopt;
    const auto first = wholeNumber(text.substr(0, cross));
    const auto second = wholeNumber(text.substr(cross + 1));
    if (!first || !second) return std::nullopt;
    return std::pair(*first, *second);
}

int lengthOf(PatternAxis axis, cv::Size projector) {
    return axis == PatternAxis::columns ? projector.width : projector.height;
}

void addGrayCode(CaptureOrder& order, PatternAxis axis) {
    for (int bit = grayCodeBits(lengthOf(axis, order.projector)) - 1; bit >= 0; --bit)
        for (const bool inverse : {false, true}) order.images.emplace_back(GrayBit{axis, bit, inverse});
}

CaptureOrder grayCodeOrder(cv::Size projector) {
    CaptureOrder order{projector, {}};
    addGrayCode(order, PatternAxis::columns);
    addGrayCode(order, PatternAxis::rows);
    order.images.emplace_back(FlatField{true});
    order.images.emplace_back(FlatField{false});
    return order;
}

[[noreturn]] void refusePattern(std::string_view text, const std::string& why) {
    throw InvalidInput("pattern " + inQuotes(text), why, "write graycode, or phase:16x3+1x3 (periods x steps)");
}

CaptureOrder phaseOrder(std::string_view text, std::string_view sets, cv::Size projector) {
    std::vector<std::pair<int, int>> all;
    for (std::size_t begin = 0; begin <= sets.size();) {
        const std::size_t end = std::min(sets.find('+', begin), sets.size());
        const auto set = numberPair(sets.substr(begin, end - begin));
        if (!set) refusePattern(text, inQuotes(sets.substr(begin, end - begin)) + " is no number of periods x steps");
        if (set->second < 3 || set->second > kMostSteps)
            refusePattern(text, std::to_string(set->second) + " steps, not 3 to " + std::to_string(kMostSteps));
        if (set->first < 1 || 4 * set->first > std::min(projector.width, projector.height))
            refusePattern(text,
                          std::to_string(set->first) + " periods, not one to a quarter of the projector's pixels");
        all.push_back(*set);
        begin = end + 1;
    }
    const auto tellsPeriods = [&all](const auto& set) {
        return set.first == 1 ||
               std::ranges::any_of(all, [&set](const auto& other) { return other.first == set.first + 1; });
    };
    if (std::ranges::none_of(all, tellsPeriods))
        refusePattern(text, "nothing tells one period from the next; add a set of 1 period");
    CaptureOrder order{projector, {}};
    for (const PatternAxis axis : {PatternAxis::columns, PatternAxis::rows})
        for (const auto& [periods, steps] : all)
            for (int step = 0; step < steps; ++step) order.images.emplace_back(PhaseStep{axis, periods, step, steps});
    if (order.images.size() > kMostImages) refusePattern(text, "more than " + std::to_string(kMostImages) + " images");
    return order;
}

/// One line of an order file; empty where it says nothing that is known.
std::optional<PatternImage> imageOf(const std::string& line) {
    std::istringstream words(line);
    std::vector<std::string> word;
    for (std::string each; words >> each;) word.push_back(each);
    if (word.size() == 1 && (word[0] == "white" || word[0] == "black")) return FlatField{word[0] == "white"};
    if (word.size() == 1 && word[0] == "unused") return UnusedImage{};
    if (word.size() < 3 || (word[0] != "column" && word[0] != "row")) return std::nullopt;
    const PatternAxis axis = word[0] == "column" ? PatternAxis::columns : PatternAxis::rows;
    const auto number = wholeNumber(word[2]);
    if (!number || *number < 0 || *number > kLargestSide) return std::nullopt;
    const bool inverse = word.size() == 4 && word[3] == "inverse";
    if (word[1] == "bit" && (word.size() == 3 || inverse)) return GrayBit{axis, *number, inverse};
    if (word[1] != "phase" || word.size() != 7 || word[3] != "step" || word[5] != "of") return std::nullopt;
    const auto step = wholeNumber(word[4]);
    const auto steps = wholeNumber(word[6]);
    if (!step || !steps || *steps < 3 || *steps > kMostSteps || *step < 0 || *step >= *steps) return std::nullopt;
    return PhaseStep{axis, *number, *step, *steps};
}

bool fits(const PatternImage& image, cv::Size projector) {
    if (const auto* gray = std::get_if<GrayBit>(&image))
        return gray->bit < grayCodeBits(lengthOf(gray->axis, projector));
    if (const auto* phase = std::get_if<PhaseStep>(&image))
        return phase->periods >= 1 && 4 * phase->periods <= lengthOf(phase->axis, projector);
    return true;
}

} // namespace

CaptureOrder parsePattern(std::string_view text, cv::Size projector) {
    constexpr std::string_view kPhase = "phase:";
    if (text == "graycode") return grayCodeOrder(projector);
    if (!text.starts_with(kPhase)) refusePattern(text, "there is no such pattern");
    return phaseOrder(text, text.substr(kPhase.size()), projector);
}

CaptureOrder parseCaptureOrder(std::string_view text, const std::string& name, cv::Size projector) {
    CaptureOrder order{projector, {}};
    std::istringstream lines{std::string(text)};
    std::set<std::string> seen;
    int number = 0;
    for (std::string line; std::getline(lines, line);) {
        ++number;
        const auto refuse = [&](const std::string& why) {
            throw DataError(name + ", line " + std::to_string(number), why,
                            "write lines such as 'column bit 9', 'row bit 0 inverse', 'column phase 16 step 0 of 3', "
                            "'white', 'black' or 'unused'");
        };
        line = line.substr(0, line.find('#'));
        if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
        const auto image = imageOf(line);
        if (!image) refuse(inQuotes(line) + " is no image that is known");
        if (!fits(*image, projector)) refuse(inQuotes(line) + " is finer than the projector's pixels");
        if (!std::holds_alternative<UnusedImage>(*image) && !seen.insert(wordsOf(*image)).second)
            refuse(inQuotes(line) + " is there twice");
        order.images.push_back(*image);
        if (order.images.size() > kMostImages) refuse("more than " + std::to_string(kMostImages) + " images");
    }
    if (order.images.empty()) throw DataError(name, "names no image", "write one line for each image of a pose");
    return order;
}

CaptureOrder readCaptureOrder(const std::filesystem::path& file, cv::Size projector) {
    const std::vector<std::byte> bytes = readFile(file, kMostOrderBytes);
    return parseCaptureOrder({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, file.string(), projector);
}

cv::Size parseProjectorSize(std::string_view text) {
    const auto size = numberPair(text);
    if (!size || size->first < 16 || size->second < 16 || size->first > kLargestSide || size->second > kLargestSide)
        throw InvalidInput("projector size " + inQuotes(text), "is no width x height in pixels",
                           "write it as 1024x768, from 16 to " + std::to_string(kLargestSide) + " a side");
    return {size->first, size->second};
}

std::string wordsOf(const PatternImage& image) {
    const auto axisWord = [](PatternAxis axis) {
        return std::string(axis == PatternAxis::columns ? "column " : "row ");
    };
    if (const auto* gray = std::get_if<GrayBit>(&image))
        return axisWord(gray->axis) + "bit " + std::to_string(gray->bit) + (gray->inverse ? " inverse" : "");
    if (const auto* phase = std::get_if<PhaseStep>(&image))
        return axisWord(phase->axis) + "phase " + std::to_string(phase->periods) + " step " +
               std::to_string(phase->step) + " of " + std::to_string(phase->steps);
    if (const auto* flat = std::get_if<FlatField>(&image)) return flat->white ? "white" : "black";
    return "unused";
}

cv::Mat drawPattern(const PatternImage& image, cv::Size projector) {
    if (const auto* phase = std::get_if<PhaseStep>(&image))
        return phaseShiftPattern(projector, phase->axis, phase->periods, phase->step, phase->steps);
    if (const auto* gray = std::get_if<GrayBit>(&image))
        return grayCodePattern(projector, gray->axis, gray->bit, gray->inverse);
    const auto* flat = std::get_if<FlatField>(&image);
    return {projector, CV_8U, cv::Scalar(flat != nullptr && flat->white ? 255 : 0)};
}

} // namespace lumorph
