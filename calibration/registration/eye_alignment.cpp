#include "calibration/registration/eye_alignment.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "calibration/registration/refusing.h"
#include "core/base/error.h"

namespace lumorph {

namespace {

using registration::eigen;
using registration::kDegree;
using registration::number;

constexpr const char* kAlignments = "alignments of the eye";

constexpr std::size_t kFewestAlignments = 8;
constexpr double kShortestSight = 0.06;        ///< metres from mark to tip, in the mean
constexpr double kLeastAround = 4.0 * kDegree; ///< spread of the lines of sight in the head's frame
constexpr double kEyeAstray = 0.02;            ///< metres by which a single line misses the eye
constexpr double kFarthestEye = 0.4;           ///< metres from the head's body
constexpr double kWander = 0.01;               ///< metres: nobody holds head and hand still
constexpr double kEyeOpen = 0.012;             ///< metres of sigma: more says nothing

/// Lines of sight in the head's frame.
struct Line {
    glm::dvec3 tip, direction; ///< towards the eye
    double length = 0.0;       ///< metres from mark to tip
};

std::vector<Line> linesOf(const SightRows& alignments, const Pose& worldFromTracker, const glm::dvec3& tip) {
    std::vector<Line> lines;
    for (const registration::SightRow& row : alignments.rows) {
        const glm::dvec3 from = inverseOf(worldFromTracker * row.head) * row.mark, to = row.pointer * tip;
        lines.push_back({to, glm::normalize(to - from), glm::distance(from, to)});
    }
    return lines;
}

void checkLines(const std::vector<Line>& lines) {
    double length = 0.0;
    glm::dvec3 mean(0.0);
    for (const Line& line : lines) {
        length += line.length / double(lines.size());
        mean += line.direction;
    }
    if (length < kShortestSight)
        registration::refuse(Cause::pointsDegenerate, kAlignments,
                             "the tip was held " + number(1000.0 * length, 0) +
                                 " mm from its marks: too near to tell "
                                 "a direction",
                             "hold it a good third of the way from the eye to the mark");
    double squares = 0.0;
    for (const Line& line : lines)
        squares += std::pow(std::acos(std::clamp(glm::dot(line.direction, glm::normalize(mean)), -1.0, 1.0)), 2);
    const double around = std::sqrt(squares / double(lines.size()));
    if (around < kLeastAround)
        registration::refuse(Cause::motionDegenerate, kAlignments,
                             "the head saw all marks in one direction, within " + number(around / kDegree, 1) +
                                 " degrees: how far away the eye is stays open",
                             "take marks on the left and right, near and far, and also turn and tilt the head between "
                             "them");
}

/// The point nearest to all lines, least squares.
glm::dvec3 meetingOf(const std::vector<Line>& lines) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (const Line& line : lines) {
        const Eigen::Vector3d d = eigen(line.direction);
        const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - d * d.transpose();
        normal += across;
        right += across * eigen(line.tip);
    }
    const Eigen::Vector3d at = normal.ldlt().solve(right);
    return {at.x(), at.y(), at.z()};
}

void judgeEye(EyePlace& place, const SightRows& alignments, const registration::Figures& figures) {
    std::size_t astray = 0;
    for (std::size_t i = 0; i < alignments.rows.size(); ++i) {
        const double miss = registration::missOf(alignments.rows[i], figures);
        place.points.push_back({alignments.names[i], miss});
        if (miss < kEyeAstray) continue;
        ++astray;
        place.warnings.push_back({Cause::pointSuspicious,
                                  alignments.names[i],
                                  {},
                                  "it passes the eye by " + number(1000.0 * miss, 0) + " mm",
                                  "it counts for little; align it again, with the same eye as before"});
    }
    place.rms = rmsOf(place.points);
    if (4 * astray > alignments.rows.size() || glm::length(place.eyeFromHead) > kFarthestEye)
        registration::refuse(Cause::modelDoesNotFit, kAlignments,
                             "the lines of sight meet in no eye: they miss by " + number(1000.0 * place.rms, 0) +
                                 " mm, " + number(1000.0 * glm::length(place.eyeFromHead), 0) + " mm from the head",
                             "close the other eye, see that the tracked head is the visitor's, and that pointer and "
                             "tracker are registered");
    const double open = glm::length(place.sigma);
    if (!(open < kEyeOpen))
        registration::refuse(Cause::motionDegenerate, kAlignments,
                             "they leave the eye open by " + number(1000.0 * open, 0) + " mm",
                             "align more marks, and turn and tilt the head between them");
}

/// Where the eye comes to lie with another tip or tracker.
glm::dvec3 eyeWith(const SightRows& alignments, const registration::Figures& figures) {
    return registration::refine({{}, {}, alignments.rows, {}}, figures, {false, false, false, true})
        .figures.eyeFromHead;
}

/// Adds what errors of tip and tracker make of the eye, each by a small step of its own.
void carry(EyePlace& place, const SightRows& alignments, const registration::Figures& figures, const SightBase& base) {
    glm::dvec3 squares = place.sigma * place.sigma;
    double ofTip = 0.0;
    const auto moved = [&](const registration::Figures& other) {
        return eyeWith(alignments, other) - place.eyeFromHead;
    };
    // How the pointer was held in the room, in the mean.
    glm::dmat3 held(0.0);
    for (const registration::SightRow& row : alignments.rows)
        held += glm::mat3_cast(figures.worldFromTracker.rotation * row.head.rotation * row.pointer.rotation) /
                double(alignments.rows.size());
    for (int axis = 0; axis < 3; ++axis) {
        const auto along = [axis](double size) {
            glm::dvec3 way(0.0);
            way[axis] = size;
            return way;
        };
        registration::Figures other = figures;
        const glm::dvec3 tip = along(base.tip.sigma[axis]);
        other.tip += tip;
        other.worldFromTracker.position -= base.tipShare * (held * tip);
        const glm::dvec3 byTip = moved(other);
        squares += byTip * byTip;
        ofTip += glm::dot(byTip, byTip);
        other = figures;
        other.worldFromTracker.position += along(base.trackerShift);
        const glm::dvec3 byShift = moved(other);
        other = figures;
        other.worldFromTracker = Pose{{}, rotationOfTurn(along(base.trackerTurn))} * figures.worldFromTracker;
        const glm::dvec3 byTurn = moved(other);
        squares += byShift * byShift + byTurn * byTurn;
    }
    place.sigma = glm::sqrt(squares);
    place.tipSigma = std::sqrt(ofTip);
}

} // namespace

