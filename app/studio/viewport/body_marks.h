#pragma once

#include <vector>

#include <QPainter>
#include <QSize>
#include <QString>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "app/studio/look/palette.h"
#include "core/render/viewport/view_camera.h"

namespace lumorph::studio {

/// A tracked body in a view: its axes and its name.
struct BodyMark {
    QString name;
    glm::vec3 position{0.0F}; ///< metres, in the frame of the view's scene
    glm::quat rotation{1.0F, 0.0F, 0.0F, 0.0F};
    double strength = 1.0; ///< fades to 0.25 where it was not seen for a while
    bool operator==(const BodyMark&) const = default;
};

/// How strongly a body is drawn that was seen so many seconds ago: wholly for a quarter of a second, then less and less
/// for two seconds.
[[nodiscard]] double strengthOf(double secondsAgo);

/// Paints axes in red, green and blue over a view, each where its body is, 6 cm long or 26 pixels, whichever is more. A
/// body outside the view is a small arrow at the edge that points to it.
void paintBodies(QPainter& painter, const QSize& view, const ViewCamera& camera, const std::vector<BodyMark>& bodies,
                 const Palette& palette);

} // namespace lumorph::studio
