#pragma once

#include <functional>

namespace lumorph {

/// Does work whose parallel loops (TBB) take all cores but one, and come after those of usual work: for what may go on
/// for hours beside a window and a loop. On one core it is the calling thread's alone. Throws what `work` throws.
void leavingACore(const std::function<void()>& work);

} // namespace lumorph
