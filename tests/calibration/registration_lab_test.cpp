#include "calibration/lab/registration_lab.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <random>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "calibration/lab/board_lab.h"
#include "calibration/registration/surface_fit.h"
#include "core/scene/measured_sigma.h"
#include "tests/calibration/measured_stage.h"
#include "tests/support/cut_tablet.h"

// R24, R25, R26: tracker, pointer, device and eye in millimetres, against the lab's truth.

namespace lumorph {
namespace {

constexpr double kDegree = 0.017453292519943295;

const Rig& tablet() {
    static const Rig rig = test::cutTablet();
    return rig;
}

constexpr unsigned kSetUps = 20;

struct Room {
    Installation believed = defaultInstallation();
    Installation truth;
    explicit Room(std::uint32_t seed) {
        believed.cameras.resize(1);
        believed.cameras.front().camera = defaultLabCamera(believed.projectors.front().camera);
        truth = trueRoom(believed, tablet().actuators(), seed);
    }
    /// All before a step is known exactly.
    [[nodiscard]] Installation knowing(bool tip, bool tracker) const {
        Installation room = believed;
        if (tip) room.pointerTip = truth.pointerTip;
        if (tracker) room.worldFromTracker = truth.worldFromTracker;
        return room;
    }
};

Registration registeredInLab(const char* stage, const Installation& believed, const Room& room, std::uint32_t seed,
                             const Progress& progress = {}) {
    return test::measuredInLab<Registration>(stage, tablet(), believed, room.truth, seed, {}, progress);
}

struct Off {
    double millimetres = 0.0, degrees = 0.0;
};

/// How far a rigid figure puts a place that truly is `place` in the frame to which it leads.
Off offOf(const glm::mat4& estimated, const glm::mat4& truth, const glm::dvec3& place) {
    const glm::dmat4 error = glm::dmat4(estimated) * glm::inverse(glm::dmat4(truth));
    const glm::dmat3 turn(error);
    const double sine =
        0.5 * glm::length(glm::dvec3(turn[1][2] - turn[2][1], turn[2][0] - turn[0][2], turn[0][1] - turn[1][0]));
    return {1000.0 * glm::distance(glm::dvec3(error * glm::dvec4(place, 1.0)), place), std::asin(sine) / kDegree};
}
Off trackerOff(const Installation& room, const Installation& truth) {
    return offOf(room.worldFromTracker, truth.worldFromTracker, {0.0, 0.02, 0.0});
}
/// At the middle of the device.
Off deviceOff(const Installation& room, const Installation& truth) {
    return offOf(room.bodyFromDevice, truth.bodyFromDevice,
                 glm::dvec3(truth.bodyFromDevice * glm::vec4(0.0F, 0.01F, 0.0F, 1.0F)));
}
double tipOff(const Installation& room, const Installation& truth) {
    return 1000.0 * static_cast<double>(glm::distance(room.pointerTip, truth.pointerTip));
}
double eyeOff(const Installation& room, const Installation& truth) {
    return 1000.0 * static_cast<double>(glm::distance(room.eyeFromHead, truth.eyeFromHead));
}

TEST(RegistrationLab, SetUpsAreRegisteredToAMillimetreAndTheEyeToFive) {
    std::printf("set-up   tip mm   tracker mm deg (fresh)   device mm deg (fresh)   eye mm (fresh)\n");
    for (unsigned seed = 1; seed <= kSetUps; ++seed) {
        const Room room(seed);
        const Registration pointer = registeredInLab("pointer", room.believed, room, seed);
        ASSERT_TRUE(pointer.good()) << pointer.summary;
        const Registration tracker = registeredInLab("tracker", pointer.installation, room, seed);
        ASSERT_TRUE(tracker.good()) << tracker.summary;
        const Registration device = registeredInLab("body", tracker.installation, room, seed);
        ASSERT_TRUE(device.good()) << device.summary;
        const Registration eye = registeredInLab("eye", device.installation, room, seed);
        ASSERT_TRUE(eye.good()) << eye.summary;
        const Off inRoom = trackerOff(eye.installation, room.truth), onBody = deviceOff(eye.installation, room.truth);
        const double tip = tipOff(eye.installation, room.truth), eyes = eyeOff(eye.installation, room.truth);
        std::printf("%5u %9.2f %10.2f %6.3f (%.2f) %11.2f %6.3f (%.2f) %9.2f (%.2f)\n", seed, tip, inRoom.millimetres,
                    inRoom.degrees, 1000.0 * tracker.fresh.rms, onBody.millimetres, onBody.degrees,
                    1000.0 * device.fresh.rms, eyes, 1000.0 * eye.fresh.rms);
        EXPECT_LE(inRoom.millimetres, 1.0);
        EXPECT_LE(inRoom.degrees, 0.2);
        EXPECT_LE(onBody.millimetres, 1.0);
        EXPECT_LE(onBody.degrees, 0.2);
        EXPECT_LE(eyes, 5.0) << "from 8 alignments with 2 px aiming noise";
        EXPECT_EQ(eye.installation.origins.eyeOffset.way, Origin::Way::simulated);
        EXPECT_EQ(tracker.fresh.points.size(), 4U);
    }
}

/// Errors in units of the sigmas that were said of them.
struct InSigmas {
    double squares = 0.0, said = 0.0, off = 0.0, count = 0.0;
    void add(double millimetres, double sigma) {
        squares += std::pow(1e-3 * millimetres / sigma, 2);
        off += std::pow(millimetres, 2);
        said += std::pow(1e3 * sigma, 2);
        count += 1.0;
    }
    void print(const char* what) const {
        std::printf("%-24s off %.2f mm, said %.2f mm, %.2f sigmas\n", what, std::sqrt(off / count),
                    std::sqrt(said / count), ratio());
    }
    [[nodiscard]] double ratio() const { return std::sqrt(squares / count); }
};

TEST(RegistrationLab, ErrorsOfTheTipAndOfTheTrackerReachWhatIsMeasuredWithThem) {
    constexpr unsigned kRooms = 60;
    RegistrationLabOptions options; // hands that are as the solver takes them to be
    options.hands.dotMillimetres = 0.7;
    options.hands.landmarkMillimetres = 0.4;
    options.hands.aimPixels = 2.25;
    for (const double tipMillimetres : {0.1, 0.5}) { // along each axis
        InSigmas ofTracker, ofDevice, ofEye, inRoom;
        for (unsigned seed = 301; seed <= 300 + kRooms; ++seed) {
            const Room room(seed);
            std::mt19937 engine(seed);
            std::normal_distribution<double> normal(0.0, 1e-3 * tipMillimetres);
            Installation believed = room.believed;
            believed.cameras.clear();
            believed.pointerTip = room.truth.pointerTip + glm::vec3(normal(engine), normal(engine), normal(engine));
            believed.origins.pointer = {Origin::Way::measured,
                                        withSigma("pivoting", {1e-3 * tipMillimetres * std::sqrt(3.0), 0.0, 0.0, 0.0}),
                                        "2026-11-20T10:00:00Z"};
            const Registration tracker =
                registerTracker(captureDotsInLab(tablet(), believed, room.truth, seed, options), believed);
            ASSERT_TRUE(tracker.good()) << tracker.summary;
            const Registration device =
                registerDevice(captureLandmarksInLab(tablet(), room.truth, seed, options), tracker.installation);
            ASSERT_TRUE(device.good()) << device.summary;
            const Registration eye =
                registerEye(captureEyeInLab(tablet(), believed, room.truth, seed, options), device.installation);
            ASSERT_TRUE(eye.good()) << eye.summary;
            ofTracker.add(trackerOff(tracker.installation, room.truth).millimetres, tracker.shiftSigma);
            ofDevice.add(deviceOff(device.installation, room.truth).millimetres, device.shiftSigma);
            ofEye.add(eyeOff(eye.installation, room.truth), eye.shiftSigma);
            for (const Registration* one : {&tracker, &device, &eye}) EXPECT_LE(one->tipSigma, one->shiftSigma);
            // Where the device comes to lie in the room: what both have of the tip partly cancels.
            const Installation& said = eye.installation;
            const glm::mat4 body = glm::inverse(room.truth.worldFromTracker) * room.truth.worldFromDevice *
                                   glm::inverse(room.truth.bodyFromDevice);
            const double all = std::sqrt(std::pow(tracker.shiftSigma, 2) + std::pow(device.shiftSigma, 2) -
                                         2.0 * tracker.tipSigma * device.tipSigma);
            inRoom.add(offOf(said.worldFromTracker * body * said.bodyFromDevice, room.truth.worldFromDevice,
                             glm::dvec3(room.truth.worldFromDevice * glm::vec4(0.0F, 0.01F, 0.0F, 1.0F)))
                           .millimetres,
                       all);
        }
        std::printf("tip %.1f mm along each axis\n", tipMillimetres);
        ofTracker.print("tracker");
        ofDevice.print("device");
        ofEye.print("eye");
        inRoom.print("device in the room");
        for (const InSigmas* one : {&ofTracker, &ofDevice, &ofEye, &inRoom}) {
            EXPECT_GT(one->ratio(), 0.4);
            EXPECT_LT(one->ratio(), 1.2);
        }
    }
}

TEST(RegistrationLab, TouchedPointsAloneTellTheDevice) {
    double shift = 0.0, turn = 0.0;
    for (unsigned seed = 1; seed <= kSetUps; ++seed) {
        const Room room(seed);
        const Registration result =
            registerDevice(captureLandmarksInLab(tablet(), room.truth, seed), room.knowing(true, false));
        ASSERT_TRUE(result.good()) << result.summary;
        const Off off = deviceOff(result.installation, room.truth);
        shift = std::max(shift, off.millimetres);
        turn = std::max(turn, off.degrees);
    }
    std::printf("device by touch alone, the worst of %u: %.2f mm, %.3f degrees\n", kSetUps, shift, turn);
    EXPECT_LE(shift, 1.0);
    EXPECT_LE(turn, 0.2);
}

TEST(RegistrationLab, DotsOnATableOfUnknownHeightTellThePlaceToo) {
    const Room room(3);
    RegistrationLabOptions options;
    options.dots = 20;
    DotCapture capture = captureDotsInLab(tablet(), room.believed, room.truth, 3, options);
    capture.tableHeight.reset();
    const Registration result = registerTracker(capture, room.knowing(true, false));
    ASSERT_TRUE(result.good()) << result.summary;
    const Off off = trackerOff(result.installation, room.truth);
    std::printf("unknown table: %.2f mm, %.3f degrees; %s\n", off.millimetres, off.degrees, result.summary.c_str());
    EXPECT_LT(off.millimetres, 3.0 * 1000.0 * result.shiftSigma) << "it knows its own worth";
    EXPECT_LT(off.degrees, 3.0 * result.turnSigma / kDegree);
    EXPECT_LT(off.millimetres, 5.0);
    ASSERT_EQ(result.warnings.size(), 1U) << "and says what is missing";
    EXPECT_NE(result.warnings[0].remedy.find("on a box"), std::string::npos);
}

TEST(RegistrationLab, DotsThatFallOnABoxNeedNoTable) {
    const Room room(10);
    const CalibratedCamera& lens = room.truth.projectors.front().camera;
    const glm::dvec3 from = positionOf(lens);
    TrackerLab lab(room.truth, 10);
    DotCapture capture;
    capture.tableHeight.reset();
    for (int i = 0; i < 24; ++i) {
        const glm::dvec2 pixel(100.0 + 1700.0 * (i % 6) / 5.0, 80.0 + 900.0 * double(i / 6) / 3.0);
        const glm::dvec3 way = directionOf(lens, pixel);
        const double height = i % 2 == 0 ? 0.0 : 0.2;
        const Touch touch = lab.touchDot("dot " + std::to_string(i + 1), from - (from.y - height) / way.y * way);
        (i % 6 == 3 ? capture.fresh : capture.dots).push_back({0, pixel, touch});
    }
    const Registration result = registerTracker(capture, room.knowing(true, false));
    ASSERT_TRUE(result.good()) << result.summary;
    const Off off = trackerOff(result.installation, room.truth);
    std::printf("dots on a box: %.2f mm, %.3f degrees; %s\n", off.millimetres, off.degrees, result.summary.c_str());
    EXPECT_LT(off.degrees, 0.2);
    EXPECT_LT(off.millimetres, 2.0);
}

TEST(RegistrationLab, ATrackedBoardBeforeTheCameraTellsThePlace) {
    const Room room(5);
    TrackerLab lab(room.truth, 5);
    const CalibrationBoard board = parseCalibrationBoard("chess:9x7:20");
    const BoardCapture capture = lab.moveBoard(room.truth.cameras.front().camera, board, 0.001);
    const Registration result = registerTracker(capture, room.believed);
    ASSERT_TRUE(result.good()) << result.summary;
    const Off off = trackerOff(result.installation, room.truth);
    std::printf("board: %.2f mm, %.3f degrees; %s\n", off.millimetres, off.degrees, result.summary.c_str());
    EXPECT_LT(off.millimetres, 1.0);
    EXPECT_LT(off.degrees, 0.2);
}

TEST(RegistrationLab, StructuredLightOnTheDeviceTellsItsBody) {
    const Room room(6);
    const SurfaceCapture capture = test::surfaceInLab(tablet(), room.believed, room.truth, 6);
    Installation known = room.knowing(true, true);
    // Somebody has put it down anyhow.
    known.worldFromDevice = glm::rotate(glm::translate(known.worldFromDevice, {0.012F, 0.004F, -0.015F}),
                                        glm::radians(7.0F), {0.1F, 1.0F, 0.1F});
    const Registration result = registerDevice(capture, known);
    ASSERT_TRUE(result.good()) << result.summary;
    const Off off = deviceOff(result.installation, room.truth);
    std::printf("surface, %zu points: %.2f mm, %.3f degrees; %s\n", capture.points.size(), off.millimetres, off.degrees,
                result.summary.c_str());
    EXPECT_LT(off.millimetres, 1.0);
    EXPECT_LT(off.degrees, 0.2);
}

TEST(RegistrationLab, TheDeviceAtRestIsAsItsMeasuredServosByTheirNames) {
    Room room(6);
    const Actuator& last = tablet().actuators().back(); // alone in the list, as after a check
    room.believed.servos = {{last.name, {{0.0, 0.02, 0.06}, {1.0, 0.96, 1.0}}, 0.0}};
    std::vector<double> strokes(tablet().actuatorCount(), 0.0);
    strokes.back() = 0.06;
    EXPECT_EQ(shapeAtRest(tablet(), room.believed).positions, deformed(tablet(), strokes).positions);
}

TEST(RegistrationLab, ADotThatWasMissedIsNamedAndHardlyCounts) {
    const Room room(8);
    DotCapture capture = captureDotsInLab(tablet(), room.believed, room.truth, 8);
    for (TimedPose& at : capture.dots[5].touch.pointer.poses) at.pose.position.x += 0.03; // the dot beside it
    const Registration result = registerTracker(capture, room.knowing(true, false));
    ASSERT_TRUE(result.good()) << result.summary;
    ASSERT_EQ(result.warnings.size(), 1U);
    EXPECT_EQ(result.warnings[0].cause, Cause::pointSuspicious);
    EXPECT_EQ(result.warnings[0].view, "dot 6");
    EXPECT_LT(trackerOff(result.installation, room.truth).millimetres, 1.0);
}

TEST(RegistrationLab, CancelStopsAndRepeatsAreEqual) {
    const Room room(9);
    std::stop_source stop;
    stop.request_stop();
    EXPECT_THROW((void)registeredInLab("tracker", room.believed, room, 9, Progress({}, stop.get_token())), Cancelled);
    const Installation known = room.knowing(true, false);
    const auto once = [&] { return registeredInLab("tracker", known, room, 9).installation.worldFromTracker; };
    EXPECT_EQ(once(), once());
}

} // namespace
} // namespace lumorph
