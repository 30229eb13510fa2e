#include "app/workspaces/scene/scene_commands.h"

#include <QActionGroup>
#include <QFileInfo>

#include "app/studio/document/scene_edit.h"
#include "app/studio/look/icons.h"
#include "app/workspaces/scene/projector_pose.h"
#include "app/workspaces/scene/scene_words.h"
#include "app/workspaces/scene/texture_rows.h"

namespace lumorph::studio {

namespace {

/// In the order of the menu; empty: a line.
const QStringList kAdded{"scene.add.model",
                         "scene.add.target",
                         "",
                         "scene.add.box",
                         "scene.add.sphere",
                         "scene.add.cylinder",
                         "scene.add.plane",
                         "",
                         "scene.add.water",
                         "scene.add.heights",
                         "scene.add.fog",
                         "",
                         "scene.add.sun",
                         "scene.add.lamp",
                         "",
                         "scene.add.group",
                         "",
                         "scene.add.projector"};

constexpr float kAboveDevice = 0.035F; ///< metres: where a solid is seen to stand on the tablet

SceneItem shape(ShapeItem::Form form, const char* name, const glm::vec3& size) {
    SceneItem item;
    item.name = name;
    item.position = {0.0F, 0.02F + 0.5F * size.y, 0.0F};
    item.kind = ShapeItem{form, size};
    item.material.name = "Plain";
    item.material.color = {0.85F, 0.55F, 0.30F};
    return item;
}

SceneItem water() {
    SceneItem item;
    item.name = "Water";
    item.position = {0.0F, 0.03F, 0.0F};
    HeightItem height;
    height.waves = {{}, {0.003, 0.06, 1.4, Angle::degrees(50.0), {}}};
    height.calmEdge = 0.02;
    item.kind = height;
    item.material.name = "Water";
    item.material.color = {0.25F, 0.55F, 0.65F};
    item.material.roughness = 0.05F;
    item.material.reflection = 0.6F;
    item.material.refraction = 0.6F;
    return item;
}

SceneItem fog() {
    SceneItem item;
    item.name = "Fog";
    item.position = {0.0F, kAboveDevice + 0.02F, 0.0F};
    item.kind = FogItem{};
    return item;
}

SceneItem light(LightItem::Kind kind) {
    SceneItem item;
    item.name = kind == LightItem::Kind::sun ? "Sun" : "Lamp";
    item.anchor = Anchor::world;
    item.position = kind == LightItem::Kind::sun ? glm::vec3(0.4F, 0.8F, 0.3F) : glm::vec3(0.15F, 0.3F, 0.1F);
    LightItem value;
    value.kind = kind;
    value.intensity = 1.0;
    item.kind = value;
    return item;
}

SceneItem plain(const char* name, ItemKind kind) {
    SceneItem item;
    item.name = name;
    item.kind = std::move(kind);
    return item;
}

class SceneCommands : public QObject {
public:
    SceneCommands(Studio& studio, SceneSelection& selection, std::function<QWidget*()> parent)
        : QObject(&studio.commands), studio_(studio), selection_(selection), parent_(std::move(parent)) {
        addAdding();
        addChanging();
        addShowing();
        addPlaying();
        connect(&selection, &SceneSelection::changed, this, [this] { follow(); });
        connect(&studio.document, &StudioDocument::changed, this, [this](StateParts parts) {
            if (parts & (StatePart::scene | StatePart::installation)) follow();
        });
        connect(&studio.project, &ProjectService::chooseAsset, this, [this](const QString& asset) { relink(asset); });
        follow();
    }

private:
    QAction* add(const QString& id, const QString& text, const QString& hint, const QString& iconName,
                 const QString& keys, bool checkable, std::function<void()> run) {
        Commands::Options options;
        options.icon = iconName;
        options.shortcut = QKeySequence(keys);
        options.menu = "Things";
        options.workspace = "scene";
        options.checkable = checkable;
        QAction* action = studio_.commands.add(id, text, options, std::move(run));
        const QString shown = options.shortcut.toString(QKeySequence::NativeText);
        action->setToolTip(hint + (shown.isEmpty() ? QString() : " (" + shown + ")"));
        return action;
    }

