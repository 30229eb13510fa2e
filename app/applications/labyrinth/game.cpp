#include "app/applications/labyrinth/game.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

namespace lumorph::labyrinth {
namespace {

constexpr double kMostAtOnce = 0.25;    ///< seconds
constexpr double kLeanTime = 0.06;      ///< time constant of the lean, seconds: keys know no half way
constexpr double kFallen = -0.006;      ///< metres over the sheet: below it the ball is in a hole
constexpr int kFallSteps = 144;         ///< 0.6 s until the ball comes back
constexpr int kBumpSteps = 12;          ///< 50 ms between two bumps
constexpr double kLeastBump = 0.03;     ///< metres a second
constexpr double kLeastRoll = 0.01;     ///< metres a second
constexpr double kReach = 0.0062;       ///< between the middles of ball and pick-up, metres
constexpr double kPickUpHeight = 0.004; ///< of its middle over the floor, metres
constexpr int kGhostSteps = 8;          ///< a position of the run

glm::dvec3 gravityAt(const glm::dvec2& lean) {
    return Game::kGravity * glm::normalize(glm::dvec3(std::tan(lean.x), -1.0, std::tan(lean.y)));
}

} // namespace

Game::Game(Level level, std::uint64_t seed)
    : level_(std::move(level)), blocks_(blocksOf(level_)), world_(level_, blocks_) {
    for (int row = 0; row < level_.rows; ++row)
        for (int column = 0; column < level_.columns; ++column)
            if (level_.at({column, row}).pickUp != PickUp::none) pickUps_.emplace_back(column, row);
    safe_ = restingOn(level_.start);
    // A hand does not put it down twice at the same place.
    std::mt19937_64 random(seed);
    const auto aside = [&] { return 0.001 * (static_cast<double>(random() >> 11U) * 0x1p-53 - 0.5); };
    const double x = aside();
    world_.place(safe_ + glm::dvec3(x, 0.0, aside()));
    run_.level = level_.name;
    run_.positions.emplace_back(ball().position);
}

glm::dvec3 Game::restingOn(glm::ivec2 cell) const {
    const glm::dvec2 at = centreOf(level_, cell);
    return {at.x, level_.at(cell).height * level_.step + kBallRadius, at.y};
}

bool Game::isSafe(glm::ivec2 cell) const {
    for (int dz = -1; dz <= 1; ++dz)
        for (int dx = -1; dx <= 1; ++dx) {
            const glm::ivec2 beside = cell + glm::ivec2(dx, dz);
            if (!level_.holds(beside) || level_.at(beside).tile == Tile::hole) return false;
        }
    return level_.at(cell).tile == Tile::floor;
}

double Game::seconds() const noexcept { return static_cast<double>(steps_) * BallWorld::kStep; }

int Game::score() const noexcept {
    const int saved = done_ ? static_cast<int>(10.0 * std::max(0.0, level_.seconds - seconds())) : 0;
    return std::max(0, 100 * static_cast<int>(taken_.size()) + saved - 50 * falls_);
}

void Game::happened(GameEvent::Kind kind, double strength) { events_.push_back({kind, strength, ball().position}); }

void Game::advance(double seconds, const glm::dvec2& lean) {
    events_.clear();
    left_ += std::clamp(seconds, 0.0, kMostAtOnce);
    for (; left_ >= BallWorld::kStep; left_ -= BallWorld::kStep) step(lean);
    const double speed = glm::length(ball().velocity);
    if (world_.onGround() && !fallen() && speed > kLeastRoll) happened(GameEvent::Kind::roll, speed);
}

void Game::step(const glm::dvec2& lean) {
    if (done_) return;
    const double length = glm::length(lean);
    const glm::dvec2 wanted = length > kMostLean ? lean * (kMostLean / length) : lean;
    lean_ += (wanted - lean_) * (BallWorld::kStep / kLeanTime);
    ++steps_;
    if (fallenSteps_ > 0 && --fallenSteps_ == 0) world_.place(safe_);
    if (fallenSteps_ == 0) {
        world_.step(gravityAt(lean_));
        follow();
    }
    if (steps_ % kGhostSteps == 0) run_.positions.emplace_back(ball().position);
}

/// What the step has led to.
void Game::follow() {
    const glm::dvec3& at = ball().position;
    const glm::ivec2 cell = cellAt(level_, {at.x, at.z});
    if (at.y < kFallen || !level_.holds(cell)) return fall();
    quietSteps_ = std::max(0, quietSteps_ - 1);
    if (world_.bump() > kLeastBump && quietSteps_ == 0) {
        happened(GameEvent::Kind::bump, world_.bump());
        quietSteps_ = kBumpSteps;
    }
    if (world_.onGround() && isSafe(cell)) safe_ = restingOn(cell);
    const auto reached = [&](glm::ivec2 pickUp) {
        const glm::dvec3 middle = restingOn(pickUp) + glm::dvec3(0.0, kPickUpHeight - kBallRadius, 0.0);
        return glm::distance(at, middle) < kReach;
    };
    for (const glm::ivec2 pickUp : pickUps_) {
        if (!reached(pickUp)) continue;
        taken_.push_back(level_.at(pickUp).pickUp);
        happened(GameEvent::Kind::pickUp, static_cast<double>(taken_.size()));
    }
    std::erase_if(pickUps_, reached);
    if (cell != level_.goal || !world_.onGround()) return;
    done_ = true;
    happened(GameEvent::Kind::goal, 1.0);
    run_.seconds = seconds();
    run_.score = score();
}

void Game::fall() {
    ++falls_;
    fallenSteps_ = kFallSteps;
    happened(GameEvent::Kind::fall, 1.0);
}

} // namespace lumorph::labyrinth
