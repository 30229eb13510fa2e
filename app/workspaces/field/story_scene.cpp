#include "app/workspaces/field/story_scene.h"

#include <array>
#include <cmath>
#include <utility>

#include <glm/common.hpp>

#include "app/workspaces/common/field_cloud.h"
#include "core/loop/match_stage.h"
#include "core/mdf/field_view.h"

namespace lumorph::studio {

namespace {

constexpr float kSeenThrough = 0.3F; ///< opacity of a surface over voxels

std::array<std::uint8_t, 4> voxelBytes(const glm::vec3& color) {
    const auto byte = [](float share) { return static_cast<std::uint8_t>(std::lround(255.0F * share)); };
    return {byte(color.r), byte(color.g), byte(color.b), 255};
}

/// Which state of the device the step shows.
State shownState(const StoryPicture& picture) {
    const Story& story = *picture.story;
    if (picture.view.step <= StoryStep::field) return stateOf(story, picture.view.actuator, picture.view.level);
    if (picture.view.step == StoryStep::fit && story.match) return story.match->refined.state;
    return State(story.rig->actuatorCount());
}

/// The voxels that the step is about.
BitColumns shownVoxels(const StoryPicture& picture, const std::vector<std::uint8_t>& levels) {
    const Story& story = *picture.story;
    const Field& field = story.field->field;
    const StoryView& view = picture.view;
    if (view.step == StoryStep::states) return coveredBy(story, stateOf(story, view.actuator, view.level));
    if (view.step == StoryStep::target) return story.match ? story.match->target : BitColumns(field.frame.dimensions);
    BitColumns bits(field.frame.dimensions);
    if (view.step == StoryStep::fit) return bits;
    const int highest = view.step == StoryStep::field ? view.level : field.levels;
    const glm::ivec3 size = field.frame.dimensions;
    for (int z = 0; z < size.z; ++z)
        for (int x = 0; x < size.x; ++x)
            for (int y = 0; y < size.y; ++y)
                if (levels[field.voxelIndex(x, y, z)] <= highest) bits.set(x, y, z);
    if (view.step == StoryStep::all && picture.reach) bits |= picture.reach->together;
    if (view.step == StoryStep::votes && story.match) bits &= story.match->target;
    return bits;
}

MatchFrame frameOf(const StoryPicture& picture) {
    const Story& story = *picture.story;
    MatchFrame frame;
    frame.rig = story.rig;
    frame.field = story.field;
    frame.devicePositions = std::make_shared<const std::vector<glm::vec3>>(positionsAt(story, shownState(picture)));
    if (picture.view.step < StoryStep::target || !story.match) return frame;
    frame.target = story.target;
    frame.targetPositions = story.targetPositions;
    frame.deviceFromTarget = story.deviceFromTarget;
    if (picture.view.step != StoryStep::fit) return frame;
    frame.matched = true;
    frame.classes = std::make_shared<const std::vector<std::uint8_t>>(
        voxelClasses(story.match->refined.covered, story.match->target));
    return frame;
}

} // namespace

StorySceneBuilder::StorySceneBuilder(const FieldSceneColors& colors) : colors_(colors) { builder_.setColors(colors); }

std::shared_ptr<const ViewportScene> StorySceneBuilder::build(const StoryPicture& picture) {
    auto scene = std::make_shared<ViewportScene>(*builder_.build(frameOf(picture), FieldDisplay(), false));
    // What is told of lies inside them.
    const StoryStep step = picture.view.step;
    for (ViewportSurface& surface : scene->surfaces) {
        if (surface.id == kDeviceId && step <= StoryStep::field) surface.opacity = kSeenThrough;
        if (surface.id == kTargetId && step == StoryStep::votes) surface.opacity = kSeenThrough;
    }
    addVoxels(*scene, picture);
    addPlane(*scene, picture);
    return scene;
}

void StorySceneBuilder::addVoxels(ViewportScene& scene, const StoryPicture& picture) const {
    const Field& field = picture.story->field->field;
    const StoryView& view = picture.view;
    const bool single = view.step == StoryStep::field || view.step == StoryStep::votes;
    const std::vector<std::uint8_t> levels = firstLevels(field, single ? std::optional(view.actuator) : std::nullopt);
    const auto colorOf = [&](const glm::ivec3& v) {
        if (view.step == StoryStep::states)
            return levelColor(view.level, field.levels, colors_.levelLow, colors_.levelHigh);
        if (view.step == StoryStep::target) return colors_.target;
        if (view.step == StoryStep::all && picture.reach && picture.reach->together.test(v.x, v.y, v.z))
            return colors_.overfilled;
        return levelColor(levels[field.voxelIndex(v.x, v.y, v.z)], field.levels, colors_.levelLow, colors_.levelHigh);
    };
    glm::ivec3 last = field.frame.dimensions - 1;
    if (view.step != StoryStep::states) last[view.plane.axis] = view.plane.index;
    auto voxels = std::make_shared<std::vector<ViewportVoxel>>();
    for (const glm::ivec3& v : surfaceVoxels(shownVoxels(picture, levels), glm::ivec3(0), last))
        voxels->push_back({static_cast<std::uint16_t>(v.x), static_cast<std::uint16_t>(v.y),
                           static_cast<std::uint16_t>(v.z), 0, voxelBytes(colorOf(v))});
    ViewportVoxels cloud;
    cloud.id = kFieldId;
    cloud.frame = field.frame;
    cloud.voxels = std::move(voxels);
    scene.voxels.push_back(std::move(cloud));
}

/// The edge of the plane that is seen beside.
void StorySceneBuilder::addPlane(ViewportScene& scene, const StoryPicture& picture) const {
    const VoxelFrame& frame = picture.story->field->field.frame;
    Box plane = frame.box();
    const int axis = picture.view.plane.axis;
    plane.min[axis] = plane.max[axis] = static_cast<float>(middleOf(picture.view.plane, frame));
    const std::array<glm::vec3, 4> corners =
        axis == 0 ? std::array{plane.min, glm::vec3(plane.min.x, plane.min.y, plane.max.z), plane.max,
                               glm::vec3(plane.min.x, plane.max.y, plane.min.z)}
                  : std::array{plane.min, glm::vec3(plane.max.x, plane.min.y, plane.min.z), plane.max,
                               glm::vec3(plane.min.x, plane.max.y, plane.min.z)};
    for (std::size_t k = 0; k < corners.size(); ++k)
        scene.lines.push_back({corners[k], corners[(k + 1) % corners.size()], colors_.accent, 2.0F, false});
}

} // namespace lumorph::studio
