#include "calibration/doctor/capture_calibration.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include <tbb/parallel_for.h>

#include "calibration/decode/capture_folder.h"
#include "calibration/doctor/alternatives.h"
#include "calibration/doctor/phase_check.h"
#include "calibration/doctor/repeated_poses.h"
#include "calibration/doctor/sequence_check.h"
#include "calibration/doctor/stripe_check.h"
#include "calibration/doctor/uneven_light.h"
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

namespace {

bool isGrayCode(const CaptureOrder& order) {
    return std::ranges::none_of(order.images,
                                [](const PatternImage& image) { return std::holds_alternative<PhaseStep>(image); });
}

/// What the pictures of a pose suffer from and may still be read with: named where something else then fails.
class PoseTroubles {
public:
    void add(std::optional<Finding> finding) {
        if (finding) all_.push_back(std::move(*finding));
    }
    void throwIf(const std::optional<Finding>& finding) const {
        if (finding) throw CaptureRefused(explains(finding->cause) ? all_.front() : *finding);
    }
    [[nodiscard]] bool has(Cause cause) const { return std::ranges::find(all_, cause, &Finding::cause) != all_.end(); }
    std::vector<Finding> take() { return std::move(all_); }

private:
    /// Whether what came first explains a cause that tells little by itself.
    [[nodiscard]] bool explains(Cause cause) const {
        if (all_.empty()) return false;
        const bool hidesAll = has(Cause::noisy) || has(Cause::underexposed) || has(Cause::outOfFocus);
        const bool isVague =
            cause == Cause::boardNotFound || cause == Cause::boardUnlit || cause == Cause::projectorSize;
        const bool isSeenInDetail =
            cause == Cause::rigMoved || cause == Cause::foreignImage || cause == Cause::phaseOrder;
        return isVague || (isSeenInDetail && hidesAll);
    }

    std::vector<Finding> all_;
};

} // namespace

ReadPose readPose(const CapturedView& view, const std::vector<cv::Mat>& images, const CalibrationBoard& board,
                  const CaptureOrder& order) {
    PoseTroubles troubles;
    const auto sequence = checkSequence(view, images, order);
    // Noise averages out, and a Gray code has its edges where pattern and inverse are alike under any curve.
    const bool isBearable =
        sequence &&
        (sequence->cause == Cause::noisy ||
         (isGrayCode(order) && (sequence->cause == Cause::projectorGamma || sequence->cause == Cause::clipped)));
    if (sequence && !isBearable) throw CaptureRefused(*sequence);
    troubles.add(sequence);
    if (const auto stripes = checkStripes(view, images, order)) {
        // What moved between a pattern and its inverse has edges of its own, which look like finer stripes.
        const cv::Mat white = decodeView(images, order).white;
        if (const auto seen = findBoard(white, board))
            troubles.throwIf(checkSteadiness(view, images, order, white, seen->seen));
        troubles.throwIf(stripes);
    }
    if (const auto phases = checkPhases(view, images, order)) {
        // Steps of another brightness look like steps in another order, or like a curve.
        const SteadiedImages steady = steadied(images, order);
        if (!checkPhases(view, steady.images, order)) throw CaptureRefused(driftFinding(view.name, "", steady.change));
        troubles.throwIf(phases);
    }
    DecodedView decoded = decodeView(images, order);
    troubles.add(checkDark(view.name, decoded));
    const std::optional<BoardPoints> found = findBoard(decoded.white, board);
    if (found && board.kind == CalibrationBoard::Kind::chess)
        troubles.add(checkSharpness(view.name, decoded.white, *found));
    const auto bright = checkLight(view.name, decoded);
    if (found)
        if (const auto moved = checkSteadiness(view, images, order, decoded.white, found->seen))
            troubles.throwIf(bright ? bright : moved); // what is cut off has no corners to compare
    if (!troubles.has(Cause::outOfFocus)) troubles.add(checkFocus(view.name, decoded, images, order));
    troubles.throwIf(checkBoardSize(view.name, decoded.white, board, found.has_value()));
    troubles.throwIf(
        checkProjectorSize(view.name, decoded, order.projector, found ? found->seen : std::vector<cv::Point2d>()));
    if (!found) troubles.throwIf(bright);
    if (!found)
        troubles.throwIf(Finding{Cause::boardNotFound, view.name, "", "the board cannot be found under white light",
                                 "check --board, and that all of the board is lit, sharp and in the picture"});
    ReadPose read{{view.name, *found, projectorPointsOn(decoded, found->seen, kPointsWanted)}, std::move(decoded), {}};
    if (read.observations.projector.size() < kFewestPoints && isReadableInverted(images, order, found->seen))
        throw CaptureRefused({Cause::inverseSwapped, view.name, "", "patterns and their inverses are exchanged",
                              "name the images in the order pattern, inverse, or say so in an order file"});
    if (read.observations.projector.size() < kFewestPoints) troubles.throwIf(checkNoise(view.name, read.decoded));
    if (read.observations.projector.size() < kFewestPoints)
        troubles.throwIf(Finding{Cause::boardUnlit, view.name, "",
                                 "the patterns can be read on too little of the board",
                                 "bring the board into the projector's light, expose for longer, darken the room"});
    troubles.add(checkExposure(view.name, read.decoded, found->seen));
    troubles.add(checkBoardKind(view.name, board, *found));
    read.warnings = troubles.take();
    return read;
}

