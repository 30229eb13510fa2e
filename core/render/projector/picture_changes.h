#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/render/eye/lookup_region.h"
#include "core/scene/show_frame.h"

namespace lumorph {

/// A rectangle of a projector's image that holds the device as it is.
[[nodiscard]] PixelRectangle devicePixels(const ShowFrame& frame, const CalibratedCamera& projector);

/// Remembers for which frame a projector's picture was drawn, to know what of it the next one can change: the device,
/// shadows on the table, what an eye sees there. The rest of a still table stays as it is, which saves more than half
/// of a frame's work.
class PictureChanges {
public:
    /// What to draw for a frame: all of the image where more than things in motion has changed. Forgets what was drawn,
    /// until it is told again.
    [[nodiscard]] PixelRegion begin(const ShowFrame& frame, const CalibratedCamera& projector,
                                    std::span<const TableArea> lookups);
    /// The picture stands.
    void finish(const ShowFrame& frame);

private:
    struct Drawn {
        std::shared_ptr<const Scene> scene;
        std::shared_ptr<const Installation> installation;
        std::shared_ptr<const SceneAssets> assets;
        std::shared_ptr<const Rig> rig;
        glm::mat4 worldFromDevice{1.0F};
        std::vector<PosedLight> lights;
    };
    [[nodiscard]] bool standsStill(const ShowFrame& frame) const;

    std::optional<Drawn> drawn_;
    PixelRegion moving_; ///< what moved in the frame drawn last
};

} // namespace lumorph
