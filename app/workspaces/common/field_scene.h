#pragma once

#include <memory>

#include "app/workspaces/common/field_display.h"
#include "core/loop/match_frame.h"
#include "core/render/viewport/viewport_scene.h"

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
    glm::vec3 wish{0.62F, 0.70F, 0.86F}; ///< ghost of where the device is asked to be
};

/// Turns frames of the loop into scenes; keeps shadings, voxel clouds and level surfaces while what they come from
/// stays the same object. No Qt window, no GL: the command line and the studio use the same.
class FieldSceneBuilder {
public:
    FieldSceneBuilder();
    ~FieldSceneBuilder();

    void setColors(const FieldSceneColors& colors);
    /// Patient (the default): `build` waits until everything is ready. Else large surfaces are prepared in a thread of
    /// their own and left out, or the last one kept, while `pending`: for a window that must not stall.
    void setPatient(bool patient);
    /// Something is still being prepared: build again soon.
    [[nodiscard]] bool pending() const;
    /// The scene of a frame; shadings, clouds and surfaces in it are the same objects as in the last scene while what
    /// they come from is. `targetSelected` outlines the target.
    [[nodiscard]] std::shared_ptr<const ViewportScene> build(const MatchFrame& frame, const FieldDisplay& display,
                                                             bool targetSelected);

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph::studio
