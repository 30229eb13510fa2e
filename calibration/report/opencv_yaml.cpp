#include "calibration/report/opencv_yaml.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <optional>

#include <opencv2/calib3d.hpp>

#include "core/base/error.h"
#include "core/base/text.h"

namespace lumorph {

namespace {

constexpr std::size_t kMostYamlBytes = std::size_t{16} << 20;
constexpr std::size_t kMostNumbers = 64; // of one entry that is read
constexpr int kMostPixels = 65'536;
constexpr double kLargestNumber = 1e9;

/// What an entry of such a file can be.
enum class Role {
    cameraMatrix,
    cameraDistortion,
    projectorMatrix,
    projectorDistortion,
    rotation,
    translation,
    cameraWidth,
    cameraHeight,
    cameraSize,
    projectorWidth,
    projectorHeight,
    projectorSize,
    rms,
    cameraRms,
    projectorRms,
    metresPerUnit,
    date,
    board,
    simulated,
};

/// How each is spelled: as it stands, or without case, underscores and blanks.
struct Spelling {
    Role role;
    std::string_view exact; ///< short names, where case tells a matrix from a number; separated by blanks
    std::string_view loose;
};
constexpr std::array kSpellings{
    Spelling{Role::cameraMatrix, "K K1 M M1 CM1 A1",
             "cameramatrix cameramatrix1 camera1matrix cammatrix cammatrix1 camk camerak mtx mtx1 intrinsicmatrix "
             "intrinsicmatrix1 intrinsics1 cameraintrinsics"},
    Spelling{Role::cameraDistortion, "D D1",
             "distcoeffs distcoeffs1 distcoeff distcoeff1 distcoefs1 distortioncoefficients distortioncoefficients1 "
             "camkc dist dist1 cameradistcoeffs cameradistortion camdist"},
    Spelling{Role::projectorMatrix, "K2 M2 CM2 A2",
             "cameramatrix2 camera2matrix cammatrix2 projk projectork projmatrix projectormatrix projectorcameramatrix "
             "mtx2 intrinsicmatrix2 intrinsics2 projectorintrinsics"},
    Spelling{Role::projectorDistortion, "D2",
             "distcoeffs2 distcoeff2 distcoefs2 distortioncoefficients2 projkc dist2 projdistcoeffs projdist "
             "projectordistcoeffs projectordistortion"},
    Spelling{Role::rotation, "R", "rotation rotationmatrix rot"},
    Spelling{Role::translation, "T", "translation translationvector trans"},
    Spelling{Role::cameraWidth, "", "imagewidth imagewidth1 camerawidth camwidth"},
    Spelling{Role::cameraHeight, "", "imageheight imageheight1 cameraheight camheight"},
    Spelling{Role::cameraSize, "", "imagesize imagesize1 camerasize camsize cameraresolution"},
    Spelling{Role::projectorWidth, "", "projectorwidth projwidth imagewidth2"},
    Spelling{Role::projectorHeight, "", "projectorheight projheight imageheight2"},
    Spelling{Role::projectorSize, "", "projectorsize projsize imagesize2 projectorresolution"},
    Spelling{Role::rms, "", "rms stereoerror stereorms reprojectionerror"},
    Spelling{Role::cameraRms, "", "camerarms camerror avgreprojectionerror rms1"},
    Spelling{Role::projectorRms, "", "projectorrms projerror rms2"},
    Spelling{Role::metresPerUnit, "", "metresperunit"},
    Spelling{Role::date, "", "calibrationtime calibrationdate date"},
    Spelling{Role::board, "", "board"},
    Spelling{Role::simulated, "", "simulated"},
};

bool isAmong(std::string_view words, std::string_view word) {
    if (word.empty() || word.find(' ') != std::string_view::npos) return false;
    for (std::size_t at = words.find(word); at != std::string_view::npos; at = words.find(word, at + 1)) {
        const bool begins = at == 0 || words[at - 1] == ' ';
        const bool ends = at + word.size() == words.size() || words[at + word.size()] == ' ';
        if (begins && ends) return true;
    }
    return false;
}

std::optional<Role> roleOf(std::string_view key) {
    std::string loose;
    for (const char c : key)
        if (c != '_' && c != '-' && c != ' ') loose += static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
    for (const Spelling& spelling : kSpellings)
        if (isAmong(spelling.exact, key) || isAmong(spelling.loose, loose)) return spelling.role;
    return std::nullopt;
}

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view kBlank = " \t\r";
    const std::size_t begin = text.find_first_not_of(kBlank);
    if (begin == std::string_view::npos) return {};
    return text.substr(begin, text.find_last_not_of(kBlank) - begin + 1);
}

std::string_view unquoted(std::string_view text) {
    const bool isQuoted =
        text.size() >= 2 && (text.front() == '"' || text.front() == '\'') && text.back() == text.front();
    return isQuoted ? text.substr(1, text.size() - 2) : text;
}

/// "key: rest"; empty where it is none. A colon counts before a blank or the end.
std::optional<std::pair<std::string_view, std::string_view>> entryOf(std::string_view line) {
    std::size_t from = 0;
    if (!line.empty() && (line.front() == '"' || line.front() == '\'')) from = line.find(line.front(), 1);
    if (from == std::string_view::npos) return std::nullopt;
    for (std::size_t at = line.find(':', from); at != std::string_view::npos; at = line.find(':', at + 1))
        if (at > 0 && (at + 1 == line.size() || line[at + 1] == ' ' || line[at + 1] == '\t'))
            return std::pair(unquoted(trimmed(line.substr(0, at))), trimmed(line.substr(at + 1)));
    return std::nullopt;
}

/// What a file says under one key.
struct Entry {
    int line = 0;
    std::string word; ///< a scalar
    std::vector<double> numbers;
    int rows = 0, columns = 0; ///< 0: not said
};

/// The entries of a file that mean something to us; whatever else stands there is passed over.
class YamlReader {
public:
    YamlReader(std::string_view text, const std::string& name) : text_(text), name_(name) {}

    std::map<Role, Entry> read() {
        std::optional<Role> role; // of the entry that the lines belong to
        std::string_view part;    // of a matrix: rows, cols, dt, data
        while (nextLine()) {
            const std::string_view line = trimmed(line_);
            if (line.empty() || line.front() == '#' || line.starts_with('%') || line == "---" || line == "...")
                continue;
            const bool isInner = line_.front() == ' ' || line_.front() == '\t' || line.front() == '-' ||
                                 line.front() == ']' || open_ > 0;
            const auto entry = open_ > 0 ? std::nullopt : entryOf(line);
            if (!isInner) {
                if (!entry) refuse("is no 'key: value'");
                role = roleOf(entry->first);
                part = {};
                if (role && entries_.contains(*role))
                    refuse("says again what line " + std::to_string(entries_[*role].line) + " said");
                if (role) entries_[*role].line = number_;
                take(role, part, withoutTag(entry->second));
            } else if (entry && line.front() != '-') {
                part = entry->first;
                take(role, part, withoutTag(entry->second));
            } else {
                take(role, part, line);
            }
        }
        if (open_ > 0) refuse("ends within a list");
        return std::move(entries_);
    }

    [[noreturn]] void refuse(const std::string& why) const { refuseAt(number_, why); }
    [[noreturn]] void refuseAt(int line, const std::string& why) const {
        throw DataError(name_ + ", line " + std::to_string(line), why,
                        "write it as OpenCV's FileStorage does, or export it as JSON from Lumorph");
    }

private:
    bool nextLine() {
        if (at_ >= text_.size()) return false;
        const std::size_t end = std::min(text_.find('\n', at_), text_.size());
        line_ = text_.substr(at_, end - at_);
        at_ = end + 1;
        ++number_;
        return true;
    }

    /// Without "!!opencv-matrix" and such.
    static std::string_view withoutTag(std::string_view rest) {
        if (!rest.starts_with('!')) return rest;
        const std::size_t blank = rest.find(' ');
        return blank == std::string_view::npos ? std::string_view() : trimmed(rest.substr(blank));
    }

