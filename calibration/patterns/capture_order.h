#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <opencv2/core.hpp>

#include "calibration/patterns/phase_shift.h"

namespace lumorph {

/// One stripe image of a Gray code; bit 0 is the finest.
struct GrayBit {
    PatternAxis axis = PatternAxis::columns;
    int bit = 0;
    bool inverse = false;
    bool operator==(const GrayBit&) const = default;
};

/// One image of a phase shift set.
struct PhaseStep {
    PatternAxis axis = PatternAxis::columns;
    int periods = 1;
    int step = 0;
    int steps = 3;
    bool operator==(const PhaseStep&) const = default;
};

/// All pixels alike.
struct FlatField {
    bool white = true;
    bool operator==(const FlatField&) const = default;
};

/// An image of a capture that nothing is read from.
struct UnusedImage {
    bool operator==(const UnusedImage&) const = default;
};

/// What one image of a capture shows.
using PatternImage = std::variant<GrayBit, PhaseStep, FlatField, UnusedImage>;

/// What each image of one pose shows, in the order in which they are projected and named.
struct CaptureOrder {
    cv::Size projector;
    std::vector<PatternImage> images;
    bool operator==(const CaptureOrder&) const = default;
};

/// `graycode`: columns then rows, the most significant bit first, each followed by its inverse, then white and black.
/// `phase:16x3+1x3`: columns then rows, each three steps of 16 periods and three of one. Three steps or more; to tell
/// one period from the next, a set has one period, or two sets have numbers of periods that differ by one.
/// Throws InvalidInput naming the part that is wrong.
[[nodiscard]] CaptureOrder parsePattern(std::string_view text, cv::Size projector);

/// For light on anything but a flat board: phases of four steps, which a projector's gamma leaves alone.
inline constexpr const char* kFourStepPattern = "phase:16x4+1x4";

/// Parses an order file, one line an image: `column bit 9`, `row bit 0 inverse`, `column phase 16 step 0 of 3`,
/// `white`, `black`, `unused`; empty lines, and what follows a #, are left out. `name` stands in errors. Throws
/// DataError with the line.
[[nodiscard]] CaptureOrder parseCaptureOrder(std::string_view text, const std::string& name, cv::Size projector);
/// The same from a file.
[[nodiscard]] CaptureOrder readCaptureOrder(const std::filesystem::path& file, cv::Size projector);

/// Parses "1024x768". Throws InvalidInput.
[[nodiscard]] cv::Size parseProjectorSize(std::string_view text);

/// A line of an order file.
[[nodiscard]] std::string wordsOf(const PatternImage& image);

/// What the projector shows for it, 8-bit grey; what is unused is black.
[[nodiscard]] cv::Mat drawPattern(const PatternImage& image, cv::Size projector);

} // namespace lumorph
