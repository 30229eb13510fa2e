#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/applications/demo.h"
#include "app/applications/navigation/best_turn.h"
#include "app/applications/navigation/ground_picture.h"
#include "app/applications/navigation/inset.h"
#include "app/applications/navigation/labels.h"
#include "app/applications/navigation/map.h"
#include "app/applications/navigation/map_view.h"
#include "app/applications/navigation/rain.h"
#include "app/applications/navigation/view_ground.h"
#include "app/applications/visitor.h"
#include "core/loop/show_program.h"

namespace lumorph::navigation {

/// How the device bends for who looks; `beside`: it does, and is seen without it, too.
enum class Bending { off, on, beside };

/// Items of the scene; labels are from kFirstLabel on.
enum LandItem : int { kSunItem = 1, kLandItem, kRainItem, kFirstCloud, kLastCloud = kFirstCloud + 5 };

/// A map that one flies over, as an application: light shows land, houses and names, and the device takes the land's
/// shape; flights end with the turn at which it can do so best. Leaning pans, `key.in`, `key.out`, `key.turnLeft` and
/// `key.turnRight` act while held, `key.next` flies to the next place, `key.restart` to where all is seen. A held
/// pointer body, or `key.rain`, lets it rain; `key.bend` lets the far edge come up for who looks (view-dependent
/// shape), `key.off` shows that beside the same without it. Without a visitor it flies from place to place.
class NavigationProgram final : public ShowProgram {
public:
    /// Throws InvalidInput for a map without heights, or cover for each of them, DataError where the font is missing.
    NavigationProgram(std::uint64_t seed, std::shared_ptr<const Map> map, Bending bending = Bending::off);

    [[nodiscard]] ShowContent frame(const ShowMoment& moment) override;

    /// Flies to a place as `find` finds it; throws InvalidInput naming those there are where none is meant.
    void flyTo(const std::string& name);

    /// Lets this be read in the first half minute.
    void tell(ShowCaption caption);

    [[nodiscard]] const Map& map() const noexcept { return *map_; }
    [[nodiscard]] const MapView& view() const noexcept { return view_; }
    [[nodiscard]] const ViewGround& ground() const noexcept { return *ground_; }
    [[nodiscard]] const Rain& rain() const noexcept { return rain_; }
    [[nodiscard]] bool flies() const noexcept { return flight_.has_value(); }
    [[nodiscard]] bool playsItself() const noexcept { return !visitor_.there(); }
    [[nodiscard]] MapView home() const noexcept;

private:
    void listen(const ShowMoment& moment);
    void move(double step);
    void tour(double step);
    void steer(double step);
    void fly(const MapView& to);
    [[nodiscard]] MapView viewOf(const Place& place, double turn) const;
    void paintGround();
    [[nodiscard]] const GroundPicture& picture() const;
    void makeLand(double step);
    void letRain(const ShowMoment& moment);
    [[nodiscard]] std::shared_ptr<const Scene> scene(const ShowMoment& moment);

    std::shared_ptr<const Map> map_;
    std::uint64_t seed_;
    Visitor visitor_;
    Rain rain_;
    Labels labels_;
    std::optional<Inset> inset_;
    std::shared_ptr<const SceneAssets> still_; ///< what never changes
    Scene setting_;

    std::shared_ptr<const Rig> rig_;
    std::optional<BestTurn> bestTurn_; ///< of `rig_`
    MapView view_;
    glm::dvec2 velocity_{0.0}; ///< of the middle, device metres a second
    std::optional<Flight> flight_;
    double flown_ = 0.0, rested_ = 0.0; ///< seconds
    std::size_t visited_ = 0;           ///< places, by the tour or `key.next`
    std::optional<std::size_t> last_;   ///< place that a visitor went to
    double idle_ = 0.0;                 ///< seconds in which he has steered nothing
    double in_ = 0.0, out_ = 0.0, left_ = 0.0, right_ = 0.0;
    double wheel_ = 0.0; ///< notches
    bool raining_ = false;
    double drifted_ = 0.0;            ///< seconds that the cloud has drifted
    double swell_ = 0.0;              ///< of the waters as `land_` has them, metres
    Bending usual_, bending_;         ///< where nobody chose otherwise, and now
    std::optional<glm::dvec2> cloud_; ///< over the device

    std::unique_ptr<GroundPicture> whole_, sharp_, making_;
    std::optional<ViewGround> ground_;
    PictureWindow window_; ///< of the land's picture
    std::shared_ptr<const SceneModel> land_;
    std::shared_ptr<const SceneAssets> assets_;
    std::shared_ptr<const ShowCaption> told_, comparing_;
};

[[nodiscard]] Demo navigationDemo();

} // namespace lumorph::navigation
