#pragma once

#include <filesystem>
#include <stop_token>
#include <string>

namespace lumorph {

/// Whether a text is an address of the web, http or https.
[[nodiscard]] bool isWebAddress(const std::string& text);

/// Whether an answer is no forecast: an error that the service explains, or the page of a network that wants a log-in.
[[nodiscard]] bool isRefusal(const std::string& answer);

/// What a server answers to a GET, at most 16 MiB; waits for it, no longer than `seconds` without a byte, nor after
/// `stop`. Follows
/// redirections, but none from https to http. Needs a QCoreApplication. Throws InvalidInput for what is no address,
/// DeviceError where no answer comes or the server refuses; an error that the server explains (a status of 400 to 499
/// with a JSON body, as Open-Meteo's) is returned, for its reader knows more.
[[nodiscard]] std::string fetchWeather(const std::string& address, double seconds = 15.0,
                                       const std::stop_token& stop = {});

/// A forecast in a file of the user's cache.
struct CachedForecast {
    std::filesystem::path file;
    double age = 0.0;    ///< seconds since it came
    std::string problem; ///< why it is not a new one; empty: it is
};

/// Fetches a forecast as `fetchWeather` does into a file of the user's cache, for each address the same. Where none
/// comes, the one that came last from there is given. Throws as fetchWeather where there is none either, and
/// DeviceError where it cannot be written.
[[nodiscard]] CachedForecast fetchedForecast(const std::string& address, double seconds = 15.0);

/// Writes a forecast where `fetchedForecast` looks for it. Throws DeviceError.
std::filesystem::path keepForecast(const std::string& address, const std::string& answer);

} // namespace lumorph
