#include "core/base/thread_priority.h"

#include <sched.h>
#include <sys/resource.h>

namespace lumorph {

namespace {

/// Of Linux' 0 (usual) to 19: a quarter of the processor's time where somebody else wants the rest.
constexpr int kNiceness = 5;

constexpr int kPromptness = 5; // of 1 to 99; the sound of a desktop has more

} // namespace

// On Linux each thread has a niceness of its own, and 0 is the calling one (sched(7)).
void giveWayToOthers() noexcept { ::setpriority(PRIO_PROCESS, 0, kNiceness); }

bool runPromptly() noexcept {
    sched_param parameters{};
    parameters.sched_priority = kPromptness;
    return ::sched_setscheduler(0, SCHED_RR | SCHED_RESET_ON_FORK, &parameters) == 0;
}

} // namespace lumorph