    void take(const std::optional<Role>& role, std::string_view part, std::string_view rest) {
        const bool isQuoted = !rest.empty() && (rest.front() == '"' || rest.front() == '\'');
        if (!isQuoted)
            for (const char c : rest) open_ += c == '[' || c == '{' ? 1 : c == ']' || c == '}' ? -1 : 0;
        if (open_ < 0) refuse("closes a list that was not opened");
        if (!role || rest.empty()) return;
        Entry& entry = entries_[*role];
        if (part == "dt") return;
        if (part == "rows" || part == "cols") {
            const auto count = numberOf(rest);
            if (!count || *count < 1.0 || *count > 64.0 || *count != std::floor(*count))
                refuse(inQuotes(rest) + " is no number of " + (part == "rows" ? "rows" : "columns"));
            (part == "rows" ? entry.rows : entry.columns) = static_cast<int>(*count);
            return;
        }
        if (*role == Role::date || *role == Role::board) {
            entry.word = inQuotes(unquoted(rest), 200);
            entry.word = entry.word.substr(1, entry.word.size() - 2);
            return;
        }
        takeNumbers(entry, rest);
    }

    void takeNumbers(Entry& entry, std::string_view rest) {
        constexpr std::string_view kBetween = " \t\r[],";
        if (rest.find('{') != std::string_view::npos) refuse("holds a map where numbers should be");
        for (std::size_t at = rest.find_first_not_of(kBetween); at != std::string_view::npos;) {
            const std::size_t end = std::min(rest.find_first_of(kBetween, at), rest.size());
            const std::string_view word = rest.substr(at, end - at);
            at = rest.find_first_not_of(kBetween, end);
            if (word.starts_with('#')) return;
            if (word == "-") continue; // of a list, one line an element
            const auto number = numberOf(unquoted(word));
            if (!number) refuse(inQuotes(word) + " is no number up to 1e9");
            entry.numbers.push_back(*number);
            if (entry.numbers.size() > kMostNumbers) refuse("holds more numbers than a matrix of a calibration");
        }
    }

    static std::optional<double> numberOf(std::string_view word) {
        if (word.starts_with('+')) word.remove_prefix(1);
        double number = 0.0;
        const auto read = std::from_chars(word.data(), word.data() + word.size(), number);
        if (read.ec != std::errc() || read.ptr != word.data() + word.size()) return std::nullopt;
        if (!(std::abs(number) <= kLargestNumber)) return std::nullopt;
        return number;
    }

    std::string_view text_;
    const std::string& name_;
    std::size_t at_ = 0;
    std::string_view line_;
    int number_ = 0;
    int open_ = 0; ///< brackets
    std::map<Role, Entry> entries_;
};

/// Takes a calibration out of entries.
class YamlCalibration {
public:
    YamlCalibration(const YamlReader& reader, std::map<Role, Entry> entries, const std::string& name)
        : reader_(reader), entries_(std::move(entries)), name_(name) {}

    CalibrationRecord take(const KnownSizes& sizes) {
        CalibrationRecord record;
        ProcamCalibration& result = record.result;
        takeDevice(result.camera, Role::cameraMatrix, Role::cameraDistortion, "camera");
        result.camera.size = sizeOf(Role::cameraWidth, Role::cameraHeight, Role::cameraSize, sizes.camera, "camera");
        if (entries_.contains(Role::projectorMatrix)) {
            takeDevice(result.projector, Role::projectorMatrix, Role::projectorDistortion, "projector");
            result.projector.size =
                sizeOf(Role::projectorWidth, Role::projectorHeight, Role::projectorSize, sizes.projector, "projector");
            takeRig(result);
        }
        result.rms = numberOr(Role::rms, 0.0, 0.0);
        result.camera.rms = numberOr(Role::cameraRms, 0.0, 0.0);
        result.projector.rms = numberOr(Role::projectorRms, 0.0, 0.0);
        record.source.metresPerUnit = numberOr(Role::metresPerUnit, 0.001, 1e-9);
        record.source.date = entries_[Role::date].word;
        record.source.board = entries_[Role::board].word;
        record.source.isSimulated = numberOr(Role::simulated, 0.0, 0.0) != 0.0;
        result.state.camera = result.camera.lens;
        result.state.projector = result.projector.lens;
        result.state.projectorFromCamera = result.projectorFromCamera;
        return record;
    }

private:
    [[noreturn]] void refuseMissing(const std::string& what, const std::string& remedy) const {
        throw DataError(name_, "says nothing of the " + what, remedy);
    }

