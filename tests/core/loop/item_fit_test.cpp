#include <cmath>

#include <gtest/gtest.h>

#include "tests/core/loop/scene_loop_fixture.h"

// How well servos take the shape of a scene's item: counted here voxel by voxel from what the item is.

namespace lumorph::test {
namespace {

class ItemFitTest : public SceneLoopTest {
protected:
    /// The tablet with a box over it, centred at x = z = 0, whose top lies `height` above the surface at rest.
    MatchWish boxWish(const glm::vec3& size, double height, const glm::vec2& centre = {0.0F, 0.0F}) {
        SceneInRoom scene = emptyScene();
        SceneItem item = itemOf(ItemRole::physical, ShapeItem{ShapeItem::Form::box, size});
        const float top = field()->field.restSurface + static_cast<float>(height);
        item.position = {centre.x, top - 0.5F * size.y, centre.y};
        scene.items = {item};
        MatchWish wish = wishWith(scene);
        wish.field = field();
        return wish;
    }
    static std::shared_ptr<const MatchField> field() {
        static const auto made = matchFieldOf(*tablet());
        return made;
    }
    /// Of the box's part above the surface at rest: intersection over union with what is covered at `strokes`.
    static double iouByHand(const glm::vec3& size, double height, const std::vector<double>& strokes) {
        const VoxelFrame& frame = field()->field.frame;
        BitColumns covered(frame.dimensions);
        CoverageScratch scratch;
        field()->coverage.coveredAt(strokes, covered, scratch);
        const double rest = static_cast<double>(field()->field.restSurface);
        std::size_t both = 0, either = 0;
        for (int x = 0; x < frame.dimensions.x; ++x)
            for (int y = 0; y < frame.dimensions.y; ++y)
                for (int z = 0; z < frame.dimensions.z; ++z) {
                    if (!field()->coverage.domain().test(x, y, z)) continue;
                    const glm::dvec3 p = frame.centre(x, y, z);
                    const bool inBox = std::abs(p.x) < 0.5 * size.x && std::abs(p.z) < 0.5 * size.z && p.y > rest &&
                                       p.y < rest + height;
                    const bool inDevice = covered.test(x, y, z);
                    both += inBox && inDevice ? 1 : 0;
                    either += inBox || inDevice ? 1 : 0;
                }
        return static_cast<double>(both) / static_cast<double>(either);
    }
};

TEST_F(ItemFitTest, IsTheIouOfWhatIsCoveredWithAllUpToTheItemsTop) {
    const glm::vec3 size(0.12F, 0.02F, 0.1F);
    const MatchWish wish = boxWish(size, 0.03);
    const auto frame = run(wish, 3.0);
    ASSERT_TRUE(frame->itemFit);
    EXPECT_EQ(frame->itemFit->item, 1);
    EXPECT_GT(frame->itemFit->iouWanted, 0.1);
    EXPECT_NEAR(frame->itemFit->iouWanted, iouByHand(size, 0.03, frame->wantedStrokes), 0.01);
    EXPECT_NEAR(frame->itemFit->iouEstimated, iouByHand(size, 0.03, frame->estimatedStrokes), 0.01);
    EXPECT_LT(frame->itemFit->shareBeyondFrame, 0.02);
    EXPECT_NEAR(frame->itemFit->volume, 0.12 * 0.03 * 0.1, 0.1 * 0.12 * 0.03 * 0.1);
    EXPECT_TRUE(loop_.settled()) << "what is told is of the last frame";
}

TEST_F(ItemFitTest, SaysWhatLiesBesideAndAboveTheFrame) {
    const Box box = field()->field.frame.box();
    const float width = box.max.x - box.min.x;
    const auto beside = run(boxWish({0.5F * width, 0.02F, 0.08F}, 0.02, {box.max.x, 0.0F}), 1.0);
    ASSERT_TRUE(beside->itemFit);
    EXPECT_NEAR(beside->itemFit->shareBeyondFrame, 0.5, 0.04) << "half of it lies to the right";
    const double room = static_cast<double>(box.max.y - field()->field.restSurface);
    const auto above = run(boxWish({0.1F, 0.02F, 0.08F}, 3.0 * room), 1.0);
    ASSERT_TRUE(above->itemFit);
    EXPECT_NEAR(above->itemFit->shareBeyondFrame, 2.0 / 3.0, 0.02);
}

// A small thing made physical moved nothing, and nothing said so.
TEST_F(ItemFitTest, OfASmallSphereIsPoor) {
    SceneInRoom scene = emptyScene();
    SceneItem item = itemOf(ItemRole::physical, ShapeItem{ShapeItem::Form::sphere, glm::vec3(0.02F)});
    item.position.y = field()->field.restSurface + 0.01F;
    scene.items = {item};
    MatchWish wish = wishWith(scene);
    wish.field = field();
    const auto frame = run(wish, 1.0);
    ASSERT_TRUE(frame->itemFit);
    EXPECT_LT(frame->itemFit->iouWanted, 0.1);
    EXPECT_GT(frame->itemFit->volume, 0.0);
}

TEST_F(ItemFitTest, IsToldOnlyWhileTheItemDrivesAndNothingIsMatchedThen) {
    MatchWish wish = boxWish({0.1F, 0.02F, 0.1F}, 0.03);
    wish.target = stillTarget(boxMesh({0, 0, 0}, {0.06F, 0.03F, 0.05F}));
    const auto byItem = step(wish);
    EXPECT_TRUE(byItem->itemFit);
    EXPECT_FALSE(byItem->matched) << "the numbers of a target that nobody follows say nothing";
    wish.driver = Driver::target;
    const auto byTarget = step(wish);
    EXPECT_FALSE(byTarget->itemFit);
    EXPECT_TRUE(byTarget->matched);
    EXPECT_GE(byTarget->iouWanted, byTarget->iouVoting);
    wish.driver = Driver::sceneItem;
    EXPECT_TRUE(step(wish)->itemFit) << "at once, not when it is due again";
}

} // namespace
} // namespace lumorph::test
