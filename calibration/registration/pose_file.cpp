#include "calibration/registration/pose_file.h"

#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <set>
#include <span>

#include <glm/geometric.hpp>

#include "calibration/registration/pose_columns.h"
#include "calibration/registration/recording_check.h"
#include "core/base/text.h"

namespace lumorph {

namespace {

constexpr double kFarthest = 200.0;     ///< metres: no tracker sees farther
constexpr double kNormTolerance = 0.02; ///< of a quaternion: printed with two digits it still passes
constexpr std::size_t kMostRows = 5'000'000;

constexpr std::string_view kBlanks = " \t\r\v\f";
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(kBlanks);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

std::string_view withoutQuotes(std::string_view text) {
    const bool quoted = text.size() > 1 && text.front() == '"' && text.back() == '"';
    return quoted ? trimmed(text.substr(1, text.size() - 2)) : text;
}

/// Calls `row(line, its comment, "file, line n")` for each line that has something on it.
template <typename Row> void forEachRow(std::string_view text, const std::string& name, const Row& row) {
    if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
        throw DataError(name, "it is text in UTF-16", "save it as UTF-8");
    if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
    const char ending = text.find('\n') == std::string_view::npos ? '\r' : '\n';
    std::size_t number = 0;
    while (!text.empty()) {
        const std::size_t end = text.find(ending);
        const std::string_view line = text.substr(0, end);
        text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
        if (++number > kMostRows)
            throw DataError(name, "it has more than five million lines", "cut the recording into shorter ones");
        const std::size_t hash = line.find('#');
        const std::string_view comment = hash == std::string_view::npos ? "" : trimmed(line.substr(hash + 1));
        const std::string_view data = trimmed(line.substr(0, hash));
        if (!data.empty() || !comment.empty()) row(data, comment, name + ", line " + std::to_string(number));
    }
}

std::optional<double> numberOf(std::string_view field) {
    std::array<char, 64> text{};
    if (field.starts_with('+')) field.remove_prefix(1);
    if (field.empty() || field.size() > text.size()) return std::nullopt;
    std::size_t commas = 0;
    for (std::size_t i = 0; i < field.size(); ++i) {
        text[i] = field[i] == ',' ? '.' : field[i];
        commas += field[i] == ',' ? 1 : 0;
    }
    double value = 0.0;
    const auto [next, error] = std::from_chars(text.data(), text.data() + field.size(), value);
    const bool whole = error == std::errc() && next == text.data() + field.size();
    return whole && commas < 2 && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

/// Adds one field; several where numbers stand in it with blanks between, as in "1, 2 3".
void addField(std::vector<std::string_view>& fields, std::string_view field) {
    const std::size_t before = fields.size();
    for (std::string_view rest = field; !rest.empty();) {
        const std::size_t end = rest.find_first_of(" \t");
        if (end == std::string_view::npos && rest.size() == field.size()) break;
        if (!numberOf(rest.substr(0, end))) break;
        fields.push_back(rest.substr(0, end));
        if (end == std::string_view::npos) return;
        rest = trimmed(rest.substr(end));
    }
    fields.resize(before);
    fields.push_back(field);
}

/// Whether each comma stands between two digits, as that of a decimal number does.
bool areDecimal(std::string_view line) {
    for (std::size_t at = line.find(','); at != std::string_view::npos; at = line.find(',', at + 1)) {
        const auto isDigit = [&](std::size_t i) { return i < line.size() && line[i] >= '0' && line[i] <= '9'; };
        if (at == 0 || !isDigit(at - 1) || !isDigit(at + 1)) return false;
    }
    return true;
}

/// What stands between the separators of a line: semicolons, else commas, else blanks. Beside semicolons, and beside
/// tabs where all of them may be so, a comma is a part of a number. What ends with a separator has nothing behind it.
void splitInto(std::vector<std::string_view>& fields, std::string_view line) {
    fields.clear();
    std::string_view separators;
    if (line.find(';') != std::string_view::npos)
        separators = ";";
    else if (line.find(',') != std::string_view::npos)
        separators = line.find('\t') != std::string_view::npos && areDecimal(line) ? "\t" : ",";
    const std::string_view ends = separators.empty() ? " \t" : separators;
    for (line = trimmed(line); !line.empty();) {
        const std::size_t quote = line.front() == '"' ? line.find('"', 1) : 0;
        const std::size_t end = line.find_first_of(ends, quote == std::string_view::npos ? 0 : quote);
        addField(fields, withoutQuotes(trimmed(line.substr(0, end))));
        if (end == std::string_view::npos) return;
        line = separators.empty() ? trimmed(line.substr(end)) : trimmed(line.substr(end + 1));
    }
}

/// Names of columns may have blanks in them where commas, semicolons or tabs stand between.
std::vector<std::string_view> namesOf(std::string_view line) {
    std::vector<std::string_view> names;
    for (const char separator : {';', ',', '\t'}) {
        if (line.find(separator) == std::string_view::npos) continue;
        while (true) {
            const std::size_t end = line.find(separator);
            names.push_back(withoutQuotes(trimmed(line.substr(0, end))));
            if (end == std::string_view::npos) return names;
            line.remove_prefix(end + 1);
        }
    }
    splitInto(names, line);
    return names;
}

bool takeNumbers(std::span<const std::string_view> fields, std::span<double> numbers) {
    if (fields.size() != numbers.size()) return false;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const auto number = numberOf(fields[i]);
        if (!number) return false;
        numbers[i] = *number;
    }
    return true;
}

/// Head rows and comments of a file, and which of its columns are what.
class Columns {
public:
    explicit Columns(std::size_t usual) : usual_(usual) {}

