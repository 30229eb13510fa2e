#include "core/base/spare_core.h"

#include <algorithm>

#include <tbb/info.h>
#include <tbb/task_arena.h>

namespace lumorph {

void leavingACore(const std::function<void()>& work) {
    tbb::task_arena arena(std::max(1, tbb::info::default_concurrency() - 1), 1, tbb::task_arena::priority::low);
    arena.execute(work);
}

} // namespace lumorph
