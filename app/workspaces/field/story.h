#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <QString>
#include <glm/mat4x4.hpp>

#include "core/base/progress.h"
#include "core/loop/match_field.h"
#include "core/loop/match_target.h"
#include "core/mdf/field_story.h"

namespace lumorph::studio {

/// The steps in which it is told how the field works, from a single state to the fit.
enum class StoryStep { states, field, all, target, votes, fit };
inline constexpr int kStorySteps = 6;

/// What it is told of: the device that is open, its field, and the target as it stands at one moment. Immutable; made
/// beside the window, read by any thread.
struct Story {
    std::shared_ptr<const MatchField> field;                       ///< always there
    std::shared_ptr<const Rig> rig;                                ///< of the field
    std::vector<VoxelPlane> telling;                               ///< for each actuator
    BitColumns reachable;                                          ///< voxels that any actuator changes
    std::shared_ptr<const MatchTarget> target;                     ///< may be empty, and with it what follows
    std::shared_ptr<const std::vector<glm::vec3>> targetPositions; ///< at that moment, target's own frame
    glm::mat4 deviceFromTarget{1.0F};
    std::optional<StoryMatch> match;
    std::size_t unreachable = 0; ///< target voxels that no actuator changes
};

/// Where a target stands, and at which moment of its animation.
struct StoryTarget {
    std::shared_ptr<const MatchTarget> target; ///< may be empty
    glm::mat4 deviceFromTarget{1.0F};
    double seconds = 0.0;
    bool relief = false;
};

/// Throws Cancelled.
[[nodiscard]] std::shared_ptr<const Story> makeStory(std::shared_ptr<const MatchField> field, const StoryTarget& target,
                                                     const Progress& progress = {});

/// What is looked at.
struct StoryView {
    StoryStep step = StoryStep::states;
    std::size_t actuator = 0;
    int level = 0; ///< of that actuator, in the first two steps
    VoxelPlane plane;
    bool operator==(const StoryView&) const = default;
};

/// One picture of the story, as a plain value.
struct StoryPicture {
    std::shared_ptr<const Story> story;      ///< always there
    std::shared_ptr<const JointReach> reach; ///< empty while it is still being counted
    StoryView view;
};

/// Whether there is a target to tell of, or none is needed.
[[nodiscard]] bool canBeTold(const StoryPicture& picture) noexcept;

/// The plane that tells the most in this step; that of the actuator where the step is about one.
[[nodiscard]] VoxelPlane tellingPlane(const StoryPicture& picture);

/// The joint state in which one actuator is at a level and the others at rest.
[[nodiscard]] State stateOf(const Story& story, std::size_t actuator, int level);
/// V of a joint state.
[[nodiscard]] BitColumns coveredBy(const Story& story, const State& state);
/// The rig's vertices in a joint state, device metres.
[[nodiscard]] std::vector<glm::vec3> positionsAt(const Story& story, const State& state);

/// Title and a few sentences, with the numbers of the device that is open.
struct StoryWords {
    QString name; ///< of the step, one word
    QString title, text;
};
[[nodiscard]] StoryWords wordsOf(const StoryPicture& picture);
[[nodiscard]] QString nameOf(StoryStep step);

} // namespace lumorph::studio
