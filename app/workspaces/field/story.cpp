#include "app/workspaces/field/story.h"

#include <algorithm>
#include <array>
#include <utility>

#include <QObject>

#include "app/workspaces/common/field_summary.h"
#include "core/mdf/placement.h"

namespace lumorph::studio {

namespace {

QString percentText(double share) { return QObject::tr("%1 %").arg(100.0 * share, 0, 'f', 1); }

/// As its file is called.
QString targetName(const Story& story) { return QString::fromStdString(story.target->name); }

QString actuatorName(const Story& story, std::size_t actuator) {
    return QString::fromStdString(story.rig->actuators()[actuator].name);
}

void addTarget(Story& story, const StoryTarget& from, const Progress& progress) {
    story.target = from.target;
    story.deviceFromTarget = from.deviceFromTarget;
    Target target = from.target->solid;
    target.mesh = meshAt(*from.target, from.seconds);
    story.targetPositions = std::make_shared<const std::vector<glm::vec3>>(target.mesh.positions);
    std::vector<glm::vec3> standing;
    placePoints(target.mesh.positions, from.deviceFromTarget, standing);
    target.mesh.positions = std::move(standing);
    progress.report(-1.0, QT_TR_NOOP("turning the target into voxels"));
    SolidVoxelizer voxelizer;
    BitColumns bits;
    const MatchField& field = *story.field;
    if (from.relief && field.relief)
        voxelizeRelief(*field.relief, target.mesh.positions, target.mesh.triangles, bits);
    else
        voxelizeTarget(field.field.frame, target, voxelizer, bits, progress);
    story.match = matchStory(field.coverage, field.voting, std::move(bits), progress);
    BitColumns beyond = story.match->target;
    beyond -= story.reachable;
    story.unreachable = beyond.count();
}

QString statesText(const StoryPicture& picture) {
    const Story& story = *picture.story;
    const StoryView& view = picture.view;
    return QObject::tr(
               "“%1” can stand at %2 levels. At level %3 it covers %4 voxels that the device at rest does not. Each "
               "state is turned into voxels like this, one after the other.")
        .arg(actuatorName(story, view.actuator))
        .arg(story.field->field.levels)
        .arg(view.level)
        .arg(countText(coveredBy(story, stateOf(story, view.actuator, view.level)).count()));
}

QString fieldText(const StoryPicture& picture) {
    const Story& story = *picture.story;
    std::size_t changed = 0;
    for (const Ramp& ramp : story.field->field.actuators[picture.view.actuator].ramps)
        changed += ramp.v0 != kUnchanged ? 1 : 0;
    return QObject::tr(
               "Every voxel keeps only the level at which “%1” first covers it: light green early, dark green late. So "
               "one grid stands for all %2 states. It changes %3 voxels.")
        .arg(actuatorName(story, picture.view.actuator))
        .arg(story.field->field.levels)
        .arg(countText(changed));
}

QString allText(const StoryPicture& picture) {
    const Story& story = *picture.story;
    const QString reached =
        QObject::tr("All fields over one another: the device reaches %1 voxels, each coloured by the lowest "
                    "level that any of its %2 actuators needs. ")
            .arg(countText(story.reachable.count()))
            .arg(story.rig->actuatorCount());
    if (!picture.reach) return reached + QObject::tr("What only two of them together reach is being counted.");
    if (picture.reach->pairs.empty()) return reached + QObject::tr("None needs two of them at once.");
    const JointReach::Pair& most = picture.reach->pairs.front();
    return reached + QObject::tr("Blue: %1 voxels that only two together reach, %4 of them “%2” with “%3”.")
                         .arg(countText(picture.reach->together.count()), actuatorName(story, most.first),
                              actuatorName(story, most.second), countText(most.voxels));
}

QString targetText(const StoryPicture& picture) {
    const Story& story = *picture.story;
    if (!story.match) return QObject::tr("No target is open yet. Open one, and the story goes on with it.");
    const QString sentence =
        QObject::tr("The shape wanted, “%1”, is turned into voxels of the same grid. %2 of them lie "
                    "outside the device at rest")
            .arg(targetName(story), countText(story.match->target.count()));
    if (story.unreachable == 0) return sentence + QObject::tr(", all where actuators reach.");
    return sentence + QObject::tr("; %1 lie where no actuator reaches (orange).").arg(countText(story.unreachable));
}

QString votesText(const StoryPicture& picture) {
    const Story& story = *picture.story;
    if (!story.match) return targetText(picture);
    const ActuatorVote& vote = story.match->votes.actuators[picture.view.actuator];
    std::size_t candidates = 0;
    for (const std::size_t count : candidateCounts(story.field->field, picture.view.actuator, story.match->target))
        candidates += count;
    const QString name = actuatorName(story, picture.view.actuator);
    if (candidates == 0)
        return QObject::tr(
                   "Where target and field overlap, each voxel speaks for the level that covers it. No voxel of this "
                   "target speaks for “%1”, so it rests.")
            .arg(name);
    if (!vote.reached)
        return QObject::tr(
                   "Where target and field overlap, each voxel speaks for the level that covers it. No level of “%1” "
                   "covers enough of the target, so it rests.")
            .arg(name);
    return QObject::tr(
               "Where target and field overlap, %1 voxels speak for a level of “%2” (bars). Eq. 1 weighs what a level "
               "gets wrong against what it covers (line): level %3 is best.")
        .arg(countText(candidates), name)
        .arg(vote.level.index);
}

QString fitText(const StoryPicture& picture) {
    const Story& story = *picture.story;
    if (!story.match) return targetText(picture);
    const double voted = story.match->voting.quality.iou();
    const double refined = story.match->refined.quality.iou();
    return QObject::
        tr("By the votes alone device and target share %1 of their volume (IoU). Refinement goes on from there with "
           "the true volume of all actuators together: %2. The device takes this shape.")
            .arg(percentText(voted), percentText(refined));
}

/// Of the planes that tell the most of one actuator, the one in which all of them together change the most.
VoxelPlane fullestOfTelling(const Story& story) {
    const auto changed = [&story](const VoxelPlane& plane) {
        const glm::ivec3 size = story.reachable.dimensions();
        const glm::ivec2 extent = sizeOf(plane, size);
        int count = 0;
        for (int across = 0; across < extent.x; ++across)
            for (int up = 0; up < extent.y; ++up) {
                const glm::ivec3 v = voxelOf(plane, size, {across, up});
                count += story.reachable.test(v.x, v.y, v.z) ? 1 : 0;
            }
        return count;
    };
    return *std::ranges::max_element(story.telling, {}, changed);
}

} // namespace

std::shared_ptr<const Story> makeStory(std::shared_ptr<const MatchField> field, const StoryTarget& target,
                                       const Progress& progress) {
    auto story = std::make_shared<Story>();
    story->field = std::move(field);
    story->rig = std::make_shared<const Rig>(story->field->rig);
    const Field& mdf = story->field->field;
    for (std::size_t a = 0; a < mdf.actuators.size(); ++a) {
        progress.throwIfCancelled();
        progress.report(0.5 * static_cast<double>(a) / static_cast<double>(mdf.actuators.size()),
                        "looking at the field");
        story->telling.push_back(tellingPlane(mdf, *story->rig, a));
    }
    story->reachable = reachableVoxels(mdf);
    if (target.target) addTarget(*story, target, progress);
    return story;
}

bool canBeTold(const StoryPicture& picture) noexcept {
    return picture.view.step < StoryStep::target || picture.story->match.has_value();
}

VoxelPlane tellingPlane(const StoryPicture& picture) {
    const Story& story = *picture.story;
    const StoryStep step = picture.view.step;
    if (step == StoryStep::all) {
        const bool together = picture.reach && !picture.reach->pairs.empty();
        return together ? fullestPlane(picture.reach->together) : fullestOfTelling(story);
    }
    if (step < StoryStep::target || !story.match) return story.telling[picture.view.actuator];
    BitColumns candidates = story.match->target;
    candidates &= step == StoryStep::votes ? changedVoxels(story.field->field, picture.view.actuator) : story.reachable;
    if (candidates.count() > 0) return fullestPlane(candidates);
    return step == StoryStep::votes ? story.telling[picture.view.actuator] : fullestPlane(story.match->target);
}

State stateOf(const Story& story, std::size_t actuator, int level) {
    State state(story.rig->actuatorCount());
    state[actuator] = Level{level};
    return state;
}

BitColumns coveredBy(const Story& story, const State& state) {
    BitColumns covered;
    CoverageScratch scratch;
    story.field->coverage.covered(state, covered, scratch);
    return covered;
}

std::vector<glm::vec3> positionsAt(const Story& story, const State& state) {
    std::vector<glm::vec3> positions(story.rig->restMesh().positions.size());
    story.rig->deform(strokesOf(*story.rig, state, story.field->field.levels), positions);
    return positions;
}

QString nameOf(StoryStep step) {
    static constexpr std::array<const char*, kStorySteps> kNames{QT_TR_NOOP("States"), QT_TR_NOOP("Field"),
                                                                 QT_TR_NOOP("Device"), QT_TR_NOOP("Target"),
                                                                 QT_TR_NOOP("Votes"),  QT_TR_NOOP("Fit")};
    return QObject::tr(kNames[static_cast<std::size_t>(step)]);
}

StoryWords wordsOf(const StoryPicture& picture) {
    const StoryStep step = picture.view.step;
    switch (step) {
    case StoryStep::states:
        return {nameOf(step), QObject::tr("One actuator, one state at a time"), statesText(picture)};
    case StoryStep::field:
        return {nameOf(step), QObject::tr("All its states in one field"), fieldText(picture)};
    case StoryStep::all:
        return {nameOf(step), QObject::tr("The field of the whole device"), allText(picture)};
    case StoryStep::target:
        return {nameOf(step), QObject::tr("The target in the same voxels"), targetText(picture)};
    case StoryStep::votes:
        return {nameOf(step), QObject::tr("The target's voxels vote"), votesText(picture)};
    case StoryStep::fit:
        return {nameOf(step), QObject::tr("The fit"), fitText(picture)};
    }
    return {};
}

} // namespace lumorph::studio
