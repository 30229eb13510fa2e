#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calibration/lab/check_lab.h"
#include "calibration/lab/lab_world.h"
#include "calibration/lab/moved_room.h"
#include "calibration/lab/true_room.h"
#include "calibration/verify/check_picture.h"
#include "core/base/error.h"
#include "tests/calibration/measured_stage.h"
#include "tests/support/cut_tablet.h"
#include "tests/support/long_tests.h"

namespace lumorph::test {
namespace {

using ::testing::HasSubstr;

const Rig& verifiedRig() {
    static const Rig rig = test::cutTablet();
    return rig;
}

/// A projector of a quarter of the usual pixels, the lab's camera beside it; the device a little turned.
Installation verifiedRoom() {
    Installation room = defaultInstallation();
    CalibratedCamera& lamp = room.projectors.front().camera;
    lamp = withSize(lamp, {960, 540});
    room.worldFromDevice = glm::mat4(0.98F, 0.0F, -0.199F, 0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 0.199F, 0.0F, 0.98F, 0.0F,
                                     0.01F, 0.0F, -0.015F, 1.0F);
    for (int column : {0, 2}) room.worldFromDevice[column] = glm::normalize(room.worldFromDevice[column]);
    return withLabCamera(room);
}

/// The same by a camera of few pixels.
Installation seenRoom() { return photographedRoom(verifiedRoom(), 480); }

LabBenchOptions quickOptions() {
    LabBenchOptions options;
    options.checkPattern = "phase:16x3+1x3";
    return options;
}

VerifiedRoom checkOf(const std::string& moved, std::uint32_t seed = 1,
                     const LabBenchOptions& options = quickOptions()) {
    const Installation room = seenRoom();
    const Installation truth =
        moved.empty() ? room : pushed(room, verifiedRig(), parseLabPush(moved, verifiedRig()), seed);
    return measuredInLab<VerifiedRoom>("verify", verifiedRig(), room, truth, seed, options);
}

/// Root mean square of how far light lies beside for the true room when the show is drawn for another, by rays of this
/// test alone: places of the raised device and the table around it, each lit by the pixel that the other room has for
/// it; metres.
double trueLightError(const Installation& truth, const Installation& drawn, double stroke = 0.4) {
    const TriangleMesh mesh = deformed(verifiedRig(), std::vector<double>(verifiedRig().actuatorCount(), stroke));
    double sum = 0.0, count = 0.0;
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
        const auto into = [](const Installation& room, const glm::dvec3& p) {
            return glm::dvec3(glm::dmat4(room.worldFromDevice) * glm::dvec4(p, 1.0));
        };
        const glm::dvec3 middle = (a + b + c) / 3.0;
        const glm::dvec3 normal = glm::cross(into(truth, b) - into(truth, a), into(truth, c) - into(truth, a));
        const CalibratedCamera& lamp = truth.projectors.front().camera;
        const glm::dvec3 place = into(truth, middle);
        if (glm::dot(normal, positionOf(lamp) - place) <
            0.3 * glm::length(normal) * glm::length(positionOf(lamp) - place))
            continue;
        const auto pixel = pixelOf(drawn.projectors.front().camera, into(drawn, middle));
        if (!pixel) continue;
        const glm::dvec3 beam = directionOf(lamp, *pixel), from = positionOf(lamp);
        const glm::dvec3 lit = from + beam * (glm::dot(normal, place - from) / glm::dot(normal, beam));
        const double weight = glm::length(normal);
        sum += weight * glm::dot(lit - place, lit - place);
        count += weight;
    }
    return std::sqrt(sum / count);
}

struct MovedCase {
    const char* moved;
    const char* part;
};

void PrintTo(const MovedCase& one, std::ostream* out) { *out << one.moved; }

class VerifyMoved : public testing::TestWithParam<MovedCase> {};

// What was pushed is named, with how far, and the correction puts the light back to where it belongs.
TEST_P(VerifyMoved, IsNamedAndCorrected) {
    const std::uint32_t seeds = longTests() ? 10 : 1;
    for (std::uint32_t seed = 1; seed <= seeds; ++seed) {
        const Installation room = verifiedRoom();
        const Installation truth = pushed(room, verifiedRig(), parseLabPush(GetParam().moved, verifiedRig()), seed);
        const VerifiedRoom found = checkOf(GetParam().moved, seed);
        std::string said = found.check.sentence;
        const double before = trueLightError(truth, room), after = trueLightError(truth, found.installation);
        std::printf("%s: %s\n  true light error %.2f mm before, %.3f mm after; fresh %.2f mm\n", GetParam().moved,
                    said.c_str(), 1e3 * before, 1e3 * after, 1e3 * found.fresh.median);
        ASSERT_EQ(found.check.verdict, RoomCheck::Verdict::moved) << said;
        ASSERT_EQ(found.check.names.size(), 1U) << said;
        EXPECT_EQ(found.check.names.front(), GetParam().part);
        EXPECT_TRUE(found.check.couldAlsoBe.empty());
        EXPECT_LT(after, 0.4e-3);
        EXPECT_LT(found.fresh.median, 0.5e-3);
    }
}

INSTANTIATE_TEST_SUITE_P(Parts, VerifyMoved,
                         testing::Values(MovedCase{"projector:3mm", "projector"}, MovedCase{"camera:3mm", "camera"},
                                         MovedCase{"device:3mm", "device"},
                                         MovedCase{"edge front:6deg", "servo of 'edge front'"}),
                         [](const auto& one) { return "Case" + std::to_string(one.index); });

TEST(VerifyInLab, SaysStillGoodWhereNothingMoved) {
    const VerifiedRoom found = checkOf("");
    std::printf("%s; %d photographs\n", found.check.sentence.c_str(), found.photographs);
    EXPECT_EQ(found.check.verdict, RoomCheck::Verdict::good);
    EXPECT_LT(found.check.device.median, 0.3e-3);
    EXPECT_LT(found.fresh.median, 0.3e-3);
    EXPECT_GT(found.check.map.size(), 500U);
    EXPECT_EQ(found.installation, seenRoom()) << "nothing is corrected that is right";
}

TEST(VerifyInLab, SaysStillGoodAtHalfAMillimetre) {
    for (const char* moved : {"projector:0.5mm", "device:0.5mm"}) {
        const VerifiedRoom found = checkOf(moved, 4);
        std::printf("%s: %s\n", moved, found.check.sentence.c_str());
        EXPECT_EQ(found.check.verdict, RoomCheck::Verdict::good);
    }
}

// All that trueRoom makes wrong is there as well: unmeasured servos with play, other colours of the light.
TEST(VerifyInLab, FindsAProjectorAmongServosThatNobodyMeasured) {
    const Installation room = seenRoom();
    const Installation truth =
        pushed(trueRoom(room, verifiedRig().actuators(), 3), verifiedRig(), {"projector", 3e-3, 0.0}, 3);
    const auto found = measuredInLab<VerifiedRoom>("verify", verifiedRig(), room, truth, 3, quickOptions());
    const double after = trueLightError(truth, found.installation);
    std::printf("%s\n  true light error %.2f mm before, %.3f mm after\n", found.check.sentence.c_str(),
                1e3 * trueLightError(truth, room), 1e3 * after);
    ASSERT_EQ(found.check.verdict, RoomCheck::Verdict::moved);
    EXPECT_EQ(std::ranges::count(found.check.names, "projector"), 1);
    EXPECT_EQ(std::ranges::count(found.check.names, "camera"), 0);
    EXPECT_EQ(std::ranges::count(found.check.names, "device"), 0);
    EXPECT_LT(after, 0.5e-3);
}

TEST(VerifyInLab, NamesWhyThereIsNoVerdict) {
    const auto obstacleOf = [](const LabBenchOptions& options) {
        const VerifiedRoom found = checkOf("projector:3mm", 1, options);
        std::printf("%s\n", found.check.sentence.c_str());
        EXPECT_EQ(found.check.verdict, RoomCheck::Verdict::none);
        EXPECT_EQ(found.installation, seenRoom());
        return found.check.obstacle ? std::string(keyOf(found.check.obstacle->obstacle)) : std::string();
    };
    LabBenchOptions dark = quickOptions(), bright = dark, blurred = dark, covered = dark;
    dark.check.exposure = 0.01;
    bright.check.exposure = 4.0;
    blurred.check.shake = 9.0;
    const glm::vec3 eye(positionOf(verifiedRoom().cameras.front().camera));
    covered.check.hands = {visitorHand(glm::vec3(0.6F) * eye, eye)};
    EXPECT_EQ(obstacleOf(dark), "too_dark");
    EXPECT_EQ(obstacleOf(bright), "overexposed");
    EXPECT_EQ(obstacleOf(blurred), "blurred");
    EXPECT_EQ(obstacleOf(covered), "covered");
}

TEST(MovedParts, ComparesNoMorePointsThanItMay) {
    const Installation room = verifiedRoom();
    const std::vector<double> rest(verifiedRig().actuatorCount(), 0.0);
    const ExpectedLight lit = expectedLight(verifiedRig(), room, rest, 0, 0, 16);
    const RoomSurface surface(room, verifiedRig(), rest);
    const CalibratedCamera& eye = room.cameras.front().camera;
    LitShot shot{rest, {}};
    for (const cv::Point& pixel : lit.pixels) {
        const auto hit = surface.trace(positionOf(eye), directionOf(eye, {pixel.x, pixel.y}));
        ASSERT_TRUE(hit);
        const auto panel = pixelOf(room.projectors.front().camera, hit->point);
        ASSERT_TRUE(panel);
        shot.points.push_back({0, {pixel.x, pixel.y}, *panel});
    }
    MovedPartOptions options;
    options.mostPoints = shot.points.size() * 2 / 3; // fewer than there are, and more than half of them
    const MovedParts moved = movedParts(verifiedRig(), room, std::vector{shot}, options);
    EXPECT_TRUE(moved.parts.empty());
    EXPECT_LE(moved.compared, options.mostPoints);
    EXPECT_EQ(moved.points, moved.compared) << "all of them lie where they are believed to";
}

TEST(RoomCheck, CorrectionsLeaveWhatWasMeasuredLater) {
    const Installation believed = verifiedRoom();
    MovedParts found;
    const RoomParts parts = partsOf(believed, verifiedRig());
    found.motion = Eigen::VectorXd::Zero(parts.size());
    found.motion[parts.device().first + 3] = 0.004;
    found.parts = {{parts.device(), 0.004, 0.0001}};
    const Installation corrected = correctedBy(believed, verifiedRig(), found);
    Installation room = believed;
    room.pointerTip = {0.0F, -0.2F, 0.0F}; // meanwhile
    room.projectors.front().camera.focal *= 1.01;
    Installation expected = room;
    expected.worldFromDevice = corrected.worldFromDevice;
    expected.origins.devicePlace = corrected.origins.devicePlace;
    takeCorrections(corrected, room);
    EXPECT_EQ(room, expected);
    takeCorrections(corrected, room);
    EXPECT_EQ(room, expected) << "twice is once";
    room.worldFromDevice = believed.worldFromDevice;
    room.origins.devicePlace = {Origin::Way::measured, "another way", "2999-01-01T00:00:00Z"};
    expected = room;
    takeCorrections(corrected, room);
    EXPECT_EQ(room, expected) << "measured after the check";
}

TEST(CheckLab, PatternsAreLightWhateverTheProjectorsResponse) {
    Installation plain = verifiedRoom();
    plain.cameras.front().camera = withSize(plain.cameras.front().camera, {160, 128});
    Installation bent = plain;
    bent.projectors.front().black = glm::vec3(0.02F);
    bent.projectors.front().responseCurve = {{0.0, glm::vec3(0.0F)}, {0.5, glm::vec3(0.2F)}, {1.0, glm::vec3(1.0F)}};
    const std::vector<double> rest(verifiedRig().actuatorCount(), 0.0);
    const cv::Mat grey(540, 960, CV_8U, cv::Scalar(128));
    CheckLab one(plain, verifiedRig(), rest), other(bent, verifiedRig(), rest);
    EXPECT_EQ(cv::norm(one.photograph(0, grey), other.photograph(0, grey), cv::NORM_INF), 0.0);
}

TEST(ErrorPicture, AWordLongerThanALineIsCut) {
    RoomCheck check;
    check.sentence = std::string(300, 'x') + " moved";
    const std::vector<double> rest(verifiedRig().actuatorCount(), 0.0);
    EXPECT_EQ(errorPicture(check, verifiedRig(), verifiedRoom(), rest, 600).size().x, 600);
}

} // namespace
} // namespace lumorph::test
