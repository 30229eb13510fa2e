#include "calibration/lab/boards_lab.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <opencv2/imgproc.hpp>

#include "calibration/patterns/capture_order.h"
#include "core/base/error.h"

namespace lumorph {

namespace {

constexpr double kRim = 0.04;     // metres of paper around a board's points
constexpr int kProposedPoses = 4; // times those that are wanted: not all are seen by everybody

std::string poseName(std::size_t pose) { return "pose_" + std::to_string(pose + 1); }

std::string placeWords(std::size_t pose, std::size_t count) {
    return "board in place " + std::to_string(pose + 1) + " of " + std::to_string(count);
}

NamedDevice namedDevice(const std::string& name, const CalibratedCamera& device) {
    return {name, {device.size.x, device.size.y}};
}

/// The board's points, all in the picture with a little room around.
bool isInPicture(const BoardLab& lab, const CalibratedCamera& device, const glm::dmat4& pose,
                 std::optional<glm::dvec2> (BoardLab::*pixelOfPoint)(const glm::dvec3&) const) {
    const glm::dvec2 room = 0.03 * glm::dvec2(device.size), end = glm::dvec2(device.size - 1) - room;
    return std::ranges::all_of(lab.points(), [&](const glm::dvec3& point) {
        const auto pixel = (lab.*pixelOfPoint)(glm::dvec3(pose * glm::dvec4(point, 1.0)));
        return pixel && pixel->x >= room.x && pixel->y >= room.y && pixel->x <= end.x && pixel->y <= end.y;
    });
}

/// One pose under all patterns of an order: the board lies where it was laid.
ReadPose photographed(BoardLab& lab, const std::string& name, const CalibrationBoard& board, const CaptureOrder& order,
                      const std::string& words, const Progress& progress) {
    std::vector<cv::Mat> images;
    CapturedView view{name, {}};
    for (const PatternImage& pattern : order.images) {
        progress.throwIfCancelled();
        progress.report(static_cast<double>(images.size()) / static_cast<double>(order.images.size()), words);
        lab.show(drawPattern(pattern, order.projector));
        images.push_back(lab.photograph());
        view.files.emplace_back("image_" + std::to_string(images.size()) + ".png");
    }
    return readPose(view, images, board, order);
}

/// A projector and a camera of the lab.
struct LabPair {
    std::size_t projector = 0, camera = 0; ///< of the capture
    CaptureOrder order;
    BoardLab lab;
};

std::vector<glm::dmat4> posesFor(const std::vector<LabPair>& pairs, int wanted) {
    std::vector<glm::dmat4> poses, others;
    for (const glm::dmat4& pose : pairs.front().lab.possiblePoses(kProposedPoses * wanted)) {
        const bool seenByAll = std::ranges::all_of(pairs, [&](const LabPair& pair) {
            return isInPicture(pair.lab, pair.lab.camera(), pose, &BoardLab::cameraPixel) &&
                   isInPicture(pair.lab, pair.lab.projector().camera, pose, &BoardLab::projectorPixel);
        });
        (seenByAll ? poses : others).push_back(pose);
        if (!seenByAll && poses.empty())
            throw InvalidInput("board in the lab", "laid flat it does not fit into what all projectors light",
                               "use a smaller board, or move the projectors nearer together");
        if (static_cast<int>(poses.size()) == wanted) return poses;
    }
    throw InvalidInput("board in the lab", "it does not fit into what all projectors light and the cameras see",
                       "use a smaller board, or move the projectors nearer together");
}

/// Turned left for right: what a camera of this kind sees in a mirror is such a camera's picture without one.
CalibratedCamera turnedCamera(CalibratedCamera camera) {
    camera.principal.x = camera.size.x - 1 - camera.principal.x;
    camera.distortion[3] = -camera.distortion[3]; // p2 leans to the side
    return camera;
}

/// The camera that sees without the mirror, turned left for right, what this one sees in it.
CalibratedCamera behindMirror(const CalibratedCamera& camera, const LabMirror& mirror) {
    const glm::dmat3 outer = glm::outerProduct(mirror.normal, mirror.normal);
    glm::dmat4 reflection(glm::dmat3(1.0) - 2.0 * outer);
    reflection[3] = glm::dvec4(2.0 * mirror.distance * mirror.normal, 1.0);
    CalibratedCamera behind = turnedCamera(camera);
    behind.cameraFromWorld = glm::scale(glm::dmat4(1.0), {-1.0, 1.0, 1.0}) * camera.cameraFromWorld * reflection;
    return behind;
}

} // namespace

BoardsCapture captureBoardsInLab(const Installation& truth, std::uint32_t seed, const BoardsLabOptions& options,
                                 const Progress& progress) {
    const CalibrationBoard board = parseCalibrationBoard(options.board);
    std::vector<NamedDevice> cameras, projectors;
    for (const InstalledCamera& camera : truth.cameras) cameras.push_back(namedDevice(camera.name, camera.camera));
    std::vector<LabPair> pairs;
    for (const InstalledProjector& projector : truth.projectors) {
        if (!projector.enabled) continue;
        const NamedDevice lamp = namedDevice(projector.name, projector.camera);
        for (std::size_t c = 0; c < truth.cameras.size(); ++c) {
            Installation pair = truth;
            pair.projectors = {projector};
            pair.cameras = {truth.cameras[c]};
            const auto number = static_cast<std::uint32_t>(pairs.size());
            pairs.push_back({projectors.size(), c, parsePattern(options.pattern, lamp.size),
                             BoardLab(pair, board, options.pictures, seed + 1000U * number)});
        }
        projectors.push_back(lamp);
    }
    if (pairs.empty())
        throw InvalidInput("boards in the lab", "the room has no projector that is on, or no camera", "add one");
    const std::vector<glm::dmat4> poses = posesFor(pairs, options.poses);
    std::vector<std::string> names;
    for (std::size_t pose = 0; pose < poses.size(); ++pose) names.push_back(poseName(pose));
    BoardsCapture capture = emptyBoardsCapture(options.board, std::move(cameras), std::move(projectors), names);
    const double share = 1.0 / static_cast<double>(poses.size() * pairs.size());
    double done = 0.0;
    for (std::size_t pose = 0; pose < poses.size(); ++pose)
        for (LabPair& pair : pairs) {
            if (pose == 3 && options.push != 0.0 && pair.projector + 1 == capture.projectors.size()) {
                CalibratedCamera pushed = pair.lab.projector().camera;
                pushed.cameraFromWorld = glm::translate(pushed.cameraFromWorld, {options.push, 0.0, 0.0});
                pair.lab.setProjector(pushed);
            }
            pair.lab.lay(poses[pose]);
            const ReadPose read =
                photographed(pair.lab, names[pose], board, pair.order,
                             placeWords(pose, poses.size()) + ", lit by " + capture.projectors[pair.projector].name,
                             progress.part(done, done + share));
            takeLight(capture, pose, pair.camera, pair.projector, read.observations, read.decoded.white.size());
            capture.warnings.insert(capture.warnings.end(), read.warnings.begin(), read.warnings.end());
            done += share;
        }
    return capture;
}

Installation mirrorRoomTruth(Installation room, LabMirror& mirror) {
    // The mirror leans a little over the table's left edge; the camera looks between the board and its image.
    mirror.normal = glm::normalize(glm::dvec3(-1.0, -0.05, 0.04));
    mirror.distance = 0.26;
    CalibratedCamera camera = cameraLookingAt({0.30, 1.15, 0.55}, {-0.24, 0.08, 0.0}, {1440, 900}, 1.0);
    camera.focal = glm::dvec2(1312.0);
    camera.principal = {724.0, 443.0};
    camera.distortion = {-0.1, 0.03, 0.0004, -0.0003, 0.0};
    room.cameras.resize(1);
    room.cameras.front().camera = camera;
    return room;
}

MirrorCapture captureMirrorInLab(const Installation& truth, const LabMirror& mirror, std::uint32_t seed,
                                 const BoardsLabOptions& options, const Progress& progress) {
    if (truth.projectors.empty() || truth.cameras.empty())
        throw InvalidInput("mirror in the lab", "the room has no projector or no camera", "add one");
    const CalibrationBoard board = parseCalibrationBoard(options.board);
    const CalibratedCamera& camera = truth.cameras.front().camera;
    Installation behind = truth;
    behind.cameras.front().camera = behindMirror(camera, mirror);
    BoardLab mirrored(behind, board, options.pictures, seed), direct(truth, board, options.pictures, seed + 1);
    const NamedDevice lamp = namedDevice("", truth.projectors.front().camera);
    const CaptureOrder order = parsePattern(options.pattern, lamp.size);
    MirrorCapture capture{options.board, {camera.size.x, camera.size.y}, lamp.size, {}, {}};
    const auto isBefore = [&](const glm::dmat4& pose) {
        return std::ranges::all_of(mirrored.points(), [&](const glm::dvec3& point) {
            return glm::dot(mirror.normal, glm::dvec3(pose * glm::dvec4(point, 1.0))) < mirror.distance - kRim;
        });
    };
    std::vector<glm::dmat4> poses = mirrored.possiblePoses(kProposedPoses * options.poses);
    std::erase_if(poses, [&](const glm::dmat4& pose) { return !isBefore(pose); });
    if (static_cast<int>(poses.size()) < options.poses)
        throw InvalidInput("board in the lab", "it does not fit between camera, projector and mirror",
                           "use a smaller board");
    poses.resize(static_cast<std::size_t>(options.poses));
    const double share = 1.0 / static_cast<double>(poses.size());
    for (std::size_t pose = 0; pose < poses.size(); ++pose) {
        const double done = static_cast<double>(pose) * share;
        mirrored.lay(poses[pose]);
        const ReadPose read =
            photographed(mirrored, poseName(pose), board, order, placeWords(pose, poses.size()) + ", in the mirror",
                         progress.part(done, done + share));
        MirrorView view = mirrorView(read.observations, camera.size.x);
        if (isInPicture(direct, camera, poses[pose], &BoardLab::cameraPixel)) {
            direct.lay(poses[pose]);
            direct.show(cv::Mat(lamp.size, CV_8U, cv::Scalar(255)));
            const cv::Mat grey = direct.photograph();
            if (findBoard(grey, board)) // seen too slantingly it is none
                view.direct = findDirect(grey, view.name, "direct", board, capture.camera, view.mirrored);
        }
        capture.views.push_back(std::move(view));
        capture.warnings.insert(capture.warnings.end(), read.warnings.begin(), read.warnings.end());
    }
    return capture;
}

} // namespace lumorph
