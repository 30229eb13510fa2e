#include <charconv>
#include <chrono>
#include <string>

#include "app/applications/ambient/ambient.h"
#include "app/applications/ambient/weather_file.h"
#include "core/base/error.h"

namespace lumorph::ambient {
namespace {

double secondsOf(const std::string& name, const std::string& text) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size())
        throw InvalidInput(name, "'" + text.substr(0, 40) + "' is no number", "give seconds");
    return value;
}

double localBegin(const std::string& text, const Place& place) {
    const std::optional<double> local = timeFrom(text, 0.0);
    if (!local) throw InvalidInput("begin", "'" + text.substr(0, 40) + "' is no time", "write it as 2026-05-17T14:00");
    return utcOf(place, *local);
}

void takeClock(AmbientSettings& settings, const std::string& text) {
    if (text != "real" && text != "quick")
        throw InvalidInput("clock", "'" + text.substr(0, 40) + "' is no clock", "say real or quick");
    if (text == "real") takeRealClock(settings);
}

} // namespace

void takeRealClock(AmbientSettings& settings) {
    settings.daySeconds = 86'400.0;
    settings.now = [] {
        return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
    };
}

std::vector<DemoOption> settingOptions() {
    return {
        {"weather",
         "Of ambient: a forecast in Open-Meteo's JSON, a file or an http(s) address",
         {"Weather", "Wetter"},
         {"file or address of a forecast (Open-Meteo's JSON)", "Datei oder Adresse (JSON von Open-Meteo)"},
         true},
        {"place",
         "Of ambient: LAT,LON or LAT,LON,HOURS ahead of UTC",
         {"Place", "Ort"},
         {"latitude,longitude,hours ahead of UTC: 48.1,11.6,2", "Breite,Länge,Stunden vor UTC: 48.1,11.6,2"}},
        {"begin",
         "Of ambient: its first time, 2026-05-17T14:00 at the place",
         {"First time", "Erste Zeit"},
         {"2026-05-17T14:00", "2026-05-17T14:00"}},
        {"day",
         "Of ambient: seconds that a day takes; 86400 is the world's own time",
         {"Length of a day", "Dauer eines Tages"},
         {"seconds; 86400 is the world's own time", "Sekunden; 86400 ist die wirkliche Zeit"}},
        {"clock",
         "Of ambient: 'real' for the room's own time, 'quick' for a day in minutes",
         {"Clock", "Uhr"},
         {"real: the room's own time; quick: a day in minutes", "real: die wirkliche Zeit; quick: ein Tag in Minuten"}},
        {"anticipation",
         "Of ambient: seconds by which light is ahead of the servos",
         {"Light ahead of servos", "Licht vor den Servos"},
         {"seconds", "Sekunden"}}};
}

AmbientSettings settingsFrom(const DemoTold& settings) {
    AmbientSettings read;
    // The place first: weather may bring another, and times are of the place.
    if (const auto weather = settings.find("weather"); weather != settings.end()) {
        Forecast forecast = readForecastFile(weather->second);
        read.place = forecast.place.value_or(read.place);
        read.begin = forecast.weather.begin();
        read.weather = std::make_shared<const Weather>(std::move(forecast.weather));
    }
    if (const auto place = settings.find("place"); place != settings.end()) read.place = placeFrom(place->second);
    for (const auto& [name, text] : settings) {
        if (name == "begin")
            read.begin = localBegin(text, read.place);
        else if (name == "day")
            read.daySeconds = secondsOf(name, text);
        else if (name == "clock")
            takeClock(read, text);
        else if (name == "anticipation")
            read.anticipation = secondsOf(name, text);
        else if (name != "weather" && name != "place")
            throw InvalidInput("setting '" + name.substr(0, 40) + "'", "the coast has none of this name",
                               "use weather, place, begin, day, clock or anticipation");
    }
    for (const char* other : {"begin", "day"})
        if (read.now && settings.contains(other))
            throw InvalidInput("setting 'clock'",
                               std::string("the room's own time leaves no choice of '") + other + "'",
                               "leave one of them out");
    return read;
}

} // namespace lumorph::ambient
