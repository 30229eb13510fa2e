#include "app/workspaces/scene/item_handles.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <QCoreApplication>
#include <glm/gtc/matrix_access.hpp>
#include <glm/matrix.hpp>

#include "app/studio/document/scene_edit.h"
#include "app/studio/look/palette.h"
#include "app/studio/viewport/view_marks.h"
#include "core/scene/posed_scene.h"

namespace lumorph::studio {
namespace {

glm::vec2 toVec(const QPointF& at) { return {static_cast<float>(at.x()), static_cast<float>(at.y())}; }

/// What has a place that a hand may take.
bool canBeMoved(const SceneItem& item) {
    const auto* light = std::get_if<LightItem>(&item.kind);
    return light == nullptr || light->kind == LightItem::Kind::lamp;
}

QString verbOf(GizmoHandle handle) {
    if (handle == GizmoHandle::turn) return QCoreApplication::translate("ItemHandles", "Turn %1");
    if (handle == GizmoHandle::size) return QCoreApplication::translate("ItemHandles", "Scale %1");
    return QCoreApplication::translate("ItemHandles", "Move %1");
}

} // namespace

HandleView handleView(const CalibratedCamera& camera) {
    HandleView view;
    const glm::dvec3 eye = positionOf(camera);
    const glm::dvec3 forward(glm::row(camera.cameraFromWorld, 2));
    view.camera.distance = 1.0;
    view.camera.pivot = glm::vec3(eye + forward);
    view.camera.yaw = Angle::radians(std::atan2(-forward.x, -forward.z));
    view.camera.pitch = Angle::radians(std::asin(std::clamp(-forward.y, -1.0, 1.0)));
    // Pixel centres lie at whole numbers there, at halves here.
    const glm::dvec2 middle = camera.principal + 0.5;
    const glm::dvec2 half = glm::max(glm::abs(middle), glm::abs(glm::dvec2(camera.size) - middle));
    view.camera.fieldOfView = Angle::radians(2.0 * std::atan(half.y / camera.focal.y));
    view.size = glm::vec2(2.0 * half);
    view.offset = glm::vec2(half - middle);
    return view;
}

glm::mat4 worldFromParent(const Scene& scene, const SceneItem& item, double seconds, const glm::mat4& worldFromDevice) {
    const glm::mat4 anchor = item.anchor == Anchor::device ? worldFromDevice : glm::mat4(1.0F);
    const SceneItem* group = findItem(scene, item.parent);
    return group == nullptr ? anchor : anchor * anchorFromItem(scene, *group, seconds);
}

SceneItem draggedItem(SceneItem item, const glm::mat4& worldFromParent, const Placement& from, const Placement& to) {
    const glm::mat3 parentFromWorld = glm::inverse(glm::mat3(worldFromParent));
    item.position += parentFromWorld * (to.translation - from.translation);
    const auto turn = static_cast<float>(to.yaw.inRadians() - from.yaw.inRadians());
    if (turn != 0.0F) {
        const glm::vec3 up = glm::normalize(parentFromWorld * glm::vec3(0.0F, 1.0F, 0.0F));
        item.rotation = glm::normalize(glm::angleAxis(turn, up) * item.rotation);
    }
    item.scale *= static_cast<float>(to.scale / from.scale);
    return item;
}

ItemHandles::ItemHandles(StudioDocument& document, CameraOf cameraOf)
    : document_(document), cameraOf_(std::move(cameraOf)) {}

void ItemHandles::setItem(int item) {
    if (item == item_) return;
    if (grip_) cancel();
    item_ = item;
    hot_.reset();
}

const SceneItem* ItemHandles::item() const {
    const SceneItem* found = item_ == 0 ? nullptr : findItem(*document_.state().scene, item_);
    return found != nullptr && canBeMoved(*found) ? found : nullptr;
}

std::optional<Gizmo> ItemHandles::gizmo() const {
    const SceneItem* held = item();
    if (held == nullptr) return std::nullopt;
    const glm::mat4 parent =
        worldFromParent(*document_.state().scene, *held, seconds_, document_.state().installation->worldFromDevice);
    const glm::vec3 origin(parent * glm::vec4(held->position, 1.0F));
    return Gizmo{{1.0, {}, origin}, origin};
}

std::optional<HandleView> ItemHandles::viewOf(const QSize& size) const {
    const auto camera = cameraOf_(size);
    return camera ? std::optional(handleView(*camera)) : std::nullopt;
}

void ItemHandles::paint(QPainter& painter, const QSize& size) {
    const auto shown = gizmo();
    const auto view = shown ? viewOf(size) : std::nullopt;
    if (!view) return;
    painter.save();
    painter.setRenderHint(QPainter::Antialiasing);
    const QColor accent = currentPalette().accent;
    const glm::vec3 hot(accent.redF(), accent.greenF(), accent.blueF());
    const auto handle = grip_ ? std::optional(grip_->handle) : hot_;
    for (const ViewportLine& line : gizmoLines(*shown, view->camera, view->size, 1.0, handle, hot)) {
        const auto a = pixelOf(view->camera, line.from, view->size);
        const auto b = pixelOf(view->camera, line.to, view->size);
        if (!a || !b) continue;
        const glm::vec3 color = 255.0F * line.color;
        painter.setPen(QPen(QColor(static_cast<int>(color.r), static_cast<int>(color.g), static_cast<int>(color.b)),
                            static_cast<double>(line.width), Qt::SolidLine, Qt::RoundCap));
        const glm::vec2 from = *a - view->offset, to = *b - view->offset;
        painter.drawLine(QPointF(from.x, from.y), QPointF(to.x, to.y));
    }
    painter.restore();
    if (grip_ && !grip_->label.isEmpty()) paintChip(painter, size, grip_->pointer, grip_->label, currentPalette());
}

bool ItemHandles::hover(const QPointF& at, const QSize& size) {
    const auto shown = gizmo();
    const auto view = shown ? viewOf(size) : std::nullopt;
    const auto handle = view ? gizmoAt(*shown, view->camera, toVec(at) + view->offset, view->size, 1.0) : std::nullopt;
    return std::exchange(hot_, handle) != handle;
}

bool ItemHandles::press(const QPointF& at, const QSize& size, Qt::KeyboardModifiers /*modifiers*/) {
    hover(at, size);
    const auto shown = gizmo();
    const auto view = viewOf(size);
    if (!hot_ || !shown || !view) return false;
    grip_ = Grip{
        *hot_,
        *shown,
        *item(),
        worldFromParent(*document_.state().scene, *item(), seconds_, document_.state().installation->worldFromDevice),
        toVec(at) + view->offset,
        at,
        {}};
    return true;
}

void ItemHandles::drag(const QPointF& to, const QSize& size, Qt::KeyboardModifiers modifiers) {
    const auto view = viewOf(size);
    if (!grip_ || !view) return;
    const GizmoDrag now = dragGizmo(grip_->start, grip_->handle, view->camera, grip_->from, toVec(to) + view->offset,
                                    view->size, modifiers.testFlag(Qt::ControlModifier));
    grip_->pointer = to;
    grip_->label = QString::fromStdString(now.label);
    const SceneItem moved = draggedItem(grip_->item, grip_->worldFromParent, grip_->start.placement, now.placement);
    previewScene(document_, [this, &moved](Scene& scene) {
        if (SceneItem* held = itemOf(scene, item_)) *held = moved;
    });
}

void ItemHandles::release() {
    if (!grip_) return;
    const Grip ended = *std::exchange(grip_, std::nullopt);
    const QString name = QString::fromStdString(ended.item.name);
    if (document_.previewing()) document_.commitPreview(verbOf(ended.handle).arg(name));
}

void ItemHandles::cancel() {
    grip_.reset();
    if (document_.previewing()) document_.cancelPreview();
}

} // namespace lumorph::studio
