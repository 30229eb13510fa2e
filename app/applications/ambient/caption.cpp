#include "app/applications/ambient/caption.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

namespace lumorph::ambient {
namespace {

constexpr double kOldForecast = 3600.0; ///< seconds from which on its age is said
constexpr double kWet = 0.1;            ///< mm of rain, or cm of snow, an hour

Words joined(const Words& first, const char* between, const Words& second) {
    return {first.english + between + second.english,
            first.in(Language::german) + between + second.in(Language::german)};
}

/// Of a local time, 1970-01-01 having been a Thursday.
Words dayName(double local) {
    static const std::array<Words, 7> kDays{{{"Thursday", "Donnerstag"},
                                             {"Friday", "Freitag"},
                                             {"Saturday", "Samstag"},
                                             {"Sunday", "Sonntag"},
                                             {"Monday", "Montag"},
                                             {"Tuesday", "Dienstag"},
                                             {"Wednesday", "Mittwoch"}}};
    const auto day = static_cast<long long>(std::floor(local / 86'400.0)) % 7;
    return kDays[static_cast<std::size_t>(day < 0 ? day + 7 : day)];
}

std::string clockText(double local) {
    const auto minutes = static_cast<long long>(std::floor(local / 60.0));
    const long long ofDay = ((minutes % 1440) + 1440) % 1440;
    std::array<char, 24> text{};
    std::snprintf(text.data(), text.size(), "%lld:%02lld", ofDay / 60, ofDay % 60);
    return text.data();
}

enum class Falls { nothing, rain, snow, thunder };

Falls fallsIn(const WeatherHour& hour) {
    if (hour.thunder > 0.5) return Falls::thunder;
    if (hour.snow > kWet && hour.snow > hour.rain) return Falls::snow;
    return hour.rain > kWet ? Falls::rain : Falls::nothing;
}

Words skyOf(const WeatherHour& hour) {
    switch (fallsIn(hour)) {
    case Falls::thunder:
        return {"thunderstorm", "Gewitter"};
    case Falls::snow:
        return {"snow", "Schnee"};
    case Falls::rain:
        return {"rain", "Regen"};
    default:
        break;
    }
    if (hour.visibility < 1000.0) return {"fog", "Nebel"};
    if (hour.cloudCover > 0.8) return {"overcast", "bedeckt"};
    if (hour.cloudCover > 0.35) return {"cloudy", "wolkig"};
    return {"clear", "klar"};
}

Words windFrom(double bearing) {
    static const std::array<Words, 8> kFrom{{{"north", "Nord"},
                                             {"northeast", "Nordost"},
                                             {"east", "Ost"},
                                             {"southeast", "Südost"},
                                             {"south", "Süd"},
                                             {"southwest", "Südwest"},
                                             {"west", "West"},
                                             {"northwest", "Nordwest"}}};
    const auto eighth = std::lround(bearing / (std::numbers::pi / 4.0));
    return kFrom[static_cast<std::size_t>(((eighth % 8) + 8) % 8)];
}

/// The first hour to come in which something else falls than now.
Words comingOf(const View& view) {
    const Falls now = fallsIn(view.weather);
    const auto change =
        std::ranges::find_if(view.coming, [&](const View::Coming& hour) { return fallsIn(hour.weather) != now; });
    if (change == view.coming.end())
        return now == Falls::nothing ? Words{"It stays dry.", "Es bleibt trocken."}
                                     : Words{"It goes on like that.", "So bleibt es."};
    const double then = view.utc + 3600.0 * change->ahead;
    const std::string at = clockText(then + offsetAt(view.place, then) + 1.0); // whole hours, give or take the last bit
    if (fallsIn(change->weather) == Falls::nothing) return {"Dry from " + at + ".", "Trocken ab " + at + "."};
    Words what = skyOf(change->weather);
    what.english.front() = static_cast<char>(what.english.front() - 'a' + 'A');
    return {what.english + " from " + at + ".", what.german + " ab " + at + "."};
}

Words ageOf(double seconds) {
    const std::string hours = std::to_string(std::lround(seconds / 3600.0));
    return {"The forecast is " + hours + (hours == "1" ? " hour old." : " hours old."),
            "Die Vorhersage ist " + hours + (hours == "1" ? " Stunde alt." : " Stunden alt.")};
}

} // namespace

ShowCaption captionOf(const View& view, double quantum, double forecastAge) {
    const double local = view.utc + offsetAt(view.place, view.utc);
    const double told = quantum * std::floor(local / quantum);
    const WeatherHour& now = view.weather;
    const std::string degrees = std::to_string(std::lround(now.temperature)) + " \u00B0C, ";
    const Words coming = comingOf(view), sky = skyOf(now), from = windFrom(now.windFrom);
    const std::string speed = std::to_string(std::lround(now.windSpeed)) + " m/s";
    const Words wind = now.windSpeed < 0.5 ? Words{"no wind", "windstill"}
                                           : Words{"wind " + speed + " from the " + from.english,
                                                   "Wind " + speed + " aus " + from.german};
    ShowCaption caption;
    caption.title = joined(dayName(told), ", ", Words(clockText(told)));
    caption.sentence = joined(joined(joined(Words(degrees), "", sky), ", ", wind), ". ", coming);
    if (forecastAge >= kOldForecast) caption.sentence = joined(caption.sentence, " ", ageOf(forecastAge));
    return caption;
}

} // namespace lumorph::ambient
