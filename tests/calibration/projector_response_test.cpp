#include "core/scene/projector_response.h"

#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "core/render/gl/headless_context.h"
#include "tests/calibration/show_world.h"

namespace lumorph {
namespace {

InstalledProjector measured(InstalledProjector projector, double gamma, float black) {
    for (int k = 0; k <= 128; ++k) {
        const double value = k / 128.0;
        const auto light = [&](double power) { return static_cast<float>(std::pow(value, power)); };
        projector.responseCurve.push_back({value, {light(gamma), light(gamma + 0.2), light(gamma - 0.2)}});
    }
    projector.black = {black, 1.2F * black, 0.8F * black};
    projector.gain = {0.9F, 1.0F, 1.1F};
    return projector;
}

// A grey of device and table, as Embree's rays see it in the light of what the pass sends.
TEST(ProjectorResponse, IsInvertedByTheProjectorPassInTheLabsRays) {
    const HeadlessContext context;
    const CalibratedCamera above = cameraLookingAt({0.02, 1.1, 0.25}, {0.0, 0.0, 0.0}, {180, 130}, 310.0);
    const InstalledProjector left = projectorAt({-0.7, 1.4, 0.1}, {-0.06, 0.0, 0.0}, {640, 400}, 1700.0);
    const InstalledProjector right = projectorAt({0.75, 1.3, -0.1}, {0.07, 0.0, 0.02}, {600, 420}, 1600.0);
    for (const bool two : {false, true}) {
        std::vector<InstalledProjector> projectors{measured(left, 2.3, 0.004F)};
        if (two) projectors.push_back(measured(right, 2.0, 0.006F));
        const double wanted = std::pow((0.7 + 0.055) / 1.055, 2.4);
        SpatialRenderer renderer;
        const ShowFrame frame = frameOf(unlitScene(glm::vec3(0.7F), glm::vec3(0.7F), projectors), liftedFlaps());
        renderer.draw(frame);
        EXPECT_TRUE(renderer.warnings().empty());
        const auto worst = [&](const std::vector<glm::vec3>& seen) {
            int off = 0, judged = 0;
            for (const glm::vec3& light : seen) {
                if (light.g < 0.2F) continue; // where no projector reaches
                ++judged;
                for (int channel = 0; channel < 3; ++channel)
                    off += std::abs(static_cast<double>(light[channel]) / wanted - 1.0) > 0.02 ? 1 : 0;
            }
            std::printf("%d of %d channels of %d places off by more than 2 %%\n", off, 3 * judged, judged);
            return judged > 3000 ? static_cast<double>(off) / (3.0 * judged) : 1.0;
        };
        EXPECT_LT(worst(Lab(labOf(frame, renderer)).radiance(above, 1)), 0.05);
        (void)renderer.readLab(above);
        EXPECT_TRUE(renderer.warnings().empty()) << "the preview's programs too";
    }
}

TEST(ProjectorResponse, LiftsTheDarkOnlyWhereSeveralProjectorsOverlap) {
    Installation room;
    EXPECT_EQ(blackFloor(room), glm::vec3(0.0F));
    room.projectors = {measured(projectorAt({-0.5, 1.6, 0.0}, {0.0, 0.0, 0.0}, {640, 400}, 900.0), 2.2, 0.004F)};
    EXPECT_EQ(blackFloor(room), glm::vec3(0.0F)) << "one projector";
    room.projectors.push_back(measured(projectorAt({0.5, 1.6, 0.0}, {0.0, 0.0, 0.0}, {640, 400}, 900.0), 2.2, 0.004F));
    EXPECT_GT(blackFloor(room).g, 0.0F);
}

} // namespace
} // namespace lumorph
