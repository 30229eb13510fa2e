#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <vector>

#include <opencv2/calib3d.hpp>

#include "calibration/decode/capture_folder.h"
#include "calibration/solve/procam_calibration.h"
#include "tests/bench/bench_groups.h"
#include "tests/bench/bench_timing.h"
#include "tests/support/procam_observations.h"

namespace lumorph::bench {

namespace {

constexpr const char* kRow = "calibration-held-out";
constexpr std::size_t kNeighbours = 24; // decoded points around a corner

struct Capture {
    std::string name;
    std::vector<ViewObservations> views;
    cv::Size camera, projector;
    double readSeconds = 0.0;
};

Capture realCapture(const std::filesystem::path& folder) {
    Capture capture{"procam_chess, poses 0 1 2 4", {}, {}, {1024, 768}};
    const CaptureOrder order = parsePattern("graycode", capture.projector);
    const CalibrationBoard board = parseCalibrationBoard("chess:9x7:75");
    capture.readSeconds = secondsOf([&] {
        for (const CapturedView& captured : viewsIn(folder)) {
            const DecodedView decoded = decodeView(readImages(captured), order);
            const auto found = findBoard(decoded.white, board);
            if (!found) throw DataError(captured.name, "the board is not found", "fetch the data again");
            capture.camera = decoded.white.size();
            capture.views.push_back({captured.name, *found, projectorPointsOn(decoded, found->seen, 3000)});
        }
    });
    return capture;
}

Capture simulatedCapture() {
    const test::ProcamSetup setup = test::randomSetup(1, 4);
    return {"simulated: ../shared/data/procam_chess is not there", test::observe(setup, {0.1, 0.1}, 1),
            cv::Size(setup.camera.size.x, setup.camera.size.y),
            cv::Size(setup.projector.size.x, setup.projector.size.y)};
}

/// A pinhole with five terms, as OpenCV has it.
struct CvLens {
    cv::Mat matrix, distortion;
};

/// Projector and camera as OpenCV's users solve them.
struct CvRig {
    CvLens camera, projector;
    cv::Mat turn, way;
};

/// The usual way's only projector corners: a homography of the decoded points around each corner. For comparison alone;
/// Lumorph itself makes none.
std::vector<cv::Point2f> usualProjectorCorners(const ViewObservations& view) {
    std::vector<cv::Point2f> corners;
    std::vector<std::size_t> order(view.projector.size());
    for (const cv::Point2d& corner : view.corners.seen) {
        std::iota(order.begin(), order.end(), 0);
        const std::size_t count = std::min(kNeighbours, order.size());
        std::ranges::partial_sort(order, order.begin() + static_cast<std::ptrdiff_t>(count), {}, [&](std::size_t i) {
            const cv::Point2d off = view.projector[i].camera - corner;
            return off.dot(off);
        });
        std::vector<cv::Point2d> from, to;
        for (std::size_t i = 0; i < count; ++i) {
            from.push_back(view.projector[order[i]].camera);
            to.push_back(view.projector[order[i]].projector);
        }
        std::vector<cv::Point2d> there;
        cv::perspectiveTransform(std::vector{corner}, there, cv::findHomography(from, to));
        corners.emplace_back(there.front());
    }
    return corners;
}

/// `calibrateCamera` twice, then `stereoCalibrate` with those flags.
CvRig usualWay(const Capture& capture, int without, int flags) {
    std::vector<std::vector<cv::Point3f>> board;
    std::vector<std::vector<cv::Point2f>> seen, lit;
    for (std::size_t v = 0; v < capture.views.size(); ++v) {
        if (static_cast<int>(v) == without) continue;
        const BoardPoints& corners = capture.views[v].corners;
        board.emplace_back(corners.board.begin(), corners.board.end());
        seen.emplace_back(corners.seen.begin(), corners.seen.end());
        lit.push_back(usualProjectorCorners(capture.views[v]));
    }
    CvRig rig;
    std::vector<cv::Mat> turns, ways;
    cv::calibrateCamera(board, seen, capture.camera, rig.camera.matrix, rig.camera.distortion, turns, ways);
    cv::calibrateCamera(board, lit, capture.projector, rig.projector.matrix, rig.projector.distortion, turns, ways);
    cv::Mat essential, fundamental;
    cv::stereoCalibrate(board, seen, lit, rig.camera.matrix, rig.camera.distortion, rig.projector.matrix,
                        rig.projector.distortion, capture.camera, rig.turn, rig.way, essential, fundamental, flags);
    return rig;
}

/// Root mean square error of a view's decoded points: its pose from the camera alone, reprojected into the projector.
double transferError(const ViewObservations& view, const CvRig& rig) {
    cv::Mat axis, way;
    cv::solvePnP(view.corners.board, view.corners.seen, rig.camera.matrix, rig.camera.distortion, axis, way);
    cv::Matx33d turn;
    cv::Rodrigues(axis, turn);
    const cv::Vec3d shift(way.at<double>(0), way.at<double>(1), way.at<double>(2));
    const cv::Vec3d normal(turn(0, 2), turn(1, 2), turn(2, 2));
    std::vector<cv::Point2d> pixels, directions, lit;
    for (const ProjectorPoint& point : view.projector) pixels.push_back(point.camera);
    cv::undistortPoints(pixels, directions, rig.camera.matrix, rig.camera.distortion);
    std::vector<cv::Point3d> points;
    for (const cv::Point2d& direction : directions) {
        const cv::Vec3d ray(direction.x, direction.y, 1.0);
        points.emplace_back(ray * (normal.dot(shift) / normal.dot(ray)));
    }
    cv::Mat rigAxis;
    cv::Rodrigues(rig.turn, rigAxis);
    cv::projectPoints(points, rigAxis, rig.way, rig.projector.matrix, rig.projector.distortion, lit);
    double sum = 0.0;
    for (std::size_t i = 0; i < lit.size(); ++i) {
        const cv::Point2d off = lit[i] - view.projector[i].projector;
        sum += off.dot(off);
    }
    return std::sqrt(sum / static_cast<double>(lit.size()));
}

/// Each view held out once; root of the mean square over views.
double usualHeldOut(const Capture& capture, int flags, std::string& note) {
    double sum = 0.0;
    for (std::size_t v = 0; v < capture.views.size(); ++v) {
        const double error = transferError(capture.views[v], usualWay(capture, static_cast<int>(v), flags));
        note += " " + fixed(error, 3);
        sum += error * error / static_cast<double>(capture.views.size());
    }
    return std::sqrt(sum);
}

} // namespace

void benchCalibration(const Filter& filter, Report& report) {
    const std::string free = std::string(kRow) + "-free-intrinsics";
    const std::string time = "calibration-time";
    if (!filter.wants(kRow) && !filter.wants(free) && !filter.wants(time)) return;
    const std::filesystem::path folder = std::filesystem::path(LUMORPH_SHARED_DIR) / "data/procam_chess";
    const Capture capture = std::filesystem::exists(folder) ? realCapture(folder) : simulatedCapture();
    ProcamCalibration found;
    const double solving =
        secondsOf([&] { found = calibrateProcam(capture.views, capture.camera, capture.projector); });
    double ours = 0.0;
    std::string ourNote = "Lumorph, pixels by view:";
    for (const ViewQuality& view : found.views) {
        const double error = view.heldOut.value_or(0.0);
        ourNote += " " + fixed(error, 3);
        ours += error * error / static_cast<double>(found.views.size());
    }
    ours = std::sqrt(ours);
    std::string fixedNote = "intrinsics fixed in stereoCalibrate:";
    std::string freeNote = "intrinsics free in it:";
    const double usual = usualHeldOut(capture, cv::CALIB_FIX_INTRINSIC, fixedNote);
    const double loose = usualHeldOut(capture, cv::CALIB_USE_INTRINSIC_GUESS, freeNote);
    const std::string what = "error of each view left out of the solution, against OpenCV's on the same corners";
    if (filter.wants(kRow))
        report.add({kRow, what, ours / usual, "x", atMost(0.7), {}, {capture.name, ourNote, fixedNote}});
    if (filter.wants(free))
        report.add({free, what, ours / loose, "x", atMost(1.0), {}, {capture.name, ourNote, freeNote}});
    if (filter.wants(time))
        report.add({time,
                    "images read and decoded, and all of it solved and judged",
                    capture.readSeconds + solving,
                    "s",
                    atMost(20.0),
                    {},
                    {capture.name, "solved and judged in " + fixed(solving, 2) + " s"}});
}

} // namespace lumorph::bench
