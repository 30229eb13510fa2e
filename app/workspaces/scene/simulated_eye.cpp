#include "app/workspaces/scene/simulated_eye.h"

#include <utility>

#include "app/studio/document/scene_edit.h"
#include "app/workspaces/scene/eye_orbit.h"

namespace lumorph::studio {
namespace {

constexpr int kWheelMilliseconds = 400;

} // namespace

SimulatedEye::SimulatedEye(StudioDocument& document, QObject* parent) : QObject(parent), document_(document) {
    settled_.setSingleShot(true);
    settled_.setInterval(kWheelMilliseconds);
    connect(&settled_, &QTimer::timeout, this, [this] { end(true); });
}

glm::vec3 SimulatedEye::eye() const { return document_.state().installation->eye; }

glm::vec3 SimulatedEye::centre() const {
    const StudioState& state = document_.state();
    const glm::vec3 middle = state.rig.rig ? state.rig.rig->reach().centre() : glm::vec3(0.0F);
    return glm::vec3(state.installation->worldFromDevice * glm::vec4(middle, 1.0F));
}

void SimulatedEye::set(const glm::vec3& eye) {
    moving_ = true;
    previewInstallation(document_, [&eye](Installation& installation) { installation.eye = eye; });
}

void SimulatedEye::drag(const QPointF& by, const QSize& view) {
    settled_.stop();
    const glm::vec2 pixels(static_cast<float>(by.x()), static_cast<float>(by.y()));
    set(orbitedEye(eye(), centre(), pixels, {view.width(), view.height()}));
}

void SimulatedEye::zoom(double notches) {
    set(nearerEye(eye(), centre(), notches));
    settled_.start();
}

void SimulatedEye::end(bool taken) {
    settled_.stop();
    if (!std::exchange(moving_, false)) return;
    if (taken)
        document_.commitPreview(tr("Move the viewer"));
    else
        document_.cancelPreview();
}

} // namespace lumorph::studio
