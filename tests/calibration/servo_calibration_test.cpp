#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "calibration/doctor/device_capture.h"
#include "calibration/lab/board_lab.h"
#include "calibration/lab/check_lab.h"
#include "calibration/lab/device_lab.h"
#include "calibration/lab/true_room.h"
#include "calibration/servos/servo_gain.h"
#include "core/base/error.h"
#include "core/base/resources.h"
#include "core/scene/measured_servos.h"
#include "tests/calibration/measured_stage.h"
#include "tests/core/temporary_folder.h"
#include "tests/support/cut_tablet.h"

namespace lumorph {
namespace {

using test::measuredInLab;

bool takesLong() { return std::getenv("LUMORPH_LONG_TESTS") != nullptr; }

const Rig& servoTablet() {
    static const Rig rig = test::cutTablet();
    return rig;
}

/// As the camera can see it: the device cannot bend beyond its range.
double trueAt(const MeasuredServo& servo, double commanded, bool rises) {
    return realStroke(servo, commanded, rises ? 0.0 : 1.0);
}

struct CurveErrors {
    double worst = 0.0;    ///< degrees, over both ways
    double backlash = 0.0; ///< degrees
};

/// Between the levels too, at 97 commands; without the ends, which only one way reaches.
CurveErrors errorsOf(const ServoCalibration& measured, const Installation& truth, double backlashDegrees) {
    CurveErrors errors;
    for (std::size_t i = 0; i < measured.servos.size(); ++i) {
        const ServoFinding& servo = measured.servos[i];
        for (int k = 0; k <= 96; ++k)
            for (const bool rises : {true, false}) {
                const double seen = realStroke(servo.curve, k / 96.0, rises ? 0.0 : 1.0);
                const double real = trueAt(truth.servos[i], k / 96.0, rises);
                errors.worst = std::max(errors.worst, servo.degrees * std::abs(seen - real));
            }
        errors.backlash = std::max(errors.backlash, std::abs(servo.backlashDegrees - backlashDegrees));
    }
    return errors;
}

TEST(ServoCalibrationTest, SixBentServosWithTwoDegreesOfBacklash) {
    const int seeds = takesLong() ? 8 : 2;
    std::printf("seed  groups  passes  seconds  worst curve  worst backlash  fresh median / worst  rms\n");
    for (int seed = 1; seed <= seeds; ++seed) {
        const Installation believed = defaultInstallation();
        const Installation truth = trueRoom(believed, servoTablet().actuators(), seed);
        const auto result = measuredInLab<ServoMeasurement>("servos", servoTablet(), believed, truth, seed);
        ASSERT_EQ(result.measured.servos.size(), 6U);
        for (const Finding& finding : result.measured.findings) ADD_FAILURE() << sentenceOf(finding);
        ASSERT_TRUE(result.measured.usable);
        const CurveErrors errors = errorsOf(result.measured, truth, LabErrors{}.backlashDegrees);
        std::printf("%4d  %6zu  %6zu  %7.1f  %7.2f deg  %10.2f deg  %6.2f / %.2f deg  %.2f mm\n", seed,
                    result.plan.groups.size(), result.plan.steps.size(), result.seconds, errors.worst, errors.backlash,
                    result.measured.freshDegrees, result.measured.freshWorst, 1e3 * result.measured.rms);
        EXPECT_LE(errors.worst, 1.0);
        EXPECT_LE(errors.backlash, 0.3);
        EXPECT_LE(result.seconds, 180.0);
        EXPECT_EQ(result.room.servos.size(), 6U);
        EXPECT_EQ(result.room.origins.servos.way, Origin::Way::simulated);
    }
}

struct FaultCase {
    ServoFault fault;
    Cause cause;
    const char* name;
};

class ServoFaultTest : public testing::TestWithParam<FaultCase> {};

TEST_P(ServoFaultTest, IsNamedWithItsServoAndNobodyElse) {
    const Installation believed = defaultInstallation();
    const Installation truth = trueRoom(believed, servoTablet().actuators(), 3);
    LabBenchOptions options;
    options.servos.fault = GetParam().fault;
    const auto result = measuredInLab<ServoMeasurement>("servos", servoTablet(), believed, truth, 3, options);
    std::vector<std::string> expected, named;
    for (const std::size_t i : faultyServos(GetParam().fault, 6)) expected.push_back(servoTablet().actuators()[i].name);
    for (const Finding& finding : result.measured.findings) {
        std::printf("%s\n", sentenceOf(finding).c_str());
        EXPECT_EQ(keyOf(finding.cause), keyOf(GetParam().cause));
        named.push_back(finding.view);
    }
    EXPECT_EQ(named, expected);
    const bool jammed = GetParam().fault == ServoFault::jammed;
    EXPECT_EQ(result.measured.usable, jammed);
    EXPECT_EQ(result.room == believed, !jammed); // nothing is kept of servos that are wired wrongly
    if (jammed) {
        const MeasuredServo& servo = result.room.servos[faultyServos(ServoFault::jammed, 6).front()];
        EXPECT_NEAR(reachOf(servo).high, kLabStop, 1.0 / 90.0);
    }
}

INSTANTIATE_TEST_SUITE_P(Lab, ServoFaultTest,
                         testing::Values(FaultCase{ServoFault::swapped, Cause::servoSwapped, "swapped"},
                                         FaultCase{ServoFault::reversed, Cause::servoReversed, "reversed"},
                                         FaultCase{ServoFault::dead, Cause::servoDead, "dead"},
                                         FaultCase{ServoFault::jammed, Cause::servoJammed, "jammed"}),
                         [](const auto& given) { return given.param.name; });

TEST(ServoCalibrationTest, MatchedIouOfTheRealDeviceRises) {
    const Installation believed = defaultInstallation();
    const Installation truth = trueRoom(believed, servoTablet().actuators(), 1);
    const auto result = measuredInLab<ServoMeasurement>("servos", servoTablet(), believed, truth, 1);
    const auto library = readTargets({resourceFile("targets/bowl.glb"), resourceFile("targets/corners.glb"),
                                      resourceFile("targets/cove.glb"), resourceFile("targets/valley.glb")});
    LibraryFitOptions options;
    options.resolution = 25;
    const ServoGain gain = servoGain(servoTablet(), library, result.room, truth, options);
    std::printf("IoU wanted %.4f, real device before %.4f, after %.4f; projection off by %.2f mm before, %.2f after\n",
                gain.wanted, gain.told, gain.measured, 1e3 * gain.toldOff, 1e3 * gain.measuredOff);
    EXPECT_GT(gain.measured, gain.told);
    EXPECT_NEAR(gain.measured, gain.wanted, 0.01);
    EXPECT_LT(gain.measuredOff, 0.25 * gain.toldOff);
}

TEST(ServoCalibrationTest, StopEndsItWithNothingKept) {
    const Installation believed = defaultInstallation();
    const Installation truth = trueRoom(believed, servoTablet().actuators(), 1);
    std::stop_source stop;
    int reports = 0;
    std::string first;
    const Progress progress(
        [&](double, std::string_view stage) {
            if (reports == 0) first = stage;
            if (++reports == 5) stop.request_stop();
        },
        stop.get_token());
    EXPECT_THROW(
        static_cast<void>(measuredInLab<ServoMeasurement>("servos", servoTablet(), believed, truth, 1, {}, progress)),
        Cancelled);
    EXPECT_LE(reports, 6);
    EXPECT_NE(first.find("hands off"), std::string::npos) << first;
}

TEST(ServoCalibrationTest, RefusesWhatIsNoMeasurement) {
    const ServoPlan plan = planServos(servoTablet(), {{0, 1, 2, 3}, {4, 5}});
    EXPECT_THROW(static_cast<void>(solveServos(servoTablet(), glm::dmat4(1.0), plan, {})), InvalidInput);
    const std::vector<ServoPass> nothing(plan.steps.size());
    EXPECT_THROW(static_cast<void>(solveServos(servoTablet(), glm::dmat4(1.0), plan, nothing)), CaptureRefused);
    const std::vector<ServoPass> broken(plan.steps.size(),
                                        ServoPass(1000, {glm::dvec3(std::numeric_limits<double>::quiet_NaN()), 1.0}));
    EXPECT_THROW(static_cast<void>(solveServos(servoTablet(), glm::dmat4(1.0), plan, broken)), CaptureRefused);
    EXPECT_THROW(static_cast<void>(planServos(servoTablet(), {{0, 1}})), InvalidInput);
    EXPECT_THROW(static_cast<void>(planServos(servoTablet(), {{0, 1, 2, 3}, {4, 5, 6}})), InvalidInput);
    EXPECT_THROW(static_cast<void>(planServos(servoTablet(), {{0, 1, 2, 3}, {3, 4, 5}})), InvalidInput);
    EXPECT_THROW(static_cast<void>(planServos(servoTablet(), {{0, 1, 2, 3, 4, 5}}, {.steps = 1})), InvalidInput);
    Installation dark = defaultInstallation();
    dark.projectors.clear();
    EXPECT_THROW(static_cast<void>(measuredInLab<ServoMeasurement>("servos", servoTablet(), dark, dark, 1)),
                 InvalidInput);
}

/// What camera and projector see of the device in each step of a plan.
std::vector<ServoPass> passesOf(const ServoPlan& plan, const Installation& room = defaultInstallation()) {
    ServoLabOptions options;
    options.pixelStep = 12;
    ServoLab lab(servoTablet(), room, 4, options);
    std::vector<ServoPass> passes;
    for (const ServoStep& step : plan.steps) {
        lab.command(step.commanded);
        passes.push_back(surfacePoints(lab.look(), lab.camera(), lab.projector()));
    }
    return passes;
}

ServoPlan wiringPlan() {
    ServoPlan plan = planServos(servoTablet(), {{0, 1, 2, 3}, {4, 5}}, {.fresh = 0});
    plan.steps.resize(7); // at rest, then each alone
    return plan;
}

TEST(ServoCalibrationTest, AHiddenServoIsNotCalledDead) {
    const ServoPlan plan = wiringPlan();
    std::vector<ServoPass> passes = passesOf(plan);
    passes[3].clear(); // a hand in the light while the third moves
    const ServoCalibration measured = solveServos(servoTablet(), glm::dmat4(1.0), plan, passes);
    EXPECT_FALSE(measured.usable);
    ASSERT_EQ(measured.findings.size(), 1U);
    EXPECT_EQ(keyOf(measured.findings.front().cause), keyOf(Cause::tooFewPoints));
    EXPECT_EQ(measured.findings.front().view, servoTablet().actuators()[2].name);
}

/// What a solver refuses passes for, and how many it took before it did.
std::pair<std::string, std::size_t> refusalOf(const ServoPlan& plan, const std::vector<ServoPass>& passes) {
    ServoSolver solver(servoTablet(), glm::dmat4(1.0), plan);
    std::size_t taken = 0;
    try {
        for (; !solver.ended(); ++taken) solver.take(passes[taken]);
        static_cast<void>(solver.result());
    } catch (const CaptureRefused& refused) {
        return {std::string(keyOf(refused.finding().cause)), taken};
    }
    return {"", taken};
}

TEST(ServoCalibrationTest, ADeviceThatLiesElsewhereIsToldFromOneThatWasPushed) {
    const ServoPlan plan = planServos(servoTablet(), {{0, 1, 2, 3}, {4, 5}}, {.steps = 4, .fresh = 1});
    const auto shifted = [](glm::vec3 by) {
        Installation room = defaultInstallation();
        room.worldFromDevice[3] = glm::vec4(by, 1.0F);
        return room;
    };
    const std::vector<ServoPass> passes = passesOf(plan);
    EXPECT_EQ(refusalOf(plan, passes).first, "");
    const std::vector<ServoPass> aside = passesOf(plan, shifted({0.03F, 0.0F, 0.0F}));
    const auto [cause, taken] = refusalOf(plan, aside);
    EXPECT_EQ(cause, keyOf(Cause::modelDoesNotFit));
    EXPECT_EQ(taken, 6U) << "known once each servo has moved alone, not after all levels";
    std::vector<ServoPass> pushed = passes;
    const std::vector<ServoPass> later = passesOf(plan, shifted({0.006F, 0.0F, 0.006F}));
    std::copy(later.begin() + 9, later.end(), pushed.begin() + 9);
    EXPECT_EQ(refusalOf(plan, pushed).first, keyOf(Cause::rigMoved));
}

TEST(ServoCalibrationTest, CurvesOfFewLevelsBendAsServosDo) {
    const Installation truth = trueRoom(defaultInstallation(), servoTablet().actuators(), 8);
    const ServoPlan plan = planServos(servoTablet(), {{0, 1, 2, 3}, {4, 5}}, {.steps = 4, .fresh = 1});
    Installation placed = defaultInstallation();
    placed.servos = truth.servos;
    const ServoCalibration measured = solveServos(servoTablet(), glm::dmat4(1.0), plan, passesOf(plan, placed));
    ASSERT_TRUE(measured.usable);
    double sum = 0.0;
    for (std::size_t i = 0; i < measured.servos.size(); ++i)
        for (const double commanded : {0.25, 0.5, 0.75}) {
            const ServoFinding& servo = measured.servos[i];
            sum += servo.degrees *
                   std::abs(realStroke(servo.curve, commanded, 0.0) - trueAt(truth.servos[i], commanded, true));
        }
    const double mean = sum / static_cast<double>(3 * measured.servos.size());
    std::printf("at levels a quarter of the range apart curves are %.3f degrees off in the mean\n", mean);
    EXPECT_LT(mean, 0.25);
}

TEST(ServoCalibrationTest, WithoutTheDeviceAtRestThereIsNoResultLater) {
    ServoPlan plan = wiringPlan();
    plan.steps.resize(3);
    const std::vector<ServoPass> passes = passesOf(plan);
    ServoSolver solver(servoTablet(), glm::dmat4(1.0), plan);
    EXPECT_THROW(solver.take({}), CaptureRefused);
    EXPECT_THROW(solver.take(passes[1]), CaptureRefused);
    EXPECT_THROW(solver.take(passes[2]), CaptureRefused);
    ASSERT_TRUE(solver.ended());
    EXPECT_THROW(static_cast<void>(solver.result()), CaptureRefused);
}

TEST(ServoCalibrationTest, CurvesThatNoFreshStateConfirmsAreNotUsed) {
    const ServoPlan plan = planServos(servoTablet(), {{0, 1, 2, 3}, {4, 5}}, {.steps = 4, .fresh = 1});
    std::vector<ServoPass> passes = passesOf(plan);
    EXPECT_TRUE(solveServos(servoTablet(), glm::dmat4(1.0), plan, passes).usable);
    passes.back().clear();
    const ServoCalibration measured = solveServos(servoTablet(), glm::dmat4(1.0), plan, passes);
    EXPECT_FALSE(measured.usable);
    EXPECT_EQ(measured.findings.size(), 1U);
}

/// The whole way from photographs: pictures of the lab's camera under phase patterns, decoded, then solved.
TEST(ServoPhotographsTest, StrokesOfPhotographedFlaps) {
    if (!takesLong()) GTEST_SKIP() << "renders 84 pictures";
    const TemporaryFolder folder;
    DeviceLabCapture capture;
    capture.room = defaultInstallation();
    capture.pattern = "phase:16x3+1x3";
    CalibratedCamera camera = defaultLabCamera(capture.room.projectors.front().camera);
    camera.focal *= 1.7; // zoomed in on the device
    capture.room.cameras.push_back({"Camera", "", camera, {}, {}});
    const auto place = folder.path() / "shots";
    writeDeviceLabCapture(capture, servoTablet(), place);
    const CalibratedCamera& lamp = capture.room.projectors.front().camera;
    const cv::Size panel(lamp.size.x, lamp.size.y);
    const DeviceCapture read = readDeviceCapture(place, 6, {{"projector", parsePattern(capture.pattern, panel)}});
    StrokeSolver solver(servoTablet(), glm::dmat4(capture.room.worldFromDevice));
    double worst = 0.0;
    for (const DeviceShot& shot : read.shots) {
        const auto points = surfacePoints(shot.light[0][0], camera, lamp);
        const std::vector<std::vector<double>> guesses{std::vector<double>(6, 0.0)};
        const auto found = solver.solve(points, guesses, {}, true);
        ASSERT_TRUE(found) << shot.name;
        for (std::size_t i = 0; i < 6; ++i)
            worst = std::max(worst, 90.0 * std::abs(found->strokes[i] - shot.strokes[i]));
        std::printf("%s: %zu points, rms %.2f mm, share %.2f\n", shot.name.c_str(), points.size(), 1e3 * found->rms,
                    found->share);
    }
    std::printf("worst stroke %.2f degrees off\n", worst);
    EXPECT_LE(worst, 1.0);
}

/// A device on a table: servos with play, whichever way they come, and photographs of where they then stand.
class PlayBench : public DeviceBench {
public:
    PlayBench(const Rig& rig, const Installation& truth) : rig_(rig), truth_(truth), real_(rig.actuatorCount(), 0.0) {
        servos_ = std::exchange(truth_.servos, {}); // where they stand is told to the lab
    }
    void stand(std::span<const double> commanded, const Progress& /*progress*/) override {
        for (std::size_t i = 0; i < real_.size(); ++i) real_[i] = realStroke(servos_[i], commanded[i], real_[i]);
        lab_.emplace(truth_, rig_, real_, CheckLabOptions{}, ++stands_);
    }
    [[nodiscard]] std::vector<cv::Mat> photograph(std::size_t projector, const CaptureOrder& order,
                                                  const Progress& /*progress*/) override {
        std::vector<cv::Mat> images;
        for (const PatternImage& pattern : order.images)
            images.push_back(lab_->photograph(projector, drawPattern(pattern, order.projector)));
        if (isUnplugged && stands_ > 3) images.resize(images.size() / 2);
        return images;
    }

