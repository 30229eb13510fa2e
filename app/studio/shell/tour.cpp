#include "app/studio/shell/tour.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <QDockWidget>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QPainter>
#include <QPainterPath>
#include <QPushButton>
#include <QTimer>
#include <QVBoxLayout>

#include "app/studio/look/palette.h"
#include "app/studio/shell/overlay.h"

namespace lumorph::studio {
namespace {

constexpr int kCardWidth = 344;
constexpr int kGap = 16;
constexpr int kArrow = 12;              ///< how far it sticks out of the card
constexpr int kShadow = 12;             ///< and the card's shadow
constexpr QMargins kBars(0, 40, 0, 28); ///< of the window: what stands there is never covered

/// One in sight before one of another workspace that has the same name; a dock that is closed can be shown.
QWidget* widgetOf(const QWidget& window, const TourStep& step) {
    QWidget* hidden = nullptr;
    for (const QString& name : step.widgets)
        for (QWidget* widget : window.findChildren<QWidget*>(name)) {
            if (widget->isVisible()) return widget;
            if (hidden == nullptr) hidden = widget;
        }
    return hidden;
}

/// One dot a step; the present one is filled.
class StepDots : public QWidget {
public:
    StepDots(int count, QWidget* parent) : QWidget(parent), count_(count) { setFixedSize(count * 14, 16); }
    void setPresent(int present) {
        present_ = present;
        setAccessibleName(QString("Step %1 of %2").arg(present + 1).arg(count_));
        update();
    }

protected:
    void paintEvent(QPaintEvent* /*event*/) override {
        QPainter painter(this);
        painter.setRenderHint(QPainter::Antialiasing);
        painter.setPen(Qt::NoPen);
        for (int i = 0; i < count_; ++i) {
            painter.setBrush(i == present_ ? currentPalette().accent : currentPalette().border);
            painter.drawEllipse(QPointF(i * 14 + 5, 8), 3.5, 3.5);
        }
    }

private:
    int count_;
    int present_ = 0;
};

class Tour : public Overlay {
public:
    Tour(QMainWindow& window, std::vector<TourStep> steps, std::function<void()> finished)
        : Overlay(window), steps_(std::move(steps)), finished_(std::move(finished)) {
        setObjectName("tour");
        std::erase_if(steps_, [&window](const TourStep& step) { return widgetOf(window, step) == nullptr; });
        makeCard();
        auto* follow = new QTimer(this); // the lit widget may be resized or moved meanwhile
        connect(follow, &QTimer::timeout, this, [this] {
            if (spot() != lit_) arrange();
        });
        follow->start(100);
    }

    void begin() {
        if (steps_.empty()) {
            end();
            return;
        }
        open();
        go(0);
    }

    void end() {
        if (finished_) std::exchange(finished_, nullptr)();
        leave();
        if (steps_.empty()) deleteLater();
    }

protected:
    void keyPressEvent(QKeyEvent* event) override {
        switch (event->key()) {
        case Qt::Key_Escape:
            end();
            return;
        case Qt::Key_Right:
            go(step_ + 1);
            return;
        case Qt::Key_Left:
            go(step_ - 1);
            return;
        case Qt::Key_Return:
        case Qt::Key_Enter:
            next_->click();
            return;
        default:
            Overlay::keyPressEvent(event);
        }
    }

    void arrange() override {
        if (steps_.empty()) return;
        lit_ = spot();
        const QWidget* second = present().alsoLit.isEmpty() ? nullptr : inSight(present().alsoLit);
        also_ = second != nullptr ? boxOf(*second) : QRect();
        card_->setFixedWidth(std::min(kCardWidth, width() - 2 * kGap));
        card_->layout()->activate();
        const int height = card_->layout()->totalHeightForWidth(card_->width());
        card_->setFixedHeight(std::min(height > 0 ? height : card_->sizeHint().height(), this->height()));
        card_->move(besideSpot(card_->size()));
        // Outside the mask the window below gets the mouse: the lit widget can be used.
        lights_ = QRegion(lit_.isEmpty() ? QRect() : lit_.adjusted(4, 4, -4, -4)) + also_;
        coverAllBut(lights_ - QRegion(card_->geometry().adjusted(-kShadow, -kShadow, kShadow, kShadow)) -
                    arrow().boundingRect().toAlignedRect().adjusted(-2, -2, 2, 2));
        update();
    }

