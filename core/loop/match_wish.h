#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/base/clock.h"
#include "core/loop/match_field.h"
#include "core/loop/match_target.h"
#include "core/loop/pose_stream.h"
#include "core/scene/scene.h"
#include "core/scene/scene_assets.h"

namespace lumorph {

class FrameSource;

enum class MatchMethod { voting, refined };

/// What the user wants now; the loop takes the newest one for each frame.
struct MatchWish {
    std::shared_ptr<const Rig> rig;            ///< always there
    std::shared_ptr<const MatchField> field;   ///< empty until it is built; then its rig is the rig
    std::shared_ptr<const MatchTarget> target; ///< may be empty
    Placement placement;
    bool live = true; ///< follow the target; false: hold `strokes`
    MatchMethod method = MatchMethod::refined;
    Microseconds budget{8'000};  ///< for refinement, each frame
    std::vector<double> strokes; ///< held while not live or without a target; one an actuator
    bool playing = true;         ///< the target's animation runs
    std::optional<double> seek;  ///< animation time to show while not playing, seconds
    double spin = 0.0;           ///< radians a second that the target turns about +Y
    bool dancing = false;        ///< random moves, while not live
    bool stopped = false;        ///< STOP: servos stay where they are until it is taken back
    bool showTint = true;        ///< work out which voxels are unmatched and overfilled

    std::shared_ptr<const Scene> scene; ///< what light shows, and what of it servos follow; may be empty
    std::shared_ptr<const SceneAssets> assets;
    std::shared_ptr<const PoseBoard> poses; ///< tracked heads and device; without a head the scene's own eye
    double lightDelay = 0.0;                ///< measured from a frame to its light, seconds; 0: not yet
    bool scenePlaying = true;               ///< the scene's time runs
    std::optional<double> sceneSeek;        ///< scene time to go to, seconds; heeded once for each new value

    std::shared_ptr<FrameSource> source; ///< its frames instead of the loop's own; the actuators stand as they say

    // With a scene: `virtualOnly` holds the servos at rest; else, while `live`, they follow the scene's visible driving
    // item (a TargetItem with the role physical is the target, matched as ever), or without one what they would follow
    // without a scene. View dependence is joined to all of it by the larger stroke.
};

} // namespace lumorph
