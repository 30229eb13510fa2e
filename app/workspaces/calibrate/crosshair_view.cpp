#include <algorithm>
#include <cmath>

#include <QCheckBox>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QListWidget>
#include <QMouseEvent>
#include <QPainter>
#include <QPushButton>
#include <QSignalBlocker>
#include <QVBoxLayout>

#include "app/studio/document/hand_control.h"
#include "app/studio/look/palette.h"
#include "app/studio/widgets/dock_parts.h"
#include "app/studio/widgets/panel.h"
#include "app/workspaces/calibrate/calibrate_docks.h"
#include "app/workspaces/common/step_card.h"

namespace lumorph::studio {
namespace {

constexpr double kArrowScale = 20.0; // residuals are drawn so many times as long
constexpr int kLoupe = 25;           // projector pixels on each side, an odd number
constexpr int kLoupeScale = 7;
constexpr int kStrip = kLoupe * kLoupeScale + 16; // below the picture
constexpr int kSideWidth = 280;

/// The projector's picture with the crosshair, as large as fits. It is dragged, or moved by keys.
class CrosshairPicture : public QWidget {
public:
    CrosshairPicture(CrosshairService& service, QWidget* parent) : QWidget(parent), service_(service) {
        setObjectName("crosshair.picture");
        setAccessibleName("Picture of the projector; arrow keys move the crosshair");
        setFocusPolicy(Qt::StrongFocus);
        setCursor(Qt::CrossCursor);
        setMinimumSize(240, 160);
    }

protected:
    bool event(QEvent* event) override {
        // Else the arrow keys would be taken for shortcuts.
        if (event->type() == QEvent::ShortcutOverride && isMove(static_cast<QKeyEvent*>(event)->key())) {
            event->accept();
            return true;
        }
        return QWidget::event(event);
    }
    void keyPressEvent(QKeyEvent* event) override {
        if (!isMove(event->key())) return QWidget::keyPressEvent(event);
        const double step = event->modifiers().testFlag(Qt::ShiftModifier) ? 10.0 : 1.0;
        const int key = event->key();
        service_.moveBy({key == Qt::Key_Left    ? -step
                         : key == Qt::Key_Right ? step
                                                : 0.0,
                         key == Qt::Key_Up     ? -step
                         : key == Qt::Key_Down ? step
                                               : 0.0});
    }
    void mousePressEvent(QMouseEvent* event) override { drag(event); }
    void mouseMoveEvent(QMouseEvent* event) override { drag(event); }

