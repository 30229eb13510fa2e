#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace lumorph {

/// The middle of some values by size; of an even count the greater of the two in the middle, so that it is always one
/// that was there. Zero for none. Values that are no numbers have no place in an order and may not be among them.
template <typename Value> [[nodiscard]] Value median(std::vector<Value> values) {
    if (values.empty()) return Value{};
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

} // namespace lumorph
