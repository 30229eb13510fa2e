#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>

#include "app/applications/navigation/map.h"
#include "app/applications/navigation/view_ground.h"
#include "core/base/image.h"
#include "core/scene/scene_assets.h"

namespace lumorph::navigation {

inline constexpr const char* kRainImage = "navigation rain"; ///< an asset that is in memory alone

/// The sample into which water runs from one: of the eight around it the one to which it falls most steeply. Nothing
/// in a hollow.
[[nodiscard]] std::optional<glm::ivec2> steepestDescent(const HeightMap& heights, glm::ivec2 sample) noexcept;

/// Drops that fall from a cloud and run down the map, from sample to sample, until they come to water. Where many have
/// run the water stands higher, and slowly runs off. The ground is dark where it is wet, and river and lake rise with
/// what has come to them.
class Rain {
public:
    struct Drop {
        glm::dvec2 at{0.0}; ///< place, metres
        glm::ivec2 to{0};   ///< sample that it runs to
        double falls = 0.0; ///< seconds until it is on the ground
        double rests = 0.0; ///< seconds in a hollow
    };
    /// What a drop leaves where it falls.
    struct Splash {
        glm::dvec2 at{0.0}; ///< place, metres
        double age = 0.0;   ///< seconds
    };
    static constexpr std::size_t kMostDrops = 900;
    static constexpr double kMostSwell = 2.0; ///< metres by which waters rise

    explicit Rain(std::uint64_t seed) : seed_(seed) {}

    /// Lets drops fall around a point of the device for a while (nothing: from nowhere), and all run.
    void advance(const Map& map, const MapView& view, const std::optional<glm::dvec2>& cloud, double seconds);

    [[nodiscard]] const std::vector<Drop>& drops() const noexcept { return drops_; }
    [[nodiscard]] std::size_t reachedWater() const noexcept { return reached_; } ///< drops, so far
    [[nodiscard]] const std::vector<Splash>& splashes() const noexcept { return splashes_; }
    [[nodiscard]] bool dry() const noexcept { return drops_.empty() && streams_.empty() && wettest_ == 0.0F; }
    /// How wet the ground is, 0 to 1.
    [[nodiscard]] float wetnessAt(const glm::dvec2& place) const noexcept;
    /// By how much waters stand higher than in dry weather, metres, in steps of which each can be seen.
    [[nodiscard]] double swell() const noexcept;

    /// Falling drops with their splashes, running water and wet ground as light, device metres.
    [[nodiscard]] SceneModel model(const Map& map, const ViewGround& ground, double cloudHeight) const;

private:
    /// Water that runs through a cell of the map.
    struct Stream {
        glm::dvec2 from{0.0}, to{0.0};
        float depth = 0.0F; ///< drops that lately came through
    };
    using Key = std::pair<std::int32_t, std::pair<std::int32_t, std::int32_t>>; ///< octave, cell

    void fall(const Map& map, const MapView& view, const glm::dvec2& cloud, double seconds);
    /// Whether it is still there.
    bool run(const Map& map, const MapView& view, Drop& drop, double seconds);
    void wet(const Map& map, const MapView& view, glm::ivec2 from, glm::ivec2 to);
    void soak(const Map& map, const MapView& view, const glm::dvec2& cloud, double seconds);
    void age(double seconds);

    std::uint64_t seed_;
    std::int32_t fallen_ = 0;
    double due_ = 0.0; ///< drops
    std::size_t reached_ = 0;
    std::vector<Drop> drops_;
    std::vector<Splash> splashes_;
    std::map<Key, Stream> streams_;
    std::vector<float> wetness_; ///< of square cells of the map, in rows; empty before the first rain
    double wetCell_ = 1.0;       ///< metres
    float wettest_ = 0.0F;
    double swell_ = 0.0; ///< metres
};

/// Its pictures: running water, the deeper, the brighter; wet ground, the wetter, the darker; rings of splashes.
[[nodiscard]] std::shared_ptr<const Image> rainImage();

} // namespace lumorph::navigation