    bool isUnplugged = false;

private:
    const Rig& rig_;
    Installation truth_;
    std::vector<MeasuredServo> servos_;
    std::vector<double> real_;
    std::optional<CheckLab> lab_;
    std::uint32_t stands_ = 0;
};

TEST(ServoCalibrationTest, OneFlapOnABenchOfPhotographs) {
    RigParts parts;
    parts.name = "one flap";
    parts.restMesh = servoTablet().restMesh();
    parts.actuators = {servoTablet().actuators().front()};
    const Rig rig(std::move(parts));
    Installation believed = defaultInstallation();
    CalibratedCamera camera = defaultLabCamera(believed.projectors.front().camera);
    camera.focal *= 1.7; // zoomed in on the device
    believed.cameras.push_back({"Camera", "", withSize(camera, {640, 512}), {}, {}});
    const Installation truth = trueRoom(believed, rig.actuators(), 5);
    ServoPlanOptions plan;
    plan.steps = takesLong() ? 16 : 5;
    plan.fresh = 3;
    plan.pictures = picturesOfLook(believed);
    const auto measuredOn = [&](PlayBench bench) {
        const auto look = [&](const std::vector<double>& commanded, const Progress& progress) {
            return surfacePoints(lookBy(bench, believed, commanded, progress), believed.cameras.front().camera,
                                 believed.projectors.front().camera);
        };
        return measureServos(rig, believed, 5, look, {}, plan);
    };
    const ServoMeasurement result = measuredOn(PlayBench(rig, truth));
    for (const Finding& finding : result.measured.findings) ADD_FAILURE() << sentenceOf(finding);
    ASSERT_TRUE(result.measured.usable);
    double worst = 0.0; // at the levels
    for (const MeasuredServo::Point& point : result.measured.servos.front().curve.points)
        for (const auto& [seen, rises] : {std::pair(point.rising, true), std::pair(point.falling, false)})
            worst = std::max(
                worst, result.measured.servos.front().degrees *
                           std::abs(std::clamp(seen, 0.0, 1.0) - trueAt(truth.servos.front(), point.commanded, rises)));
    std::printf("%zu looks: curve %.2f degrees off, play %.2f degrees, points %.2f mm off the surface\n",
                result.plan.steps.size(), worst, result.measured.servos.front().backlashDegrees,
                1e3 * result.measured.rms);
    EXPECT_LE(worst, 1.0);
    EXPECT_NEAR(result.measured.servos.front().backlashDegrees, LabErrors{}.backlashDegrees, 0.5);
    PlayBench unplugged(rig, truth);
    unplugged.isUnplugged = true;
    EXPECT_THROW((void)measuredOn(std::move(unplugged)), DeviceError);
}

TEST(ServoPlanTest, PartsOfTheSameVerticesMoveOneAfterTheOther) {
    const auto groups = servoGroups(servoTablet(), [](std::span<const double>) { return std::vector<int>(6, 100); });
    for (const auto& group : groups)
        for (const std::size_t a : group)
            for (const std::size_t b : group)
                for (const std::uint32_t vertex : servoTablet().verticesOf(a)) {
                    const auto others = servoTablet().verticesOf(b);
                    ASSERT_TRUE(a == b || !std::ranges::binary_search(others, vertex));
                }
    // Where one hides another, each is measured by itself.
    const auto hidden = servoGroups(servoTablet(), [](std::span<const double> strokes) {
        const auto up = std::ranges::count_if(strokes, [](double s) { return s > 0.0; });
        return std::vector<int>(6, up > 1 ? 10 : 100);
    });
    EXPECT_EQ(hidden.size(), 6U);
}

} // namespace
} // namespace lumorph
