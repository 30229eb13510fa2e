#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include <glm/vec3.hpp>

#include "calibration/tracking/board_finder.h"

namespace lumorph {

/// A lens as it was calibrated, for pictures of the size that the camera gives; pixels.
struct CameraLens {
    double fx = 0.0, fy = 0.0, cx = 0.0, cy = 0.0;
    std::array<double, 5> distortion{}; ///< k1, k2, p1, p2, k3
    bool operator==(const CameraLens&) const = default;
};

/// Where a camera stands and what it looks at, world metres, upright.
struct CameraPlace {
    glm::dvec3 from{0.0};
    glm::dvec3 to{0.0};
    bool operator==(const CameraPlace&) const = default;
};

/// Which camera or video sees which board.
struct BoardAddress {
    std::string source; ///< "/dev/video0" or a video file
    MarkerBoard board;
    std::string body = "board"; ///< what the board is called among the tracked bodies
    std::optional<CameraLens> lens;
    double fieldOfViewDegrees = 60.0; ///< from left to right; taken for true where there is no lens
    std::optional<CameraPlace> place; ///< empty: so that the board lies at its place where it is seen first
    double aboveMillimetres = 0.0;    ///< the board's height over the body's origin
    bool repeat = false;              ///< a file begins anew at its end
    bool operator==(const BoardAddress&) const = default;
};

/// True for what begins as an address of a board.
[[nodiscard]] bool isBoardAddress(std::string_view uri);

/// Reads `board://camera0?..`, `board:///dev/video2?..` or `board:///path/video.mp4?..` with, all optional:
/// `squares=5x7`, `size=30` and `marker=22` (millimetres), `dictionary=4X4_50`, `kind=charuco|aruco`, `name=board`,
/// `lens=fx,fy,cx,cy[,k1,k2,p1,p2[,k3]]` (pixels) or `fov=60` (degrees), `from=x,y,z&to=x,y,z` (metres), `above=4`
/// (millimetres), `repeat=yes|no`. Throws InvalidInput naming the part that is wrong.
[[nodiscard]] BoardAddress parseBoardAddress(std::string_view uri);

/// Parses the board of such words alone: `squares=5x7&size=30`. Throws as above.
[[nodiscard]] MarkerBoard parseBoardWords(std::string_view query);

} // namespace lumorph
