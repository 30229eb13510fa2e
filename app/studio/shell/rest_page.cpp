#include "app/studio/shell/rest_page.h"

#include <QPainter>
#include <QPainterPath>
#include <QVBoxLayout>

#include "app/studio/look/palette.h"

namespace lumorph::studio {
namespace {

constexpr int kMargin = 48;
constexpr double kSheet = 132.0, kSwell = 26.0, kSheetOver = 64.0; ///< of the picture over the title, pixels

QLabel* addLine(QVBoxLayout& column, const char* name, const char* style) {
    auto* line = new QLabel;
    line->setObjectName(name);
    line->setAlignment(Qt::AlignHCenter);
    line->setWordWrap(true);
    line->setStyleSheet(style);
    column.addWidget(line);
    return line;
}

} // namespace

RestPage::RestPage(Settings& settings, QWidget* parent) : QWidget(parent), settings_(settings) {
    setObjectName("visitors.rest");
    auto* column = new QVBoxLayout(this);
    column->setContentsMargins(kMargin, kMargin, kMargin, kMargin);
    column->setSpacing(12);
    column->addStretch(2);
    title_ = addLine(*column, "visitors.rest.title", "font-size: 38px; font-weight: 600;");
    sentence_ = addLine(*column, "visitors.rest.sentence", "font-size: 20px;");
    column->addStretch(3);
    connect(&settings, &Settings::languageChanged, this, &RestPage::say);
    say();
}

void RestPage::say() {
    title_->setText(settings_.say({"A short rest", "Eine kurze Pause"}));
    sentence_->setText(settings_.say({"Nothing can be shown right now. It goes on by itself.",
                                      "Gerade ist nichts zu sehen. Es geht von selbst weiter."}));
}

/// A sheet that lies almost flat. Drawn by hand: bundled files may be what is missing.
void RestPage::paintEvent(QPaintEvent* /*event*/) {
    const Palette& colors = currentPalette();
    QPainter painter(this);
    painter.fillRect(rect(), colors.window);
    painter.setRenderHint(QPainter::Antialiasing);
    const QPointF left(0.5 * (width() - kSheet), title_->y() - kSheetOver), right = left + QPointF(kSheet, 0.0);
    painter.setPen(QPen(colors.textMuted, 2.0, Qt::SolidLine, Qt::RoundCap));
    painter.drawLine(left + QPointF(0.0, 14.0), right + QPointF(0.0, 14.0));
    QPainterPath sheet(left);
    sheet.cubicTo(left + QPointF(0.4 * kSheet, 0.0), left + QPointF(0.3 * kSheet, -kSwell),
                  left + QPointF(0.5 * kSheet, -kSwell));
    sheet.cubicTo(right + QPointF(-0.3 * kSheet, -kSwell), right + QPointF(-0.4 * kSheet, 0.0), right);
    painter.setPen(QPen(colors.accentText, 5.0, Qt::SolidLine, Qt::RoundCap));
    painter.drawPath(sheet);
}

} // namespace lumorph::studio
