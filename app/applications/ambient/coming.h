#pragma once

#include <array>
#include <optional>

#include "app/applications/ambient/forecast_card.h"
#include "app/applications/ambient/scenery.h"
#include "core/render/figure/text.h"

namespace lumorph::ambient {

/// The forecast: a row of cards over the far water that come nearer to now hour by hour and turn to who looks.
class Coming {
public:
    static constexpr double kCardWidth = 0.0190; ///< metres

    /// Throws DataError where the font is missing.
    Coming();

    static void addTo(Scene& scene, SceneAssets& assets);
    void show(Scene& scene, const View& view) const;
    /// Paints what cards say now; true where a picture has changed, which `pictures` then puts into assets.
    [[nodiscard]] bool update(const View& view);
    void pictures(SceneAssets& assets) const;

private:
    struct Painted {
        std::optional<ForecastCard> says;
        std::shared_ptr<const Image> picture;
    };
    Font font_;
    std::array<Painted, kCards> painted_; ///< by slots
};

/// What the card of a time of the view says.
[[nodiscard]] ForecastCard cardOf(const View& view, const View::Card& card) noexcept;

} // namespace lumorph::ambient
