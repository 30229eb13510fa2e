#pragma once

#include <memory>
#include <vector>

#include <glm/vec2.hpp>

#include "app/applications/slosh.h"
#include "app/applications/visitor.h"
#include "core/loop/show_program.h"

namespace lumorph {

/// The sea of `waterScene` as an application. Leaning lets the water run, and what floats with it; `wheel`, `key.in`
/// and `key.out` make it stormier or calmer; `key.next` throws something in, `key.restart` begins anew. Without a
/// visitor it is the sea as it is.
class WaterProgram final : public ShowProgram {
public:
    static constexpr double kCalmest = 0.2, kStormiest = 1.3; ///< of the scene's own waves
    static constexpr std::size_t kMostFloats = 8;

    /// Throws DataError where a picture is missing.
    WaterProgram();

    [[nodiscard]] ShowContent frame(const ShowMoment& moment) override;

    [[nodiscard]] double storm() const noexcept { return storm_; }
    [[nodiscard]] std::size_t floats() const noexcept { return floats_.size(); }

private:
    struct Float {
        SceneItem item;
        glm::dvec2 home{0.0}, at{0.0}, velocity{0.0}; ///< device metres
        double radius = 0.0, lift = 0.0;              ///< of its middle over the water, metres
    };
    void begin();
    void listen(const ShowMoment& moment);
    void throwIn();
    void drift(const HeightItem& sea, double seconds, double step);
    void keepApart();

    Scene still_; ///< all but what floats
    std::vector<Float> first_, floats_;
    std::shared_ptr<const SceneAssets> assets_;
    std::shared_ptr<const ShowCaption> caption_;
    Visitor visitor_;
    Slosh slosh_{0.7};
    double wanted_ = 1.0, storm_ = 1.0;
    double held_ = 0.0; ///< -1 calmer to 1 stormier, by a key
};

} // namespace lumorph