    /// Throws where numbers and shape do not agree.
    const Entry& entryOfCount(Role role, std::initializer_list<std::size_t> counts, const char* what) {
        const Entry& entry = entries_[role];
        const std::size_t shape = static_cast<std::size_t>(entry.rows) * static_cast<std::size_t>(entry.columns);
        if (entry.rows > 0 && entry.columns > 0 && shape != entry.numbers.size())
            reader_.refuseAt(entry.line, "has " + std::to_string(entry.numbers.size()) + " numbers, not " +
                                             std::to_string(shape) + " as its rows and columns say");
        if (std::ranges::find(counts, entry.numbers.size()) == counts.end())
            reader_.refuseAt(entry.line,
                             "has " + std::to_string(entry.numbers.size()) + " numbers, which is no " + what);
        return entry;
    }

    static cv::Matx33d matrixOf(const Entry& entry) { return cv::Matx33d(entry.numbers.data()); }

    void takeDevice(CalibratedDevice& device, Role matrix, Role distortion, const char* what) {
        if (!entries_.contains(matrix))
            refuseMissing(what + std::string("'s matrix"),
                          "write cameraMatrix1 (camera) and cameraMatrix2 (projector)");
        const Entry& intrinsics = entryOfCount(matrix, {9}, "3 x 3 matrix");
        if (const std::string problem = setIntrinsics(device, matrixOf(intrinsics)); !problem.empty())
            reader_.refuseAt(intrinsics.line, problem);
        device.model = "imported";
        if (!entries_.contains(distortion)) return;
        const Entry& terms = entryOfCount(distortion, {0, 4, 5, 8, 12, 14}, "distortion of OpenCV");
        if (const std::string problem = setDistortion(device, terms.numbers); !problem.empty())
            reader_.refuseAt(terms.line, problem);
    }

    cv::Size sizeOf(Role width, Role height, Role both, cv::Size known, const char* what) {
        std::vector<double> sides;
        int line = 0;
        if (entries_.contains(both)) {
            sides = entryOfCount(both, {2}, "width and height").numbers;
            line = entries_[both].line;
        } else if (entries_.contains(width) && entries_.contains(height)) {
            sides = {entryOfCount(width, {1}, "width").numbers[0], entryOfCount(height, {1}, "height").numbers[0]};
            line = entries_[width].line;
        }
        if (sides.empty() && !known.empty()) return known;
        if (sides.empty())
            refuseMissing(what + std::string("'s size"), "add " + std::string(what) + "_width and " + what + "_height");
        for (const double side : sides)
            if (!(side >= 1.0 && side <= kMostPixels && side == std::floor(side)))
                reader_.refuseAt(line, "is no width and height in pixels");
        return {static_cast<int>(sides[0]), static_cast<int>(sides[1])};
    }

    void takeRig(ProcamCalibration& result) {
        if (!entries_.contains(Role::rotation) || !entries_.contains(Role::translation))
            refuseMissing("projector's place", "write R and T, from the camera's frame to the projector's");
        const Entry& rotation = entryOfCount(Role::rotation, {9, 3}, "rotation");
        const Entry& shift = entryOfCount(Role::translation, {3}, "translation");
        cv::Matx33d matrix;
        if (rotation.numbers.size() == 9)
            matrix = matrixOf(rotation);
        else
            cv::Rodrigues(cv::Vec3d(rotation.numbers.data()), matrix);
        if (const std::string problem = setRig(result, matrix, cv::Vec3d(shift.numbers.data())); !problem.empty())
            reader_.refuseAt(rotation.line, problem);
    }

