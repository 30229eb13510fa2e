#include "app/workspaces/rig/rig_workspace.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include <QApplication>
#include <QElapsedTimer>
#include <QFileDialog>
#include <QPointer>

#include "app/studio/document/rig_edit.h"
#include "app/studio/viewport/viewport_widget.h"
#include "app/studio/widgets/bundled_shelf.h"
#include "app/workspaces/common/export_dialogs.h"
#include "app/workspaces/common/field_colors.h"
#include "app/workspaces/common/kept_camera.h"
#include "app/workspaces/rig/actuator_handles.h"
#include "app/workspaces/rig/copies_dialog.h"
#include "app/workspaces/rig/draw_sheet.h"
#include "app/workspaces/rig/influence_brush.h"
#include "app/workspaces/rig/influence_map.h"
#include "app/workspaces/rig/moved_part.h"
#include "app/workspaces/rig/new_device.h"
#include "app/workspaces/rig/parts_dialog.h"
#include "app/workspaces/rig/rig_docks.h"
#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/rig/actuator_copies.h"
#include "core/rig/rig_file.h"

namespace lumorph::studio {

namespace {

constexpr int kSettleMilliseconds = 200;
constexpr int kWiggleMilliseconds = 33;
constexpr qint64 kRehearseMilliseconds = 500; ///< to get from one shape to another, so that one sees what moves
constexpr float kShownAround = 0.35F; ///< of the device's longest side, to each side of a place that is looked at
constexpr float kMarkSize = 0.025F;

ViewCamera firstCamera() {
    ViewCamera camera;
    camera.yaw = Angle::degrees(32.0);
    camera.pitch = Angle::degrees(28.0);
    return camera;
}

/// An octahedron around a place, which nothing hides.
void addMark(const glm::vec3& place, float size, const glm::vec3& color, std::vector<ViewportLine>& lines) {
    const glm::vec3 axes[] = {{size, 0, 0}, {0, size, 0}, {0, 0, size}};
    for (int k = 0; k < 3; ++k)
        for (const float side : {-1.0F, 1.0F})
            for (const float other : {-1.0F, 1.0F})
                lines.push_back({place + side * axes[k], place + other * axes[(k + 1) % 3], color, 2.5F, true});
}

} // namespace

struct RigWorkspace::Data : public QObject {
    explicit Data(Studio& shared)
        : studio(shared), handles(shared.document, selection, [this] { return view->camera(); }),
          linePreview(shared.document),
          brush(shared.document, tools, {[this] { return view->camera(); }, [this] { return view->scene(); }},
                [this] { painted(); }) {}
    ~Data() override {
        if (view) view->setOverlay(nullptr);
    }

    void listen();
    void addCommands();
    void openRig();
    void saveRig();
    [[nodiscard]] std::vector<Findable> thingsToFind();
    [[nodiscard]] QWidget* window() const { return view ? view->window() : QApplication::activeWindow(); }
    void refresh();
    void select();
    void edited();
    void markPart();
    void wiggle();
    void toggleWiggle();
    void mirror();
    void copies();
    [[nodiscard]] bool painting() const { return tools.editing() && selection.actuator().has_value(); }
    void painted();
    void setPainting();
    void mapInfluence();
    void rehearse(bool glides);
    void listenToView();
    void followHandles();
    void moveLineBy(const Placement& placement);
    /// Looks from where the place lies, seen from the middle of the device, so that nothing but itself is in the way.
    void turnTo(const glm::vec3& place);
    void frameOnce(const ViewportScene& scene);
    /// The frame as shown: the loop's, or what is rehearsed, with the selected actuator wiggling on top.
    [[nodiscard]] MatchFrame shownFrame(const MatchFrame& frame);

