#pragma once

#include <optional>
#include <vector>

#include "calibration/decode/capture_folder.h"
#include "calibration/decode/pattern_decoder.h"
#include "calibration/decode/refusal.h"
#include "calibration/solve/observations.h"

namespace lumorph {

/// Whether camera or board moved while the patterns of one pose were shown: the board's points are looked for again in
/// every image of even light. Nothing where they stay within half a pixel.
[[nodiscard]] std::optional<Finding> checkSteadiness(const CapturedView& view, const std::vector<cv::Mat>& images,
                                                     const CaptureOrder& order, const std::vector<cv::Point2d>& board);

/// Whether the board is overexposed.
[[nodiscard]] std::optional<Finding> checkExposure(const std::string& view, const DecodedView& decoded,
                                                   const std::vector<cv::Point2d>& board);

/// Whether so much of what the projector lights is overexposed that no board can be found.
[[nodiscard]] std::optional<Finding> checkLight(const std::string& view, const DecodedView& decoded);

/// Whether what was decoded can come from a projector of this size: coordinates past its edge, or a picture that ends
/// in a straight line before it. Where only the board is lit (its points in the camera's picture; empty: not known),
/// its own rim is no such end.
[[nodiscard]] std::optional<Finding> checkProjectorSize(const std::string& view, const DecodedView& decoded,
                                                        cv::Size projector, const std::vector<cv::Point2d>& board);

/// Whether poses are mirror images: a camera and a projector on the same side of a board never see it so. Nothing where
/// none is.
[[nodiscard]] std::optional<Finding> checkMirrored(const std::vector<ViewObservations>& views);

} // namespace lumorph
