#pragma once

#include <cstdint>
#include <functional>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/clock.h"
#include "core/base/units.h"
#include "core/geometry/capsule.h"
#include "core/loop/match_field.h"
#include "core/loop/match_target.h"
#include "core/loop/show_caption.h"
#include "core/loop/show_inputs.h"
#include "core/loop/show_sound.h"
#include "core/mdf/placement.h"
#include "core/scene/driver.h"
#include "core/scene/installation.h"
#include "core/scene/scene.h"
#include "core/scene/scene_assets.h"

namespace lumorph {

class PoseBoard;
class ShowProgram;

/// Milliseconds of each stage of one frame.
struct MatchTimes {
    double pose = 0.0, voxelize = 0.0, match = 0.0, refine = 0.0, motion = 0.0, deform = 0.0, total = 0.0;
    double program = 0.0; ///< the show program's answer
    double track = 0.0;   ///< poses and viewer
    double rule = 0.0;    ///< view dependence, and the servos' part of a scene's item
    // Not parts of `total`:
    double poseAge = 0.0; ///< of the oldest pose used when the frame began; 0 without a tracker
    double latency =
        0.0; ///< from that pose being measured to the light for which it was predicted; 0 without a tracker
};

/// Classes of MatchFrame::classes.
inline constexpr std::uint8_t kVoxelMatched = 1, kVoxelUnmatched = 2, kVoxelOverfilled = 3;

/// How well the device takes the shape of a scene item that servos follow; numbers as those of a target below.
struct ItemFit {
    int item = 0;                  ///< its id in the scene
    double iouWanted = 0.0;        ///< of what is covered at the wanted strokes
    double iouEstimated = 0.0;     ///< of what is covered now
    double volume = 0.0;           ///< cubic metres of it in the frame, between the surface at rest and its top
    double shareBeyondFrame = 0.0; ///< of all that lies above the surface at rest, over twice the frame's extent
    double shareUnreachable = 0.0;
};

/// What one frame found, as a value that never changes again.
struct MatchFrame {
    std::uint64_t number = 0;
    Microseconds time{0};
    bool recorded = false; ///< shown again from a recording
    std::shared_ptr<const Rig> rig;
    std::shared_ptr<const void> rigOrigin; ///< of the wish
    std::shared_ptr<const MatchField> field;
    std::shared_ptr<const MatchTarget> target;
    Driver driver = Driver::hand; ///< of the wish
    /// A target's voxels were compared with the device in this frame: those of `target`, which servos follow if it is
    /// the driver, or those of `program`. Never while the scene's item drives.
    bool matched = false;
    std::optional<ItemFit> itemFit;    ///< with a field, while the scene's item drives
    std::optional<double> poseSeconds; ///< how far the poses have come that play; empty: none do
    double seconds = 0.0;              ///< of the target's animation
    bool relief = false;               ///< it is matched as a relief
    Angle turned;                      ///< by spinning, on top of the placement's yaw
    glm::mat4 deviceFromTarget{1.0F};
    std::shared_ptr<const std::vector<glm::vec3>>
        targetPositions; ///< target's own frame; the same object while it stands still
    std::shared_ptr<const std::vector<glm::vec3>> devicePositions; ///< at the estimated state, device metres

    State wanted;                         ///< levels asked for (of the field; empty without one)
    std::vector<double> wantedStrokes;    ///< what the actuators are asked for, one each
    std::vector<double> estimatedStrokes; ///< where they really are under their velocity limits
    /// What their servos are told for that: the same, but for servos whose curve was measured. Empty in a frame that
    /// was recorded.
    std::vector<double> commandedStrokes;
    std::shared_ptr<const Votes> votes; ///< error curves; only when matched
    double iouVoting = 0.0;             ///< of V(s) by voting alone
    double iouWanted = 0.0;             ///< of V(wanted)
    double iouEstimated = 0.0;          ///< of the volume really covered now
    int statesSeen = 0;                 ///< joint states that refinement looked at
    double unmatchedVolume = 0.0;       ///< cubic metres of the target that V(wanted) leaves out
    double overfilledVolume = 0.0;      ///< cubic metres of V(wanted) outside the target
    double targetVolume = 0.0;          ///< cubic metres of the target in the frame, outside the body
    double shareBeyondFrame = 0.0;      ///< of the target's volume
    double shareUnreachable = 0.0;      ///< of the target's voxels that no actuator changes
    std::shared_ptr<const std::vector<std::uint8_t>> classes; ///< one a voxel, x fastest; empty unless asked for

    std::shared_ptr<const Scene> scene;               ///< of the wish
    std::shared_ptr<const Installation> installation; ///< of the wish
    std::shared_ptr<const SceneAssets> assets;
    double sceneSeconds = 0.0;
    glm::mat4 worldFromDevice{1.0F};        ///< predicted for the moment at which the frame is seen
    std::optional<glm::vec3> eye;           ///< of the viewer who is followed, predicted likewise; world metres
    std::vector<Capsule> hands;             ///< that are tracked, with their arms, predicted likewise; world metres
    std::shared_ptr<const PoseBoard> poses; ///< they are from; empty: nothing is tracked
    Microseconds lightTime{0};              ///< the moment for which they are predicted
    std::string viewer;                     ///< his name; empty for the scene's own eye
    bool handingOver = false;               ///< the eye glides from one viewer to the next
    std::vector<double> viewStrokes;        ///< what view dependence asks for; empty while it is off or servos rest
    std::vector<double> unbentStrokes;      ///< `wantedStrokes` without it; empty likewise
    std::vector<double> splitStrokes;       ///< what the frequency split asks for; empty where servos follow none

    std::shared_ptr<const ShowProgram> program; ///< that was asked in this frame; empty: none
    double programSeconds = 0.0;                ///< its time, ShowMoment::seconds
    std::vector<ShowInput> inputs;              ///< that it was given in this frame: a recording of them can replay it
    std::vector<ShowSound> sounds;              ///< that it lets be heard
    std::shared_ptr<const ShowCaption> caption; ///< that it lets be read; empty: nothing
    std::function<std::string()> keepsake;      ///< that it wants kept: ShowContent::keepsake
    /// Why the wish's program is asked no more, and that the show goes on without it; in every frame from its end on.
    std::string programError;
    bool comparesBend = false; ///< it wants the device seen without and with view dependence, see BendComparison

    MatchTimes ms;
};

} // namespace lumorph
