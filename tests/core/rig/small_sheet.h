#pragma once

#include "core/rig/rig.h"
#include "tests/support/small_rigs.h"

namespace lumorph::test {

/// A box whose top follows a sheet of two levers and two modes, each corner of it a row.
inline RigParts smallSheetParts() {
    RigParts parts;
    parts.name = "small";
    parts.restMesh = boxMesh({0, 0, 0}, {0.1F, 0.02F, 0.1F});
    SheetMotion& sheet = parts.sheet.emplace();
    sheet.modes.strokes = {{0.0F, 0.4F, 1.0F}, {0.0F, 1.0F}};
    sheet.modes.modeCount = 2;
    sheet.modes.coefficients = {0.0F, 0.0F, 0.1F, 0.9F, 0.5F, 0.1F, 0.6F, 1.1F, 1.0F, 0.0F, 0.7F, 0.8F};
    for (const glm::vec3& p : parts.restMesh.positions) {
        const bool top = p.y > 0.01F;
        const auto row = static_cast<std::uint32_t>(sheet.modes.rowCount());
        sheet.followers.push_back({top ? row : SheetMotion::kNoRow, 1.0F});
        if (!top) continue;
        sheet.modes.modes.emplace_back(-0.1F * p.x, 0.01F + 0.3F * p.z, 0.001F);
        sheet.modes.modes.emplace_back(0.002F, 0.02F - 0.1F * p.x, -0.03F * p.z);
    }
    for (int axis = 0; axis < 2; ++axis) {
        Actuator actuator;
        actuator.name = "lever " + std::to_string(axis);
        actuator.deformer = SheetLift{1 - axis, Angle::degrees(7.3), Angle::degrees(55.0 + axis)};
        parts.actuators.push_back(std::move(actuator));
    }
    return parts;
}

} // namespace lumorph::test
