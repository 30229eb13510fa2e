#pragma once

#include <span>

#include "calibration/lab/lab.h"
#include "core/scene/show_frame.h"

namespace lumorph {

/// The lab of a frame: the device as it is and its table, in the colours of their bare surfaces, and the scene's
/// projectors with what they send out, one picture each (an empty one for a projector that is off). Surface 0 is the
/// device, 1 the table. Throws InvalidInput when pictures and projectors do not agree.
[[nodiscard]] LabWorld labWorld(const ShowFrame& frame, std::span<const Image> pictures);

/// Device (surface 0) and table (1) of a room, in the colours of their bare surfaces, while the device stands at these
/// strokes; without projectors.
[[nodiscard]] LabWorld roomWorld(const Installation& room, const Rig& rig, std::span<const double> strokes);
/// A projector that shows values as light, as patterns need it: a response would bend their phases.
[[nodiscard]] InstalledProjector linearProjector(InstalledProjector projector);

/// The device of a frame, world metres.
[[nodiscard]] TriangleMesh deviceMesh(const ShowFrame& frame);
/// The device of a room at these strokes, world metres.
[[nodiscard]] TriangleMesh deviceMesh(const Installation& room, const Rig& rig, std::span<const double> strokes);
/// A visitor's flat hand around a place, and the forearm behind it, which comes from where the visitor stands; world
/// metres. For LabWorld::blockers.
[[nodiscard]] TriangleMesh visitorHand(const glm::vec3& place, const glm::vec3& visitor);
/// The table as a flat mesh, world metres.
[[nodiscard]] TriangleMesh tableMesh(glm::vec2 size);

} // namespace lumorph
