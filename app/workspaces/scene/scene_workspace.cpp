#include "app/workspaces/scene/scene_workspace.h"

#include <algorithm>

#include <QApplication>
#include <QDropEvent>
#include <QMimeData>
#include <QPointer>

#include "app/studio/document/scene_edit.h"
#include "app/workspaces/scene/outliner_model.h"
#include "app/workspaces/scene/scene_central_view.h"
#include "app/workspaces/scene/scene_commands.h"
#include "app/workspaces/scene/scene_docks.h"
#include "app/workspaces/scene/scene_words.h"
#include "app/workspaces/scene/technique_commands.h"
#include "core/scene/material_library.h"

namespace lumorph::studio {

namespace {

bool endsWith(const std::filesystem::path& file, std::initializer_list<const char*> extensions) {
    const QString extension = QString::fromStdString(file.extension().string()).toLower();
    return std::any_of(extensions.begin(), extensions.end(), [&](const char* one) { return extension == one; });
}

} // namespace

struct SceneWorkspace::Data : public QObject {
    explicit Data(Studio& shared) : studio(shared) {}

    [[nodiscard]] std::vector<Findable> thingsToFind();
    void takeModel(const std::filesystem::path& file);
    void takePicture(const std::filesystem::path& file);
    /// A material of the library that is dropped on the stage.
    bool eventFilter(QObject* watched, QEvent* event) override;

