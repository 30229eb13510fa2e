#include "calibration/report/calibration_record.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include <nlohmann/json.hpp>
#include <opencv2/calib3d.hpp>

#include "calibration/decode/calibration_board.h"
#include "core/base/error.h"
#include "core/base/json_check.h"
#include "core/scene/json_section.h"

namespace lumorph {

namespace {

using nlohmann::json;

constexpr const char* kOther = "choose another file, or export it again";
constexpr JsonLimits kLimits{.bytes = std::size_t{16} << 20, .depth = 16, .values = 200'000};
constexpr double kLargest = 1e9;       // of any number
constexpr double kLargestFocal = 1e7;  // pixels
constexpr int kLargestPixels = 65'536; // a side
constexpr double kLargestTerm = 1e6;   // of distortion
constexpr std::size_t kMostViews = 10'000;
constexpr std::size_t kMostTexts = 1'000;
constexpr double kDegrees = 57.29577951308232; // a radian
constexpr std::array<const char*, 9> kSigmaKeys{"fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3"};
constexpr std::array kDistortionOrder{kK1, kK2, kP1, kP2, kK3}; // as OpenCV has them

json listOf(const Lens& lens) {
    json list = json::array();
    for (const LensParameter term : kDistortionOrder) list.push_back(lens[term]);
    return list;
}

template <typename Figures> bool isAnySaid(const Figures& figures) {
    return std::ranges::any_of(figures, [](double figure) { return figure != 0.0; });
}

json jsonOf(const CalibratedDevice& device) {
    const Lens& lens = device.lens;
    const double fy = lens[kFocalLength] * lens[kAspect];
    json sigma = json::object();
    const double fySigma =
        std::hypot(device.sigma[kFocalLength] * lens[kAspect], lens[kFocalLength] * device.sigma[kAspect]);
    for (std::size_t i = 0; i < kSigmaKeys.size(); ++i) sigma[kSigmaKeys[i]] = i == kAspect ? fySigma : device.sigma[i];
    json document = {
        {"K", {{lens[kFocalLength], 0.0, lens[kPrincipalX]}, {0.0, fy, lens[kPrincipalY]}, {0.0, 0.0, 1.0}}},
        {"distortion", listOf(lens)},
        {"model", device.model}};
    // What nobody said is left out, so that whoever reads it takes no 0 for exact.
    if (!device.size.empty()) document["size"] = {device.size.width, device.size.height};
    if (device.rms != 0.0) document["rms"] = device.rms;
    if (isAnySaid(device.sigma)) document["sigma"] = sigma;
    return document;
}

json rotationJson(const PoseVector& pose) {
    const glm::dmat3 rotation = Rigid::exp(pose).rotation;
    json rows = json::array();
    for (int row = 0; row < 3; ++row) rows.push_back({rotation[0][row], rotation[1][row], rotation[2][row]});
    return rows;
}

json orNull(const std::optional<double>& number) { return number ? json(*number) : json(); }

json viewJson(const ProcamCalibration& result, std::size_t index) {
    const ViewQuality& view = result.views[index];
    json document = {{"name", view.name},
                     {"cameraRms", view.cameraRms},
                     {"projectorRms", view.projectorRms},
                     {"heldOutTransfer", orNull(view.heldOut)}};
    if (index >= result.state.cameraFromBoard.size()) return document;
    const PoseVector& pose = result.state.cameraFromBoard[index];
    if (std::ranges::all_of(pose, [](double number) { return std::isfinite(number); }))
        document["cameraFromBoard"] = pose;
    return document;
}

bool allFinite(const json& value) {
    if (value.is_number_float()) return std::isfinite(value.get<double>());
    return std::ranges::all_of(value.is_structured() ? value : json::array(),
                               [](const json& inner) { return allFinite(inner); });
}

/// A list of three lists of three numbers, as OpenCV has matrices.
cv::Matx33d matrixIn(const JsonSection& section, json& object, const std::string& key) {
    const auto found = object.find(key);
    if (found == object.end()) section.refuse(key, "is missing", "write it as three rows of three numbers");
    cv::Matx33d matrix;
    bool isMatrix = found->is_array() && found->size() == 3;
    for (int row = 0; isMatrix && row < 3; ++row) {
        const json& line = (*found)[static_cast<std::size_t>(row)];
        isMatrix = line.is_array() && line.size() == 3;
        for (int column = 0; isMatrix && column < 3; ++column) {
            const json& number = line[static_cast<std::size_t>(column)];
            isMatrix = number.is_number() && std::abs(number.get<double>()) <= kLargest;
            if (isMatrix) matrix(row, column) = number.get<double>();
        }
    }
    if (!isMatrix) section.refuse(key, "is not three rows of three numbers up to 1e9", "correct it");
    return matrix;
}

std::optional<double> optionalNumber(JsonSection& section, json& object, const std::string& key) {
    if (const auto found = object.find(key); found == object.end() || found->is_null()) return std::nullopt;
    double number = 0.0;
    section.number(key, number, -kLargest, kLargest);
    return number;
}

/// The object under a key that must be there.
template <typename Read> void requiredSection(JsonSection& root, json& document, const char* key, const Read& read) {
    if (!root.has(key)) root.refuse(key, "is missing", kOther);
    root.section(key, [&](const JsonSection& section) { read(document[key], section); });
}

template <std::size_t Count>
bool readNumbers(JsonSection& section, const std::string& key, std::array<double, Count>& numbers) {
    std::vector<double> list;
    if (!section.has(key)) return false;
    section.numbers(key, list, -kLargest, kLargest, Count, true);
    std::ranges::copy(list, numbers.begin());
    return true;
}

void readDevice(json& object, JsonSection section, CalibratedDevice& device, bool mayLackSize = false) {
    const cv::Matx33d matrix = matrixIn(section, object, "K");
    if (const std::string problem = setIntrinsics(device, matrix); !problem.empty())
        section.refuse("K", problem, "write it as OpenCV does, in pixels");
    std::vector<double> terms;
    section.numbers("distortion", terms, -kLargestTerm, kLargestTerm, 14);
    if (const std::string problem = setDistortion(device, terms); !problem.empty())
        section.refuse("distortion", problem, "calibrate with k1, k2, p1, p2, k3 alone");
    std::array<double, 2> size{};
    const bool hasSize = readNumbers(section, "size", size);
    if (!hasSize && !mayLackSize) section.refuse("size", "is missing", "write [width, height] in pixels");
    for (const double side : size)
        if (hasSize && !(side >= 1.0 && side <= kLargestPixels && side == std::floor(side)))
            section.refuse("size", "is no width and height in pixels", "write [width, height]");
    device.size = {static_cast<int>(size[0]), static_cast<int>(size[1])};
    section.number("rms", device.rms, 0.0, kLargest);
    section.text("model", device.model);
    section.section("sigma", [&](JsonSection sigma) {
        for (std::size_t i = 0; i < kSigmaKeys.size(); ++i) sigma.number(kSigmaKeys[i], device.sigma[i], 0.0, kLargest);
    });
    // Of the aspect, from those of both focal lengths.
    const double fy = device.sigma[kAspect];
    const double part = device.sigma[kFocalLength] * device.lens[kAspect];
    device.sigma[kAspect] = std::sqrt(std::max(0.0, fy * fy - part * part)) / device.lens[kFocalLength];
    for (std::size_t i = 0; i < device.free.size(); ++i) device.free[i] = device.sigma[i] > 0.0;
}

void readView(json& object, JsonSection section, ProcamCalibration& result) {
    ViewQuality& view = result.views.emplace_back();
    section.text("name", view.name);
    view.heldOut = optionalNumber(section, object, "heldOutTransfer");
    section.number("cameraRms", view.cameraRms, 0.0, kLargest);
    section.number("projectorRms", view.projectorRms, 0.0, kLargest);
    PoseVector pose;
    if (!readNumbers(section, "cameraFromBoard", pose)) pose.fill(std::numeric_limits<double>::quiet_NaN());
    result.state.cameraFromBoard.push_back(pose);
}

/// Warnings with a cause that this version does not know are left out.
void readWarning(JsonSection section, ProcamCalibration& result) {
    std::string key;
    Finding finding;
    section.text("cause", key);
    section.text("view", finding.view);
    section.text("file", finding.file);
    section.text("why", finding.why);
    section.text("remedy", finding.remedy);
    const std::optional<Cause> cause = causeOf(key);
    if (!cause) return;
    finding.cause = *cause;
    result.warnings.push_back(finding);
}

void readSource(json& document, JsonSection& root, CalibrationSource& source) {
    root.text("date", source.date);
    root.text("board", source.board);
    root.text("pattern", source.pattern);
    root.number("metresPerUnit", source.metresPerUnit, 1e-9, 1e6);
    root.flag("simulated", source.isSimulated);
    const auto inputs = document.find("inputs");
    if (inputs == document.end()) return;
    if (!inputs->is_array() || inputs->size() > kMostTexts ||
        !std::ranges::all_of(*inputs, [](const json& input) { return input.is_string(); }))
        root.refuse("inputs", "is no list of texts", "remove it");
    source.inputs = inputs->get<std::vector<std::string>>();
}

void readRig(json& document, JsonSection& root, ProcamCalibration& result) {
    const cv::Matx33d rotation = matrixIn(root, document, "R");
    std::array<double, 3> shift{};
    if (!readNumbers(root, "T", shift)) root.refuse("T", "is missing", "write three numbers");
    if (const std::string problem = setRig(result, rotation, {shift[0], shift[1], shift[2]}); !problem.empty())
        root.refuse("R", problem, "write the rotation that maps the camera's frame to the projector's");
    root.section("sigma", [&](JsonSection sigma) {
        std::array<double, 3> turn{}, place{};
        readNumbers(sigma, "rotationDegrees", turn);
        readNumbers(sigma, "T", place);
        for (std::size_t i = 0; i < 3; ++i) {
            result.projectorFromCameraSigma[i] = turn[i] / kDegrees;
            result.projectorFromCameraSigma[i + 3] = place[i];
        }
    });
}

} // namespace

std::string setIntrinsics(CalibratedDevice& device, const cv::Matx33d& matrix) {
    const double fx = matrix(0, 0);
    const double fy = matrix(1, 1);
    for (const double number : matrix.val)
        if (!std::isfinite(number)) return "holds a number that is not finite";
    if (!(fx > 0.0 && fy > 0.0 && fx < kLargestFocal && fy < kLargestFocal && fx / fy < 100.0 && fy / fx < 100.0))
        return "has no focal lengths in pixels";
    if (std::abs(matrix(0, 1)) > 1e-6 * fx) return "has skew, which Lumorph's lenses do not";
    if (std::abs(matrix(1, 0)) > 1e-9 || std::abs(matrix(2, 0)) > 1e-9 || std::abs(matrix(2, 1)) > 1e-9 ||
        std::abs(matrix(2, 2) - 1.0) > 1e-9)
        return "is no camera matrix";
    if (std::abs(matrix(0, 2)) > kLargestFocal || std::abs(matrix(1, 2)) > kLargestFocal)
        return "has its principal point absurdly far out";
    device.lens[kFocalLength] = fx;
    device.lens[kAspect] = fy / fx;
    device.lens[kPrincipalX] = matrix(0, 2);
    device.lens[kPrincipalY] = matrix(1, 2);
    return {};
}

std::string setDistortion(CalibratedDevice& device, const std::vector<double>& terms) {
    for (std::size_t i = 0; i < terms.size(); ++i) {
        if (!(std::abs(terms[i]) <= kLargestTerm)) return "holds an absurd number";
        if (i >= kDistortionOrder.size() && terms[i] != 0.0)
            return "has terms beyond k1, k2, p1, p2, k3 (rational, thin prism or tilted)";
    }
    for (std::size_t i = 0; i < kDistortionOrder.size(); ++i)
        device.lens[kDistortionOrder[i]] = i < terms.size() ? terms[i] : 0.0;
    return {};
}

std::string setRig(ProcamCalibration& result, const cv::Matx33d& rotation, const cv::Vec3d& shift) {
    const cv::Matx33d product = rotation.t() * rotation;
    double off = std::abs(cv::determinant(rotation) - 1.0);
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            off = std::max(off, std::abs(product(row, column) - (row == column ? 1.0 : 0.0)));
    if (!(off < 1e-3)) return "is no rotation";
    cv::Vec3d vector;
    cv::Rodrigues(rotation, vector);
    result.projectorFromCamera = {vector[0], vector[1], vector[2], shift[0], shift[1], shift[2]};
    return {};
}

CalibrationRecord inMillimetres(CalibrationRecord record) {
    constexpr double kMetresPerMillimetre = 0.001;
    const double unit = record.source.metresPerUnit;
    if (!(unit > 1e-9 && unit < 1e6))
        throw InvalidInput("unit of the calibration", "is no length", "write metresPerUnit, 0.001 for millimetres");
    const double scale = unit / kMetresPerMillimetre;
    record.source.metresPerUnit = kMetresPerMillimetre;
    if (scale == 1.0) return record;
    ProcamCalibration& result = record.result;
    const auto scaleShift = [scale](PoseVector& pose) {
        for (std::size_t i = 3; i < pose.size(); ++i) pose[i] *= scale;
    };
    scaleShift(result.projectorFromCamera);
    scaleShift(result.projectorFromCameraSigma);
    scaleShift(result.state.projectorFromCamera);
    for (PoseVector& pose : result.state.cameraFromBoard) scaleShift(pose);
    result.boardBend *= scale;
    try {
        CalibrationBoard board = parseCalibrationBoard(record.source.board);
        board.spacing *= scale;
        board.marker *= scale;
        record.source.board = boardText(board);
    } catch (const InvalidInput&) { // of another program, which names boards in its own way, or of none
    }
    return record;
}

void addSizeDoubts(ProcamCalibration& result, const std::string& file) {
    const auto add = [&](const CalibratedDevice& device, Cause cause, const char* what, const std::string& remedy) {
        std::array<char, 200> why{};
        std::snprintf(why.data(), why.size(),
                      "the %s's matrix has its centre at column %.1f, row %.1f, but its pictures are said to be "
                      "%d x %d pixels",
                      what, device.lens[kPrincipalX], device.lens[kPrincipalY], device.size.width, device.size.height);
        const auto isSame = [&](const Finding& one) { return one.cause == cause && one.why == why.data(); };
        if (std::ranges::none_of(result.warnings, isSame))
            result.warnings.push_back({cause, "", file, why.data(), remedy});
    };
    constexpr double kFarOut = 0.3;   // of a side, from the middle: no camera's lens sits so far aside
    constexpr double kScaled = 0.125; // likewise, on both axes alike: a size that was scaled
    const auto asideOf = [](const CalibratedDevice& device) {
        return cv::Point2d((device.lens[kPrincipalX] + 0.5) / device.size.width - 0.5,
                           (device.lens[kPrincipalY] + 0.5) / device.size.height - 0.5);
    };
    if (const CalibratedDevice& camera = result.camera; !camera.size.empty()) {
        const cv::Point2d aside = asideOf(camera);
        const bool isFar = std::abs(aside.x) > kFarOut || std::abs(aside.y) > kFarOut;
        const bool isScaled = aside.x * aside.y > 0.0 && std::min(std::abs(aside.x), std::abs(aside.y)) > kScaled &&
                              std::abs(aside.x - aside.y) < 0.2 * std::abs(aside.x + aside.y);
        if (isFar || isScaled)
            add(camera, Cause::imageSize, "camera",
                "give the size of the pictures that it was calibrated with, or calibrate at this one");
    }
    // A projector's lens shift puts its centre above or below the picture, seldom beside it.
    if (const CalibratedDevice& projector = result.projector;
        !projector.size.empty() && std::abs(asideOf(projector).x) > 0.5)
        add(projector, Cause::projectorSize, "projector",
            "give the size of the picture that was projected; ignore this where the lens is shifted sideways");
}

std::string calibrationText(const CalibrationRecord& record) {
    const ProcamCalibration& result = record.result;
    const CalibrationSource& source = record.source;
    json views = json::array();
    for (std::size_t i = 0; i < result.views.size(); ++i) views.push_back(viewJson(result, i));
    json warnings = json::array();
    for (const Finding& finding : result.warnings)
        warnings.push_back({{"cause", std::string(keyOf(finding.cause))},
                            {"view", finding.view},
                            {"file", finding.file},
                            {"why", finding.why},
                            {"remedy", finding.remedy}});
    json document = {{"lumorph", "calibration"},
                     {"schemaVersion", kCalibrationSchema},
                     {"date", source.date},
                     {"board", source.board},
                     {"pattern", source.pattern},
                     {"inputs", source.inputs},
                     {"metresPerUnit", source.metresPerUnit},
                     {"camera", jsonOf(result.camera)},
                     {"views", views},
                     {"worstView", result.worstView},
                     {"halvesDiffer", orNull(result.halvesDiffer)},
                     {"halvesAllowed", orNull(result.halvesAllowed)},
                     {"warnings", warnings},
                     {"degenerate", result.degenerate}};
    if (source.isSimulated) document["simulated"] = true;
    if (result.rms != 0.0) document["rms"] = result.rms;
    if (!result.projector.size.empty()) {
        const PoseVector& rig = result.projectorFromCamera;
        const PoseVector& sigma = result.projectorFromCameraSigma;
        document["projector"] = jsonOf(result.projector);
        document["R"] = rotationJson(rig);
        document["T"] = {rig[3], rig[4], rig[5]};
        if (isAnySaid(sigma))
            document["sigma"] = {{"rotationDegrees", {kDegrees * sigma[0], kDegrees * sigma[1], kDegrees * sigma[2]}},
                                 {"T", {sigma[3], sigma[4], sigma[5]}}};
    }
    if (!allFinite(document)) throw InvalidInput("calibration", "holds a number that is not finite", "calibrate again");
    try {
        return document.dump(2) + "\n";
    } catch (const json::exception&) {
        throw InvalidInput("calibration", "holds a name that is not UTF-8", "rename its folders");
    }
}

CalibrationRecord parseCalibration(std::string_view text, const std::string& name) {
    if (const std::string problem = jsonProblem(text, kLimits); !problem.empty())
        throw DataError(name, problem, kOther);
    json document = json::parse(text);
    if (!document.is_object()) throw DataError(name, "is no calibration: its JSON is not an object", kOther);
    JsonSection root(document, "", name);
    std::string kind;
    root.text("lumorph", kind);
    if (kind != "calibration") throw DataError(name, "is no calibration of Lumorph", kOther);
    int schema = 0;
    root.wholeNumber("schemaVersion", schema, 1, std::numeric_limits<int>::max());
    if (schema > kCalibrationSchema)
        throw DataError(name,
                        "was written by a newer Lumorph (schema " + std::to_string(schema) + "; this one reads up to " +
                            std::to_string(kCalibrationSchema) + ")",
                        "open it with the newest Lumorph");
    if (schema == 0) root.refuse("schemaVersion", "is missing", "write " + std::to_string(kCalibrationSchema));
    CalibrationRecord record;
    ProcamCalibration& result = record.result;
    readSource(document, root, record.source);
    requiredSection(root, document, "camera", [&](json& object, const JsonSection& section) {
        readDevice(object, section, result.camera, document.contains("projector"));
    });
    if (root.has("projector")) {
        requiredSection(root, document, "projector", [&](json& object, const JsonSection& section) {
            readDevice(object, section, result.projector);
        });
        readRig(document, root, result);
    }
    root.number("rms", result.rms, 0.0, kLargest);
    root.text("worstView", result.worstView);
    root.flag("degenerate", result.degenerate);
    result.halvesDiffer = optionalNumber(root, document, "halvesDiffer");
    result.halvesAllowed = optionalNumber(root, document, "halvesAllowed");
    std::size_t view = 0;
    json views = document.value("views", json::array());
    root.sections("views", kMostViews, [&](const JsonSection& section) { readView(views[view++], section, result); });
    root.sections("warnings", kMostTexts, [&](const JsonSection& section) { readWarning(section, result); });
    result.state.camera = result.camera.lens;
    result.state.projector = result.projector.lens;
    result.state.projectorFromCamera = result.projectorFromCamera;
    addSizeDoubts(result, name);
    return record;
}

} // namespace lumorph
