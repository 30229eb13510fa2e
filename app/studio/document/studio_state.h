#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "core/loop/match_target.h"
#include "core/loop/match_wish.h"
#include "core/mdf/placement.h"
#include "core/motion/pose_book.h"
#include "core/rig/rig.h"
#include "core/scene/installation.h"
#include "core/scene/scene.h"
#include "core/scene/scene_assets.h"

namespace lumorph::studio {

/// What is open, as one plain value: large parts are shared and never change, so a copy is cheap and an undo step is a
/// copy from before.
struct StudioState {
    struct RigAsset {
        std::filesystem::path path; ///< a file, or a folder of one mesh per state; edits leave it
        /// What is shown, matched and moved: compiled of `parts` or, until that is done, of an edit before.
        std::shared_ptr<const Rig> rig;
        std::shared_ptr<const RigParts> parts{}; ///< what the user edits; always there with a rig
        std::shared_ptr<const Rig> origin{};     ///< the rig as it was opened, the same for all its edits
        bool compiled = false; ///< `rig` is of `parts`; false while they are compiled, or where they cannot be
        bool operator==(const RigAsset&) const = default;
    };
    struct FieldAsset {
        std::filesystem::path path; ///< empty while it was built here and not saved
        std::shared_ptr<const MatchField> field;
        std::shared_ptr<const RigParts> builtFor{}; ///< the parts of the rig that it was built for
        bool stale = false;                         ///< it covers another volume than the rig, which was edited since
        bool operator==(const FieldAsset&) const = default;
    };
    struct TargetAsset {
        std::filesystem::path path;
        std::shared_ptr<const MatchTarget> target;
        bool operator==(const TargetAsset&) const = default;
    };
    struct Matching {
        Driver driver = Driver::target; ///< target, sceneItem or hand, which holds `strokes`
        MatchMethod method = MatchMethod::refined;
        Microseconds budget{8'000};
        bool operator==(const Matching&) const = default;
    };
    struct Playback {
        bool playing = true;
        double spin = 0.0; ///< radians a second
        bool operator==(const Playback&) const = default;
    };

    RigAsset rig;
    FieldAsset field; ///< of this rig or an edit of it before, or empty
    TargetAsset target;
    Placement placement;
    std::vector<double> strokes;           ///< set by hand; one an actuator of the rig's parts, each in [0, 1]
    std::shared_ptr<const PoseBook> poses; ///< named, and their sequence; in a document never empty
    Matching matching;
    Playback playback;
    std::shared_ptr<const Scene> scene; ///< in a document never empty
    /// What stands in the room, whatever is open: opening a project leaves it as it is. In a document never empty.
    std::shared_ptr<const Installation> installation;
    /// What the scene names, as far as it has been read; no edit changes it, and undo leaves it as it is.
    std::shared_ptr<const SceneAssets> assets;
};

} // namespace lumorph::studio
