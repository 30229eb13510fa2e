#pragma once

#include <filesystem>
#include <memory>

#include "core/loop/match_field.h"

namespace lumorph::studio {

/// Fields that were built here, the last one of each rig, so that the same rig need not wait again. Keeps the few used
/// last. May be used from any thread; a folder that cannot be used is as good as an empty one.
class FieldCache {
public:
    explicit FieldCache(std::filesystem::path folder) : folder_(std::move(folder)) {}

    /// Also the one that is bundled with the tablet. Empty when there is none, or it cannot be read.
    [[nodiscard]] std::shared_ptr<const MatchField> find(const Rig& rig) const;
    void keep(const Field& field) const;

private:
    std::filesystem::path folder_;
};

} // namespace lumorph::studio
