#include <algorithm>

#include "core/loop/pose_stream.h"

namespace lumorph {

std::shared_ptr<PoseStream> PoseBoard::stream(const std::string& name, PoseRole role) {
    const std::scoped_lock lock(mutex_);
    const auto found = std::ranges::find(entries_, name, &Entry::name);
    if (found != entries_.end()) {
        found->role = role;
        return found->stream;
    }
    entries_.push_back({name, role, std::make_shared<PoseStream>()});
    return entries_.back().stream;
}

void PoseBoard::remove(const std::string& name) {
    const std::scoped_lock lock(mutex_);
    std::erase_if(entries_, [&](const Entry& entry) { return entry.name == name; });
}

std::vector<PoseBoard::Entry> PoseBoard::entries() const {
    const std::scoped_lock lock(mutex_);
    return entries_;
}

} // namespace lumorph
