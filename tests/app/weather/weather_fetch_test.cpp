#include "app/weather/weather_fetch.h"

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>

#include <QCoreApplication>
#include <QElapsedTimer>
#include <QTcpServer>
#include <QTcpSocket>
#include <QTemporaryDir>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/applications/ambient/weather_file.h"
#include "app/weather/forecast_watch.h"
#include "core/base/error.h"

// Weather over a network, from a server of the test's own: answers, refusals, silence and rubbish.

namespace lumorph {
namespace {

using ::testing::HasSubstr;

const char* const kForecast =
    R"({"latitude": 1.0, "longitude": 2.0, "hourly": {"time": ["2026-07-01T00:00"], "temperature_2m": [9.5],
        "precipitation": [0], "cloud_cover": [0], "wind_speed_10m": [3.6], "wind_direction_10m": [0]}})";

/// Gives every request the same answer, byte by byte as it is; an empty one: it keeps silent.
class WeatherFetch : public ::testing::Test {
protected:
    WeatherFetch() {
        QObject::connect(&server_, &QTcpServer::newConnection, &server_, [this] {
            QTcpSocket* socket = server_.nextPendingConnection();
            QObject::connect(socket, &QTcpSocket::readyRead, socket, [this, socket] {
                asked_ += socket->readAll();
                if (answer_.isEmpty() || !asked_.contains("\r\n\r\n")) return;
                socket->write(answer_);
                socket->disconnectFromHost();
            });
        });
        EXPECT_TRUE(server_.listen(QHostAddress::LocalHost));
    }
    void answer(const char* status, const QByteArray& body) {
        answer_ = QByteArray("HTTP/1.1 ") + status +
                  "\r\nConnection: close\r\nContent-Length: " + QByteArray::number(body.size()) + "\r\n\r\n" + body;
    }
    [[nodiscard]] std::string address() const {
        return "http://127.0.0.1:" + std::to_string(server_.serverPort()) + "/v1/forecast?latitude=1";
    }
    void expectNoAnswer(const char* says) {
        try {
            (void)fetchWeather(address(), 0.3);
            ADD_FAILURE() << says;
        } catch (const DeviceError& error) {
            EXPECT_EQ(error.subject(), address());
            EXPECT_THAT(error.what(), HasSubstr(says));
        }
    }

    int count_ = 1;
    char name_[5] = "test";
    char* words_[2] = {name_, nullptr};
    QCoreApplication application_{count_, words_};
    QTcpServer server_;
    QByteArray answer_, asked_;
};

TEST_F(WeatherFetch, BringsAForecast) {
    answer("200 OK", kForecast);
    const std::string text = fetchWeather(address());
    EXPECT_TRUE(asked_.startsWith("GET /v1/forecast?latitude=1 HTTP/1.1"));
    EXPECT_EQ(ambient::readForecast(text, address()).weather.hours().front().temperature, 9.5);
}

TEST_F(WeatherFetch, TellsARefusalAndTheServicesOwnReason) {
    answer("404 Not Found", "<html>no</html>");
    expectNoAnswer("status 404");
    answer("500 Internal Server Error", "{}");
    expectNoAnswer("status 500");
    answer("400 Bad Request", R"({"error": true, "reason": "Latitude must be in range"})");
    try {
        (void)ambient::readForecast(fetchWeather(address()), address());
        ADD_FAILURE();
    } catch (const DataError& error) {
        EXPECT_THAT(error.what(), HasSubstr("Latitude must be in range"));
    }
}

TEST_F(WeatherFetch, RubbishIsNoForecast) {
    answer("200 OK", QByteArray("\0\xff{[not json", 13));
    EXPECT_THROW((void)ambient::readForecast(fetchWeather(address()), address()), DataError);
    answer("200 OK", QByteArray());
    EXPECT_THROW((void)ambient::readForecast(fetchWeather(address()), address()), DataError);
    answer_ = "what is HTTP?";
    EXPECT_THROW((void)ambient::readForecast(fetchWeather(address()), address()), Error);
}

TEST_F(WeatherFetch, WaitsForSilenceNoLongerThanItIsTold) {
    QElapsedTimer timer;
    timer.start();
    expectNoAnswer("no answer came in time");
    EXPECT_GE(timer.elapsed(), 250);
    EXPECT_LT(timer.elapsed(), 5000);
    answer_ = "HTTP/1.1 200 OK\r\nContent-Length: 900000000\r\n\r\n{";
    EXPECT_THROW((void)fetchWeather(address(), 0.5), Error) << "larger than any forecast";
}

TEST_F(WeatherFetch, NobodyThereAndNoAddress) {
    server_.close();
    EXPECT_THROW((void)fetchWeather("http://127.0.0.1:1/", 2.0), DeviceError);
    for (const char* wrong : {"", "forecast.json", "ftp://example.org/", "http://", "https:///x"})
        EXPECT_THROW((void)fetchWeather(wrong), InvalidInput) << wrong;
    EXPECT_TRUE(isWebAddress("https://api.open-meteo.com/v1/forecast"));
    EXPECT_FALSE(isWebAddress("https.json"));
}

