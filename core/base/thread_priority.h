#pragma once

namespace lumorph {

/// Lets the calling thread, and every thread that it starts from now on, wait for those that somebody waits for: a
/// long computation shall not make the window stutter on a machine with few cores. It cannot be taken back.
void giveWayToOthers() noexcept;

/// Lets the calling thread run as soon as it wakes, before every usual one of the machine (SCHED_RR of Linux); threads
/// that it starts are usual ones. For threads that sleep nearly always, and that something real waits for. False where
/// the system does not grant it (to root, and within RLIMIT_RTPRIO); nothing has changed then.
bool runPromptly() noexcept;

} // namespace lumorph
