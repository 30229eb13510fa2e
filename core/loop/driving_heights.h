#pragma once

#include <map>
#include <memory>
#include <span>
#include <vector>

#include "core/loop/match_target.h"
#include "core/mdf/placement.h"
#include "core/motion/surface_heights.h"
#include "core/scene/posed_scene.h"
#include "core/scene/scene.h"
#include "core/scene/scene_assets.h"

namespace lumorph {

/// The heights that a scene's item wishes for at points over the device, at any time of it; beside the item they stay
/// as they are. Keeps what was worked out for a time while nothing about the item changes, since a window of time is
/// asked for again and again.
class DrivingHeights {
public:
    /// What the heights are made from.
    struct Source {
        std::shared_ptr<const Scene> scene;
        std::shared_ptr<const SceneAssets> assets; ///< may be empty
        int item = 0;                              ///< of the scene
        glm::mat4 worldFromDevice{1.0F};
        /// For a TargetItem, whose time is the target's own:
        std::shared_ptr<const MatchTarget> target;
        Placement placement;        ///< at time 0
        double targetSeconds = 0.0; ///< of its animation at time 0
        bool playing = true;
        double spin = 0.0; ///< radians a second
    };

    explicit DrivingHeights(std::span<const glm::vec2> points);
    /// The scene must hold the item.
    void use(const Source& source);
    /// Device metres, one a point.
    void at(double seconds, std::span<float> heights);

private:
    void workOut(double seconds, std::span<float> heights);
    void ofHeightField(const HeightItem& item, double seconds, std::span<float> heights) const;
    [[nodiscard]] const Image* pictureOf(const HeightItem& item) const;
    void ofSurfaces(double seconds, std::span<float> heights);
    void ofTarget(double seconds, std::span<float> heights);
    void raise(std::span<const glm::vec3> positions, const glm::mat4& deviceFromSurface,
               std::span<const glm::uvec3> triangles, std::span<float> highest);

    std::vector<glm::vec2> points_;
    SurfaceHeights reader_;
    Source source_;
    Scene alone_; ///< the groups around the item, and last the item
    ScenePoser poser_;
    std::vector<glm::vec3> placed_; ///< buffers
    std::vector<float> read_;
    std::map<double, std::vector<float>> kept_;
};

} // namespace lumorph
