#include "app/weather/weather_fetch.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <span>
#include <system_error>

#include <QCryptographicHash>
#include <QEventLoop>
#include <QJsonDocument>
#include <QJsonObject>
#include <QNetworkAccessManager>
#include <QNetworkReply>
#include <QNetworkRequest>
#include <QStandardPaths>
#include <QTimer>
#include <QUrl>

#include "core/base/atomic_file.h"
#include "core/base/error.h"

namespace lumorph {
namespace {

constexpr qint64 kMostBytes = qint64{16} << 20;
constexpr std::chrono::milliseconds kStopEvery{50};
constexpr const char* kWaitRemedy = "look whether the network is there, or give a file";

QUrl urlOf(const std::string& address) {
    const QUrl url(QString::fromStdString(address), QUrl::StrictMode);
    if (!url.isValid() || url.host().isEmpty() || !isWebAddress(address))
        throw InvalidInput(address.substr(0, 200), "is no address of the web", "write https://api.open-meteo.com/...");
    return url;
}

/// Lets the reply come; aborts it where it is too large or its bytes come too slowly. Whether it was for its size.
bool waitFor(QNetworkReply& reply, double seconds, const std::stop_token& stop) {
    bool tooLarge = false;
    QEventLoop loop;
    QTimer silence;
    silence.setSingleShot(true);
    silence.setInterval(static_cast<int>(std::lround(1000.0 * seconds)));
    QObject::connect(&silence, &QTimer::timeout, &reply, &QNetworkReply::abort);
    QObject::connect(&reply, &QNetworkReply::downloadProgress, &loop, [&](qint64 received, qint64 total) {
        silence.start();
        if (received <= kMostBytes && total <= kMostBytes) return;
        tooLarge = true;
        reply.abort();
    });
    QObject::connect(&reply, &QNetworkReply::finished, &loop, &QEventLoop::quit);
    QTimer asks;
    QObject::connect(&asks, &QTimer::timeout, &reply, [&] {
        if (stop.stop_requested()) reply.abort();
    });
    if (stop.stop_possible()) asks.start(kStopEvery);
    silence.start();
    if (!reply.isFinished()) loop.exec();
    return tooLarge;
}

/// Where the forecast of an address is kept: names of files have no room for the address itself.
std::filesystem::path cacheOf(const std::string& address) {
    const QByteArray bytes = QByteArray::fromStdString(address);
    const QByteArray name = QCryptographicHash::hash(bytes, QCryptographicHash::Sha256).toHex().left(16);
    const std::filesystem::path cache =
        QStandardPaths::writableLocation(QStandardPaths::GenericCacheLocation).toStdString();
    return cache / "lumorph" / ("forecast-" + name.toStdString() + ".json");
}

} // namespace

bool isRefusal(const std::string& answer) {
    const QJsonDocument json = QJsonDocument::fromJson(QByteArray::fromStdString(answer));
    return !json.isObject() || json.object().value("error").toBool();
}

bool isWebAddress(const std::string& text) { return text.starts_with("http://") || text.starts_with("https://"); }

std::string fetchWeather(const std::string& address, double seconds, const std::stop_token& stop) {
    QNetworkRequest request(urlOf(address));
    request.setHeader(QNetworkRequest::UserAgentHeader, QStringLiteral("Lumorph"));
    QNetworkAccessManager manager;
    const std::unique_ptr<QNetworkReply> reply(manager.get(request));
    if (waitFor(*reply, seconds, stop))
        throw DataError(address, "its answer is larger than 16 MiB", "ask for fewer days");
    const int status = reply->attribute(QNetworkRequest::HttpStatusCodeAttribute).toInt();
    const QByteArray body = reply->isOpen() ? reply->readAll() : QByteArray(); // one that was aborted is closed
    if (status >= 400 && status < 500 && body.trimmed().startsWith('{')) return body.toStdString();
    if (status >= 400)
        throw DeviceError(address, "the server answers with status " + std::to_string(status), "correct the address");
    if (reply->error() == QNetworkReply::OperationCanceledError)
        throw DeviceError(address, "no answer came in time", kWaitRemedy);
    if (reply->error() != QNetworkReply::NoError)
        throw DeviceError(address, reply->errorString().toStdString(), kWaitRemedy);
    return body.toStdString();
}

std::filesystem::path keepForecast(const std::string& address, const std::string& answer) {
    const std::filesystem::path file = cacheOf(address);
    std::error_code failed; // the writer names it
    std::filesystem::create_directories(file.parent_path(), failed);
    writeFileAtomically(file, std::as_bytes(std::span(answer)));
    return file;
}

CachedForecast fetchedForecast(const std::string& address, double seconds) {
    const std::filesystem::path kept = cacheOf(address);
    std::error_code none;
    const auto written = std::filesystem::last_write_time(kept, none);
    const auto last = [&](std::string problem) -> CachedForecast {
        const auto age = std::filesystem::file_time_type::clock::now() - written;
        return {kept, std::max(0.0, std::chrono::duration<double>(age).count()), std::move(problem)};
    };
    try {
        const std::string answer = fetchWeather(address, seconds);
        if (!isRefusal(answer)) return {keepForecast(address, answer), 0.0, {}};
        // An address that brought one before is refused for a while: too many have asked, or a network wants a log-in.
        if (!none) return last(address + ": it is no forecast that has come");
        const std::filesystem::path refused = cacheOf(address + " refused"); // whose reader names the reason
        std::filesystem::create_directories(refused.parent_path(), none);
        writeFileAtomically(refused, std::as_bytes(std::span(answer)));
        return {refused, 0.0, {}};
    } catch (const DeviceError& error) {
        if (none) throw;
        return last(error.what());
    }
}

} // namespace lumorph
