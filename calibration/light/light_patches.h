#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>
#include <opencv2/core.hpp>

#include "calibration/decode/refusal.h"
#include "calibration/lab/lab.h"
#include "core/rig/rig.h"
#include "core/scene/installation.h"

namespace lumorph {

/// What light is measured on.
enum class LightSurface { device, table, sheet };
inline constexpr std::size_t kLightSurfaces = 3;

/// A sheet of white paper on the table: its corners, world metres, in turn.
using WhiteSheet = std::array<glm::vec3, 4>;

/// Where a sheet of 12 cm lies flat on the table, seen by the camera, in the light of as many projectors as can be and
/// clear of the device; empty where there is no room for it.
[[nodiscard]] std::optional<WhiteSheet> placeForSheet(const Installation& room, const Rig& rig,
                                                      const CalibratedCamera& camera);

/// What is to be known where there is none.
[[nodiscard]] Finding noRoomForSheet();

/// The camera of a room with pictures of at most so many columns: flat light needs no more.
[[nodiscard]] CalibratedCamera lightCamera(const CalibratedCamera& camera, int width = 320);

/// Device at rest (surface 0), table (1) and sheet (2) in a room, with its projectors, which show black.
[[nodiscard]] LabWorld lightWorld(const Installation& room, const Rig& rig, const std::optional<WhiteSheet>& sheet);

/// Pixels of a camera whose mean is taken: one surface, lit evenly.
struct LightPatch {
    LightSurface surface = LightSurface::device;
    cv::Rect pixels;
    std::vector<double> shares; ///< one a projector: light of its full white on a white surface; 0: not lit
    double radius = 0.0;        ///< from the picture's middle, 1 in its corners
};

/// All patches that some projector lights, where an installation has device, table and sheet; the camera's picture may
/// be small, 320 pixels across are enough. A projector that is off lights none.
[[nodiscard]] std::vector<LightPatch> lightPatches(const Installation& room, const Rig& rig,
                                                   const CalibratedCamera& camera,
                                                   const std::optional<WhiteSheet>& sheet);

/// Mean bytes of each patch of an 8-bit picture: red, green and blue, or of a grey one three times the same; 255 where
/// one pixel in fifty is cut off.
[[nodiscard]] std::vector<glm::dvec3> patchBytes(std::span<const LightPatch> patches, const cv::Mat& picture);

} // namespace lumorph
