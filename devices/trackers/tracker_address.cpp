#include "devices/trackers/tracker_address.h"

#include <QHostAddress>
#include <QUrlQuery>

#include "core/base/error.h"

namespace lumorph {

namespace {

/// The parts of one URI, taken one after the other; what is left at the end is a mistake of the one who wrote it.
class Parts {
public:
    explicit Parts(std::string_view uri) : uri_(uri) {
        const QString text = QString::fromUtf8(uri.data(), static_cast<qsizetype>(uri.size()));
        scheme_ = text.section("://", 0, 0);
        const QString rest = text.contains("://") ? text.section("://", 1) : QString();
        target_ = rest.section('?', 0, 0);
        if (target_.endsWith('/')) target_.chop(1);
        query_ = QUrlQuery(rest.section('?', 1));
    }

    [[noreturn]] void refuse(const std::string& why) const {
        throw InvalidInput("tracker address '" + uri_ + "'", why,
                           "write natnet://HOST?mode=multicast, opentrack://127.0.0.1:4242, osc://127.0.0.1:9000 or "
                           "sim://head");
    }

    [[nodiscard]] const QString& scheme() const { return scheme_; }
    [[nodiscard]] const QString& target() const { return target_; }

    QString text(const char* key, const QString& otherwise) {
        if (!query_.hasQueryItem(key)) return otherwise;
        const QString value = query_.queryItemValue(key, QUrl::FullyDecoded);
        query_.removeQueryItem(key);
        return value;
    }

    double number(const char* key, double otherwise, double least, double most) {
        bool isNumber = false;
        const double value = text(key, QString::number(otherwise)).toDouble(&isNumber);
        if (!isNumber || !(value >= least && value <= most))
            refuse(std::string(key) + " must be " + QString::number(least).toStdString() + " to " +
                   QString::number(most).toStdString());
        return value;
    }

    [[nodiscard]] std::uint16_t port(const QString& text) const {
        bool isNumber = false;
        const uint value = text.toUInt(&isNumber);
        if (!isNumber || value == 0 || value > 65535) refuse("a port must be 1 to 65535");
        return static_cast<std::uint16_t>(value);
    }

    std::uint16_t port(const char* key, int otherwise) { return port(text(key, QString::number(otherwise))); }

    [[nodiscard]] std::string machine(const QString& text) const {
        if (text == "localhost") return "127.0.0.1";
        const QHostAddress address(text);
        // Short forms such as "10.1" would be taken too, and mean something else than they seem to.
        if (address.protocol() != QAbstractSocket::IPv4Protocol || address.toString() != text)
            refuse("a machine is named by its four numbers, such as 192.168.0.5");
        return text.toStdString();
    }

    void expectNothingMore() const {
        if (!query_.isEmpty())
            refuse("nothing is known of '" + query_.queryItems().constFirst().first.toStdString() + "'");
    }

private:
    std::string uri_;
    QString scheme_;
    QString target_;
    QUrlQuery query_;
};

natnet::Version parseVersion(const Parts& parts, const QString& text) {
    bool isMajor = false;
    bool isMinor = false;
    const natnet::Version version{text.section('.', 0, 0).toInt(&isMajor), text.section('.', 1).toInt(&isMinor)};
    if (!isMajor || !isMinor || version < natnet::Version{2, 5} || version.major > 9 || version.minor > 99)
        parts.refuse("version must be one such as 2.10 or 4.1");
    return version;
}

NatNetAddress parseNatNet(Parts& parts) {
    NatNetAddress address;
    address.host = parts.machine(parts.target());
    const QString mode = parts.text("mode", "multicast");
    if (mode != "multicast" && mode != "unicast") parts.refuse("mode is unicast or multicast");
    address.multicast = mode == "multicast";
    address.command = parts.port("command", address.command);
    const QString data = parts.text("data", {});
    address.dataGiven = !data.isEmpty();
    if (address.dataGiven) address.data = parts.port(data);
    const QString local = parts.text("local", {});
    if (!local.isEmpty()) address.local = parts.machine(local);
    address.group = parts.machine(parts.text("multicast", QString::fromStdString(address.group)));
    if (!QHostAddress(QString::fromStdString(address.group)).isMulticast())
        parts.refuse("multicast must be a multicast group, such as 239.255.42.99");
    const QString version = parts.text("version", {});
    if (!version.isEmpty()) address.version = parseVersion(parts, version);
    return address;
}

template <typename Address> Address parseListener(Parts& parts) {
    Address address;
    address.local = parts.machine(parts.target().section(':', 0, 0));
    const QString port = parts.target().section(':', 1);
    if (parts.target().contains(':')) address.port = parts.port(port);
    return address;
}

SimulatedBodyAddress parseSimulated(Parts& parts) {
    SimulatedBodyAddress address;
    address.body = parts.target().toStdString();
    if (address.body != "head" && address.body != "device" && address.body != "pointer")
        parts.refuse("a simulated body is head, device or pointer");
    address.noiseMillimetres = parts.number("noise", 0.0, 0.0, 1000.0);
    address.dropShare = parts.number("drop", 0.0, 0.0, 1.0);
    address.latencyMilliseconds = parts.number("latency", 0.0, 0.0, 1000.0);
    address.rateHertz = parts.number("rate", address.rateHertz, 1.0, 1000.0);
    return address;
}

TrackerAddress parseAny(Parts& parts) {
    if (parts.scheme() == "natnet") return parseNatNet(parts);
    if (parts.scheme() == "opentrack") return parseListener<OpenTrackAddress>(parts);
    if (parts.scheme() == "osc") return parseListener<OscAddress>(parts);
    if (parts.scheme() == "sim") return parseSimulated(parts);
    parts.refuse("its scheme is unknown");
}

} // namespace

TrackerAddress parseTrackerAddress(std::string_view uri) {
    Parts parts(uri);
    TrackerAddress address = parseAny(parts);
    parts.expectNothingMore();
    return address;
}

} // namespace lumorph
