#include "core/base/thread_priority.h"

#include <sys/resource.h>

namespace lumorph {

namespace {

/// Of Linux' 0 (usual) to 19: a quarter of the processor's time where somebody else wants the rest.
constexpr int kNiceness = 5;

} // namespace

// On Linux each thread has a niceness of its own, and 0 is the calling one (sched(7)).
void giveWayToOthers() noexcept { ::setpriority(PRIO_PROCESS, 0, kNiceness); }

} // namespace lumorph
