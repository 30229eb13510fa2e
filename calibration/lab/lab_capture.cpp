#include "calibration/lab/lab_capture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <random>
#include <utility>

#include <glm/gtc/matrix_transform.hpp>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>

#include "calibration/lab/lab_folder.h"
#include "calibration/lab/lab_light.h"
#include "calibration/lab/lab_truth.h"
#include "calibration/patterns/gray_code.h"
#include "core/base/error.h"

namespace lumorph {

namespace {

using Json = nlohmann::json;

constexpr int kMostPoses = 100;

constexpr std::array kLabFaults = {Cause::lateFrame,         Cause::missingImage,   Cause::doubledImage,
                                   Cause::blackWhiteSwapped, Cause::inverseSwapped, Cause::mirrored,
                                   Cause::rigMoved,          Cause::projectorSize,  Cause::widthHeightSwapped,
                                   Cause::frontalViews,      Cause::clipped,        Cause::keystone,
                                   Cause::boardWarped,       Cause::squareSize,     Cause::strangeLens,
                                   Cause::projectorGamma,    Cause::cameraRefocused};

std::string numbered(const char* word, int number, std::size_t count) {
    char text[32];
    std::snprintf(text, sizeof(text), count > 100 ? "%s_%03d" : "%s_%02d", word, number);
    return text;
}

std::string fixed(double value, int digits = 2) {
    char text[48];
    std::snprintf(text, sizeof(text), "%.*f", digits, value);
    return text;
}

std::string sizeWords(cv::Size size) { return std::to_string(size.width) + " x " + std::to_string(size.height); }

/// The homography that moves the corners of a picture to other places.
cv::Matx33d quadWarp(cv::Size size, const std::array<cv::Point2f, 4>& moved) {
    const float right = static_cast<float>(size.width - 1);
    const float bottom = static_cast<float>(size.height - 1);
    const std::array<cv::Point2f, 4> corners = {cv::Point2f(0, 0), {right, 0}, {right, bottom}, {0, bottom}};
    return cv::getPerspectiveTransform(corners.data(), moved.data());
}

/// Another size of a projector whose patterns are as many.
cv::Size otherSize(cv::Size size, std::mt19937& dice) {
    const auto smaller = [&dice](int length) {
        const int least = (1 << (grayCodeBits(length) - 1)) + 1;
        const double share = std::uniform_real_distribution<double>(0.72, 0.88)(dice);
        return std::clamp(static_cast<int>(share * length), least, length);
    };
    const cv::Size other =
        dice() % 2 == 0 ? cv::Size(smaller(size.width), size.height) : cv::Size(size.width, smaller(size.height));
    return other != size ? other : cv::Size(smaller(size.width), smaller(size.height));
}

} // namespace

std::span<const Cause> labFaults() { return kLabFaults; }

struct LabCapturer::Data {
    LabCapture capture;
    std::mt19937 dice;
    CalibrationBoard board;
    cv::Size panel;         ///< the projector's picture, as it is and as it is said to be
    cv::Size drawn;         ///< what the patterns are made for
    CaptureOrder order;     ///< what is said
    CaptureOrder projected; ///< what is shown
    std::optional<BoardLab> lab;
    std::vector<glm::dmat4> poses;
    std::vector<glm::dmat4> cameraFromBoard; ///< of poses that were taken, metres
    std::vector<LabFault> faults;
    int faultyPose = 0, faultyImage = 0;
    double amount = 0.0; ///< of what the fault does, in its own unit

    explicit Data(LabCapture what) : capture(std::move(what)), dice(capture.seed * 31U + 17U) {}

    [[nodiscard]] bool has(Cause cause) const { return capture.fault == cause; }
    [[nodiscard]] double between(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(dice);
    }
    [[nodiscard]] double either(double low, double high) { return (dice() % 2 == 0 ? 1.0 : -1.0) * between(low, high); }
    [[nodiscard]] std::string viewName(int pose) const { return numbered("pose", pose, poses.size()); }
    [[nodiscard]] std::string fileName(int image) const {
        return numbered("image", image, order.images.size()) + ".png";
    }