    void addAdding() {
        const auto one = [this](const char* id, const QString& text, const QString& hint, const QString& iconName,
                                std::function<SceneItem()> make) {
            add(QString("scene.add.") + id, text, hint, iconName, {}, false,
                [this, make = std::move(make)] { put(make()); });
        };
        add("scene.add.model", tr("Add a model..."), tr("A glTF file, with its materials and animations"), "surface",
            "Ctrl+Shift+M", false, [this] { chooseModel(); });
        one("target", tr("Add the target"), tr("Light draws the target where the matcher has it"), "target",
            [] { return plain("Target", TargetItem{}); });
        one("box", tr("Add a box"), tr("A simple solid"), "box",
            [] { return shape(ShapeItem::Form::box, "Box", glm::vec3(0.03F)); });
        one("sphere", tr("Add a sphere"), tr("A simple solid"), "sphere",
            [] { return shape(ShapeItem::Form::sphere, "Sphere", glm::vec3(0.03F)); });
        one("cylinder", tr("Add a cylinder"), tr("A simple solid"), "cylinder", [] {
            return shape(ShapeItem::Form::cylinder, "Cylinder", {0.03F, 0.04F, 0.03F});
        });
        one("plane", tr("Add a plane"), tr("A flat rectangle"), "plane", [] {
            return shape(ShapeItem::Form::plane, "Plane", {0.08F, 0.001F, 0.06F});
        });
        one("water", tr("Add water"), tr("A surface with travelling waves"), "water", water);
        add("scene.add.heights", tr("Add a picture of heights..."), tr("A grey picture: the whiter, the higher"),
            "heights", {}, false, [this] { chooseHeights(); });
        one("fog", tr("Add fog"), tr("Drifting fog in a box"), "fog", fog);
        one("sun", tr("Add a sun"), tr("Parallel light with shadows"), "sun",
            [] { return light(LightItem::Kind::sun); });
        one("lamp", tr("Add a lamp"), tr("Light from a place near by"), "lamp",
            [] { return light(LightItem::Kind::lamp); });
        add("scene.add.projector", tr("Add a projector"), tr("Another one that lights the device"), "projector", {},
            false, [this] { addProjector(); });
        one("group", tr("Add a group"), tr("Holds others together"), "group",
            [] { return plain("Group", GroupItem{}); });
    }

    void addProjector() {
        InstalledProjector projector = defaultInstallation().projectors.front();
        const auto& all = studio_.document.state().installation->projectors;
        projector.name = "Projector " + std::to_string(all.size() + 1);
        // Beside the others, so that both can be seen. Its pose stays assumed: nothing was measured or entered.
        carryTo(projector.camera,
                positionOf(projector.camera) + glm::dvec3(0.5 * static_cast<double>(all.size()), 0, 0));
        lookAt(projector.camera, glm::dvec2(0.0));
        editInstallation(studio_.document, tr("Add a projector"),
                         [&projector](Installation& installation) { installation.projectors.push_back(projector); });
        selection_.choose({SceneChoice::Kind::projector,
                           static_cast<int>(studio_.document.state().installation->projectors.size()) - 1});
    }

    void addChanging() {
        duplicate_ = add("scene.duplicate", tr("Duplicate"), tr("Copy what is chosen"), "duplicate", "Ctrl+Shift+D",
                         false, [this] { duplicate(); });
        remove_ = add("scene.delete", tr("Delete"), tr("Take what is chosen out of the scene"), "trash", "Del", false,
                      [this] { remove(); });
        hide_ = add("scene.hide", tr("Hide"), tr("Hide or show what is chosen"), "eye-off", "Ctrl+H", false,
                    [this] { toggleVisible(); });
    }

