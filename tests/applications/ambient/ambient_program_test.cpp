#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "app/applications/ambient/ambient.h"
#include "app/applications/ambient/coming.h"
#include "app/applications/ambient/simulated_year.h"
#include "core/base/error.h"
#include "core/base/resources.h"
#include "core/motion/causal_split.h"
#include "core/motion/frequency_split.h"
#include "core/motion/surface_heights.h"
#include "core/show/show_player.h"
#include "tests/support/program_visit.h"

// R37, R38: the ambient display as visitors meet it: what is seen, heard and felt, what comes first, and what it costs.

namespace lumorph::ambient {
namespace {

using test::tabletRig;
using Visit = test::ProgramVisit;
using test::kFrame;

/// Weather of one kind for a day and more.
AmbientSettings constant(const WeatherHour& hour) {
    AmbientSettings settings;
    settings.weather = std::make_shared<const Weather>(1'780'000'000.0, std::vector<WeatherHour>(72, hour));
    return settings;
}

WeatherHour windy(double speed) {
    WeatherHour hour;
    hour.windSpeed = speed;
    return hour;
}

int shownAmong(const Scene& scene, int first, int count) {
    int shown = 0;
    for (int k = 0; k < count; ++k) shown += findItem(scene, first + k)->visible ? 1 : 0;
    return shown;
}

TEST(AmbientProgram, SaysDayWeatherAndWhatComesToWhoWantsToReadIt) {
    std::vector<WeatherHour> hours(72, windy(7.4));
    for (std::size_t k = 0; k < hours.size(); ++k) {
        hours[k].temperature = 11.6;
        hours[k].cloudCover = 0.5;
        hours[k].windFrom = 4.71; // west
        hours[k].rain = k >= 10 ? 3.0 : 0.0;
    }
    AmbientSettings settings;
    settings.weather = std::make_shared<const Weather>(1'780'000'000.0, hours);
    settings.begin = 1'780'012'800.0; // Friday 2026-05-29, 0:00 UTC
    settings.daySeconds = 86'400.0;
    AmbientProgram program(1, settings);
    Visit visit(program, 0.5);
    visit.frame();
    double rains = *settings.begin;
    while (program.weather().at(rains).rain < 0.1) rains += 3600.0;
    const std::string hour = std::to_string(std::lround((rains - *settings.begin) / 3600.0) + 1) + ":00";
    ASSERT_TRUE(visit.content().caption);
    EXPECT_EQ(visit.content().caption->title.english, "Friday, 1:00");
    EXPECT_EQ(visit.content().caption->title.german, "Freitag, 1:00");
    EXPECT_EQ(visit.content().caption->sentence.english,
              "12 \u00B0C, cloudy, wind 7 m/s from the west. Rain from " + hour + ".");
    EXPECT_EQ(visit.content().caption->sentence.german,
              "12 \u00B0C, wolkig, Wind 7 m/s aus West. Regen ab " + hour + ".");
    const auto first = visit.content().caption;
    visit.frames(20.0);
    EXPECT_EQ(visit.content().caption, first) << "the same object within its minute";
    visit.frames(45.0);
    EXPECT_EQ(visit.content().caption->title.english, "Friday, 1:01");
}

TEST(AmbientProgram, ShowsEveryNotableDayByItself) {
    AmbientSettings settings;
    settings.daySeconds = 20.0;
    AmbientProgram program(1, settings);
    Visit visit(program);
    const std::vector<double> days = notableDays(program.weather(), settings.place);
    std::vector<bool> seen(days.size(), false);
    bool snowed = false, rained = false, fogged = false;
    for (int k = 0; k < 60 * 100; ++k) {
        visit.frame();
        if (k % 10 != 0) continue;
        ASSERT_NO_THROW(checkScene(*visit.content().scene)) << k;
        ASSERT_NO_THROW(checkHeightGrid(std::get<HeightGrid>(visit.content().target))) << k;
        const double today = localMidnight(settings.place, program.clock().utc());
        for (std::size_t d = 0; d < days.size(); ++d) seen[d] = seen[d] || days[d] == today;
        const Scene& scene = *visit.content().scene;
        snowed = snowed || (shownAmong(scene, kFirstFlakes, kFlakeLayers) > 0 && visit.item(kLandSnow).visible);
        rained =
            rained || (shownAmong(scene, kFirstRain, kRainLayers) > 0 && shownAmong(scene, kFirstRing, kRings) > 3);
        fogged = fogged || visit.item(kFirstFog).visible;
    }
    EXPECT_EQ(std::ranges::count(seen, true), std::ssize(days));
    EXPECT_TRUE(snowed);
    EXPECT_TRUE(rained);
    EXPECT_TRUE(fogged);
    EXPECT_GE(visit.heard("ambient.thunder"), 2);
    EXPECT_GT(visit.heard("ambient.rain"), 100);
    EXPECT_EQ(visit.heard("ambient.wind"), 60 * 100);
    EXPECT_EQ(visit.heard("ambient.wave"), 60 * 100);
}

TEST(AmbientProgram, KeysLetTimeRunFasterBackToAnotherDayAndToNow) {
    AmbientProgram program(1);
    Visit visit(program);
    visit.frame();
    const double begin = program.clock().utc();
    visit.frames(1.0);
    EXPECT_NEAR(program.clock().utc() - begin, 720.0, 15.0) << "a day in two minutes";
    visit.frame({{"key.right", 1.0}});
    visit.frames(1.0);
    EXPECT_GT(program.clock().utc() - begin, 720.0 + 0.9 * 8.0 * 720.0);
    visit.frame({{"key.right", 0.0}, {"key.left", 1.0}});
    visit.frames(0.5);
    EXPECT_LT(program.clock().speed(), 0.0) << "back";
    visit.frame({{"key.left", 0.0}});
    visit.frame({{"key.next", 1.0}});
    const std::vector<double> days = notableDays(program.weather(), {});
    EXPECT_EQ(localMidnight({}, program.clock().utc()), days[1]);
    visit.frame({{"key.restart", 1.0}});
    EXPECT_EQ(program.clock().utc(), begin);
}

TEST(AmbientProgram, AVisitorsPointerMakesRings) {
    AmbientProgram program(1, constant(windy(2.0)));
    Visit visit(program);
    visit.frames(0.1);
    EXPECT_EQ(shownAmong(*visit.content().scene, kFirstRing, kRings), 0) << "it does not rain";
    visit.frame({{"pointer.x", 0.5}, {"pointer.y", 0.5}});
    visit.frames(1.0);
    const SceneItem& ring = visit.item(kFirstRing + kRings - 1);
    EXPECT_TRUE(ring.visible);
    EXPECT_LT(glm::distance(glm::dvec2(ring.position.x, ring.position.z), glm::dvec2(0.0525, 0.0375)), 1e-4);
    EXPECT_NEAR(ring.position.y, kSeaLevel, 0.01);
}

// At each whole hour by day the shadow of the lighthouse points at the stone of the hour.
TEST(AmbientProgram, TheShadowOfTheLighthouseTellsTheHour) {
    for (const char* where : {"52.52,13.405", "-33.87,151.21", "64.15,-21.94"}) {
        AmbientSettings settings;
        settings.place = placeFrom(where);
        settings.daySeconds = 24.0 / 20.0; // an hour in three frames
        settings.begin = *timeFrom("2026-04-20T05:00", settings.place.utcOffset);
        AmbientProgram program(1, settings);
        Visit visit(program);
        visit.frame();
        int looked = 0;
        for (int hour = 5; hour <= 20; ++hour, visit.frames(3.0 * kFrame)) {
            ASSERT_NEAR(localHour(settings.place, program.view().utc), hour, 1e-6);
            if (program.view().sun.elevation < 0.07) continue;
            const glm::dvec3 light(visit.item(kKeyLight).position);
            const glm::dvec2 shadow = -glm::normalize(glm::dvec2(light.x, light.z));
            const glm::dvec3 stone(visit.item(kFirstStone + hour).position);
            const glm::dvec2 at = glm::dvec2(stone.x, stone.z) - kGnomon;
            EXPECT_NEAR(glm::length(at), kDialRadius, 1e-6);
            EXPECT_GT(glm::dot(glm::normalize(at), shadow), std::cos(0.01)) << where << " at " << hour;
            ++looked;
        }
        EXPECT_GE(looked, 9) << where;
    }
}

TEST(AmbientProgram, NightIsDarkAndItsLampBurns) {
    AmbientSettings settings = constant({});
    settings.daySeconds = 24.0 / 20.0;
    settings.begin = *timeFrom("2026-06-03T00:00", settings.place.utcOffset);
    AmbientProgram program(1, settings);
    Visit visit(program);
    visit.frame();
    const auto light = [&] {
        const auto& lamp = std::get<LightItem>(visit.item(kKeyLight).kind);
        return lamp.intensity + static_cast<double>(glm::length(visit.content().scene->sky));
    };
    const double midnight = light();
    EXPECT_TRUE(visit.item(kBeam).visible);
    visit.frames(12 * 3 * kFrame);
    EXPECT_GT(light(), 4.0 * midnight);
    EXPECT_FALSE(visit.item(kBeam).visible);
}

TEST(AmbientProgram, FogAndCloudsDriftWithTheWind) {
    WeatherHour foggy = windy(3.0);
    foggy.windFrom = 1.2;
    foggy.visibility = 200.0;
    foggy.cloudCover = 1.0;
    AmbientProgram program(1, constant(foggy));
    Visit visit(program);
    visit.frames(1.0);
    const glm::dvec2 towards = onDevice({}, 1.2 + 3.14159265358979);
    for (int k = 0; k < kFogs; ++k) {
        const glm::vec2 drift = std::get<FogItem>(visit.item(kFirstFog + k).kind).drift;
        EXPECT_GT(glm::dot(glm::normalize(glm::dvec2(drift)), towards), 0.9999);
        EXPECT_GT(glm::length(drift), 0.005F);
    }
    EXPECT_NEAR(static_cast<double>(visit.item(kFirstFog).opacity + visit.item(kFirstFog + 1).opacity), 1.0, 0.02)
        << "one comes as the other goes";
    EXPECT_GT(glm::dot(program.view().drifted, towards), 0.003);
}

TEST(AmbientProgram, FogStaysOnTheDeviceAndFillsLowPlacesFirst) {
    float before = 0.0F;
    for (const double visibility : {4000.0, 2000.0, 300.0}) {
        WeatherHour hour;
        hour.visibility = visibility;
        AmbientProgram program(1, constant(hour));
        Visit visit(program);
        visit.frames(7.0); // one of the banks is full
        float top = 0.0F;
        for (int k = 0; k < kFogs; ++k) {
            const SceneItem& item = visit.item(kFirstFog + k);
            const auto& fog = std::get<FogItem>(item.kind);
            EXPECT_LT(std::abs(item.position.x) + 0.5F * fog.size.x, 0.105F);
            EXPECT_LT(std::abs(item.position.z) + 0.5F * fog.size.z, 0.075F);
            EXPECT_LT(item.position.y - 0.5F * fog.size.y, static_cast<float>(kSeaLevel)) << "it lies on the water";
            top = std::max(top, item.position.y + 0.5F * fog.size.y);
        }
        EXPECT_GT(top, before) << "the thicker, the higher";
        before = top;
    }
}

TEST(AmbientProgram, TheCardsTellOfEveryThirdHourOfTheForecast) {
    std::vector<WeatherHour> hours(48);
    for (std::size_t k = 0; k < hours.size(); ++k) {
        hours[k].temperature = static_cast<double>(k) - 14.4;
        hours[k].rain = k == 14 ? 5.0 : 0.0;
    }
    AmbientSettings settings;
    settings.weather = std::make_shared<const Weather>(*timeFrom("2026-05-17T00:00", 3600.0), hours);
    settings.begin = timeFrom("2026-05-17T09:30", 3600.0);
    settings.place.utcOffset = 3600.0;
    AmbientProgram program(1, settings);
    Visit visit(program);
    visit.frame();
    const auto itemOfCard = [&](int k) {
        return visit.item(kFirstCard + program.view().cards[static_cast<std::size_t>(k)].slot);
    };
    float before = -1.0F;
    for (int k = 0; k < kCards; ++k) {
        const View::Card& card = program.view().cards[static_cast<std::size_t>(k)];
        EXPECT_NEAR(card.ahead, 2.5 + 3.0 * k, 1e-9);
        const ForecastCard says = cardOf(program.view(), card);
        EXPECT_EQ(says.hour, (12 + 3 * k) % 24);
        EXPECT_EQ(says.degrees, std::lround(12.0 + 3.0 * k - 14.4));
        EXPECT_EQ(says.sign == WeatherSign::rain, k == 1) << "a shower at 14 is told at 15";
        EXPECT_GT(itemOfCard(k).position.x, before) << "the nearest first";
        before = itemOfCard(k).position.x;
    }
    const float apart = itemOfCard(1).position.x - itemOfCard(0).position.x;
    EXPECT_GT(apart, Coming::kCardWidth) << "none hides another";
    const float from = itemOfCard(0).position.x;
    visit.frames(1.0);
    EXPECT_LT(itemOfCard(0).position.x, from) << "it comes nearer";
}

TEST(AmbientForecastCard, SaysTheWorstOfTheWeather) {
    WeatherHour hour;
    hour.cloudCover = 0.1;
    EXPECT_EQ(signOf(hour, true), WeatherSign::sun);
    EXPECT_EQ(signOf(hour, false), WeatherSign::moon);
    hour.cloudCover = 0.5;
    EXPECT_EQ(signOf(hour, true), WeatherSign::sunAndCloud);
    hour.cloudCover = 0.9;
    EXPECT_EQ(signOf(hour, true), WeatherSign::cloud);
    hour.visibility = 300.0;
    EXPECT_EQ(signOf(hour, true), WeatherSign::fog);
    hour.rain = 0.5;
    EXPECT_EQ(signOf(hour, true), WeatherSign::rain);
    hour.snow = 1.0;
    EXPECT_EQ(signOf(hour, true), WeatherSign::snow);
    hour.thunder = 1.0;
    EXPECT_EQ(signOf(hour, true), WeatherSign::thunder);
}

// Legible means contrast: what is written is at least seven times as light as its plate (WCAG 2, level AAA).
TEST(AmbientForecastCard, WritesWithTheContrastOfAAndEverySignDiffers) {
    const Font font(resourceFile("fonts/Inter-SemiBold.otf"));
    const auto light = [](const Image::Pixel& pixel) {
        const auto linear = [](std::uint8_t byte) {
            const double share = byte / 255.0;
            return share <= 0.04045 ? share / 12.92 : std::pow((share + 0.055) / 1.055, 2.4);
        };
        return 0.2126 * linear(pixel[0]) + 0.7152 * linear(pixel[1]) + 0.0722 * linear(pixel[2]);
    };
    std::vector<Image> pictures;
    for (const WeatherSign sign :
         {WeatherSign::sun, WeatherSign::moon, WeatherSign::sunAndCloud, WeatherSign::moonAndCloud, WeatherSign::cloud,
          WeatherSign::fog, WeatherSign::rain, WeatherSign::snow, WeatherSign::thunder}) {
        pictures.push_back(pictureOf({sign, 14, -8}, font));
        const Image& picture = pictures.back();
        double most = 0.0;
        int inSign = 0, inWords = 0;
        for (int y = 0; y < kCardPixels.y; ++y)
            for (int x = 0; x < kCardPixels.x; ++x) {
                const double here = light(picture.at(x, y));
                most = std::max(most, here);
                const bool bright = here > 0.1;
                (y > 52 && y < 148 ? inSign : inWords) += bright ? 1 : 0;
            }
        const double plate = light(picture.at(kCardPixels.x / 2, 5));
        EXPECT_GT((most + 0.05) / (plate + 0.05), 7.0);
        EXPECT_GT(inSign, 500);
        EXPECT_GT(inWords, 700);
        EXPECT_EQ(picture.at(0, 0)[3], 0) << "round corners";
        for (std::size_t k = 0; k + 1 < pictures.size(); ++k) EXPECT_NE(pictures[k], picture);
    }
}

std::string forecastText(double degrees) {
    return R"({"hourly": {"time": ["2026-07-01T00:00"], "temperature_2m": [)" + std::to_string(degrees) +
           R"(], "precipitation": [0], "cloud_cover": [0], "wind_speed_10m": [3.6], "wind_direction_10m": [0]}})";
}

TEST(AmbientProgram, ALaterForecastTakesThePlaceOfTheLastAndItsAgeIsSaid) {
    AmbientSettings settings = constant(WeatherHour{});
    std::optional<DemoNews> next = DemoNews{{}, 3.0 * 3600.0};
    settings.feed = [&](const std::string& option) {
        EXPECT_EQ(option, "weather");
        return std::exchange(next, std::nullopt);
    };
    AmbientProgram program(1, settings);
    Visit visit(program);
    visit.frame();
    ASSERT_TRUE(visit.content().caption);
    EXPECT_NE(visit.content().caption->sentence.english.find("The forecast is 3 hours old."), std::string::npos);
    EXPECT_NE(visit.content().caption->sentence.in(Language::german).find("3 Stunden alt"), std::string::npos);
    EXPECT_EQ(program.view().weather.temperature, 15.0);
    const auto until = [&](double degrees) {
        for (int k = 0; k < 2000 && program.view().weather.temperature != degrees; ++k) {
            visit.frame();
            std::this_thread::yield();
        }
        return program.view().weather.temperature;
    };
    next = DemoNews{"no forecast at all", 0.0};
    visit.frames(0.5);
    EXPECT_EQ(program.view().weather.temperature, 15.0) << "the last one goes on";
    EXPECT_GT(program.forecastAge(), 3.0 * 3600.0);
    next = DemoNews{forecastText(21.5), 0.0};
    EXPECT_EQ(until(21.5), 21.5);
    EXPECT_LT(program.forecastAge(), 60.0);
    EXPECT_EQ(program.view().cards.front().weather.temperature, 21.5) << "cards too";
    EXPECT_LT(std::abs(program.view().utc - 1'782'864'000.0), 100'000.0) << "its own days are shown, July 1st";
}

TEST(AmbientProgram, AForecastAgesByTheClockAlsoWhileTheShowRests) {
    AmbientSettings settings = constant(WeatherHour{});
    double now = 1'780'050'000.0;
    settings.now = [&now] { return now; };
    settings.feed = [](const std::string&) { return std::nullopt; };
    AmbientProgram program(1, settings);
    Visit visit(program);
    visit.frame();
    EXPECT_EQ(program.forecastAge(), 0.0);
    now += 3600.0 * 7.0; // the machine has slept
    visit.frame();
    EXPECT_DOUBLE_EQ(program.forecastAge(), 3600.0 * 7.0);
    now -= 3600.0; // somebody has set its clock
    visit.frame();
    EXPECT_DOUBLE_EQ(program.forecastAge(), 3600.0 * 7.0);
}

TEST(AmbientProgram, AForecastThatComesAgainAndAgainIsShownByTheRealClock) {
    const DemoFeed feed = [](const std::string&) { return std::nullopt; };
    const auto begunAt = [](DemoTold told, DemoFeed fed) {
        const auto program =
            ambientDemo().program(ProgramStart{.seed = 1, .told = std::move(told), .feed = std::move(fed)}, {});
        Visit(*program).frame();
        return dynamic_cast<const AmbientProgram&>(*program).view().utc;
    };
    const double now = std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
    EXPECT_NEAR(begunAt({}, feed), now, 60.0);
    EXPECT_GT(std::abs(begunAt({}, {}) - now), 3600.0) << "a simulated year has no now";
    EXPECT_NEAR(begunAt({{"begin", "2026-05-17T14:00"}}, feed), *timeFrom("2026-05-17T13:00", 0.0), 600.0);
    EXPECT_NEAR(begunAt({{"clock", "quick"}, {"begin", "2026-05-17T14:00"}}, feed), *timeFrom("2026-05-17T13:00", 0.0),
                600.0);
}

TEST(AmbientProgram, WhatNobodyFetchesGetsNoOlder) {
    AmbientProgram program(1, constant(WeatherHour{}));
    Visit(program).frames(5.0);
    EXPECT_EQ(program.forecastAge(), 0.0);
}

TEST(AmbientProgram, TheRealClockIsShownAndReturnedTo) {
    AmbientSettings settings = constant(WeatherHour{});
    double now = 1'780'050'000.0;
    settings.now = [&now] { return now; };
    settings.daySeconds = 86'400.0;
    AmbientProgram program(1, settings);
    Visit visit(program);
    visit.frame();
    EXPECT_DOUBLE_EQ(program.view().utc, now);
    now += 3600.0 * 7.0; // the machine has slept
    visit.frames(8.0);
    EXPECT_NEAR(program.view().utc, now, 1.0);
    visit.frame({{"key.left", 1.0}});
    visit.frames(2.0);
    EXPECT_LT(program.view().utc, now - 3600.0) << "a visitor looks at the hours before";
    visit.frame({{"key.left", 0.0}});
    visit.frames(Visitor::kSilence + 8.0);
    EXPECT_NEAR(program.view().utc, now, 1.0);
    EXPECT_EQ(settingsFrom({{"clock", "real"}}).daySeconds, 86'400.0);
    EXPECT_TRUE(settingsFrom({{"clock", "real"}}).now);
    EXPECT_FALSE(settingsFrom({}).now) << "the quick day is the usual one";
    EXPECT_THROW((void)settingsFrom({{"clock", "slow"}}), InvalidInput);
}

TEST(AmbientProgram, RefusesSettingsThatAreNone) {
    for (const DemoTold& wrong : {DemoTold{{"place", "here"}},
                                  {{"begin", "noon"}},
                                  {{"day", "0"}},
                                  {{"day", "x"}},
                                  {{"anticipation", "-1"}},
                                  {{"anticipation", "1s"}},
                                  {{"colour", "red"}},
                                  {{"weather", "/none.json"}}})
        EXPECT_THROW(AmbientProgram(1, settingsFrom(wrong)), Error) << wrong.begin()->first;
    const AmbientSettings read = settingsFrom({{"place", "48.2,16.4,2"}, {"begin", "2026-05-17T12:00"}, {"day", "60"}});
    EXPECT_EQ(read.begin, timeFrom("2026-05-17T10:00", 0.0));
    EXPECT_EQ(read.daySeconds, 60.0);
}

TEST(AmbientProgram, TheSameSeedAndInputsAreTheSameShow) {
    AmbientProgram a(5), b(5);
    Visit first(a), second(b);
    for (int k = 0; k < 400; ++k) {
        std::vector<ShowInput> inputs;
        if (k == 50 || k == 150) inputs.push_back({"key.next", 1.0});
        first.frame(inputs);
        second.frame(inputs);
        if (k % 40 == 0) {
            ASSERT_EQ(*first.content().scene, *second.content().scene) << k;
        }
        ASSERT_EQ(std::get<HeightGrid>(first.content().target).heights,
                  std::get<HeightGrid>(second.content().target).heights);
    }
}

MatchWish wishFor(std::shared_ptr<ShowProgram> program) {
    MatchWish wish;
    wish.rig = tabletRig();
    wish.strokes.assign(wish.rig->actuatorCount(), 0.0);
    wish.installation = std::make_shared<const Installation>(defaultInstallation());
    wish.program = std::move(program);
    wish.inputs = std::make_shared<ShowInputs>();
    wish.driver = Driver::program;
    return wish;
}

// In a recording of the loop with a change of weather and in one without: when light differs first, and when servos do.
TEST(AmbientProgram, LightIsAheadOfTheServosByTheAnticipationInARecording) {
    for (const double delay : {0.5, 2.0}) {
        const auto record = [&](bool changes) {
            AmbientSettings settings;
            settings.anticipation = delay;
            ManualClock clock;
            ShowPlayer player(clock, wishFor(std::make_shared<AmbientProgram>(1, settings)));
            std::vector<std::shared_ptr<const MatchFrame>> frames;
            for (int k = 0; k < 60 * 4; ++k) {
                if (changes && k == 60) player.wish().inputs->push({"key.next", 1.0});
                frames.push_back(player.step());
            }
            return frames;
        };
        const auto calm = record(false), changed = record(true);
        const auto wavesOf = [](const MatchFrame& frame) {
            return std::get<HeightItem>(findItem(*frame.scene, kSea)->kind).waves;
        };
        double seen = -1.0, felt = -1.0;
        for (std::size_t k = 0; k < calm.size(); ++k) {
            if (seen < 0.0 && wavesOf(*calm[k]) != wavesOf(*changed[k])) seen = changed[k]->programSeconds;
            if (felt < 0.0 && calm[k]->splitStrokes != changed[k]->splitStrokes) felt = changed[k]->programSeconds;
        }
        ASSERT_GE(seen, 0.9);
        ASSERT_GE(felt, seen);
        RecordProperty("delay", std::to_string(felt - seen));
        EXPECT_NEAR(felt - seen, delay, kFrame + 1e-6);
    }
}

TEST(AmbientProgram, ItsProgramSaysWhatLightShowsAndWhatServosFollow) {
    AmbientProgram program(1);
    Visit visit(program);
    std::vector<SeaState> shown;
    for (int k = 0; k < 60 * 8; ++k) {
        visit.frame(k == 120 ? std::vector<ShowInput>{{"key.next", 1.0}} : std::vector<ShowInput>{});
        shown.push_back(program.view().sea);
        const std::size_t then = k < 120 ? 0 : static_cast<std::size_t>(k - 120);
        if (k >= 120) {
            ASSERT_NEAR(program.followed().wind, shown[then].wind, 0.02 + 0.02 * shown[then].wind) << k;
        }
    }
}

/// What light shows over the points of a split: sea and land.
void shownHeights(const View& view, std::span<const glm::vec2> points, std::span<float> out) {
    for (std::size_t p = 0; p < points.size(); ++p) {
        const glm::dvec2 at(points[p]);
        out[p] = static_cast<float>(std::max(landHeight(at), kSeaLevel + heightOf(view.waves, at)));
    }
}

/// What moves of series of heights, one series a point: sums over all points and times.
struct Motion {
    double energy = 0.0, kept = 0.0;
};
Motion motionOf(const std::vector<std::vector<float>>& ideal, const std::vector<std::vector<float>>& ours) {
    Motion motion;
    for (std::size_t p = 0; p < ideal.front().size(); ++p) {
        double a = 0.0, b = 0.0, aa = 0.0, ab = 0.0;
        for (std::size_t k = 0; k < ideal.size(); ++k) {
            const auto x = static_cast<double>(ideal[k][p]), y = static_cast<double>(ours[k][p]);
            a += x;
            b += y;
            aa += x * x;
            ab += x * y;
        }
        const auto count = static_cast<double>(ideal.size());
        motion.energy += aa - a * a / count;
        motion.kept += ab - a * b / count;
    }
    return motion;
}

struct Felt {
    double kept = 0.0;        ///< of the motion that the rig could show of what light shows, looking ahead
    double correlation = 0.0; ///< of what moves: the device with light off, and the slow heights that are wished
};

Felt feltIn(const WeatherHour& weather) {
    AmbientProgram program(1, constant(weather));
    Visit visit(program);
    FrequencySplit ideal(*tabletRig());
    CausalSplit causal(*tabletRig());
    SurfaceHeights reader(causal.points());
    std::vector<std::vector<float>> bests, devices, wishes;
    std::vector<float> heights(causal.points().size());
    // The ideal one asks for the waves of other times as well: with steady weather they are known.
    const Sea sea(1);
    const auto wishAt = [&](double t, std::span<float> out) {
        View then = program.view();
        then.waves = sea.waves(then.sea, t);
        shownHeights(then, ideal.points(), out);
    };
    for (int k = 0; k < 60 * 16; ++k) {
        visit.frame();
        const auto& grid = std::get<HeightGrid>(visit.content().target);
        for (std::size_t p = 0; p < heights.size(); ++p)
            heights[p] = static_cast<float>(heightAt(grid, glm::dvec2(causal.points()[p])));
        const std::vector<double> strokes = causal.strokes(heights, k == 0 ? 0.0 : kFrame);
        if (k < 60 * 4 || k % 6 != 0) continue;
        std::vector<float> device(causal.restHeights().begin(), causal.restHeights().end());
        const std::vector<double> best = ideal.strokes(wishAt, program.view().seconds);
        std::vector<float> bestDevice(device.size());
        ideal.heights(best, bestDevice);
        ideal.heights(strokes, device);
        View slow = program.view();
        std::erase_if(slow.waves, [](const Wave& wave) { return wave.length < Sea::kServoLength; });
        shownHeights(slow, causal.points(), heights);
        bests.push_back(bestDevice);
        devices.push_back(device);
        wishes.push_back(heights);
    }
    const Motion motion = motionOf(bests, devices);
    const Motion wished = motionOf(wishes, wishes), felt = motionOf(devices, devices), both = motionOf(wishes, devices);
    return {motion.kept / motion.energy, both.kept / std::sqrt(wished.energy * felt.energy)};
}

TEST(AmbientProgram, ServosKeepTheSlowEnergyOfTheWavesThatTheTabletReaches) {
    for (const double wind : {8.0, 16.0}) {
        const Felt felt = feltIn(windy(wind));
        std::printf("wind %.0f m/s: kept %.3f, height correlation %.3f\n", wind, felt.kept, felt.correlation);
        EXPECT_GE(felt.kept, 0.9) << wind;
        EXPECT_LE(felt.kept, 1.25) << wind;
        EXPECT_GT(felt.correlation, 0.5) << wind << " m/s: what hands feel with the light off";
    }
}

TEST(AmbientProgram, AFrameTakesASmallPartOfItsTime) {
    AmbientProgram program(1);
    Visit visit(program);
    std::vector<double> milliseconds;
    for (int k = 0; k < 60 * 60; ++k) {
        const double begun = test::threadSeconds();
        visit.frame(k % 600 == 300 ? std::vector<ShowInput>{{"key.next", 1.0}} : std::vector<ShowInput>{});
        milliseconds.push_back(1e3 * (test::threadSeconds() - begun));
    }
    EXPECT_LE(test::shareOf(milliseconds, 0.5), 2.0);
    EXPECT_LE(test::shareOf(milliseconds, 0.99), 8.0);
}

// Half an hour with visitors who come, press and go; k counts tenths of a second.
TEST(AmbientProgram, HalfAnHourKeepsItsMemoryAndTheLimitsOfTheServos) {
    AmbientProgram program(3);
    const test::LongVisit visit = test::visitForLong(program, 1800.0, 0.1, [](int k, double, ShowInputs& inputs) {
        if (k % 700 == 200) inputs.push({"key.next", 1.0});
        if (k % 700 == 300) inputs.push({"key.right", 1.0});
        if (k % 700 == 330) inputs.push({"key.right", 0.0});
        if (k % 1900 == 1000) inputs.push({"key.restart", 1.0});
        if (k % 50 == 0 && k % 1900 < 800) inputs.push({"pointer.x", std::sin(0.01 * k)});
    });
    test::expectSteady(visit);
    EXPECT_GT(visit.fastest, 0.05) << "they did move";
}

} // namespace
} // namespace lumorph::ambient
