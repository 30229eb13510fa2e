#pragma once

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "app/applications/slosh.h"
#include "app/applications/visitor.h"
#include "app/applications/water/afloat.h"
#include "app/applications/water/harbour.h"
#include "app/applications/water/ripples.h"
#include "app/applications/water/sea_surface.h"
#include "core/loop/show_program.h"

namespace lumorph {

/// The sea of `waterScene` as an application. Leaning lets the water run, and what floats with it; a press of the
/// pointer or a hand makes rings, which push things away; `wheel`, `key.in` and `key.out` make it stormier or calmer;
/// `key.next` throws something in, `key.restart` begins anew. A boat may be brought to a beacon, which then comes up
/// elsewhere. Without a visitor drops fall now and then, and the boat sails by itself. Sounds are `water.drop`,
/// `.splash` and `.harbour`.
class WaterProgram final : public ShowProgram {
public:
    static constexpr double kCalmest = 0.2, kStormiest = 1.3; ///< of the scene's own waves
    static constexpr std::size_t kMostFloats = 8;

    /// Throws DataError where a picture is missing.
    WaterProgram();

    [[nodiscard]] ShowContent frame(const ShowMoment& moment) override;

    [[nodiscard]] double storm() const noexcept { return storm_; }
    [[nodiscard]] std::size_t floats() const noexcept { return floats_.size(); } ///< without the boat
    [[nodiscard]] const sea::SeaSurface& water() const noexcept { return water_; }
    [[nodiscard]] const sea::Harbour& harbour() const noexcept { return harbour_; }
    [[nodiscard]] const glm::dvec2& boat() const noexcept { return boat_.at; }

private:
    void begin();
    void addFirst(const SceneItem& item);
    void listen(const ShowMoment& moment);
    void takeHands(const ShowMoment& moment);
    void takePointer(double step);
    void play(double step);
    void touch(const glm::dvec2& place, double strength);
    void throwIn();
    void advance(const ShowMoment& moment, double step);
    void sailHome();
    [[nodiscard]] std::vector<sea::Float*> afloat();
    void showHarbour(Scene& scene) const;
    [[nodiscard]] std::shared_ptr<const SceneAssets> assetsNow() const;
    void hear(const char* sound, double strength, const glm::dvec2& place);

    Scene still_; ///< lights alone
    std::vector<Wave> waves_;
    std::vector<sea::Float> first_, floats_;
    sea::Float boat_;
    std::shared_ptr<const SceneAssets> assets_;
    std::shared_ptr<const ShowCaption> caption_, arrived_;
    Visitor visitor_;
    Slosh slosh_{0.7};
    sea::Ripples ripples_;
    sea::SeaSurface water_;
    sea::Harbour harbour_;
    std::vector<ShowSound> sounds_;     ///< of this frame
    std::set<std::string> hands_;       ///< that touch the water
    bool pressed_ = false;              ///< a button or finger is down
    std::optional<glm::dvec2> touched_; ///< where, since it is
    double sinceTouch_ = 0.0;           ///< seconds
    double alone_ = 0.0;                ///< seconds of its own show
    int played_ = 0;                    ///< of what it does in it
    double wanted_ = 1.0, storm_ = 1.0;
    double held_ = 0.0; ///< -1 calmer to 1 stormier, by a key
};

} // namespace lumorph
