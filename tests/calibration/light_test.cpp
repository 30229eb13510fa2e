#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <random>
#include <stop_token>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "calibration/lab/true_room.h"
#include "calibration/light/camera_response.h"
#include "calibration/light/light_patches.h"
#include "core/render/gl/headless_context.h"
#include "core/scene/projector_response.h"
#include "tests/calibration/measured_stage.h"
#include "tests/calibration/show_world.h"
#include "tests/support/light_errors.h"

namespace lumorph {
namespace {

using test::LightErrors, test::lightErrorsOf, test::measuredInLab;

/// The light that makes a byte, of a camera with a toe, a shoulder and a black of its own.
double byteOfLight(double light) {
    const auto bent = [](double x) { return std::pow(x + 0.01, 1.0 / 2.4); };
    double value = (bent(std::min(light, 1.0)) - bent(0.0)) / (bent(1.0) - bent(0.0));
    value += 0.1 * value * (1.0 - value);
    return 6.0 + 249.0 * value;
}

std::vector<ExposedByte> exposuresOf(const std::vector<double>& places, const std::vector<double>& seconds,
                                     double noise) {
    std::mt19937 engine(5);
    std::normal_distribution<double> grain(0.0, noise);
    std::vector<ExposedByte> seen;
    for (std::size_t i = 0; i < places.size(); ++i)
        for (const double time : seconds) {
            const double byte = byteOfLight(places[i] * time) + grain(engine);
            seen.push_back({i, time, std::clamp(byte, 0.0, 255.0)});
        }
    return seen;
}

TEST(CameraResponseTest, IsFoundFromExposuresOfTheSamePlaces) {
    std::vector<double> places, seconds;
    for (int i = 0; i < 40; ++i) places.push_back(0.2 + 0.02 * i);
    for (int k = 0; k < 14; ++k) seconds.push_back(1.1 * std::pow(1.55, -k));
    const CameraResponse response = estimateCameraResponse(exposuresOf(places, seconds, 0.2));
    double unit = 0.0, worst = 0.0;
    for (double light = 0.002; light < 0.9; light *= 1.1)
        if (std::abs(byteOfLight(light) - 128.0) < 8.0) unit = response.lightOf(byteOfLight(light)) / light;
    for (double light = 0.01; light < 0.85; light *= 1.07)
        worst = std::max(worst, std::abs(response.lightOf(byteOfLight(light)) / (unit * light) - 1.0));
    std::printf("camera's curve: %.2f %% off at worst, exposures scatter by %.2f %%\n", 100.0 * worst,
                100.0 * response.rms());
    EXPECT_LT(worst, 0.015);
    EXPECT_NEAR(response.lightOf(128.0), 1.0, 1e-3);
    EXPECT_EQ(response.lightOf(0.0), 0.0);
}

TEST(CameraResponseTest, RefusesACameraThatEvensExposuresOut) {
    std::vector<ExposedByte> seen;
    for (std::size_t i = 0; i < 40; ++i)
        for (int k = 0; k < 12; ++k) seen.push_back({i, 0.001 * std::pow(1.5, k), 80.0 + static_cast<double>(i)});
    try {
        (void)estimateCameraResponse(seen);
        FAIL() << "it was taken";
    } catch (const CaptureRefused& refused) {
        EXPECT_EQ(refused.finding().cause, Cause::cameraAdjusts);
    }
    EXPECT_THROW((void)estimateCameraResponse(std::span(seen).first(10)), CaptureRefused);
}

void printErrors(const char* what, const LightCalibration& found, const LightErrors& errors) {
    std::printf("%-22s %d photographs; curve %.2f %% of white, gains %.2f %%, black %.3f %% of white, colours %.3f, "
                "gains x colours %.2f %%; fresh greys %.2f %% and %.1f %% (before %.1f %% and %.1f %%)\n",
                what, found.photographs, 100.0 * errors.curve, 100.0 * errors.gain, 100.0 * errors.black, errors.colors,
                100.0 * errors.product, 100.0 * found.fresh.median, 100.0 * found.fresh.most,
                100.0 * found.before.median, 100.0 * found.before.most);
    for (const Finding& warning : found.warnings) std::printf("  %s\n", sentenceOf(warning).c_str());
    if (found.refusal) std::printf("  refused: %s\n", sentenceOf(*found.refusal).c_str());
}

// Half of a patch on the white device, half beside it, where the device was not believed to be.
TEST(PatchBytes, AreCutOffWhereAPartOfThePatchIs) {
    cv::Mat picture(8, 24, CV_8UC3, cv::Scalar(100, 120, 140));
    picture(cv::Rect(0, 0, 4, 8)).setTo(cv::Scalar(255, 200, 160));
    picture(cv::Rect(16, 0, 8, 8)).setTo(cv::Scalar(254, 254, 254));
    LightPatch mixed, even, bright;
    mixed.pixels = {0, 0, 8, 8};
    even.pixels = {8, 0, 8, 8};
    bright.pixels = {16, 0, 8, 8};
    const auto bytes = patchBytes(std::vector{mixed, even, bright}, picture);
    EXPECT_EQ(bytes[0], glm::dvec3(255.0, 160.0, 150.0));
    EXPECT_EQ(bytes[1], glm::dvec3(100.0, 120.0, 140.0));
    EXPECT_EQ(bytes[2], glm::dvec3(254.0));
}

TEST(LightTest, OfAProjectorIsMeasuredWithTheColoursOfDeviceAndTable) {
    const Installation believed = defaultInstallation();
    for (const std::uint32_t seed : {1U, 2U}) {
        const Installation truth = trueRoom(believed, bundledTablet()->actuators(), seed);
        const auto found = measuredInLab<LightCalibration>("light", *bundledTablet(), believed, truth, seed);
        const LightErrors errors = lightErrorsOf(found.room, truth);
        printErrors("with a white sheet", found, errors);
        for (const std::string& figure : found.figures) std::printf("  %s\n", figure.c_str());
        ASSERT_TRUE(found.good()) << sentenceOf(*found.refusal);
        EXPECT_TRUE(found.hasWhiteSheet);
        EXPECT_TRUE(found.warnings.empty());
        EXPECT_LT(errors.curve, 0.006);
        EXPECT_LT(errors.gain, 0.01);
        EXPECT_LT(errors.black, 0.0005);
        EXPECT_LT(errors.colors, 0.006);
        EXPECT_LT(found.fresh.median, 0.01);
        EXPECT_GT(found.before.median, 3.0 * found.fresh.median) << "sRGB was believed";
        EXPECT_EQ(found.room.projectors.front().response.way, Origin::Way::simulated);
        EXPECT_EQ(found.room.origins.colors.way, Origin::Way::simulated);
        EXPECT_NO_THROW(checkInstallation(found.room));
        Installation others = found.room; // nothing but light was changed
        others.deviceColor = believed.deviceColor;
        others.tableColor = believed.tableColor;
        others.origins.colors = believed.origins.colors;
        others.projectors = believed.projectors;
        EXPECT_EQ(others, believed);
        EXPECT_EQ(found.room.projectors.front().camera, believed.projectors.front().camera);
    }
}

TEST(LightTest, WithoutASheetWhatIsProjectedIsRightAllTheSame) {
    const Installation believed = defaultInstallation();
    const Installation truth = trueRoom(believed, bundledTablet()->actuators(), 3);
    LabBenchOptions options;
    options.light.laysSheet = false;
    const auto found = measuredInLab<LightCalibration>("light", *bundledTablet(), believed, truth, 3, options);
    const LightErrors errors = lightErrorsOf(found.room, truth);
    printErrors("without a sheet", found, errors);
    ASSERT_TRUE(found.good()) << sentenceOf(*found.refusal);
    EXPECT_FALSE(found.hasWhiteSheet);
    EXPECT_NE(found.assumption.find("taken to be white"), std::string::npos);
    EXPECT_LT(errors.product, 0.01);
    EXPECT_GT(errors.colors, 0.005) << "the truth is not white, and nobody can know";
}

// Ratios of projectors, and of device and table, do not ask for the camera's colours.
TEST(LightTest, ACameraOfOtherColoursTintsTheGainsAlone) {
    const Installation believed = defaultInstallation();
    const Installation truth = trueRoom(believed, bundledTablet()->actuators(), 4);
    LabBenchOptions options;
    options.light.balance = {0.75, 1.0, 0.85};
    options.light.ambient = 0.0;
    const auto found = measuredInLab<LightCalibration>("light", *bundledTablet(), believed, truth, 4, options);
    const LightErrors errors = lightErrorsOf(found.room, truth);
    printErrors("another camera, dark", found, errors);
    ASSERT_TRUE(found.good()) << sentenceOf(*found.refusal);
    EXPECT_LT(errors.curve, 0.006);
    EXPECT_LT(errors.black, 0.0005);
    EXPECT_LT(errors.colors, 0.006) << "the sheet has the same tint in the picture";
    EXPECT_GT(errors.gain, 0.05);
}

struct LightFaultCase {
    LightFault fault;
    Cause cause;
    const char* name;
};

class LightFaultTest : public testing::TestWithParam<LightFaultCase> {};

TEST_P(LightFaultTest, IsNamedAndNothingIsKept) {
    const Installation believed = defaultInstallation();
    const Installation truth = trueRoom(believed, bundledTablet()->actuators(), 5);
    LabBenchOptions options;
    options.light.fault = parseLightFault(GetParam().name);
    EXPECT_EQ(options.light.fault, GetParam().fault);
    const auto found = measuredInLab<LightCalibration>("light", *bundledTablet(), believed, truth, 5, options);
    ASSERT_TRUE(found.refusal);
    std::printf("%s\n", sentenceOf(*found.refusal).c_str());
    EXPECT_EQ(keyOf(found.refusal->cause), keyOf(GetParam().cause));
    EXPECT_FALSE(found.refusal->remedy.empty());
    EXPECT_EQ(found.room, believed);
}

INSTANTIATE_TEST_SUITE_P(Lab, LightFaultTest,
                         testing::Values(LightFaultCase{LightFault::saturated, Cause::cameraSaturates, "saturated"},
                                         LightFaultCase{LightFault::dark, Cause::lightTooDark, "dark"},
                                         LightFaultCase{LightFault::automatic, Cause::cameraAdjusts, "automatic"},
                                         LightFaultCase{LightFault::ambient, Cause::ambientChanges, "ambient"},
                                         LightFaultCase{LightFault::falling, Cause::responseNotRising, "falling"},
                                         LightFaultCase{LightFault::unseen, Cause::lightTooDark, "unseen"}),
                         [](const auto& given) { return given.param.name; });

TEST(LightTest, OfWhatACameraDoesNotSeeIsRefused) {
    Installation room = defaultInstallation();
    room.cameras.push_back(
        {"Camera", "", cameraLookingAt({0.0, 1.0, 2.0}, {0.0, 0.8, 4.0}, {640, 512}, 900.0), {}, {}});
    const auto found = measuredInLab<LightCalibration>("light", *bundledTablet(), room, room, 1);
    ASSERT_TRUE(found.refusal);
    EXPECT_EQ(found.refusal->cause, Cause::surfaceUnseen);
    room.projectors.front().enabled = false;
    EXPECT_THROW((void)measuredInLab<LightCalibration>("light", *bundledTablet(), room, room, 1), InvalidInput);
    EXPECT_THROW((void)parseLightFault("tired"), InvalidInput);
}

TEST(LightTest, EndsWhenItIsCancelled) {
    std::stop_source source;
    source.request_stop();
    const Installation believed = defaultInstallation();
    EXPECT_THROW((void)measuredInLab<LightCalibration>("light", *bundledTablet(), believed, believed, 1, {},
                                                       Progress({}, source.get_token())),
                 Cancelled);
}

/// Two projectors from both sides, whose pictures overlap on the device and beside it, and a camera above.
Installation overlappingRoom() {
    Installation room;
    room.projectors = {projectorAt({-0.7, 1.4, 0.1}, {-0.1, 0.0, 0.0}, {640, 400}, 1700.0),
                       projectorAt({0.75, 1.3, -0.1}, {0.12, 0.0, 0.02}, {600, 420}, 1600.0)};
    room.projectors[0].name = "Left";
    room.projectors[1].name = "Right";
    room.cameras.push_back(
        {"Camera", "", cameraLookingAt({0.2, 1.5, 0.5}, {0.0, 0.0, 0.0}, {640, 512}, 1050.0), {}, {}});
    return room;
}

/// How even a grey is where one projector lights the table, the other, and both.
struct SeamFigures {
    double regions = 0.0; ///< most that the mean of a region and channel is off the mean of all
    double within = 0.0;  ///< share of places and channels within 2 %
    int places = 0;
};

/// A grey wish, as the renderer makes it by `believed` and rays see it in the true room.
SeamFigures seamOf(const Installation& believed, const Installation& truth) {
    SpatialRenderer renderer;
    SceneInRoom shown = unlitScene(glm::vec3(0.7F), glm::vec3(0.7F), believed.projectors);
    shown.deviceColor = believed.deviceColor;
    shown.tableColor = believed.tableColor;
    const ShowFrame frame = frameOf(shown, std::vector<double>(bundledTablet()->actuatorCount(), 0.0));
    renderer.draw(frame);
    LabWorld world = labOf(frame, renderer);
    world.surfaces[0].albedo = lightOfSrgb(truth.deviceColor);
    world.surfaces[1].albedo = lightOfSrgb(truth.tableColor);
    for (std::size_t p = 0; p < truth.projectors.size(); ++p) world.projectors[p].projector = truth.projectors[p];
    const Lab lab(std::move(world));
    const CalibratedCamera above = cameraLookingAt({0.02, 1.1, 0.25}, {0.0, 0.0, 0.0}, {180, 130}, 310.0);
    const LabSight sight = lab.look(above, 1);
    const std::vector<glm::vec3> light = lab.radiance(sight);
    struct Region {
        glm::dvec3 sum{0.0};
        double count = 0.0;
    };
    std::array<Region, 4> regions; // by which projectors reach
    Region all;
    for (std::size_t i = 0; i < light.size(); ++i) {
        if (sight.surfaces[i] < 0) continue;
        const std::size_t lit =
            (sight.gleams[2 * i].share > 0.0F ? 1U : 0U) + (sight.gleams[2 * i + 1].share > 0.0F ? 2U : 0U);
        if (lit == 0) continue;
        for (Region* region : {&regions[lit], &all}) {
            region->sum += glm::dvec3(light[i]);
            region->count += 1.0;
        }
    }
    SeamFigures figures;
    const glm::dvec3 mean = all.sum / all.count;
    for (std::size_t lit = 1; lit < regions.size(); ++lit) {
        EXPECT_GT(regions[lit].count, 500.0) << "too little is lit so";
        const glm::dvec3 off = glm::abs(regions[lit].sum / regions[lit].count / mean - 1.0);
        figures.regions = std::max({figures.regions, off.r, off.g, off.b});
    }
    double within = 0.0;
    for (std::size_t i = 0; i < light.size(); ++i) {
        if (sight.surfaces[i] < 0 || !(sight.gleams[2 * i].share + sight.gleams[2 * i + 1].share > 0.0F)) continue;
        ++figures.places;
        for (int channel = 0; channel < 3; ++channel)
            within += std::abs(static_cast<double>(light[i][channel]) / mean[channel] - 1.0) < 0.02 ? 1.0 : 0.0;
    }
    figures.within = within / (3.0 * figures.places);
    return figures;
}

TEST(LightSeamTest, OfTwoProjectorsIsFlatWithinTwoPercentByWhatWasMeasured) {
    const HeadlessContext context;
    const Installation believed = overlappingRoom();
    LabErrors errors;
    errors.gain = 0.2;
    const Installation truth = trueRoom(believed, bundledTablet()->actuators(), 6, errors);
    const auto found = measuredInLab<LightCalibration>("light", *bundledTablet(), believed, truth, 6);
    printErrors("two projectors", found, lightErrorsOf(found.room, truth));
    ASSERT_TRUE(found.good()) << sentenceOf(*found.refusal);
    const SeamFigures before = seamOf(believed, truth), after = seamOf(found.room, truth);
    for (const auto& [what, seam] : {std::pair("believed", before), std::pair("measured", after)})
        std::printf("seam as %s: regions off by %.2f %%, %.1f %% of %d places and channels within 2 %%\n", what,
                    100.0 * seam.regions, 100.0 * seam.within, seam.places);
    EXPECT_LT(after.regions, 0.02);
    EXPECT_GT(after.within, 0.95);
    EXPECT_GT(before.regions, 0.05);
    EXPECT_LT(before.within, 0.5);
}

} // namespace
} // namespace lumorph
