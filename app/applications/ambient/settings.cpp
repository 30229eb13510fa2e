#include <charconv>
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
    const std::optional<double> time = timeFrom(text, place.utcOffset);
    if (!time) throw InvalidInput("begin", "'" + text.substr(0, 40) + "' is no time", "write it as 2026-05-17T14:00");
    return *time;
}

} // namespace

AmbientSettings settingsFrom(const DemoSettings& settings) {
    AmbientSettings read;
    // The place first: weather may bring another, and times are of the place.
    if (const auto weather = settings.find("weather"); weather != settings.end()) {
        const auto text = settings.find("forecast");
        Forecast forecast =
            text == settings.end() ? readForecastFile(weather->second) : readForecast(text->second, weather->second);
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
        else if (name == "anticipation")
            read.anticipation = secondsOf(name, text);
        else if (name != "weather" && name != "forecast" && name != "place")
            throw InvalidInput("setting '" + name.substr(0, 40) + "'", "the coast has none of this name",
                               "use weather, place, begin, day or anticipation");
    }
    return read;
}

} // namespace lumorph::ambient
