#include "calibration/solve/installation_calibration.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/procam_capture.h"

namespace lumorph::test {
namespace {

using ::testing::HasSubstr;

/// The usual set-up with a second camera and a second projector beside the first ones.
struct Room {
    ProcamSetup setup = ProcamSetup::usual();
    std::vector<CalibratedCamera> cameras, projectors;
    std::vector<NamedDevice> cameraNames, projectorNames;

    Room() {
        CalibratedCamera second = setup.camera;
        second.focal = glm::dvec2(820.0);
        second.principal = {230.0, 190.0};
        second.distortion = {-0.15, 0.0, 0.0, 0.0, 0.0};
        second.cameraFromWorld = glm::translate(glm::dmat4(1.0), {-260.0, 20.0, 40.0}) *
                                 glm::rotate(glm::dmat4(1.0), glm::radians(14.0), {0.0, 1.0, 0.0}) *
                                 glm::rotate(glm::dmat4(1.0), glm::radians(20.0), {0.0, 0.0, 1.0});
        cameras = {setup.camera, second};
        CalibratedCamera beside = setup.projector;
        beside.focal = glm::dvec2(520.0);
        beside.principal = {120.0, 30.0};
        beside.cameraFromWorld = glm::translate(glm::dmat4(1.0), {210.0, 120.0, 30.0}) *
                                 glm::rotate(glm::dmat4(1.0), glm::radians(-9.0), {0.0, 1.0, 0.0});
        projectors = {setup.projector, beside};
        cameraNames = {{"left camera", {480, 360}}, {"right camera", {480, 360}}};
        projectorNames = {{"upper projector", {256, 192}}, {"side projector", {256, 192}}};
        setup.cameraFromBoard.push_back(setup.pose(-20, 25, 15));
    }

    /// What camera `c` sees of a board, and of projectors' light on it.
    void look(InstallationView& view, std::size_t pose, std::size_t c, bool turned, double noise,
              std::mt19937& random) const {
        std::normal_distribution<double> grain(0.0, noise), fine(0.0, 0.5 * noise);
        const glm::dmat4& board = setup.cameraFromBoard[pose];
        const double wide = setup.square * (setup.columns - 1), high = setup.square * (setup.rows - 1);
        const auto place = [&](double x, double y) { return glm::dvec3(board * glm::dvec4(x, y, 0.0, 1.0)); };
        for (int row = 0; row < setup.rows; ++row)
            for (int column = 0; column < setup.columns; ++column) {
                const double x = column * setup.square, y = row * setup.square;
                const auto seen = pixelOf(cameras[c], place(x, y));
                view.corners[c].board.emplace_back(turned ? wide - x : x, turned ? high - y : y, 0.0);
                view.corners[c].seen.emplace_back(seen->x + grain(random), seen->y + grain(random));
            }
        for (std::size_t p = 0; p < projectors.size(); ++p)
            for (int row = 0; row < 7; ++row)
                for (int column = 0; column < 9; ++column) {
                    const glm::dvec3 at = place(column / 8.0 * wide, row / 6.0 * high);
                    const auto seen = pixelOf(cameras[c], at);
                    const auto lit = pixelOf(projectors[p], at);
                    view.light[c][p].push_back({{seen->x, seen->y}, {lit->x + fine(random), lit->y + fine(random)}});
                }
    }

    /// `who` says which cameras look at each pose.
    [[nodiscard]] std::vector<InstallationView> capture(const std::vector<std::vector<int>>& who, double noise,
                                                        std::uint32_t seed, bool turning = true) const {
        std::mt19937 random(seed);
        std::vector<InstallationView> views;
        for (std::size_t pose = 0; pose < who.size(); ++pose) {
            InstallationView view{"pose_" + std::to_string(pose), std::vector<BoardPoints>(2), {}};
            view.light.assign(2, std::vector<std::vector<ProjectorPoint>>(2));
            for (const int c : who[pose])
                look(view, pose, static_cast<std::size_t>(c), turning && c == 1 && pose % 2 == 0, noise, random);
            views.push_back(view);
        }
        return views;
    }

