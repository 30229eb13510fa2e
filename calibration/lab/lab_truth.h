#pragma once

#include <glm/mat4x4.hpp>
#include <nlohmann/json.hpp>

#include "core/geometry/calibrated_camera.h"

namespace lumorph {

/// Pieces of the `truth.json` beside a capture of the lab. Rows of the matrix, of its rotation, and its translation by
/// the unit's length; a camera as OpenCV writes it.
[[nodiscard]] nlohmann::json jsonOf(const glm::dmat4& matrix);
[[nodiscard]] nlohmann::json rotationJson(const glm::dmat4& matrix);
[[nodiscard]] nlohmann::json shiftJson(const glm::dmat4& matrix, double metresPerUnit);
[[nodiscard]] nlohmann::json jsonOf(const CalibratedCamera& camera);

} // namespace lumorph
