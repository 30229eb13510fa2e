#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace lumorph {

/// When a forecast is fetched again, seconds.
struct WatchTimes {
    double every = 1800.0;   ///< after one that came
    double firstTry = 60.0;  ///< after a failure; twice as long after each further one
    double longest = 1800.0; ///< between two tries
    double silence = 15.0;   ///< as of fetchWeather
};

/// Fetches a forecast again and again, in a thread of its own, as long as it lives. Each that comes also lies where
/// `fetchedForecast` keeps it. Needs a QCoreApplication.
class ForecastWatch {
public:
    /// Begins with one that has just come, or, not `isNew`, as after a failure.
    explicit ForecastWatch(std::string address, bool isNew = true, const WatchTimes& times = {});
    ~ForecastWatch(); ///< at once, whatever is on its way

    /// The text of one that has come since this was asked last; never waits.
    [[nodiscard]] std::optional<std::string> take();
    /// How often it has failed since one came.
    [[nodiscard]] int failures() const;

private:
    void run(const std::stop_token& stop);
    [[nodiscard]] bool fetch(const std::stop_token& stop);

    const std::string address_;
    const WatchTimes times_;
    double wait_; ///< seconds until the next try
    mutable std::mutex mutex_;
    std::condition_variable_any woken_;
    std::optional<std::string> news_;
    int failures_ = 0;
    std::jthread thread_; ///< last: it uses all others
};

} // namespace lumorph
