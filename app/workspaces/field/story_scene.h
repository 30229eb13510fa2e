#pragma once

#include <memory>

#include "app/workspaces/common/field_scene.h"
#include "app/workspaces/field/story.h"
#include "core/render/viewport/viewport_scene.h"

namespace lumorph::studio {

/// Makes scenes of the story's pictures: the device in the state that is told of, voxels up to the plane, so that one
/// looks at the cut, and the plane's edge. Keeps what was prepared from one picture to the next. One thread at a time.
class StorySceneBuilder {
public:
    explicit StorySceneBuilder(const FieldSceneColors& colors);
    [[nodiscard]] std::shared_ptr<const ViewportScene> build(const StoryPicture& picture);

private:
    void addVoxels(ViewportScene& scene, const StoryPicture& picture) const;
    void addPlane(ViewportScene& scene, const StoryPicture& picture) const;

    FieldSceneColors colors_;
    FieldSceneBuilder builder_;
};

} // namespace lumorph::studio
