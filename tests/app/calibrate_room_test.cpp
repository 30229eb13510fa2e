#include <filesystem>
#include <fstream>
#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/process.h"
#include "tests/core/temporary_folder.h"
#include "tests/support/procam_capture.h"

namespace lumorph::test {
namespace {

using ::testing::HasSubstr;
using ::testing::MatchesRegex;

const char* const kPattern = "phase:16x3+1x3";

void writeImages(const std::filesystem::path& folder, const std::vector<Image>& images) {
    std::filesystem::create_directories(folder);
    for (std::size_t i = 0; i < images.size(); ++i) writePng(images[i], folder / imageName(i));
}

void expectRefusal(const Outcome& outcome, const std::string& cause) {
    EXPECT_EQ(outcome.exitCode, 1);
    EXPECT_THAT(outcome.err, MatchesRegex("lumorph: [^\n]+: [^\n]+; [^\n]+\n"));
    ASSERT_FALSE(outcome.out.empty()) << outcome.err;
    EXPECT_EQ(outcome.json()["refused"]["cause"], cause) << outcome.err;
}

/// Two cameras and two projectors; the second camera does not see the last two poses, nor the first camera the second
/// projector's light on it.
class CalibrateRoom : public ::testing::Test {
protected:
    static void SetUpTestSuite() {
        folder_ = std::make_unique<TemporaryFolder>();
        setup_ = ProcamSetup::usual();
        CalibratedCamera second = setup_.camera;
        second.focal = glm::dvec2(820.0);
        second.principal = {230.0, 190.0};
        second.cameraFromWorld = glm::translate(glm::dmat4(1.0), {-260.0, 20.0, 40.0}) *
                                 glm::rotate(glm::dmat4(1.0), glm::radians(14.0), {0.0, 1.0, 0.0});
        side_ = setup_.projector;
        side_.focal = glm::dvec2(520.0);
        side_.principal = {120.0, 30.0};
        side_.cameraFromWorld = glm::translate(glm::dmat4(1.0), {210.0, 120.0, 30.0}) *
                                glm::rotate(glm::dmat4(1.0), glm::radians(-9.0), {0.0, 1.0, 0.0});
        const std::filesystem::path room = *folder_ / "room";
        for (std::size_t pose = 0; pose < setup_.cameraFromBoard.size(); ++pose) {
            const bool last = pose + 1 == setup_.cameraFromBoard.size();
            const auto at = room / ("pose_" + std::to_string(pose));
            look(at / "left" / "upper", setup_.camera, setup_.projector, pose);
            if (last) continue;
            look(at / "left" / "side", setup_.camera, side_, pose);
            look(at / "right" / "upper", second, setup_.projector, pose);
            look(at / "right" / "side", second, side_, pose);
        }
    }
    static void TearDownTestSuite() { folder_.reset(); }

    /// Photographs a pose in the frame of the camera, as the simulation wants it.
    static void look(const std::filesystem::path& folder, const CalibratedCamera& camera,
                     const CalibratedCamera& projector, std::size_t pose) {
        ProcamSetup seen = setup_;
        seen.camera = camera;
        seen.camera.cameraFromWorld = glm::dmat4(1.0);
        seen.projector = projector;
        seen.projector.cameraFromWorld = projector.cameraFromWorld * glm::inverse(camera.cameraFromWorld);
        writeImages(folder, photographAll(seen, camera.cameraFromWorld * setup_.cameraFromBoard[pose],
                                          phaseLights(projector.size, 16), static_cast<std::uint32_t>(pose) + 1));
    }

    static Outcome room(const std::filesystem::path& folder, const std::vector<std::string>& more = {"--json"},
                        const std::string& upper = "upper=256x192") {
        std::vector<std::string> arguments{"calibrate",    "room",        folder.string(), "--board",
                                           "chess:9x7:30", "--projector", upper,           "--projector",
                                           "side=256x192", "--pattern",   kPattern};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return lumorph(arguments);
    }
    /// A copy to spoil.
    static std::filesystem::path copied(const std::string& name) {
        std::filesystem::copy(*folder_ / "room", *folder_ / name, std::filesystem::copy_options::recursive);
        return *folder_ / name;
    }