SightRows rowsOf(std::span<const Alignment> alignments, const glm::dvec3& tip, const CaptureFault* undo) {
    SightRows all;
    for (const Alignment& alignment : alignments) {
        if (!alignment.touch.body)
            registration::refuse(Cause::trackerLost, alignment.touch.name.c_str(), "the head was not recorded",
                                 "track the head while the visitor aims");
        const Rest rest = restOf(withoutFault(alignment.touch, undo), tip, kWander);
        registration::SightRow row;
        row.pointer = rest.pointer;
        row.head = rest.body;
        row.mark = alignment.mark;
        row.tipSigma = std::hypot(row.tipSigma, noiseOf(rest));
        all.rows.push_back(row);
        all.names.push_back(alignment.touch.name);
        all.warnings.insert(all.warnings.end(), rest.warnings.begin(), rest.warnings.end());
    }
    return all;
}

EyePlace placeEye(const SightRows& alignments, const Pose& worldFromTracker, const SightBase& base,
                  const Progress& progress) {
    const glm::dvec3& tip = base.tip.tip;
    if (alignments.rows.size() < kFewestAlignments)
        registration::refuse(Cause::tooFewPoints, kAlignments,
                             std::to_string(alignments.rows.size()) + " alignments are too few", "aim at eight marks");
    const std::vector<Line> lines = linesOf(alignments, worldFromTracker, tip);
    checkLines(lines);
    const registration::Figures start{worldFromTracker, tip, {}, meetingOf(lines)};
    const registration::Refined refined =
        registration::refine({{}, {}, alignments.rows, {}}, start, {false, false, false, true}, progress);
    EyePlace place;
    place.eyeFromHead = refined.figures.eyeFromHead;
    place.sigma = refined.sigmas.eye;
    place.warnings = alignments.warnings;
    judgeEye(place, alignments, refined.figures);
    carry(place, alignments, refined.figures, base);
    return place;
}

} // namespace lumorph
