#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "calibration/decode/calibration_board.h"
#include "calibration/doctor/capture_calibration.h"
#include "calibration/doctor/device_capture.h"
#include "calibration/solve/installation_calibration.h"
#include "calibration/solve/mirror_calibration.h"

namespace lumorph {

/// What any number of cameras saw of a board under any number of projectors, pose by pose.
struct BoardsCapture {
    std::string board; ///< as `parseCalibrationBoard` reads it
    std::vector<NamedDevice> cameras, projectors;
    std::vector<InstallationView> views;
    std::vector<Finding> warnings;
};

/// An empty one, with a place for everything in each of its views. Here, so that what reads recordings needs nothing of
/// what reads pictures.
[[nodiscard]] inline BoardsCapture emptyBoardsCapture(std::string board, std::vector<NamedDevice> cameras,
                                                      std::vector<NamedDevice> projectors,
                                                      const std::vector<std::string>& views) {
    BoardsCapture capture{std::move(board), std::move(cameras), std::move(projectors), {}, {}};
    for (const std::string& name : views) {
        InstallationView& view = capture.views.emplace_back();
        view.name = name;
        view.corners.resize(capture.cameras.size());
        view.light.assign(capture.cameras.size(), std::vector<std::vector<ProjectorPoint>>(capture.projectors.size()));
    }
    return capture;
}

/// Adds what a camera saw of a view's board under one projector, with the size of the camera's pictures. Throws
/// CaptureRefused where the board moved since another projector lit it, or where pictures have another size than those
/// before.
void takeLight(BoardsCapture& capture, std::size_t view, std::size_t camera, std::size_t projector,
               const ViewObservations& seen, cv::Size pictures);

/// Reads a folder POSE/CAMERA/PROJECTOR/images. Throws DataError where there is no such folder or a projector is not
/// named, CaptureRefused for images that cannot be trusted, Cancelled.
[[nodiscard]] BoardsCapture readBoardsCapture(const std::filesystem::path& folder, const std::string& board,
                                              const std::vector<NamedOrder>& projectors, const Progress& progress = {});

/// Boards whose light a camera saw by way of a mirror.
struct MirrorCapture {
    std::string board; ///< as `parseCalibrationBoard` reads it
    cv::Size camera, projector;
    std::vector<MirrorView> views;
    std::vector<Finding> warnings;
};

/// A pose of which the pictures were turned left for right before they were read, in pixels of the pictures as they
/// were taken.
[[nodiscard]] MirrorView mirrorView(const ViewObservations& turned, int pictureWidth);

/// The board past the mirror, in a picture that was taken with the mirror covered. Throws CaptureRefused where it is
/// not found, where the picture has another size, or where it is where it was seen in the mirror.
[[nodiscard]] BoardPoints findDirect(const cv::Mat& grey, const std::string& view, const std::string& file,
                                     const CalibrationBoard& board, cv::Size camera, const BoardPoints& mirrored);

/// Of poses whose pictures were turned left for right. Throws CaptureRefused where boards were found past the mirror
/// instead: then they are not mirrored, once the picture is.
void requireMirrored(const std::vector<ViewObservations>& turned);

/// Reads a folder with a folder of images a pose; a picture `direct` in one shows the board past the mirror. Throws as
/// `readBoardsCapture`.
[[nodiscard]] MirrorCapture readMirrorCapture(const std::filesystem::path& folder, const std::string& board,
                                              const CaptureOrder& order, const Progress& progress = {});

} // namespace lumorph
