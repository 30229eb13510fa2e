#include "app/workspaces/rig/influence_brush.h"

#include <algorithm>
#include <utility>

#include <QCoreApplication>
#include <glm/geometric.hpp>

#include "app/studio/document/rig_edit.h"
#include "app/studio/look/palette.h"
#include "app/studio/viewport/gizmo_shape.h"
#include "app/studio/viewport/view_marks.h"
#include "app/workspaces/rig/influence_map.h"
#include "core/render/viewport/viewport_renderer.h"

namespace lumorph::studio {

namespace {

using Tool = InfluenceTools::Tool;

QString brushText(const char* words) { return QCoreApplication::translate("InfluenceBrush", words); }

QString hintOf(Tool tool, const QString& name) {
    switch (tool) {
    case Tool::erase:
        return brushText("Draw over what is to follow %1 less").arg(name);
    case Tool::smooth:
        return brushText("Draw where the influence of %1 is to change more gently").arg(name);
    case Tool::distance:
        return brushText("Click the place around which the device is to follow %1").arg(name);
    default:
        return brushText("Draw over what is to follow %1").arg(name);
    }
}

QString stepOf(Tool tool) {
    switch (tool) {
    case Tool::erase:
        return brushText("Erase the influence of %1");
    case Tool::smooth:
        return brushText("Smooth the influence of %1");
    default:
        return brushText("Paint the influence of %1");
    }
}

} // namespace

InfluenceBrush::InfluenceBrush(StudioDocument& document, InfluenceTools& tools, View view,
                               std::function<void()> changed)
    : document_(document), tools_(tools), view_(std::move(view)), changed_(std::move(changed)) {}

void InfluenceBrush::follow(std::optional<std::size_t> actuator) {
    const auto& parts = document_.state().rig.parts;
    if (stroke_ && actuator == actuator_) return; // the stroke leads
    if (stroke_) cancel();
    if (actuator == actuator_ && parts == of_) return;
    actuator_ = parts && actuator && *actuator < parts->actuators.size() ? actuator : std::nullopt;
    of_ = parts;
    weights_ = actuator_ ? actuatorWeights(*parts, *actuator_) : std::vector<float>();
    if (!actuator_) spot_.reset();
}

std::optional<InfluenceBrush::Spot> InfluenceBrush::spotAt(const QPointF& at, const QSize& size) const {
    const auto scene = view_.scene();
    const auto& parts = document_.state().rig.parts;
    if (!scene || !parts || !actuator_) return std::nullopt;
    const glm::vec2 pixels(static_cast<float>(size.width()), static_cast<float>(size.height()));
    const ViewCamera camera = view_.camera();
    const auto hit = pick(*scene, rayThrough(camera, {at.x(), at.y()}, pixels));
    if (!hit || !hit->corners) return std::nullopt;
    const auto& [corners, shares] = *hit->corners;
    const auto& rest = parts->restMesh.positions;
    if (std::max({corners.x, corners.y, corners.z}) >= rest.size()) return std::nullopt;
    const glm::vec3 a = rest[corners.x], b = rest[corners.y], c = rest[corners.z];
    const glm::vec3 across = glm::cross(b - a, c - a);
    if (!(glm::length(across) > 0.0F)) return std::nullopt;
    const auto radius =
        static_cast<float>(tools_.tool() == Tool::distance ? tools_.falloff().full : tools_.brush().radius);
    return Spot{at, radius / metresPerPixel(camera, hit->point, pixels), shares.x * a + shares.y * b + shares.z * c,
                glm::normalize(across)};
}

void InfluenceBrush::paint(QPainter& painter, const QSize& size) {
    const auto& parts = document_.state().rig.parts;
    if (!actuator_ || !parts || *actuator_ >= parts->actuators.size()) return;
    const Palette& colors = currentPalette();
    paintNotice(painter, size, hintOf(tools_.tool(), QString::fromStdString(parts->actuators[*actuator_].name)),
                colors);
    paintHeatLegend(painter, size, {brushText("Follows"), brushText("100 %")});
    if (!spot_) return;
    painter.save();
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setBrush(Qt::NoBrush);
    for (const auto& [color, width] : {std::pair(colors.window, 4.0), std::pair(colors.text, 1.5)}) {
        painter.setPen(QPen(color, width));
        painter.drawEllipse(spot_->pixel, spot_->pixels, spot_->pixels);
    }
    if (tools_.tool() == Tool::distance) {
        const double outer = spot_->pixels * (1.0 + tools_.falloff().range / std::max(tools_.falloff().full, 1e-6));
        painter.setPen(QPen(colors.text, 1.5, Qt::DashLine));
        painter.drawEllipse(spot_->pixel, outer, outer);
    }
    painter.restore();
}

bool InfluenceBrush::press(const QPointF& at, const QSize& size, Qt::KeyboardModifiers /*modifiers*/) {
    spot_ = spotAt(at, size);
    if (!spot_ || document_.previewing()) return false;
    picking_ = tools_.tool() == Tool::distance;
    if (picking_) return true;
    base_ = document_.state().rig.parts;
    stroke_.emplace(*base_, *actuator_);
    move();
    return true;
}

void InfluenceBrush::drag(const QPointF& to, const QSize& size, Qt::KeyboardModifiers /*modifiers*/) {
    spot_ = spotAt(to, size);
    if (spot_ && stroke_) move();
}

void InfluenceBrush::move() {
    stroke_->moveTo(spot_->place, spot_->normal, tools_.brush());
    previewRig(document_, [this](RigParts& parts) {
        if (*actuator_ >= parts.actuators.size()) return;
        parts.actuators[*actuator_] = base_->actuators[*actuator_];
        parts.skeleton = base_->skeleton;
        setActuatorWeights(parts, *actuator_, stroke_->weights());
    });
    changed_();
}

void InfluenceBrush::release() {
    if (std::exchange(picking_, false)) {
        if (spot_) tools_.pick(spot_->place);
        return;
    }
    if (!stroke_) return;
    weights_ = stroke_->weights();
    stroke_.reset();
    const auto& parts = document_.state().rig.parts;
    if (document_.previewing() && parts && *actuator_ < parts->actuators.size())
        document_.commitPreview(stepOf(tools_.tool()).arg(QString::fromStdString(parts->actuators[*actuator_].name)));
    follow(actuator_);
    changed_();
}

void InfluenceBrush::cancel() {
    picking_ = false;
    if (!stroke_) return;
    stroke_.reset();
    if (document_.previewing()) document_.cancelPreview();
    changed_();
}

bool InfluenceBrush::hover(const QPointF& at, const QSize& size) {
    if (stroke_) return false;
    const bool before = spot_.has_value();
    spot_ = spotAt(at, size);
    return before || spot_;
}

} // namespace lumorph::studio