    void readComment(std::string_view comment) {
        if (hasData_) return;
        if (const auto named = columnsByName(namesOf(comment))) named_ = named;
    }
    /// Whether it is a head row, of which there is one at most.
    [[nodiscard]] bool readHead(std::string_view line) {
        if (hasData_) return false;
        hasData_ = true;
        const std::vector<std::string_view> names = namesOf(line);
        if (names.size() < usual_) return false;
        for (const std::string_view name : names)
            if (numberOf(name)) return false;
        if (const auto named = columnsByName(names)) named_ = named;
        return true;
    }
    /// The fields of time (where there is one), place and quaternion, x first; nothing where there are others.
    [[nodiscard]] std::optional<std::vector<std::string_view>> ordered(std::string_view line) {
        splitInto(fields_, line);
        if (!named_) return fields_;
        std::vector<std::string_view> ordered;
        for (const std::size_t column : named_->columns) {
            if (column >= fields_.size()) return std::nullopt;
            ordered.push_back(fields_[column]);
        }
        return ordered;
    }
    /// Seconds and metres of one.
    [[nodiscard]] double timeUnit() const { return named_ ? named_->timeUnit : 1.0; }
    [[nodiscard]] double lengthUnit() const { return named_ ? named_->lengthUnit : 1.0; }

private:
    std::size_t usual_;
    std::optional<PoseColumns> named_;
    std::vector<std::string_view> fields_;
    bool hasData_ = false;
};

/// Of place and quaternion.
Pose poseOf(std::span<const double, 7> n, double lengthUnit, const std::string& place) {
    const glm::dquat rotation(n[6], n[3], n[4], n[5]); // glm takes w first
    const double length = glm::length(rotation);
    if (std::abs(length - 1.0) > kNormTolerance)
        throw DataError(place, "its last four numbers are no rotation: their length as a quaternion is not 1",
                        "write the quaternion as qx, qy, qz, qw");
    const Pose pose{lengthUnit * glm::dvec3(n[0], n[1], n[2]), rotation / length};
    if (glm::length(pose.position) > kFarthest)
        throw CaptureRefused({Cause::wrongUnits,
                              place,
                              {},
                              "it is farther than 200 m",
                              "write places in metres, not in millimetres, and from an origin that is in the room"});
    return pose;
}

TimedPose timedPoseOf(std::string_view line, Columns& columns, const std::string& place) {
    std::array<double, 8> n{};
    const auto fields = columns.ordered(line);
    if (!fields || !takeNumbers(*fields, n)) {
        const bool isStation = fields && fields->size() == 7;
        throw DataError(place,
                        (isStation ? "it has no time: " : "it is not eight finite numbers: ") + inQuotes(line, 60),
                        std::string("write time, x, y, z, qx, qy, qz, qw with commas or blanks between, in seconds and "
                                    "metres") +
                            (isStation ? "; poses that stood still are solved with --stations, without times" : ""));
    }
    return {n[0] * columns.timeUnit(), poseOf(std::span(n).last<7>(), columns.lengthUnit(), place)};
}

/// Seconds since 1970 are no larger than this, and milliseconds no smaller.
constexpr double kFarthestTime = 1e11;

/// Only clocks that count from 1970 are that far: then the unit is certain.
void bringToSeconds(PoseTrack& track, const std::string& name) {
    const double last = std::abs(track.poses.back().seconds);
    if (last < kFarthestTime) return;
    const bool milli = last < 1e3 * kFarthestTime, micro = last < 1e6 * kFarthestTime;
    const double unit = milli ? 1e-3 : micro ? 1e-6 : 1e-9;
    for (TimedPose& at : track.poses) at.seconds *= unit;
    track.warnings.push_back({Cause::timeUnit,
                              name,
                              {},
                              std::string("its times are ") +
                                  (milli   ? "milliseconds"
                                   : micro ? "microseconds"
                                           : "nanoseconds") +
                                  " since 1970",
                              "they were taken as that; write seconds"});
}

} // namespace

PoseTrack parsePoseTrack(std::string_view text, const std::string& name) {
    PoseTrack track;
    std::vector<std::string> places;
    Columns columns(8);
    forEachRow(text, name, [&](std::string_view line, std::string_view comment, const std::string& place) {
        if (!comment.empty()) columns.readComment(comment);
        if (line.empty() || columns.readHead(line)) return;
        track.poses.push_back(timedPoseOf(line, columns, place));
        places.push_back(place);
    });
    if (track.poses.size() < 2)
        throw CaptureRefused(
            {Cause::tooFewPoints, name, {}, "it has fewer than two poses", "record the body while it moves"});
    bringToSeconds(track, name);
    return inTimeOrder(track, name, places);
}

std::vector<NamedPoint> parseNamedPoints(std::string_view text, const std::string& name) {
    std::vector<NamedPoint> points;
    std::set<std::string> names;
    std::vector<std::string_view> fields;
    forEachRow(text, name, [&](std::string_view line, std::string_view, const std::string& place) {
        if (line.empty()) return;
        const std::size_t comma = line.find_first_of(line.find(';') == std::string_view::npos ? ",\t" : ";");
        std::array<double, 3> n{};
        if (comma != std::string_view::npos) splitInto(fields, line.substr(comma + 1));
        if (comma == std::string_view::npos || comma == 0 || !takeNumbers(fields, n))
            throw DataError(place, "it is not a name and three finite numbers: " + inQuotes(line, 60),
                            "write name, x, y, z with commas, in metres");
        const std::string of(withoutQuotes(trimmed(line.substr(0, comma))));
        if (!names.insert(of).second)
            throw DataError(place, "there is a point " + inQuotes(of) + " before it",
                            "give each point a name of its own");
        points.push_back({of, {n[0], n[1], n[2]}});
    });
    return points;
}

std::vector<Station> parseStations(std::string_view text, const std::string& name) {
    std::vector<Station> stations;
    std::set<std::string> names;
    Columns columns(7);
    forEachRow(text, name, [&](std::string_view line, std::string_view comment, const std::string& place) {
        if (!comment.empty()) columns.readComment(comment);
        if (line.empty() || columns.readHead(line)) return;
        std::array<double, 7> n{};
        auto fields = columns.ordered(line);
        std::string of = std::to_string(stations.size() + 1);
        if (fields && fields->size() == 8) {
            of = fields->front();
            fields->erase(fields->begin());
        }
        if (!fields || !takeNumbers(*fields, n))
            throw DataError(place, "it is not seven finite numbers, or a name and seven: " + inQuotes(line, 60),
                            "write x, y, z, qx, qy, qz, qw with commas or blanks between, in metres");
        if (!names.insert(of).second)
            throw DataError(place, "there is a station " + inQuotes(of) + " before it",
                            "give each station a name of its own, or none");
        stations.push_back({of, poseOf(n, columns.lengthUnit(), place)});
    });
    return stations;
}

} // namespace lumorph
