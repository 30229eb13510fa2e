#include "calibration/report/calibrated_room.h"

#include <cmath>
#include <numbers>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>

#include "calibration/lab/board_lab.h"
#include "core/base/error.h"

namespace lumorph::test {
namespace {

using testing::ElementsAre;

PoseVector vectorOf(const glm::dmat4& pose, double metresPerUnit) {
    cv::Matx33d rotation;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) rotation(row, column) = pose[column][row];
    cv::Vec3d vector;
    cv::Rodrigues(rotation, vector);
    return {vector[0],
            vector[1],
            vector[2],
            pose[3].x / metresPerUnit,
            pose[3].y / metresPerUnit,
            pose[3].z / metresPerUnit};
}

CalibratedDevice deviceOf(const CalibratedCamera& camera) {
    CalibratedDevice device;
    device.size = {camera.size.x, camera.size.y};
    device.lens = {camera.focal.x,       camera.focal.y / camera.focal.x,
                   camera.principal.x,   camera.principal.y,
                   camera.distortion[0], camera.distortion[1],
                   camera.distortion[2], camera.distortion[3],
                   camera.distortion[4]};
    return device;
}

/// The lab's true figures as a calibration would give them that makes no error: everything in the camera's frame.
ProcamCalibration trueCalibration(const BoardLab& lab, double metresPerUnit) {
    ProcamCalibration result;
    result.camera = deviceOf(lab.camera());
    result.projector = deviceOf(lab.projector().camera);
    const glm::dmat4& camera = lab.camera().cameraFromWorld;
    result.projectorFromCamera = vectorOf(lab.projector().camera.cameraFromWorld * glm::inverse(camera), metresPerUnit);
    for (const glm::dmat4& pose : lab.proposePoses(3)) {
        result.views.push_back({"pose_" + std::to_string(result.views.size()), 0.1, 0.1, {}});
        result.state.cameraFromBoard.push_back(vectorOf(camera * pose, metresPerUnit));
    }
    return result;
}

Installation labRoom() {
    Installation room = defaultInstallation();
    CalibratedCamera& projector = room.projectors.front().camera;
    projector.principal.y = 1.1 * projector.size.y; // lens shift: outside of the picture
    projector.distortion = {-0.05, 0.02, 0.001, -0.002, 0.003};
    return room;
}

double largestPoseError(const CalibratedCamera& one, const CalibratedCamera& other) {
    double most = 0.0;
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            most = std::max(most, std::abs(one.cameraFromWorld[column][row] - other.cameraFromWorld[column][row]));
    return most;
}

TEST(CalibratedRoom, HasProjectorAndCameraWhereTheLabTrulyHasThem) {
    struct Case {
        const char* board;
        double metresPerUnit;
    };
    for (const Case& one :
         {Case{"chess:9x7:25", 0.001}, Case{"charuco:7x5:3:2.2", 0.01}, Case{"circles:4x11:0.02", 1.0}}) {
        BoardLabOptions options;
        options.metresPerUnit = one.metresPerUnit;
        const CalibrationBoard board = parseCalibrationBoard(one.board);
        const BoardLab lab(labRoom(), board, options);
        RoomPlacement placement;
        placement.metresPerUnit = one.metresPerUnit;
        placement.date = "2026-11-25T10:00:00Z";
        const Installation before = defaultInstallation();
        const Installation after = withCalibration(before, trueCalibration(lab, one.metresPerUnit), board, placement);
        const InstalledProjector& projector = after.projectors.front();
        EXPECT_LT(largestPoseError(projector.camera, lab.projector().camera), 1e-9) << one.board;
        EXPECT_EQ(projector.camera.size, lab.projector().camera.size);
        EXPECT_EQ(projector.camera.principal, lab.projector().camera.principal);
        EXPECT_EQ(projector.camera.distortion, lab.projector().camera.distortion);
        ASSERT_EQ(after.cameras.size(), 1U) << "added, where there was none";
        EXPECT_LT(largestPoseError(after.cameras.front().camera, lab.camera()), 1e-9) << one.board;
        EXPECT_EQ(projector.lens.way, Origin::Way::measured);
        EXPECT_EQ(projector.pose.method, "structured light, 3 boards");
        EXPECT_EQ(projector.pose.date, placement.date);
        EXPECT_EQ(projector.response, before.projectors.front().response) << "nobody measured it";
        // All else is as it was.
        Installation rest = after;
        rest.projectors = before.projectors;
        rest.cameras = before.cameras;
        EXPECT_EQ(rest, before);
    }
}

TEST(CalibratedRoom, LensIsThatOfOpenCv) {
    const BoardLab lab(labRoom(), parseCalibrationBoard("chess:9x7:25"));
    const Installation room = withCalibration(defaultInstallation(), trueCalibration(lab, 0.001), lab.board());
    const CalibratedCamera& camera = room.projectors.front().camera;
    cv::Matx33d rotation;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) rotation(row, column) = camera.cameraFromWorld[column][row];
    cv::Vec3d vector;
    cv::Rodrigues(rotation, vector);
    const glm::dvec3 shift(camera.cameraFromWorld[3]);
    const cv::Matx33d matrix(camera.focal.x, 0, camera.principal.x, 0, camera.focal.y, camera.principal.y, 0, 0, 1);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> place(-0.4, 0.4);
    std::vector<cv::Point3d> points;
    for (int i = 0; i < 200; ++i) points.emplace_back(place(random), 0.2 + 0.5 * place(random), place(random));
    std::vector<cv::Point2d> pixels;
    cv::projectPoints(points, vector, cv::Vec3d(shift.x, shift.y, shift.z), matrix,
                      std::vector<double>(camera.distortion.begin(), camera.distortion.end()), pixels);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto pixel = pixelOf(camera, {points[i].x, points[i].y, points[i].z});
        ASSERT_TRUE(pixel);
        EXPECT_NEAR(pixel->x, pixels[i].x, 1e-6);
        EXPECT_NEAR(pixel->y, pixels[i].y, 1e-6);
    }
}

