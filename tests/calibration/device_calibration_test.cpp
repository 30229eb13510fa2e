#include "calibration/solve/device_calibration.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include <glm/gtc/matrix_transform.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>

#include "calibration/lab/lab.h"
#include "tests/support/cut_tablet.h"
#include "tests/support/long_tests.h"
#include "tests/support/procam_capture.h"

namespace lumorph::test {
namespace {

const Rig& deviceRig() {
    static const Rig rig = test::cutTablet();
    return rig;
}

/// Turns a camera's principal point away from the middle of its picture, which stays on what it looked at.
CalibratedCamera shifted(CalibratedCamera camera, double pixels) {
    const double lean = std::atan2(pixels, camera.focal.y);
    camera.cameraFromWorld = glm::rotate(glm::dmat4(1.0), lean, glm::dvec3(1.0, 0.0, 0.0)) * camera.cameraFromWorld;
    camera.principal.y += pixels;
    return camera;
}

/// Two cameras and two projectors around the tablet, which stands on a table that is lit too. The device is the world.
struct DeviceRoom {
    std::vector<CalibratedCamera> cameras, projectors;
    std::vector<NamedDevice> cameraNames, projectorNames;

    explicit DeviceRoom(std::uint32_t seed) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> off(-1.0, 1.0);
        const auto near = [&](double x, double y, double z) {
            return glm::dvec3(x + 0.1 * off(random), y + 0.1 * off(random), z + 0.1 * off(random));
        };
        const glm::dvec3 middle(0.0, 0.03, 0.0);
        cameras = {cameraLookingAt(near(-0.5, 1.2, 0.7), middle, {640, 480}, 2300.0 + 200.0 * off(random)),
                   cameraLookingAt(near(0.6, 1.1, 0.5), middle, {640, 480}, 2100.0 + 200.0 * off(random))};
        cameras[0].distortion = {-0.18, 0.05, 0.0005, -0.0005, 0.0};
        cameras[1].distortion = {-0.12, 0.0, 0.0, 0.001, 0.0};
        cameras[0].principal += glm::dvec2(8.0 * off(random), 8.0 * off(random));
        projectors = {shifted(cameraLookingAt(near(0.1, 2.0, 0.4), middle, {1024, 768}, 4200.0), 380.0),
                      shifted(cameraLookingAt(near(-0.5, 1.7, -0.5), middle, {1280, 800}, 3900.0), 300.0)};
        projectors[0].distortion = {-0.05, 0.02, 0.0004, -0.0003, 0.0};
        projectors[1].distortion = {-0.03, 0.0, 0.0, 0.0, 0.0};
        for (int i = 0; i < 2; ++i) {
            cameraNames.push_back({"camera " + std::to_string(i + 1), {640, 480}});
            projectorNames.push_back(
                {"projector " + std::to_string(i + 1),
                 {projectors[static_cast<std::size_t>(i)].size.x, projectors[static_cast<std::size_t>(i)].size.y}});
        }
    }

    /// At rest, each flap raised by itself, and all half way.
    static std::vector<std::vector<double>> states() {
        std::vector<std::vector<double>> all(8, std::vector<double>(deviceRig().actuatorCount(), 0.0));
        for (std::size_t i = 0; i < 6; ++i) all[i + 1][i] = 0.75;
        all[7].assign(deviceRig().actuatorCount(), 0.4);
        return all;
    }

    /// What a decoder would find in every `step`th camera pixel, by rays of the lab; some of it is wrong.
    [[nodiscard]] std::vector<DeviceShot> capture(int step, double noise, std::uint32_t seed) const {
        std::mt19937 random(seed);
        std::normal_distribution<double> grain(0.0, noise);
        std::uniform_real_distribution<double> chance(0.0, 1.0);
        std::vector<DeviceShot> shots;
        for (const auto& strokes : states()) {
            LabWorld world;
            const TriangleMesh table{
                {{-0.6F, 0.0F, -0.45F}, {0.6F, 0.0F, -0.45F}, {-0.6F, 0.0F, 0.45F}, {0.6F, 0.0F, 0.45F}},
                {{0, 2, 1}, {1, 2, 3}}};
            world.surfaces = {{deformed(deviceRig(), strokes), glm::vec3(0.8F)}, {table, glm::vec3(0.5F)}};
            for (const CalibratedCamera& camera : projectors) {
                InstalledProjector projector;
                projector.camera = camera;
                world.projectors.push_back({projector, Image(camera.size)});
            }
            const Lab lab(std::move(world));
            DeviceShot shot{"state_" + std::to_string(shots.size()), strokes, {}};
            shot.light.assign(2, std::vector<std::vector<ProjectorPoint>>(2));
            for (std::size_t c = 0; c < 2; ++c)
                for (int y = 0; y < cameras[c].size.y; y += step)
                    for (int x = 0; x < cameras[c].size.x; x += step) {
                        const auto hit = lab.trace(positionOf(cameras[c]), directionOf(cameras[c], glm::dvec2(x, y)));
                        if (!hit || hit->surface < 0) continue;
                        for (std::size_t p = 0; p < 2; ++p) {
                            if (!lab.lit(p, hit->point, hit->normal)) continue;
                            const auto at = pixelOf(projectors[p], hit->point);
                            cv::Point2d pixel(at->x + grain(random), at->y + grain(random));
                            if (chance(random) < 0.01) pixel += cv::Point2d(60.0 * grain(random) / noise, 40.0);
                            shot.light[c][p].push_back({cv::Point2d(x, y), pixel});
                        }
                    }
            shots.push_back(std::move(shot));
        }
        return shots;
    }

