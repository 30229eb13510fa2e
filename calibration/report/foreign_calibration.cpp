#include "calibration/report/foreign_calibration.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <opencv2/calib3d.hpp>

#include "calibration/report/foreign_text.h"
#include "core/base/error.h"
#include "core/base/text.h"

namespace lumorph {

namespace {

constexpr int kMostPixels = 65'536;
constexpr int kDeepestNode = 8;

/// What an entry of such a file can be.
enum class Role {
    cameraMatrix,
    cameraDistortion,
    cameraModel, ///< of its distortion
    cameraType,  ///< a projection's name, or what is printed on the camera
    cameraWidth,
    cameraHeight,
    cameraSize,
    cameraRms,
    projectorMatrix,
    projectorDistortion,
    projectorModel,
    projectorType,
    projectorWidth,
    projectorHeight,
    projectorSize,
    projectorRms,
    rotation,
    translation,
    transform,
    rms,
    metresPerUnit,
    date,
    board,
    simulated,
    pictureShape, ///< height and width, as NumPy has them
    fisheye,      ///< a switch
};

/// How each is spelled: as it stands, or without case, underscores and blanks.
struct Spelling {
    Role role;
    std::string_view exact; ///< short names, where case tells a matrix from a number; separated by blanks
    std::string_view loose;
};
constexpr std::array kSpellings{
    Spelling{Role::cameraMatrix, "K K1 M M1 CM1 A1 Kc k",
             "cameramatrix cameramatrix1 camera1matrix cammatrix cammatrix1 camk camerak camint mtx mtx1 "
             "intrinsicmatrix intrinsicmatrix1 intrinsics1 cameraintrinsics"},
    Spelling{Role::cameraDistortion, "D D1 kc d",
             "distcoeffs distcoeffs1 distcoeff distcoeff1 distcoefs1 distortioncoefficients distortioncoefficients1 "
             "distortioncoeffs camkc dist dist1 cameradistcoeffs cameradistortion camdist"},
    Spelling{Role::cameraModel, "", "distortionmodel lensmodel distortiontype"},
    Spelling{Role::cameraType, "", "cameramodel projectionmodel"},
    Spelling{Role::projectorMatrix, "K2 M2 CM2 A2 Kp",
             "cameramatrix2 camera2matrix cammatrix2 projk projectork projint projmatrix projectormatrix "
             "projectorcameramatrix mtx2 intrinsicmatrix2 intrinsics2 projectorintrinsics"},
    Spelling{Role::projectorDistortion, "D2 kp",
             "distcoeffs2 distcoeff2 distcoefs2 distortioncoefficients2 projkc dist2 projdistcoeffs projdist "
             "projectordistcoeffs projectordistortion"},
    Spelling{Role::rotation, "R Rp", "rotation rotationmatrix rot"},
    Spelling{Role::translation, "T Tp", "translation translationvector trans"},
    Spelling{Role::transform, "", "tcncnm1"},
    Spelling{Role::cameraWidth, "width", "imagewidth imagewidth1 camerawidth camwidth framewidth"},
    Spelling{Role::cameraHeight, "height", "imageheight imageheight1 cameraheight camheight frameheight"},
    Spelling{Role::cameraSize, "", "imagesize imagesize1 camerasize camsize cameraresolution resolution"},
    Spelling{Role::pictureShape, "", "imgshape imageshape"},
    Spelling{Role::projectorWidth, "", "projectorwidth projwidth imagewidth2 screenresx screenwidth"},
    Spelling{Role::projectorHeight, "", "projectorheight projheight imageheight2 screenresy screenheight"},
    Spelling{Role::projectorSize, "", "projectorsize projsize imagesize2 projectorresolution"},
    Spelling{Role::rms, "", "rms stereoerror stereorms reprojectionerror"},
    Spelling{Role::cameraRms, "", "camerarms camerror avgreprojectionerror rms1"},
    Spelling{Role::projectorRms, "", "projectorrms projerror rms2"},
    Spelling{Role::metresPerUnit, "", "metresperunit"},
    Spelling{Role::date, "", "calibrationtime calibrationdate date"},
    Spelling{Role::board, "", "board"},
    Spelling{Role::simulated, "", "simulated"},
    Spelling{Role::fisheye, "", "fisheye fisheyemodel isfisheye usefisheye"},
};
/// Names that are clear in the node of a device alone.
constexpr std::array kNodeSpellings{
    Spelling{Role::cameraMatrix, "", "matrix intrinsics intrinsic"},
    Spelling{Role::cameraDistortion, "", "distortion coefficients coeffs distcoefs kc"},
    Spelling{Role::cameraType, "", "model"},
    Spelling{Role::cameraSize, "", "size"},
    Spelling{Role::cameraRms, "", "rms error"},
};

/// The device in whose node an entry is.
enum class Side { none, camera, projector };

constexpr std::array kDeviceRoles{
    std::pair(Role::cameraMatrix, Role::projectorMatrix), std::pair(Role::cameraDistortion, Role::projectorDistortion),
    std::pair(Role::cameraModel, Role::projectorModel),   std::pair(Role::cameraType, Role::projectorType),
    std::pair(Role::cameraWidth, Role::projectorWidth),   std::pair(Role::cameraHeight, Role::projectorHeight),
    std::pair(Role::cameraSize, Role::projectorSize),     std::pair(Role::cameraRms, Role::projectorRms)};

/// Lens models that are OpenCV's k1, k2, p1, p2, k3 (and terms that must then be 0), loosely spelled.
constexpr std::string_view kBrownModels =
    "plumbbob rationalpolynomial radtan radialtangential brown brownconrady opencv opencv5 pinhole pinholeradtan "
    "perspective standard none null";
/// Those that are not, where the word may also be the type of a camera.
constexpr std::string_view kOtherModels =
    "equidistant equi fisheye opencvfisheye fisheye624 kannalabrandt kannalabrandt4 kannalabrandt8 kb kb4 kb8 "
    "pinholeequi omni omnidirectional mei ds doublesphere eucm ucm unified fov atan ocam scaramuzza thinprismfisheye "
    "stereographic orthographic equisolid";

std::string shortNumber(double number) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.3g", number);
    return text.data();
}

/// "2026-11-24T17:05:00Z".
bool isIsoDate(std::string_view date) {
    constexpr std::string_view kForm = "0000-00-00T";
    if (date.size() < kForm.size()) return false;
    for (std::size_t i = 0; i < kForm.size(); ++i)
        if (kForm[i] == '0' ? date[i] < '0' || date[i] > '9' : date[i] != kForm[i]) return false;
    return true;
}

bool isWordAmong(std::string_view words, std::string_view word) {
    if (word.empty() || word.find(' ') != std::string_view::npos) return false;
    for (std::size_t at = words.find(word); at != std::string_view::npos; at = words.find(word, at + 1)) {
        const bool begins = at == 0 || words[at - 1] == ' ';
        const bool ends = at + word.size() == words.size() || words[at + word.size()] == ' ';
        if (begins && ends) return true;
    }
    return false;
}

/// Small letters and digits alone.
std::string looseOf(std::string_view key) {
    std::string loose;
    for (const char c : lowerCase(key))
        if (c != '_' && c != '-' && c != ' ') loose += c;
    return loose;
}

template <typename Spellings>
std::optional<Role> roleAmong(const Spellings& spellings, std::string_view key, std::string_view loose) {
    for (const Spelling& spelling : spellings)
        if (isWordAmong(spelling.exact, key) || isWordAmong(spelling.loose, loose)) return spelling.role;
    return std::nullopt;
}

/// The number of a node such as "cam0" or "camera_2"; nothing for other names.
std::optional<int> cameraNumber(std::string_view key) {
    const std::string loose = looseOf(key);
    const std::size_t digits = loose.starts_with("camera") ? 6 : loose.starts_with("cam") ? 3 : loose.size();
    if (loose.size() != digits + 1 || loose.back() < '0' || loose.back() > '9') return std::nullopt;
    return loose.back() - '0';
}

/// What of a file means something to us; whatever else stands there is passed over.
class Entries {
public:
    explicit Entries(const ForeignText& text) : text_(text) {}

