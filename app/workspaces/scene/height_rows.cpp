#include <numbers>

#include <QPushButton>

#include "app/studio/look/icons.h"
#include "app/workspaces/scene/item_rows.h"
#include "app/workspaces/scene/repeated_rows.h"
#include "app/workspaces/scene/texture_rows.h"

namespace lumorph::studio {

namespace {

constexpr double kWaveTurn = 2.0 * std::numbers::pi;

Part<HeightItem> heightOf(const Part<SceneItem>& item) {
    return within<HeightItem>(item, [](auto& found) { return std::get_if<HeightItem>(&found.kind); });
}

void addWave(SceneForm& form, const Part<Wave>& wave, const QString& name) {
    form.number(
        {name + ".amplitude", QObject::tr("Height"), QObject::tr("Above and below the middle")},
        {Quantity::length, 0.0, 1.0, 0.005, 0.0005}, wave, [](auto& w) -> auto& { return w.amplitude; });
    form.number(
        {name + ".length", QObject::tr("Length"), QObject::tr("From crest to crest")},
        {Quantity::length, 1e-3, 10.0, 0.1, 0.005}, wave, [](auto& w) -> auto& { return w.length; });
    form.number(
        {name + ".period", QObject::tr("Once in"), QObject::tr("0 stands still")}, {Quantity::seconds, 0.0, 600.0, 2.0},
        wave, [](auto& w) -> auto& { return w.period; });
    form.number(
        {name + ".direction", QObject::tr("Direction"), QObject::tr("0 degrees runs to the right, 90 to the front")},
        {Quantity::angle, -kWaveTurn, kWaveTurn}, wave, [](auto& w) -> auto& { return w.direction; });
    form.number(
        {name + ".phase", QObject::tr("Starts at"), {}}, {Quantity::angle, -kWaveTurn, kWaveTurn}, wave,
        [](auto& w) -> auto& { return w.phase; });
}

} // namespace

void addHeightRows(SceneForm& form, Studio& studio, const Part<SceneItem>& item) {
    const auto part = heightOf(item);
    form.showWhile(&form.section("item.section.height", QObject::tr("Water and heights")),
                   [part](const StudioState& state) { return part.read(state) != nullptr; });
    form.vector(
        {"item.height.size", QObject::tr("Size"), QObject::tr("Width and depth")}, {Quantity::length, 1e-3, 10.0, 0.2},
        "xz", part, [](auto& height) -> auto& { return height.size; });
    addFileSlot(form, studio,
                {"item.height.image", QObject::tr("Picture of heights"), pictureFilter(),
                 [part](const StudioState& state) {
                     const HeightItem* height = part.read(state);
                     return height ? height->image : std::string();
                 },
                 [part](StudioState& state, const std::string& asset) {
                     if (HeightItem* height = part.write(state)) height->image = asset;
                 }});
    form.number(
        {"item.height.imageHeight", QObject::tr("Black to white"), QObject::tr("How high white stands over black")},
        {Quantity::length, -1.0, 1.0, 0.02}, part, [](auto& height) -> auto& { return height.imageHeight; });
    form.number(
        {"item.height.floor", QObject::tr("Walls down to"), {}}, {Quantity::length, -10.0, 10.0, -0.02}, part,
        [](auto& height) -> auto& { return height.floor; });
    form.number(
        {"item.height.calmEdge", QObject::tr("Calm rim"), QObject::tr("Over which waves fade towards the rim")},
        {Quantity::length, 0.0, 10.0, 0.0}, part, [](auto& height) -> auto& { return height.calmEdge; });
    const auto waves = [](auto& height) { return &height.waves; };
    addRepeatedRows<Wave>(form, {"item.wave", QObject::tr("Wave"), QObject::tr("Add a wave")},
                          within<std::vector<Wave>>(part, waves), addWave);
}

} // namespace lumorph::studio
