#include "app/workspaces/devices/servo_row.h"

#include <cmath>

#include <QBoxLayout>
#include <QPainter>

#include "app/studio/look/palette.h"
#include "app/studio/widgets/dock_parts.h"
#include "app/workspaces/devices/device_words.h"

namespace lumorph::studio {
namespace {

constexpr int kServoRowHeight = 56, kLeastServoRowHeight = 34;
constexpr int kNameWidth = 128;

} // namespace

ServoRow::ServoRow(std::size_t servo, const QString& name, QWidget* parent)
    : QAbstractButton(parent), servo_(servo), channel_(new QLabel(this)), bar_(new StrokeBar(this)) {
    const QString number = QString::number(servo);
    setObjectName("devices.row." + number);
    setAccessibleName(servoName({}, servo) + ", " + name);
    setToolTip(name + ": click to set it up on the right");
    setCheckable(true);
    setFocusPolicy(Qt::StrongFocus);
    setMinimumHeight(kLeastServoRowHeight);
    setMaximumHeight(kServoRowHeight);
    setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Preferred);
    auto* title = new QLabel(fontMetrics().elidedText(name, Qt::ElideRight, kNameWidth - 4), this);
    title->setProperty("look", "heading");
    title->setTextFormat(Qt::PlainText);
    channel_->setObjectName("devices.channel." + number);
    channel_->setProperty("look", "muted");
    auto* names = new QVBoxLayout;
    names->setSpacing(0);
    names->addStretch(1);
    names->addWidget(title);
    names->addWidget(channel_);
    names->addStretch(1);
    title->setFixedWidth(kNameWidth);
    pulse_ = makeNumber("devices.pulse." + number, "2500 µs", this);
    pulse_->setToolTip("Width of the pulse that the servo gets");
    word_ = new QLabel(this);
    word_->setObjectName("devices.word." + number);
    word_->setProperty("look", "muted");
    word_->setFixedWidth(word_->fontMetrics().horizontalAdvance("Waits for you") + 4);
    wiggle_ = new QPushButton("Wiggle", this);
    wiggle_->setObjectName("devices.wiggle." + number);
    wiggle_->setToolTip("Moves this servo a little to and fro, to see which one it is");
    wiggle_->setAccessibleName("Wiggle " + name);
    auto* row = new QHBoxLayout(this);
    row->setContentsMargins(8, 0, 8, 0);
    row->setSpacing(8);
    row->addLayout(names);
    row->addWidget(bar_, 1);
    row->addWidget(pulse_);
    row->addWidget(word_);
    row->addWidget(wiggle_);
    connect(wiggle_, &QPushButton::clicked, this, &ServoRow::wiggled);
}

void ServoRow::show(const LinkStatus& link, const ServoSetup& setup, bool tested, double wanted) {
    channel_->setText("channel " + QString::number(setup.channel));
    ServoStatus servo = servo_ < link.servos.size() ? link.servos[servo_] : ServoStatus{};
    if (link.phase == LinkPhase::off) servo = {};
    if (!servo.attached) servo.wanted = wanted; // the show goes on without them
    bar_->show(servo);
    pulse_->setText(servo.attached ? QString::number(std::lround(servo.microseconds)) + " µs" : QString("no pulse"));
    word_->setText(link.phase == LinkPhase::off ? QString("No link") : servoWord(link, servo_, tested));
    wiggle_->setEnabled(link.phase == LinkPhase::live && servo.attached);
}

QSize ServoRow::sizeHint() const { return {520, kServoRowHeight}; }

void ServoRow::paintEvent(QPaintEvent* /*event*/) {
    const Palette& colors = currentPalette();
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    const QColor fill = isChecked() ? selectedColor(colors) : underMouse() ? colors.hovered : colors.raised;
    painter.setPen(QPen(isChecked() ? colors.accent : colors.line, 1.0));
    painter.setBrush(fill);
    painter.drawRoundedRect(QRectF(rect()).adjusted(0.5, 0.5, -0.5, -0.5), 6.0, 6.0);
}

} // namespace lumorph::studio
