#pragma once

#include <memory>

#include "app/workspaces/field/field_display.h"
#include "core/loop/live_match.h"
#include "core/render/viewport_scene.h"

namespace lumorph::studio {

/// Picking ids of the Field workspace's scene.
inline constexpr std::uint32_t kDeviceId = 1, kTargetId = 2, kFieldId = 3;

/// Colours of a theme that a scene needs, sRGB.
struct FieldSceneColors {
    Theme theme = Theme::dark;
    glm::vec3 device{0.93F, 0.915F, 0.88F};
    glm::vec3 target{0.16F, 0.72F, 0.80F};
    glm::vec3 unmatched{0.0F};
    glm::vec3 overfilled{0.0F};
    glm::vec3 levelLow{0.0F};
    glm::vec3 levelHigh{0.0F};
    glm::vec3 accent{0.16F, 0.72F, 0.80F};
};

/// Turns frames of the loop into scenes; keeps shadings, voxel clouds and level surfaces while what they come from
/// stays the same object. No Qt window, no GL: the command line and the studio use the same.
class FieldSceneBuilder {
public:
    FieldSceneBuilder();
    ~FieldSceneBuilder();

    void setColors(const FieldSceneColors& colors);
    [[nodiscard]] std::shared_ptr<const ViewportScene> build(const MatchFrame& frame, const FieldDisplay& display,
                                                             bool targetSelected);

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph::studio
