#include "app/weather/forecast_watch.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "app/weather/weather_fetch.h"
#include "core/base/error.h"

namespace lumorph {

ForecastWatch::ForecastWatch(std::string address, bool isNew, const WatchTimes& times)
    : address_(std::move(address)), times_(times), wait_(isNew ? times.every : times.firstTry),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

ForecastWatch::~ForecastWatch() { thread_.request_stop(); }

void ForecastWatch::run(const std::stop_token& stop) {
    for (;;) {
        {
            std::unique_lock lock(mutex_);
            woken_.wait_for(lock, stop, std::chrono::duration<double>(wait_), [] { return false; });
        }
        if (stop.stop_requested()) return;
        const bool came = fetch(stop);
        const std::scoped_lock lock(mutex_);
        failures_ = came ? 0 : failures_ + 1;
        wait_ =
            came ? times_.every : std::min(times_.longest, std::ldexp(times_.firstTry, std::min(failures_ - 1, 20)));
    }
}

bool ForecastWatch::fetch(const std::stop_token& stop) {
    try {
        std::string text = fetchWeather(address_, times_.silence, stop);
        if (isRefusal(text)) return false;
        try {
            keepForecast(address_, text);
        } catch (const DeviceError&) { // a full disk: it shows all the same
        }
        const std::scoped_lock lock(mutex_);
        news_ = std::move(text);
        return true;
    } catch (const Error&) { // the last one goes on
        return false;
    }
}

std::optional<std::string> ForecastWatch::take() {
    const std::unique_lock lock(mutex_, std::try_to_lock);
    return lock ? std::exchange(news_, std::nullopt) : std::nullopt;
}

int ForecastWatch::failures() const {
    const std::scoped_lock lock(mutex_);
    return failures_;
}

} // namespace lumorph
