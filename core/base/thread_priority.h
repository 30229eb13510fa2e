#pragma once

namespace lumorph {

/// Lets the calling thread, and every thread that it starts from now on, wait for those that somebody waits for: a
/// long computation shall not make the window stutter on a machine with few cores. It cannot be taken back.
void giveWayToOthers() noexcept;

} // namespace lumorph