    static std::unique_ptr<TemporaryFolder> folder_;
    static ProcamSetup setup_;
    static CalibratedCamera side_;
};

std::unique_ptr<TemporaryFolder> CalibrateRoom::folder_;
ProcamSetup CalibrateRoom::setup_;
CalibratedCamera CalibrateRoom::side_;

TEST_F(CalibrateRoom, PrintsTheTrueLensesAndPlacesOfAllDevices) {
    const Outcome outcome = room(*folder_ / "room");
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const nlohmann::json result = outcome.json();
    ASSERT_EQ(result["cameras"].size(), 2U);
    ASSERT_EQ(result["projectors"].size(), 2U);
    for (const char* key : {"rms", "views", "worstView", "warnings"}) EXPECT_TRUE(result.contains(key)) << key;
    const auto expectDevice = [](const nlohmann::json& device, const std::string& name, double focal,
                                 const glm::dvec3& way) {
        EXPECT_EQ(device["name"], name);
        for (const char* key : {"K", "distortion", "size", "rms", "sigma", "R", "T"})
            EXPECT_TRUE(device.contains(key)) << key;
        EXPECT_NEAR(device["K"][0][0], focal, 0.005 * focal) << name;
        for (int i = 0; i < 3; ++i) EXPECT_NEAR(device["T"][static_cast<std::size_t>(i)], way[i], 6.0) << name;
    };
    expectDevice(result["cameras"][0], "left", 960.0, glm::dvec3(0.0));
    expectDevice(result["cameras"][1], "right", 820.0, {-260.0, 20.0, 40.0});
    expectDevice(result["projectors"][0], "upper", 470.0, glm::dvec3(setup_.projector.cameraFromWorld[3]));
    expectDevice(result["projectors"][1], "side", 520.0, glm::dvec3(side_.cameraFromWorld[3]));
    EXPECT_EQ(result["views"].size(), 6U);
    EXPECT_LT(result["rms"], 0.3);
}

TEST_F(CalibrateRoom, PrintsTextForPeople) {
    const Outcome outcome = room(*folder_ / "room", {});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    for (const char* word : {"left", "right", "upper", "side", "focal length", "(worst)"})
        EXPECT_THAT(outcome.out, HasSubstr(word));
}

TEST_F(CalibrateRoom, AProjectorThatSharesNothingIsRefusedByName) {
    const auto spoiled = copied("apart");
    for (std::size_t pose = 0; pose < 6; ++pose) {
        const auto at = spoiled / ("pose_" + std::to_string(pose));
        for (const char* camera : {"left", "right"}) std::filesystem::remove_all(at / camera / "side");
    }
    const Outcome outcome = room(spoiled);
    expectRefusal(outcome, "disconnected");
    EXPECT_THAT(outcome.err, HasSubstr("side"));
}

TEST_F(CalibrateRoom, AMissingImageIsRefusedByPlace) {
    const auto spoiled = copied("missing");
    std::filesystem::remove(spoiled / "pose_1" / "right" / "side" / imageName(3));
    const Outcome missing = room(spoiled);
    expectRefusal(missing, "missing_image");
    EXPECT_THAT(missing.err, HasSubstr("pose_1/right/side"));
}

TEST_F(CalibrateRoom, WrongFoldersAndNamesAreRefused) {
    const Outcome nowhere = room(*folder_ / "nowhere");
    EXPECT_EQ(nowhere.exitCode, 1);
    EXPECT_THAT(nowhere.err, MatchesRegex("lumorph: [^\n]+: [^\n]+; [^\n]+\n"));
    const Outcome unknown = room(*folder_ / "room", {}, "top=256x192");
    EXPECT_EQ(unknown.exitCode, 1);
    EXPECT_THAT(unknown.err, HasSubstr("upper"));
    const auto order = *folder_ / "order.txt";
    std::ofstream(order) << "white\nrow bit x\n";
    const Outcome badOrder = room(*folder_ / "room", {"--order", order.string()});
    EXPECT_EQ(badOrder.exitCode, 1);
    EXPECT_THAT(badOrder.err, HasSubstr("order.txt, line 2"));
    EXPECT_EQ(room(*folder_ / "room", {}, "256x192").exitCode, 2);
    EXPECT_EQ(room(*folder_ / "room", {}, "side=256x192").exitCode, 2);
}

/// A camera beside a mirror. Its picture of what the mirror shows is that of an ordinary camera behind the mirror,
/// turned left for right.
class CalibrateMirror : public ::testing::Test {
protected:
    static void SetUpTestSuite() {
        folder_ = std::make_unique<TemporaryFolder>();
        setup_ = ProcamSetup::usual();
        setup_.camera.size = {640, 360};
        setup_.camera.focal = glm::dvec2(640.0);
        setup_.camera.principal = {325.0, 172.0};
        setup_.camera.distortion = {-0.12, 0.0, 0.0, 0.0, 0.0};
        const glm::dmat4 aside = glm::translate(glm::dmat4(1.0), {150.0, 0.0, -50.0});
        for (glm::dmat4& board : setup_.cameraFromBoard) board = aside * board;
        setup_.projector.cameraFromWorld = setup_.projector.cameraFromWorld * glm::inverse(aside);
        normal_ = glm::normalize(glm::dvec3(-1.0, 0.05, 0.1));
        // Reflected in the plane, then x turned round.
        glm::dmat4 behind(1.0);
        for (int column = 0; column < 3; ++column) behind[column] -= glm::dvec4(2.0 * normal_[column] * normal_, 0.0);
        behind[3] = glm::dvec4(2.0 * kDistance * normal_, 1.0);
        behind = glm::scale(glm::dmat4(1.0), {-1.0, 1.0, 1.0}) * behind;
        ProcamSetup seen = setup_;
        seen.camera.principal.x = setup_.camera.size.x - 1 - setup_.camera.principal.x;
        seen.projector.cameraFromWorld = setup_.projector.cameraFromWorld * glm::inverse(behind);
        for (std::size_t pose = 0; pose < setup_.cameraFromBoard.size(); ++pose) {
            std::vector<Image> images =
                photographAll(seen, behind * setup_.cameraFromBoard[pose], phaseLights(setup_.projector.size, 16),
                              static_cast<std::uint32_t>(pose) + 1);
            for (Image& image : images) image = leftForRight(image);
            const auto at = *folder_ / "capture" / ("pose_" + std::to_string(pose));
            writeImages(at, images);
            if (pose % 2 == 1) continue;
            const auto white = [](int, int) { return 1.0; };
            writePng(photograph(setup_, seenSamples(setup_, setup_.cameraFromBoard[pose]), white, 9),
                     at / "direct.png");
        }
    }
    static void TearDownTestSuite() { folder_.reset(); }

