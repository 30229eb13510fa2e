#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
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

/// Whether a file comes before another as people mean their names: numbers count as numbers (2 before 10), capital
/// letters as small ones, and `shot.png` comes before `shot (1).png`.
[[nodiscard]] bool isNamedBefore(const std::filesystem::path& one, const std::filesystem::path& other);

/// Pictures of a folder in the order of their names: of every kind that OpenCV reads. Files whose names begin with a
/// dot are none. Throws DataError where it is no folder or has none.
[[nodiscard]] std::vector<std::filesystem::path> imagesIn(const std::filesystem::path& folder);

/// The folders in `folder` by name, but for hidden ones, which are being written. Throws DataError where it is none.
[[nodiscard]] std::vector<std::filesystem::path> foldersIn(const std::filesystem::path& folder);

/// What a folder of poses holds.
struct CaptureListing {
    std::vector<CapturedView> views; ///< one a folder, by name
    std::vector<Finding> passedOver; ///< `passedOver`: what lies beside them and is none of the capture
};

/// Looks through a folder of poses. Patterns as they are projected (a folder of pictures with two greys), pictures
/// beside the folders, folders without pictures, and files that are no pictures are passed over and named. Throws
/// DataError where no pose is left.
[[nodiscard]] CaptureListing listCapture(const std::filesystem::path& folder);

/// The poses alone.
[[nodiscard]] std::vector<CapturedView> viewsIn(const std::filesystem::path& folder);

/// Takes out of a pose with more images than patterns those that are of another size or kind of file than most, where
/// as many are left as there are patterns: a photo of the room. Returns what was taken out.
[[nodiscard]] std::optional<Finding> dropStrangers(CapturedView& view, std::size_t patterns);

/// Lies in a capture of the virtual lab that has no truth.json.
inline constexpr const char* kLabCaptureMark = "simulated.txt";
/// Whether the pictures in a folder are the virtual lab's.
[[nodiscard]] bool isLabCapture(const std::filesystem::path& folder);

/// One image as 8-bit grey. More bits than 8 are taken from the brightest that the image has, in whole bits: 10 or 12
/// bits in a file of 16 are as bright as 16. Throws CaptureRefused when it cannot be read or is too large to unpack.
[[nodiscard]] cv::Mat readGrey(const std::filesystem::path& file, const std::string& view);

/// All images of a pose, of more bits than 8 by the brightest of all. Throws CaptureRefused when one cannot be read, or
/// has another size than the first.
[[nodiscard]] std::vector<cv::Mat> readImages(const CapturedView& view);

} // namespace lumorph
