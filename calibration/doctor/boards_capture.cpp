#include "calibration/doctor/boards_capture.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "calibration/doctor/view_check.h"
#include "core/base/error.h"

namespace lumorph {

namespace {

/// Where the images of one projector's light, by one camera, lie; pose by pose.
struct LightSeen {
    std::vector<std::size_t> poses;
    std::vector<CapturedView> views;
};

/// What lies in a folder POSE/CAMERA/PROJECTOR/images.
struct RoomFolder {
    std::vector<std::string> poses, cameras;
    std::map<std::pair<std::string, std::size_t>, LightSeen> lights; ///< by camera's name and projector
};

std::size_t projectorNamed(const std::filesystem::path& folder, const std::vector<NamedOrder>& projectors) {
    const std::string name = folder.filename().string();
    const auto found = std::ranges::find(projectors, name, &NamedOrder::name);
    if (found == projectors.end())
        throw DataError(folder.string(), "no projector has this name",
                        "give --projector " + name + "=WIDTHxHEIGHT, or rename the folder");
    return static_cast<std::size_t>(found - projectors.begin());
}

RoomFolder listRoom(const std::filesystem::path& folder, const std::vector<NamedOrder>& projectors) {
    RoomFolder room;
    for (const std::filesystem::path& pose : foldersIn(folder)) {
        for (const std::filesystem::path& camera : foldersIn(pose)) {
            const std::string name = camera.filename().string();
            if (std::ranges::find(room.cameras, name) == room.cameras.end()) room.cameras.push_back(name);
            for (const std::filesystem::path& light : foldersIn(camera)) {
                LightSeen& seen = room.lights[{name, projectorNamed(light, projectors)}];
                const std::string view = pose.filename().string() + "/" + name + "/" + light.filename().string();
                seen.poses.push_back(room.poses.size());
                seen.views.push_back({view, imagesIn(light)});
            }
        }
        room.poses.push_back(pose.filename().string());
    }
    if (room.lights.empty())
        throw DataError(folder.string(), "holds no folders POSE/CAMERA/PROJECTOR with images",
                        "give one folder a pose, in it one a camera, in that one a projector whose light it saw");
    std::ranges::sort(room.cameras, isNamedBefore);
    return room;
}

/// A board stays where it is while one projector after the other lights it.
void requireStill(const BoardPoints& before, const BoardPoints& now, const std::string& view) {
    constexpr double kStill = 1.0; // pixels
    std::vector<double> ways;
    for (const cv::Point2d& seen : now.seen) {
        double nearest = HUGE_VAL;
        for (const cv::Point2d& other : before.seen)
            nearest = std::min(nearest, std::hypot(seen.x - other.x, seen.y - other.y));
        ways.push_back(nearest);
    }
    const auto middle = ways.begin() + static_cast<std::ptrdiff_t>(ways.size() / 2);
    std::ranges::nth_element(ways, middle);
    if (*middle > kStill)
        throw CaptureRefused({Cause::rigMoved, view, "",
                              "the board or the camera moved since another projector lit this pose",
                              "capture this pose again, with all projectors while nothing moves"});
}

bool isDirect(const std::filesystem::path& file) { return file.stem() == "direct"; }

/// The patterns in the mirror, and by which files the poses are seen directly.
struct MirrorFolder {
    std::vector<CapturedView> patterns;
    std::vector<std::filesystem::path> direct; ///< empty where there is none
};

MirrorFolder listMirror(const std::filesystem::path& folder) {
    MirrorFolder all{viewsIn(folder), {}};
    for (CapturedView& view : all.patterns) {
        const auto found = std::ranges::find_if(view.files, isDirect);
        all.direct.push_back(found == view.files.end() ? std::filesystem::path() : *found);
        std::erase_if(view.files, isDirect);
        if (view.files.empty())
            throw CaptureRefused({Cause::missingImage, view.name, "", "it has no images of the patterns",
                                  "capture this pose again, or remove its folder"});
    }
    return all;
}

} // namespace

void requireMirrored(const std::vector<ViewObservations>& turned) {
    std::optional<Finding> wrong = checkMirrored(turned);
    if (!wrong) return;
    if (wrong->cause == Cause::mirrored) {
        wrong->why = "the board that is found is not seen in a mirror";
        wrong->remedy = "let only the mirror show the board while patterns are shown; without a mirror, use procam";
    }
    throw CaptureRefused(*wrong);
}

void takeLight(BoardsCapture& capture, std::size_t view, std::size_t camera, std::size_t projector,
               const ViewObservations& seen, cv::Size pictures) {
    cv::Size& size = capture.cameras[camera].size;
    if (!size.empty() && size != pictures)
        throw CaptureRefused({Cause::imageSize, seen.name, "",
                              "its images have another size than this camera's under another projector",
                              "capture all with one camera setting"});
    size = pictures;
    BoardPoints& corners = capture.views[view].corners[camera];
    if (corners.seen.empty())
        corners = seen.corners;
    else
        requireStill(corners, seen.corners, seen.name);
    capture.views[view].light[camera][projector] = seen.projector;
}

BoardsCapture readBoardsCapture(const std::filesystem::path& folder, const std::string& board,
                                const std::vector<NamedOrder>& projectors, const Progress& progress) {
    const CalibrationBoard printed = parseCalibrationBoard(board);
    const RoomFolder listed = listRoom(folder, projectors);
    std::vector<NamedDevice> cameras, lamps;
    for (const std::string& name : listed.cameras) cameras.push_back({name, {}});
    for (const NamedOrder& projector : projectors) lamps.push_back({projector.name, projector.order.projector});
    BoardsCapture room = emptyBoardsCapture(board, std::move(cameras), std::move(lamps), listed.poses);
    const auto count = static_cast<double>(listed.lights.size());
    double done = 0.0;
    for (const auto& [who, seen] : listed.lights) {
        const auto camera =
            static_cast<std::size_t>(std::ranges::find(listed.cameras, who.first) - listed.cameras.begin());
        const ReadCapture capture = readPoses(seen.views, printed, projectors[who.second].order, {},
                                              progress.part(done / count, (done + 1.0) / count));
        if (const auto mirrored = checkMirrored(capture.views)) throw CaptureRefused(*mirrored);
        for (std::size_t i = 0; i < capture.views.size(); ++i)
            takeLight(room, seen.poses[i], camera, who.second, capture.views[i], capture.camera);
        room.warnings.insert(room.warnings.end(), capture.warnings.begin(), capture.warnings.end());
        done += 1.0;
    }
    for (const NamedDevice& camera : room.cameras)
        if (camera.size.empty())
            throw CaptureRefused({Cause::disconnected, "", "", "camera " + camera.name + " has no images",
                                  "remove its folders, or put what it saw of each projector's light into them"});
    return room;
}

MirrorView mirrorView(const ViewObservations& turned, int pictureWidth) {
    MirrorView view{turned.name, turned.corners, turned.projector, {}};
    for (cv::Point2d& pixel : view.mirrored.seen) pixel.x = pictureWidth - 1 - pixel.x;
    for (ProjectorPoint& point : view.light) point.camera.x = pictureWidth - 1 - point.camera.x;
    return view;
}

BoardPoints findDirect(const cv::Mat& grey, const std::string& view, const std::string& file,
                       const CalibrationBoard& board, cv::Size camera, const BoardPoints& mirrored) {
    const auto refuse = [&](Cause cause, const char* why, const char* remedy) {
        throw CaptureRefused({cause, view, file, why, remedy});
    };
    if (grey.size() != camera)
        refuse(Cause::imageSize, "has another size than the other images", "take it with the camera's setting of them");
    const std::optional<BoardPoints> found = findBoard(grey, board);
    if (!found)
        refuse(Cause::boardNotFound, "the board cannot be found past the mirror",
               "leave the picture out, or take it again with the mirror covered and all of the board in sight");
    const auto outlineOf = [](const std::vector<cv::Point2d>& points) {
        return cv::boundingRect(std::vector<cv::Point2f>(points.begin(), points.end()));
    };
    const cv::Rect there = outlineOf(mirrored.seen);
    const cv::Rect both = there & outlineOf(found->seen);
    if (2 * both.area() > there.area())
        refuse(Cause::mirrored, "shows the board in the mirror again", "cover the mirror for this picture");
    return *found;
}

MirrorCapture readMirrorCapture(const std::filesystem::path& folder, const std::string& board,
                                const CaptureOrder& order, const Progress& progress) {
    const CalibrationBoard printed = parseCalibrationBoard(board);
    const MirrorFolder listed = listMirror(folder);
    const ReadCapture capture = readPoses(listed.patterns, printed, order, {}, progress, Sight::mirrored);
    requireMirrored(capture.views);
    MirrorCapture all{board, capture.camera, order.projector, {}, capture.warnings};
    for (std::size_t i = 0; i < capture.views.size(); ++i) {
        MirrorView view = mirrorView(capture.views[i], capture.camera.width);
        if (const std::filesystem::path& file = listed.direct[i]; !file.empty())
            view.direct = findDirect(readGrey(file, view.name), view.name, file.filename().string(), printed,
                                     capture.camera, view.mirrored);
        all.views.push_back(std::move(view));
    }
    return all;
}

} // namespace lumorph
