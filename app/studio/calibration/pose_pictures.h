#pragma once

#include <QImage>
#include <QSize>

#include "calibration/decode/pattern_decoder.h"

namespace lumorph::studio {

/// A pose as pictures to look at; at most 960 pixels wide, all of one size.
struct PosePictures {
    QSize camera;         ///< pixels of the camera's picture, in which points are told
    cv::Rect lit;         ///< of those, around where the projector's light was seen; empty: nowhere
    cv::Mat grey;         ///< under white light, as it was taken, 8-bit
    QImage white;         ///< the same
    QImage columns, rows; ///< the projector's coordinates in colours, with a line every 64 projector pixels
    QImage confidence;    ///< from dark (not known) to bright
};

/// The decoded maps as pictures. `projector`: its size in pixels.
[[nodiscard]] PosePictures picturesOf(const DecodedView& decoded, cv::Size projector);

/// 8-bit grey or BGR as a picture of at most 960 pixels.
[[nodiscard]] QImage pictureOfMat(const cv::Mat& image);

} // namespace lumorph::studio
