#include "calibration/registration/touched_dots.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <opencv2/calib3d.hpp>

#include "calibration/registration/layout_check.h"
#include "calibration/registration/refusing.h"
#include "calibration/registration/rigid_fit.h"

namespace lumorph {

namespace {

using registration::Figures;
using registration::FittedPlace;
using registration::number;
using registration::RayRow;

constexpr const char* kDots = "points between tracker and room";

constexpr double kDotSigma = 0.0007; ///< metres: how well a visitor meets a dot
constexpr std::size_t kFewest = 4, kFewestWithoutTable = 6;
constexpr double kShortest = 0.12;                      ///< metres between the two that are farthest apart
constexpr double kAstray = 0.005;                       ///< metres by which a single point errs too much
constexpr double kOpen = 0.003;                         ///< metres of sigma: more says nothing
constexpr double kLoose = 0.25 * registration::kDegree; ///< of sigma: more shows at the height of a head
constexpr double kLongTip = 0.03; ///< metres from which on a pointer shows on which side it stands

void checkNumber(std::size_t count, std::size_t fewest, const char* more) {
    if (count < fewest)
        registration::refuse(Cause::tooFewPoints, kDots, std::to_string(count) + " points are too few", more);
}

const CalibratedCamera& lensOf(const Installation& room, const TouchedDot& dot) {
    if (dot.projector >= room.projectors.size())
        throw InvalidInput("touched dot", "there is no such projector", "name one of the installation");
    return room.projectors[dot.projector].camera;
}

/// Where the table is known: rays meet it in points.
Pose byTable(const std::vector<RayRow>& rows, const std::vector<glm::dvec3>& places) {
    std::vector<glm::dvec3> met;
    for (const RayRow& row : rows) {
        const double down = row.direction.y;
        if (std::abs(down) < 1e-3)
            registration::refuse(Cause::pointsDegenerate, kDots, "a ray runs along the table",
                                 "show dots on the table");
        met.push_back(row.origin + (*row.height - row.origin.y) / down * row.direction);
    }
    return fitRigid(places, met).toFromFrom;
}

/// Else: the pose of the projector or camera with most rays among the points, by SQPnP (Terzakis and Lourakis 2020).
Pose byPerspective(const std::vector<RayRow>& rows, const std::vector<glm::dvec3>& places) {
    const auto sharing = [&](const glm::dvec3& origin) {
        return std::ranges::count_if(rows, [&](const RayRow& row) { return row.origin == origin; });
    };
    const glm::dvec3 origin =
        std::ranges::max_element(rows, {}, [&](const RayRow& row) { return sharing(row.origin); })->origin;
    glm::dvec3 forward(0.0);
    for (const RayRow& row : rows)
        if (row.origin == origin) forward += glm::normalize(row.direction);
    forward = glm::normalize(forward);
    const glm::dvec3 right =
        glm::normalize(glm::cross(forward, std::abs(forward.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0)));
    const glm::dmat3 worldFromView(right, glm::cross(forward, right), forward);
    std::vector<cv::Point3d> points;
    std::vector<cv::Point2d> seen;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (rows[i].origin != origin) continue;
        const glm::dvec3 d = glm::transpose(worldFromView) * rows[i].direction;
        points.emplace_back(places[i].x, places[i].y, places[i].z);
        seen.emplace_back(d.x / d.z, d.y / d.z);
    }
    cv::Vec3d turn, way;
    if (!cv::solvePnP(points, seen, cv::Matx33d::eye(), cv::noArray(), turn, way, false, cv::SOLVEPNP_SQPNP))
        registration::refuse(Cause::modelDoesNotFit, kDots, "no place of the tracker explains what was seen",
                             "see that each point was noted with the pixel at which it was seen");
    const Pose viewFromTracker{{way[0], way[1], way[2]}, rotationOfTurn({turn[0], turn[1], turn[2]})};
    return Pose{origin, glm::quat_cast(worldFromView)} * viewFromTracker;
}

Pose closedForm(const std::vector<RayRow>& rows, const std::vector<glm::dvec3>& places) {
    if (std::ranges::all_of(rows, [](const RayRow& row) { return row.height.has_value(); }))
        return byTable(rows, places);
    checkNumber(rows.size(), kFewestWithoutTable, "touch six or more, or say how high the table is");
    return byPerspective(rows, places);
}

/// A mirror image of a plane is the plane turned over: then the pointer would stand behind the table.
void checkSide(const std::vector<RayRow>& rows, const Figures& figures) {
    if (!(glm::length(figures.tip) > kLongTip)) return;
    double behind = 0.0;
    for (const RayRow& row : rows) {
        const glm::dvec3 toPointer = figures.worldFromTracker.rotation * (row.pointer.rotation * -figures.tip);
        behind += glm::dot(toPointer, row.direction) > 0.0 ? 1.0 : -1.0;
    }
    if (behind > 0.0)
        registration::refuse(Cause::mirrored, kDots,
                             "the pointer would stand behind what it touches: the tracker's coordinates are "
                             "left-handed, or its tip is at the other end",
                             "let the tracker tell right-handed coordinates, and calibrate the tip by pivoting");
}

void judgeHold(FittedPlace& place) {
    if (!(place.shiftSigma < kOpen))
        registration::refuse(Cause::pointsDegenerate, kDots,
                             "they leave the place open by " + number(1000.0 * place.shiftSigma, 1) + " mm",
                             "add points farther apart, at several heights, or say how high the table is");
    if (place.turnSigma > kLoose)
        place.warnings.push_back({Cause::pointsDegenerate,
                                  kDots,
                                  {},
                                  "they leave its turn open by " + number(place.turnSigma / registration::kDegree, 1) +
                                      " degrees, which shows above the table",
                                  "also touch dots that fall on a box, or say how high the table is"});
}

} // namespace

DotRows rowsOf(std::span<const TouchedDot> dots, const Installation& room, const glm::dvec3& tip,
               std::optional<double> height, const CaptureFault* undo) {
    DotRows all;
    for (const TouchedDot& dot : dots) {
        const CalibratedCamera& lens = lensOf(room, dot);
        const Rest rest = restOf(withoutFault(dot.touch, undo), tip);
        all.rows.push_back({rest.pointer, positionOf(lens), directionOf(lens, dot.pixel), height,
                            std::hypot(kDotSigma, noiseOf(rest))});
        all.names.push_back(dot.touch.name);
        all.warnings.insert(all.warnings.end(), rest.warnings.begin(), rest.warnings.end());
    }
    return all;
}

FittedPlace placeTracker(const DotRows& dots, const registration::TipRow& tip, const Progress& progress) {
    checkNumber(dots.rows.size(), kFewest, "touch six or more, all over the table");
    std::vector<glm::dvec3> places;
    for (const RayRow& row : dots.rows) places.push_back(row.pointer * tip.tip);
    registration::checkLayout(places, kDots, kShortest);
    const Figures start{closedForm(dots.rows, places), tip.tip, {}, {}};
    checkSide(dots.rows, start);
    const registration::Refined refined =
        registration::refine({dots.rows, {}, {}, tip}, start, {true, true, false, false}, progress);
    FittedPlace place;
    place.figures = refined.figures;
    place.turnSigma = refined.sigmas.trackerTurn;
    place.shiftSigma = refined.sigmas.trackerShift;
    place.tipSigma = refined.sigmas.trackerTip;
    place.warnings = dots.warnings;
    registration::judgePoints(place, dots, kAstray, kDots,
                              "see that each was touched while its own dot was shown, with the tip that was measured");
    judgeHold(place);
    return place;
}

} // namespace lumorph
