#include "app/applications/techniques/techniques_program.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "app/applications/demo_items.h"
#include "core/scene/posed_scene.h"

namespace lumorph {
namespace {

constexpr double kAside = 0.35; ///< of the way from the middle to the edge
constexpr double kPressed = 0.5;

std::shared_ptr<const ShowCaption> captionOf(const Technique& technique, bool on) {
    const std::string number = std::to_string(technique.key) + "  ";
    ShowCaption caption{{number + technique.name.english, number + technique.name.german}, technique.sentence};
    if (!on && technique.key != 0) {
        caption.title.english += ": off";
        caption.title.german += ": aus";
        caption.sentence = {"The same without it.", "Dasselbe ohne."};
    }
    return std::make_shared<const ShowCaption>(std::move(caption));
}

/// All that the scenes name, each file once.
std::shared_ptr<const SceneAssets> picturesOf(const std::vector<std::shared_ptr<const Scene>>& scenes) {
    Scene all = *scenes.front();
    for (const auto& scene : scenes) {
        SceneItem item;
        item.id = static_cast<int>(all.items.size()) + 1000;
        item.kind = ShapeItem{};
        item.material = scene->device.material;
        all.items.push_back(std::move(item));
    }
    return loadSceneAssets(all, {});
}

} // namespace

TechniquesProgram::TechniquesProgram() {
    std::vector<std::shared_ptr<const Scene>> scenes;
    for (const Technique& technique : techniques()) {
        Ready ready;
        for (const bool on : {false, true}) {
            ready.scenes[on ? 1 : 0] = std::make_shared<const Scene>(techniqueScene(technique.key, on));
            ready.captions[on ? 1 : 0] = captionOf(technique, on);
        }
        scenes.insert(scenes.end(), ready.scenes.begin(), ready.scenes.end());
        all_.push_back(std::move(ready));
    }
    pictures_ = picturesOf(scenes);
}

ShowContent TechniquesProgram::frame(const ShowMoment& moment) {
    visitor_.take(moment);
    if (visitor_.came() || visitor_.left()) alone_ = 0.0;
    if (visitor_.came()) on_ = true;
    visitor_.there() ? answer(moment) : playItself(moment.step);
    const Ready& ready = all_[shown_];
    ShowContent content;
    content.scene = ready.scenes[on_ ? 1 : 0];
    content.assets = pictures_;
    content.caption = ready.captions[on_ ? 1 : 0];
    content.target = gridOf(*drivingItem(*content.scene), moment.seconds);
    content.following = Following::split;
    return content;
}

/// The plain device is left out: each begins as one.
void TechniquesProgram::playItself(double step) {
    alone_ += step;
    if (alone_ > kWithout + kWith) this->step(1);
    if (shown_ == 0) choose(1);
    on_ = alone_ > kWithout;
}

void TechniquesProgram::answer(const ShowMoment& moment) {
    for (const ShowInput& input : moment.inputs) press(input);
    if (visitor_.next()) step(1);
    if (visitor_.restart()) choose(1);
    const double leant = visitor_.lean().x / Visitor::kMostLean - visitor_.push().x;
    const double aside = visitor_.pointer() ? visitor_.pointer()->x : leant;
    const auto side = std::abs(aside) > kAside ? std::optional(aside > 0.0) : std::nullopt;
    if (side && side != side_) on_ = *side;
    if (side) side_ = side;
}

/// One after the other, so that none is too short to be seen.
void TechniquesProgram::press(const ShowInput& input) {
    const auto pushes = [&](double& before) {
        return std::abs(std::exchange(before, input.value)) <= kPressed && std::abs(input.value) > kPressed;
    };
    if (input.name == "pad.x" && pushes(stick_.x)) return step(input.value > 0.0 ? 1 : -1);
    if (input.name == "pad.y" && pushes(stick_.y)) on_ = input.value < 0.0;
    if (!(input.value > kPressed)) return;
    if (input.name == "key.right") step(1);
    if (input.name == "key.left") step(-1);
    if (input.name == "key.up") on_ = true;
    if (input.name == "key.down") on_ = false;
    if (input.name == "key.off") on_ = !on_;
    for (std::size_t k = 0; k < all_.size(); ++k)
        if (input.name == "key." + std::to_string(k)) choose(k);
}

void TechniquesProgram::step(int by) {
    const auto count = static_cast<int>(all_.size());
    choose(static_cast<std::size_t>((key() + by + count) % count));
}

void TechniquesProgram::choose(std::size_t technique) {
    shown_ = technique;
    on_ = true;
    alone_ = 0.0;
}

} // namespace lumorph
