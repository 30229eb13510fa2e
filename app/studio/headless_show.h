#pragma once

#include <filesystem>
#include <iosfwd>

namespace lumorph::studio {

/// The studio's first minutes without a display: the bundled tablet follows an animated target for `seconds`, by the
/// same loop and in the same scene as in the window. Writes into `folder` (made if needed) pictures of the start, the
/// middle and the end, of what is left unmatched, of the field's voxels and of a level surface, a video and the table
/// bloom.csv; then of the bundled water what eye, projector and lab see, and a video of the lab. Tells on `out` what it
/// does and where things are. Throws InvalidInput for a
/// time outside (0, 600], DeviceError where nothing can be drawn or written.
void runHeadlessShow(const std::filesystem::path& folder, double seconds, std::ostream& out);

} // namespace lumorph::studio