    void addShowing() {
        const auto one = [this](const char* id, const QString& text, const QString& hint, const char* keys,
                                Showing showing) {
            QAction* action = add(QString("scene.showing.") + id, text, hint, {}, keys, true, [this, showing, text] {
                editScene(studio_.document, tr("Show %1").arg(text.toLower()),
                          [showing](Scene& scene) { scene.showing = showing; });
                follow();
            });
            showings_->addAction(action);
            showing_.emplace_back(showing, action);
        };
        showings_ = new QActionGroup(this);
        one("physical", tr("Physical"), tr("Servos alone: what the hand feels, in plain light"), "Ctrl+Alt+1",
            Showing::physical);
        one("light", tr("Light"), tr("Light alone: the device stays flat"), "Ctrl+Alt+2", Showing::virtualOnly);
        one("both", tr("Both"), tr("Servos take the coarse shape, light adds all that is fine"), "Ctrl+Alt+3",
            Showing::both);
    }

    void addPlaying() {
        play_ = add("scene.play", {}, {}, {}, "Alt+P", false,
                    [this] { studio_.loop.setScenePlaying(!studio_.loop.scenePlaying()); });
        connect(&studio_.loop, &StudioLoop::scenePlayingChanged, this, [this] { followPlaying(); });
        followPlaying();
    }

    void followPlaying() {
        const bool playing = studio_.loop.scenePlaying();
        play_->setText(playing ? tr("Pause the scene") : tr("Play the scene"));
        play_->setToolTip((playing ? tr("Waves, animations and moving light hold still")
                                   : tr("Waves, animations and moving light go on")) +
                          " (" + play_->shortcut().toString(QKeySequence::NativeText) + ")");
        play_->setIcon(icon(playing ? "pause" : "play"));
    }

    void put(SceneItem item) {
        const SceneItem* chosen = findItem(*studio_.document.state().scene, selection_.item());
        const int group = !chosen ? 0 : std::holds_alternative<GroupItem>(chosen->kind) ? chosen->id : chosen->parent;
        int id = 0;
        const QString what = tr("Add %1").arg(QString::fromStdString(item.name));
        editScene(studio_.document, what, [&](Scene& scene) { id = addItem(scene, item, group); });
        if (findItem(*studio_.document.state().scene, id) != nullptr)
            selection_.chooseItem(id);
        else
            studio_.notices.post("scene", {Notice::Level::warning,
                                           what,
                                           tr("the scene holds as much as it can"),
                                           tr("take something else out first"),
                                           {}});
    }

    void chooseModel() {
        if (QWidget* window = parent_())
            askForFile(studio_, window, tr("Add a model"), modelFilter(),
                       [this](const std::filesystem::path& file) { put(modelItem(file)); });
    }

    void chooseHeights() {
        if (QWidget* window = parent_())
            askForFile(studio_, window, tr("Add a picture of heights"), pictureFilter(),
                       [this](const std::filesystem::path& file) {
                           HeightItem heights;
                           heights.image = file.string();
                           SceneItem item = plain("Heights", heights);
                           item.position.y = kAboveDevice - 0.015F;
                           put(std::move(item));
                       });
    }

    void relink(const QString& asset) {
        QWidget* window = parent_();
        if (!window) return;
        const std::string name = asset.toStdString();
        askForFile(studio_, window, tr("Relink %1").arg(QFileInfo(asset).fileName()), tr("All files (*)"),
                   [this, name](const std::filesystem::path& file) { studio_.project.relink(name, file); });
    }

    [[nodiscard]] const SceneItem* chosen() const {
        return findItem(*studio_.document.state().scene, selection_.item());
    }

    void duplicate() {
        const SceneItem* item = chosen();
        if (!item) return;
        int copy = 0;
        editScene(studio_.document, tr("Duplicate %1").arg(QString::fromStdString(item->name)),
                  [&, id = item->id](Scene& scene) {
                      copy = duplicateItem(scene, id);
                      if (SceneItem* made = itemOf(scene, copy)) made->position += glm::vec3(0.01F, 0.0F, 0.01F);
                  });
        selection_.chooseItem(copy);
    }

