#include <algorithm>
#include <cstdio>
#include <memory>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "calibration/lab/lab_lens.h"
#include "core/render/headless_context.h"
#include "tests/support/truth_show.h"

// R24, R26: lights the deformed device with the projector's picture in the virtual lab, looks from the eye, and
// compares with what the eye should see (DESIGN.md, "Truth test").

namespace lumorph::test {
namespace {

/// A renderer in a context of its own, the tablet, and the benches of one state.
class TruthTest : public testing::TestWithParam<TruthState> {
protected:
    TruthBench benchOf(const TruthState& state, const ShowFrame& frame, const glm::vec3& observer) const {
        TruthSetup setup = truthSetup(device, state, observer);
        setup.eye = deviceView(frame, observer, setup.eye.size);
        return TruthBench(setup);
    }

    HeadlessContext context;
    TruthDevice device = truthDevice();
    SpatialRenderer renderer;
};

TEST_P(TruthTest, TheLitDeviceLooksAsTheEyePassSays) {
    const TruthState& state = GetParam();
    for (const TruthEye& eye : truthEyes()) {
        const ShowFrame first = truthFrame(device, state, positionOf(eye), kTruthContents.front());
        TruthBench bench = benchOf(state, first, positionOf(eye));
        ASSERT_GT(bench.judgedPixels(), 100'000U);
        for (const TruthContent content : kTruthContents) {
            const ShowFrame frame = truthFrame(device, state, positionOf(eye), content);
            ASSERT_EQ(deviceView(frame, positionOf(eye), bench.eye().size), bench.eye());
            renderer.draw(frame);
            const TruthFigure figure = judge(bench, renderer.readEye(), renderer.readProjector(0));
            std::printf("truth %-11s | %-11s | %-7s | rendered %5.1f dB | ideal %5.1f dB\n", state.name, eye.name,
                        nameOf(content), figure.rendered, figure.ideal);
            EXPECT_GE(figure.rendered, figure.bar()) << eye.name << ", " << nameOf(content);
        }
        const TruthCoverage coverage = coverageOf(bench, device, state, renderer.readMask());
        std::printf("cover %-11s | %-11s | device %4.1f %% | flaps %5.1f %% | mask differs %.2f %%\n", state.name,
                    eye.name, 100 * coverage.device, 100 * coverage.flaps, 100 * coverage.disagreement);
        EXPECT_GE(coverage.device, 0.6) << eye.name;
        EXPECT_GE(coverage.flaps, 0.3) << eye.name;
        EXPECT_LE(coverage.disagreement, 0.02) << eye.name;
    }
}

TEST_P(TruthTest, PointsAreSeenWhereTheEyePassHasThem) {
    const TruthState& state = GetParam();
    std::vector<double> all;
    for (const TruthEye& eye : truthEyes()) {
        const glm::vec3 from = positionOf(eye);
        std::vector<glm::dvec3> points = benchOf(state, ballsFrame(device, state, from, {}), from).devicePoints(42);
        for (std::size_t i = 0; i < points.size(); ++i) points[i].y += i % 3 == 0 ? 0.035 : 0.003;
        const ShowFrame frame = ballsFrame(device, state, from, points);
        TruthBench bench = benchOf(state, frame, from);
        renderer.draw(frame);
        std::vector<glm::dvec2> places;
        const LabLens lens = lensOf(bench.eye(), "eye");
        for (const glm::dvec3& point : points)
            if (const auto place = imageOf(lens, point)) places.push_back(*place);
        const auto errors =
            spotErrors(bench.seen(renderer.readProjector(0)), lightOf(renderer.readEye()), places, 16, bench.judged());
        std::printf("place %-11s | %-11s | mean %.3f | 95 %% %.3f pixels | %zu balls\n", state.name, eye.name,
                    meanOf(errors), quantileOf(errors, 0.95), errors.size());
        EXPECT_GE(errors.size(), 15U) << eye.name;
        EXPECT_LE(meanOf(errors), 0.5) << eye.name;
        EXPECT_LE(quantileOf(errors, 0.95), 1.5) << eye.name;
    }
}

std::string testName(const testing::TestParamInfo<TruthState>& state) {
    std::string name = state.param.name;
    std::replace(name.begin(), name.end(), ' ', '_');
    return name;
}

INSTANTIATE_TEST_SUITE_P(States, TruthTest, testing::ValuesIn(truthStates().begin(), truthStates().end()), testName);

} // namespace
} // namespace lumorph::test
