#pragma once

#include <functional>
#include <memory>
#include <optional>

#include <QImage>
#include <QRect>
#include <gtest/gtest.h>

#include "app/studio/rendering/render_thread.h"
#include "app/studio/viewport/viewport_widget.h"

namespace lumorph::studio {

/// A scene of one cube standing free in the air, no grid; `color` sRGB.
[[nodiscard]] std::shared_ptr<ViewportScene> cubeScene(const glm::vec3& centre, float side, const glm::vec3& color,
                                                       std::uint32_t id = 7);
/// A sphere of so many triangles, at least.
[[nodiscard]] std::shared_ptr<ViewportScene> sphereScene(int triangles, float radius);

/// The rectangle around all pixels that are clearly red; empty when there are none.
[[nodiscard]] QRect redPart(const QImage& image);
/// The same for the cube's corners as the camera sees them, by `pixelOf`.
[[nodiscard]] QRectF cubePart(const ViewCamera& camera, const glm::vec3& centre, float side, glm::vec2 size);

/// Runs the event loop until it is so; false after `milliseconds`.
[[nodiscard]] bool waitFor(const std::function<bool()>& isSo, int milliseconds = 20000);

} // namespace lumorph::studio
