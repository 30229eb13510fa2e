#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "calibration/lab/board_lab.h"
#include "calibration/lab/lab_lens.h"
#include "calibration/report/calibrated_room.h"
#include "calibration/solve/error_map.h"
#include "calibration/stages/lab_bench.h"
#include "calibration/stages/stage.h"
#include "tests/support/chain_judge.h"
#include "tests/support/cut_tablet.h"
#include "tests/support/long_tests.h"
#include "tests/support/procam_observations.h"
#include "tests/support/truth.h"

// R24, R25, R26: from a room of which nothing is known, through every link of the chain, to a show in the room as it
// truly is, all of the lab's errors on at once.

namespace lumorph::test {
namespace {

constexpr double kPerMetre = 1000.0; // millimetres, the board's unit
constexpr int kBoardPoses = 10;
constexpr double kCornerNoise = 0.1, kLightNoise = 0.15; // pixels, of camera and projector

/// What somebody has put up: near where rooms have their projector, with another zoom and a lens that bends.
Installation putUp() {
    Installation room = defaultInstallation();
    CalibratedCamera& projector = room.projectors.front().camera;
    const glm::dvec3 position = positionOf(projector) + glm::dvec3(0.03, -0.04, 0.02);
    glm::dmat4 turned =
        glm::rotate(glm::dmat4(1.0), 0.007, glm::normalize(glm::dvec3(0.3, 1.0, 0.4))) * projector.cameraFromWorld;
    turned[3] = glm::dvec4(-(glm::dmat3(turned) * position), 1.0);
    projector.cameraFromWorld = turned;
    projector.focal *= 1.01;
    projector.distortion = {-0.02, 0.0, 0.0, 0.0, 0.0};
    room.cameras.resize(1);
    room.cameras.front().camera = defaultLabCamera(projector);
    return room;
}

/// Projector and camera as boards under structured light tell them.
struct Calibrated {
    Installation room;
    ProcamCalibration solved;
    WorldPose world;
};

Calibrated calibrate(const Installation& believed, const Installation& truth, std::uint32_t seed) {
    const CalibrationBoard board = parseCalibrationBoard("chess:9x7:25");
    const BoardLab lab(truth, board, {}, seed);
    ProcamSetup setup;
    setup.camera = lab.camera();
    setup.projector = lab.projector().camera;
    const glm::dmat4 cameraFromWorld = lab.camera().cameraFromWorld;
    const auto inMillimetres = [](glm::dmat4 pose) {
        pose[3] = glm::dvec4(kPerMetre * glm::dvec3(pose[3]), 1.0);
        return pose;
    };
    setup.camera.cameraFromWorld = glm::dmat4(1.0);
    setup.projector.cameraFromWorld = inMillimetres(setup.projector.cameraFromWorld * glm::inverse(cameraFromWorld));
    setup.square = 25.0;
    for (const glm::dmat4& pose : lab.proposePoses(kBoardPoses))
        setup.cameraFromBoard.push_back(inMillimetres(cameraFromWorld * pose));
    const std::vector<ViewObservations> views = observe(setup, {kCornerNoise, kLightNoise}, seed);
    Calibrated result;
    result.solved = solve(setup, views);
    result.room = withCalibration(believed, result.solved, board);
    const glm::dmat4 worldFromCam = worldFromCamera(result.solved, board, believed, {});
    const PoseVector& flat = result.solved.state.cameraFromBoard.front();
    const glm::dvec3 axis(flat[0], flat[1], flat[2]);
    const glm::dmat3 turn(glm::rotate(glm::dmat4(1.0), glm::length(axis), glm::normalize(axis)));
    BoardPoints seen{{}, views.front().corners.seen};
    for (const cv::Point3d& point : views.front().corners.board) {
        const glm::dvec3 inCamera =
            turn * glm::dvec3(point.x, point.y, point.z) + glm::dvec3(flat[3], flat[4], flat[5]);
        const glm::dvec3 world(worldFromCam * glm::dvec4(inCamera / kPerMetre, 1.0));
        seen.board.emplace_back(kPerMetre * world.x, kPerMetre * world.y, kPerMetre * world.z);
    }
    result.world = worldPoseFrom(result.solved, seen, kCornerNoise);
    return result;
}

/// Of places on the table and as high as the device lifts its skin: how far beside them the light of the calibrated
/// room truly falls, as a share of the error that the map predicts there.
std::vector<double> sharesOfMap(const Calibrated& calibrated, const Installation& truth) {
    const LabLens believed = lensOf(calibrated.room.projectors.front().camera, "calibrated projector");
    const LabLens lamp = lensOf(truth.projectors.front().camera, "true projector");
    std::vector<double> shares;
    for (const double y : {0.0, 0.05})
        for (int i = -4; i <= 4; ++i)
            for (int k = -4; k <= 4; ++k) {
                const glm::dvec3 place(0.04 * i, y, 0.03 * k);
                const auto pixel = imageOf(believed, place);
                const auto ray = pixel ? rayThrough(lamp, *pixel) : std::nullopt;
                if (!ray) continue;
                const glm::dvec3 fell = lamp.position + (y - lamp.position.y) / ray->y * *ray;
                const double predicted =
                    errorMap(calibrated.solved, calibrated.world,
                             {{{kPerMetre * place.x, kPerMetre * place.y, kPerMetre * place.z}, {0.0, 1.0, 0.0}}})
                        .front();
                shares.push_back(kPerMetre * glm::distance(fell, place) / predicted);
            }
    return shares;
}

/// The stages after projector and camera, each from the room as the stages before left it.
Installation measureStages(const Rig& rig, Installation room, const Installation& truth, std::uint32_t seed) {
    constexpr std::pair<const char*, std::uint32_t> kStages[] = {
        {"light", 0}, {"pointer", 0}, {"tracker", 1}, {"body", 2}, {"eye", 3}, {"servos", 4}, {"delays", 5}};
    for (const auto& [key, more] : kStages) {
        const CalibrationStage& stage = calibrationStage(key);
        LabBench lab(rig, truth, seed + more);
        const StageResult result = measureStage(stage, {{std::shared_ptr<const Rig>(), &rig}, room}, lab).result;
        EXPECT_TRUE(isGood(result)) << key;
        stage.apply(roomOf(result), room);
    }
    return room;
}

void print(const char* what, const ShownError& error) {
    std::printf("%-22s | balls %2zu of %2zu: mean %.2f, 95 %% %.2f pixels | skin mean %.2f pixels, %.2f mm, 95 %% %.2f "
                "mm | eye %.1f mm | device %.2f mm\n",
                what, error.balls.size(), error.judgedBalls, meanOf(error.balls), quantileOf(error.balls, 0.95),
                meanOf(error.skinPixels), meanOf(error.skinMillimetres), quantileOf(error.skinMillimetres, 0.95),
                error.eyeMillimetres, error.deviceMillimetres);
}

// Aim: of normal errors within a radius that holds 95 of 100, the mean is 0.41 (along one direction alone) to 0.51 of
// it (to all sides alike). Reached: 0.17, the map is more than twice too wide where the lens model is chosen among
// several. Worse than that fails, and so does a map that is too narrow. In the short form ErrorMap does so with one
// lens model.
TEST(EndToEnd, TheErrorMapIsNeitherTooWideNorTooNarrow) {
    if (!longTests()) GTEST_SKIP() << "half a minute: LUMORPH_LONG_TESTS=1 takes it";
    constexpr std::uint32_t rooms = 12;
    constexpr double kReached = 0.15, kMost = 0.6;
    const Rig rig = test::cutTablet();
    std::vector<double> shares, means;
    for (std::uint32_t seed = 101; seed < 101 + rooms; ++seed) {
        const Installation truth = trueRoom(putUp(), rig.actuators(), seed);
        const std::vector<double> room = sharesOfMap(calibrate(defaultInstallation(), truth, seed), truth);
        ASSERT_GT(room.size(), 100U) << seed;
        shares.insert(shares.end(), room.begin(), room.end());
        means.push_back(meanOf(room));
    }
    const auto within = static_cast<double>(std::ranges::count_if(shares, [](double share) { return share <= 1.0; })) /
                        static_cast<double>(shares.size());
    std::printf(
        "light beside, of %u rooms: %.1f %% within the predicted 95 %%, mean %.2f of it (%.2f to %.2f a room)\n", rooms,
        100.0 * within, meanOf(shares), quantileOf(means, 0.0), quantileOf(means, 1.0));
    EXPECT_GE(meanOf(shares), kReached) << "too wide";
    EXPECT_LE(meanOf(shares), kMost) << "too narrow";
    EXPECT_GE(within, 0.85);
}

TEST(EndToEnd, TheWholeChainShowsWhatTheEyeShouldSee) {
    const auto rig = std::make_shared<const Rig>(test::cutTablet());
    std::vector<double> means; // eye pixels, by rooms
    for (std::uint32_t seed = 1; seed <= (longTests() ? 6U : 1U); ++seed) {
        const Installation truth = trueRoom(putUp(), rig->actuators(), seed);
        const Calibrated calibrated = calibrate(defaultInstallation(), truth, seed);
        const std::vector<double> shares = sharesOfMap(calibrated, truth);
        std::printf("light beside, as a share of the predicted 95 %%: mean %.2f, most %.2f of %zu places\n",
                    meanOf(shares), quantileOf(shares, 1.0), shares.size());
        ASSERT_GT(shares.size(), 100U);
        // How wide the map is, is judged over many rooms above.
        EXPECT_LE(quantileOf(shares, 0.95), 1.0) << "inside the predicted map in 95 of 100 places";
        EXPECT_GE(meanOf(shares), 0.04) << "a map that says nothing";

        const Installation estimated = measureStages(*rig, calibrated.room, truth, 10 * seed);
        const ShownError shown = shownError(rig, estimated, truth);
        print("whole chain", shown);
        means.push_back(meanOf(shown.balls));
        EXPECT_GE(shown.judgedBalls, 20U);
        EXPECT_GE(shown.balls.size() + 2, shown.judgedBalls) << "what is not seen at all is no small error";
        EXPECT_LE(meanOf(shown.balls), 1.5);
        EXPECT_LE(meanOf(shown.skinPixels), 1.5);
        EXPECT_LE(std::abs(estimated.predictionSeconds - truth.predictionSeconds), 0.002);
        EXPECT_LE(std::abs(estimated.trackerSeconds - truth.trackerSeconds), 0.002);
        if (seed > 1) continue;
        // Each link counts: without one of them the same judge says so.
        Installation straight = estimated, carried = estimated, eyeless = estimated;
        straight.servos.clear();
        carried.bodyFromDevice = glm::mat4(1.0F);
        eyeless.eyeFromHead = glm::vec3(0.0F);
        const ShownError servos = shownError(rig, straight, truth), body = shownError(rig, carried, truth),
                         eye = shownError(rig, eyeless, truth);
        print("servos not measured", servos);
        print("device not measured", body);
        print("eye not measured", eye);
        // Most of the device stands still, and most of what is shown lies on it: the worst places tell.
        EXPECT_GT(quantileOf(servos.skinMillimetres, 0.95), 3.0 * quantileOf(shown.skinMillimetres, 0.95));
        EXPECT_LT(body.balls.size() + body.skinPixels.size(), shown.skinPixels.size() / 10)
            << "nearly all is far beside";
        EXPECT_GT(quantileOf(eye.balls, 0.95), 3.0 * quantileOf(shown.balls, 0.95));
    }
    std::printf("whole chain: mean %.2f eye pixels of %zu rooms, most %.2f\n", meanOf(means), means.size(),
                quantileOf(means, 1.0));
    EXPECT_LE(meanOf(means), 0.5);
}

} // namespace
} // namespace lumorph::test