    /// Root mean square of how far the solution puts light beside where it belongs, over the room of the boards;
    /// pixels.
    [[nodiscard]] double projectorError(const InstallationCalibration& result, std::size_t p) const {
        double sum = 0.0, count = 0.0;
        for (const double x : {-120.0, 0.0, 120.0})
            for (const double y : {-90.0, 0.0, 90.0})
                for (const double z : {930.0, 1000.0, 1070.0}) {
                    const auto& solved = result.state.projectors[p];
                    BundleState state;
                    state.projector = solved.lens;
                    state.projectorFromCamera = solved.fromWorld;
                    const cv::Point2d at = projectorPixel({x, y, z}, state);
                    const auto truth = pixelOf(projectors[p], {x, y, z});
                    sum += std::pow(at.x - truth->x, 2) + std::pow(at.y - truth->y, 2);
                    count += 1.0;
                }
        return std::sqrt(sum / count);
    }
};

TEST(InstallationCalibration, TwoCamerasAndTwoProjectorsComeIntoOneWorld) {
    const Room room;
    const auto views = room.capture({{0, 1}, {0, 1}, {0}, {0, 1}, {1}, {0, 1}, {0, 1}}, 0.05, 3);
    const InstallationCalibration result = calibrateInstallation(views, room.cameraNames, room.projectorNames);
    EXPECT_NEAR(result.cameras[0].lens[kFocalLength], 960.0, 4.0);
    EXPECT_NEAR(result.cameras[1].lens[kFocalLength], 820.0, 4.0);
    EXPECT_NEAR(result.projectors[0].lens[kFocalLength], 470.0, 2.0);
    EXPECT_NEAR(result.projectors[1].lens[kFocalLength], 520.0, 2.0);
    const glm::dvec3 way(room.cameras[1].cameraFromWorld[3]);
    for (int i = 0; i < 3; ++i) {
        const auto at = static_cast<std::size_t>(3 + i);
        EXPECT_NEAR(result.state.cameras[1].fromWorld[at], way[i], 4.0 * result.sigma.cameras[1].fromWorld[at]);
        EXPECT_LT(result.sigma.cameras[1].fromWorld[at], 2.0);
        EXPECT_EQ(result.state.cameras[0].fromWorld[at], 0.0);
    }
    std::printf("joint RMS %.3f; light beside where it belongs: %.3f and %.3f projector pixels\n", result.rms,
                room.projectorError(result, 0), room.projectorError(result, 1));
    EXPECT_LT(room.projectorError(result, 0), 0.8);
    EXPECT_LT(room.projectorError(result, 1), 0.8);
    EXPECT_NEAR(result.rms, 0.05 * std::sqrt(1.25), 0.015);
    ASSERT_EQ(result.views.size(), 7U);
}

TEST(InstallationCalibration, PointsThatAreFarOffOrMissTheBoardAreLeftOutAndNamed) {
    const Room room;
    const auto sound = room.capture({{0, 1}, {0, 1}, {0}, {0, 1}, {1}, {0, 1}, {0, 1}}, 0.05, 3);
    auto spoiled = sound;
    spoiled[1].corners[0].seen[3] += cv::Point2d(9.0, 0.0);
    spoiled[3].light[1][1][5].projector += cv::Point2d(40.0, 5.0);
    spoiled[3].light[1][1][50].projector += cv::Point2d(-30.0, 60.0);
    spoiled[5].light[0][0][7].camera = {1e5, 400.0}; // a ray that misses the board
    const InstallationCalibration result = calibrateInstallation(spoiled, room.cameraNames, room.projectorNames);
    std::vector<std::string> named;
    for (const Finding& warning : result.warnings)
        if (warning.cause == Cause::pointSuspicious)
            named.push_back(warning.view + ": " + warning.why.substr(0, warning.why.find(" lie ")));
    EXPECT_THAT(named, ::testing::UnorderedElementsAre(
                           "pose_1: 1 of 63 points of the board that left camera saw",
                           "pose_3: 2 of 63 points of the light of side projector that right camera saw",
                           "pose_5: 1 of 63 points of the light of upper projector that left camera saw"));
    const InstallationCalibration clean = calibrateInstallation(sound, room.cameraNames, room.projectorNames);
    EXPECT_NEAR(result.rms, clean.rms, 0.002);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_NEAR(result.cameras[i].lens[kFocalLength], clean.cameras[i].lens[kFocalLength],
                    0.5 * clean.cameras[i].sigma[kFocalLength]);
        EXPECT_NEAR(result.projectors[i].lens[kFocalLength], clean.projectors[i].lens[kFocalLength],
                    0.5 * clean.projectors[i].sigma[kFocalLength]);
    }
}

TEST(InstallationCalibration, CamerasThatShareNoBoardMeetByAProjectorsLight) {
    const Room room;
    const auto views = room.capture({{0}, {1}, {0}, {1}, {0}, {1}, {0, 1}}, 0.05, 4);
    auto apart = views;
    apart[6].corners[1] = {};
    const InstallationCalibration result = calibrateInstallation(apart, room.cameraNames, room.projectorNames);
    const glm::dvec3 way(room.cameras[1].cameraFromWorld[3]);
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(result.state.cameras[1].fromWorld[static_cast<std::size_t>(3 + i)], way[i], 5.0);
    EXPECT_LT(room.projectorError(result, 1), 1.0);
}

TEST(InstallationCalibration, DevicesThatShareNothingAreRefusedByName) {
    const Room room;
    auto views = room.capture({{0}, {1}, {0}, {1}, {0}, {1}}, 0.05, 5);
    for (InstallationView& view : views) // the second projector lights only what the second camera sees, the first none
        for (std::size_t c = 0; c < 2; ++c) view.light[c][c == 0 ? 1 : 0].clear();
    try {
        (void)calibrateInstallation(views, room.cameraNames, room.projectorNames);
        FAIL() << "it was accepted";
    } catch (const CaptureRefused& refused) {
        EXPECT_EQ(refused.finding().cause, Cause::disconnected);
        EXPECT_THAT(refused.what(), HasSubstr("right camera"));
        EXPECT_THAT(refused.what(), HasSubstr("side projector"));
        EXPECT_THAT(refused.what(), ::testing::Not(HasSubstr("upper projector")));
    }
}

TEST(InstallationCalibration, ACameraThatWasMovedBetweenPosesIsRefused) {
    Room room;
    auto views = room.capture({{0, 1}, {0, 1}, {0, 1}}, 0.05, 6);
    room.cameras[1].cameraFromWorld =
        glm::translate(glm::dmat4(1.0), {30.0, 0.0, 0.0}) * room.cameras[1].cameraFromWorld;
    const auto later = room.capture({{0, 1}, {0, 1}, {0, 1}, {0, 1}, {0, 1}, {0, 1}}, 0.05, 7);
    views.insert(views.end(), later.begin() + 3, later.end());
    try {
        (void)calibrateInstallation(views, room.cameraNames, room.projectorNames);
        FAIL() << "it was accepted";
    } catch (const CaptureRefused& refused) {
        EXPECT_EQ(refused.finding().cause, Cause::modelDoesNotFit);
    }
}

TEST(InstallationCalibration, ListsThatDoNotAgreeAreRefused) {
    const Room room;
    auto views = room.capture({{0, 1}, {0, 1}, {0, 1}}, 0.05, 6);
    views[1].corners.pop_back();
    EXPECT_THROW((void)calibrateInstallation(views, room.cameraNames, room.projectorNames), InvalidInput);
    EXPECT_THROW((void)calibrateInstallation(views, {}, room.projectorNames), InvalidInput);
}

} // namespace
} // namespace lumorph::test
