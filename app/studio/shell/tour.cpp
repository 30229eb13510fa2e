#include "app/studio/shell/tour.h"

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
        // Outside the mask the window below gets the mouse: the lit widget can be used.
        const QRegion open = lit_.isEmpty() ? QRegion() : QRegion(lit_.adjusted(4, 4, -4, -4));
        card_->setFixedWidth(std::min(kCardWidth, width() - 2 * kGap));
        card_->adjustSize();
        card_->move(besideSpot(card_->size()));
        coverAllBut(open - QRegion(card_->geometry()));
        update();
    }

    void paintEvent(QPaintEvent* event) override {
        Overlay::paintEvent(event);
        if (lit_.isEmpty()) return;
        QPainter painter(this);
        painter.setRenderHint(QPainter::Antialiasing);
        painter.setPen(QPen(currentPalette().accent, 3));
        painter.setBrush(Qt::NoBrush);
        painter.drawRoundedRect(QRectF(lit_).adjusted(2, 2, -2, -2), 4, 4);
    }

private:
    void makeCard() {
        card_ = new QFrame(this);
        card_->setObjectName("tour.card");
        card_->setProperty("look", "popup");
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
        const TourStep& now = steps_[static_cast<std::size_t>(step)];
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

    /// Of the present step's widget, in this window; empty while it is hidden or floats.
    [[nodiscard]] QRect spot() const {
        if (steps_.empty()) return {};
        const QWidget* widget = widgetOf(*parentWidget(), steps_[static_cast<std::size_t>(step_)]);
        if (widget == nullptr || !widget->isVisible() || widget->window() != parentWidget()) return {};
        return QRect(widget->mapTo(parentWidget(), QPoint()), widget->size()).intersected(rect());
    }

    /// Beside what is lit, where there is most room; inside it when it fills the window.
    [[nodiscard]] QPoint besideSpot(const QSize& card) const {
        const QRect inside = rect().adjusted(kGap, 56, -kGap, -44);
        QPoint at(lit_.center().x() - card.width() / 2, lit_.bottom() - card.height() - 6 * kGap);
        if (lit_.isEmpty())
            at = rect().center() - QPoint(card.width() / 2, card.height() / 2);
        else if (inside.right() - lit_.right() >= card.width() + kGap)
            at = QPoint(lit_.right() + kGap, lit_.top());
        else if (lit_.left() - inside.left() >= card.width() + kGap)
            at = QPoint(lit_.left() - kGap - card.width(), lit_.top());
        return {std::clamp(at.x(), inside.left(), std::max(inside.left(), inside.right() - card.width())),
                std::clamp(at.y(), inside.top(), std::max(inside.top(), inside.bottom() - card.height()))};
    }

    std::vector<TourStep> steps_;
    std::function<void()> finished_;
    int step_ = 0;
    QRect lit_;
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
