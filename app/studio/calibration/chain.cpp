#include "app/studio/calibration/chain.h"

#include <algorithm>

#include <QDateTime>
#include <QLocale>
#include <QObject>

namespace lumorph::studio {
namespace {

std::size_t placeOf(LinkId id) {
    const auto& links = chainLinks();
    return static_cast<std::size_t>(std::ranges::find(links, id, &ChainLink::id) - links.begin());
}

QString dateText(const std::string& date) {
    const QDateTime time = QDateTime::fromString(QString::fromStdString(date), Qt::ISODate).toLocalTime();
    return time.isValid() ? QLocale::c().toString(time, "d MMMM, hh:mm") : QString();
}

QString measuredText(const Origin& origin) {
    const QString method = QString::fromStdString(origin.method), date = dateText(origin.date);
    if (method.isEmpty()) return date;
    return date.isEmpty() ? method : method + ", " + date;
}

/// Alone, whatever those before it are.
LinkStand ownStand(const ChainLink& link, const Installation& room, const LastCheck& checked) {
    if (isCheck(link))
        return checked.date.empty()
                   ? LinkStand{LinkStand::How::open, {}}
                   : LinkStand{checked.isSimulated ? LinkStand::How::simulated : LinkStand::How::measured,
                               QObject::tr("still good, %1").arg(dateText(checked.date))};
    const Origin* origin = originOf(link, room);
    if (origin == nullptr) return {};
    // What was put in doubt says why.
    if (origin->way == Origin::Way::assumed) return {LinkStand::How::open, QString::fromStdString(origin->method)};
    if (origin->way == Origin::Way::entered) return {LinkStand::How::entered, QObject::tr("entered by hand")};
    return {origin->way == Origin::Way::simulated ? LinkStand::How::simulated : LinkStand::How::measured,
            measuredText(*origin)};
}

bool isWantedIn(const ChainLink& link, const Installation& room) { return !link.isWanted || link.isWanted(room); }

/// Where several projectors are measured together, what builds on one of them builds on that.
LinkId needIn(LinkId need, const Installation& room) {
    const bool isTogether = need == LinkId::projector && isWantedIn(chainLinks()[placeOf(LinkId::room)], room);
    return isTogether ? LinkId::room : need;
}

std::string dateOf(const ChainLink& link, const Installation& room, const LastCheck& checked) {
    if (isCheck(link)) return checked.date;
    const Origin* origin = originOf(link, room);
    return origin && origin->isCalibrated() ? origin->date : std::string();
}

} // namespace

std::vector<LinkStand> standsOf(const Installation& room, const LastCheck& checked) {
    const auto& links = chainLinks();
    std::vector<LinkStand> stands;
    for (const ChainLink& link : links) {
        LinkStand stand = ownStand(link, room, checked);
        if (stand.how == LinkStand::How::open && needIn(link.id, room) != link.id)
            stand = {LinkStand::How::spare, QObject::tr("one alone; the next measures all together")};
        if (!isWantedIn(link, room)) {
            if (stand.how == LinkStand::How::open || link.id == LinkId::room) stand = {LinkStand::How::spare, {}};
            stands.push_back(std::move(stand));
            continue;
        }
        for (const LinkId own : link.needs) {
            const LinkId need = needIn(own, room);
            const std::size_t place = placeOf(need);
            const LinkStand::How before = stands[place].how;
            if (stand.how == LinkStand::How::open &&
                (before == LinkStand::How::open || before == LinkStand::How::waits)) {
                stand = {LinkStand::How::waits, QObject::tr("after %1").arg(links[place].title.toLower())};
                break;
            }
            // Dates of one form are in the order of their texts.
            if ((stand.how == LinkStand::How::measured || stand.how == LinkStand::How::simulated) &&
                dateOf(links[place], room, checked) > dateOf(link, room, checked)) {
                stand = {LinkStand::How::stale, QObject::tr("%1 was measured after it").arg(links[place].title)};
                break;
            }
        }
        stands.push_back(std::move(stand));
    }
    return stands;
}

std::optional<std::size_t> nextLink(const std::vector<LinkStand>& stands) {
    const auto wanted = [](const LinkStand& stand) {
        return stand.how == LinkStand::How::open || stand.how == LinkStand::How::stale;
    };
    const auto found = std::ranges::find_if(stands, wanted);
    if (found == stands.end()) return std::nullopt;
    return static_cast<std::size_t>(found - stands.begin());
}

InstallationVersion versionOf(const ChainLink& link, const LinkOutcome& outcome, const Installation& room) {
    InstallationVersion version;
    version.title = link.title.toStdString();
    for (const LinkFigure& figure : outcome.figures)
        version.inputs.push_back((figure.name + ": " + figure.value).toStdString());
    double worst = -1.0;
    for (const LinkPoint& point : outcome.points)
        if (point.isFresh) worst = std::max(worst, point.millimetres);
    if (worst >= 0.0) version.figures.push_back({"worst check point", worst, "mm"});
    version.isSimulated = outcome.isSimulated;
    version.installation = room;
    link.stage->apply(*outcome.installation, version.installation);
    const Origin* origin = originOf(link, version.installation);
    if (origin) version.date = origin->date;
    return version;
}

bool isUsed(const ChainLink& link, const LinkOutcome& outcome, const Installation& room) {
    if (!outcome.installation) return outcome.isGood;
    Installation with = room;
    link.stage->apply(*outcome.installation, with);
    return with == room;
}

} // namespace lumorph::studio