    void checkRequest() const;
    void planFault();
    void planPoses();
    void tell(const std::string& what, int pose = -1, int image = -1);
    [[nodiscard]] cv::Mat pattern(int image) const;
    [[nodiscard]] int projectedAt(int pose, int image) const;
    void moveCamera();
    void refocus();
};

void LabCapturer::Data::checkRequest() const {
    if (capture.poses < 1 || capture.poses > kMostPoses)
        throw InvalidInput("poses", std::to_string(capture.poses) + " is not 1 to " + std::to_string(kMostPoses),
                           "six are good");
    if (!capture.fault) return;
    const std::string key(keyOf(*capture.fault));
    if (std::ranges::find(kLabFaults, *capture.fault) == kLabFaults.end())
        throw InvalidInput("fault " + key, "the lab cannot make it", "choose one of those that --help lists");
    const bool gray = capture.pattern == "graycode";
    if (gray && has(Cause::projectorGamma))
        throw InvalidInput("fault " + key, "these patterns cannot have it",
                           "use a phase pattern, such as phase:16x3+1x3");
    if (!gray && (has(Cause::blackWhiteSwapped) || has(Cause::inverseSwapped)))
        throw InvalidInput("fault " + key, "these patterns cannot have it", "use --pattern graycode");
    const bool several = has(Cause::cameraRefocused) || has(Cause::mirrored);
    if (several && capture.poses < 2) throw InvalidInput("fault " + key, "one pose cannot have it", "take six poses");
}

void LabCapturer::Data::tell(const std::string& what, int pose, int image) {
    faults.push_back({*capture.fault, pose < 0 ? "" : viewName(pose), image < 0 ? "" : fileName(image), what});
}

/// What the fault changes before the first picture is taken.
void LabCapturer::Data::planFault() {
    if (!capture.fault) return;
    BoardLabOptions& options = capture.options;
    const double width = capture.room.cameras.front().camera.size.x;
    switch (*capture.fault) {
    case Cause::clipped:
        options.whiteLevel = between(700.0, 1200.0);
        break;
    case Cause::keystone: {
        const auto corner = [&](double x, double y) {
            return cv::Point2f(static_cast<float>((x + (0.5 - x) * between(0.04, 0.2)) * (panel.width - 1)),
                               static_cast<float>((y + (0.5 - y) * between(0.04, 0.2)) * (panel.height - 1)));
        };
        options.warp = quadWarp(panel, {corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)});
        break;
    }
    case Cause::boardWarped: {
        // Two to four per cent of half the board's diagonal.
        const double half = 0.5 * board.spacing * std::hypot(board.columns, board.rows);
        options.shape.across = half * either(0.02, 0.04);
        options.shape.twist = half * either(0.0, 0.02);
        options.shape.down = half * either(0.01, 0.03);
        break;
    }
    case Cause::squareSize:
        options.shape.stretch.y = 1.0 + either(0.015, 0.03);
        break;
    case Cause::strangeLens:
        amount = between(2.0, 3.5);
        if (dice() % 2 == 0)
            options.projectorWave = amount;
        else
            options.cameraWave = amount * width / 1280.0;
        break;
    case Cause::projectorGamma:
        if (capture.room.projectors.front().gamma == 1.0) capture.room.projectors.front().gamma = 2.2;
        break;
    case Cause::cameraRefocused:
        amount = either(0.015, 0.03);
        break;
    case Cause::rigMoved:
        amount = either(4.0, 12.0) * width / 1280.0;
        break;
    case Cause::projectorSize:
        drawn = otherSize(panel, dice);
        break;
    case Cause::widthHeightSwapped:
        drawn = {panel.height, panel.width};
        break;
    default:
        break;
    }
}