    /// Root mean square of how far light beside where it belongs, over the device at rest and raised; projector pixels.
    [[nodiscard]] double projectorError(const DeviceCalibration& result, std::size_t p) const {
        double sum = 0.0, count = 0.0;
        BundleState solved;
        solved.projector = result.state.projectors[p].lens;
        solved.projectorFromCamera = result.state.projectors[p].fromWorld;
        for (const double stroke : {0.0, 0.5, 1.0}) {
            const TriangleMesh mesh = deformed(deviceRig(), std::vector<double>(deviceRig().actuatorCount(), stroke));
            for (std::size_t i = 0; i < mesh.positions.size(); i += 11) {
                const glm::dvec3 point(mesh.positions[i]);
                const cv::Point2d at = projectorPixel({point.x, point.y, point.z}, solved);
                const auto truth = pixelOf(projectors[p], point);
                sum += std::pow(at.x - truth->x, 2) + std::pow(at.y - truth->y, 2);
                count += 1.0;
            }
        }
        return std::sqrt(sum / count);
    }

    /// The truth, off by 10 cm, 10 degrees and 10 % of each focal length.
    [[nodiscard]] InstallationState roughStart(std::uint32_t seed) const {
        std::mt19937 random(seed);
        std::normal_distribution<double> any(0.0, 1.0);
        InstallationState start;
        const auto rough = [&](const CalibratedCamera& truth) {
            const glm::dvec3 axis = glm::normalize(glm::dvec3(any(random), any(random), any(random)));
            const glm::dvec3 way = 0.1 * glm::normalize(glm::dvec3(any(random), any(random), any(random)));
            const glm::dmat4 pose = glm::rotate(glm::dmat4(1.0), glm::radians(10.0), axis) * truth.cameraFromWorld *
                                    glm::translate(glm::dmat4(1.0), way);
            InstallationState::Device device;
            const double focal = truth.focal.x * (any(random) > 0.0 ? 1.1 : 0.9);
            device.lens = {focal, 1.0, 0.5 * (truth.size.x - 1), truth.principal.y, 0, 0, 0, 0, 0};
            cv::Matx33d turn;
            for (int row = 0; row < 3; ++row)
                for (int column = 0; column < 3; ++column) turn(row, column) = pose[column][row];
            cv::Vec3d vector;
            cv::Rodrigues(turn, vector);
            device.fromWorld = {vector[0], vector[1], vector[2], pose[3].x, pose[3].y, pose[3].z};
            return device;
        };
        for (const CalibratedCamera& camera : cameras) start.cameras.push_back(rough(camera));
        for (const CalibratedCamera& projector : projectors) start.projectors.push_back(rough(projector));
        return start;
    }
};

// Bar: two projectors and two cameras on the device alone, no board and no guess: half a projector pixel.
TEST(DeviceCalibration, TwoProjectorsAndTwoCamerasOnTheDeviceAloneWithinHalfAPixel) {
    const std::uint32_t rooms = longTests() ? 10 : 1;
    for (std::uint32_t seed = 1; seed <= rooms; ++seed) {
        const DeviceRoom room(seed);
        const auto shots = room.capture(5, 0.15, seed);
        const DeviceCalibration result = calibrateOnDevice(deviceRig(), shots, room.cameraNames, room.projectorNames);
        const double first = room.projectorError(result, 0), second = room.projectorError(result, 1);
        std::printf(
            "room %u: light beside where it belongs by %.3f and %.3f projector pixels; noise found %.3f, %.0f %% "
            "of the light on the device fits\n",
            seed, first, second, result.rms, 100.0 * result.onDevice);
        EXPECT_LT(first, 0.5);
        EXPECT_LT(second, 0.5);
        EXPECT_NEAR(result.rms, 0.15, 0.04);
        for (std::size_t c = 0; c < 2; ++c)
            EXPECT_NEAR(result.cameras[c].lens[kFocalLength], room.cameras[c].focal.x, 0.02 * room.cameras[c].focal.x);
    }
}

TEST(DeviceCalibration, ARoughStartThatIsWrongByTenCentimetresDegreesAndPercentLeadsToTheSame) {
    if (!longTests()) GTEST_SKIP() << "with fewer shots, ARoughStartTakesThePlaceOfShots asks more";
    const std::uint32_t rooms = 10;
    for (std::uint32_t seed = 21; seed < 21 + rooms; ++seed) {
        const DeviceRoom room(seed);
        DeviceSolveOptions options;
        options.start = room.roughStart(seed);
        const DeviceCalibration result =
            calibrateOnDevice(deviceRig(), room.capture(6, 0.15, seed), room.cameraNames, room.projectorNames, options);
        std::printf("room %u from a rough start: %.3f and %.3f projector pixels\n", seed,
                    room.projectorError(result, 0), room.projectorError(result, 1));
        EXPECT_LT(room.projectorError(result, 0), 0.5);
        EXPECT_LT(room.projectorError(result, 1), 0.5);
    }
}

TEST(DeviceCalibration, ARoughStartTakesThePlaceOfShots) {
    const std::uint32_t rooms = longTests() ? 10 : 1;
    for (std::uint32_t seed = 31; seed < 31 + rooms; ++seed) {
        const DeviceRoom room(seed);
        const auto all = room.capture(6, 0.15, seed);
        const std::vector<DeviceShot> few = {all[0], all[1], all[4], all[6]}; // three flaps alone place nothing
        DeviceSolveOptions options;
        options.start = room.roughStart(seed);
        const DeviceCalibration result =
            calibrateOnDevice(deviceRig(), few, room.cameraNames, room.projectorNames, options);
        std::printf("room %u, three flaps from a rough start: %.3f and %.3f projector pixels\n", seed,
                    room.projectorError(result, 0), room.projectorError(result, 1));
        EXPECT_LT(room.projectorError(result, 0), 0.5);
        EXPECT_LT(room.projectorError(result, 1), 0.5);
    }
}

/// Grey pictures of Gray code on the tablet, decoded: what a capture goes through.
std::vector<DeviceShot> photographed(const DeviceRoom& room, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> grain(0.0, 1.0); // grey levels
    std::vector<DeviceShot> shots;
    for (const auto& strokes : DeviceRoom::states()) {
        DeviceShot shot{"state_" + std::to_string(shots.size()), strokes, {}};
        shot.light.assign(2, std::vector<std::vector<ProjectorPoint>>(2));
        for (std::size_t p = 0; p < 2; ++p) {
            LabWorld world;
            world.surfaces = {{deformed(deviceRig(), strokes), glm::vec3(0.8F)}};
            world.ambient = glm::vec3(0.05F);
            InstalledProjector projector;
            projector.camera = room.projectors[p];
            projector.peak = 1.0;
            projector.gamma = 1.0;
            world.projectors = {{projector, Image(projector.camera.size)}};
            Lab lab(std::move(world));
            for (std::size_t c = 0; c < 2; ++c) {
                const LabSight sight = lab.look(room.cameras[c], 3);
                std::vector<cv::Mat> images;
                for (const Light& light : grayCodeLights(projector.camera.size)) {
                    Image pattern(projector.camera.size);
                    for (int y = 0; y < pattern.size().y; ++y)
                        for (int x = 0; x < pattern.size().x; ++x) {
                            const auto value = static_cast<std::uint8_t>(255.0 * light(x, y));
                            pattern.at(x, y) = {value, value, value, 255};
                        }
                    lab.show(0, pattern);
                    const std::vector<glm::vec3> radiance = lab.radiance(sight);
                    cv::Mat& grey = images.emplace_back(room.cameras[c].size.y, room.cameras[c].size.x, CV_8UC1);
                    for (std::size_t i = 0; i < radiance.size(); ++i)
                        grey.data[i] = cv::saturate_cast<std::uint8_t>(200.0 * radiance[i].g + grain(random));
                }
                const CaptureOrder order = parsePattern("graycode", {projector.camera.size.x, projector.camera.size.y});
                shot.light[c][p] = lightOf(decodeView(images, order), 20000);
            }
        }
        shots.push_back(std::move(shot));
    }
    return shots;
}

TEST(DeviceCalibration, PicturesOfGrayCodeOnTheDeviceSuffice) {
    if (!longTests()) GTEST_SKIP() << "1,200 pictures: LUMORPH_LONG_TESTS=1 takes them";
    DeviceRoom room(41);
    for (CalibratedCamera& projector : room.projectors) { // a camera pixel must resolve the stripes
        projector.size /= 2;
        projector.focal *= 0.5;
        projector.principal *= 0.5;
    }
    for (std::size_t p = 0; p < 2; ++p)
        room.projectorNames[p].size = {room.projectors[p].size.x, room.projectors[p].size.y};
    const DeviceCalibration result =
        calibrateOnDevice(deviceRig(), photographed(room, 5), room.cameraNames, room.projectorNames);
    std::printf("from pictures: %.3f and %.3f projector pixels; noise found %.3f, %.0f %% fits\n",
                room.projectorError(result, 0), room.projectorError(result, 1), result.rms, 100.0 * result.onDevice);
    EXPECT_LT(room.projectorError(result, 0), 0.5);
    EXPECT_LT(room.projectorError(result, 1), 0.5);
}

Finding deviceRefusal(const DeviceRoom& room, const std::vector<DeviceShot>& shots, const Rig& rig = deviceRig()) {
    try {
        (void)calibrateOnDevice(rig, shots, room.cameraNames, room.projectorNames);
    } catch (const CaptureRefused& refused) {
        return refused.finding();
    }
    ADD_FAILURE() << "it was accepted";
    return {Cause::unreadableImage, "", "", "", ""};
}

TEST(DeviceCalibration, WhatTellsTooLittleOrContradictsTheRigIsRefused) {
    const DeviceRoom room(3);
    const auto shots = room.capture(8, 0.15, 3);
    const std::vector<DeviceShot> rest(shots.begin(), shots.begin() + 1);
    EXPECT_EQ(deviceRefusal(room, rest).cause, Cause::tooFewViews);
    const std::vector<DeviceShot> three(shots.begin(), shots.begin() + 3); // two flaps place nothing
    EXPECT_EQ(deviceRefusal(room, three).cause, Cause::tooFewViews);
    auto apart = shots; // each camera sees a projector of its own
    for (DeviceShot& shot : apart) shot.light[0][1] = shot.light[1][0] = {};
    const Finding finding = deviceRefusal(room, apart);
    EXPECT_EQ(finding.cause, Cause::disconnected);
    EXPECT_THAT(finding.why, ::testing::AnyOf(::testing::HasSubstr("camera 1, projector 1 share"),
                                              ::testing::HasSubstr("camera 2, projector 2 share")));
    auto dark = shots;
    for (DeviceShot& shot : dark) shot.light.assign(2, std::vector<std::vector<ProjectorPoint>>(2));
    EXPECT_EQ(deviceRefusal(room, dark).cause, Cause::boardUnlit);
    auto exchanged = shots; // flaps that are not those they are said to be
    for (DeviceShot& shot : exchanged) std::ranges::reverse(shot.strokes);
    EXPECT_EQ(deviceRefusal(room, exchanged).cause, Cause::modelDoesNotFit);
    auto partly = shots; // a sixth of the light lies two pixels beside, and a hundredth anywhere
    for (DeviceShot& shot : partly)
        for (auto& seen : shot.light)
            for (auto& light : seen)
                for (std::size_t i = 0; i < light.size(); i += 6) light[i].projector.x += 2.0;
    const Finding part = deviceRefusal(room, partly);
    EXPECT_EQ(part.cause, Cause::modelDoesNotFit);
    int share = 0;
    double beside = 0.0;
    ASSERT_EQ(std::sscanf(part.why.c_str(),
                          "the light does not fit the device's shape: %d of 100 lit points lie on it as it was told to "
                          "stand, the others lie %lf projector",
                          &share, &beside),
              2)
        << part.why;
    EXPECT_NEAR(share, 82, 4);
    EXPECT_NEAR(beside, 2.0, 0.4);
    auto broken = shots;
    broken[1].strokes.pop_back();
    EXPECT_THROW((void)calibrateOnDevice(deviceRig(), broken, room.cameraNames, room.projectorNames), InvalidInput);
}

} // namespace
} // namespace lumorph::test
