#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <glm/mat4x4.hpp>
#include <opencv2/core.hpp>

#include "calibration/decode/calibration_board.h"
#include "calibration/lab/lab.h"
#include "core/base/progress.h"

namespace lumorph {

/// How a board differs from what it is called.
struct PrintedBoard {
    /// Height of the sheet, towards the frame's +z, in the board's unit: at (X, Y), -1 to 1 between the outermost
    /// points, across X^2 + twist X Y + down Y^2. 0: flat.
    double across = 0.0, twist = 0.0, down = 0.0;
    glm::dvec2 stretch{1.0}; ///< true lengths by what they are called, along both sides
};

/// How the lab's camera takes pictures, and what else is not as it should be.
struct BoardLabOptions {
    double metresPerUnit = 0.001; ///< of the board
    int samples = 2;              ///< rays a camera pixel, along each side
    double whiteLevel = 200.0;    ///< grey of white paper that lies on the table under full white; above 255 it clips
    double ambient = 0.03;        ///< the room's light, as a share of the projector's full white
    double vignetting = 0.2;      ///< of the light, lost in the corners
    double blur = 0.5;            ///< standard deviation, camera pixels
    double noise = 0.7;           ///< standard deviation of grey, levels
    double shotNoise = 0.008;     ///< variance that each level of grey adds
    double tremble = 0.03;        ///< standard deviation of where a picture lies, camera pixels
    PrintedBoard shape;
    double cameraWave = 0.0, projectorWave = 0.0; ///< pixels by which a lens bends what no distortion model has
    /// Where a pixel of what is shown lies in the projector's panel, as by a keystone correction.
    cv::Matx33d warp = cv::Matx33d::eye();
};

/// The virtual lab's photographer: a printed board on the lab's table or in the air above, lit by one projector, seen
/// by one camera, both true to the last digit. Where the rays go is found once for each pose of the board; pictures
/// under other patterns then take a few hundredths of a second. One thread at a time. The same seed and calls give the
/// same pictures.
class BoardLab {
public:
    /// The first projector and camera of `truth` are the true ones; without a camera, that of `defaultLabCamera`.
    /// Throws InvalidInput without a projector, or for numbers that make no picture.
    BoardLab(const Installation& truth, const CalibrationBoard& board, const BoardLabOptions& options = {},
             std::uint32_t seed = 1);
    ~BoardLab();
    BoardLab(BoardLab&&) noexcept;
    BoardLab& operator=(BoardLab&&) noexcept;

    /// Poses (the world from the board's frame, metres) in which camera and projector both see all of the board: the
    /// first flat on the table around the world's origin, x along the world's +x and the printed side up, so that it
    /// can tell where the world is; the others tilted by 15 to 40 degrees to all sides, over the lit place. The same
    /// for the same seed; a longer list begins as a shorter one. Throws InvalidInput where the board does not fit,
    /// Cancelled.
    [[nodiscard]] std::vector<glm::dmat4> proposePoses(int count, const Progress& progress = {}) const;
    /// The same, without those of so many for which there is no place.
    [[nodiscard]] std::vector<glm::dmat4> possiblePoses(int count, const Progress& progress = {}) const;

    /// Lays the board there; before the first call there is none. Throws InvalidInput for a matrix that is no rotation
    /// and translation.
    void lay(const glm::dmat4& worldFromBoard);
    /// What the projector shows from now on: 8-bit grey of its size, black before the first call. Throws InvalidInput
    /// for anything else.
    void show(const cv::Mat& grey);
    /// A picture of that by the camera, 8-bit grey.
    [[nodiscard]] cv::Mat photograph();

    /// Camera or projector is another from now on: moved, or with another focal length. Throws InvalidInput for one
    /// that is not sound, or for another size of the projector's picture.
    void setCamera(const CalibratedCamera& camera);
    void setProjector(const CalibratedCamera& projector);

    // The truth.
    [[nodiscard]] const CalibratedCamera& camera() const noexcept;
    [[nodiscard]] const InstalledProjector& projector() const noexcept;
    [[nodiscard]] const CalibrationBoard& board() const noexcept;
    [[nodiscard]] const BoardLabOptions& options() const noexcept;
    /// The board's points, in its frame, metres, as they truly are: stretched and bent.
    [[nodiscard]] std::vector<glm::dvec3> points() const;
    /// Where a place of the board by its printed coordinates (the board's unit) truly is, likewise.
    [[nodiscard]] glm::dvec3 place(double x, double y) const;
    /// Where a world point falls in the camera, and in what the projector shows, pixels; empty behind the lens.
    [[nodiscard]] std::optional<glm::dvec2> cameraPixel(const glm::dvec3& point) const;
    [[nodiscard]] std::optional<glm::dvec2> projectorPixel(const glm::dvec3& point) const;

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

/// 32-bit grey levels as 8-bit ones with the camera's noise; the same for the same seed.
[[nodiscard]] cv::Mat withNoise(const cv::Mat& light, const BoardLabOptions& options, std::uint32_t seed);

/// A camera of 1280 x 1024 beside the projector that sees the place it lights, with a distortion as lenses have.
[[nodiscard]] CalibratedCamera defaultLabCamera(const CalibratedCamera& projector);
/// A room's first camera, or where it has none that of the lab beside its first projector. Throws InvalidInput without
/// a projector.
[[nodiscard]] CalibratedCamera labCamera(const Installation& room);
/// The room with it.
[[nodiscard]] Installation withLabCamera(Installation room);

/// The same camera with another number of pixels: the image is as wide as before, and as high as its shape says.
[[nodiscard]] CalibratedCamera withSize(CalibratedCamera camera, glm::ivec2 size);

} // namespace lumorph
