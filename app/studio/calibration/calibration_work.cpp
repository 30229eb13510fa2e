#include "app/studio/calibration/calibration_work.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "core/base/error.h"

namespace lumorph::studio {
namespace {

constexpr int kSearchWidth = 640; // pixels; the live picture's board is found in a smaller one

} // namespace

OrFinding<ReadCapture> readFolder(const CalibrationSetup& setup, const std::vector<std::string>& without,
                                  const PoseTaker& take, const Progress& progress) {
    CaptureListing listing = listCapture(setup.folder);
    std::vector<CapturedView>& views = listing.views;
    std::erase_if(views, [&](const CapturedView& view) { return std::ranges::count(without, view.name) > 0; });
    if (views.empty() && !without.empty()) return ReadCapture{{}, {}, listing.passedOver};
    try {
        const CaptureOrder order = orderOf(setup);
        ReadCapture capture = readPoses(
            views, setup.board, order,
            [&](std::size_t index, const ReadPose& read) { take(poseOf(views[index].name, read, setup.projector)); },
            progress);
        capture.warnings.insert(capture.warnings.end(), listing.passedOver.begin(), listing.passedOver.end());
        return capture;
    } catch (const CaptureRefused& refused) {
        const Finding& finding = refused.finding();
        if (!finding.view.empty()) take(poseRefusedBy(finding, pictureOfFinding(views, finding)));
        return finding;
    }
}

OrFinding<std::shared_ptr<const CalibrationResult>> solveCapture(const SolveTask& task, const Progress& progress) {
    try {
        CalibrationSetup said = task.setup;
        said.projector = task.projector;
        ReadCapture capture = task.capture;
        capture.order = said.order.empty() ? orderOf(said) : CaptureOrder{task.projector, {}}; // its file may be gone
        auto result = std::make_shared<CalibrationResult>();
        result->solved = calibrateCapture(capture, task.projector, {}, progress.part(0.0, 0.8));
        if (task.knowsSize)
            std::erase_if(result->solved.warnings,
                          [](const Finding& one) { return one.cause == Cause::projectorSize; });
        result->residuals = residualsOf(capture.views, result->solved);
        result->heldOutMillimetres = heldOutMillimetresOf(result->solved);
        result->date = utcDate();
        result->setup = task.setup;
        result->isSimulated =
            isSimulatedWay(task.setup) || (task.setup.way == CaptureWay::folder && isLabCapture(task.setup.folder));
        result->plan =
            planOf(result->solved, task.flat, task.setup.board, *task.room, task.placement, progress.part(0.8, 0.9));
        result->next = suggestNextPose(result->solved, task.setup.board, {}, progress.part(0.9, 1.0));
        return std::shared_ptr<const CalibrationResult>(std::move(result));
    } catch (const CaptureRefused& refused) {
        return refused.finding();
    }
}

CalibrationPose poseOf(const std::string& name, const ReadPose& read, cv::Size projector) {
    CalibrationPose pose;
    pose.name = name;
    pose.pictures = std::make_shared<const PosePictures>(picturesOf(read.decoded, projector));
    pose.seen = std::make_shared<const ViewObservations>(read.observations);
    pose.warnings = read.warnings;
    return pose;
}

cv::Mat brightestOf(const std::vector<cv::Mat>& images) {
    cv::Mat brightest;
    double most = -1.0;
    for (const cv::Mat& image : images)
        if (const double mean = cv::mean(image)[0]; mean > most) most = mean, brightest = image;
    return brightest;
}

CalibrationPose poseRefusedBy(const Finding& finding, const cv::Mat& picture) {
    CalibrationPose pose;
    pose.name = finding.view;
    pose.refusal = finding;
    if (!picture.empty()) {
        PosePictures pictures;
        pictures.camera = {picture.cols, picture.rows};
        pictures.white = pictureOfMat(picture);
        pose.pictures = std::make_shared<const PosePictures>(std::move(pictures));
    }
    return pose;
}

cv::Mat pictureOfFinding(const std::vector<CapturedView>& views, const Finding& finding) {
    for (const CapturedView& view : views) {
        if (view.name != finding.view || view.files.empty()) continue;
        // By custom white is the one before the last.
        std::filesystem::path file = view.files.size() > 1 ? view.files[view.files.size() - 2] : view.files.back();
        for (const auto& one : view.files)
            if (one.filename() == finding.file) file = one;
        try {
            return readGrey(file, view.name);
        } catch (const std::exception&) { // the image itself may be what is broken
        }
    }
    return {};
}

std::optional<ErrorPlan> planOf(const ProcamCalibration& solved, const std::optional<BoardPoints>& flat,
                                const CalibrationBoard& board, const Installation& room, const RoomPlacement& placement,
                                const Progress& progress) {
    if (!flat) return std::nullopt;
    try {
        return errorPlanOf(solved, *flat, board, room, placement, progress);
    } catch (const InvalidInput&) { // told when it is to be used
        return std::nullopt;
    }
}

std::vector<PoseResiduals> residualsOf(const std::vector<ViewObservations>& views, const ProcamCalibration& solved) {
    constexpr std::size_t kMost = 400; // points of a view that are drawn
    std::vector<PoseResiduals> all;
    for (std::size_t i = 0; i < views.size() && i < solved.state.cameraFromBoard.size(); ++i) {
        PoseResiduals one{views[i].name, {}, {}};
        const auto corners = cameraErrors(views[i], solved.state, solved.state.cameraFromBoard[i]);
        for (std::size_t k = 0; k < corners.size(); ++k) one.camera.push_back({views[i].corners.seen[k], corners[k]});
        const auto points = projectorErrors(views[i], solved.state, solved.state.cameraFromBoard[i]);
        const std::size_t every = points.size() / kMost + 1;
        for (std::size_t k = 0; k < points.size(); k += every)
            one.projector.push_back({views[i].projector[k].projector, points[k]});
        all.push_back(std::move(one));
    }
    return all;
}

std::vector<QPointF> liveCorners(const cv::Mat& picture, const CalibrationBoard& board) {
    const double scale = std::min(1.0, static_cast<double>(kSearchWidth) / picture.cols);
    cv::Mat small;
    cv::resize(picture, small, {}, scale, scale, cv::INTER_AREA);
    std::vector<QPointF> corners;
    if (const auto found = findBoard(small, board))
        for (const cv::Point2d& point : found->seen)
            corners.emplace_back((point.x + 0.5) / scale - 0.5, (point.y + 0.5) / scale - 0.5);
    return corners;
}

} // namespace lumorph::studio
