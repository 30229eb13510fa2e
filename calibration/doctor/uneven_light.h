#pragma once

#include <optional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "calibration/decode/capture_folder.h"
#include "calibration/patterns/capture_order.h"

namespace lumorph {

// Each pattern and its inverse, and the steps of each set of phases, make the same even light. Where they do not, what
// was done to the images is found by taking it back.

/// A cause that applies to the images as they are: once it is taken back, all sets make even light. Brightness that
/// changes from image to image (`exposure_drifts`), a response curve (`projector_gamma`), greys that were cut off
/// (`clipped`), or noise (`noisy`). Nothing where all are even, or none of these restores them.
[[nodiscard]] std::optional<Finding> causeInGreys(const CapturedView& view, const std::vector<cv::Mat>& images,
                                                  const CaptureOrder& order);

/// A cause that lies in single images, most sets being even: something covers a part of the picture in them
/// (`hand_in_view`), they are disturbed all over in a fine way (`noisy`), or one was taken elsewhere (`foreign_image`).
[[nodiscard]] std::optional<Finding> causeInImages(const CapturedView& view, const std::vector<cv::Mat>& images,
                                                   const CaptureOrder& order);

/// The images with the brightness that makes all sets most alike, least squares; and by how much that changes within
/// the pose, as a share.
struct SteadiedImages {
    std::vector<cv::Mat> images;
    double change = 0.0;
};
[[nodiscard]] SteadiedImages steadied(const std::vector<cv::Mat>& images, const CaptureOrder& order);
/// What is told of it.
[[nodiscard]] Finding driftFinding(const std::string& view, const std::string& file, double change);

/// Noise of one image's grey, standard deviation, from neighbouring pixels of sets that should be alike.
[[nodiscard]] double pixelNoiseOf(const std::vector<cv::Mat>& images, const CaptureOrder& order);

/// What of two pictures of one scene differs: in a part of it, the rest being the same, or all over.
enum class Difference { none, inPart, allOver };
/// `change`: by how much, as a share of the light; not a number where nothing is lit.
[[nodiscard]] Difference differenceIn(const cv::Mat1f& change);

} // namespace lumorph
