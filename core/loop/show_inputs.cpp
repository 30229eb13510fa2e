#include "core/loop/show_inputs.h"

#include <utility>

namespace lumorph {

void ShowInputs::push(ShowInput input) {
    const std::scoped_lock lock(mutex_);
    waiting_.push_back(std::move(input));
}

std::vector<ShowInput> ShowInputs::take() {
    const std::scoped_lock lock(mutex_);
    return std::exchange(waiting_, {});
}

bool ShowInputs::empty() const {
    const std::scoped_lock lock(mutex_);
    return waiting_.empty();
}

} // namespace lumorph