    static Image leftForRight(const Image& image) {
        Image turned(image.size());
        const auto width = static_cast<std::size_t>(image.size().x);
        for (std::size_t i = 0; i < image.pixels().size(); ++i)
            turned.pixels()[i] = image.pixels()[i - i % width + (width - 1 - i % width)];
        return turned;
    }

    static Outcome mirror(const std::filesystem::path& folder, const std::vector<std::string>& more = {"--json"}) {
        std::vector<std::string> arguments{"calibrate",   "mirror",  folder.string(), "--board", "chess:9x7:30",
                                           "--projector", "256x192", "--pattern",     kPattern};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return lumorph(arguments);
    }
    static std::filesystem::path copied(const std::string& name) {
        std::filesystem::copy(*folder_ / "capture", *folder_ / name, std::filesystem::copy_options::recursive);
        return *folder_ / name;
    }

    static constexpr double kDistance = 120.0;
    static std::unique_ptr<TemporaryFolder> folder_;
    static ProcamSetup setup_;
    static glm::dvec3 normal_;
};

std::unique_ptr<TemporaryFolder> CalibrateMirror::folder_;
ProcamSetup CalibrateMirror::setup_;
glm::dvec3 CalibrateMirror::normal_;

TEST_F(CalibrateMirror, PrintsTheTrueProjectorAndMirror) {
    const Outcome outcome = mirror(*folder_ / "capture");
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const nlohmann::json result = outcome.json();
    EXPECT_NEAR(result["projector"]["K"][0][0], 470.0, 0.01 * 470.0);
    EXPECT_NEAR(result["camera"]["K"][0][0], 640.0, 0.01 * 640.0);
    EXPECT_NEAR(result["camera"]["K"][0][2], 325.0, 5.0);
    ASSERT_FALSE(result["mirror"].is_null());
    const double sigma = result["mirror"]["sigma"]["distance"];
    EXPECT_NEAR(result["mirror"]["distance"], kDistance, 5.0 * sigma);
    EXPECT_LT(sigma, 3.0);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(result["mirror"]["normal"][static_cast<std::size_t>(i)], normal_[i], 0.01);
    const glm::dvec3 way(setup_.projector.cameraFromWorld[3]);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(result["T"][static_cast<std::size_t>(i)], way[i], 8.0);
    EXPECT_THAT(mirror(*folder_ / "capture", {}).out, HasSubstr("before the camera"));
}

TEST_F(CalibrateMirror, WithoutDirectPicturesTheMirrorIsNull) {
    const auto folder = copied("mirror only");
    for (std::size_t pose = 0; pose < 6; pose += 2)
        std::filesystem::remove(folder / ("pose_" + std::to_string(pose)) / "direct.png");
    const Outcome outcome = mirror(folder);
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_TRUE(outcome.json()["mirror"].is_null());
    EXPECT_EQ(outcome.json()["warnings"].back()["cause"], "mirror_unknown");
}

TEST_F(CalibrateMirror, WhatCannotBeTrustedIsRefused) {
    const auto missing = copied("missing");
    std::filesystem::remove(missing / "pose_2" / imageName(4));
    const Outcome outcome = mirror(missing);
    expectRefusal(outcome, "missing_image");
    EXPECT_THAT(outcome.err, HasSubstr("pose_2"));
    EXPECT_EQ(mirror(*folder_ / "nowhere", {}).exitCode, 1);
    const auto again = copied("again");
    std::filesystem::copy_file(again / "pose_0" / imageName(0), again / "pose_0" / "direct.png",
                               std::filesystem::copy_options::overwrite_existing);
    const Outcome same = mirror(again);
    EXPECT_EQ(same.exitCode, 1);
    EXPECT_THAT(same.err, HasSubstr("direct.png"));
}

} // namespace
} // namespace lumorph::test
