#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/image.h"
#include "core/geometry/calibrated_camera.h"
#include "core/loop/pose_stream.h"

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

/// Width and height of the printed page without a margin, metres.
[[nodiscard]] glm::dvec2 sizeOf(const MarkerBoard& board);

/// Where a board was seen.
struct BoardSighting {
    Pose cameraFromBoard;           ///< OpenCV's camera frame: +X right, +Y down, +Z forward
    double reprojectionError = 0.0; ///< root mean square, pixels
    int points = 0;                 ///< corners it was found by
    double coverage = 0.0;          ///< share of the board's corners
};

/// A black part of a printed board, upright; metres in the board's frame.
struct BlackBox {
    glm::dvec2 corner{0.0}; ///< lower left
    glm::dvec2 size{0.0};
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
    /// little of it (under 6 corners), or where what is seen fits no pose within 5 pixels. A board that is seen from
    /// afar looks much the same in two poses: of these the one nearer to `hint` is taken, the pose of just before.
    /// Throws InvalidInput for another size.
    [[nodiscard]] std::optional<BoardSighting> find(std::span<const std::uint8_t> grey,
                                                    const std::optional<Pose>& hint = std::nullopt);
    /// Corners of the board that were seen in the last picture, though they may have been too few.
    [[nodiscard]] int cornersSeen() const noexcept;

    /// The page as a picture: black on white, `pixelsPerMetre` fine, without a margin.
    [[nodiscard]] static Image page(const MarkerBoard& board, double pixelsPerMetre);
    /// The same as boxes, which meet and do not overlap. Throws as checkBoard.
    [[nodiscard]] static std::vector<BlackBox> blackBoxes(const MarkerBoard& board);

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

/// The device's pose in the world from a sighting: `camera` holds where the camera stands, `deviceFromBoard` how the
/// board is fixed to the device.
[[nodiscard]] Pose worldFromDevice(const BoardSighting& sighting, const CalibratedCamera& camera,
                                   const Pose& deviceFromBoard);

} // namespace lumorph