    [[nodiscard]] bool projectorChosen() const {
        const SceneChoice& choice = selection_.choice();
        return choice.kind == SceneChoice::Kind::projector &&
               static_cast<std::size_t>(choice.index) < studio_.document.state().installation->projectors.size();
    }

    void removeProjector() {
        const int index = selection_.choice().index;
        selection_.choose({});
        editInstallation(studio_.document, tr("Delete a projector"), [index](Installation& installation) {
            installation.projectors.erase(installation.projectors.begin() + index);
        });
    }

    void remove() {
        if (projectorChosen()) return removeProjector();
        const SceneItem* item = chosen();
        if (!item) return;
        editScene(studio_.document, tr("Delete %1").arg(QString::fromStdString(item->name)),
                  [id = item->id](Scene& scene) { removeItem(scene, id); });
    }

    void toggleVisible() {
        const SceneItem* item = chosen();
        if (!item) return;
        editScene(studio_.document,
                  (item->visible ? tr("Hide %1") : tr("Show %1")).arg(QString::fromStdString(item->name)),
                  [id = item->id](Scene& scene) {
                      SceneItem* found = itemOf(scene, id);
                      found->visible = !found->visible;
                  });
    }

    void follow() {
        const Scene& scene = *studio_.document.state().scene;
        const SceneItem* item = chosen();
        const bool gone = selection_.choice().kind == SceneChoice::Kind::projector && !projectorChosen();
        if (gone || (!item && selection_.item() != 0)) selection_.choose({}); // it was deleted, or undone
        for (QAction* action : {duplicate_, hide_}) action->setEnabled(item != nullptr);
        remove_->setEnabled(item != nullptr || projectorChosen());
        hide_->setText(item && !item->visible ? tr("Show") : tr("Hide"));
        hide_->setIcon(icon(item && !item->visible ? "eye" : "eye-off"));
        for (const auto& [showing, action] : showing_) action->setChecked(scene.showing == showing);
    }

    Studio& studio_;
    SceneSelection& selection_;
    std::function<QWidget*()> parent_;
    QAction *duplicate_ = nullptr, *remove_ = nullptr, *hide_ = nullptr, *play_ = nullptr;
    QActionGroup* showings_ = nullptr;
    std::vector<std::pair<Showing, QAction*>> showing_;
};

} // namespace

void addSceneCommands(Studio& studio, SceneSelection& selection, std::function<QWidget*()> parent) {
    new SceneCommands(studio, selection, std::move(parent));
}

void fillAddMenu(Commands& commands, QMenu& menu) {
    for (const QString& id : kAdded)
        if (id.isEmpty())
            menu.addSeparator();
        else
            menu.addAction(commands.find(id));
}

SceneItem modelItem(const std::filesystem::path& file) {
    SceneItem item;
    item.name = file.stem().string();
    item.position = {0.0F, 0.02F, 0.0F};
    MeshItem mesh;
    mesh.model = std::filesystem::absolute(file).string();
    item.kind = mesh;
    return item;
}

bool applyMaterial(Studio& studio, const SceneChoice& choice, const Material& material) {
    const Scene& now = *studio.document.state().scene;
    const SceneItem* item = choice.kind == SceneChoice::Kind::item ? findItem(now, choice.index) : nullptr;
    const bool takes = choice.kind == SceneChoice::Kind::device || choice.kind == SceneChoice::Kind::table ||
                       (item && hasMaterial(*item));
    if (!takes) return false;
    editScene(studio.document, QObject::tr("Use %1").arg(QString::fromStdString(material.name)), [&](Scene& scene) {
        if (choice.kind == SceneChoice::Kind::device) scene.device.material = material;
        if (choice.kind == SceneChoice::Kind::table) scene.table.material = material;
        SceneItem* found = item ? itemOf(scene, choice.index) : nullptr;
        if (!found) return;
        found->material = material;
        if (auto* mesh = std::get_if<MeshItem>(&found->kind)) mesh->ownMaterials = false;
    });
    return true;
}

} // namespace lumorph::studio
