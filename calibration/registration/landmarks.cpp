#include "calibration/registration/landmarks.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "calibration/registration/dwells.h"
#include "calibration/registration/landmark_match.h"
#include "calibration/registration/refusing.h"
#include "calibration/registration/steady_tip.h"
#include "calibration/registration/time_unit.h"

namespace lumorph {

namespace {

using registration::eigen;
using registration::number;

constexpr const char* kTouches = "touched points";

constexpr double kRests = 0.0015;        ///< metres within which a tip rests; twice that: a place touched again
constexpr double kWrongTipRests = 0.003; ///< the same of a tip that is elsewhere and swings with the hand
constexpr double kWorst = 0.003;         ///< metres of RMS: beyond, something is wrong
constexpr double kDoubtful = 0.001;      ///< metres
constexpr double kTipOff = 0.002;        ///< metres by which a better tip is worth telling
constexpr std::size_t kMostPlaces = 80;
constexpr double kMostChoices = 4000.0;
constexpr int kRounds = 20;

Finding warning(Cause cause, std::string why, std::string remedy) {
    return {cause, kTouches, {}, std::move(why), std::move(remedy)};
}

std::string millimetres(double metres) { return number(1000.0 * metres, 2) + " mm"; }

/// The pointer as the reference body sees it.
std::vector<TimedPose> inReference(const PoseTrack& pointer, const std::optional<PoseTrack>& reference) {
    std::vector<TimedPose> seen;
    for (const TimedPose& at : pointer.poses) {
        if (!reference) {
            seen.push_back(at);
        } else if (const auto body = poseAt(*reference, at.seconds)) {
            seen.push_back({at.seconds, inverseOf(*body) * at.pose});
        }
    }
    return seen;
}

/// A place that the tip rested at, once or several times.
struct Touched {
    glm::dvec3 place{0.0};
    Pose pointer; ///< in the reference's frame, in the middle of the first dwell
    double samples = 0.0;
};

std::vector<Touched> touchedPlaces(const std::vector<TimedPose>& seen, const glm::dvec3& tip, double radius) {
    std::vector<TimedPlace> tips;
    tips.reserve(seen.size());
    for (const TimedPose& at : seen) tips.push_back({at.seconds, at.pose * tip});
    std::vector<Touched> touched;
    for (const Dwell& dwell : findDwells(tips, 0.8, radius)) {
        const auto count = static_cast<double>(dwell.count);
        const auto same = std::ranges::find_if(
            touched, [&](const Touched& t) { return glm::distance(t.place, dwell.place) < 2.0 * radius; });
        if (same == touched.end()) {
            touched.push_back({dwell.place, seen[dwell.first + dwell.count / 2].pose, count});
            continue;
        }
        same->place = (same->samples * same->place + count * dwell.place) / (same->samples + count);
        same->samples += count;
    }
    return touched;
}

std::vector<glm::dvec3> placesOf(const std::vector<Touched>& touched) {
    std::vector<glm::dvec3> places;
    places.reserve(touched.size());
    for (const Touched& t : touched) places.push_back(t.place);
    return places;
}

/// Calls `run` with as many touched places as the model has points, in the order of both: all choices where they are
/// few, else those without another place between.
template <typename Try> void forEachRun(const std::vector<Touched>& touched, std::size_t points, const Try& run) {
    if (touched.size() < points) return;
    double choices = 1.0;
    for (std::size_t i = 0; i < points; ++i) choices *= double(touched.size() - i) / double(i + 1);
    if (choices > kMostChoices) {
        for (std::size_t first = 0; first + points <= touched.size(); ++first)
            run(std::vector(touched.begin() + std::ptrdiff_t(first), touched.begin() + std::ptrdiff_t(first + points)));
        return;
    }
    std::vector<char> chosen(touched.size(), 0);
    std::fill_n(chosen.begin(), points, 1);
    do {
        std::vector<Touched> of;
        for (std::size_t i = 0; i < touched.size(); ++i)
            if (chosen[i]) of.push_back(touched[i]);
        run(of);
    } while (std::ranges::prev_permutation(chosen).found);
}

/// The tip with which a run of places would fit best: Gauss-Newton over where the model lies and the tip.
struct OtherTip {
    glm::dvec3 tip{0.0};
    double rms = 1e9;
};
OtherTip otherTip(std::span<const Touched> run, std::span<const glm::dvec3> model, const glm::dvec3& start) {
    OtherTip other{start, 1e9};
    for (int round = 0; round < kRounds; ++round) {
        std::vector<glm::dvec3> places;
        for (const Touched& t : run) places.push_back(t.pointer * other.tip);
        const RigidFit fit = fitRigid(places, model);
        other.rms = fit.rms;
        Eigen::Matrix<double, 9, 9> normal = Eigen::Matrix<double, 9, 9>::Zero(); // turn, shift, tip
        Eigen::Matrix<double, 9, 1> right = Eigen::Matrix<double, 9, 1>::Zero();
        for (std::size_t i = 0; i < run.size(); ++i) {
            const glm::dvec3 laid = fit.toFromFrom * places[i], left = laid - model[i];
            const glm::dvec3 arm = laid - fit.toFromFrom.position;
            const glm::dmat3 turn = glm::mat3_cast(fit.toFromFrom.rotation * run[i].pointer.rotation);
            Eigen::Matrix<double, 3, 9> rows;
            rows.leftCols<3>() << 0.0, arm.z, -arm.y, -arm.z, 0.0, arm.x, arm.y, -arm.x, 0.0;
            rows.middleCols<3>(3).setIdentity();
            for (int r = 0; r < 3; ++r)
                for (int c = 0; c < 3; ++c) rows(r, 6 + c) = turn[c][r];
            normal += rows.transpose() * rows;
            right -= rows.transpose() * eigen(left);
        }
        const Eigen::Matrix<double, 9, 1> step = normal.ldlt().solve(right);
        other.tip += glm::dvec3(step[6], step[7], step[8]);
    }
    return other;
}

bool fits(const std::optional<LandmarkMatch>& match, std::size_t points) {
    const std::size_t least = std::max<std::size_t>(3, (3 * points + 3) / 4);
    return match && match->count >= least && match->fit.rms <= kWorst;
}

[[noreturn]] void refuseTip(const glm::dvec3& tip, double rms) {
    registration::refuse(Cause::tipWrong, kTouches,
                         "with this tip the points do not fit; with one at " + number(tip.x, 4) + ", " +
                             number(tip.y, 4) + ", " + number(tip.z, 4) + " they would, by " + millimetres(rms),
                         "calibrate the pointer's tip by pivoting, and give that one");
}

/// Where the pointer was turned while it rested, it tells its tip itself.
void explainByTurns(const std::vector<TimedPose>& seen, std::span<const glm::dvec3> model, const glm::dvec3& tip) {
    const auto steady = steadyTip(seen);
    if (!steady || glm::distance(*steady, tip) < kTipOff) return;
    const std::vector<glm::dvec3> places = placesOf(touchedPlaces(seen, *steady, kRests));
    if (places.size() < 3 || places.size() > kMostPlaces) return;
    if (const auto match = matchLandmarks(places, model); fits(match, model.size())) refuseTip(*steady, match->fit.rms);
}

/// Why nothing fits, as far as the touched places tell; all by the order of the model's points.
[[noreturn]] void explain(const std::vector<Touched>& touched, std::span<const glm::dvec3> model,
                          const glm::dvec3& tip) {
    RigidFit best;
    best.rms = 1e9;
    OtherTip other;
    forEachRun(touched, model.size(), [&](const std::vector<Touched>& run) {
        std::vector<glm::dvec3> places;
        places.reserve(run.size());
        for (const Touched& t : run) places.push_back(t.place);
        try {
            const RigidFit fit = fitRigid(places, model);
            const bool scaled = std::abs(std::log(fit.scale)) > 0.2;
            for (glm::dvec3& place : places) place *= fit.scale;
            if (const double rms = fitRigid(places, model).rms; scaled && rms < kWorst * std::max(1.0, fit.scale))
                registration::refuse(Cause::wrongUnits, kTouches,
                                     "the model is " + number(fit.scale, 3) + " times as large as what was touched",
                                     "write poses, tip and model in metres");
            if (fit.mirrored)
                registration::refuse(Cause::mirrored, kTouches, "the points fit only the model's mirror image",
                                     "write poses and model in right-handed coordinates");
            if (fit.rms < best.rms) best = fit;
            if (const OtherTip better = otherTip(run, model, tip); better.rms < other.rms) other = better;
        } catch (const InvalidInput&) { // a run on a line tells nothing
        }
    });
    if (other.rms < kWorst) refuseTip(other.tip, other.rms);
    registration::refuse(Cause::modelDoesNotFit, kTouches,
                         "no choice of the " + std::to_string(touched.size()) + " touched places fits the model" +
                             (best.rms < 1e8 ? " (best fit " + number(1000.0 * best.rms, 0) + " mm RMS)" : ""),
                         "see that tip and model are the right ones, and touch all points in the model's "
                         "order, a second each");
}

LandmarkFit resultOf(const LandmarkMatch& match, const std::vector<NamedPoint>& model,
                     const std::vector<Touched>& touched, std::span<const glm::dvec3> points, const glm::dvec3& tip) {
    const std::vector<glm::dvec3> places = placesOf(touched);
    LandmarkFit result;
    result.modelFromReference = match.fit.toFromFrom;
    result.rms = match.fit.rms;
    for (std::size_t m = 0; m < model.size(); ++m) {
        Landmark landmark{model[m].name, match.placeOf[m].has_value(), {}, {}, points[m], 0.0, 0.0};
        if (landmark.touched) {
            landmark.touchedAt = places[*match.placeOf[m]];
            const glm::dquat& held = touched[*match.placeOf[m]].pointer.rotation;
            landmark.pointer = {landmark.touchedAt - held * tip, held};
            landmark.error = glm::distance(result.modelFromReference * landmark.touchedAt, points[m]);
            std::vector<glm::dvec3> from, to;
            for (std::size_t k = 0; k < model.size(); ++k)
                if (k != m && match.placeOf[k]) {
                    from.push_back(places[*match.placeOf[k]]);
                    to.push_back(points[k]);
                }
            try {
                landmark.leaveOneOut = glm::distance(fitRigid(from, to).toFromFrom * landmark.touchedAt, points[m]);
            } catch (const InvalidInput&) {
                landmark.leaveOneOut = landmark.error; // the others lie on a line
            }
        }
        result.points.push_back(std::move(landmark));
    }
    const auto worst = std::ranges::max_element(result.points, {}, &Landmark::leaveOneOut);
    result.worst = static_cast<std::size_t>(worst - result.points.begin());
    return result;
}

void warn(LandmarkFit& result, const LandmarkMatch& match) {
    std::string missed;
    for (const Landmark& landmark : result.points)
        if (!landmark.touched) missed += (missed.empty() ? "" : ", ") + landmark.name;
    if (!missed.empty())
        result.warnings.push_back(
            warning(Cause::tooFewPoints, "not touched, or elsewhere: " + missed, "touch them again, a second each"));
    if (match.ambiguous)
        result.warnings.push_back(warning(Cause::pointsDegenerate, "the model fits as well turned otherwise",
                                          "touch its points in their order, or add one that makes it uneven"));
    else if (!match.inOrder)
        result.warnings.push_back(warning(Cause::wrongOrder,
                                          "the points were touched in another order than the model's",
                                          "nothing, if the errors are small: they were told apart by their distances"));
    const Landmark& worst = result.points[result.worst];
    if (result.rms > kDoubtful || worst.leaveOneOut > 3.0 * kDoubtful)
        result.warnings.push_back(warning(Cause::pointSuspicious,
                                          "point " + worst.name + " lies " + millimetres(worst.leaveOneOut) +
                                              " from where the others have it",
                                          "touch it again, and calibrate the pointer's tip"));
}

/// A tip that is a little off spoils the fit without making it impossible.
void warnOfTip(LandmarkFit& result, const std::vector<Touched>& touched, const LandmarkMatch& match,
               std::span<const glm::dvec3> points, const glm::dvec3& tip) {
    if (match.count < 5 || result.rms < kDoubtful) return;
    std::vector<Touched> run;
    std::vector<glm::dvec3> model;
    for (std::size_t m = 0; m < points.size(); ++m)
        if (match.placeOf[m]) {
            run.push_back(touched[*match.placeOf[m]]);
            model.push_back(points[m]);
        }
    const OtherTip other = otherTip(run, model, tip);
    if (other.rms < 0.5 * result.rms && glm::distance(other.tip, tip) > kTipOff)
        result.warnings.push_back(warning(Cause::tipWrong,
                                          "a tip " + millimetres(glm::distance(other.tip, tip)) +
                                              " from the given one fits far better (" + millimetres(other.rms) + ")",
                                          "calibrate the pointer's tip by pivoting"));
}

} // namespace

LandmarkFit fitLandmarks(const PoseTrack& recordedPointer, const std::optional<PoseTrack>& recordedReference,
                         const std::vector<NamedPoint>& model, const glm::dvec3& tip) {
    const PoseTrack pointer = inKnownSeconds(recordedPointer, "pointer");
    const std::optional<PoseTrack> reference =
        recordedReference ? std::optional(inKnownSeconds(*recordedReference, "reference")) : std::nullopt;
    if (model.size() < 3)
        registration::refuse(Cause::tooFewPoints, kTouches, "the model has fewer than three points",
                             "give it four or more");
    const std::vector<TimedPose> seen = inReference(pointer, reference);
    if (seen.size() < 20)
        registration::refuse(Cause::tooFewPoints, kTouches, "pointer and reference share fewer than 20 moments",
                             "record both at the same time and by one clock");
    const std::vector<Touched> touched = touchedPlaces(seen, tip, kRests);
    std::vector<glm::dvec3> points;
    points.reserve(model.size());
    for (const NamedPoint& point : model) points.push_back(point.place);
    if (touched.size() < 3) {
        explainByTurns(seen, points, tip);
        registration::refuse(Cause::tooFewPoints, kTouches,
                             "the tip rested at " + std::to_string(touched.size()) + " places only",
                             "hold it still on each point for a second; see that its tip is the right one");
    }
    if (touched.size() > kMostPlaces)
        registration::refuse(Cause::modelDoesNotFit, kTouches, "the tip rested at more than 80 places",
                             "record the model's points alone");
    const std::vector<glm::dvec3> places = placesOf(touched);
    const std::optional<LandmarkMatch> match = matchLandmarks(places, points);
    if (!fits(match, points.size())) {
        explainByTurns(seen, points, tip);
        explain(touchedPlaces(seen, tip, kWrongTipRests), points, tip);
    }
    LandmarkFit result = resultOf(*match, model, touched, points, tip);
    warn(result, *match);
    warnOfTip(result, touched, *match, points, tip);
    for (const auto* track : {&pointer, reference ? &*reference : nullptr})
        if (track) result.warnings.insert(result.warnings.end(), track->warnings.begin(), track->warnings.end());
    return result;
}

} // namespace lumorph
