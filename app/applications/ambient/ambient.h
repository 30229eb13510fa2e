#pragma once

#include <cstdint>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <random>
#include <vector>

#include "app/applications/ambient/anticipation.h"
#include "app/applications/ambient/scenery.h"
#include "app/applications/ambient/world_clock.h"
#include "app/applications/demo.h"
#include "app/applications/slosh.h"
#include "app/applications/visitor.h"
#include "core/loop/show_program.h"
#include "core/voxels/height_grid.h"

namespace lumorph::ambient {

struct AmbientSettings {
    Place place;
    std::shared_ptr<const Weather> weather; ///< empty: a simulated year
    std::optional<double> begin;            ///< UTC; empty: the morning of the first notable day
    double daySeconds = 120.0;              ///< of the show that a day takes; 86400 is the world's own time
    std::function<double()> now; ///< the world's own clock, UTC, which is then shown; empty: time goes from `begin` on
    DemoFeed feed;               ///< of later forecasts; empty: none come
    double anticipation = 2.0;   ///< seconds by which light shows the sea before servos follow (R38)
};

/// Settings by name, as they come from outside: `weather` a file in Open-Meteo's JSON, whose place counts where none is
/// given, `place` as `placeFrom` reads it, `begin` a local time (2026-05-17T14:00), `day` and `anticipation` seconds,
/// `clock` real or quick. Without `begin` a forecast begins with its first hour, unless it comes again and again: then
/// the clock is the real one. Throws InvalidInput and DataError naming the setting.
[[nodiscard]] AmbientSettings settingsFrom(const DemoTold& settings);
/// Shows the room's own time, at its own pace.
void takeRealClock(AmbientSettings& settings);
/// What it knows.
[[nodiscard]] std::vector<DemoOption> settingOptions();

/// The ambient display: the tablet as a coast that tells time and weather. Light shows all of it, and
/// servos follow the land and the long waves, a set time after light has shown how they change.
///
/// Left and right (held) let time run faster and back, `key.next` goes to another day, `key.restart` back to where it
/// began, where the pointer stands rings run over the water, and when the device is leant the sea runs to its low
/// side, and is felt there. Sounds go on while they are there: `ambient.wind`,
/// `ambient.wave` and `ambient.rain`; `ambient.thunder` begins. Strengths are 0 to 1.
class AmbientProgram final : public ShowProgram {
public:
    /// Throws InvalidInput for settings out of range.
    explicit AmbientProgram(std::uint64_t seed, AmbientSettings settings = {});

    [[nodiscard]] ShowContent frame(const ShowMoment& moment) override;

    /// What light shows in the newest frame.
    [[nodiscard]] const View& view() const noexcept { return view_; }
    /// What servos were given in it: the sea of `anticipation` seconds before.
    [[nodiscard]] const SeaState& followed() const noexcept { return followed_; }
    /// Seconds since the forecast that shows was fetched.
    [[nodiscard]] double forecastAge() const noexcept { return newsAge_; }
    [[nodiscard]] const Weather& weather() const noexcept { return *settings_.weather; }
    [[nodiscard]] const WorldClock& clock() const noexcept { return *clock_; }

private:
    void lookUp();
    void lookAhead();
    void lookAtCards(bool otherWeather);
    void blow(double step);
    void slosh(const ShowMoment& moment);
    void turnFog(double step);
    void thunder(double step);
    void say();
    void takeNews(double step);
    [[nodiscard]] HeightGrid wish(double lag) const;
    [[nodiscard]] std::vector<ShowSound> sounds() const;

    AmbientSettings settings_;
    std::future<std::shared_ptr<const Weather>> reading_; ///< a later forecast
    double newsAge_ = 0.0;                                ///< seconds since the forecast came
    double agedUntil_ = 0.0;                              ///< UTC until which that counts, where there is a clock
    Sea sea_;
    Anticipation anticipation_;
    Scenery scenery_;
    HeightGrid land_;
    Visitor visitor_;
    Slosh slosh_{0.45};
    std::vector<Wave> sloping_; ///< the slope of the sea in a leant device; empty while it is none
    std::shared_ptr<const ShowCaption> caption_;
    double told_ = -1.0; ///< hours or minutes of the world that the caption is of
    std::optional<WorldClock> clock_;
    std::mt19937_64 chance_;

    View view_;
    SeaState followed_;
    long long cardNumber_ = -1;                       ///< of the first card, three-hour marks since 1970
    double day_ = 0.0, moonSeen_ = 0.0, hour_ = -1.0; ///< UTC for which the view's hours, moon and coming hours are
    std::optional<double> flashed_;                   ///< seconds since the last bolt
    double strength_ = 0.0;                           ///< of its thunder
    bool rumbles_ = false;                            ///< the thunder begins in this frame
};

/// What of the land and of the sea servos are to follow, in samples 7.5 mm apart; the land alone.
[[nodiscard]] HeightGrid landGrid();

[[nodiscard]] Demo ambientDemo();

} // namespace lumorph::ambient
