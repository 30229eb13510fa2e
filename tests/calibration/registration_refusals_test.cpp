#include <cmath>
#include <cstdio>
#include <functional>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "calibration/lab/board_lab.h"
#include "calibration/lab/registration_lab.h"
#include "calibration/registration/nearest_surface.h"
#include "calibration/registration/surface_fit.h"
#include "tests/calibration/measured_stage.h"
#include "tests/support/cut_tablet.h"
#include "tests/support/small_rigs.h"

// What cannot be registered is refused by name, with its remedy, and nothing of it is kept.

namespace lumorph {
namespace {

using test::measuredInLab;

const Rig& device() {
    static const Rig rig = test::cutTablet();
    return rig;
}

/// A room in which all is known, so that a single step can be spoiled.
struct KnownRoom {
    Installation believed = defaultInstallation(), truth, known;
    explicit KnownRoom(std::uint32_t seed) {
        truth = trueRoom(believed, device().actuators(), seed);
        known = believed;
        known.pointerTip = truth.pointerTip;
        known.worldFromTracker = truth.worldFromTracker;
    }
};

void expectRefused(const Registration& result, Cause cause, const std::string& remedy, const Installation& before,
                   const std::string& what) {
    ASSERT_TRUE(result.refusal) << what << ": " << result.summary;
    EXPECT_EQ(keyOf(result.refusal->cause), keyOf(cause)) << what << ": " << result.summary;
    EXPECT_NE(result.refusal->remedy.find(remedy), std::string::npos) << what << ": " << result.refusal->remedy;
    EXPECT_FALSE(result.good()) << what;
    EXPECT_EQ(result.installation, before) << what << ": nothing is kept";
    std::printf("  %-44s %s\n", what.c_str(), result.summary.c_str());
}

TEST(RegistrationRefusals, DotsThatTellTooLittle) {
    const KnownRoom room(1);
    const auto captureOf = [&](const std::vector<glm::dvec2>& pixels, std::size_t fresh) {
        TrackerLab lab(room.truth, 1);
        DotCapture capture = captureDotsInLab(device(), room.known, room.truth, 1);
        capture.dots.clear();
        const CalibratedCamera& lens = room.truth.projectors.front().camera;
        for (const glm::dvec2& pixel : pixels) {
            const glm::dvec3 from = positionOf(lens), way = directionOf(lens, pixel);
            capture.dots.push_back({0, pixel, lab.touchDot("dot", from - from.y / way.y * way)});
        }
        capture.fresh.resize(std::min(fresh, capture.fresh.size()));
        return capture;
    };
    const std::vector<glm::dvec2> all{{100, 80}, {1800, 90}, {1750, 1000}, {120, 990}, {950, 60}, {1000, 1010}};
    const struct {
        const char* what;
        std::vector<glm::dvec2> pixels;
        std::size_t fresh;
        Cause cause;
        const char* remedy;
    } rows[] = {
        {"three dots", {{100, 80}, {1800, 90}, {1750, 1000}}, 4, Cause::tooFewPoints, "touch six or more"},
        {"all on one line",
         {{100, 500}, {500, 500}, {900, 502}, {1300, 498}, {1700, 500}, {1800, 501}},
         4,
         Cause::pointsDegenerate,
         "beside that line"},
        {"all within a hand's breadth",
         {{900, 500}, {1000, 500}, {950, 580}, {910, 560}, {980, 520}},
         4,
         Cause::pointsDegenerate,
         "farther apart"},
        {"two fresh ones", all, 2, Cause::tooFewPoints, "three more"},
    };
    for (const auto& row : rows)
        expectRefused(registerTracker(captureOf(row.pixels, row.fresh), room.known), row.cause, row.remedy, room.known,
                      row.what);
    DotCapture unknown = captureOf({all.begin(), all.begin() + 5}, 4);
    unknown.tableHeight.reset();
    expectRefused(registerTracker(unknown, room.known), Cause::tooFewPoints, "how high the table is", room.known,
                  "five dots on an unknown table");
}

TEST(RegistrationRefusals, ATableThatWasMovedBeforeTheFreshPoints) {
    const KnownRoom room(2);
    DotCapture capture = captureDotsInLab(device(), room.known, room.truth, 2);
    for (TouchedDot& dot : capture.fresh)
        for (TimedPose& at : dot.touch.pointer.poses) at.pose.position.z += 0.006;
    expectRefused(registerTracker(capture, room.known), Cause::freshPointsFar, "measure again", room.known,
                  "the tracker moved by 6 mm meanwhile");
}

TEST(RegistrationRefusals, SwingsAndBoardsThatLackAMotion) {
    const KnownRoom room(3);
    TrackerLab lab(room.truth, 3);
    PointerCapture swings = capturePointerInLab(room.truth, 3);
    const glm::dvec3 tip(room.truth.pointerTip);
    swings.swings = lab.record(
        [&](double t) {
            const glm::dquat turn = rotationOfTurn({0.5 * std::sin(2.0 * t), 0.0, 0.0});
            return Pose{-(turn * tip), turn};
        },
        15.0);
    expectRefused(registerPointer(swings, room.known), Cause::motionDegenerate, "swing it across", room.known,
                  "swings about one axis");
    swings = capturePointerInLab(room.truth, 3);
    swings.fresh.resize(2);
    expectRefused(registerPointer(swings, room.known), Cause::tooFewPoints, "three more", room.known,
                  "a pointer tried in two dimples");

    const CalibratedCamera camera = defaultLabCamera(room.truth.projectors.front().camera);
    const CalibrationBoard board = parseCalibrationBoard("chess:9x7:20");
    const struct {
        const char* what;
        glm::dvec3 turns;
        Cause cause;
        const char* remedy;
    } rows[] = {
        {"a board that is only moved", glm::dvec3(0.0), Cause::clocksUnknown, "turn them now fast"},
        {"a board turned about the vertical alone", {0.0, 0.6, 0.0}, Cause::motionDegenerate, "tilt them"},
        {"a board tilted sideways alone", {0.6, 0.0, 0.0}, Cause::motionDegenerate, "about the vertical axis"},
    };
    for (const auto& row : rows) {
        // The tracker's world upright, so that its axes are the room's.
        Installation upright = room.truth;
        upright.worldFromTracker = glm::mat4(1.0F);
        TrackerLab straight(upright, 3);
        expectRefused(registerTracker(straight.moveBoard(camera, board, 0.001, row.turns), room.known), row.cause,
                      row.remedy, room.known, row.what);
    }
}

TEST(RegistrationRefusals, LandmarksThatTellTooLittle) {
    const KnownRoom room(4);
    LandmarkCapture capture = captureLandmarksInLab(device(), room.truth, 4);
    LandmarkCapture few = capture;
    few.touches.resize(3);
    expectRefused(registerDevice(few, room.known), Cause::tooFewPoints, "touch six or more", room.known,
                  "three landmarks");
    TrackerLab lab(room.truth, 4);
    const auto touchedAt = [&](const std::vector<glm::dvec3>& places) {
        LandmarkCapture of = capture;
        of.touches.clear();
        for (const glm::dvec3& at : places)
            of.touches.push_back({at, glm::dvec3(0, 1, 0), lab.touchDevice("point", at)});
        return of;
    };
    expectRefused(
        registerDevice(touchedAt({{-0.1, 0.02, 0.0}, {-0.05, 0.02, 0.0}, {0.02, 0.02, 0.0}, {0.1, 0.02, 0.0}}),
                       room.known),
        Cause::pointsDegenerate, "beside that line", room.known, "landmarks on one line");
    expectRefused(
        registerDevice(touchedAt({{0.0, 0.02, 0.0}, {0.02, 0.02, 0.0}, {0.0, 0.02, 0.02}, {0.02, 0.02, 0.02}}),
                       room.known),
        Cause::pointsDegenerate, "farther apart", room.known, "landmarks on a thumb's breadth");
    LandmarkCapture wrongOrder = capture;
    for (std::size_t i = 0; i + 1 < wrongOrder.touches.size(); ++i)
        std::swap(wrongOrder.touches[i].onModel, wrongOrder.touches[i + 1].onModel);
    expectRefused(registerDevice(wrongOrder, room.known), Cause::modelDoesNotFit, "in the order", room.known,
                  "landmarks in another order");
    Installation wrongTip = room.known;
    wrongTip.pointerTip += glm::vec3(0.08F, 0.0F, 0.0F);
    expectRefused(registerDevice(capture, wrongTip), Cause::modelDoesNotFit, "with the tip", wrongTip,
                  "a tip that is 8 cm beside");
}

TEST(RegistrationRefusals, SurfacesThatMaySlide) {
    const TriangleMesh plate = test::boxMesh({-0.1F, 0.0F, -0.08F}, {0.1F, 0.02F, 0.08F}, 4);
    std::vector<glm::dvec3> top;
    for (int i = 0; i < 40; ++i)
        for (int k = 0; k < 40; ++k) top.emplace_back(-0.08 + 0.004 * i, 0.02, -0.06 + 0.003 * k);
    const auto cause = [&](const std::vector<glm::dvec3>& points) {
        try {
            (void)fitSurface(plate, points, {0.5, 2.0, 0.6}, {});
        } catch (const CaptureRefused& refused) {
            return std::string(keyOf(refused.finding().cause));
        }
        return std::string("fits");
    };
    EXPECT_EQ(cause(top), "points_degenerate") << "a flat top alone";
    EXPECT_EQ(cause({top.begin(), top.begin() + 100}), "too_few_points");
    std::vector<glm::dvec3> sides = top;
    for (int i = 0; i < 40; ++i)
        for (int k = 0; k < 8; ++k) {
            sides.emplace_back(0.1, 0.002 * k + 0.002, -0.06 + 0.003 * i);
            sides.emplace_back(-0.08 + 0.004 * i, 0.002 * k + 0.002, 0.08);
        }
    EXPECT_EQ(cause(sides), "fits") << "with two of its sides";
    sides.front().x = std::nan("");
    EXPECT_EQ(cause(sides), "not_a_number");
}

TEST(RegistrationRefusals, NearestPlacesOfAMeshAreThoseOfAllItsTriangles) {
    const TriangleMesh mesh = test::boxMesh({-0.1F, 0.0F, -0.08F}, {0.1F, 0.02F, 0.08F}, 6);
    const NearestSurface surface(mesh);
    for (int i = 0; i < 200; ++i) {
        const glm::dvec3 p(0.2 * std::sin(1.3 * i), 0.01 + 0.06 * std::sin(2.9 * i), 0.15 * std::cos(1.7 * i));
        // Of a box, worked out by hand.
        const glm::dvec3 low(-0.1, 0.0, -0.08), high(0.1, 0.02, 0.08), in = glm::clamp(p, low, high);
        double distance = glm::distance(p, in);
        if (distance == 0.0) {
            const glm::dvec3 inside = glm::min(p - low, high - p);
            distance = std::min({inside.x, inside.y, inside.z});
        }
        const auto place = surface.of(p, 1.0);
        ASSERT_TRUE(place);
        EXPECT_NEAR(glm::distance(place->point, p), distance, 1e-7) << i;
        EXPECT_FALSE(surface.of(p, 0.5 * distance - 1e-6) && distance > 1e-5) << i;
    }
    EXPECT_THROW(NearestSurface({{{0, 0, 0}}, {{0, 1, 2}}}), InvalidInput);
}

TEST(RegistrationRefusals, AlignmentsThatTellTooLittle) {
    const KnownRoom room(5);
    RegistrationLabOptions options;
    options.alignments = 7;
    expectRefused(registerEye(captureEyeInLab(device(), room.known, room.truth, 5, options), room.known),
                  Cause::tooFewPoints, "eight marks", room.known, "seven alignments");
    TrackerLab lab(room.truth, 5);
    EyeCapture same = captureEyeInLab(device(), room.known, room.truth, 5);
    same.alignments.clear();
    for (int i = 0; i < 8; ++i)
        same.alignments.push_back(lab.align("alignment", {0.0, 0.0, 0.1}, glm::dvec3(room.truth.eye), 1.0));
    expectRefused(registerEye(same, room.known), Cause::motionDegenerate, "turn and tilt the head", room.known,
                  "eight alignments of one mark from one place");
    Installation elsewhere = room.known;
    elsewhere.worldFromTracker[3] += glm::vec4(0.4F, 0.2F, 0.0F, 0.0F);
    const EyeCapture capture = captureEyeInLab(device(), room.known, room.truth, 5);
    expectRefused(registerEye(capture, elsewhere), Cause::modelDoesNotFit, "tracker are registered", elsewhere,
                  "a tracker that was moved by half a metre");
}

TEST(RegistrationRefusals, EveryFaultOfATrackerIsNamedInEveryStep) {
    const KnownRoom room(6);
    const struct {
        TrackerFault fault;
        const char* name;
        Cause cause;
        const char* remedy;
    } faults[] = {
        {TrackerFault::dropsOut, "drops out", Cause::trackerLost, "in sight"},
        {TrackerFault::swapsBodies, "swaps bodies", Cause::bodySwapped, "swaps bodies"},
        {TrackerFault::clockJumpsBack, "clock jumps back", Cause::clockJumps, "evenly"},
        {TrackerFault::clockJumpsAhead, "clock jumps ahead", Cause::clockJumps, "evenly"},
        {TrackerFault::leftHanded, "left-handed", Cause::mirrored, "right-handed"},
        {TrackerFault::centimetres, "centimetres", Cause::wrongUnits, "metres"},
        {TrackerFault::notANumber, "no number", Cause::notANumber, "record again"},
    };
    for (const auto& row : faults) {
        LabBenchOptions options;
        options.touches.fault = row.fault;
        for (const char* stage : {"tracker", "body", "eye", "pointer"}) {
            // A pointer that swings alone looks the same in a mirror, and at any scale.
            if (stage == std::string_view("pointer") &&
                (row.fault == TrackerFault::leftHanded || row.fault == TrackerFault::centimetres))
                continue;
            expectRefused(measuredInLab<Registration>(stage, device(), room.known, room.truth, 6, options), row.cause,
                          row.remedy, room.known, std::string(stage) + ": " + row.name);
        }
    }
}

TEST(RegistrationRefusals, APointerThatIsTakenForTheBodyIsNamed) {
    const KnownRoom room(8);
    LandmarkCapture touches = captureLandmarksInLab(device(), room.truth, 8);
    for (TouchedLandmark& at : touches.touches) std::swap(at.touch.pointer, *at.touch.body);
    for (TouchedLandmark& at : touches.fresh) std::swap(at.touch.pointer, *at.touch.body);
    expectRefused(registerDevice(touches, room.known), Cause::bodySwapped, "names again", room.known,
                  "device and pointer exchanged");
    EyeCapture sights = captureEyeInLab(device(), room.known, room.truth, 8);
    for (Alignment& at : sights.alignments) std::swap(at.touch.pointer, *at.touch.body);
    for (Alignment& at : sights.fresh) std::swap(at.touch.pointer, *at.touch.body);
    expectRefused(registerEye(sights, room.known), Cause::bodySwapped, "names again", room.known,
                  "head and pointer exchanged");
}

TEST(RegistrationRefusals, FaultsAreNamedWithACameraToo) {
    const KnownRoom room(9);
    const CalibratedCamera camera = defaultLabCamera(room.truth.projectors.front().camera);
    Installation seeing = room.known;
    seeing.cameras.resize(1);
    seeing.cameras.front().camera = camera;
    const CalibrationBoard board = parseCalibrationBoard("chess:9x7:12");
    const struct {
        TrackerFault fault;
        const char* name;
        Cause cause;
    } faults[] = {
        {TrackerFault::dropsOut, "drops out", Cause::trackerLost},
        {TrackerFault::swapsBodies, "swaps bodies", Cause::bodySwapped},
        {TrackerFault::clockJumpsBack, "clock jumps back", Cause::clockJumps},
        {TrackerFault::leftHanded, "left-handed", Cause::mirrored},
        {TrackerFault::centimetres, "centimetres", Cause::wrongUnits},
        {TrackerFault::notANumber, "no number", Cause::notANumber},
    };
    for (const auto& row : faults) {
        RegistrationLabOptions options;
        options.fault = row.fault;
        const auto expect = [&](const char* step, const Registration& result) {
            expectRefused(result, row.cause, "", seeing, std::string(step) + ": " + row.name);
        };
        TrackerLab lab(room.truth, 9, {}, {}, row.fault);
        expect("moved board", registerTracker(lab.moveBoard(camera, board, 0.001), seeing));
        expect("surface", registerDevice(test::surfaceInLab(device(), seeing, room.truth, 9, options), seeing));
    }
}

TEST(RegistrationRefusals, DoubledRowsAreLeftOutAndSaid) {
    const KnownRoom room(7);
    LabBenchOptions options;
    options.touches.fault = TrackerFault::doubledRows;
    const auto result = measuredInLab<Registration>("tracker", device(), room.known, room.truth, 7, options);
    ASSERT_TRUE(result.good()) << result.summary;
    ASSERT_FALSE(result.warnings.empty());
    EXPECT_EQ(result.warnings.front().cause, Cause::doubledRows);
}

} // namespace
} // namespace lumorph
