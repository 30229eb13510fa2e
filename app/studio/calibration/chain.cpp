#include "app/studio/calibration/chain.h"

#include <algorithm>

#include <QDateTime>
#include <QLocale>

namespace lumorph::studio {
namespace {

std::string dateText(const std::string& date) {
    const QDateTime time = QDateTime::fromString(QString::fromStdString(date), Qt::ISODate).toLocalTime();
    return time.isValid() ? QLocale::c().toString(time, "d MMMM, hh:mm").toStdString() : std::string();
}

} // namespace

QString wordsOf(const StageStand& stand) { return QString::fromStdString(standText(stand, dateText)); }

InstallationVersion versionOf(const ChainLink& link, const StageOutcome& outcome, const Installation& room) {
    InstallationVersion version;
    const LinkWords words = wordsOf(outcome);
    version.title = link.title.toStdString();
    for (const LinkFigure& figure : words.figures)
        version.inputs.push_back((figure.name + ": " + figure.value).toStdString());
    double worst = -1.0;
    for (const LinkPoint& point : words.points)
        if (point.isFresh) worst = std::max(worst, point.millimetres);
    if (worst >= 0.0) version.figures.push_back({"worst check point", worst, "mm"});
    version.isSimulated = outcome.isSimulated;
    version.installation = room;
    link.stage->apply(roomOf(outcome.result), version.installation);
    const Origin* origin = link.stage->isCheck() ? nullptr : link.stage->origin(version.installation);
    if (origin) version.date = origin->date;
    return version;
}

} // namespace lumorph::studio
