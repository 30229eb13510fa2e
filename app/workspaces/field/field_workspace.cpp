#include "app/workspaces/field/field_workspace.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <utility>

#include <QAction>
#include <QPointer>
#include <QTimer>

#include "app/studio/document/hand_control.h"
#include "app/workspaces/common/field_colors.h"
#include "app/workspaces/common/kept_camera.h"
#include "app/workspaces/field/actuator_dock.h"
#include "app/workspaces/field/field_central_view.h"
#include "app/workspaces/field/field_commands.h"
#include "app/workspaces/field/field_dock.h"
#include "app/workspaces/field/field_exports.h"
#include "app/workspaces/field/field_story_window.h"
#include "app/workspaces/field/fit_certificate.h"
#include "app/workspaces/field/match_dock.h"
#include "app/workspaces/field/pose_commands.h"
#include "app/workspaces/field/pose_desk.h"
#include "app/workspaces/field/pose_dock.h"
#include "app/workspaces/field/target_dock.h"
#include "app/workspaces/field/view_commands.h"

namespace lumorph::studio {

namespace {

/// How long until the scene is made again while part of it is still being prepared.
constexpr int kPendingMilliseconds = 30;
constexpr int kNumbersMilliseconds = 70;

/// Tells when a widget appears or goes.
class Watch : public QObject {
public:
    Watch(QWidget* watched, std::function<void(bool)> shown) : QObject(watched), shown_(std::move(shown)) {
        watched->installEventFilter(this);
    }

protected:
    bool eventFilter(QObject* watched, QEvent* event) override {
        if (event->type() == QEvent::Show || event->type() == QEvent::Hide) shown_(event->type() == QEvent::Show);
        return QObject::eventFilter(watched, event);
    }

private:
    std::function<void(bool)> shown_;
};

/// The first look at a device: from the front, a little from the right and from above.
ViewCamera firstCamera() {
    ViewCamera camera;
    camera.yaw = Angle::degrees(32.0);
    camera.pitch = Angle::degrees(28.0);
    return camera;
}

/// The box of a target as placed, in device coordinates.
Box placedBox(const MatchTarget& target, const glm::mat4& deviceFromTarget) {
    Box box;
    for (int i = 0; i < 8; ++i) {
        const glm::vec3 corner((i & 1) != 0 ? target.box.max.x : target.box.min.x,
                               (i & 2) != 0 ? target.box.max.y : target.box.min.y,
                               (i & 4) != 0 ? target.box.max.z : target.box.min.z);
        box.include(glm::vec3(deviceFromTarget * glm::vec4(corner, 1.0F)));
    }
    return box;
}

/// Where the gizmo's handles meet: the middle of the target's foot.
glm::vec3 footOf(const MatchTarget& target, const glm::mat4& deviceFromTarget) {
    glm::vec3 foot = target.box.centre();
    foot.y = target.box.min.y;
    return glm::vec3(deviceFromTarget * glm::vec4(foot, 1.0F));
}

} // namespace

struct FieldWorkspace::Data : public QObject {
    explicit Data(Studio& shared) : studio(shared) {}

    Studio& studio;
    PoseDesk poses{studio};
    FieldDisplayModel display;
    FieldSceneBuilder builder;
    QPointer<FieldCentralView> stage;
    QPointer<KeptCamera> keptCamera;
    QAction* gizmoShown = nullptr;
    bool seen = false;
    bool targetSelected = false;
    bool unframed = true; ///< another device came: the view has to find it
    QTimer pending;
    Throttle numbers{kNumbersMilliseconds};
    FitCertificate certificate{studio.loop};