    void paintEvent(QPaintEvent* /*event*/) override {
        const Palette& colors = currentPalette();
        QPainter painter(this);
        painter.fillRect(rect(), colors.sunken);
        const CrosshairState& state = service_.state();
        if (!state.session) return;
        const QImage lit = service_.picture();
        const QImage& sight = service_.sight();
        const QRectF area = areaOf(lit.size());
        const double scale = area.width() / lit.width();
        const auto on = [&](const cv::Point2d& pixel) {
            return area.topLeft() + QPointF(pixel.x + 0.5, pixel.y + 0.5) * scale;
        };
        painter.setRenderHints(QPainter::Antialiasing | QPainter::SmoothPixmapTransform);
        painter.fillRect(area, Qt::black);
        if (state.isLab) painter.drawImage(area, sight);
        painter.setClipRect(area);
        const auto& crosshairs = state.session->crosshairs();
        const cv::Point2d now = crosshairs[state.current].pixel;
        painter.setPen(QPen(Qt::white, 1.0));
        painter.drawLine(QPointF(area.left(), on(now).y()), QPointF(area.right(), on(now).y()));
        painter.drawLine(QPointF(on(now).x(), area.top()), QPointF(on(now).x(), area.bottom()));
        const auto& result = state.session->result();
        for (std::size_t i = 0; i < crosshairs.size(); ++i) {
            if (!crosshairs[i].aimed) continue;
            const bool suspicious = result && result->points[i].suspicious;
            painter.setPen(QPen(suspicious ? colors.danger : colors.success, 2.0));
            painter.setBrush(Qt::NoBrush);
            painter.drawEllipse(on(crosshairs[i].pixel), 5.0, 5.0);
            if (!result) continue;
            const cv::Point2d error = result->points[i].error;
            painter.setPen(QPen(suspicious ? colors.danger : colors.warning, 2.0));
            drawArrow(painter, on(crosshairs[i].pixel), QPointF(error.x, error.y) * scale * kArrowScale);
        }
        painter.setClipping(false);
        QRectF strip(0.0, height() - kStrip + 8.0, width(), kStrip - 16.0);
        if (state.isLab) strip.setLeft(drawLoupe(painter, strip, now, lit, sight) + 8.0);
        drawMeant(painter, strip, sight);
    }

private:
    static bool isMove(int key) {
        return key == Qt::Key_Left || key == Qt::Key_Right || key == Qt::Key_Up || key == Qt::Key_Down;
    }
    static void drawArrow(QPainter& painter, const QPointF& from, const QPointF& by) {
        const double length = std::hypot(by.x(), by.y());
        painter.drawLine(from, from + by);
        if (length < 4.0) return;
        const QPointF back = by / length * 6.0, side(-back.y() * 0.5, back.x() * 0.5);
        painter.drawLine(from + by, from + by - back + side);
        painter.drawLine(from + by, from + by - back - side);
    }
    [[nodiscard]] QRectF areaOf(const QSize& picture) const {
        const QSizeF fitted =
            QSizeF(picture).scaled(QSizeF(width(), std::max(80, height() - kStrip)), Qt::KeepAspectRatio);
        return {QPointF((width() - fitted.width()) / 2.0, (height() - kStrip - fitted.height()) / 2.0), fitted};
    }
    void drag(QMouseEvent* event) {
        if (!event->buttons().testFlag(Qt::LeftButton) || !service_.state().session) return;
        const QSize size = service_.picture().size();
        const QRectF area = areaOf(size);
        const QPointF at = (event->position() - area.topLeft()) * (size.width() / area.width());
        service_.moveTo({at.x() - 0.5, at.y() - 0.5});
    }
    /// Pixel by pixel around the crosshair, at the left of the strip. Returns where it ends.
    static double drawLoupe(QPainter& painter, const QRectF& strip, const cv::Point2d& pixel, const QImage& lit,
                            const QImage& sight) {
        const QRectF loupe(strip.left(), strip.top(), strip.height(), strip.height());
        const QRect source(static_cast<int>(pixel.x) - kLoupe / 2, static_cast<int>(pixel.y) - kLoupe / 2, kLoupe,
                           kLoupe);
        painter.setRenderHint(QPainter::SmoothPixmapTransform, false);
        painter.drawImage(loupe, sight.copy(source));
        painter.setCompositionMode(QPainter::CompositionMode_Plus);
        painter.drawImage(loupe, lit.copy(source));
        painter.setCompositionMode(QPainter::CompositionMode_SourceOver);
        painter.setRenderHint(QPainter::SmoothPixmapTransform);
        painter.setBrush(Qt::NoBrush);
        painter.setPen(QPen(currentPalette().border, 1.0));
        painter.drawRect(loupe);
        return loupe.right();
    }
    /// Which point of the device is meant.
    void drawMeant(QPainter& painter, const QRectF& strip, const QImage& sight) const {
        const QSizeF fitted = QSizeF(sight.size()).scaled(strip.size(), Qt::KeepAspectRatio);
        const QRectF area(strip.topLeft(), fitted);
        painter.drawImage(area, sight);
        painter.setBrush(Qt::NoBrush);
        painter.setPen(QPen(currentPalette().border, 1.0));
        painter.drawRect(area);
        painter.setPen(QPen(currentPalette().accent, 2.0));
        const QPointF at = area.topLeft() + (service_.target() + QPointF(0.5, 0.5)) * (fitted.width() / sight.width());
        painter.drawEllipse(at, 6.0, 6.0);
    }

