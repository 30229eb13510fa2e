#include "calibration/doctor/capture_calibration.h"

#include <algorithm>
#include <atomic>
#include <iterator>
#include <optional>
#include <utility>

#include <tbb/parallel_for.h>

#include "calibration/decode/capture_folder.h"
#include "calibration/doctor/alternatives.h"
#include "calibration/doctor/sequence_check.h"
#include "calibration/doctor/stripe_check.h"
#include "calibration/doctor/view_check.h"

namespace lumorph {

namespace {

constexpr int kPointsWanted = 3000; // squares on a board
constexpr std::size_t kFewestPoints = 60;
constexpr double kReading = 0.6; // of the whole time

/// One pose of a folder.
struct FolderPose {
    ViewObservations observations;
    cv::Size size;
    std::optional<Finding> refusal;
    std::vector<Finding> warnings;
};

/// Whether the patterns can be read where each is taken for its inverse.
bool isReadableInverted(const std::vector<cv::Mat>& images, CaptureOrder order, const std::vector<cv::Point2d>& board) {
    for (PatternImage& image : order.images)
        if (auto* gray = std::get_if<GrayBit>(&image)) gray->inverse = !gray->inverse;
    return projectorPointsOn(decodeView(images, order), board, kPointsWanted).size() > kFewestPoints;
}

std::vector<FolderPose> readAll(const std::vector<CapturedView>& views, const CalibrationBoard& board,
                                const CaptureOrder& order, const PoseReader& onRead, const Progress& progress,
                                Sight sight) {
    std::vector<FolderPose> all(views.size());
    std::atomic<int> done = 0;
    std::atomic<std::size_t> refused = views.size(); // the first pose that is; those after it need not be read
    // Two at a time: each holds all its images.
    tbb::task_arena arena(2);
    arena.execute([&] {
        tbb::parallel_for(std::size_t{0}, views.size(), [&](std::size_t i) {
            if (progress.cancelled() || i > refused) return;
            try {
                std::vector<cv::Mat> images = readImages(views[i]);
                if (sight == Sight::mirrored)
                    for (cv::Mat& image : images) cv::flip(image, image, 1);
                ReadPose pose = readPose(views[i], images, board, order);
                if (onRead) onRead(i, pose);
                all[i].size = pose.decoded.white.size();
                all[i].observations = std::move(pose.observations);
                all[i].warnings = std::move(pose.warnings);
            } catch (const CaptureRefused& why) {
                all[i].refusal = why.finding();
                std::size_t before = refused;
                while (i < before && !refused.compare_exchange_weak(before, i)) {
                }
            }
            progress.report(++done / static_cast<double>(views.size()), "reading poses");
        });
    });
    progress.throwIfCancelled();
    for (const FolderPose& view : all) // the first of them, whichever was read first
        if (view.refusal) throw CaptureRefused(*view.refusal);
    return all;
}

void requireSameSize(const std::vector<FolderPose>& views) {
    for (const FolderPose& view : views)
        if (view.size != views.front().size)
            throw CaptureRefused({Cause::imageSize, view.observations.name, "",
                                  "its images have another size than those of " + views.front().observations.name,
                                  "capture all poses with one camera setting"});
}

/// One pose that does not agree with the others: something moved between the devices, or within the pose.
void requireAgreement(const ProcamCalibration& result) {
    constexpr double kFar = 4.0;   // times the others
    constexpr double kLeast = 0.7; // pixels
    for (const ViewQuality& view : result.views) {
        double others = 0.0;
        for (const ViewQuality& other : result.views)
            if (other.name != view.name) others = std::max(others, other.projectorRms);
        if (view.projectorRms > kLeast && view.projectorRms > kFar * others)
            throw CaptureRefused({Cause::rigMoved, view.name, "",
                                  "this pose does not agree with the others: camera or projector moved",
                                  "leave the pose out, or capture all again with both fixed"});
    }
}

/// Names the cause of errors that are too large, or that another cause explains better than lenses do.
void explain(const std::vector<ViewObservations>& views, const CaptureOrder& order, ProcamCalibration& result,
             const Progress& progress) {
    const std::optional<Explanation> explanation = explanationOf(views, result, order, progress);
    if (explanation && (explanation->refused || misfitOf(result))) throw CaptureRefused(explanation->finding);
    requireAgreement(result);
    if (const std::optional<Finding> misfit = misfitOf(result)) throw CaptureRefused(*misfit);
    if (explanation) result.warnings.push_back(explanation->finding);
}

/// Solves a capture whose errors are explained later. Boards that seem to lie all the same way are looked at again.
ProcamCalibration solveUnexplained(const ReadCapture& capture, cv::Size projector, SolveOptions options,
                                   const Progress& progress) {
    options.judgesFit = false;
    try {
        return calibrateProcam(capture.views, capture.camera, projector, options, progress);
    } catch (const CaptureRefused& refused) {
        if (refused.finding().cause != Cause::frontalViews) throw;
        if (const auto cause = causeInCamera(capture.views, capture.camera, progress)) throw CaptureRefused(*cause);
        throw;
    }
}

} // namespace

ReadPose readPose(const CapturedView& view, const std::vector<cv::Mat>& images, const CalibrationBoard& board,
                  const CaptureOrder& order) {
    const auto throwIf = [](const std::optional<Finding>& finding) {
        if (finding) throw CaptureRefused(*finding);
    };
    throwIf(checkSequence(view, images, order));
    throwIf(checkStripes(view, images, order));
    DecodedView decoded = decodeView(images, order);
    const std::optional<BoardPoints> found = findBoard(decoded.white, board);
    throwIf(checkProjectorSize(view.name, decoded, order.projector, found ? found->seen : std::vector<cv::Point2d>()));
    if (!found) throwIf(checkLight(view.name, decoded));
    if (!found)
        throw CaptureRefused({Cause::boardNotFound, view.name, "", "the board cannot be found under white light",
                              "check --board, and that all of the board is lit, sharp and in the picture"});
    throwIf(checkSteadiness(view, images, order, found->seen));
    ReadPose read{{view.name, *found, projectorPointsOn(decoded, found->seen, kPointsWanted)}, std::move(decoded), {}};
    if (const auto exposure = checkExposure(view.name, read.decoded, found->seen)) read.warnings.push_back(*exposure);
    if (const auto kind = checkBoardKind(view.name, board, *found)) read.warnings.push_back(*kind);
    if (read.observations.projector.size() < kFewestPoints && isReadableInverted(images, order, found->seen))
        throw CaptureRefused({Cause::inverseSwapped, view.name, "", "patterns and their inverses are exchanged",
                              "name the images in the order pattern, inverse, or say so in an order file"});
    if (read.observations.projector.size() < kFewestPoints)
        throw CaptureRefused({Cause::boardUnlit, view.name, "", "the patterns can be read on too little of the board",
                              "bring the board into the projector's light, expose for longer, darken the room"});
    return read;
}

ReadCapture readPoses(const std::vector<CapturedView>& poses, const CalibrationBoard& board, const CaptureOrder& order,
                      const PoseReader& onRead, const Progress& progress, Sight sight) {
    if (poses.empty()) throw InvalidInput("poses", "there is none", "give at least one");
    if (const auto wrong = checkCounts(poses, order)) throw CaptureRefused(*wrong);
    std::vector<FolderPose> read = readAll(poses, board, order, onRead, progress, sight);
    requireSameSize(read);
    ReadCapture capture;
    capture.order = order;
    capture.camera = read.front().size;
    for (FolderPose& view : read) {
        capture.views.push_back(std::move(view.observations));
        for (const Finding& warning : view.warnings) { // the same board in all poses is named once
            const bool isRepeated = warning.cause == Cause::boardKind &&
                                    std::ranges::count(capture.warnings, Cause::boardKind, &Finding::cause) > 0;
            if (!isRepeated) capture.warnings.push_back(warning);
        }
    }
    return capture;
}

ProcamCalibration calibrateCapture(const ReadCapture& capture, cv::Size projector, const SolveOptions& options,
                                   const Progress& progress) {
    if (const auto mirrored = checkMirrored(capture.views)) throw CaptureRefused(*mirrored);
    ProcamCalibration result = solveUnexplained(capture, projector, options, progress.part(0.0, 0.8));
    CaptureOrder order = capture.order;
    order.projector = projector;
    explain(capture.views, order, result, progress.part(0.8, 1.0));
    result.warnings.insert(result.warnings.end(), capture.warnings.begin(), capture.warnings.end());
    return result;
}

ProcamCalibration calibrateProcamFolder(const std::filesystem::path& folder, const CalibrationBoard& board,
                                        const CaptureOrder& order, const SolveOptions& options,
                                        const Progress& progress) {
    const ReadCapture capture = readPoses(viewsIn(folder), board, order, {}, progress.part(0.0, kReading));
    return calibrateCapture(capture, order.projector, options, progress.part(kReading, 1.0));
}

ProcamCalibration calibrateIntrinsicsFolder(const std::filesystem::path& folder, const CalibrationBoard& board,
                                            const SolveOptions& options, const Progress& progress) {
    const std::vector<std::filesystem::path> files = imagesIn(folder);
    std::vector<std::optional<BoardPoints>> found(files.size());
    std::vector<cv::Size> sizes(files.size());
    std::atomic<int> done = 0;
    tbb::parallel_for(std::size_t{0}, files.size(), [&](std::size_t i) {
        if (progress.cancelled()) return;
        const cv::Mat grey = readGrey(files[i], "");
        sizes[i] = grey.size();
        found[i] = findBoard(grey, board);
        progress.report(kReading * ++done / static_cast<double>(files.size()), "looking for the board");
    });
    progress.throwIfCancelled();
    std::vector<ViewObservations> views;
    std::vector<Finding> warnings;
    for (std::size_t i = 0; i < files.size(); ++i) {
        const std::string name = files[i].filename().string();
        if (sizes[i] != sizes.front())
            throw CaptureRefused({Cause::imageSize, "", name, "has another size than the pictures before it",
                                  "give pictures of one camera with one setting"});
        if (found[i]) {
            if (const auto kind = checkBoardKind("", board, *found[i]); kind && views.empty())
                warnings.push_back(*kind);
            views.push_back({name, *found[i], {}});
        } else {
            warnings.push_back({Cause::boardNotFound, "", name,
                                "the board cannot be found, so the picture was left out",
                                "check that all of the board is sharp and in the picture"});
        }
    }
    if (views.empty())
        throw CaptureRefused({Cause::boardNotFound, "", "", "the board is found in none of the pictures",
                              "check --board: its kind and how many corners it has"});
    ProcamCalibration result = calibrateIntrinsics(views, sizes.front(), options, progress.part(kReading, 1.0));
    result.warnings.insert(result.warnings.end(), warnings.begin(), warnings.end());
    return result;
}

} // namespace lumorph
