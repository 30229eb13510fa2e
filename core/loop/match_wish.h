#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/base/clock.h"
#include "core/loop/match_field.h"
#include "core/loop/match_target.h"
#include "core/loop/pose_stream.h"
#include "core/scene/installation.h"
#include "core/scene/scene.h"
#include "core/scene/scene_assets.h"

namespace lumorph {

class FrameSource;
class ShowInputs;
class ShowProgram;

/// Who moves the servos. View dependence joins in by the larger stroke, whoever it is, and a scene that shows light
/// alone (Showing::virtualOnly) holds them at rest; a recording knows neither.
enum class Driver {
    target,    ///< `target` is matched by `field`; without one of them `strokes` are held
    sceneItem, ///< heights of the scene's visible driving item, or of its slow part where its role is split; without
               ///< such an item, or where it stands for a target that is not there, `strokes` are held
    hand,      ///< `strokes` are held
    dance,     ///< random moves that begin at `strokes`
    recording, ///< frames of `source` are shown, with servos as they say; without a source the wish is refused
    program,   ///< what `program` asks of them; where it asks nothing, has ended, or wants to be matched without a
               ///< field, `strokes` are held; without a program the wish is refused
};

/// Who moves the servos for those who know only whether they shall follow something (`live`): a visible driving item of
/// the scene that does not stand for a physical target, else the target; and the hand while they follow nothing.
[[nodiscard]] Driver driverOf(bool live, const Scene* scene);

enum class MatchMethod { voting, refined };

/// What the user wants now; the loop takes the newest one for each frame.
struct MatchWish {
    std::shared_ptr<const Rig> rig;            ///< always there
    std::shared_ptr<const MatchField> field;   ///< empty until it is built; then its rig is the rig
    std::shared_ptr<const MatchTarget> target; ///< may be empty
    Placement placement;
    Driver driver = Driver::target;
    MatchMethod method = MatchMethod::refined;
    Microseconds budget{8'000};  ///< for refinement, each frame
    std::vector<double> strokes; ///< held, or begun from, as `driver` says; one an actuator
    bool playing = true;         ///< the target's animation runs
    std::optional<double> seek;  ///< animation time to show while not playing, seconds
    double spin = 0.0;           ///< radians a second that the target turns about +Y
    bool stopped = false;        ///< STOP: servos stay where they are until it is taken back
    bool showTint = true;        ///< work out which voxels are unmatched and overfilled

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
    std::shared_ptr<ShowInputs> inputs; ///< of that program; the same queue in every wish for it; may be empty
};

} // namespace lumorph