    void collect(const ForeignEntry& node, Side side = Side::none, int depth = 0) {
        // Kalibr counts cameras from 0, users of stereoCalibrate from 1.
        const bool fromZero =
            std::ranges::any_of(node.children, [](const ForeignEntry& child) { return cameraNumber(child.key) == 0; });
        for (const ForeignEntry& child : node.children) {
            if (child.key.empty()) continue;
            if (const auto role = roleOf(child, side)) {
                note(*role, child, depth);
                continue;
            }
            if (child.children.empty() || depth >= kDeepestNode || isBoardNode(child)) continue;
            if (const auto inner = sideOf(child, side, fromZero))
                collect(child, *inner, depth + 1);
            else
                passedOver_.push_back(&child);
        }
    }

    [[nodiscard]] bool has(Role role) const { return entries_.contains(role); }
    [[nodiscard]] const ForeignEntry& at(Role role) const { return *entries_.at(role).entry; }
    [[nodiscard]] std::size_t line(Role role) const { return at(role).line; }
    [[nodiscard]] std::string word(Role role) const { return has(role) ? ForeignText::wordOf(at(role)) : ""; }
    /// Nodes of further cameras.
    [[nodiscard]] const std::vector<const ForeignEntry*>& passedOver() const { return passedOver_; }

private:
    struct Noted {
        const ForeignEntry* entry = nullptr;
        int depth = 0;
    };

    /// A board's width and height are no camera's.
    [[nodiscard]] static bool isBoardNode(const ForeignEntry& node) {
        constexpr std::array<std::string_view, 8> kNames = {"board",        "chessboard", "checkerboard", "charuco",
                                                            "charucoboard", "pattern",    "target",       "grid"};
        return std::ranges::find(kNames, looseOf(node.key)) != kNames.end();
    }

    /// Of a node by its name, within one of `around`; nothing for the node of a further camera.
    [[nodiscard]] std::optional<Side> sideOf(const ForeignEntry& node, Side around, bool fromZero) const {
        const std::string loose = looseOf(node.key);
        if (loose.starts_with("proj") || loose == "beamer") return Side::projector;
        if (loose == "cam" || loose == "camera" || loose == "cameracalibration") return Side::camera;
        const std::optional<int> number = cameraNumber(node.key);
        if (!number) return around;
        if (!fromZero)
            return *number == 1   ? std::optional(Side::camera)
                   : *number == 2 ? std::optional(Side::projector)
                                  : std::nullopt;
        // Kalibr knows cameras alone; a projector that was calibrated as one has a topic that says so.
        const ForeignEntry* topic = node.child("rostopic");
        const bool isProjector = topic != nullptr && lowerCase(topic->value).find("proj") != std::string::npos;
        // Each is placed by the one before it.
        if (isProjector && *number != 1)
            text_.refuse(node.line, "is the projector, which has to be the second of the chain, after its camera");
        return *number == 0 ? std::optional(Side::camera) : isProjector ? std::optional(Side::projector) : std::nullopt;
    }

    /// Those of a list in brackets or of a matrix; 0 where something else stands there.
    [[nodiscard]] std::size_t countIn(const ForeignEntry& entry) const {
        try {
            return text_.numbersOf(entry).size();
        } catch (const DataError&) {
            return 0;
        }
    }

    [[nodiscard]] static bool isWord(const ForeignEntry& entry) {
        const std::string word = ForeignText::wordOf(entry);
        return entry.children.empty() && !word.empty() && std::isalpha(static_cast<unsigned char>(word.front())) != 0;
    }

    [[nodiscard]] std::optional<Role> roleOf(const ForeignEntry& entry, Side side) const {
        const std::string loose = looseOf(entry.key);
        std::optional<Role> role = roleAmong(kSpellings, entry.key, loose);
        if (!role && side != Side::none) role = roleAmong(kNodeSpellings, entry.key, loose);
        if (!role) return std::nullopt;
        // A node of that name, with the figures in it.
        const bool isMatrix = entry.child("data") != nullptr || entry.children.empty() || entry.children[0].key.empty();
        if (!isMatrix && *role != Role::fisheye) return std::nullopt;
        if (entry.key == "k" && countIn(entry) != 9) role = Role::cameraDistortion;
        if (*role == Role::cameraDistortion && isWord(entry)) role = Role::cameraModel;
        // What camera_info calls R rectifies a stereo pair.
        if (side == Side::camera && (*role == Role::rotation || *role == Role::translation)) return std::nullopt;
        if (side == Side::projector)
            for (const auto& [camera, projector] : kDeviceRoles)
                if (*role == camera) return projector;
        return role;
    }

    void note(Role role, const ForeignEntry& entry, int depth) {
        const auto [known, isNew] = entries_.try_emplace(role, Noted{&entry, depth});
        if (isNew || known->second.depth < depth) return;
        const bool isRemark = role == Role::rms || role == Role::cameraRms || role == Role::projectorRms ||
                              role == Role::date || role == Role::board; // written in several ways side by side
        const bool isSame = entry.children.empty() && entry.value == known->second.entry->value;
        if (known->second.depth == depth && (isRemark || isSame)) return;
        if (known->second.depth == depth)
            text_.refuse(entry.line, "says again what line " + std::to_string(known->second.entry->line) + " said");
        known->second = {&entry, depth};
    }

    const ForeignText& text_;
    std::map<Role, Noted> entries_;
    std::vector<const ForeignEntry*> passedOver_;
};

/// Takes a calibration out of the entries of one document.
class ForeignCalibration {
public:
    ForeignCalibration(const ForeignText& text, Entries entries) : text_(text), entries_(std::move(entries)) {}

    CalibrationRecord take(const KnownSizes& sizes) {
        CalibrationRecord record;
        ProcamCalibration& result = record.result;
        refuseFisheye();
        const bool hasProjector = entries_.has(Role::projectorMatrix);
        takeDevice(result, result.camera, Role::cameraMatrix, Role::cameraDistortion, Role::cameraModel,
                   Role::cameraType, "camera");
        result.camera.size = cameraSize(result, sizes.camera, !hasProjector);
        if (hasProjector) {
            takeDevice(result, result.projector, Role::projectorMatrix, Role::projectorDistortion, Role::projectorModel,
                       Role::projectorType, "projector");
            result.projector.size = sizeOf(Role::projectorWidth, Role::projectorHeight, Role::projectorSize,
                                           sizes.projector, "projector", true);
            takeRig(record);
        }
        result.rms = errorOf(Role::rms);
        result.camera.rms = errorOf(Role::cameraRms);
        result.projector.rms = errorOf(Role::projectorRms);
        // OpenCV's own samples write dates as the machine's language has them.
        if (const std::string date = entries_.word(Role::date); isIsoDate(date)) record.source.date = date;
        record.source.board = entries_.word(Role::board);
        const std::string simulated = lowerCase(entries_.word(Role::simulated));
        const bool isWord = simulated == "true" || simulated == "yes" || simulated == "false" || simulated == "no";
        record.source.isSimulated =
            isWord ? simulated == "true" || simulated == "yes" : numberOr(Role::simulated, 0.0, 0.0) != 0.0;
        result.state.camera = result.camera.lens;
        result.state.projector = result.projector.lens;
        result.state.projectorFromCamera = result.projectorFromCamera;
        addSizeDoubts(result, text_.name());
        for (const ForeignEntry* other : entries_.passedOver())
            result.warnings.push_back({Cause::passedOver, "", text_.placeOf(other->line),
                                       inQuotes(other->key) + " is a further camera, and was passed over",
                                       "import a file of its own for it"});
        return record;
    }

private:
    [[noreturn]] void refuseMissing(const std::string& what, const std::string& remedy) const {
        throw DataError(text_.name(), "says nothing of the " + what, remedy);
    }