    Studio& studio;
    SceneSelection selection;
    QPointer<SceneCentralView> stage;
    bool seen = false;
};

/// The scene's items, and what is always there.
std::vector<Findable> SceneWorkspace::Data::thingsToFind() {
    std::vector<Findable> found;
    const auto add = [&](const QString& title, const QString& kind, const QString& icon, const SceneChoice& choice) {
        found.push_back({title, kind, icon, "scene", [this, choice] { selection.choose(choice); }});
    };
    using Kind = SceneChoice::Kind;
    const StudioState& state = studio.document.state();
    if (state.scene)
        for (const SceneItem& item : state.scene->items)
            add(QString::fromStdString(item.name), kindWord(item), kindIcon(item), {Kind::item, item.id});
    if (state.installation)
        for (std::size_t i = 0; i < state.installation->projectors.size(); ++i)
            add(QString::fromStdString(state.installation->projectors[i].name), tr("Projector"), "projector",
                {Kind::projector, static_cast<int>(i)});
    add(tr("Device"), tr("Setup"), "device", {Kind::device, 0});
    add(tr("Table"), tr("Setup"), "table", {Kind::table, 0});
    add(tr("Viewer"), tr("Setup"), "viewer", {Kind::viewer, 0});
    add(tr("Room light"), tr("Setup"), "room", {Kind::room, 0});
    return found;
}

/// It comes in as light alone, and may become what the servos follow.
void SceneWorkspace::Data::takeModel(const std::filesystem::path& file) {
    int id = 0;
    const QString name = QString::fromStdString(file.stem().string());
    editScene(studio.document, tr("Add %1").arg(name), [&](Scene& scene) { id = addItem(scene, modelItem(file)); });
    selection.chooseItem(id);
    const auto drive = [this, id, name] {
        editScene(studio.document, tr("Let the servos follow %1").arg(name),
                  [id](Scene& scene) { setItemRole(scene, id, ItemRole::physical); });
    };
    studio.notices.post("scene", {Notice::Level::info,
                                  name,
                                  tr("Added as light only."),
                                  tr("Shall the servos take its shape too?"),
                                  {{tr("Make it the target"), drive}, {tr("Keep as light"), [] {}}}});
}

/// It goes to what is chosen where that has a surface, else to the device.
bool SceneWorkspace::Data::eventFilter(QObject* watched, QEvent* event) {
    const auto type = event->type();
    if (type != QEvent::DragEnter && type != QEvent::DragMove && type != QEvent::Drop)
        return QObject::eventFilter(watched, event);
    auto* drop = static_cast<QDropEvent*>(event);
    if (!drop->mimeData()->hasFormat(kMaterialMime)) return QObject::eventFilter(watched, event);
    drop->acceptProposedAction();
    const std::vector<Material> all = readyMaterials();
    const auto number = static_cast<std::size_t>(drop->mimeData()->data(kMaterialMime).toUInt());
    if (type == QEvent::Drop && number < all.size() && !applyMaterial(studio, selection.choice(), all[number]))
        applyMaterial(studio, {SceneChoice::Kind::device, 0}, all[number]);
    return true;
}

/// It covers the device once.
void SceneWorkspace::Data::takePicture(const std::filesystem::path& file) {
    editScene(studio.document, tr("Show %1 on the device").arg(QString::fromStdString(file.filename().string())),
              [&file](Scene& scene) {
                  SceneTexture& texture = scene.device.material.colorTexture;
                  texture = {};
                  texture.image = std::filesystem::absolute(file).string();
                  texture.tile = {0.21F, 0.15F};
                  scene.device.material.color = glm::vec3(1.0F);
                  scene.device.show = DeviceSkin::Show::material;
              });
    selection.choose({SceneChoice::Kind::device, 0});
}

SceneWorkspace::SceneWorkspace(Studio& studio) : data_(std::make_unique<Data>(studio)) {
    addSceneCommands(studio, data_->selection, [this]() -> QWidget* {
        return data_->stage ? data_->stage->window() : QApplication::activeWindow();
    });
    addTechniqueCommands(studio);
    studio.commands.addFinder([data = data_.get()] { return data->thingsToFind(); });
}

SceneWorkspace::~SceneWorkspace() = default;

QString SceneWorkspace::id() const { return "scene"; }
QString SceneWorkspace::title() const { return "Scene"; }

QWidget* SceneWorkspace::makeCentralView() {
    Data& data = *data_;
    data.stage = new SceneCentralView(data.studio);
    data.stage->setActive(data.seen);
    data.stage->setAcceptDrops(true);
    data.stage->installEventFilter(&data);
    connect(data.stage, &SceneCentralView::picked, &data.selection, &SceneSelection::chooseItem);
    const auto mark = [&data] {
        if (data.stage) data.stage->setSelected(data.selection.item());
    };
    connect(&data.selection, &SceneSelection::changed, data.stage, mark);
    mark();
    return data.stage;
}

std::vector<WorkspaceDock> SceneWorkspace::makeDocks() {
    Data& data = *data_;
    return {{"dock.scene.outliner", "Outliner", "scene", makeOutlinerDock(data.studio, data.selection),
             Qt::LeftDockWidgetArea, false},
            {"dock.scene.library", "Library", "library", makeLibraryDock(data.studio, data.selection),
             Qt::LeftDockWidgetArea, true},
            {"dock.scene.inspector", "Inspector", "settings", makeInspectorDock(data.studio, data.selection),
             Qt::RightDockWidgetArea, false}};
}

void SceneWorkspace::setSeen(bool seen) {
    data_->seen = seen;
    if (data_->stage) data_->stage->setActive(seen);
}

bool SceneWorkspace::setForVisitors(bool on) {
    if (!data_->stage) return true;
    data_->stage->setForVisitors(on);
    if (!on) data_->stage->setSelected(data_->selection.item());
    return true;
}

bool SceneWorkspace::takeDrop(const std::vector<std::filesystem::path>& files) {
    const auto isModel = [](const auto& file) { return endsWith(file, {".glb", ".gltf"}); };
    const auto isPicture = [](const auto& file) { return endsWith(file, {".png", ".jpg", ".jpeg"}); };
    if (!std::all_of(files.begin(), files.end(), [&](const auto& file) { return isModel(file) || isPicture(file); }))
        return false;
    for (const auto& file : files)
        if (isModel(file))
            data_->takeModel(file);
        else
            data_->takePicture(file);
    return true;
}

} // namespace lumorph::studio
