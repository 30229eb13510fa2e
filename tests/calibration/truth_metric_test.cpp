#include <cmath>
#include <memory>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "calibration/lab/lab_lens.h"
#include "core/base/resources.h"
#include "core/rig/rig_file.h"
#include "core/scene/show_frame.h"
#include "tests/support/truth.h"
#include "tests/support/truth_cases.h"

// Who judges the judge: what the truth test measures, put to a projector picture that is known to be right, and to one
// that is off by a single pixel.

namespace lumorph::test {
namespace {

constexpr double kLean = 0.0240; // of the projector's axis; its lens shift does the rest, so that it lights the device

double stripes(double x) { return std::sin(x) > 0.0 ? 1.0 : 0.0; }

glm::vec3 bricks(const Lab::Hit& hit) {
    const bool mortar = stripes(hit.point.x * 300.0) + stripes(hit.point.z * 500.0) > 1.5;
    return mortar ? glm::vec3(0.75F, 0.7F, 0.65F) : glm::vec3(0.3F, 0.08F, 0.04F);
}

// Rings around the device's middle: soft, all directions.
glm::vec3 ripples(const Lab::Hit& hit) {
    const double wave = std::sin(250.0 * glm::length(glm::dvec2(hit.point.x, hit.point.z)));
    return {0.1F, static_cast<float>(0.4 + 0.1 * wave), static_cast<float>(0.5 + 0.3 * wave)};
}

Image shifted(const Image& image, int dx, int dy) {
    Image out(image.size());
    for (int y = std::max(0, dy); y < std::min(image.size().y, image.size().y + dy); ++y)
        for (int x = std::max(0, dx); x < std::min(image.size().x, image.size().x + dx); ++x)
            out.at(x, y) = image.at(x - dx, y - dy);
    return out;
}

class TruthMetric : public testing::Test {
protected:
    static TruthBench benchOf(const char* state, const char* eye) {
        TruthDevice device = truthDevice();
        // Beyond the device, so that the figures below do not follow the default projector about.
        CalibratedCamera& camera = device.scene.projectors.at(0).camera;
        const glm::dvec3 position(0.0, 2.0, -0.25);
        camera.cameraFromWorld =
            cameraLookingAt(position, position + glm::dvec3(0.0, -1.0, kLean), camera.size, camera.focal.x)
                .cameraFromWorld;
        return TruthBench(truthSetup(device, truthState(state), truthEye(eye)));
    }
};

TEST_F(TruthMetric, TheIdealPictureComesThroughAndAShiftedOneDoesNot) {
    for (const char* state : {"rest", "mixed"}) {
        TruthBench bench = benchOf(state, "front");
        EXPECT_GT(bench.judgedPixels(), 100'000U);
        struct Row {
            const char* name;
            glm::vec3 (*color)(const Lab::Hit&);
            double ideal;  // decibels that the right picture reaches at least
            double beside; // and that the picture beside it stays below; what is soft hides a pixel's shift
        };
        for (const Row& row : {Row{"ripples", ripples, 50.0, 47.0}, Row{"bricks", bricks, 40.0, 30.0}}) {
            const LabPicture eye = painted(bench.lab(), bench.eye(), row.color);
            const LabPicture wanted = bench.lowPassed(eye);
            const Image ideal = bench.ideal(eye);
            const double right = psnr(bench.seen(ideal), wanted, bench.judged());
            const double wrong = psnr(bench.seen(shifted(ideal, 1, 0)), wanted, bench.judged());
            std::printf("%s, %s: ideal %.1f dB, one pixel beside it %.1f dB\n", state, row.name, right, wrong);
            EXPECT_GT(right, row.ideal) << state << ", " << row.name;
            EXPECT_LT(wrong, row.beside) << state << ", " << row.name;
        }
    }
}

TEST_F(TruthMetric, RegistrationSeesAShiftOfOnePixel) {
    TruthBench bench = benchOf("mixed", "front");
    const std::vector<glm::dvec3> points = bench.devicePoints(48);
    ASSERT_GT(points.size(), 30U);
    const LabPicture eye = painted(bench.lab(), bench.eye(), [&](const Lab::Hit& hit) {
        for (const glm::dvec3& point : points)
            if (glm::length(point - hit.point) < 0.0015) return glm::vec3(1.0F);
        return glm::vec3(0.0F);
    });
    std::vector<glm::dvec2> places;
    const LabLens lens = lensOf(bench.eye(), "eye");
    for (const glm::dvec3& point : points) places.push_back(*imageOf(lens, point));
    const Image ideal = bench.ideal(eye);
    const auto right = spotErrors(bench.seen(ideal), eye, places, 14, bench.judged());
    const auto wrong = spotErrors(bench.seen(shifted(ideal, 0, 1)), eye, places, 14, bench.judged());
    std::printf("ideal: mean %.3f, 95 %% %.3f pixels of %zu spots; one pixel beside it: mean %.3f\n", meanOf(right),
                quantileOf(right, 0.95), right.size(), meanOf(wrong));
    ASSERT_GT(right.size(), 20U);
    EXPECT_LT(meanOf(right), 0.1);
    EXPECT_LT(quantileOf(right, 0.95), 0.2);
    EXPECT_GT(meanOf(wrong), 0.5);
}

// A picture for an eye elsewhere is wrong as soon as what it shows lies above the surface: the point of it all.
TEST_F(TruthMetric, AnEyeElsewhereDoesNotSeeTheSame) {
    TruthBench bench = benchOf("mixed", "front");
    TruthSetup beside = truthSetup(truthDevice(), truthState("mixed"), truthEye("front"));
    const glm::dvec3 floating(0.01, 0.09, 0.0);
    const auto ballSeenFrom = [&](const CalibratedCamera& eye, const Lab& lab) {
        const LabLens lens = lensOf(eye, "eye");
        return painted(lab, eye, [&](const Lab::Hit& hit) {
            const glm::dvec3 way = glm::normalize(hit.point - lens.position);
            const glm::dvec3 to = floating - lens.position;
            const bool ball = glm::length(to - glm::dot(to, way) * way) < 0.01 && glm::dot(to, way) < hit.distance;
            return ball ? glm::vec3(0.8F, 0.2F, 0.1F) : bricks(hit);
        });
    };
    const LabPicture eye = ballSeenFrom(bench.eye(), bench.lab());
    const Image image = bench.ideal(eye);
    beside.eye = truthView(truthDevice(), truthEye("front") + glm::vec3(0.05F, 0.0F, 0.0F));
    TruthBench other(beside);
    const LabPicture wanted = other.lowPassed(ballSeenFrom(other.eye(), other.lab()));
    const double here = psnr(bench.seen(image), bench.lowPassed(eye), bench.judged());
    const double there = psnr(other.seen(image), wanted, other.judged());
    std::printf("from the eye %.1f dB, from 5 cm beside it %.1f dB\n", here, there);
    EXPECT_GT(here, 40.0);
    EXPECT_LT(there, 20.0);
}

} // namespace
} // namespace lumorph::test