    [[noreturn]] void refuseModel(std::size_t line, const std::string& why) const {
        throw CaptureRefused({Cause::lensModel, "", text_.placeOf(line), why,
                              "calibrate with k1, k2, p1, p2, k3 alone (plumb_bob, radtan), or with pictures that were "
                              "undistorted before"});
    }

    void refuseFisheye() const {
        if (!entries_.has(Role::fisheye)) return;
        const ForeignEntry& entry = entries_.at(Role::fisheye);
        const std::string word = lowerCase(ForeignText::wordOf(entry));
        if (entry.children.empty() && (word == "0" || word == "false" || word == "no" || word.empty())) return;
        refuseModel(entry.line, "its lens model is OpenCV's fisheye (Kannala-Brandt), whose k1 to k4 are no k1, k2, "
                                "p1, p2");
    }

    /// Whether a model is named; one that Lumorph's lenses do not have is refused.
    bool checkModel(Role model, bool isType, const char* what) const {
        if (!entries_.has(model)) return false;
        const std::string word = entries_.word(model);
        const std::string loose = looseOf(word);
        if (loose.empty() || isWordAmong(kBrownModels, loose)) return !loose.empty() && !isType;
        if (isType && !isWordAmong(kOtherModels, loose)) return false;
        refuseModel(entries_.line(model),
                    "the " + std::string(what) + "'s lens model is " + inQuotes(word) +
                        (isWordAmong(kOtherModels, loose) ? ", a fisheye or wide-angle model" : "") +
                        "; its numbers are no k1, k2, p1, p2");
    }

    /// Throws where numbers and shape do not agree.
    std::vector<double> numbersIn(Role role, std::initializer_list<std::size_t> counts, const char* what) const {
        const ForeignEntry& entry = entries_.at(role);
        const std::size_t shape = countIn(entry, "rows") * countIn(entry, "cols");
        std::vector<double> numbers = text_.numbersOf(entry);
        if (shape > 0 && shape != numbers.size())
            text_.refuse(entry.line, "has " + std::to_string(numbers.size()) + " numbers, not " +
                                         std::to_string(shape) + " as its rows and columns say");
        if (std::ranges::find(counts, numbers.size()) == counts.end())
            text_.refuse(entry.line, "has " + std::to_string(numbers.size()) + " numbers, which is no " + what);
        return numbers;
    }

    /// 0: not said.
    std::size_t countIn(const ForeignEntry& entry, std::string_view key) const {
        const ForeignEntry* said = entry.child(key);
        if (said == nullptr) return 0;
        const auto count = foreignNumber(said->value);
        if (!count || *count < 1.0 || *count > 64.0 || *count != std::floor(*count))
            text_.refuse(said->line,
                         inQuotes(said->value) + " is no number of " + (key == "rows" ? "rows" : "columns"));
        return static_cast<std::size_t>(*count);
    }

