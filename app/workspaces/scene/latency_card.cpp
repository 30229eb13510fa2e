#include "app/workspaces/scene/latency_card.h"

#include <QPainter>

#include "app/studio/look/palette.h"

namespace lumorph::studio {
namespace {

constexpr int kMilliseconds = 250; // nobody reads faster
constexpr int kLine = 18;
constexpr int kLatencyPadding = 12;
constexpr int kWidth = 200;
constexpr int kLines = 17;

} // namespace

LatencyCard::LatencyCard(ShowFeed& feed, QWidget* parent) : FloatingCard(parent), feed_(feed), due_(kMilliseconds) {
    setObjectName("scene.latency");
    setAccessibleName(tr("Time of each stage"));
    connect(&feed_, &ShowFeed::shown, &due_, &Throttle::request);
    connect(&due_, &Throttle::due, this, [this] {
        if (!isVisible()) return;
        lines_ = linesOf(feed_);
        update();
    });
}

QSize LatencyCard::sizeHint() const { return {kWidth, kLines * kLine + 2 * kLatencyPadding}; }

std::vector<LatencyCard::Line> LatencyCard::linesOf(const ShowFeed& feed) {
    const DrawnShow& newest = feed.newest();
    if (!newest.match) return {};
    const MatchTimes& loop = newest.match->ms;
    const ShowTimes& show = newest.ms;
    const QString ms = tr("ms");
    return {{tr("Pose's age"), loop.poseAge, ms},
            {tr("Track"), loop.track, ms},
            {tr("Match"), loop.voxelize + loop.match + loop.refine, ms},
            {tr("Rule"), loop.rule, ms},
            {tr("Motion"), loop.motion + loop.deform, ms},
            {tr("Pose"), show.pose, ms},
            {tr("Upload"), show.upload, ms},
            {tr("Shadow"), show.shadow, ms},
            {tr("Eye pass"), show.eye, ms},
            {tr("Projectors"), show.projectors, ms},
            {tr("Lab"), show.lab, ms},
            {tr("Read back"), show.readBack, ms},
            {tr("End to end"), loop.poseAge + feed.endToEnd(), ms},
            {tr("Looked ahead"), loop.latency, ms},
            {tr("By newest pose"), show.latency, ms},
            {tr("Pictures"), feed.rate(), tr("/s")},
            {tr("Resolution"), 100.0 * newest.resolution, tr("%")}};
}

void LatencyCard::paintEvent(QPaintEvent* event) {
    FloatingCard::paintEvent(event);
    const Palette& colors = currentPalette();
    QPainter painter(this);
    int y = kLatencyPadding;
    for (const Line& line : lines_) {
        const QRect row(kLatencyPadding, y, width() - 2 * kLatencyPadding, kLine);
        painter.setPen(colors.textMuted);
        painter.drawText(row, Qt::AlignLeft | Qt::AlignVCenter, line.stage);
        painter.setPen(colors.text);
        painter.drawText(row, Qt::AlignRight | Qt::AlignVCenter,
                         tr("%1 %2").arg(line.value, 0, 'f', line.value < 99.5 ? 1 : 0).arg(line.unit));
        y += kLine;
    }
}

void LatencyCard::showEvent(QShowEvent* event) {
    FloatingCard::showEvent(event);
    lines_ = linesOf(feed_);
    feed_.setMeasuring(true);
}

void LatencyCard::hideEvent(QHideEvent* event) {
    FloatingCard::hideEvent(event);
    feed_.setMeasuring(false);
}

} // namespace lumorph::studio
