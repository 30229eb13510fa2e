#pragma once

#include <span>

#include <glm/vec3.hpp>

/// Private to the registrations.
namespace lumorph::registration {

/// Whether points fix a rigid place: throws CaptureRefused, `points_degenerate`, where the two that are farthest apart
/// are nearer than `shortest` metres, and where all lie on one line. `what` is what the refusal is about.
void checkLayout(std::span<const glm::dvec3> places, const char* what, double shortest);

} // namespace lumorph::registration
