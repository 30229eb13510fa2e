#include "app/studio/shell/rest_page.h"

#include <QPainter>
#include <QVBoxLayout>

#include "app/studio/look/palette.h"

namespace lumorph::studio {
namespace {

constexpr int kMargin = 48;

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
    title_ = addLine(*column, "visitors.rest.title", "font-size: 30px; font-weight: 600;");
    sentence_ = addLine(*column, "visitors.rest.sentence", "font-size: 17px;");
    column->addStretch(3);
    connect(&settings, &Settings::languageChanged, this, &RestPage::say);
    say();
}

void RestPage::say() {
    title_->setText(settings_.say({"A short rest", "Eine kurze Pause"}));
    sentence_->setText(settings_.say({"Nothing can be shown right now. It goes on by itself.",
                                      "Gerade ist nichts zu sehen. Es geht von selbst weiter."}));
}

void RestPage::paintEvent(QPaintEvent* /*event*/) { QPainter(this).fillRect(rect(), currentPalette().window); }

} // namespace lumorph::studio
