#include "app/applications/labyrinth/board.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <glm/geometric.hpp>

#include "app/applications/demo_items.h"
#include "app/applications/labyrinth/board_model.h"
#include "core/scene/material_library.h"

namespace lumorph::labyrinth {
namespace {

constexpr const char* kMazeModel = "labyrinth level"; ///< an asset that is in memory alone
constexpr float kGem = 0.0050F;                       ///< side of a pick-up, metres
constexpr double kGemFloats = 0.0042;                 ///< its middle over the floor, metres
constexpr double kBeamHeight = 0.016;                 ///< of the light over the goal, metres
constexpr double kRingSpeed = 0.045;                  ///< by which its side grows, metres a second
constexpr double kRingSeconds = 1.4;                  ///< until it has faded
constexpr int kTrail = kFirstPickUp - kFirstTrail;

glm::vec3 colorOf(PickUp pickUp) {
    switch (pickUp) {
    case PickUp::red:
        return {0.95F, 0.16F, 0.14F};
    case PickUp::green:
        return {0.15F, 0.78F, 0.30F};
    case PickUp::blue:
        return {0.14F, 0.42F, 0.95F};
    case PickUp::yellow:
        return {0.99F, 0.80F, 0.10F};
    default:
        return {0.72F, 0.26F, 0.92F};
    }
}

Material glowing(const std::string& name, const glm::vec3& color, float strength) {
    Material material;
    material.name = name;
    material.color = color;
    material.roughness = 0.25F;
    material.reflection = 0.1F;
    material.emission = color;
    material.emissionStrength = strength;
    return material;
}

glm::vec3 overFloor(const Level& level, glm::ivec2 cell, double height) {
    const glm::dvec2 place = centreOf(level, cell);
    return {glm::dvec3(place.x, static_cast<double>(kSheet) + level.at(cell).height * level.step + height, place.y)};
}

glm::vec3 shown(const glm::dvec3& place) { return glm::vec3(place) + glm::vec3(0.0F, kSheet, 0.0F); }

SceneItem ball() {
    SceneItem item = demoItem(kBallItem, "Ball", ShapeItem{ShapeItem::Form::sphere, glm::vec3(2.0 * kBallRadius)});
    item.material = readyMaterial("Stone");
    item.material.name = "Ball";
    // Marbled, so that one sees it roll, and with a light of its own, so that nobody loses it in a shadow.
    item.material.color = {1.0F, 0.62F, 0.30F};
    item.material.colorTexture.tile = glm::vec2(0.012F);
    item.material.normalMaps[0] = {};
    item.material.roughness = 0.12F;
    item.material.reflection = 0.15F;
    item.material.emission = {1.0F, 0.34F, 0.08F};
    item.material.emissionStrength = 0.55F;
    return item;
}

SceneItem ghostBall() {
    SceneItem item = demoItem(kGhostItem, "Best run", ShapeItem{ShapeItem::Form::sphere, glm::vec3(1.7 * kBallRadius)});
    item.material = glowing("Ghost", {0.55F, 0.85F, 1.0F}, 0.5F);
    item.opacity = 0.45F;
    item.visible = false;
    return item;
}

SceneItem goalDisc(const Level& level) {
    const auto side = static_cast<float>(0.8 * level.cell);
    SceneItem item = demoItem(kGoalItem, "Goal", ShapeItem{ShapeItem::Form::cylinder, {side, 0.0006F, side}});
    item.position = overFloor(level, level.goal, 0.0003);
    item.material = glowing("Goal", {0.25F, 0.95F, 0.45F}, 0.7F);
    return item;
}

SceneItem goalBeam(const Level& level) {
    const auto side = static_cast<float>(0.5 * level.cell);
    SceneItem item = demoItem(kBeamItem, "Light over the goal",
                              ShapeItem{ShapeItem::Form::cylinder, {side, static_cast<float>(kBeamHeight), side}});
    item.position = overFloor(level, level.goal, 0.5 * kBeamHeight);
    item.material = glowing("Light", {0.25F, 0.95F, 0.45F}, 0.8F);
    item.material.reflection = 0.0F;
    item.opacity = 0.28F;
    return item;
}

SceneItem goalRing(const Level& level) {
    SceneItem item = demoItem(kRingItem, "Goal reached", ShapeItem{ShapeItem::Form::cylinder, glm::vec3(1.0F)});
    item.position = overFloor(level, level.goal, 0.5 * level.wall);
    item.material = glowing("Reached", {0.45F, 1.0F, 0.60F}, 1.0F);
    item.visible = false;
    return item;
}

SceneItem ballBehind() {
    SceneItem item = demoItem(kBehindItem, "Ball behind a wall", ShapeItem{ShapeItem::Form::sphere, glm::vec3(1.0F)});
    item.material = glowing("Ball behind a wall", {1.0F, 0.62F, 0.30F}, 0.9F);
    item.material.unlit = true;
    item.opacity = 0.5F;
    item.visible = false;
    return item;
}

SceneItem trailLight(int number) {
    const double share = 1.0 - static_cast<double>(number) / kTrail;
    const auto side = static_cast<float>(2.0 * kBallRadius * (0.25 + 0.55 * share));
    SceneItem item = demoItem(kFirstTrail + number, "Trail", ShapeItem{ShapeItem::Form::sphere, glm::vec3(side)});
    item.material = glowing("Trail", {1.0F, 0.55F, 0.18F}, 0.9F);
    item.material.reflection = 0.0F;
    item.opacity = static_cast<float>(0.30 * share);
    item.visible = false;
    return item;
}

SceneItem gem(const Level& level, glm::ivec2 cell, int id, int number) {
    const glm::vec3 color = colorOf(level.at(cell).pickUp);
    SceneItem item =
        demoItem(id, "Pick-up " + std::to_string(number + 1), ShapeItem{ShapeItem::Form::box, glm::vec3(kGem)});
    item.position = overFloor(level, cell, kGemFloats);
    // On its corner, turning.
    item.rotation = glm::angleAxis(0.9553F, glm::normalize(glm::vec3(1.0F, 0.0F, 1.0F)));
    item.motion = {1.6, 0.0008, 1.8 + 0.2 * (number % 4)};
    item.material = glowing("Gem", color, 0.18F);
    item.material.roughness = 0.12F;
    item.material.reflection = 0.2F;
    return item;
}

/// A picked-up gem lies on the far wall, from the left.
glm::vec3 trophyPlace(const Level& level, std::size_t number) {
    const double pitch = level.cell;
    const double top = wallTop(level, {level.columns / 2, 0});
    return {glm::dvec3((-0.5 * level.columns + 1.5) * level.cell + pitch * static_cast<double>(number),
                       static_cast<double>(kSheet) + top + 0.5 * static_cast<double>(kGem),
                       -0.5 * level.cell * (level.rows - 1))};
}

SceneItem& itemOf(Scene& scene, int id) { return *std::ranges::find(scene.items, id, &SceneItem::id); }

void showPickUps(Scene& scene, const Game& game, const std::vector<glm::ivec2>& all) {
    std::vector<PickUp> waiting = game.taken(); // which lie on the wall, in the order in which they were taken
    std::vector<bool> placed(waiting.size(), false);
    for (std::size_t k = 0; k < all.size(); ++k) {
        if (std::ranges::find(game.pickUps(), all[k]) != game.pickUps().end()) continue;
        const PickUp color = game.level().at(all[k]).pickUp;
        std::size_t place = 0;
        while (place + 1 < waiting.size() && (placed[place] || waiting[place] != color)) ++place;
        placed[place] = true;
        SceneItem& item = itemOf(scene, kFirstPickUp + static_cast<int>(k));
        item.position = trophyPlace(game.level(), place);
        item.motion.bob = 0.0;
    }
}

/// Where the ball was at the last times of its run; a ball that lies leaves none.
void showTrail(Scene& scene, const Game& game) {
    const std::vector<glm::vec3>& run = game.run().positions;
    glm::vec3 before(game.ball().position);
    for (int k = 0; k < kTrail && static_cast<std::size_t>(k) < run.size() && !game.fallen() && !game.done(); ++k) {
        const glm::vec3& at = run[run.size() - 1 - static_cast<std::size_t>(k)];
        constexpr float kJump = 0.03F; // after a fall the ball is elsewhere at once, metres
        if (glm::distance(at, before) > kJump) return;
        if (glm::distance(at, glm::vec3(game.ball().position)) > static_cast<float>(kBallRadius)) {
            SceneItem& light = itemOf(scene, kFirstTrail + k);
            light.visible = true;
            light.position = shown(glm::dvec3(at));
        }
        before = at;
    }
}

/// A ball of light before the wall that hides it, as large for the eye as the ball would be.
void showBehind(Scene& scene, const Game& game, const glm::dvec3& eye) {
    const glm::dvec3 way = eye - game.ball().position;
    const double far = glm::length(way);
    const double hidden = hiddenUpTo(game.blocks(), game.ball().position, eye);
    const double at = hidden + kBallRadius;
    if (hidden == 0.0 || at > 0.5 * far) return;
    SceneItem& item = itemOf(scene, kBehindItem);
    item.visible = true;
    item.position = shown(game.ball().position + (at / far) * way);
    item.scale = glm::vec3(static_cast<float>(2.0 * kBallRadius * (1.0 - at / far)));
}

/// Where a ray goes into a block and out of it, metres from its origin; `out` below `in`: it passes.
struct Passage {
    double in = 0.0, out = 1.0; ///< no block is farther
};

Passage within(const Block& block, const glm::dvec3& from, const glm::dvec3& way) {
    Passage passage;
    // Inside is where `at` plus a way times `per` is not below 0.
    const auto cut = [&passage](double at, double per) {
        if (per > 0.0)
            passage.in = std::max(passage.in, -at / per);
        else if (per < 0.0)
            passage.out = std::min(passage.out, -at / per);
        else if (at < 0.0)
            passage.out = -1.0;
    };
    const auto cross = [](const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; };
    const glm::dvec2 flat(from.x, from.z), flatWay(way.x, way.z);
    for (std::size_t k = 0; k < 4; ++k) {
        const glm::dvec2 side = block.outline[(k + 1) % 4] - block.outline[k];
        cut(cross(side, flat - block.outline[k]), cross(side, flatWay));
    }
    const glm::dvec2 u = block.outline[1] - block.outline[0], v = block.outline[3] - block.outline[0];
    const double det = cross(u, v), du = block.tops[1] - block.tops[0], dv = block.tops[3] - block.tops[0];
    const auto rises = [&](const glm::dvec2& by) { return (cross(by, v) * du + cross(u, by) * dv) / det; };
    cut(from.y - block.bottom, way.y);
    cut(block.tops[0] + rises(flat - block.outline[0]) - from.y, rises(flatWay) - way.y);
    return passage;
}

void lean(Scene& scene, const glm::dvec2& lean) {
    SceneItem& board = itemOf(scene, kLeaning);
    const glm::dquat turn = boardTurn(lean);
    const glm::dvec3 middle(0.0, static_cast<double>(kSheet), 0.0);
    board.rotation = glm::normalize(glm::quat(turn));
    board.position = glm::vec3(middle - turn * middle);
}

void showGoal(Scene& scene, const Game& game, double inGoal) {
    SceneItem& beam = itemOf(scene, kBeamItem);
    const double breath = 0.5 + 0.5 * std::sin(2.0 * std::numbers::pi * 0.6 * game.seconds());
    beam.opacity = static_cast<float>(0.18 + 0.16 * breath);
    if (!game.done()) return;
    itemOf(scene, kGoalItem).material.emissionStrength = 2.0F;
    beam.opacity = 0.45F;
    if (inGoal > kRingSeconds) return;
    SceneItem& ring = itemOf(scene, kRingItem);
    const double side = game.level().cell + kRingSpeed * inGoal;
    ring.visible = true;
    ring.scale = {glm::dvec3(side, 0.0008, side)};
    ring.opacity = static_cast<float>(0.45 * (1.0 - inGoal / kRingSeconds));
}

} // namespace

glm::dquat boardTurn(const glm::dvec2& lean) {
    const glm::dvec3 up = glm::normalize(glm::dvec3(std::tan(lean.x), 1.0, std::tan(lean.y)));
    return glm::normalize(glm::dquat(1.0 + up.y, up.z, 0.0, -up.x)); // the shortest turn from +Y
}

double hiddenUpTo(const std::vector<Block>& blocks, const glm::dvec3& ball, const glm::dvec3& eye) {
    const glm::dvec3 way = glm::normalize(eye - ball);
    double hidden = 0.0;
    for (const Block& block : blocks) {
        const auto [in, out] = within(block, ball, way);
        if (out > std::max(in, kBallRadius)) hidden = std::max(hidden, out);
    }
    return hidden;
}

std::shared_ptr<const SceneAssets> boardPictures(const std::vector<Level>& levels) {
    Scene all;
    const auto add = [&](const Material& material) {
        SceneItem item = demoItem(static_cast<int>(all.items.size()) + 1, material.name, ShapeItem{});
        item.material = material;
        all.items.push_back(std::move(item));
    };
    for (const Level& level : levels)
        for (const Material& material : boardMaterials(level)) add(material);
    add(ball().material);
    add(defaultScene().table.material);
    return loadSceneAssets(all, {});
}

Board::Board(const Game& game, const SceneAssets& pictures) : still_(defaultScene()), pickUps_(game.pickUps()) {
    const Level& level = game.level();
    still_.device.show = DeviceSkin::Show::content;
    SceneItem maze = demoItem(kMaze, level.name.substr(0, 80), MeshItem{.model = kMazeModel});
    maze.position.y = kSheet;
    still_.items.push_back(std::move(maze));
    still_.items.push_back(ball());
    still_.items.push_back(ghostBall());
    still_.items.push_back(goalDisc(level));
    still_.items.push_back(goalBeam(level));
    still_.items.push_back(goalRing(level));
    still_.items.push_back(ballBehind());
    for (int k = 0; k < kTrail; ++k) still_.items.push_back(trailLight(k));
    int number = 0;
    for (const glm::ivec2 cell : pickUps_) {
        still_.items.push_back(gem(level, cell, kFirstPickUp + number, number));
        ++number;
    }
    for (SceneItem& item : still_.items)
        if (item.id != kSun) item.parent = kLeaning;
    still_.items.insert(still_.items.begin(), demoItem(kLeaning, "Board", GroupItem{}));
    auto assets = std::make_shared<SceneAssets>(pictures);
    assets->models[kMazeModel] = std::make_shared<const SceneModel>(boardModel(level, game.blocks()));
    assets_ = std::move(assets);
}

std::shared_ptr<const Scene> Board::show(const Game& game, const Beside& beside) const {
    auto scene = std::make_shared<Scene>(still_);
    lean(*scene, beside.lean);
    SceneItem& rolling = itemOf(*scene, kBallItem);
    rolling.position = shown(game.ball().position);
    rolling.rotation = glm::normalize(glm::quat(game.ball().rotation));
    rolling.visible = !game.fallen();
    if (const Ghost* best = beside.best; best && !best->positions.empty() && game.seconds() < best->seconds) {
        SceneItem& ghost = itemOf(*scene, kGhostItem);
        ghost.visible = true;
        ghost.position = shown(glm::dvec3(positionAt(*best, game.seconds())));
    }
    showTrail(*scene, game);
    showGoal(*scene, game, beside.inGoal);
    if (beside.eye && !game.fallen()) {
        const glm::dvec3 middle(0.0, static_cast<double>(kSheet), 0.0);
        showBehind(*scene, game, glm::conjugate(boardTurn(beside.lean)) * (*beside.eye - middle));
    }
    showPickUps(*scene, game, pickUps_);
    return scene;
}

} // namespace lumorph::labyrinth
