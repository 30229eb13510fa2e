#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/geometry/model.h"
#include "core/mdf/placement.h"

namespace lumorph {

/// A target as the loop uses it: one mesh, or a model with an animation. Immutable; shared between threads.
struct MatchTarget {
    std::string name;
    Target solid;                       ///< the mesh at time 0, looked over and repaired
    std::shared_ptr<const Model> model; ///< empty for a plain mesh
    int animation = -1;                 ///< of the model; -1: it stands still
    double duration = 0.0;              ///< seconds; 0 when it stands still
    Box box;                            ///< over the whole animation, in the target's own frame
    std::vector<std::string> warnings;  ///< plain sentences
};

/// Reads a mesh or a glTF of any supported kind. A glTF with animations plays the one asked for (default: the first).
/// Throws DataError naming file, place and remedy, and for a mesh without volume or beyond the limits; Cancelled.
[[nodiscard]] std::shared_ptr<const MatchTarget> readMatchTarget(const std::filesystem::path& file,
                                                                 std::optional<int> animation = std::nullopt,
                                                                 const Progress& progress = {});

/// A time in [0, duration] at which a target repeated without end looks as it does at `seconds`.
[[nodiscard]] double animationTime(const MatchTarget& target, double seconds);

/// The target's mesh at a time of its animation (repeated without end), in its own frame. The triangles are the same at
/// every time.
[[nodiscard]] TriangleMesh meshAt(const MatchTarget& target, double seconds);

} // namespace lumorph
