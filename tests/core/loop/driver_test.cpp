#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/core/loop/scene_loop_fixture.h"

// Who moves the servos: by the flags of those who have flags, and by the one value that the loop reads.

namespace lumorph::test {
namespace {

enum class Item { none, light, field, hiddenField, split, physicalTarget, splitTarget };

Scene sceneWith(Item item) {
    Scene scene = emptyScene();
    switch (item) {
    case Item::none:
        return scene;
    case Item::light:
        scene.items = {itemOf(ItemRole::virtualOnly, waves(0.01, 3.0))};
        return scene;
    case Item::field:
    case Item::hiddenField:
        scene.items = {itemOf(ItemRole::physical, waves(0.01, 3.0))};
        break;
    case Item::split:
        scene.items = {itemOf(ItemRole::split, waves(0.01, 3.0))};
        break;
    case Item::physicalTarget:
        scene.items = {itemOf(ItemRole::physical, TargetItem{})};
        break;
    case Item::splitTarget:
        scene.items = {itemOf(ItemRole::split, TargetItem{})};
        break;
    }
    scene.items.front().position = {0.0F, 0.03F, 0.0F};
    scene.items.front().visible = item != Item::hiddenField;
    return scene;
}

TEST(Driver, FollowsFromWhetherThereIsSomethingToFollow) {
    struct Case {
        bool live;
        Item item;
        Driver driver;
    };
    const Case cases[] = {
        {false, Item::none, Driver::hand},
        {false, Item::field, Driver::hand},
        {false, Item::physicalTarget, Driver::hand},
        {true, Item::none, Driver::target},
        {true, Item::light, Driver::target},
        {true, Item::hiddenField, Driver::target},
        {true, Item::physicalTarget, Driver::target},
        {true, Item::field, Driver::sceneItem},
        {true, Item::split, Driver::sceneItem},
        {true, Item::splitTarget, Driver::sceneItem},
    };
    for (const Case& c : cases) {
        const Scene scene = sceneWith(c.item);
        EXPECT_EQ(driverOf(c.live, &scene), c.driver) << c.live << " " << static_cast<int>(c.item);
    }
    EXPECT_EQ(driverOf(true, nullptr), Driver::target);
    EXPECT_EQ(driverOf(false, nullptr), Driver::hand);
}

/// What a frame says about who moved its servos.
std::string moverOf(const MatchWish& wish, const MatchFrame& frame) {
    if (!frame.splitStrokes.empty()) return "split";
    if (frame.wantedStrokes == wish.strokes) return "strokes";
    if (std::ranges::all_of(frame.wantedStrokes, [](double s) { return s == 0.0; })) return "rest";
    if (frame.votes && frame.statesSeen > 0) return "match";
    return "other";
}

// The device stands where `strokes` say unless what the driver needs is there; only the driver decides.
TEST(Driver, AloneDecidesWhoMovesTheServos) {
    const auto field = matchFieldOf(cushionRig());
    const auto block = stillTarget(boxMesh({0, 0, 0}, {0.06F, 0.006F, 0.05F}));
    struct Case {
        Driver driver;
        Item item;
        bool target;
        Showing showing;
        const char* mover;
    };
    const Case cases[] = {
        {Driver::target, Item::none, true, Showing::both, "match"},
        {Driver::target, Item::field, true, Showing::both, "match"}, // whatever the scene would drive
        {Driver::target, Item::none, false, Showing::both, "strokes"},
        {Driver::target, Item::none, true, Showing::virtualOnly, "rest"},
        {Driver::sceneItem, Item::field, true, Showing::both, "other"},
        {Driver::sceneItem, Item::split, true, Showing::both, "split"},
        {Driver::sceneItem, Item::splitTarget, true, Showing::both, "split"},
        {Driver::sceneItem, Item::splitTarget, false, Showing::both, "strokes"},
        {Driver::sceneItem, Item::hiddenField, true, Showing::both, "strokes"},
        {Driver::sceneItem, Item::none, true, Showing::both, "strokes"},
        {Driver::sceneItem, Item::field, true, Showing::virtualOnly, "rest"},
        {Driver::hand, Item::field, true, Showing::both, "strokes"},
        {Driver::hand, Item::none, false, Showing::both, "strokes"},
        {Driver::hand, Item::none, true, Showing::virtualOnly, "rest"},
        {Driver::dance, Item::field, true, Showing::both, "other"},
        {Driver::dance, Item::none, false, Showing::virtualOnly, "rest"},
    };
    for (const Case& c : cases) {
        ManualClock clock;
        MatchLoop loop(clock);
        MatchWish wish = wishFor(field, c.target ? block : nullptr);
        Scene scene = sceneWith(c.item);
        scene.showing = c.showing;
        wish.scene = std::make_shared<const Scene>(scene);
        wish.installation = std::make_shared<const Installation>(defaultInstallation());
        wish.assets = std::make_shared<const SceneAssets>();
        wish.driver = c.driver;
        wish.strokes = {0.3, 0.2, 0.1};
        EXPECT_EQ(moverOf(wish, *loop.step(wish, kFrame)), c.mover)
            << static_cast<int>(c.driver) << " " << static_cast<int>(c.item);
    }
}

TEST(Driver, ThatLacksWhatItNeedsIsRefused) {
    ManualClock clock;
    MatchLoop loop(clock);
    MatchWish wish = wishFor(matchFieldOf(cushionRig()), nullptr);
    for (const Driver driver : {Driver::recording, Driver::program}) {
        wish.driver = driver;
        EXPECT_THROW((void)loop.step(wish, kFrame), InvalidInput);
    }
}

} // namespace
} // namespace lumorph::test