void LabCapturer::Data::planPoses() {
    poses = lab->proposePoses(has(Cause::frontalViews) ? 1 : capture.poses);
    const glm::dmat4 flat = poses.front();
    const glm::dvec3 axes[] = {{1.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, {0.0, 1.0, 0.0}};
    while (static_cast<int>(poses.size()) < capture.poses) { // only with boards that all look up
        glm::dmat4 pose =
            glm::translate(glm::dmat4(1.0), {between(-0.02, 0.02), between(0.0, 0.1), between(-0.02, 0.02)});
        for (int axis = 0; axis < 3; ++axis)
            pose = glm::rotate(pose, glm::radians(between(-1.0, 1.0) * (axis == 2 ? 20.0 : 2.0)), axes[axis]);
        poses.push_back(pose * flat);
    }
    const auto count = static_cast<int>(order.images.size());
    const auto pick = [this](int low, int high) { return std::uniform_int_distribution<int>(low, high)(dice); };
    faultyPose = pick(has(Cause::cameraRefocused) ? 1 : 0, capture.poses - 1);
    faultyImage = pick(1, count - 3);
    if (has(Cause::rigMoved)) faultyImage = pick(count / 4, 3 * count / 4);
}

cv::Mat LabCapturer::Data::pattern(int image) const {
    const PatternImage& shown = projected.images[static_cast<std::size_t>(image)];
    cv::Mat picture = drawPattern(shown, drawn);
    if (drawn != panel) cv::resize(picture, picture, panel, 0.0, 0.0, cv::INTER_NEAREST);
    if (!std::holds_alternative<PhaseStep>(shown) || has(Cause::projectorGamma)) return picture;
    // Who knows the projector's response shows phases so that their light is a cosine.
    const double gamma = capture.room.projectors.front().gamma;
    cv::Mat1b straight(1, 256);
    for (int value = 0; value < 256; ++value) {
        const double light = value / 255.0;
        straight(0, value) =
            cv::saturate_cast<uchar>(255.0 * (gamma == 0.0 ? srgbOfLight(light) : std::pow(light, 1.0 / gamma)));
    }
    cv::LUT(picture, straight, picture);
    return picture;
}

/// Which of the patterns an image shows.
int LabCapturer::Data::projectedAt(int pose, int image) const {
    const auto count = static_cast<int>(order.images.size());
    if (has(Cause::inverseSwapped) && image + 2 < count) return image ^ 1;
    if (pose != faultyPose) return image;
    if (has(Cause::lateFrame) && image >= faultyImage) return image - 1;
    if (has(Cause::blackWhiteSwapped) && image + 2 >= count) return 2 * count - 3 - image;
    return image;
}

/// Turns the camera a little, as when somebody hits it.
void LabCapturer::Data::moveCamera() {
    CalibratedCamera camera = lab->camera();
    camera.cameraFromWorld =
        glm::rotate(glm::dmat4(1.0), amount / camera.focal.x, glm::dvec3(0.3, 0.95, 0.0)) * camera.cameraFromWorld;
    lab->setCamera(camera);
}

void LabCapturer::Data::refocus() {
    CalibratedCamera camera = lab->camera();
    camera.focal *= 1.0 + amount;
    lab->setCamera(camera);
}

LabCapturer::LabCapturer(LabCapture capture) : data_(std::make_unique<Data>(std::move(capture))) {
    Data& d = *data_;
    if (d.capture.room.projectors.empty())
        throw InvalidInput("virtual lab", "its installation has no projector", "add one, or use the default lab");
    if (d.capture.room.cameras.empty())
        d.capture.room.cameras.push_back(
            {"Camera beside the projector", "", defaultLabCamera(d.capture.room.projectors.front().camera), {}, {}});
    d.board = parseCalibrationBoard(d.capture.board);
    const glm::ivec2 size = d.capture.room.projectors.front().camera.size;
    d.panel = d.drawn = {size.x, size.y};
    d.order = parsePattern(d.capture.pattern, d.panel);
    d.checkRequest();
    d.planFault();
    d.projected = parsePattern(d.capture.pattern, d.drawn);
    if (d.projected.images.size() != d.order.images.size())
        throw InvalidInput("fault " + std::string(keyOf(*d.capture.fault)), "patterns of another size are not as many",
                           "choose another fault or projector");
    d.lab.emplace(d.capture.room, d.board, d.capture.options, d.capture.seed);
    d.planPoses();
}

LabCapturer::~LabCapturer() = default;

std::vector<LabShot> LabCapturer::takeNext(const Progress& progress) {
    Data& d = *data_;
    const auto pose = static_cast<int>(d.cameraFromBoard.size());
    if (pose >= d.capture.poses)
        throw InvalidInput("capture in the lab", "all its poses have been taken", "ask for more poses");
    const auto count = static_cast<int>(d.order.images.size());
    const bool faulty = pose == d.faultyPose;
    if (d.has(Cause::cameraRefocused) && faulty) {
        d.refocus();
        d.tell("the focal length is " + fixed(100.0 * d.amount) + " % larger from this pose on", pose);
    }
    d.lab->lay(d.poses[static_cast<std::size_t>(pose)]);
    d.cameraFromBoard.push_back(d.lab->camera().cameraFromWorld * d.poses[static_cast<std::size_t>(pose)]);
    std::vector<LabShot> shots;
    for (int image = 0; image < count; ++image) {
        progress.throwIfCancelled();
        progress.report(static_cast<double>(image) / count, "photographing");
        if (d.has(Cause::rigMoved) && faulty && image == d.faultyImage) {
            d.moveCamera();
            d.tell("the camera turned by " + fixed(d.amount) + " pixels", pose, image);
        }
        const bool here = faulty && image == d.faultyImage;
        if (d.has(Cause::missingImage) && here) {
            d.tell("the image is missing", pose, image);
            continue;
        }
        d.lab->show(d.pattern(d.projectedAt(pose, image)));
        cv::Mat grey = d.lab->photograph();
        if (d.has(Cause::doubledImage) && here) {
            grey = shots.back().grey.clone();
            d.tell("the image is the one before", pose, image);
        }
        if (d.has(Cause::mirrored) && faulty) cv::flip(grey, grey, 1);
        if (d.has(Cause::lateFrame) && here) d.tell("from here on each image shows the pattern before", pose, image);
        shots.push_back({d.viewName(pose), d.fileName(image), grey});
    }
    if (d.has(Cause::mirrored) && faulty) d.tell("the images are mirrored", pose);
    if (d.has(Cause::blackWhiteSwapped) && faulty) d.tell("white and black are exchanged", pose, count - 2);
    if (pose > 0 || !d.capture.fault) return shots;
    switch (*d.capture.fault) { // what is wrong from the first pose on
    case Cause::inverseSwapped:
        d.tell("patterns and inverses are exchanged");
        break;
    case Cause::projectorSize:
    case Cause::widthHeightSwapped:
        d.tell("the patterns were made for " + sizeWords(d.drawn) + " and stretched to " + sizeWords(d.panel));
        break;
    case Cause::frontalViews:
        d.tell("the board lies nearly the same way in all poses");
        break;
    case Cause::clipped:
        d.tell("white paper would be grey " + fixed(d.capture.options.whiteLevel, 0));
        break;
    case Cause::keystone:
        d.tell("the projector warps its picture");
        break;
    case Cause::boardWarped:
        d.tell("the board is bent");
        break;
    case Cause::squareSize:
        d.tell("the squares are not square");
        break;
    case Cause::strangeLens:
        d.tell(std::string("the ") + (d.capture.options.projectorWave > 0.0 ? "projector" : "camera") +
               "'s lens bends its picture in waves");
        break;
    case Cause::projectorGamma:
        d.tell("the projector's gamma was not undone");
        break;
    default:
        break;
    }
    return shots;
}

const LabCapture& LabCapturer::capture() const noexcept { return data_->capture; }
const BoardLab& LabCapturer::lab() const noexcept { return *data_->lab; }
const std::vector<glm::dmat4>& LabCapturer::poses() const noexcept { return data_->poses; }
const std::vector<LabFault>& LabCapturer::faults() const noexcept { return data_->faults; }

std::string LabCapturer::truthText() const {
    const Data& d = *data_;
    const BoardLabOptions& options = d.capture.options;
    const double unit = options.metresPerUnit;
    const CalibratedCamera& camera = d.capture.room.cameras.front().camera;
    const CalibratedCamera& projector = d.lab->projector().camera;
    const glm::dmat4 rig = projector.cameraFromWorld * glm::inverse(camera.cameraFromWorld);
    Json poses = Json::array();
    for (std::size_t i = 0; i < d.cameraFromBoard.size(); ++i)
        poses.push_back({{"name", d.viewName(static_cast<int>(i))},
                         {"R", rotationJson(d.cameraFromBoard[i])},
                         {"T", shiftJson(d.cameraFromBoard[i], unit)},
                         {"worldFromBoard", jsonOf(d.poses[i])}});
    Json points = Json::array();
    for (const glm::dvec3& point : d.lab->points()) points.push_back({point.x / unit, point.y / unit, point.z / unit});
    Json faults = Json::array();
    for (const LabFault& fault : d.faults) {
        Json entry = {{"key", keyOf(fault.cause)}, {"what", fault.what}};
        if (!fault.view.empty()) entry["view"] = fault.view;
        if (!fault.file.empty()) entry["file"] = fault.file;
        faults.push_back(entry);
    }
    Json warp = Json::array();
    for (int row = 0; row < 3; ++row)
        warp.push_back({options.warp(row, 0), options.warp(row, 1), options.warp(row, 2)});
    const Json truth = {{"lumorph", "lab capture"},
                        {"seed", d.capture.seed},
                        {"pattern", d.capture.pattern},
                        {"camera", jsonOf(camera)},
                        {"projector", jsonOf(projector)},
                        {"R", rotationJson(rig)},
                        {"T", shiftJson(rig, unit)},
                        {"board",
                         {{"name", d.capture.board},
                          {"metresPerUnit", unit},
                          {"points", points},
                          {"bend", {options.shape.across, options.shape.twist, options.shape.down}},
                          {"stretch", {options.shape.stretch.x, options.shape.stretch.y}}}},
                        {"poses", poses},
                        {"patternSize", {d.drawn.width, d.drawn.height}},
                        {"projectorWarp", warp},
                        {"wave", {{"camera", options.cameraWave}, {"projector", options.projectorWave}}},
                        {"pictures",
                         {{"whiteLevel", options.whiteLevel},
                          {"ambient", options.ambient},
                          {"vignetting", options.vignetting},
                          {"blur", options.blur},
                          {"noise", options.noise},
                          {"shotNoise", options.shotNoise},
                          {"tremble", options.tremble},
                          {"gamma", d.lab->projector().gamma}}},
                        {"faults", faults}};
    return truth.dump(1) + "\n";
}

void writeLabCapture(LabCapturer& capturer, const std::filesystem::path& folder, const Progress& progress) {
    LabFolder making(folder);
    const int count = capturer.capture().poses;
    for (int pose = 0; pose < count; ++pose)
        making.write(capturer.takeNext(progress.part(static_cast<double>(pose) / count, (pose + 0.8) / count)),
                     progress);
    making.write("truth.json", capturer.truthText());
    making.finish();
}

} // namespace lumorph