void addWarnings(const std::vector<Finding>& ofPose, std::vector<Finding>& all) {
    for (const Finding& warning : ofPose)
        if (warning.cause != Cause::boardKind || std::ranges::count(all, Cause::boardKind, &Finding::cause) == 0)
            all.push_back(warning);
}

ReadCapture readPoses(const std::vector<CapturedView>& poses, const CalibrationBoard& board, const CaptureOrder& order,
                      const PoseReader& onRead, const Progress& progress, Sight sight) {
    if (poses.empty()) throw InvalidInput("poses", "there is none", "give at least one");
    std::vector<CapturedView> known = poses;
    ReadCapture capture;
    for (CapturedView& pose : known)
        if (auto dropped = dropStrangers(pose, order.images.size())) capture.warnings.push_back(std::move(*dropped));
    if (const auto wrong = checkCounts(known, order)) throw CaptureRefused(*wrong);
    std::vector<FolderPose> read = readAll(known, board, order, onRead, progress, sight);
    requireSameSize(read);
    capture.order = order;
    capture.camera = read.front().size;
    for (FolderPose& view : read) {
        capture.views.push_back(std::move(view.observations));
        addWarnings(view.warnings, capture.warnings);
    }
    return capture;
}

namespace {

/// Sizes of pictures that projectors have, and whole parts of them.
bool isUsualSize(cv::Size size) {
    constexpr std::array<std::array<int, 2>, 36> kUsual = {
        {{640, 360},   {640, 400},   {640, 480},   {800, 480},   {800, 600},   {848, 480},   {854, 480},   {608, 684},
         {684, 608},   {912, 1140},  {1140, 912},  {960, 540},   {1024, 600},  {1024, 768},  {1152, 864},  {1280, 720},
         {1280, 768},  {1280, 800},  {1280, 960},  {1280, 1024}, {1360, 768},  {1366, 768},  {1400, 1050}, {1440, 900},
         {1600, 900},  {1600, 1200}, {1680, 1050}, {1824, 1140}, {1920, 1080}, {1920, 1200}, {2048, 1080}, {2048, 1536},
         {2560, 1440}, {2560, 1600}, {3840, 2160}, {4096, 2160}}};
    return std::ranges::any_of(kUsual, [size](const auto& usual) {
        for (const int parts : {1, 2, 3, 4}) // as tests and previews have them
            if (parts * size.width == usual[0] && parts * size.height == usual[1]) return true;
        return false;
    });
}

std::string shortNumber(double value) {
    char text[48];
    std::snprintf(text, sizeof(text), "%.3g", value);
    return text;
}

/// Sizes and lengths that may be right and are seldom so: what is said of them nothing in the pictures contradicts.
void warnOfUnlikely(const ReadCapture& capture, cv::Size projector, ProcamCalibration& result) {
    double column = 0.0;
    double row = 0.0;
    double square = std::numeric_limits<double>::infinity();
    for (const ViewObservations& view : capture.views) {
        for (const ProjectorPoint& point : view.projector) {
            column = std::max(column, point.projector.x);
            row = std::max(row, point.projector.y);
        }
        for (std::size_t i = 0; i + 1 < view.corners.board.size(); ++i)
            square = std::min(square, cv::norm(view.corners.board[i] - view.corners.board[i + 1]));
    }
    if (!isUsualSize(projector))
        result.warnings.push_back(
            {Cause::projectorSize, "", "",
             std::to_string(projector.width) + " x " + std::to_string(projector.height) +
                 " is no usual size of a projector; what was decoded on the boards ends at column " +
                 std::to_string(std::lround(column)) + " and row " + std::to_string(std::lround(row)) +
                 ", which does not tell",
             "check the size that the patterns were made for"});
    constexpr double kSmallest = 1.0, kLargest = 1000.0, kNearest = 1.0; // mm, as boards are named
    if (square < kSmallest || square > kLargest)
        result.warnings.push_back({Cause::unlikelyLength, "", "",
                                   "points of the board are " + shortNumber(square) + " mm apart",
                                   "give the board's lengths in millimetres: all others follow them"});
    const PoseVector& rig = result.projectorFromCamera;
    const double apart = std::hypot(rig[3], rig[4], rig[5]);
    if (apart < kNearest)
        result.warnings.push_back({Cause::unlikelyLength, "", "",
                                   "the projector would stand " + shortNumber(apart) + " mm from the camera",
                                   "check the board's lengths, in millimetres"});
}

/// Whether phases, which tell shares of width and height, fit with the two exchanged.
bool fitsExchanged(const ReadCapture& capture, cv::Size projector) {
    constexpr double kFits = 0.5; // pixels
    if (projector.width == projector.height) return false;
    const double byWidth = static_cast<double>(projector.height) / projector.width;
    std::vector<ViewObservations> views = capture.views;
    for (ViewObservations& view : views)
        for (ProjectorPoint& point : view.projector)
            point.projector = {(point.projector.x + 0.5) * byWidth - 0.5, (point.projector.y + 0.5) / byWidth - 0.5};
    SolveOptions quick;
    quick.judge = false;
    try {
        return calibrateProcam(views, capture.camera, {projector.height, projector.width}, quick).projector.rms < kFits;
    } catch (const CaptureRefused&) {
        return false;
    }
}

/// What single poses suffer from explains what no model fits.
void throwTrouble(const ReadCapture& capture, const Finding& finding) {
    constexpr std::array kDustbins = {Cause::modelDoesNotFit, Cause::strangeLens, Cause::projectorSize,
                                      Cause::boardWarped,     Cause::keystone,    Cause::squareSize};
    constexpr std::array kTroubles = {Cause::outOfFocus, Cause::noisy, Cause::exposureDrifts, Cause::projectorGamma};
    if (std::ranges::find(kDustbins, finding.cause) == kDustbins.end()) return;
    for (const Finding& warning : capture.warnings)
        if (std::ranges::find(kTroubles, warning.cause) != kTroubles.end() ||
            (warning.cause == Cause::clipped && !isGrayCode(capture.order))) // stripes bear it, phases do not
            throw CaptureRefused(warning);
}

} // namespace