    double numberOr(Role role, double otherwise, double least) {
        if (!entries_.contains(role)) return otherwise;
        const double number = entryOfCount(role, {1}, "single number").numbers[0];
        if (!(number >= least)) reader_.refuseAt(entries_[role].line, "is out of range");
        return number;
    }

    const YamlReader& reader_;
    std::map<Role, Entry> entries_;
    const std::string& name_;
};

std::string exactText(double number) {
    char text[40];
    const auto end = std::to_chars(text, text + sizeof text, number);
    std::string written(text, end.ptr);
    // OpenCV takes a number without a point for a whole one.
    if (written.find_first_of(".e") == std::string::npos) written += '.';
    return written;
}

void addMatrix(std::string& text, const char* key, int rows, const std::vector<double>& numbers) {
    text += std::string(key) + ": !!opencv-matrix\n   rows: " + std::to_string(rows) +
            "\n   cols: " + std::to_string(static_cast<int>(numbers.size()) / rows) + "\n   dt: d\n   data: [ ";
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        if (!std::isfinite(numbers[i]))
            throw InvalidInput("calibration", "holds a number that is not finite", "calibrate again");
        text += (i == 0 ? "" : i % 3 == 0 ? ",\n       " : ", ") + exactText(numbers[i]);
    }
    text += " ]\n";
}

void addDevice(std::string& text, const CalibratedDevice& device, const char* matrix, const char* distortion) {
    const Lens& lens = device.lens;
    addMatrix(text, matrix, 3,
              {lens[kFocalLength], 0.0, lens[kPrincipalX], 0.0, lens[kFocalLength] * lens[kAspect], lens[kPrincipalY],
               0.0, 0.0, 1.0});
    addMatrix(text, distortion, 1, {lens[kK1], lens[kK2], lens[kP1], lens[kP2], lens[kK3]});
}

/// A text in double quotes that no reader can misread.
std::string quotedWord(const std::string& word) {
    std::string text = "\"";
    for (const char c : word) text += c == '"' || c == '\\' || static_cast<unsigned char>(c) < 32 ? '?' : c;
    return text + "\"";
}

} // namespace

std::string calibrationYaml(const CalibrationRecord& record) {
    const ProcamCalibration& result = record.result;
    std::string text = "%YAML:1.0\n---\n";
    const auto number = [&text](const char* key, double value) {
        text += std::string(key) + ": " + exactText(std::isfinite(value) ? value : 0.0) + "\n";
    };
    const auto size = [&text](const char* device, cv::Size pixels) {
        text += std::string(device) + "_width: " + std::to_string(pixels.width) + "\n" + device +
                "_height: " + std::to_string(pixels.height) + "\n";
    };
    if (!record.source.date.empty()) text += "calibration_time: " + quotedWord(record.source.date) + "\n";
    if (!record.source.board.empty()) text += "board: " + quotedWord(record.source.board) + "\n";
    number("metres_per_unit", record.source.metresPerUnit);
    if (record.source.isSimulated) number("simulated", 1.0);
    size("image", result.camera.size);
    addDevice(text, result.camera, "cameraMatrix1", "distCoeffs1");
    number("camera_rms", result.camera.rms);
    if (result.projector.size.empty()) return text;
    size("projector", result.projector.size);
    addDevice(text, result.projector, "cameraMatrix2", "distCoeffs2");
    number("projector_rms", result.projector.rms);
    const PoseVector& rig = result.projectorFromCamera;
    cv::Matx33d rotation;
    cv::Rodrigues(cv::Vec3d(rig[0], rig[1], rig[2]), rotation);
    addMatrix(text, "R", 3, {rotation.val, rotation.val + 9});
    addMatrix(text, "T", 3, {rig[3], rig[4], rig[5]});
    number("rms", result.rms);
    return text;
}

CalibrationRecord parseCalibrationYaml(std::string_view text, const std::string& name, const KnownSizes& sizes) {
    if (text.size() > kMostYamlBytes)
        throw DataError(name, "is larger than a calibration", "choose the file of matrices");
    YamlReader reader(text, name);
    std::map<Role, Entry> entries = reader.read();
    return YamlCalibration(reader, std::move(entries), name).take(sizes);
}

} // namespace lumorph
