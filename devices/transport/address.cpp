#include "devices/transport/address.h"

#include <QRegularExpression>
#include <QUrl>
#include <QUrlQuery>

#include "core/base/error.h"

namespace lumorph {

namespace {

[[noreturn]] void refuse(std::string_view uri, const std::string& why) {
    throw InvalidInput("device address '" + std::string(uri) + "'", why,
                       "write serial:///dev/NAME?baud=N, bt://MAC, hid://VENDOR:PRODUCT or sim://NAME");
}

SerialAddress parseSerial(std::string_view uri, const QUrl& url, const QUrlQuery& query) {
    SerialAddress address{url.path(QUrl::FullyDecoded).toStdString()};
    if (address.path.size() < 2 || address.path.find('\0') != std::string::npos || !url.host().isEmpty())
        refuse(uri, "a serial address needs a path such as /dev/ttyUSB0");
    if (query.hasQueryItem("baud")) {
        bool isNumber = false;
        address.baud = query.queryItemValue("baud").toInt(&isNumber);
        if (!isNumber || address.baud < 300 || address.baud > 4'000'000)
            refuse(uri, "the baud rate must be 300 to 4000000");
    }
    return address;
}

/// A misspelt option would be a wrong one that nobody notices.
void refuseOptionsBut(const QString& known, std::string_view uri, const QUrlQuery& query) {
    for (const auto& [key, value] : query.queryItems())
        if (key != known) refuse(uri, "it has no option '" + key.toStdString() + "'");
}

} // namespace

DeviceAddress parseDeviceAddress(std::string_view uri) {
    const QString text = QString::fromUtf8(uri.data(), static_cast<qsizetype>(uri.size()));
    const QUrlQuery query(text.section('?', 1));
    const QString scheme = text.section("://", 0, 0);
    const QString target = text.section("://", 1).section('?', 0, 0);
    if (scheme == "serial") refuseOptionsBut("baud", uri, query);
    if (scheme == "hid") refuseOptionsBut("product", uri, query);
    if (scheme == "bt") refuseOptionsBut({}, uri, query);
    if (scheme == "serial") return parseSerial(uri, QUrl(text), query);
    if (scheme == "bt") {
        static const QRegularExpression mac("^([0-9A-Fa-f]{2}:){5}[0-9A-Fa-f]{2}$");
        if (!mac.match(target).hasMatch()) refuse(uri, "a Bluetooth address is six pairs of hexadecimal digits");
        return BluetoothAddress{target.toUpper().toStdString()};
    }
    if (scheme == "hid") {
        static const QRegularExpression ids("^([0-9A-Fa-f]{4}):([0-9A-Fa-f]{4})$");
        const QRegularExpressionMatch match = ids.match(target);
        if (!match.hasMatch()) refuse(uri, "a HID address is two groups of four hexadecimal digits");
        return HidAddress{match.captured(1).toUShort(nullptr, 16), match.captured(2).toUShort(nullptr, 16),
                          query.queryItemValue("product", QUrl::FullyDecoded).toStdString()};
    }
    if (scheme == "sim") {
        if (target.isEmpty()) refuse(uri, "a simulated device needs a name");
        SimulatedAddress address{target.toStdString(), {}};
        for (const auto& [key, value] : query.queryItems(QUrl::FullyDecoded))
            address.options[key.toStdString()] = value.toStdString();
        return address;
    }
    refuse(uri, "its scheme is unknown");
}

} // namespace lumorph
