#include "calibration/stages/simulated_question.h"

#include <algorithm>

namespace lumorph {

bool SimulatedQuestion::asks(const Installation& room) {
    const std::vector<std::string> parts = realParts(room);
    const auto isAnswered = [this](const std::string& part) {
        return std::ranges::find(answered_, part) != answered_.end();
    };
    if (!asked_.empty() && asked_ == parts) answered_.insert(answered_.end(), parts.begin(), parts.end());
    if (std::ranges::all_of(parts, isAnswered)) {
        asked_.clear();
        return false;
    }
    asked_ = parts;
    return true;
}

} // namespace lumorph
