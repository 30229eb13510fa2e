#include "app/workspaces/common/body_axes.h"

#include <cmath>

#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include "core/loop/tracked_room.h"

namespace lumorph::studio {
namespace {

constexpr int kMilliseconds = 33;
constexpr auto kCommand = "view.bodies";
constexpr auto kKey = "view/bodies";

/// In steps that the eye cannot tell apart, so that a body at rest asks for no painting.
float rounded(double value, double step) { return static_cast<float>(std::round(value / step) * step); }

BodyMark markOf(const SeenBody& body, const Installation& installation, const glm::dmat4& deviceFromWorld) {
    BodyMark mark;
    mark.name = QString::fromStdString(body.name);
    const Pose pose = body.role ? inRoom(installation, *body.role, body.pose) : bodyInRoom(installation, body.pose);
    const glm::dvec4 at = deviceFromWorld * glm::dvec4(pose.position, 1.0);
    const glm::dquat turn = glm::quat_cast(glm::dmat3(deviceFromWorld)) * pose.rotation;
    for (int axis = 0; axis < 3; ++axis) mark.position[axis] = rounded(at[axis], 5e-4);
    mark.rotation =
        glm::quat(rounded(turn.w, 2e-3), rounded(turn.x, 2e-3), rounded(turn.y, 2e-3), rounded(turn.z, 2e-3));
    mark.strength = std::round(50.0 * strengthOf(body.age)) / 50.0;
    return mark;
}

} // namespace

void addBodiesCommand(Studio& studio) {
    Commands::Options options;
    options.icon = "eye";
    options.menu = "View";
    options.checkable = true;
    QAction* action = studio.commands.add(kCommand, "Axes of tracked bodies", options, [] {});
    action->setToolTip("Show where trackers see heads, the device and hands, in the 3D views");
    action->setChecked(studio.settings.value(kKey, true).toBool());
    QObject::connect(action, &QAction::toggled, action,
                     [&studio](bool shown) { studio.settings.setValue(kKey, shown); });
}

BodyAxes::BodyAxes(Studio& studio, ViewportWidget* view) : QObject(view), studio_(studio), view_(view) {
    timer_.setInterval(kMilliseconds);
    connect(&timer_, &QTimer::timeout, this, [this] { look(); });
    connect(&studio.trackers, &TrackerService::changed, this, [this] { follow(); });
    connect(&studio.commands, &Commands::added, this, [this](QAction* action) {
        if (action->objectName() == kCommand) connect(action, &QAction::toggled, this, [this] { follow(); });
    });
    if (const QAction* action = studio.commands.find(kCommand))
        connect(action, &QAction::toggled, this, [this] { follow(); });
}

bool BodyAxes::isWanted() const {
    const QAction* shown = studio_.commands.find(kCommand);
    return !studio_.trackers.trackers().empty() && shown != nullptr && shown->isChecked();
}

void BodyAxes::follow() {
    if (!isWanted()) {
        timer_.stop();
        view_->setBodies({});
    } else if (view_->isVisible() && !timer_.isActive()) {
        timer_.start();
    }
}

void BodyAxes::look() {
    if (!view_->isVisible()) return timer_.stop();
    const auto& frame = studio_.loop.frame();
    const glm::dmat4 deviceFromWorld = frame ? glm::inverse(glm::dmat4(frame->worldFromDevice)) : glm::dmat4(1.0);
    const Installation room = frame && frame->installation ? *frame->installation : Installation{};
    std::vector<BodyMark> marks;
    for (const SeenBody& body : studio_.trackers.bodies()) marks.push_back(markOf(body, room, deviceFromWorld));
    view_->setBodies(std::move(marks));
}

} // namespace lumorph::studio
