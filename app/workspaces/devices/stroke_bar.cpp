#include "app/workspaces/devices/stroke_bar.h"

#include <algorithm>

#include <QHBoxLayout>
#include <QLabel>
#include <QPainter>

#include "app/studio/look/palette.h"

namespace lumorph::studio {
namespace {

constexpr double kMargin = 8.0; ///< so that the ring is whole at both ends

void drawWanted(QPainter& painter, const QPointF& at) {
    painter.setPen(QPen(currentPalette().text, 1.5));
    painter.setBrush(currentPalette().panel);
    painter.drawEllipse(at, 5.0, 5.0);
}

void drawReadBack(QPainter& painter, const QPointF& at) {
    painter.setPen(Qt::NoPen);
    painter.setBrush(currentPalette().warning);
    painter.drawRoundedRect(QRectF(at.x() - 1.5, at.y() - 10.0, 3.0, 20.0), 1.5, 1.5);
}

void drawCommanded(QPainter& painter, const QRectF& box, bool attached) {
    painter.setPen(Qt::NoPen);
    painter.setBrush(attached ? currentPalette().accent : currentPalette().border);
    painter.drawRoundedRect(box, 4.0, 4.0);
}

/// One mark of the legend.
class Mark : public QWidget {
public:
    enum class Kind { commanded, wanted, readBack };
    Mark(Kind kind, QWidget* parent) : QWidget(parent), kind_(kind) { setFixedSize(20, 20); }

protected:
    void paintEvent(QPaintEvent* /*event*/) override {
        QPainter painter(this);
        painter.setRenderHint(QPainter::Antialiasing);
        if (kind_ == Kind::commanded) drawCommanded(painter, QRectF(2, 6, 16, 8), true);
        if (kind_ == Kind::wanted) drawWanted(painter, QPointF(10, 10));
        if (kind_ == Kind::readBack) drawReadBack(painter, QPointF(10, 10));
    }

private:
    Kind kind_;
};

} // namespace

StrokeBar::StrokeBar(QWidget* parent) : QWidget(parent) {
    setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
    setAttribute(Qt::WA_TransparentForMouseEvents); // the row is what is clicked
}

void StrokeBar::show(const ServoStatus& servo) {
    servo_ = servo;
    update();
}

QSize StrokeBar::sizeHint() const { return {160, 24}; }
QSize StrokeBar::minimumSizeHint() const { return {72, 24}; }

void StrokeBar::paintEvent(QPaintEvent* /*event*/) {
    const Palette& colors = currentPalette();
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    const double middle = 0.5 * height(), room = width() - 2.0 * kMargin;
    const auto xOf = [room](double stroke) { return kMargin + std::clamp(stroke, 0.0, 1.0) * room; };
    painter.setPen(Qt::NoPen);
    painter.setBrush(blend(colors.panel, colors.border, 0.4));
    painter.drawRoundedRect(QRectF(kMargin - 4.0, middle - 4.0, room + 8.0, 8.0), 4.0, 4.0);
    if (servo_.attached || servo_.known)
        drawCommanded(painter, QRectF(kMargin - 4.0, middle - 4.0, xOf(servo_.commanded) - kMargin + 4.0, 8.0),
                      servo_.attached);
    drawWanted(painter, QPointF(xOf(servo_.wanted), middle));
    if (servo_.readBack) drawReadBack(painter, QPointF(xOf(*servo_.readBack), middle));
}

QWidget* makeStrokeLegend(QWidget* parent) {
    auto* legend = new QWidget(parent);
    auto* row = new QHBoxLayout(legend);
    row->setContentsMargins(0, 0, 0, 0);
    row->setSpacing(4);
    const struct {
        Mark::Kind kind;
        const char* text;
        const char* tip;
    } marks[] = {{Mark::Kind::wanted, "wanted", "What the show asks for"},
                 {Mark::Kind::commanded, "sent", "What was sent, within the limits of speed and range"},
                 {Mark::Kind::readBack, "read back", "Where the servo says it is; only some controllers can ask"}};
    for (const auto& mark : marks) {
        row->addWidget(new Mark(mark.kind, legend));
        auto* label = new QLabel(mark.text, legend);
        label->setProperty("look", "muted");
        label->setToolTip(mark.tip);
        row->addWidget(label);
        row->addSpacing(8);
    }
    row->addStretch(1);
    return legend;
}

} // namespace lumorph::studio
