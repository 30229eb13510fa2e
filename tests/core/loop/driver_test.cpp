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

TEST(Driver, OfASceneIsItsVisibleItemUnlessThatStandsForTheTarget) {
    const std::pair<Item, Driver> cases[] = {
        {Item::none, Driver::target},           {Item::light, Driver::target},    {Item::hiddenField, Driver::target},
        {Item::physicalTarget, Driver::target}, {Item::field, Driver::sceneItem}, {Item::split, Driver::sceneItem},
        {Item::splitTarget, Driver::sceneItem},
    };
    for (const auto& [item, driver] : cases) EXPECT_EQ(driverOf(sceneWith(item)), driver) << static_cast<int>(item);
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