    CrosshairService& service_;
};

class CrosshairView : public QWidget {
public:
    explicit CrosshairView(const CalibrateParts& parts)
        : parts_(parts), service_(parts.crosshairs), card_(new StepCard("crosshair.card", "target", this)),
          picture_(new CrosshairPicture(service_, this)), points_(new QListWidget(this)) {
        setObjectName("crosshair.view");
        setProperty("look", "panel");
        setAttribute(Qt::WA_StyledBackground);
        auto* column = new QVBoxLayout(this);
        column->setContentsMargins(16, 8, 16, 8);
        column->setSpacing(8);
        column->addWidget(card_);
        auto* row = new QHBoxLayout;
        row->setSpacing(8);
        row->addWidget(picture_, 1);
        row->addWidget(makeSide());
        column->addLayout(row, 1);
        legend_ = new QLabel(this);
        legend_->setObjectName("crosshair.legend");
        legend_->setProperty("look", "muted");
        legend_->setWordWrap(true);
        column->addWidget(legend_);
        connect(card_, &StepCard::nextWanted, this, [this] {
            service_.doNext();
            picture_->setFocus();
        });
        connect(&service_, &CrosshairService::changed, this, [this] { refresh(); });
        refresh();
    }

private:
    QWidget* makeSide() {
        auto* side = new QWidget(this);
        side->setFixedWidth(kSideWidth);
        auto* column = new QVBoxLayout(side);
        column->setContentsMargins(0, 0, 0, 0);
        column->setSpacing(8);
        column->addWidget(makeHeading("Points of the device", side));
        points_->setObjectName("crosshair.points");
        points_->setAccessibleName("Points of the device");
        column->addWidget(points_, 1);
        leftOut_ = new QCheckBox("Leave this point out", side);
        leftOut_->setObjectName("crosshair.leaveOut");
        leftOut_->setToolTip("Where it cannot be seen, or the light does not reach it");
        column->addWidget(leftOut_);
        auto* raise = new QPushButton("Raise all flaps", side);
        raise->setObjectName("crosshair.raise");
        raise->setToolTip("The points are those of the raised device; undo lets it down again");
        column->addWidget(raise);
        lab_ = new QCheckBox("In the virtual lab", side);
        lab_->setObjectName("crosshair.lab");
        lab_->setToolTip("The picture shows the device as the lab's projector truly lights it. Otherwise the crosshair "
                         "is shown in the projector's output window, and you look at the real device.");
        column->addWidget(lab_);
        auto* anew = new QPushButton("Begin anew", side);
        anew->setObjectName("crosshair.anew");
        column->addWidget(anew);
        connect(points_, &QListWidget::currentRowChanged, this, [this](int index) {
            if (index >= 0) service_.select(static_cast<std::size_t>(index));
        });
        connect(points_, &QListWidget::itemClicked, picture_, [this] { picture_->setFocus(); });
        connect(leftOut_, &QCheckBox::clicked, this,
                [this](bool out) { service_.setLeftOut(service_.state().current, out); });
        connect(raise, &QPushButton::clicked, this, [this] {
            HandControl(parts_.studio.document, parts_.studio.loop)
                .moveAll("Raise all flaps", service_.state().strokes);
        });
        connect(lab_, &QCheckBox::clicked, this, [this](bool on) { service_.setLab(on); });
        connect(anew, &QPushButton::clicked, this, [this] { service_.begin(); });
        return side;
    }

    void refresh() {
        const CrosshairState& state = service_.state();
        const CrosshairNext next = nextOf(state);
        card_->show({next.tone, next.title, next.text, next.button, false});
        const QSignalBlocker quiet(points_);
        const std::size_t count = state.session ? state.session->crosshairs().size() : 0;
        while (points_->count() > static_cast<int>(count)) delete points_->takeItem(points_->count() - 1);
        for (std::size_t i = 0; i < count; ++i) {
            QListWidgetItem* item = points_->item(static_cast<int>(i));
            if (!item) item = new QListWidgetItem(points_);
            item->setText(QString("%1\n%2").arg(QString::fromStdString(state.session->crosshairs()[i].name),
                                                wordsOfPoint(state, i)));
        }
        if (count > 0) points_->setCurrentRow(static_cast<int>(state.current));
        leftOut_->setEnabled(count > 0);
        leftOut_->setChecked(count > 0 && state.leftOut[state.current]);
        lab_->setChecked(state.isLab);
        QString words = state.isLab
                            ? "The device as the lab's projector lights it; below, the crosshair enlarged, and "
                              "the point that is meant. "
                            : "What the projector shows; look at the device itself. Below, the point that is meant. ";
        if (state.session && state.session->result())
            words += QString("Arrows: from a crosshair to where the others put its point, %1 times as long. ")
                         .arg(kArrowScale, 0, 'f', 0);
        if (state.millimetres)
            words += QString("95 of 100 cases lie within %1 mm on the device.").arg(*state.millimetres, 0, 'f', 1);
        legend_->setText(words);
        picture_->update();
    }

    CalibrateParts parts_;
    CrosshairService& service_;
    StepCard* card_;
    CrosshairPicture* picture_;
    QListWidget* points_;
    QCheckBox* leftOut_ = nullptr;
    QCheckBox* lab_ = nullptr;
    QLabel* legend_ = nullptr;
};

} // namespace

QWidget* makeCrosshairView(const CalibrateParts& parts) { return new CrosshairView(parts); }

} // namespace lumorph::studio