ProcamCalibration calibrateCapture(const ReadCapture& capture, cv::Size projector, const SolveOptions& options,
                                   const Progress& progress) {
    const bool hasPhases = !isGrayCode(capture.order);
    if (hasPhases)
        if (const auto turned = checkTurned(capture.views)) throw CaptureRefused(*turned);
    if (const auto mirrored = checkMirrored(capture.views)) throw CaptureRefused(*mirrored);
    const std::vector<std::size_t> first = firstLike(capture.views);
    ReadCapture distinct = capture;
    distinct.views.clear();
    std::vector<Finding> repeated;
    for (std::size_t v = 0; v < first.size(); ++v) {
        if (first[v] == v)
            distinct.views.push_back(capture.views[v]);
        else
            repeated.push_back({Cause::repeatedPoses, capture.views[v].name, "",
                                "shows the same view as " + capture.views[first[v]].name + ": both count once",
                                "move and tilt the board between poses"});
    }
    constexpr std::size_t kFewestViews = 3;
    if (!repeated.empty() && distinct.views.size() < kFewestViews) throw CaptureRefused(repeated.front());
    CaptureOrder order = capture.order;
    order.projector = projector;
    ProcamCalibration result;
    try {
        result = solveUnexplained(distinct, projector, options, progress.part(0.0, 0.8));
        explain(distinct.views, order, result, progress.part(0.8, 1.0));
    } catch (const CaptureRefused& refused) {
        throwTrouble(capture, refused.finding());
        // What one pose explains is no matter of the projector's size.
        const Cause cause = refused.finding().cause;
        const bool isOfPose = cause == Cause::cameraMoved || cause == Cause::cameraRefocused;
        if (hasPhases && !isOfPose && fitsExchanged(distinct, projector))
            throw CaptureRefused({Cause::widthHeightSwapped, "", "",
                                  "the poses fit a projector of " + std::to_string(projector.height) + " x " +
                                      std::to_string(projector.width) + ", not of " + std::to_string(projector.width) +
                                      " x " + std::to_string(projector.height),
                                  "exchange width and height"});
        throw;
    }
    repeatFor(capture.views, first, result);
    result.warnings.insert(result.warnings.end(), repeated.begin(), repeated.end());
    result.warnings.insert(result.warnings.end(), capture.warnings.begin(), capture.warnings.end());
    warnOfUnlikely(capture, projector, result);
    if (hasPhases && isUpsideDown(capture.views))
        result.warnings.push_back({Cause::phaseOrder, "", "",
                                   "the projector would hang upside down beside the camera: it does, or the steps of "
                                   "all phases stand in another order",
                                   "nothing where it hangs so; else say the order of the steps in an order file"});
    return result;
}

ProcamCalibration calibrateProcamFolder(const std::filesystem::path& folder, const CalibrationBoard& board,
                                        const CaptureOrder& order, const SolveOptions& options,
                                        const Progress& progress) {
    const CaptureListing listing = listCapture(folder);
    ReadCapture capture = readPoses(listing.views, board, order, {}, progress.part(0.0, kReading));
    capture.warnings.insert(capture.warnings.begin(), listing.passedOver.begin(), listing.passedOver.end());
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
