#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/base/clock.h"
#include "core/base/words.h"
#include "core/loop/match_field.h"
#include "core/loop/match_target.h"
#include "core/loop/pose_stream.h"
#include "core/motion/pose_sequence.h"
#include "core/scene/driver.h"
#include "core/scene/installation.h"
#include "core/scene/scene.h"
#include "core/scene/scene_assets.h"

namespace lumorph {

class FrameSource;
class ShowInputs;
class ShowProgram;

enum class MatchMethod { voting, refined };

/// What the user wants now; the loop takes the newest one for each frame.
struct MatchWish {
    std::shared_ptr<const Rig> rig; ///< always there
    /// Stays the same object while a rig is edited, so that its actuators go on where they are; may be empty.
    std::shared_ptr<const void> rigOrigin;
    /// Empty until it is built. Of the rig, or of an edit of it with as many actuators.
    std::shared_ptr<const MatchField> field;
    std::shared_ptr<const MatchTarget> target; ///< may be empty
    Placement placement;
    /// Whom the servos follow; `recording` and `program` need `source` and `program`, or the wish is refused.
    Driver driver = Driver::target;
    MatchMethod method = MatchMethod::refined;
    Microseconds budget{8'000};  ///< for refinement, each frame
    std::vector<double> strokes; ///< held, or begun from, as `driver` says; one an actuator
    /// By hand: poses that play in place of `strokes`, by the loop's clock. Empty: none do.
    std::shared_ptr<const PosePlay> posePlay;
    bool playing = true;        ///< the target's animation runs
    std::optional<double> seek; ///< animation time to show while not playing, seconds
    double spin = 0.0;          ///< radians a second that the target turns about +Y
    bool stopped = false;       ///< STOP: estimated strokes hold still until it is taken back; a device lets go
    bool showTint = true;       ///< work out which voxels are unmatched and overfilled

    std::shared_ptr<const Scene> scene;               ///< what light shows, and what of it servos follow; may be empty
    std::shared_ptr<const Installation> installation; ///< where; always there with a scene
    std::shared_ptr<const SceneAssets> assets;
    std::shared_ptr<const PoseBoard> poses; ///< tracked heads and device; without a head the simulated eye
    double lightDelay = 0.0;                ///< measured from a frame to its light, seconds; 0: not yet
    bool scenePlaying = true;               ///< the scene's time runs
    std::optional<double> sceneSeek;        ///< scene time to go to, seconds; heeded once for each new value

    std::shared_ptr<FrameSource> source; ///< of the driver `recording`, instead of frames of the loop's own

    /// Asked once a frame for scene and assets, which then take the place of the wish's own, and for what servos follow
    /// if the driver is `program`; not asked while a recording shows. May be empty.
    std::shared_ptr<ShowProgram> program;
    std::shared_ptr<ShowInputs> inputs;    ///< of that program; the same queue in every wish for it; may be empty
    Language language = Language::english; ///< in which that program writes
};

} // namespace lumorph
