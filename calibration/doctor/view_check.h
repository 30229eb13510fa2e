#pragma once

#include <optional>
#include <vector>

#include "calibration/decode/calibration_board.h"
#include "calibration/decode/capture_folder.h"
#include "calibration/decode/pattern_decoder.h"
#include "calibration/decode/refusal.h"
#include "calibration/solve/observations.h"

namespace lumorph {

/// Whether all images of one pose show the board in one place: its points, which were found in `white`, are looked for
/// again in every image of even light. Camera or board moved (`rig_moved`), white is of another pose
/// (`foreign_image`), or single images are covered or disturbed, as `causeInImages` tells. Nothing where they stay
/// within half a pixel.
[[nodiscard]] std::optional<Finding> checkSteadiness(const CapturedView& view, const std::vector<cv::Mat>& images,
                                                     const CaptureOrder& order, const cv::Mat1b& white,
                                                     const std::vector<cv::Point2d>& board);

/// Whether a chessboard has another number of inner corners than said: more, of which a part was found, or fewer, with
/// all of it in the picture. `found`: whether it was found as said.
[[nodiscard]] std::optional<Finding> checkBoardSize(const std::string& view, const cv::Mat1b& white,
                                                    const CalibrationBoard& board, bool found);

/// Whether the edges of a chessboard's squares are blurred over several pixels of the camera.
[[nodiscard]] std::optional<Finding> checkSharpness(const std::string& view, const cv::Mat1b& white,
                                                    const BoardPoints& found);

/// Whether stripes are blurred away that the camera's pixels would resolve.
[[nodiscard]] std::optional<Finding> checkFocus(const std::string& view, const DecodedView& decoded,
                                                const std::vector<cv::Mat>& images, const CaptureOrder& order);

/// Whether the board is overexposed.
[[nodiscard]] std::optional<Finding> checkExposure(const std::string& view, const DecodedView& decoded,
                                                   const std::vector<cv::Point2d>& board);

/// Whether so much of what the projector lights is overexposed that no board can be found or followed.
[[nodiscard]] std::optional<Finding> checkLight(const std::string& view, const DecodedView& decoded);

/// Whether white and black differ by so few greys that patterns hardly can be told.
[[nodiscard]] std::optional<Finding> checkDark(const std::string& view, const DecodedView& decoded);

/// Whether noise is so large beside the projector's light that patterns are lost in it.
[[nodiscard]] std::optional<Finding> checkNoise(const std::string& view, const DecodedView& decoded);

/// Whether what was decoded can come from a projector of this size: coordinates past its edge, or a picture that ends
/// in a straight line before it. Where only the board is lit (its points in the camera's picture; empty: not known),
/// its own rim is no such end.
[[nodiscard]] std::optional<Finding> checkProjectorSize(const std::string& view, const DecodedView& decoded,
                                                        cv::Size projector, const std::vector<cv::Point2d>& board);

/// Whether poses are mirror images: a camera and a projector on the same side of a board never see it so. Nothing where
/// none is.
[[nodiscard]] std::optional<Finding> checkMirrored(const std::vector<ViewObservations>& views);

/// Whether one pose sees the projector's picture upside down and others do not (`phase_order`): a camera is never
/// turned over between poses, but steps of phases are exchanged.
[[nodiscard]] std::optional<Finding> checkTurned(const std::vector<ViewObservations>& views);
/// Whether all poses see it so.
[[nodiscard]] bool isUpsideDown(const std::vector<ViewObservations>& views);

} // namespace lumorph
