#pragma once

#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include <glm/vec2.hpp>
#include <gtest/gtest.h>

#include "core/loop/match_loop.h"
#include "tests/core/loop/loop_fixture.h"
#include "tests/support/cut_tablet.h"
#include "tests/support/scene_in_room.h"

namespace lumorph::test {

inline constexpr double kFrame = 1.0 / 60.0; ///< seconds

inline std::shared_ptr<const Rig> tablet() {
    static const auto rig = std::make_shared<const Rig>(test::cutTablet());
    return rig;
}

inline SceneInRoom emptyScene() {
    SceneInRoom scene = defaultSceneInRoom();
    scene.items.clear();
    return scene;
}

inline SceneItem itemOf(ItemRole role, decltype(SceneItem::kind) kind, int id = 1) {
    SceneItem item;
    item.id = id;
    item.name = "item";
    item.role = role;
    item.kind = std::move(kind);
    return item;
}

inline HeightItem waves(double amplitude, double period) {
    HeightItem water;
    water.size = {0.2F, 0.14F};
    water.waves = {{amplitude, 0.25, period, Angle{}, Angle{}}};
    return water;
}

/// `waves`, written down here: heights over the device of an item lifted to `base`, as it is turned by `yaw`.
inline double waveHeight(const HeightItem& water, const glm::vec2& at, double t) {
    const Wave& wave = water.waves.front();
    return wave.amplitude * std::sin(2.0 * std::numbers::pi * (at.x / wave.length - t / wave.period));
}

/// A loop with a scene, in a time that the test turns.
class SceneLoopTest : public testing::Test {
protected:
    MatchWish wishWith(const SceneInRoom& scene, std::shared_ptr<const Rig> rig = tablet()) {
        MatchWish wish;
        wish.strokes.assign(rig->actuatorCount(), 0.0);
        wish.rig = std::move(rig);
        setSceneInRoom(wish, scene);
        wish.driver = driverOf(scene);
        wish.assets = std::make_shared<const SceneAssets>();
        return wish;
    }
    std::shared_ptr<const MatchFrame> step(const MatchWish& wish, double seconds = kFrame) {
        clock_.advance(Microseconds(std::llround(1e6 * seconds)));
        return loop_.step(wish, seconds);
    }
    std::shared_ptr<const MatchFrame> run(const MatchWish& wish, double seconds) {
        std::shared_ptr<const MatchFrame> frame;
        for (double t = 0.0; t < seconds; t += kFrame) frame = step(wish);
        return frame;
    }

    ManualClock clock_;
    MatchLoop loop_{clock_};
};

} // namespace lumorph::test
