#include <numbers>

#include "app/workspaces/scene/item_rows.h"
#include "app/workspaces/scene/texture_rows.h"

namespace lumorph::studio {

namespace {

constexpr double kLargest = 10.0; ///< metres
constexpr const char* kSizeEnds = "xyz";

template <class Kind> Part<Kind> kindOf(const Part<SceneItem>& item) {
    return within<Kind>(item, [](auto& found) { return std::get_if<Kind>(&found.kind); });
}

template <class Kind> std::function<bool(const StudioState&)> isKind(const Part<Kind>& part) {
    return [part](const StudioState& state) { return part.read(state) != nullptr; };
}

/// The animations of the model as far as it has been read; the first entry stands still.
QStringList animationsOf(const SceneAssets* assets, const std::string& model) {
    QStringList names{QObject::tr("Stands still")};
    const auto found = assets ? assets->models.find(model) : decltype(assets->models.end()){};
    if (!assets || found == assets->models.end() || !found->second) return names;
    for (const Model::Animation& animation : found->second->model.animations)
        names << (animation.name.empty() ? QObject::tr("Animation %1").arg(names.size())
                                         : QString::fromStdString(animation.name));
    return names;
}

void addMesh(SceneForm& form, Studio& studio, const Part<SceneItem>& item) {
    const auto part = kindOf<MeshItem>(item);
    form.showWhile(&form.section("item.section.mesh", QObject::tr("Model")), isKind(part));
    addFileSlot(form, studio,
                {"item.model", QObject::tr("File"), modelFilter(),
                 [part](const StudioState& state) {
                     const MeshItem* mesh = part.read(state);
                     return mesh ? mesh->model : std::string();
                 },
                 [part](StudioState& state, const std::string& asset) {
                     if (MeshItem* mesh = part.write(state)) mesh->model = asset;
                 }});
    QComboBox* animation = form.addChoice(
        {"item.animation", QObject::tr("Animation"), {}}, {QObject::tr("Stands still")},
        [](const StudioState&) { return std::nullopt; },
        [part](StudioState& state, int index) {
            if (MeshItem* mesh = part.write(state)) mesh->animation = index - 1;
        });
    form.onRefresh([animation, part, &studio](const StudioState& state) {
        const MeshItem* mesh = part.read(state);
        if (!mesh) return;
        const QStringList names = animationsOf(studio.document.state().assets.get(), mesh->model);
        const QSignalBlocker quiet(animation);
        if (animation->count() != names.size() || animation->itemText(animation->count() - 1) != names.back()) {
            animation->clear();
            animation->addItems(names);
        }
        animation->setCurrentIndex(std::min(mesh->animation + 1, animation->count() - 1));
    });
    form.number(
        {"item.speed", QObject::tr("Speed"), QObject::tr("100 % is as the file says")},
        {Quantity::share, 0.0, 100.0, 1.0}, part, [](auto& mesh) -> auto& { return mesh.speed; });
    form.check(
        {"item.ownMaterials", QObject::tr("The file's own materials"), {}}, part,
        [](auto& mesh) -> auto& { return mesh.ownMaterials; });
}

void addShape(SceneForm& form, const Part<SceneItem>& item) {
    const auto part = kindOf<ShapeItem>(item);
    form.showWhile(&form.section("item.section.shape", QObject::tr("Shape")), isKind(part));
    form.choice(
        {"item.form", QObject::tr("Form"), {}},
        {QObject::tr("Box"), QObject::tr("Sphere"), QObject::tr("Cylinder"), QObject::tr("Plane")}, part,
        [](auto& shape) -> auto& { return shape.form; });
    form.vector(
        {"item.size", QObject::tr("Size"), QObject::tr("Width, height and depth")},
        {Quantity::length, 1e-4, kLargest, 0.03}, kSizeEnds, part, [](auto& shape) -> auto& { return shape.size; });
}

void addFog(SceneForm& form, const Part<SceneItem>& item) {
    const auto part = kindOf<FogItem>(item);
    form.showWhile(&form.section("item.section.fog", QObject::tr("Fog")), isKind(part));
    form.vector(
        {"item.fog.size", QObject::tr("Box"), QObject::tr("The box that it fills")},
        {Quantity::length, 1e-3, kLargest, 0.2}, kSizeEnds, part, [](auto& fog) -> auto& { return fog.size; });
    form.color(
        {"item.fog.color", QObject::tr("Fog colour"), {}}, part, [](auto& fog) -> auto& { return fog.color; });
    form.number(
        {"item.fog.density", QObject::tr("Density"),
         QObject::tr("How much of what is behind it one metre takes away, at the densest")},
        {Quantity::plain, 0.0, 1000.0, 12.0, 0.5}, part, [](auto& fog) -> auto& { return fog.density; });
    form.number(
        {"item.fog.grain", QObject::tr("Clouds"), QObject::tr("How large its clouds are")},
        {Quantity::length, 1e-3, kLargest, 0.06}, part, [](auto& fog) -> auto& { return fog.grain; });
    form.vector(
        {"item.fog.drift", QObject::tr("Drifts a second"), QObject::tr("The wind")},
        {Quantity::length, -kLargest, kLargest, 0.0}, "xz", part, [](auto& fog) -> auto& { return fog.drift; });
}

} // namespace

void addKindRows(SceneForm& form, Studio& studio, const Part<SceneItem>& item) {
    addMesh(form, studio, item);
    addShape(form, item);
    addHeightRows(form, studio, item);
    addFog(form, item);
    addLightRows(form, item);
    form.endSection();
}

} // namespace lumorph::studio
