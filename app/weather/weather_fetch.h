#pragma once

#include <filesystem>
#include <string>

namespace lumorph {

/// Whether a text is an address of the web, http or https.
[[nodiscard]] bool isWebAddress(const std::string& text);

/// What a server answers to a GET, at most 16 MiB; waits for it, no longer than `seconds` without a byte. Follows
/// redirections, but none from https to http. Needs a QCoreApplication. Throws InvalidInput for what is no address,
/// DeviceError where no answer comes or the server refuses; an error that the server explains (a status of 400 to 499
/// with a JSON body, as Open-Meteo's) is returned, for its reader knows more.
[[nodiscard]] std::string fetchWeather(const std::string& address, double seconds = 15.0);

/// Fetches a forecast as `fetchWeather` does into a file of the user's cache, the same each time, and gives its place.
/// Throws DeviceError where that cannot be written.
[[nodiscard]] std::filesystem::path fetchedForecast(const std::string& address);

} // namespace lumorph
