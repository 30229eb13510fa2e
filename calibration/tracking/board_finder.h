#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "core/geometry/calibrated_camera.h"
#include "core/loop/pose_stream.h"
#include "core/render/image.h"

namespace lumorph {

/// A printed board of markers. Its frame: origin at the lower left corner of the page, +X right, +Y up the page, +Z out
/// of it towards whoever looks; metres.
struct MarkerBoard {
    enum class Kind { aruco, charuco };
    Kind kind = Kind::charuco;
    int columns = 5; ///< squares (ChArUco) or markers (ArUco) side by side
    int rows = 7;
    double square = 0.03;              ///< metres; ArUco: from one marker's edge to the next marker's same edge
    double marker = 0.022;             ///< metres, less than `square`
    std::string dictionary = "4X4_50"; ///< as OpenCV names it, without DICT_
    bool operator==(const MarkerBoard&) const = default;
};

/// Throws InvalidInput naming what is wrong.
void checkBoard(const MarkerBoard& board);

/// Where a board was seen.
struct BoardSighting {
    Pose cameraFromBoard;           ///< OpenCV's camera frame: +X right, +Y down, +Z forward
    double reprojectionError = 0.0; ///< root mean square, pixels
    int points = 0;                 ///< corners it was found by
    double coverage = 0.0;          ///< share of the board's corners
};

/// Finds one board in grey pictures of one camera. One thread at a time.
class BoardFinder {
public:
    /// Throws as checkBoard and checkCamera.
    BoardFinder(const MarkerBoard& board, const CalibratedCamera& camera);
    ~BoardFinder();
    BoardFinder(BoardFinder&&) noexcept;
    BoardFinder& operator=(BoardFinder&&) noexcept;

    /// `grey` has the camera's size, row after row from the top. Nothing where the board is not to be seen, or too
    /// little of it (under 6 corners), or where what is seen fits no pose within 5 pixels. Throws InvalidInput for
    /// another size.
    [[nodiscard]] std::optional<BoardSighting> find(std::span<const std::uint8_t> grey);

    /// The page to print: black on white, `pixelsPerMetre` fine, without a margin.
    [[nodiscard]] static Image page(const MarkerBoard& board, double pixelsPerMetre);

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

/// The device's pose in the world from a sighting: `camera` holds where the camera stands, `deviceFromBoard` how the
/// board is fixed to the device.
[[nodiscard]] Pose worldFromDevice(const BoardSighting& sighting, const CalibratedCamera& camera,
                                   const Pose& deviceFromBoard);

} // namespace lumorph
