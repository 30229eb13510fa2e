#include "core/loop/bend_comparison.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "core/loop/show_program.h"
#include "core/loop/show_stage.h"
#include "tests/core/loop/scene_loop_fixture.h"

// The device without and with view dependence, as both are seen beside each other (R23; paper, Fig. 9).

namespace lumorph::test {
namespace {

/// Servos follow a ridge along the middle, and the scene bends for who looks.
class Ridge final : public ShowProgram {
public:
    explicit Ridge(bool compares) : compares_(compares) {}
    ShowContent frame(const ShowMoment& moment) override {
        auto scene = std::make_shared<Scene>(emptyScene());
        scene->viewDependence.on = true;
        const Box box = boundingBox(moment.rig->restMesh().positions);
        HeightGrid grid{{box.min.x, box.min.z}, {box.max.x, box.max.z}, 24, 20, {}};
        for (int k = 0; k < 24 * 20; ++k)
            grid.heights.push_back(box.max.y + (k % 24 < 12 ? 0.012F : 0.0F)); // the left half rises
        ShowContent content;
        content.scene = scene;
        content.target = std::move(grid);
        content.following = Following::split;
        content.comparesBend = compares_;
        return content;
    }

private:
    bool compares_;
};

class BendComparisonTest : public SceneLoopTest {
protected:
    MatchWish wishFor(bool compares) {
        MatchWish wish = wishWith(emptyScene());
        wish.program = std::make_shared<Ridge>(compares);
        wish.driver = Driver::program;
        Installation room = *wish.installation;
        room.eye = {0.0F, 0.3F, 0.7F}; // in front, 23 degrees over the table: the far edge bends
        wish.installation = std::make_shared<const Installation>(room);
        return wish;
    }
    using Half = BendComparison::Half;
    std::vector<glm::vec3> positions(const MatchFrame& frame, Half half) {
        return *comparison_.half(frame, stage_.frame(frame), half).devicePositions;
    }
    static std::vector<glm::vec3> deformed(const std::vector<double>& strokes) {
        std::vector<glm::vec3> positions(tablet()->restMesh().positions.size());
        tablet()->deform(strokes, positions);
        return positions;
    }
    /// y of the highest point behind the middle.
    static float farTop(const std::vector<glm::vec3>& positions) {
        float top = 0.0F;
        for (const glm::vec3& p : positions)
            if (p.z < 0.0F) top = std::max(top, p.y);
        return top;
    }

    ShowStage stage_;
    BendComparison comparison_;
};

TEST_F(BendComparisonTest, OfAProgramKeepsItsShapeInBothHalvesAndAddsTheRuleByTheLargerStroke) {
    const auto frame = run(wishFor(true), 4.0);
    ASSERT_TRUE(frame->programError.empty()) << frame->programError;
    ASSERT_TRUE(frame->comparesBend);
    ASSERT_FALSE(frame->splitStrokes.empty());
    ASSERT_GT(*std::ranges::max_element(frame->splitStrokes), 0.05) << "there is a shape";
    EXPECT_EQ(frame->unbentStrokes, frame->splitStrokes);
    EXPECT_EQ(positions(*frame, Half::without), deformed(frame->splitStrokes));

    std::vector<double> bent = ViewRule(*tablet()).strokes({0.0, 0.3, 0.7});
    ASSERT_GT(*std::ranges::max_element(bent), 0.3);
    for (std::size_t i = 0; i < bent.size(); ++i) bent[i] = std::max(bent[i], frame->splitStrokes[i]);
    const std::vector<glm::vec3> with = positions(*frame, Half::with), wanted = deformed(bent);
    for (std::size_t v = 0; v < with.size(); ++v) ASSERT_LT(glm::distance(with[v], wanted[v]), 2e-4F) << v;
    EXPECT_GT(farTop(with), farTop(positions(*frame, Half::without)) + 0.01F);
    // Servos that bend by now stand as the second half, but for what their limits take off.
    EXPECT_NEAR(farTop(*frame->devicePositions), farTop(with), 0.004F);
}

TEST_F(BendComparisonTest, OfAnyOtherShowIsFlatBesideTheBendAlone) {
    const auto frame = run(wishFor(false), 2.0);
    EXPECT_FALSE(frame->comparesBend);
    const std::vector<double> none(tablet()->actuatorCount(), 0.0);
    EXPECT_EQ(positions(*frame, Half::without), deformed(none));
    EXPECT_GT(farTop(positions(*frame, Half::with)), farTop(deformed(none)) + 0.01F);
}

TEST_F(BendComparisonTest, WithoutAnEyeLeavesTheDeviceAsItIs) {
    MatchFrame frame = *run(wishFor(true), 1.0);
    frame.eye.reset();
    for (const Half half : {Half::without, Half::with}) EXPECT_EQ(positions(frame, half), *frame.devicePositions);
}

} // namespace
} // namespace lumorph::test