    void takeDevice(ProcamCalibration& result, CalibratedDevice& device, Role matrix, Role distortion, Role model,
                    Role type, const char* what) {
        if (!entries_.has(matrix))
            refuseMissing(what + std::string("'s matrix"),
                          "write cameraMatrix1 (camera) and cameraMatrix2 (projector)");
        (void)checkModel(type, true, what);
        const bool isNamed = checkModel(model, false, what);
        const std::vector<double> n = numbersIn(matrix, {9, 4}, "3 x 3 matrix");
        const cv::Matx33d intrinsics =
            n.size() == 9 ? cv::Matx33d(n.data()) : cv::Matx33d(n[0], 0.0, n[2], 0.0, n[1], n[3], 0.0, 0.0, 1.0);
        if (const std::string problem = setIntrinsics(device, intrinsics); !problem.empty())
            text_.refuse(entries_.line(matrix), problem);
        device.model = "imported";
        if (!entries_.has(distortion) || isNothing(distortion)) return;
        const std::vector<double> terms = numbersIn(distortion, {0, 4, 5, 8, 12, 14}, "distortion of OpenCV");
        if (const std::string problem = setDistortion(device, terms); !problem.empty())
            refuseModel(entries_.line(distortion), problem);
        const bool isDistorted = std::ranges::any_of(terms, [](double term) { return term != 0.0; });
        if (terms.size() == 4 && isDistorted && !isNamed)
            result.warnings.push_back({Cause::lensModel, "", text_.placeOf(entries_.line(distortion)),
                                       "the " + std::string(what) +
                                           "'s lens model is not named; its four numbers are taken as k1, k2, p1, p2",
                                       "make sure that it is no fisheye, whose four numbers mean something else"});
    }

    bool isNothing(Role role) const {
        const std::string word = lowerCase(entries_.word(role));
        return entries_.at(role).children.empty() && (word.empty() || word == "null" || word == "~" || word == "none");
    }

    cv::Size sizeOf(Role width, Role height, Role both, cv::Size known, const char* what, bool must) const {
        std::vector<double> sides;
        std::size_t line = 0;
        if (entries_.has(both)) {
            sides = numbersIn(both, {2}, "width and height");
            line = entries_.line(both);
        } else if (entries_.has(width) && entries_.has(height)) {
            sides = {numbersIn(width, {1}, "width")[0], numbersIn(height, {1}, "height")[0]};
            line = entries_.line(width);
        }
        // A camera that was not opened yet is 0 x 0 in ROS, and in SLStudio.
        if (std::ranges::all_of(sides, [](double side) { return side == 0.0; })) sides.clear();
        if (sides.empty() && !known.empty()) return known;
        if (sides.empty() && !must) return {};
        if (sides.empty())
            refuseMissing(what + std::string("'s size"), "add " + std::string(what) + "_width and " + what + "_height");
        return wholeSize(sides[0], sides[1], line);
    }

    cv::Size wholeSize(double width, double height, std::size_t line) const {
        for (const double side : {width, height})
            if (!(side >= 1.0 && side <= kMostPixels && side == std::floor(side)))
                text_.refuse(line, "is no width and height in pixels");
        return {static_cast<int>(width), static_cast<int>(height)};
    }

    cv::Size cameraSize(const ProcamCalibration& result, cv::Size known, bool must) const {
        if (!entries_.has(Role::pictureShape))
            return sizeOf(Role::cameraWidth, Role::cameraHeight, Role::cameraSize, known, "camera", must);
        const std::vector<double> shape = numbersIn(Role::pictureShape, {2, 3}, "shape of a picture");
        cv::Size size = wholeSize(shape[1], shape[0], entries_.line(Role::pictureShape));
        // Some write it the other way round; the middle of the lens says which.
        const Lens& lens = result.camera.lens;
        const auto fits = [&lens](cv::Size one) {
            return lens[kPrincipalX] < one.width && lens[kPrincipalY] < one.height;
        };
        if (!fits(size) && fits({size.height, size.width})) std::swap(size.width, size.height);
        return size;
    }

    void takeRig(CalibrationRecord& record) {
        if (entries_.has(Role::transform)) return takeTransform(record);
        if (!entries_.has(Role::rotation) || !entries_.has(Role::translation))
            refuseMissing("projector's place", "write R and T, from the camera's frame to the projector's");
        const std::vector<double> rotation = numbersIn(Role::rotation, {9, 3}, "rotation");
        const std::vector<double> shift = numbersIn(Role::translation, {3}, "translation");
        cv::Matx33d matrix;
        if (rotation.size() == 9)
            matrix = cv::Matx33d(rotation.data());
        else
            cv::Rodrigues(cv::Vec3d(rotation.data()), matrix);
        setPlace(record, matrix, cv::Vec3d(shift.data()), Role::rotation);
        takeUnit(record);
    }

