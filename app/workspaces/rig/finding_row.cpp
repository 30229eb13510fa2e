#include "app/workspaces/rig/finding_row.h"

#include <QHBoxLayout>
#include <QKeyEvent>
#include <QPainter>
#include <QVBoxLayout>

#include "app/studio/look/palette.h"
#include "app/studio/widgets/icon_label.h"
#include "app/workspaces/rig/rig_facts.h"

namespace lumorph::studio {

namespace {

constexpr int kRowIcon = 18;
constexpr int kRowPadding = 8;

QString iconOf(RigFinding::Kind kind) {
    switch (kind) {
    case RigFinding::Kind::stretch:
        return "scale";
    case RigFinding::Kind::speed:
        return "speed";
    default:
        return "error";
    }
}

bool isGrave(RigFinding::Kind kind) { return kind < RigFinding::Kind::stretch; }

} // namespace

FindingRow::FindingRow(const RigFinding& finding, QWidget* parent)
    : QAbstractButton(parent), remedy_(new QLabel(shownText(finding.remedy), this)) {
    setCheckable(true);
    setFocusPolicy(Qt::StrongFocus);
    setAttribute(Qt::WA_Hover);
    setCursor(Qt::PointingHandCursor);
    setSizePolicy(QSizePolicy::Preferred, QSizePolicy::Minimum);
    setAccessibleName(shownText(finding.sentence));
    setAccessibleDescription(shownText(finding.remedy));
    setToolTip("Click to see it in the view");
    auto* layout = new QHBoxLayout(this);
    layout->setContentsMargins(kRowPadding, kRowPadding, kRowPadding, kRowPadding);
    layout->setSpacing(kRowPadding);
    auto* icon = new IconLabel(iconOf(finding.kind), isGrave(finding.kind) ? IconRole::danger : IconRole::warning,
                               kRowIcon, this);
    layout->addWidget(icon, 0, Qt::AlignTop);
    auto* words = new QVBoxLayout;
    words->setSpacing(4);
    auto* sentence = new QLabel(shownText(finding.sentence), this);
    sentence->setWordWrap(true);
    words->addWidget(sentence);
    remedy_->setWordWrap(true);
    remedy_->setProperty("look", "muted");
    remedy_->setObjectName("rig.finding.remedy");
    remedy_->hide();
    words->addWidget(remedy_);
    layout->addLayout(words, 1);
}

void FindingRow::checkStateSet() { remedy_->setVisible(isChecked()); }

void FindingRow::nextCheckState() {
    QAbstractButton::nextCheckState();
    checkStateSet();
}

void FindingRow::keyPressEvent(QKeyEvent* event) {
    if (event->key() == Qt::Key_Return || event->key() == Qt::Key_Enter) return click();
    QAbstractButton::keyPressEvent(event);
}

void FindingRow::paintEvent(QPaintEvent* /*event*/) {
    const Palette& colors = currentPalette();
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setPen(isChecked() ? QPen(colors.accent, 1.5) : QPen(underMouse() ? colors.border : colors.line, 1.0));
    painter.setBrush(isChecked() ? selectedColor(colors) : underMouse() ? colors.hovered : colors.raised);
    painter.drawRoundedRect(QRectF(rect()).adjusted(0.5, 0.5, -0.5, -0.5), 4, 4);
}

} // namespace lumorph::studio
