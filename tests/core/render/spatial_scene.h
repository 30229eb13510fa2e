#pragma once

#include <utility>

#include "tests/support/show_frames.h"

// A projector over the table, boxes that float, and a scene posed at a time.

namespace lumorph {

inline InstalledProjector overhead() { return projectorAt({-0.15, 1.5, -0.2}, {0.0, 0.0, 0.0}, {480, 320}, 1500.0); }

inline SceneItem box(const glm::vec3& position, Anchor anchor, const glm::vec3& color, float size = 0.04F) {
    SceneItem item;
    item.id = 1;
    item.name = "Box";
    item.position = position;
    item.anchor = anchor;
    item.kind = ShapeItem{.form = ShapeItem::Form::box, .size = glm::vec3(size)};
    item.material = unlit(color);
    return item;
}

inline ShowFrame posedBy(ScenePoser& poser, ShowFrame frame, double seconds) {
    PoseInput input;
    input.seconds = seconds;
    input.worldFromDevice = frame.worldFromDevice;
    frame.posed = poser.pose(*frame.scene, *frame.assets, input);
    return frame;
}

inline ShowFrame posed(ShowFrame frame) {
    ScenePoser poser;
    return posedBy(poser, std::move(frame), 0.0);
}

} // namespace lumorph
