#include "calibration/registration/pose_track.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>
#include <span>

#include <glm/geometric.hpp>

#include "core/base/text.h"

namespace lumorph {

namespace {

constexpr double kFarthest = 200.0;     ///< metres: no tracker sees farther
constexpr double kNormTolerance = 0.02; ///< of a quaternion: printed with two digits it still passes
constexpr std::size_t kMostRows = 5'000'000;

constexpr std::string_view kBlanks = " \t\r";

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(kBlanks);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

/// Calls `row(line without comment, "file, line n")` for each line that has something on it.
template <typename Row> void forEachRow(std::string_view text, const std::string& name, const Row& row) {
    std::size_t number = 0;
    while (!text.empty()) {
        const std::size_t end = text.find('\n');
        std::string_view line = text.substr(0, end);
        text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
        if (++number > kMostRows)
            throw DataError(name, "it has more than five million lines", "cut the recording into shorter ones");
        line = trimmed(line.substr(0, line.find('#')));
        if (!line.empty()) row(line, name + ", line " + std::to_string(number));
    }
}

/// The next number and the comma or blank behind it.
std::optional<double> takeNumber(std::string_view& line, bool last) {
    line = trimmed(line);
    double value = 0.0;
    const auto [next, error] = std::from_chars(line.data(), line.data() + line.size(), value);
    if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
    const std::string_view rest = line.substr(static_cast<std::size_t>(next - line.data()));
    line = trimmed(rest);
    if (last) return line.empty() ? std::optional(value) : std::nullopt;
    if (line.empty()) return std::nullopt;
    if (line.front() == ',')
        line.remove_prefix(1);
    else if (line.size() == rest.size())
        return std::nullopt;
    return value;
}

bool takeNumbers(std::string_view line, std::span<double> numbers) {
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const auto number = takeNumber(line, i + 1 == numbers.size());
        if (!number) return false;
        numbers[i] = *number;
    }
    return true;
}

TimedPose timedPoseOf(std::string_view line, const std::string& place) {
    double n[8] = {};
    if (!takeNumbers(line, n))
        throw DataError(place, "it is not eight finite numbers: " + inQuotes(line, 60),
                        "write time, x, y, z, qx, qy, qz, qw with commas or blanks between, in seconds and metres");
    const glm::dquat rotation(n[7], n[4], n[5], n[6]); // glm takes w first
    const double length = glm::length(rotation);
    if (std::abs(length - 1.0) > kNormTolerance)
        throw DataError(place, "its last four numbers are no rotation: their length as a quaternion is not 1",
                        "write the quaternion as qx, qy, qz, qw");
    return {n[0], {{n[1], n[2], n[3]}, rotation / length}};
}

[[noreturn]] void refuse(Cause cause, const std::string& place, std::string why, std::string remedy) {
    throw CaptureRefused({cause, place, {}, std::move(why), std::move(remedy)});
}

} // namespace

PoseTrack parsePoseTrack(std::string_view text, const std::string& name) {
    PoseTrack track;
    std::size_t doubled = 0;
    std::string firstDoubled;
    forEachRow(text, name, [&](std::string_view line, const std::string& place) {
        const TimedPose pose = timedPoseOf(line, place);
        if (glm::length(pose.pose.position) > kFarthest)
            refuse(Cause::wrongUnits, place, "it is farther than 200 m", "write places in metres, not in millimetres");
        if (!track.poses.empty() && pose.seconds == track.poses.back().seconds) {
            if (doubled++ == 0) firstDoubled = place;
            return;
        }
        if (!track.poses.empty() && pose.seconds < track.poses.back().seconds)
            refuse(Cause::clockJumps, place, "its time is before that of the row before",
                   "record again while the tracker's clock runs evenly, or cut the recording there");
        track.poses.push_back(pose);
    });
    if (track.poses.size() < 2)
        refuse(Cause::tooFewPoints, name, "it has fewer than two poses", "record the body while it moves");
    if (doubled > 0)
        track.warnings.push_back(
            {Cause::doubledRows,
             name,
             {},
             std::to_string(doubled) + " rows have the time of the row before, first " + firstDoubled,
             "they are left out; record each pose once, with its time to the millisecond"});
    return track;
}

std::vector<NamedPoint> parseNamedPoints(std::string_view text, const std::string& name) {
    std::vector<NamedPoint> points;
    std::set<std::string> names;
    forEachRow(text, name, [&](std::string_view line, const std::string& place) {
        const std::size_t comma = line.find(',');
        double n[3] = {};
        if (comma == std::string_view::npos || comma == 0 || !takeNumbers(line.substr(comma + 1), n))
            throw DataError(place, "it is not a name and three finite numbers: " + inQuotes(line, 60),
                            "write name, x, y, z with commas, in metres");
        const std::string of(trimmed(line.substr(0, comma)));
        if (!names.insert(of).second)
            throw DataError(place, "there is a point " + inQuotes(of) + " before it",
                            "give each point a name of its own");
        points.push_back({of, {n[0], n[1], n[2]}});
    });
    return points;
}

std::optional<Pose> poseAt(const PoseTrack& track, double seconds, double longestGap) {
    const auto after = std::ranges::lower_bound(track.poses, seconds, {}, &TimedPose::seconds);
    if (after == track.poses.end()) return std::nullopt;
    if (after->seconds == seconds) return after->pose;
    if (after == track.poses.begin()) return std::nullopt;
    const TimedPose& from = *std::prev(after);
    if (after->seconds - from.seconds > longestGap) return std::nullopt;
    const double share = (seconds - from.seconds) / (after->seconds - from.seconds);
    return Pose{glm::mix(from.pose.position, after->pose.position, share),
                glm::slerp(from.pose.rotation, after->pose.rotation, share)};
}

double angleOf(const glm::dquat& rotation) {
    return 2.0 * std::atan2(glm::length(glm::dvec3(rotation.x, rotation.y, rotation.z)), std::abs(rotation.w));
}

glm::dvec3 turnOf(const glm::dquat& rotation) {
    const glm::dvec3 axis = glm::dvec3(rotation.x, rotation.y, rotation.z) * (rotation.w < 0.0 ? -1.0 : 1.0);
    const double sine = glm::length(axis);
    if (sine < 1e-12) return 2.0 * axis;
    return axis * (angleOf(rotation) / sine);
}

glm::dquat rotationOfTurn(const glm::dvec3& turn) {
    const double angle = glm::length(turn);
    if (angle < 1e-12) return glm::normalize(glm::dquat(1.0, 0.5 * turn.x, 0.5 * turn.y, 0.5 * turn.z));
    const glm::dvec3 axis = turn * (std::sin(0.5 * angle) / angle);
    return {std::cos(0.5 * angle), axis.x, axis.y, axis.z};
}

} // namespace lumorph
