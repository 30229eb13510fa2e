#include "app/applications/water/water_program.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "app/applications/demo_items.h"
#include "app/applications/water/water.h"
#include "core/scene/posed_scene.h"

namespace lumorph {
namespace {

constexpr glm::dvec2 kHalf{0.105, 0.075}; ///< of the water, metres
constexpr double kCarries = 0.5;          ///< of water that runs, metres a second squared for a slope of 1
constexpr double kSlides = 0.04;          ///< down a wave, likewise: it mostly goes up and down
constexpr double kDrag = 0.9;             ///< 1 / s
constexpr double kHome = 0.5;             ///< by which it comes back to its place, 1 / s^2
constexpr double kBounce = 0.4;
constexpr double kProbe = 0.008;   ///< half the distance over which a slope is read, metres
constexpr double kNotch = 0.08;    ///< of the storm
constexpr double kHeldSpeed = 0.4; ///< of the storm, a second
constexpr double kStormTime = 0.8; ///< seconds in which waves follow
constexpr double kMostStep = 0.1;  ///< seconds; after a pause the rest is left out
constexpr int kFirstThrown = 100;  ///< ids of items

bool isAfloat(const SceneItem& item) { return std::holds_alternative<ShapeItem>(item.kind); }

/// Turns +Y to the normal of a slope along x and z.
glm::quat along(const glm::dvec2& slope) {
    const glm::vec3 normal = glm::normalize(glm::vec3(-slope.x, 1.0, -slope.y));
    const glm::vec3 axis(normal.z, 0.0F, -normal.x);
    const float length = glm::length(axis);
    return length < 1e-6F ? glm::quat(1.0F, 0.0F, 0.0F, 0.0F)
                          : glm::angleAxis(std::asin(std::min(1.0F, length)), axis / length);
}

std::array<float, 5> around(const HeightItem& sea, double seconds, const glm::dvec2& at) {
    const auto p = static_cast<float>(kProbe);
    const glm::vec2 middle(at);
    const std::array<glm::vec2, 5> places{middle, middle + glm::vec2(p, 0.0F), middle - glm::vec2(p, 0.0F),
                                          middle + glm::vec2(0.0F, p), middle - glm::vec2(0.0F, p)};
    std::array<float, 5> heights{};
    sampleHeights(sea, nullptr, seconds, places, heights);
    return heights;
}

} // namespace

WaterProgram::WaterProgram() : still_(waterScene()) {
    assets_ = loadSceneAssets(still_, {});
    const auto firstFloat = std::stable_partition(still_.items.begin(), still_.items.end(), std::not_fn(isAfloat));
    for (auto item = firstFloat; item != still_.items.end(); ++item) {
        const glm::vec3 size = std::get<ShapeItem>(item->kind).size;
        Float one{*item, {item->position.x, item->position.z}, {item->position.x, item->position.z}, {}, 0.0, 0.0};
        one.item.motion = {};
        one.radius = 0.5 * std::max(size.x, size.z);
        one.lift = 0.12 * size.y;
        first_.push_back(std::move(one));
    }
    still_.items.erase(firstFloat, still_.items.end());
    caption_ = std::make_shared<const ShowCaption>(ShowCaption{
        {"A sea you can feel", "Ein Meer, das man fühlt"},
        {"Lean it, and the water runs. The wheel, + and - make storm or calm; N throws something in.",
         "Neige es, und das Wasser läuft. Das Rad, + und - machen Sturm oder Stille; N wirft etwas hinein."}});
    begin();
}

void WaterProgram::begin() {
    floats_ = first_;
    wanted_ = 1.0;
    held_ = 0.0;
}

void WaterProgram::listen(const ShowMoment& moment) {
    visitor_.take(moment);
    for (const ShowInput& input : moment.inputs) {
        if (!std::isfinite(input.value)) continue;
        if (input.name == "wheel") wanted_ += kNotch * std::clamp(input.value, -8.0, 8.0);
        if (input.name == "key.in") held_ = input.value > 0.5 ? 1.0 : 0.0;
        if (input.name == "key.out") held_ = input.value > 0.5 ? -1.0 : 0.0;
    }
    if (visitor_.next()) throwIn();
    if (visitor_.restart() || visitor_.left()) begin();
    const double step = std::clamp(moment.step, 0.0, kMostStep);
    wanted_ = std::clamp(wanted_ + kHeldSpeed * held_ * step, kCalmest, kStormiest);
    storm_ += (wanted_ - storm_) * (1.0 - std::exp(-step / kStormTime));
    slosh_.advance(moment.step, visitor_.lean());
}

/// Now a ball, now a box, each beside the last; the oldest that was thrown goes where there are too many.
void WaterProgram::throwIn() {
    constexpr std::array<glm::vec3, 4> kColors{
        {{0.95F, 0.78F, 0.18F}, {0.22F, 0.55F, 0.90F}, {0.93F, 0.93F, 0.90F}, {0.30F, 0.72F, 0.40F}}};
    if (floats_.size() >= kMostFloats) floats_.erase(floats_.begin() + static_cast<std::ptrdiff_t>(first_.size()));
    int id = kFirstThrown;
    while (std::ranges::find(floats_, id, [](const Float& one) { return one.item.id; }) != floats_.end()) ++id;
    const auto number = static_cast<std::size_t>(id - kFirstThrown);
    Float one = first_[number % first_.size()];
    one.item.id = id;
    one.item.name = "Thrown in " + std::to_string(number + 1);
    std::get<ShapeItem>(one.item.kind).size *= 0.75F;
    one.item.material.color = kColors[number % kColors.size()];
    one.radius *= 0.75;
    one.lift *= 0.75;
    const double turn = 2.4 * static_cast<double>(number); // the golden angle spreads them
    one.home = one.at = 0.6 * kHalf * glm::dvec2(std::cos(turn), std::sin(turn));
    floats_.push_back(std::move(one));
}

void WaterProgram::drift(const HeightItem& sea, double seconds, double step) {
    for (Float& one : floats_) {
        const std::array<float, 5> heights = around(sea, seconds, one.at);
        const glm::dvec2 wave = glm::dvec2(heights[1] - heights[2], heights[3] - heights[4]) / (2.0 * kProbe);
        // Down the waves, and with the water where it runs to the low side.
        one.velocity +=
            step * (kHome * (one.home - one.at) + kCarries * slosh_.slope() - kSlides * wave - kDrag * one.velocity);
        one.at += step * one.velocity;
        one.item.position = {glm::dvec3(one.at.x, heights[0] + slosh_.heightAt(one.at) + one.lift, one.at.y)};
        one.item.rotation = along(wave + slosh_.slope());
    }
    keepApart();
}

void WaterProgram::keepApart() {
    for (std::size_t i = 0; i < floats_.size(); ++i)
        for (std::size_t j = i + 1; j < floats_.size(); ++j) {
            Float &a = floats_[i], &b = floats_[j];
            const glm::dvec2 way = b.at - a.at;
            const double far = glm::length(way), least = a.radius + b.radius;
            if (far >= least || far < 1e-9) continue;
            const glm::dvec2 push = way * (0.5 * (least - far) / far);
            a.at -= push;
            b.at += push;
            std::swap(a.velocity, b.velocity);
        }
    for (Float& one : floats_)
        for (int axis = 0; axis < 2; ++axis) {
            const double most = kHalf[axis] - one.radius;
            if (std::abs(one.at[axis]) <= most) continue;
            one.at[axis] = std::copysign(most, one.at[axis]);
            one.velocity[axis] *= -kBounce;
        }
}

ShowContent WaterProgram::frame(const ShowMoment& moment) {
    listen(moment);
    auto scene = std::make_shared<Scene>(still_);
    SceneItem& sea = *std::ranges::find_if(
        scene->items, [](const SceneItem& item) { return std::holds_alternative<HeightItem>(item.kind); });
    auto& field = std::get<HeightItem>(sea.kind);
    for (Wave& wave : field.waves) wave.amplitude *= storm_;
    drift(field, moment.seconds, std::clamp(moment.step, 0.0, kMostStep));
    ShowContent content;
    HeightGrid felt = gridOf(sea, moment.seconds);
    std::size_t k = 0;
    for (int j = 0; j < felt.rows; ++j)
        for (int i = 0; i < felt.columns; ++i) {
            const glm::dvec2 share(static_cast<double>(i) / (felt.columns - 1),
                                   static_cast<double>(j) / (felt.rows - 1));
            felt.heights[k++] += static_cast<float>(slosh_.heightAt(glm::mix(felt.min, felt.max, share)));
        }
    sea.rotation = along(slosh_.slope());
    const float level = sea.position.y;
    for (const Float& one : floats_) {
        scene->items.push_back(one.item);
        scene->items.back().position.y += level;
    }
    content.scene = std::move(scene);
    content.assets = assets_;
    content.caption = caption_;
    content.target = std::move(felt);
    content.following = Following::split;
    return content;
}

} // namespace lumorph
