#include "calibration/registration/hand_eye_stations.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "calibration/registration/hand_eye_attempt.h"
#include "calibration/registration/refusing.h"

namespace lumorph {

namespace {

using registration::kDegree;
using registration::number;

using hand_eye::Attempt;
using hand_eye::Deviation;
using hand_eye::Fit;
using hand_eye::Free;
using hand_eye::Names;
using hand_eye::Unknowns;

constexpr const char* kStations = "stations of two bodies";
constexpr std::size_t kFewestStations = 6;
constexpr std::size_t kFewestOfHalves = 12;
constexpr double kStationFar = 0.003,
                 kStationTurned = 0.5 * kDegree; ///< at least, of a station that the others contradict
constexpr double kStationStrays = 5.0;           ///< times the median
constexpr double kMostStrayStations = 0.3;       ///< of all

/// Stations of both, in one order; their times are their numbers.
struct Pairs {
    PoseTrack a, b;
    std::vector<std::string> names;
    std::vector<Finding> warnings;

    void add(const std::string& name, const Pose& inA, const Pose& inB) {
        a.poses.push_back({double(names.size()), inA});
        b.poses.push_back({double(names.size()), inB});
        names.push_back(name);
    }
};

Pairs pairsOf(std::span<const Station> a, std::span<const Station> b) {
    Pairs pairs;
    std::map<std::string, const Station*> byName;
    for (const Station& station : b) byName.emplace(station.name, &station);
    std::string alone;
    for (const Station& station : a)
        if (const auto same = byName.find(station.name); same != byName.end())
            pairs.add(station.name, station.pose, same->second->pose);
        else
            alone += (alone.empty() ? "" : ", ") + station.name;
    if (pairs.names.size() < std::min(a.size(), b.size()) && pairs.names.size() < kFewestStations &&
        a.size() == b.size()) {
        pairs = {};
        for (std::size_t i = 0; i < a.size(); ++i) pairs.add(a[i].name, a[i].pose, b[i].pose);
        return pairs;
    }
    const std::size_t unpaired = a.size() + b.size() - 2 * pairs.names.size();
    if (unpaired > 0)
        pairs.warnings.push_back({Cause::trackerLost,
                                  kStations,
                                  {},
                                  std::to_string(unpaired) + " stations are in one of the recordings alone" +
                                      (alone.empty() ? "" : ": " + alone.substr(0, 80)),
                                  "they count for nothing; name or number the stations in both"});
    return pairs;
}

Pairs pairsLeft(const Pairs& pairs, const std::vector<bool>& left) {
    Pairs kept;
    kept.warnings = pairs.warnings;
    for (std::size_t i = 0; i < pairs.names.size(); ++i)
        if (!left[i]) kept.add(pairs.names[i], pairs.a.poses[i].pose, pairs.b.poses[i].pose);
    return kept;
}

/// Leaves out what the rest contradicts; whether there was any.
bool leaveOutStrays(Pairs& pairs, const Attempt& attempt) {
    std::vector<bool> left(pairs.names.size(), false);
    std::vector<Finding> warnings;
    for (const Deviation& d : attempt.deviations) {
        const double far = glm::length(d.place), turned = glm::length(d.turn);
        if (far < std::max(kStationFar, kStationStrays * attempt.medianShift) &&
            turned < std::max(kStationTurned, kStationStrays * attempt.medianTurn))
            continue;
        left[d.pose] = true;
        warnings.push_back({Cause::pointSuspicious,
                            kStations,
                            {},
                            "station " + pairs.names[d.pose] + " is " + number(1000.0 * far, 0) + " mm and " +
                                number(turned / kDegree, 1) + " degrees from where the others have it",
                            "it counts for nothing; record it again, both bodies at rest"});
    }
    if (warnings.empty() || double(warnings.size()) > kMostStrayStations * double(pairs.names.size()) ||
        pairs.names.size() - warnings.size() < kFewestStations)
        return false;
    pairs = pairsLeft(pairs, left);
    pairs.warnings.insert(pairs.warnings.end(), warnings.begin(), warnings.end());
    return true;
}

void judgeStations(HandEye& result, const Pairs& pairs, const Attempt& attempt, const Progress& progress) {
    const Fit fit(pairs.a, pairs.b, progress);
    const std::size_t n = pairs.names.size();
    const double share = double(n - 1) / double(n); // jackknife
    double turn = 0.0, shift = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
        progress.report(double(i) / double(n), "how sure it is");
        const Unknowns one = fit.refined(attempt.solved, attempt.place, {0, n}, {i, i + 1}, Free::poses);
        const Pose change = inverseOf(one.bFromA) * attempt.solved.bFromA;
        turn += share * std::pow(angleOf(change.rotation), 2);
        shift += share * glm::dot(one.bFromA.position - attempt.solved.bFromA.position,
                                  one.bFromA.position - attempt.solved.bFromA.position);
    }
    result.turnSigma = std::sqrt(turn);
    result.shiftSigma = std::sqrt(shift);
    result.halvesTurn = result.halvesShift = std::numeric_limits<double>::quiet_NaN();
    if (n < kFewestOfHalves) return;
    const auto half = [&](std::size_t odd) {
        Pairs some;
        for (std::size_t i = odd; i < n; i += 2) some.add(pairs.names[i], pairs.a.poses[i].pose, pairs.b.poses[i].pose);
        return Fit(some.a, some.b, progress)
            .refined(attempt.solved, attempt.place, {0, some.names.size()}, {}, Free::poses)
            .bFromA;
    };
    const Pose even = half(0), odd = half(1);
    result.halvesTurn = angleOf(glm::conjugate(even.rotation) * odd.rotation);
    result.halvesShift = glm::distance(even.position, odd.position);
}

HandEye solvePairs(Pairs pairs, const Progress& progress) {
    constexpr int kRounds = 3; // what strays much hides what strays less
    const Names names;
    bool isReread = false;
    for (int round = 0;; ++round) {
        const hand_eye::Read read =
            hand_eye::readRecordings({pairs.a, pairs.b, {}, true, names, isReread}, progress.part(0.0, 0.5));
        if (read.other) {
            isReread = true;
            pairs.a = readAs(std::move(pairs.a), read.other->a);
            pairs.b = readAs(std::move(pairs.b), read.other->b);
            const std::vector<Finding> warnings = hand_eye::warningsOf(*read.other, names);
            pairs.warnings.insert(pairs.warnings.end(), warnings.begin(), warnings.end());
            continue;
        }
        const Attempt& attempt = *read.attempt;
        HandEye result = hand_eye::resultOf(attempt);
        if (result.medianTurn > 6.0 * kDegree || result.medianShift > 0.08)
            registration::refuse(Cause::modelDoesNotFit, kStations,
                                 "they do not move as one: stations differ by " +
                                     number(result.medianTurn / kDegree, 1) + " degrees and " +
                                     number(1000.0 * result.medianShift, 0) + " mm",
                                 "see that each row of one is the same station as that row of the other, and that the "
                                 "bodies are joined rigidly");
        if (round < kRounds && leaveOutStrays(pairs, attempt)) continue;
        judgeStations(result, pairs, attempt, progress.part(0.5, 1.0));
        result.warnings = hand_eye::warningsOf(attempt, names);
        result.warnings.insert(result.warnings.end(), pairs.warnings.begin(), pairs.warnings.end());
        return result;
    }
}

} // namespace

HandEye solveHandEyeStations(std::span<const Station> a, std::span<const Station> b, const Progress& progress) {
    const Pairs pairs = pairsOf(a, b);
    if (pairs.names.size() < kFewestStations)
        registration::refuse(Cause::tooFewPoints, kStations,
                             "they share " + std::to_string(pairs.names.size()) + " stations (" +
                                 std::to_string(a.size()) + " of the first, " + std::to_string(b.size()) +
                                 " of the second)",
                             "record 8 to 30, each with one row in both files: in one order, or under one name");
    return solvePairs(pairs, progress);
}

} // namespace lumorph