TEST(CalibratedRoom, WorldIsWhereTheBoardIsSaidToHaveLain) {
    const CalibrationBoard board = parseCalibrationBoard("chess:9x7:25");
    const BoardLab lab(labRoom(), board);
    const ProcamCalibration result = trueCalibration(lab, 0.001);
    RoomPlacement placement;
    placement.middle = {0.3, -0.2};
    placement.turn = 0.7;
    const glm::dmat4 world = worldFromCamera(result, board, defaultInstallation(), placement);
    const glm::dmat4 boardInWorld = world * lab.camera().cameraFromWorld * lab.proposePoses(1)[0];
    const glm::dvec3 middle(boardInWorld * glm::dvec4(0.5 * 8 * 0.025, 0.5 * 6 * 0.025, 0.0, 1.0));
    EXPECT_NEAR(glm::length(middle - glm::dvec3(0.3, 0.0, -0.2)), 0.0, 1e-9);
    EXPECT_NEAR(glm::length(glm::dvec3(boardInWorld[0]) - glm::dvec3(std::cos(0.7), 0.0, -std::sin(0.7))), 0.0, 1e-9);
    // A board that was found half a turn round, as a chessboard may be, gives the same world.
    ProcamCalibration turned = result;
    glm::dmat4 half(-1.0);
    half[2] = {0.0, 0.0, 1.0, 0.0};
    half[3] = {8 * 0.025, 6 * 0.025, 0.0, 1.0};
    turned.state.cameraFromBoard[0] = vectorOf(lab.camera().cameraFromWorld * lab.proposePoses(1)[0] * half, 0.001);
    placement = {};
    const Installation one = withCalibration(labRoom(), result, board, placement);
    const Installation other = withCalibration(labRoom(), turned, board, placement);
    EXPECT_LT(largestPoseError(one.projectors[0].camera, other.projectors[0].camera), 1e-9);
}

TEST(CalibratedRoom, WhatCannotBeIsRefusedAndOtherPosesCanBeChosen) {
    const CalibrationBoard board = parseCalibrationBoard("chess:9x7:25");
    const BoardLab lab(labRoom(), board);
    ProcamCalibration result = trueCalibration(lab, 0.001);
    EXPECT_THAT(tableViewsOf(result), ElementsAre("pose_0", "pose_1", "pose_2"));
    result.state.cameraFromBoard[0][5] = std::nan("");
    EXPECT_THAT(tableViewsOf(result), ElementsAre("pose_1", "pose_2"));
    const auto refusalOf = [&](const RoomPlacement& placement) {
        try {
            (void)withCalibration(defaultInstallation(), result, board, placement);
        } catch (const InvalidInput& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    RoomPlacement placement;
    placement.tableView = "pose_0";
    EXPECT_THAT(refusalOf(placement), testing::HasSubstr("has no known board"));
    placement.tableView = "absent";
    EXPECT_THAT(refusalOf(placement), testing::HasSubstr("'absent'"));
    placement = {};
    EXPECT_EQ(refusalOf(placement), "") << "the first that is known";
    placement.metresPerUnit = 0.0;
    EXPECT_THAT(refusalOf(placement), testing::HasSubstr("unit"));
    placement = {};
    placement.projector = 4;
    EXPECT_THAT(refusalOf(placement), testing::HasSubstr("projector 5"));
    placement.projector = 1;
    EXPECT_EQ(withCalibration(defaultInstallation(), result, board, placement).projectors.size(), 2U);
    // A camera alone moves no projector.
    result.projector = {};
    const Installation alone = withCalibration(defaultInstallation(), result, board);
    EXPECT_EQ(alone.projectors, defaultInstallation().projectors);
    EXPECT_EQ(alone.cameras.front().lens.method, "pictures of a board, 3 boards");
}

} // namespace
} // namespace lumorph::test
