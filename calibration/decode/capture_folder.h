#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "calibration/decode/refusal.h"

namespace lumorph {

/// Where the images of one pose lie, in the order in which they were taken.
struct CapturedView {
    std::string name; ///< of its folder
    std::vector<std::filesystem::path> files;
};

/// Whether a file comes before another by name, where numbers count as numbers: 2 before 10.
[[nodiscard]] bool isNamedBefore(const std::filesystem::path& one, const std::filesystem::path& other);

/// PNG and JPEG files of a folder in the order of their names. Throws DataError where it is no folder or has none.
[[nodiscard]] std::vector<std::filesystem::path> imagesIn(const std::filesystem::path& folder);

/// The folders in `folder` by name, but for hidden ones, which are being written. Throws DataError where it is none.
[[nodiscard]] std::vector<std::filesystem::path> foldersIn(const std::filesystem::path& folder);

/// The folders in `folder` that hold images, one a pose, by name. Throws DataError where there is none.
[[nodiscard]] std::vector<CapturedView> viewsIn(const std::filesystem::path& folder);

/// Lies in a capture of the virtual lab that has no truth.json.
inline constexpr const char* kLabCaptureMark = "simulated.txt";
/// Whether the pictures in a folder are the virtual lab's.
[[nodiscard]] bool isLabCapture(const std::filesystem::path& folder);

/// One image as 8-bit grey. Throws CaptureRefused when it cannot be read or is too large to unpack.
[[nodiscard]] cv::Mat readGrey(const std::filesystem::path& file, const std::string& view);

/// All images of a pose. Throws CaptureRefused when one cannot be read, or has another size than the first.
[[nodiscard]] std::vector<cv::Mat> readImages(const CapturedView& view);

} // namespace lumorph
