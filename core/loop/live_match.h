#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/clock.h"
#include "core/base/units.h"
#include "core/loop/match_target.h"
#include "core/loop/pose_stream.h"
#include "core/mdf/coverage.h"
#include "core/mdf/field.h"
#include "core/mdf/refine.h"
#include "core/mdf/voting.h"
#include "core/motion/motion.h"
#include "core/rig/rig.h"
#include "core/scene/scene.h"
#include "core/scene/scene_assets.h"

namespace lumorph {

/// A field and all that matching needs of it. Immutable; shared between threads.
struct MatchField {
    explicit MatchField(Field built); ///< reads the rig out of the field; throws DataError when it is not there
    Field field;
    Rig rig;
    Coverage coverage;
    Voting voting;
};

enum class MatchMethod { voting, refined };

struct MatchFrame;
struct MatchWish;

/// Frames that were made elsewhere, such as those of a recording. One thread at a time asks for them.
class FrameSource {
public:
    virtual ~FrameSource() = default;
    /// The frame to be seen at `now`, by the loop's clock, of the wish's rig; the same object while it is the same.
    [[nodiscard]] virtual std::shared_ptr<const MatchFrame> frame(const MatchWish& wish, Microseconds now) = 0;
    /// Whether it will be another one later.
    [[nodiscard]] virtual bool moves() const = 0;
};

/// What the user wants now; the loop takes the newest one for each frame.
struct MatchWish {
    std::shared_ptr<const Rig> rig; ///< always there
    /// Stays the same object while a rig is edited, so that its actuators go on where they are; may be empty.
    std::shared_ptr<const void> rigOrigin;
    /// Empty until it is built. Of the rig, or of an edit of it with as many actuators.
    std::shared_ptr<const MatchField> field;
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

/// Milliseconds of each stage of one frame.
struct MatchTimes {
    double pose = 0.0, voxelize = 0.0, match = 0.0, refine = 0.0, motion = 0.0, deform = 0.0, total = 0.0;
    double track = 0.0; ///< poses and viewer
    double rule = 0.0;  ///< view dependence, and the servos' part of a scene's item
    // Not parts of `total`:
    double poseAge = 0.0; ///< of the oldest pose used when the frame began; 0 without a tracker
    double latency =
        0.0; ///< from that pose being measured to the light for which it was predicted; 0 without a tracker
};

/// Classes of MatchFrame::classes.
inline constexpr std::uint8_t kVoxelMatched = 1, kVoxelUnmatched = 2, kVoxelOverfilled = 3;

/// What one frame found, as a value that never changes again.
struct MatchFrame {
    std::uint64_t number = 0;
    Microseconds time{0};
    std::shared_ptr<const Rig> rig;
    std::shared_ptr<const void> rigOrigin; ///< of the wish
    std::shared_ptr<const MatchField> field;
    std::shared_ptr<const MatchTarget> target;
    bool matched = false; ///< a target was matched in this frame
    double seconds = 0.0; ///< of the target's animation
    Angle turned;         ///< by spinning, on top of the placement's yaw
    glm::mat4 deviceFromTarget{1.0F};
    std::shared_ptr<const std::vector<glm::vec3>>
        targetPositions; ///< target's own frame; the same object while it stands still
    std::shared_ptr<const std::vector<glm::vec3>> devicePositions; ///< at the estimated state, device metres

    State wanted;                         ///< levels asked for (of the field; empty without one)
    std::vector<double> wantedStrokes;    ///< what the actuators are asked for, one each
    std::vector<double> estimatedStrokes; ///< where they are under their velocity limits
    std::shared_ptr<const Votes> votes;   ///< error curves; only when matched
    double iouVoting = 0.0;               ///< of V(s) by voting alone
    double iouWanted = 0.0;               ///< of V(wanted)
    double iouEstimated = 0.0;            ///< of the volume really covered now
    int statesSeen = 0;                   ///< joint states that refinement looked at
    double unmatchedVolume = 0.0;         ///< cubic metres of the target that V(wanted) leaves out
    double overfilledVolume = 0.0;        ///< cubic metres of V(wanted) outside the target
    double targetVolume = 0.0;            ///< cubic metres of the target in the frame, outside the body
    double shareBeyondFrame = 0.0;        ///< of the target's volume
    double shareUnreachable = 0.0;        ///< of the target's voxels that no actuator changes
    std::shared_ptr<const std::vector<std::uint8_t>> classes; ///< one a voxel, x fastest; empty unless asked for

    std::shared_ptr<const Scene> scene; ///< of the wish
    std::shared_ptr<const SceneAssets> assets;
    double sceneSeconds = 0.0;
    glm::mat4 worldFromDevice{1.0F};  ///< predicted for the moment at which the frame is seen
    std::optional<glm::vec3> eye;     ///< of the viewer who is followed, predicted likewise; world metres
    std::string viewer;               ///< his name; empty for the scene's own eye
    bool handingOver = false;         ///< the eye glides from one viewer to the next
    std::vector<double> viewStrokes;  ///< what view dependence asks for; empty while it is off or servos rest
    std::vector<double> splitStrokes; ///< what the frequency split asks for; empty without a split item
    MatchTimes ms;
};

/// One frame after another: tracked poses -> viewer -> scene time -> pose of the target -> voxels -> levels, or heights
/// -> strokes -> view dependence -> motion limits -> estimated state -> deformed device. Keeps what one frame hands to
/// the next: last levels, motion, dance, buffers. One thread at a time.
class MatchLoop {
public:
    explicit MatchLoop(const Clock& clock);
    ~MatchLoop();
    MatchLoop(MatchLoop&&) noexcept;
    MatchLoop& operator=(MatchLoop&&) noexcept;

    /// `sinceLast` seconds have passed since the frame before. An actuator goes on where it is when the rig has the
    /// same actuators or is an edit of the one before, else it starts at rest. Throws InvalidInput when the wish
    /// contradicts itself.
    [[nodiscard]] std::shared_ptr<const MatchFrame> step(const MatchWish& wish, double sinceLast);

    /// Whether another step with the last wish would change nothing: nothing plays, turns or dances, nobody is tracked,
    /// the actuators have arrived (within 1e-5 strokes; or are stopped) and refinement has nothing left to try.
    [[nodiscard]] bool settled() const noexcept;

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

/// Runs a MatchLoop in a thread of its own at a fixed rate: the newest wish goes in, the newest frame comes out. Idle
/// (nothing moves, no new wish, nobody tracked) it costs next to nothing; a body that is tracked again wakes it within
/// a tenth of a second.
class MatchThread {
public:
    /// `onFrame` is called in the loop's thread after each frame; it must return at once.
    explicit MatchThread(std::function<void()> onFrame, double framesPerSecond = 60.0);
    ~MatchThread();
    MatchThread(const MatchThread&) = delete;
    MatchThread& operator=(const MatchThread&) = delete;

    void wish(MatchWish wish);
    void setRate(double framesPerSecond);
    /// The newest frame; empty before the first.
    [[nodiscard]] std::shared_ptr<const MatchFrame> latest() const;
    /// Frames a second over the last second; 0 while idle.
    [[nodiscard]] double rate() const noexcept;
    /// What went wrong in the loop, once; the loop holds still until the next wish.
    [[nodiscard]] std::optional<std::string> takeError();

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph
