#pragma once

#include <filesystem>

#include "core/rig/parts/build_plan.h"
#include "devices/controllers/device_profile.h"

namespace lumorph {

/// Sets a profile up as a building plan wires the rig's servos: pins, limits and directions. Everything else stays.
void wireAs(const BuildPlan& plan, DeviceProfile& profile);

/// A profile for the rig, wired as its building plan says.
[[nodiscard]] DeviceProfile profileOf(const Rig& rig, const BuildPlan& plan);

/// Adds profile.json and the sketch's folder, where the plan has servos and one board drives them all.
/// Throws DataError where the sketch is missing, DeviceError where the disk refuses.
void addBoardFiles(const Rig& rig, const BuildPlan& plan, const std::filesystem::path& folder);

} // namespace lumorph
