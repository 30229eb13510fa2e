#include "app/applications/ambient/ambient.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

#include "app/applications/ambient/caption.h"
#include "app/applications/ambient/simulated_year.h"
#include "app/applications/ambient/weather_file.h"
#include "app/applications/demo_items.h"
#include "core/base/error.h"
#include "core/motion/causal_split.h"

namespace lumorph::ambient {
namespace {

constexpr glm::dvec2 kHalf{0.105, 0.075}; ///< of the tablet, metres
constexpr double kFirstHour = 8.0;        ///< of the day with which a show begins
constexpr double kWindSettles = 1.2;      ///< seconds until light shows the wind of another hour, by a factor of e
constexpr double kCarriedByWind = 0.0022; ///< speed of clouds for each metre a second of wind
constexpr double kSlopeLength = 2.0;      ///< metres of a wave that is a slope on the tablet
constexpr double kFogByWind = 0.0070;     ///< likewise of fog, which is near
constexpr double kFogLife = 14.0;         ///< seconds that a bank of fog is seen
constexpr double kMoonMoves = 600.0;      ///< seconds of the world after which the moon is looked for again
constexpr double kBoltsASecond = 0.35;    ///< in a thunderstorm
constexpr double kFlashSeconds = 0.75;
constexpr double kSlowDay = 7200.0;   ///< seconds of a day in which minutes can be read
constexpr double kThunderAfter = 0.6; ///< seconds after its bolt

AmbientSettings complete(AmbientSettings settings, std::uint64_t seed) {
    checkPlace(settings.place);
    if (!(settings.daySeconds >= 1.0 && settings.daySeconds <= 86'400.0))
        throw InvalidInput("length of a day", "is not 1 to 86400 seconds", "correct it");
    if (!settings.weather) settings.weather = std::make_shared<const Weather>(simulatedYear(settings.place, seed));
    return settings;
}

/// Two flickers.
double flashAt(double seconds) {
    const auto flicker = [](double t) { return t < 0.0 ? 0.0 : std::exp(-t / 0.09); };
    return std::min(1.0, flicker(seconds) + 0.8 * flicker(seconds - 0.17));
}

glm::dvec2 placeAt(const HeightGrid& grid, int column, int row) {
    return {std::lerp(grid.min.x, grid.max.x, static_cast<double>(column) / (grid.columns - 1)),
            std::lerp(grid.min.y, grid.max.y, static_cast<double>(row) / (grid.rows - 1))};
}

} // namespace

HeightGrid landGrid() {
    HeightGrid grid{-kHalf, kHalf, 29, 21, {}};
    for (int j = 0; j < grid.rows; ++j)
        for (int i = 0; i < grid.columns; ++i)
            grid.heights.push_back(static_cast<float>(landHeight(placeAt(grid, i, j))));
    return grid;
}

AmbientProgram::AmbientProgram(std::uint64_t seed, AmbientSettings settings)
    : settings_(complete(std::move(settings), seed)), sea_(seed), anticipation_(settings_.anticipation),
      land_(landGrid()), chance_(seed) {
    const std::vector<double> days = notableDays(*settings_.weather, settings_.place);
    const double begin =
        settings_.now
            ? settings_.now()
            : settings_.begin.value_or(std::max(settings_.weather->begin(), days.front() + 3600.0 * kFirstHour));
    agedUntil_ = settings_.now ? begin : 0.0;
    clock_.emplace(settings_.place, days, begin, settings_.daySeconds, settings_.now);
    view_.place = settings_.place;
    view_.sea = {settings_.weather->at(begin).windSpeed, {1.0, 0.0}};
    view_.sea.towards = onDevice(settings_.place, settings_.weather->at(begin).windFrom + std::numbers::pi);
}

ShowContent AmbientProgram::frame(const ShowMoment& moment) {
    visitor_.take(moment);
    takeNews(moment.step);
    clock_->advance(moment.step, visitor_);
    view_.seconds = moment.seconds;
    view_.utc = clock_->utc();
    view_.touched.reset();
    if (visitor_.there() && visitor_.pointer()) view_.touched = *visitor_.pointer() * kHalf;
    const glm::dvec3 eye(
        moment.eye.value_or(moment.installation ? moment.installation->eye : glm::vec3(0.0F, 0.5F, 0.5F)));
    view_.eye = glm::dvec3(glm::inverse(glm::dmat4(moment.worldFromDevice)) * glm::dvec4(eye, 1.0));
    lookUp();
    lookAhead();
    blow(moment.step);
    slosh(moment);
    turnFog(moment.step);
    thunder(moment.step);
    anticipation_.note(view_.seconds, view_.sea);
    followed_ = anticipation_.followed();

    ShowContent content;
    content.scene = scenery_.show(view_);
    content.assets = scenery_.assets();
    content.target = wish(causalLag(*moment.rig));
    content.following = Following::split;
    content.sounds = sounds();
    say();
    content.caption = caption_;
    return content;
}

/// A later forecast is read beside the show; one that cannot be read leaves the last.
void AmbientProgram::takeNews(double step) {
    if (!settings_.feed) return;
    // By the wall clock where there is one: a show that is not seen does not run.
    const double now = settings_.now ? settings_.now() : 0.0;
    newsAge_ += settings_.now ? std::max(0.0, now - std::exchange(agedUntil_, now)) : step;
    if (reading_.valid()) {
        if (reading_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
        std::shared_ptr<const Weather> weather = reading_.get();
        if (!weather) return;
        settings_.weather = std::move(weather);
        clock_->setDays(notableDays(*settings_.weather, settings_.place),
                        std::max(settings_.weather->begin(), settings_.begin.value_or(0.0)));
        newsAge_ = 0.0;
        day_ = 0.0, hour_ = -1.0; // all that was looked up
        return;
    }
    std::optional<DemoNews> news = settings_.feed("weather");
    if (!news) return;
    if (news->text.empty()) {
        newsAge_ = news->age;
        return;
    }
    reading_ = std::async(std::launch::async, [text = std::move(news->text)]() -> std::shared_ptr<const Weather> {
        try {
            return std::make_shared<const Weather>(readForecast(text, "a later forecast").weather);
        } catch (const Error&) {
            return nullptr;
        }
    });
}

/// A new line each hour where the day goes by in minutes, else each minute.
void AmbientProgram::say() {
    const double quantum = settings_.daySeconds < kSlowDay ? 3600.0 : 60.0;
    const double now = std::floor(view_.utc / quantum);
    if (caption_ && now == told_) return;
    told_ = now;
    caption_ = std::make_shared<const ShowCaption>(captionOf(view_, quantum, newsAge_));
}

/// Weather, sun and moon now, and the hours of the day at hand.
void AmbientProgram::lookUp() {
    view_.weather = settings_.weather->at(view_.utc);
    view_.snowLying = settings_.weather->snowLying(view_.utc);
    view_.sun = sunAt(settings_.place, view_.utc);
    if (std::abs(view_.utc - moonSeen_) > kMoonMoves) {
        moonSeen_ = view_.utc;
        view_.moon = moonAt(settings_.place, view_.utc);
    }
    const double midnight = localMidnight(settings_.place, view_.utc);
    if (midnight == day_) return;
    day_ = midnight;
    const double local = midnight + offsetAt(settings_.place, midnight); // of the clock, whose day has 24 hours
    for (std::size_t k = 0; k < view_.dayHours.size(); ++k) {
        const double then = utcOf(settings_.place, local + 3600.0 * static_cast<double>(k));
        view_.dayHours[k] = sunAt(settings_.place, then);
        view_.dayTemperatures[k] = settings_.weather->at(then).temperature;
    }
}

/// The next whole hours.
void AmbientProgram::lookAhead() {
    const double hour = 3600.0 * std::floor(view_.utc / 3600.0);
    for (std::size_t k = 0; k < view_.coming.size(); ++k) {
        const double then = hour + 3600.0 * static_cast<double>(k + 1);
        View::Coming& coming = view_.coming[k];
        coming.ahead = (then - view_.utc) / 3600.0;
        if (hour == hour_) continue;
        coming.weather = settings_.weather->at(then);
        coming.day = sunAt(settings_.place, then).elevation > kHorizon;
    }
    lookAtCards(hour_ < 0.0);
    hour_ = hour;
}

/// Every third hour of the place's clock, which need not be a whole one elsewhere.
void AmbientProgram::lookAtCards(bool otherWeather) {
    constexpr double kApart = 3600.0 * kCardHours;
    const Place& place = settings_.place;
    const auto number = static_cast<long long>(std::floor((view_.utc + offsetAt(place, view_.utc)) / kApart)) + 1;
    for (int k = 0; k < kCards; ++k) {
        View::Card& card = view_.cards[static_cast<std::size_t>(k)];
        const double then = utcOf(place, kApart * static_cast<double>(number + k));
        card.ahead = (then - view_.utc) / 3600.0;
        if (!otherWeather && number == cardNumber_) continue;
        card.slot = static_cast<int>((((number + k) % kCards) + kCards) % kCards);
        card.day = sunAt(place, then).elevation > kHorizon;
        card.weather = settings_.weather->at(then);
        for (const double beside : {-3600.0, 3600.0}) {
            const WeatherHour hour = settings_.weather->at(then + beside);
            card.weather.rain = std::max(card.weather.rain, hour.rain);
            card.weather.snow = std::max(card.weather.snow, hour.snow);
            card.weather.thunder = std::max(card.weather.thunder, hour.thunder);
        }
    }
    cardNumber_ = number;
}

/// Light's sea goes after the wind; clouds go with it.
void AmbientProgram::blow(double step) {
    const SeaState wind{view_.weather.windSpeed, onDevice(settings_.place, view_.weather.windFrom + std::numbers::pi)};
    view_.sea = between(view_.sea, wind, 1.0 - std::exp(-step / kWindSettles));
    view_.waves = sea_.waves(view_.sea, view_.seconds);
    view_.drifted += view_.sea.towards * (kCarriedByWind * (1.5 + view_.sea.wind) * step);
}

/// The sea stays level when a hand leans the coast: one more wave, so long that it is a slope.
void AmbientProgram::slosh(const ShowMoment& moment) {
    glm::dvec2 lean(0.0);
    for (const ShowBody& body : moment.bodies)
        if (body.role == PoseRole::device) lean = leanOf(moment.worldFromDevice);
    slosh_.advance(moment.step, lean);
    sloping_.clear();
    if (slosh_.rests()) return;
    const glm::dvec2& slope = slosh_.slope();
    const double amplitude = glm::length(slope) * kSlopeLength / (2.0 * std::numbers::pi);
    sloping_.push_back({amplitude, kSlopeLength, 0.0, Angle::radians(std::atan2(slope.y, slope.x)), Angle()});
    view_.waves.insert(view_.waves.end(), sloping_.begin(), sloping_.end());
}

/// Each bank keeps the drift with which it began, for what drifts at another speed would jump.
void AmbientProgram::turnFog(double step) {
    for (std::size_t k = 0; k < view_.fog.size(); ++k) {
        const double lives = view_.seconds / kFogLife + 0.5 * static_cast<double>(k);
        const double before = (view_.seconds - step) / kFogLife + 0.5 * static_cast<double>(k);
        if (step == 0.0 || std::floor(lives) > std::floor(before))
            view_.fog[k].drift = view_.sea.towards * (kFogByWind * (0.5 + view_.sea.wind));
        const double up = std::sin(std::numbers::pi * (lives - std::floor(lives)));
        view_.fog[k].share = up * up;
    }
}

void AmbientProgram::thunder(double step) {
    const auto share = [&] { return static_cast<double>(chance_() >> 11U) * 0x1p-53; };
    const double before = flashed_.value_or(kFlashSeconds);
    if (flashed_) *flashed_ += step;
    rumbles_ = flashed_ && before < kThunderAfter && *flashed_ >= kThunderAfter;
    if (flashed_ && *flashed_ > kFlashSeconds) flashed_.reset();
    if (!flashed_ && share() < kBoltsASecond * view_.weather.thunder * step) {
        flashed_ = 0.0;
        strength_ = 0.4 + 0.6 * share();
        view_.struck = {std::lerp(0.010, 0.098, share()), std::lerp(-0.068, 0.030, share())};
    }
    view_.lightning = flashed_ ? flashAt(*flashed_) : 0.0;
}

HeightGrid AmbientProgram::wish(double lag) const {
    HeightGrid grid = land_;
    std::vector<Wave> waves = sea_.slowWaves(followed_, view_.seconds, lag);
    // Who leans it expects it to move: no light has to go before.
    waves.insert(waves.end(), sloping_.begin(), sloping_.end());
    for (int j = 0; j < grid.rows; ++j) {
        for (int i = 0; i < grid.columns; ++i) {
            float& height = grid.heights[static_cast<std::size_t>(j) * static_cast<std::size_t>(grid.columns) +
                                         static_cast<std::size_t>(i)];
            height = std::max(height, static_cast<float>(kSeaLevel + heightOf(waves, placeAt(grid, i, j))));
        }
    }
    return grid;
}

std::vector<ShowSound> AmbientProgram::sounds() const {
    constexpr double kGale = 18.0, kDownpour = 8.0; // that sound loudest: metres a second, mm an hour
    const glm::vec3 overSea(0.05F, static_cast<float>(kSeaLevel), 0.02F);
    std::vector<ShowSound> sounds;
    sounds.push_back({"ambient.wind", std::min(1.0, view_.sea.wind / kGale), overSea});
    sounds.push_back({"ambient.wave", Sea::significantHeight(view_.sea.wind) / Sea::kMostHeight, overSea});
    if (view_.weather.rain > 0.0)
        sounds.push_back({"ambient.rain", std::min(1.0, view_.weather.rain / kDownpour), overSea});
    if (rumbles_) {
        const glm::dvec2& at = view_.struck;
        sounds.push_back({"ambient.thunder", strength_, glm::vec3(glm::dvec3(at.x, kSeaLevel, at.y))});
    }
    return sounds;
}

Demo ambientDemo() {
    return {
        .name = "ambient",
        .title = {"A coast that tells time and weather", "Eine Küste, die Zeit und Wetter zeigt"},
        .sentence = {"The lighthouse's shadow shows the hour, the sea the wind, and cards the hours to come.",
                     "Der Schatten des Leuchtturms zeigt die Stunde, das Meer den Wind, und Karten zeigen, was kommt."},
        .thumbnail = "thumbnails/ambient.png",
        .open = bundledTablet,
        .program = [](const ProgramStart& start, const Progress&) -> std::unique_ptr<ShowProgram> {
            AmbientSettings settings = settingsFrom(start.told);
            settings.feed = start.feed;
            // A forecast that is fetched again and again is that of the room: its clock is the room's own.
            if (settings.feed && !settings.now && !start.told.contains("clock") && !start.told.contains("begin") &&
                !start.told.contains("day"))
                takeRealClock(settings);
            return std::make_unique<AmbientProgram>(start.seed, std::move(settings));
        },
        .options = settingOptions()};
}

} // namespace lumorph::ambient