    void paintEvent(QPaintEvent* /*event*/) override {
        const Palette& colors = currentPalette();
        QPainter painter(this);
        painter.save();
        painter.setClipRegion(QRegion(rect()) - lights_);
        painter.fillRect(rect(), dimming());
        painter.restore();
        painter.setRenderHint(QPainter::Antialiasing);
        painter.setBrush(Qt::NoBrush);
        if (!lit_.isEmpty()) {
            painter.setPen(QPen(colors.accent, 3));
            painter.drawRoundedRect(QRectF(lit_).adjusted(2, 2, -2, -2), 4, 4);
        }
        // The card and its arrow are one shape, in the colour of what they point at.
        QPainterPath shape;
        shape.addRoundedRect(QRectF(card_->geometry()).adjusted(1, 1, -1, -1), 8, 8);
        shape = shape.united(arrow());
        for (int wide = kShadow; wide > 0; wide -= 2) {
            painter.setPen(QPen(QColor(0, 0, 0, 24), 2 * wide, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
            painter.drawPath(shape);
        }
        painter.setPen(QPen(colors.accent, 2, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
        painter.setBrush(colors.raised);
        painter.drawPath(shape);
    }

private:
    void makeCard() {
        card_ = new QFrame(this);
        card_->setObjectName("tour.card");
        auto* column = new QVBoxLayout(card_);
        column->setContentsMargins(20, 16, 16, 16);
        column->setSpacing(8);
        title_ = new QLabel(card_);
        title_->setObjectName("tour.title");
        title_->setProperty("look", "title");
        text_ = new QLabel(card_);
        text_->setWordWrap(true);
        action_ = new QPushButton(card_);
        action_->setObjectName("tour.action");
        connect(action_, &QPushButton::clicked, this, [this] { steps_[static_cast<std::size_t>(step_)].run(); });
        column->addWidget(title_);
        column->addWidget(text_);
        column->addWidget(action_, 0, Qt::AlignLeft);
        column->addSpacing(8);
        auto* row = new QHBoxLayout;
        row->setSpacing(8);
        dots_ = new StepDots(static_cast<int>(steps_.size()), card_);
        row->addWidget(dots_);
        row->addStretch(1);
        skip_ = addButton(*row, "tour.skip", "Skip", "flat");
        back_ = addButton(*row, "tour.back", "Back", "");
        next_ = addButton(*row, "tour.next", "Next", "primary");
        connect(skip_, &QPushButton::clicked, this, [this] { end(); });
        connect(back_, &QPushButton::clicked, this, [this] { go(step_ - 1); });
        connect(next_, &QPushButton::clicked, this, [this] { go(step_ + 1); });
        column->addLayout(row);
    }

    QPushButton* addButton(QHBoxLayout& row, const char* name, const char* text, const char* look) {
        auto* button = new QPushButton(text, card_);
        button->setObjectName(name);
        button->setProperty("look", look);
        row.addWidget(button);
        return button;
    }

    void go(int step) {
        if (step < 0) return;
        if (step >= static_cast<int>(steps_.size())) {
            end();
            return;
        }
        step_ = step;
        const TourStep& now = present();
        if (auto* dock = qobject_cast<QDockWidget*>(widgetOf(*parentWidget(), now))) {
            dock->show();
            dock->raise();
        }
        title_->setText(now.title);
        text_->setText(now.text);
        action_->setText(now.action);
        action_->setVisible(!now.action.isEmpty());
        back_->setEnabled(step > 0);
        const bool last = step + 1 == static_cast<int>(steps_.size());
        next_->setText(last ? "Done" : "Next");
        skip_->setVisible(!last);
        dots_->setPresent(step);
        arrange();
        setFocus(Qt::OtherFocusReason); // not the button: it would take the arrow keys
    }

    [[nodiscard]] const TourStep& present() const { return steps_[static_cast<std::size_t>(step_)]; }

    [[nodiscard]] const QWidget* inSight(const QString& name) const {
        for (const QWidget* widget : parentWidget()->findChildren<QWidget*>(name))
            if (widget->isVisible()) return widget;
        return nullptr;
    }

    /// In this window; empty for one that is hidden or floats.
    [[nodiscard]] QRect boxOf(const QWidget& widget) const {
        if (!widget.isVisible() || widget.window() != parentWidget()) return {};
        return QRect(widget.mapTo(parentWidget(), QPoint()), widget.size()).intersected(rect());
    }

    /// Of the present step's widget.
    [[nodiscard]] QRect spot() const {
        const QWidget* widget = steps_.empty() ? nullptr : widgetOf(*parentWidget(), present());
        return widget == nullptr ? QRect() : boxOf(*widget);
    }

    /// Beside what is lit, where it hides least of what else is; inside it when it fills the window.
    [[nodiscard]] QPoint besideSpot(const QSize& card) const {
        const QRect room = rect().marginsRemoved(kBars).adjusted(kGap, kGap, -kGap, -kGap);
        const auto inRoom = [&](QPoint at) {
            return QPoint(std::clamp(at.x(), room.left(), std::max(room.left(), room.right() + 1 - card.width())),
                          std::clamp(at.y(), room.top(), std::max(room.top(), room.bottom() + 1 - card.height())));
        };
        if (lit_.isEmpty()) return inRoom(rect().center() - QPoint(card.width() / 2, card.height() / 2));
        const int away = kArrow + 4;
        const QPoint places[] = {{lit_.right() + 1 + away, lit_.top()},
                                 {lit_.left() - away - card.width(), lit_.top()},
                                 {lit_.left(), lit_.bottom() + 1 + away},
                                 {lit_.left(), lit_.top() - away - card.height()}};
        std::optional<std::pair<qint64, QPoint>> best;
        for (const QPoint& place : places) {
            const QRect box(inRoom(place), card);
            if (box.intersects(lit_)) continue;
            const QSize hidden = box.intersected(also_).size();
            const qint64 cost = static_cast<qint64>(hidden.width()) * hidden.height();
            if (!best || cost < best->first) best = {cost, box.topLeft()};
        }
        if (best) return best->second;
        return inRoom({lit_.center().x() - card.width() / 2, lit_.bottom() - card.height() - kGap});
    }

    /// From the card to what is lit; empty where nothing is.
    [[nodiscard]] QPainterPath arrow() const {
        QPainterPath path;
        if (lit_.isEmpty()) return path;
        const QRect card = card_->geometry();
        const double half = kArrow, out = kArrow, in = 4.0;
        const auto along = [half](double wanted, int low, int high) {
            return std::clamp(wanted, low + half + 12.0, std::max(low + half + 12.0, high - half - 12.0));
        };
        const auto add = [&](QPointF root, QPointF towards) {
            const QPointF aside(towards.y() * half, towards.x() * half);
            path.moveTo(root + aside - in * towards);
            path.lineTo(root + out * towards);
            path.lineTo(root - aside - in * towards);
            path.closeSubpath();
        };
        const double x = along(lit_.center().x(), card.left(), card.right());
        const double y = along(lit_.center().y(), card.top(), card.bottom());
        if (lit_.right() < card.left())
            add(QPointF(card.left(), y), {-1, 0});
        else if (lit_.left() > card.right())
            add(QPointF(card.right() + 1, y), {1, 0});
        else if (lit_.top() > card.bottom())
            add(QPointF(x, card.bottom() + 1), {0, 1});
        else // above, or all around
            add(QPointF(x, card.top()), {0, -1});
        return path;
    }

    std::vector<TourStep> steps_;
    std::function<void()> finished_;
    int step_ = 0;
    QRect lit_, also_;
    QRegion lights_; ///< what is not dimmed
    QFrame* card_ = nullptr;
    QLabel *title_ = nullptr, *text_ = nullptr;
    StepDots* dots_ = nullptr;
    QPushButton *action_ = nullptr, *skip_ = nullptr, *back_ = nullptr, *next_ = nullptr;
};

} // namespace

void showTour(QMainWindow& window, std::vector<TourStep> steps, std::function<void()> finished) {
    if (auto* open = window.findChild<QWidget*>("tour", Qt::FindDirectChildrenOnly))
        static_cast<Overlay*>(open)->leave();
    (new Tour(window, std::move(steps), std::move(finished)))->begin();
}

} // namespace lumorph::studio