    [[nodiscard]] ViewportWidget* view() const { return stage ? stage->viewport() : nullptr; }
    void listen();
    void refresh();
    void frameOnce(const ViewportScene& scene);
    void showGizmo();
    void select(bool target);
    void pick(const ViewportHit& hit);
    [[nodiscard]] bool targetBehind(const ViewportHit& hit) const;
    void useTheme();
    void connectView();
};

void FieldWorkspace::Data::listen() {
    builder.setPatient(false);
    useTheme();
    pending.setSingleShot(true);
    pending.setInterval(kPendingMilliseconds);
    connect(&pending, &QTimer::timeout, this, &Data::refresh);
    connect(&studio.loop, &StudioLoop::framed, this, &Data::refresh);
    connect(&studio.loop, &StudioLoop::framed, &numbers, &Throttle::request);
    connect(&studio.settings, &Settings::themeChanged, this, [this] {
        useTheme();
        refresh();
    });
    connect(&display, &FieldDisplayModel::changed, this, [this] {
        studio.loop.setTint(display.value().showMismatch || display.value().touchedOnly);
        refresh();
    });
    connect(&studio.document, &StudioDocument::changed, this, [this](StateParts parts) {
        if (parts & StatePart::rig) unframed = true;
        if (!studio.document.state().target.target) targetSelected = false;
        refresh();
    });
}

void FieldWorkspace::Data::useTheme() { builder.setColors(fieldSceneColors(studio.settings.theme())); }

void FieldWorkspace::Data::refresh() {
    if (!seen || !stage) return;
    stage->refresh();
    const auto& frame = studio.loop.frame();
    if (!frame) return;
    MatchFrame shown = *frame;
    // A field of other actuators than the rig has since its edit is not matched, but it is what is open.
    if (!shown.field && isOf(shown, studio.document.state())) shown.field = studio.document.state().field.field;
    const auto scene = builder.build(shown, display.value(), targetSelected);
    view()->setScene(scene);
    if (unframed && frame->rig && isOf(*frame, studio.document.state())) frameOnce(*scene);
    showGizmo();
    if (builder.pending()) pending.start();
}

void FieldWorkspace::Data::frameOnce(const ViewportScene& scene) {
    if (view()->width() < 2 || view()->height() < 2) return;
    unframed = false;
    if (const auto kept = keptCamera->begin(QString::fromStdString(studio.document.state().rig.rig->name())))
        return view()->setCamera(*kept);
    const float aspect = static_cast<float>(view()->width()) / static_cast<float>(view()->height());
    view()->setCamera(framed(firstCamera(), scene.bounds, aspect));
}

void FieldWorkspace::Data::showGizmo() {
    const auto& target = studio.document.state().target.target;
    const auto& frame = studio.loop.frame();
    if (!targetSelected || !target || !frame) {
        view()->setGizmo(std::nullopt);
        view()->setSelectionBox({});
        return;
    }
    const Placement& placement = studio.document.state().placement;
    // A target that spins has turned away from where its placement puts it.
    const bool spinning = frame->target == target && frame->turned != Angle();
    const glm::mat4 deviceFromTarget = spinning ? frame->deviceFromTarget : placement.deviceFromTarget();
    view()->setSelectionBox(placedBox(*target, deviceFromTarget));
    if (gizmoShown && !gizmoShown->isChecked()) return view()->setGizmo(std::nullopt);
    view()->setGizmo(Gizmo{placement, footOf(*target, deviceFromTarget)});
}

void FieldWorkspace::Data::select(bool target) {
    targetSelected = target && studio.document.state().target.target != nullptr;
    refresh();
}

/// Whether the target lies under the pointer behind what was hit: device and target run through one another, and only
/// the target can be selected.
bool FieldWorkspace::Data::targetBehind(const ViewportHit& hit) const {
    if (!view() || !view()->scene() || hit.id == 0) return false;
    const ViewCamera& camera = view()->camera();
    const glm::vec3 eye = eyeOf(camera);
    const glm::vec3 along = camera.orthographic ? camera.pivot - eye : hit.point - eye;
    ViewportScene only;
    for (const ViewportSurface& surface : view()->scene()->surfaces)
        if (surface.id == kTargetId) only.surfaces.push_back(surface);
    return lumorph::pick(only, Ray{hit.point, glm::normalize(along)}).has_value();
}

void FieldWorkspace::Data::pick(const ViewportHit& hit) {
    if (hit.id != kFieldId) return select(hit.id == kTargetId || targetBehind(hit));
    const auto& field = studio.document.state().field.field;
    if (!field) return;
    FieldDisplay shown = display.value();
    const VoxelFrame& voxels = field->field.frame;
    const auto at = glm::ivec3(glm::floor((hit.point - voxels.origin) / static_cast<float>(voxels.voxelSize)));
    shown.voxel = hit.voxel ? *hit.voxel : glm::clamp(at, glm::ivec3(0), voxels.dimensions - 1);
    display.set(shown);
}

void FieldWorkspace::Data::connectView() {
    ViewportWidget* shown = view();
    keptCamera = new KeptCamera(studio.settings, "field", shown);
    connect(shown, &ViewportWidget::picked, this, &Data::pick);
    connect(shown, &ViewportWidget::gizmoDragged, this, [this](const Placement& placement) {
        studio.document.preview([placement](StudioState& state) { state.placement = placement; });
    });
    connect(shown, &ViewportWidget::gizmoDropped, this,
            [this](const QString& what) { studio.document.commitPreview(what); });
    connect(shown, &ViewportWidget::gizmoCancelled, this, [this] { studio.document.cancelPreview(); });
}

FieldWorkspace::FieldWorkspace(Studio& studio) : data_(std::make_unique<Data>(studio)) {
    Data& data = *data_;
    addFieldCommands(studio, [&data] { return data.stage ? data.stage->window() : nullptr; });
    addPoseCommands(studio, data.poses);
    data.gizmoShown = addViewCommands(studio.commands, [&data] { return data.view(); });
    connect(data.gizmoShown, &QAction::toggled, &data, &Data::refresh);
    addFieldExports({studio,
                     [&data] {
                         ExportView view;
                         if (!data.view()) return view;
                         view.scene = data.view()->scene();
                         view.camera = data.view()->camera();
                         view.ratio = static_cast<double>(data.view()->width()) / std::max(data.view()->height(), 1);
                         return view;
                     },
                     nullptr});
    addFieldStory(studio, [&data] { return data.stage ? data.stage->window() : nullptr; });
    data.listen();
}

FieldWorkspace::~FieldWorkspace() = default;

QString FieldWorkspace::id() const { return "field"; }
QString FieldWorkspace::title() const { return "Field"; }

QWidget* FieldWorkspace::makeCentralView() {
    data_->stage = new FieldCentralView(data_->studio, data_->numbers);
    data_->connectView();
    bindViewShortcuts(data_->studio.commands, data_->view());
    data_->view()->setActive(data_->seen);
    return data_->stage;
}

std::vector<WorkspaceDock> FieldWorkspace::makeDocks() {
    Studio& studio = data_->studio;
    // The field dock first: it adds the command that the match dock offers.
    QWidget* field = makeFieldDock(studio, data_->display);
    QWidget* target = makeTargetDock(studio);
    new Watch(target, [this](bool shown) {
        if (data_->stage) data_->stage->setTargetNoticesShown(!shown);
    });
    return {{"dock.actuators", "Actuators", "actuator", makeActuatorDock(studio), Qt::LeftDockWidgetArea, false},
            {"dock.field", "Field", "field", field, Qt::LeftDockWidgetArea, true},
            {"dock.target", "Target", "target", target, Qt::RightDockWidgetArea, false},
            {"dock.match", "Match", "live", makeMatchDock(studio, data_->numbers, data_->certificate),
             Qt::RightDockWidgetArea, false},
            {"dock.poses", "Poses", "mark", makePoseDock(studio, data_->poses), Qt::BottomDockWidgetArea, false, true}};
}

bool FieldWorkspace::setForVisitors(bool on) {
    if (!data_->stage) return true;
    if (on) data_->select(false);
    data_->stage->setForVisitors(on);
    return true;
}

void FieldWorkspace::setSeen(bool seen) {
    data_->seen = seen;
    data_->certificate.setActive(seen);
    if (!data_->view()) return;
    data_->view()->setActive(seen);
    data_->refresh();
}

} // namespace lumorph::studio
