#include "core/loop/dance.h"

#include <algorithm>
#include <cmath>

namespace lumorph {

const std::vector<double>& Dance::step(std::span<const double> from, double seconds) {
    if (wish_.size() != from.size()) {
        wish_.assign(from.begin(), from.end());
        untilNext_ = 0.0;
        change();
        return wish_;
    }
    untilNext_ -= seconds;
    if (untilNext_ <= 0.0) change(); // one wish a frame: after a long pause the past is not made up for
    return wish_;
}

double Dance::between(double low, double high) {
    return low + (high - low) * std::ldexp(static_cast<double>(random_() >> 11U), -53);
}

void Dance::change() {
    untilNext_ = std::max(0.0, untilNext_) + between(0.6, 1.4);
    if (wish_.empty()) return;
    const double share = between(0.2, 0.7);
    const auto sure = static_cast<std::size_t>(random_() % wish_.size());
    for (std::size_t i = 0; i < wish_.size(); ++i)
        if (i == sure || between(0.0, 1.0) < share) wish_[i] = between(0.0, 1.0);
}

} // namespace lumorph