    /// Kalibr's: metres.
    void takeTransform(CalibrationRecord& record) {
        const std::vector<double> rows = numbersIn(Role::transform, {16, 12}, "transformation of 4 x 4 numbers");
        const cv::Matx33d turn(rows[0], rows[1], rows[2], rows[4], rows[5], rows[6], rows[8], rows[9], rows[10]);
        setPlace(record, turn, {rows[3], rows[7], rows[11]}, Role::transform);
        record.source.metresPerUnit = 1.0;
    }

    void setPlace(CalibrationRecord& record, const cv::Matx33d& turn, const cv::Vec3d& shift, Role role) const {
        if (const std::string problem = setRig(record.result, turn, shift); !problem.empty())
            text_.refuse(entries_.line(role), problem);
    }

    /// Of T. No camera stands a few millimetres from its projector, and none 20 metres away.
    void takeUnit(CalibrationRecord& record) const {
        constexpr double kLeastMillimetres = 20.0;
        if (entries_.has(Role::metresPerUnit)) {
            record.source.metresPerUnit = numberOr(Role::metresPerUnit, 0.001, 1e-9);
            return;
        }
        const PoseVector& rig = record.result.projectorFromCamera;
        const double length = std::hypot(rig[3], rig[4], rig[5]);
        if (!(length > 0.0) || length >= kLeastMillimetres) return;
        record.source.metresPerUnit = 1.0;
        record.result.warnings.push_back(
            {Cause::unlikelyLength, "", text_.placeOf(entries_.line(Role::translation)),
             "T is " + shortNumber(length) + " long and its unit is not said; it is taken in metres",
             "write metres_per_unit beside it where that is wrong"});
    }

    /// 0, not known, where something else than one number stands there.
    double errorOf(Role role) const {
        if (!entries_.has(role) || isNothing(role)) return 0.0;
        try {
            const std::vector<double> numbers = text_.numbersOf(entries_.at(role));
            return numbers.size() == 1 && numbers[0] > 0.0 ? numbers[0] : 0.0;
        } catch (const DataError&) { // "n/a"
            return 0.0;
        }
    }

    double numberOr(Role role, double otherwise, double least) const {
        if (!entries_.has(role) || isNothing(role)) return otherwise;
        const double number = numbersIn(role, {1}, "single number")[0];
        if (!(number >= least)) text_.refuse(entries_.line(role), "is out of range");
        return number;
    }

    const ForeignText& text_;
    Entries entries_;
};

} // namespace

CalibrationRecord parseForeignCalibration(std::string_view text, const std::string& name, const KnownSizes& sizes) {
    const ForeignText parsed(text, name);
    std::optional<Entries> first; // that has a matrix: an echo repeats itself
    std::optional<Finding> differs;
    for (const ForeignEntry& document : parsed.documents()) {
        Entries other(parsed);
        other.collect(document);
        if (!other.has(Role::cameraMatrix)) continue;
        if (!first)
            first.emplace(std::move(other));
        else if (parsed.numbersOf(other.at(Role::cameraMatrix)) != parsed.numbersOf(first->at(Role::cameraMatrix)))
            differs = Finding{Cause::passedOver, "", parsed.placeOf(other.line(Role::cameraMatrix)),
                              "holds another camera's matrix than line " +
                                  std::to_string(first->line(Role::cameraMatrix)) + ", and was passed over",
                              "give each camera a file of its own"};
    }
    CalibrationRecord record = ForeignCalibration(parsed, first.value_or(Entries(parsed))).take(sizes);
    if (differs) record.result.warnings.push_back(*differs);
    return record;
}

} // namespace lumorph