    Studio& studio;
    RigSelection selection;
    FieldSceneBuilder builder;
    QPointer<ViewportWidget> view;
    QPointer<KeptCamera> keptCamera;
    std::optional<MovedPart> part;
    std::shared_ptr<const Rig> partOf;
    QAction* wiggleCommand = nullptr;
    QAction* partsCommand = nullptr;
    QAction* drawCommand = nullptr; ///< there is something to take up again only for a rig that was drawn
    QElapsedTimer wiggling;
    ActuatorHandles handles;
    ActuatorPreview linePreview;
    InfluenceTools tools;
    InfluenceBrush brush;
    std::optional<glm::vec3> lineFrom; ///< the pivot when the arrows began to carry it
    QAction* backCommand = nullptr;
    QAction* mirrorCommand = nullptr;
    QAction* influenceCommand = nullptr;
    QAction* copiesCommand = nullptr;
    QAction* paintCommand = nullptr;
    std::shared_ptr<const std::vector<glm::u8vec4>> colors; ///< of the device, while it shows an influence
    bool borderStale = false;                               ///< a drag has changed which vertices are moved
    std::vector<double> rehearsedFrom; ///< strokes that were shown when another state was asked for
    std::vector<double> shownStrokes;
    std::shared_ptr<const std::vector<glm::vec3>> tried; ///< positions of `triedOf` at `triedStrokes`
    std::shared_ptr<const Rig> triedOf;
    std::vector<double> triedStrokes;
    QElapsedTimer rehearsing; ///< valid while the view is on its way
    QTimer tick;
    bool seen = false;
    bool unframed = true;
    QSize framedSize;
    QElapsedTimer sinceSized;
};

void RigWorkspace::Data::listen() {
    builder.setPatient(false);
    builder.setColors(fieldSceneColors(studio.settings.theme()));
    tick.setInterval(kWiggleMilliseconds);
    connect(&tick, &QTimer::timeout, this, &Data::refresh);
    connect(&studio.loop, &StudioLoop::framed, this, &Data::refresh);
    connect(&selection, &RigSelection::changed, this, &Data::select);
    connect(&selection, &RigSelection::wiggleWanted, this, &Data::wiggle);
    connect(&selection, &RigSelection::rehearsalChanged, this, &Data::rehearse);
    connect(&selection, &RigSelection::coloursChanged, this, &Data::refresh);
    connect(&tools, &InfluenceTools::changed, this, &Data::setPainting);
    connect(&studio.settings, &Settings::themeChanged, this, [this] {
        builder.setColors(fieldSceneColors(studio.settings.theme()));
        refresh();
    });
    connect(&studio.document, &StudioDocument::changed, this, [this](StateParts parts) {
        const auto& now = studio.document.state().rig.parts;
        drawCommand->setEnabled(now && !now->drawing.empty());
        partsCommand->setEnabled(studio.document.state().rig.rig != nullptr);
        if (parts & StatePart::rigEdited) {
            edited();
            followHandles();
        }
        if (!(parts & StatePart::rig)) return;
        unframed = true;
        selection.rehearse({}, false);
        selection.select(std::nullopt);
    });
}

void RigWorkspace::Data::addCommands() {
    Commands::Options options;
    options.icon = "open";
    options.menu = "File";
    studio.commands.add("rig.open", "Open rig...", options, [this] { openRig(); });
    options.icon = "plus";
    studio.commands.add("rig.new", "New device...", options, [this] {
        emit studio.commands.workspaceWanted("rig");
        openNewDevice(studio, window());
    });
    options.icon = "bend-line";
    drawCommand = studio.commands.add("rig.draw", "Edit the drawing...", options, [this] {
        emit studio.commands.workspaceWanted("rig");
        openDrawingOfRig(studio, window());
    });
    drawCommand->setToolTip("Take up again the drawing that this device was made of");
    drawCommand->setEnabled(false);
    options.icon = "build";
    partsCommand = studio.commands.add("export.parts", "Export parts to build...", options, [this] {
        emit studio.commands.workspaceWanted("rig");
        openPartsDialog(studio, window());
    });
    partsCommand->setToolTip("What is to be printed, bought and wired to build this device, with the board's sketch");
    partsCommand->setEnabled(false);
    options.icon = "save";
    options.workspace = "rig";
    studio.commands.add("rig.save", "Save the rig as...", options, [this] { saveRig(); });
    options.menu = "Actuators";
    options.icon = "actuator";
    options.workspace = "rig";
    options.shortcut = QKeySequence("Ctrl+Shift+W");
    wiggleCommand = studio.commands.add("rig.wiggle", "Show what it moves", options, [this] { toggleWiggle(); });
    wiggleCommand->setToolTip(
        "Move the chosen actuator in this view alone; the device stays where it is. Again: end it");
    wiggleCommand->setEnabled(false);
    options.icon = "reset";
    options.shortcut = {};
    backCommand = studio.commands.add("rig.back", "Show it as it stands", options, [this] { selection.rehearse({}); });
    backCommand->setToolTip("End what is rehearsed in this view");
    backCommand->setEnabled(false);
    options.icon = "mirror";
    mirrorCommand = studio.commands.add("rig.mirror", "Mirror to the other side", options, [this] { mirror(); });
    mirrorCommand->setToolTip("The chosen actuator once more across the middle of the device; one that stands there "
                              "already takes over how it moves");
    mirrorCommand->setEnabled(false);
    options.icon = "duplicate";
    copiesCommand = studio.commands.add("rig.copies", "Copy around or along...", options, [this] { copies(); });
    copiesCommand->setToolTip("The chosen actuator several times, around the middle of the device or along a line");
    copiesCommand->setEnabled(false);
    options.icon = "heights";
    options.checkable = true;
    influenceCommand = studio.commands.add("rig.influence", "Show how far each place goes", options, [this] {
        mapInfluence();
        refresh();
    });
    influenceCommand->setToolTip("Colours what the chosen actuator moves: the farther a place goes at full stroke, the "
                                 "lighter");
    options.icon = "drop";
    paintCommand = studio.commands.add("rig.paint", "Edit the influence in the view", options,
                                       [this] { tools.setEditing(paintCommand->isChecked()); });
    paintCommand->setToolTip("Draw on the device what follows the chosen actuator, and how much");
    paintCommand->setEnabled(false);
}

void RigWorkspace::Data::saveRig() {
    const StudioState::RigAsset& asset = studio.document.state().rig;
    if (!asset.rig || !asset.compiled) return;
    askFile(window(), studio.settings, "rig.save", "Save the rig", QString::fromStdString(asset.rig->name()),
            {{"glTF, as Lumorph and Blender read it", "glb"}}, [this, rig = asset.rig](const QString& file) {
                try {
                    writeFileAtomically(std::filesystem::path(file.toStdU16String()), writeRigGlb(*rig));
                } catch (const std::exception& error) {
                    studio.notices.post("rig", noticeOf(error));
                }
            });
}

void RigWorkspace::Data::openRig() {
    QWidget* parent = window();
    if (auto* open = parent ? parent->findChild<QFileDialog*>("dialog.rig") : nullptr) return open->raise();
    auto* dialog = new QFileDialog(parent, "Open rig", studio.settings.value(kRigFolder).toString());
    dialog->setObjectName("dialog.rig");
    dialog->setOption(QFileDialog::DontUseNativeDialog);
    dialog->setAttribute(Qt::WA_DeleteOnClose);
    dialog->setFileMode(QFileDialog::ExistingFile);
    dialog->setNameFilters({"Rigs (*.glb *.gltf)", "All files (*)"});
    connect(dialog, &QFileDialog::fileSelected, this, [this](const QString& file) {
        studio.settings.setValue(kRigFolder, QFileInfo(file).absolutePath());
        studio.project.openRig(std::filesystem::path(file.toStdU16String()));
    });
    addBundledShelf(*dialog, "Rigs that come with Lumorph", bundledRigs(),
                    [this](const std::filesystem::path& file) { studio.project.openRig(file); });
    dialog->open();
}

/// Rigs that come with the program, and the actuators of the one that is open.
std::vector<Findable> RigWorkspace::Data::thingsToFind() {
    std::vector<Findable> found;
    for (const BundledFile& one : bundledRigs())
        found.push_back({one.title, "Rig", "rig", "rig", [this, file = one.file] { studio.project.openRig(file); }});
    const auto& rig = studio.document.state().rig.rig;
    for (std::size_t i = 0; rig && i < rig->actuatorCount(); ++i)
        found.push_back({QString::fromStdString(rig->actuators()[i].name), "Actuator", "actuator", "rig",
                         [this, i] { selection.select(i); }});
    return found;
}

void RigWorkspace::Data::select() {
    part.reset();
    wiggling.invalidate();
    markPart();
    followHandles();
    wiggle();
    wiggleCommand->setEnabled(part.has_value());
    for (QAction* command : {mirrorCommand, copiesCommand, paintCommand}) command->setEnabled(part.has_value());
    setPainting();
    refresh();
}

void RigWorkspace::Data::markPart() {
    const auto& rig = studio.document.state().rig.rig;
    const auto chosen = selection.actuator();
    part.reset();
    partOf = rig;
    borderStale = false;
    if (rig && chosen && *chosen < rig->actuatorCount()) part.emplace(*rig, *chosen);
}

/// The same rig with other numbers: what is chosen, and where one looks from, stay.
void RigWorkspace::Data::edited() {
    const auto& rig = studio.document.state().rig.rig;
    const auto chosen = selection.actuator();
    brush.follow(chosen);
    if (!chosen || (rig == partOf && (studio.document.previewing() || !studio.document.state().rig.compiled))) return;
    if (*chosen >= rig->actuatorCount()) return selection.select(std::nullopt);
    // Finding the border takes longer than a frame of a drag, and most edits leave it where it is.
    borderStale = borderStale || !part || *chosen >= partOf->actuatorCount() || partOf->restMesh() != rig->restMesh() ||
                  !std::ranges::equal(partOf->verticesOf(*chosen), rig->verticesOf(*chosen));
    partOf = rig;
    // In a drag the colours and the border stay those of before it.
    if (studio.document.previewing()) return refresh();
    if (borderStale) markPart();
    mapInfluence();
    refresh();
}

void RigWorkspace::Data::wiggle() {
    if (!part) return;
    wiggling.start();
    tick.start();
}

/// While it wiggles, that ends.
void RigWorkspace::Data::toggleWiggle() {
    const bool wiggles = wiggling.isValid() && wiggleStroke(1e-3 * static_cast<double>(wiggling.elapsed())) >= 0.0;
    if (!wiggles) return wiggle();
    wiggling.invalidate();
    refresh();
}

void RigWorkspace::Data::mirror() {
    const auto parts = studio.document.state().rig.parts;
    const auto chosen = selection.actuator();
    if (!parts || !chosen || *chosen >= parts->actuators.size()) return;
    try {
        const MirroredActuator mirrored = mirroredActuator(*parts, *chosen, mirrorPlaneOf(*parts, *chosen));
        const QString name = QString::fromStdString(parts->actuators[*chosen].name);
        editRig(studio.document, QString("Mirror %1").arg(name),
                [&mirrored](RigParts& now) { now.actuators = mirrored.parts.actuators; });
    } catch (const Error& error) {
        studio.notices.post("rig", noticeOf(error));
    }
}

void RigWorkspace::Data::copies() {
    if (const auto chosen = selection.actuator()) openCopiesDialog(studio, *chosen, window());
}

/// The brush has other weights to show.
void RigWorkspace::Data::painted() {
    mapInfluence();
    refresh();
}

/// Takes up the brush, or the handles again.
void RigWorkspace::Data::setPainting() {
    if (paintCommand->isChecked() != tools.editing()) paintCommand->setChecked(tools.editing());
    brush.follow(selection.actuator());
    if (view) view->setOverlay(painting() ? static_cast<PaneOverlay*>(&brush) : &handles);
    followHandles();
    mapInfluence();
    refresh();
}

void RigWorkspace::Data::mapInfluence() {
    const auto& rig = studio.document.state().rig.rig;
    const auto chosen = selection.actuator();
    colors.reset();
    handles.setLegend(std::nullopt);
    if (painting()) {
        colors = heatColors(brush.weights(), 1.0F);
    } else if (influenceCommand->isChecked() && rig && chosen && *chosen < rig->actuatorCount()) {
        const std::vector<float> ways = waysOf(*rig, *chosen);
        const float most = ways.empty() ? 0.0F : std::ranges::max(ways);
        colors = heatColors(ways, most);
        handles.setLegend(HeatLegend{"Goes at full stroke", lengthText(static_cast<double>(most))});
    }
}

void RigWorkspace::Data::rehearse(bool glides) {
    rehearsedFrom = shownStrokes;
    backCommand->setEnabled(!selection.rehearsed().empty());
    wiggling.invalidate();
    if (glides) {
        rehearsing.start();
        tick.start();
    } else {
        rehearsing.invalidate();
    }
    if (const auto& place = selection.inspectedPlace()) turnTo(*place);
    refresh();
}

void RigWorkspace::Data::listenToView() {
    view->setOverlay(&handles);
    connect(view, &ViewportWidget::gizmoDragged, this, &Data::moveLineBy);
    connect(view, &ViewportWidget::gizmoDropped, this, [this] {
        const auto& parts = studio.document.state().rig.parts;
        const auto chosen = selection.actuator();
        lineFrom.reset();
        if (studio.document.previewing() && parts && chosen && *chosen < parts->actuators.size())
            studio.document.commitPreview(
                QString("Move the axis of %1").arg(QString::fromStdString(parts->actuators[*chosen].name)));
        followHandles();
    });
    connect(view, &ViewportWidget::gizmoCancelled, this, [this] {
        lineFrom.reset();
        studio.document.cancelPreview();
        followHandles();
    });
}

void RigWorkspace::Data::moveLineBy(const Placement& placement) {
    const auto& guide = handles.guide();
    const auto chosen = selection.actuator();
    if (!guide || !chosen) return;
    if (!lineFrom) lineFrom = guide->pivot;
    const glm::vec3 by = placement.translation - *lineFrom;
    linePreview.show(*chosen, [&by](Actuator& actuator) { moveLine(actuator, by); });
}

/// The arrows that make sense for a line: along it nothing changes.
Gizmo lineGizmo(const ActuatorGuide& guide) {
    constexpr float kAligned = 0.999F;
    Gizmo gizmo{{1.0, {}, guide.pivot}, guide.pivot, 0};
    const auto offer = [&](GizmoHandle handle) {
        gizmo.handles = static_cast<std::uint8_t>(gizmo.handles | 1U << static_cast<unsigned>(handle));
    };
    if (std::abs(guide.axis.x) < kAligned) offer(GizmoHandle::moveX);
    if (std::abs(guide.axis.y) < kAligned) offer(GizmoHandle::moveY);
    if (std::abs(guide.axis.z) < kAligned) offer(GizmoHandle::moveZ);
    return gizmo;
}

void RigWorkspace::Data::followHandles() {
    if (!view) return;
    const auto& rig = studio.document.state().rig.rig;
    const auto chosen = selection.actuator();
    const bool there = rig && chosen && *chosen < rig->actuatorCount();
    handles.follow(there ? chosen : std::nullopt, there ? rig->verticesOf(*chosen) : std::span<const std::uint32_t>());
    const auto& guide = handles.guide();
    if (!lineFrom)
        view->setGizmo(guide && guide->hasLine && !painting() ? std::optional(lineGizmo(*guide)) : std::nullopt);
    view->update();
}

void RigWorkspace::Data::turnTo(const glm::vec3& place) {
    const auto& rig = studio.document.state().rig.rig;
    if (!view || !rig) return;
    unframed = false; // now the place says where one looks
    const Box& reach = rig->reach();
    const glm::vec3 size = reach.size();
    const float side = std::max({size.x, size.y, size.z});
    const glm::vec3 out = place - reach.centre();
    ViewCamera camera = view->camera();
    if (std::hypot(out.x, out.z) > 0.1F * side)
        camera.yaw = Angle::radians(static_cast<double>(std::atan2(out.x, out.z)));
    camera.pitch = firstCamera().pitch;
    const glm::vec3 around(kShownAround * side);
    const float aspect = static_cast<float>(view->width()) / static_cast<float>(std::max(1, view->height()));
    view->setCamera(framed(camera, {place - around, place + around}, aspect), true);
}

MatchFrame RigWorkspace::Data::shownFrame(const MatchFrame& frame) {
    MatchFrame shown = frame;
    std::vector<double>& strokes = shown.estimatedStrokes;
    const auto chosen = selection.actuator();
    const double stroke =
        part && wiggling.isValid() ? wiggleStroke(1e-3 * static_cast<double>(wiggling.elapsed())) : -1.0;
    const bool wiggles = stroke >= 0.0 && chosen && *chosen < strokes.size();
    const bool rehearses = selection.rehearsed().size() == strokes.size() && !strokes.empty();
    if (rehearses) strokes = selection.rehearsed();
    const bool onItsWay =
        rehearsing.isValid() && rehearsing.elapsed() < kRehearseMilliseconds && rehearsedFrom.size() == strokes.size();
    if (onItsWay) {
        const double done = static_cast<double>(rehearsing.elapsed()) / static_cast<double>(kRehearseMilliseconds);
        const double eased = done * done * (3.0 - 2.0 * done);
        for (std::size_t i = 0; i < strokes.size(); ++i) strokes[i] = std::lerp(rehearsedFrom[i], strokes[i], eased);
    } else {
        rehearsing.invalidate();
    }
    shownStrokes = strokes;
    if (!wiggles && !onItsWay) tick.stop();
    if (!wiggles && !onItsWay && !rehearses) return shown;
    if (wiggles) strokes[*chosen] = stroke;
    // A device that stands still is drawn anew by nobody.
    if (!tried || triedOf != shown.rig || triedStrokes != strokes) {
        std::vector<glm::vec3> positions(shown.rig->restMesh().positions.size());
        shown.rig->deform(strokes, positions);
        tried = std::make_shared<const std::vector<glm::vec3>>(std::move(positions));
        triedOf = shown.rig;
        triedStrokes = strokes;
    }
    shown.devicePositions = tried;
    return shown;
}

void RigWorkspace::Data::refresh() {
    if (!seen || !view) return;
    const auto& frame = studio.loop.frame();
    // A frame of the rig before would be marked with the parts of this one.
    if (!frame || frame->rigOrigin != studio.document.state().rig.origin) return;
    FieldDisplay display;
    display.showTarget = false;
    display.showMismatch = false;
    const MatchFrame shown = shownFrame(*frame);
    handles.setStrokes(shown.estimatedStrokes, frame->estimatedStrokes);
    auto scene = std::make_shared<ViewportScene>(*builder.build(shown, display, false));
    if (part && shown.devicePositions && !painting()) {
        const auto lines = part->lines(*shown.devicePositions, scene->accent);
        scene->lines.insert(scene->lines.end(), lines.begin(), lines.end());
    }
    if (const auto& colours = selection.colours(); colours && shown.devicePositions)
        for (ViewportSurface& band : colours->bands.surfaces(shown.devicePositions, colours->colors))
            scene->surfaces.push_back(std::move(band));
    if (colors)
        for (ViewportSurface& surface : scene->surfaces)
            if (surface.id == kDeviceId) surface.vertexColors = colors;
    if (const auto& place = selection.inspectedPlace()) {
        const glm::vec3 size = shown.rig->reach().size();
        addMark(*place, kMarkSize * std::max({size.x, size.y, size.z}), sceneColor(currentPalette().danger),
                scene->lines);
    }
    if (unframed) frameOnce(*scene);
    view->setScene(std::move(scene));
    if (builder.pending()) QTimer::singleShot(kWiggleMilliseconds, this, &Data::refresh);
}

void RigWorkspace::Data::frameOnce(const ViewportScene& scene) {
    if (view->width() < 2 || view->height() < 2) return;
    if (const auto kept = keptCamera->begin(QString::fromStdString(studio.document.state().rig.rig->name()))) {
        unframed = false;
        return view->setCamera(*kept);
    }
    // Until the docks beside it have their widths, the view has not its own.
    if (std::exchange(framedSize, view->size()) != view->size() || !sinceSized.isValid()) sinceSized.start();
    unframed = sinceSized.elapsed() < kSettleMilliseconds;
    if (unframed) QTimer::singleShot(kSettleMilliseconds, this, &Data::refresh);
    const float aspect = static_cast<float>(view->width()) / static_cast<float>(view->height());
    view->setCamera(framed(firstCamera(), scene.bounds, aspect));
}

RigWorkspace::RigWorkspace(Studio& studio) : data_(std::make_unique<Data>(studio)) {
    data_->addCommands();
    data_->listen();
    studio.commands.addFinder([data = data_.get()] { return data->thingsToFind(); });
}

RigWorkspace::~RigWorkspace() = default;

QString RigWorkspace::id() const { return "rig"; }
QString RigWorkspace::title() const { return "Rig"; }

QWidget* RigWorkspace::makeCentralView() {
    data_->view = new ViewportWidget(data_->studio.renderer);
    data_->view->setObjectName("rig.viewport");
    data_->view->setAccessibleName("Device");
    data_->keptCamera = new KeptCamera(data_->studio.settings, "rig", data_->view);
    data_->view->setActive(data_->seen);
    data_->listenToView();
    return data_->view;
}

std::vector<WorkspaceDock> RigWorkspace::makeDocks() {
    Studio& studio = data_->studio;
    return {
        {"dock.rig.actuators", "Actuators", "actuator", makeRigActuators(studio, data_->selection),
         Qt::LeftDockWidgetArea, false},
        {"dock.rig.influence", "Influence", "drop", makeRigInfluence(studio, data_->selection, data_->tools),
         Qt::LeftDockWidgetArea, true},
        {"dock.rig.fit", "What it can be", "target", makeRigFit(studio, data_->selection), Qt::RightDockWidgetArea,
         false},
        {"dock.rig.report", "Report", "check", makeRigReport(studio, data_->selection), Qt::RightDockWidgetArea, true},
        {"dock.rig.suggest", "Suggest", "search", makeRigSuggest(studio), Qt::RightDockWidgetArea, true},
        {"dock.rig.light", "Light", "projector", makeRigLight(studio, data_->selection), Qt::RightDockWidgetArea,
         true}};
}

void RigWorkspace::setSeen(bool seen) {
    data_->seen = seen;
    if (!data_->view) return;
    data_->view->setActive(seen);
    data_->refresh();
}

} // namespace lumorph::studio
