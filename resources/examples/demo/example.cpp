#include "app/applications/example/example.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "app/applications/demo_items.h"

namespace lumorph::example {
namespace {

constexpr glm::dvec2 kHalf{0.11, 0.075}; ///< half the field of play, metres: about the tablet's
constexpr double kRadius = 0.009;        ///< of the ball, metres
constexpr double kHill = 0.012;          ///< height of the hill below it, metres
constexpr double kHillRadius = 0.035;    ///< where the hill is down to a third, metres
constexpr double kHaste = 4.0;           ///< share of the way to the pointer that the ball rolls in a second

} // namespace

ShowContent ExampleProgram::frame(const ShowMoment& moment) {
    seconds_ += moment.step;
    silence_ += moment.step;
    listen(moment);
    ball_ += (pointed_ - ball_) * (1.0 - std::exp(-kHaste * moment.step));

    ShowContent content;
    content.scene = std::make_shared<const Scene>(scene());
    content.target = heights();
    content.following = Following::split; // servos take what is slow of it; the scene shows all
    return content;
}

void ExampleProgram::listen(const ShowMoment& moment) {
    for (const ShowInput& input : moment.inputs) {
        if (input.value != 0.0) silence_ = 0.0;
        if (input.name == "pointer.x") pointed_.x = kHalf.x * std::clamp(input.value, -1.0, 1.0);
        if (input.name == "pointer.y") pointed_.y = kHalf.y * std::clamp(input.value, -1.0, 1.0);
    }
    // Nobody there: it shows by itself what can be done.
    if (silence_ >= kSilence) pointed_ = 0.7 * kHalf * glm::dvec2(std::sin(0.9 * seconds_), std::sin(1.3 * seconds_));
}

double ExampleProgram::heightAt(const glm::dvec2& place) const {
    const double far = glm::length(place - ball_) / kHillRadius;
    return kHill * std::exp(-far * far);
}

HeightGrid ExampleProgram::heights() const {
    HeightGrid grid;
    grid.min = -kHalf;
    grid.max = kHalf;
    grid.columns = 56;
    grid.rows = 38;
    for (int j = 0; j < grid.rows; ++j)
        for (int i = 0; i < grid.columns; ++i) {
            const glm::dvec2 share(i / (grid.columns - 1.0), j / (grid.rows - 1.0));
            const double height = heightAt(grid.min + share * (grid.max - grid.min));
            grid.heights.push_back(kSheet + static_cast<float>(height));
        }
    return grid;
}

Scene ExampleProgram::scene() const {
    Scene scene = defaultScene();
    scene.device.material.color = {0.30F, 0.46F, 0.40F};
    // Light shows the hill whole; the device has it only where its servos reach.
    const auto across = static_cast<float>(2.0 * kHillRadius);
    SceneItem hill = demoItem(
        101, "Hill", ShapeItem{ShapeItem::Form::sphere, {across, static_cast<float>(2.0 * heightAt(ball_)), across}});
    hill.position = {ball_.x, kSheet, ball_.y};
    hill.material.color = {0.86F, 0.74F, 0.42F};
    scene.items.push_back(hill);
    SceneItem ball = demoItem(100, "Ball", ShapeItem{ShapeItem::Form::sphere, glm::vec3(2.0 * kRadius)});
    ball.position = {glm::dvec3(ball_.x, static_cast<double>(kSheet) + heightAt(ball_) + kRadius, ball_.y)};
    ball.material.name = "Paint";
    ball.material.color = {0.90F, 0.20F, 0.12F};
    ball.material.roughness = 0.25F;
    scene.items.push_back(ball);
    return scene;
}

Demo exampleDemo() {
    return {
        .name = "example",
        .title = {"Example", "Beispiel"},
        .sentence = {"Point somewhere, and the ball rolls there; your hand feels the hill it stands on.",
                     "Zeige irgendwohin, und die Kugel rollt dorthin; die Hand fühlt den Hügel, auf dem sie steht."},
        .thumbnail = "thumbnails/example.png",
        .open = bundledTablet,
        // A start brings a seed, for a program with chance in it; this one has none.
        .program = [](const ProgramStart&, const Progress&) -> std::unique_ptr<ShowProgram> {
            return std::make_unique<ExampleProgram>();
        }};
}

} // namespace lumorph::example