/// With a cache of the test's own.
class ForecastKept : public WeatherFetch {
protected:
    ForecastKept() { qputenv("XDG_CACHE_HOME", cache_.path().toUtf8()); }
    ~ForecastKept() override { qunsetenv("XDG_CACHE_HOME"); }
    /// Lets the server answer for so long, or until it is as wanted.
    template <typename Wanted> bool within(double seconds, const Wanted& wanted) {
        QElapsedTimer timer;
        for (timer.start(); timer.elapsed() < 1000.0 * seconds;) {
            if (wanted()) return true;
            QCoreApplication::processEvents(QEventLoop::AllEvents, 5);
        }
        return wanted();
    }
    QTemporaryDir cache_;
};

TEST_F(ForecastKept, TheLastOneShowsWhereNoneComes) {
    answer("503 Service Unavailable", "");
    EXPECT_THROW((void)fetchedForecast(address(), 0.5), DeviceError) << "there is none yet";
    answer("200 OK", kForecast);
    const CachedForecast first = fetchedForecast(address(), 0.5);
    EXPECT_TRUE(first.problem.empty());
    EXPECT_EQ(ambient::readForecastFile(first.file).weather.hours().front().temperature, 9.5);
    answer("503 Service Unavailable", "");
    std::filesystem::last_write_time(first.file, std::filesystem::file_time_type::clock::now() - std::chrono::hours(2));
    const CachedForecast again = fetchedForecast(address(), 0.5);
    EXPECT_EQ(again.file, first.file);
    EXPECT_NEAR(again.age, 7200.0, 5.0);
    EXPECT_THAT(again.problem, HasSubstr("status 503"));
    EXPECT_THROW((void)fetchedForecast(address() + "&longitude=3", 0.5), DeviceError) << "that is another place";
    // What the service explains is no forecast, and neither is a network's log-in: they do not replace one.
    for (const auto& [status, body] :
         {std::pair{"429 Too Many Requests", R"({"error": true, "reason": "too many have asked"})"},
          {"200 OK", "<html>log in</html>"}}) {
        answer(status, body);
        const CachedForecast refused = fetchedForecast(address(), 0.5);
        EXPECT_EQ(refused.file, first.file);
        EXPECT_FALSE(refused.problem.empty());
    }
    answer("400 Bad Request", R"({"error": true, "reason": "Latitude must be in range"})");
    EXPECT_THROW((void)ambient::readForecastFile(fetchedForecast(address() + "&latitude=91", 0.5).file), DataError)
        << "where there is none yet the reason is said";
    EXPECT_EQ(ambient::readForecastFile(first.file).weather.hours().front().temperature, 9.5);
}

TEST_F(ForecastKept, IsFetchedAgainAndTriedAgainAfterFailures) {
    answer("200 OK", kForecast);
    ForecastWatch watch(address(), true, {0.05, 0.02, 0.06, 1.0});
    EXPECT_FALSE(watch.take()) << "nothing yet, and no waiting for it";
    std::optional<std::string> news;
    const auto comes = [&] { return (news = watch.take()).has_value(); };
    ASSERT_TRUE(within(3.0, comes));
    EXPECT_EQ(*news, kForecast);
    ASSERT_TRUE(within(3.0, comes)) << "and again";
    answer("500 Internal Server Error", "");
    ASSERT_TRUE(within(3.0, [&] { return watch.failures() >= 3; }));
    (void)watch.take();
    EXPECT_FALSE(watch.take()) << "a failure is no news";
    answer("429 Too Many Requests", R"({"error": true, "reason": "too many have asked"})");
    const int before = watch.failures();
    ASSERT_TRUE(within(3.0, [&] { return watch.failures() >= before + 2; })) << "a refusal is a failure";
    EXPECT_FALSE(watch.take()) << "and no news either";
    answer("200 OK", kForecast);
    ASSERT_TRUE(within(3.0, comes)) << "after failures it is tried again";
    EXPECT_EQ(watch.failures(), 0);
}

TEST_F(ForecastKept, AfterAFailureTheFirstTryComesSoon) {
    answer("200 OK", kForecast);
    ForecastWatch watch(address(), false, {600.0, 0.02, 600.0, 1.0});
    EXPECT_TRUE(within(3.0, [&] { return watch.take().has_value(); }));
}

TEST_F(ForecastKept, AWatchEndsAtOnceWhileAServerIsSilent) {
    QElapsedTimer timer;
    {
        ForecastWatch watch(address(), true, {0.01, 0.01, 0.01, 30.0});
        EXPECT_TRUE(within(3.0, [&] { return asked_.contains("GET"); }));
        timer.start();
    }
    EXPECT_LT(timer.elapsed(), 1000);
}

} // namespace
} // namespace lumorph
