#include "app/studio/shell/replay_bar.h"

#include <QComboBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QMenu>
#include <QPainter>
#include <QPushButton>
#include <QSignalBlocker>
#include <QToolButton>
#include <QVBoxLayout>

#include "app/studio/look/icons.h"
#include "app/studio/look/palette.h"
#include "app/studio/widgets/dock_parts.h"
#include "app/studio/widgets/icon_label.h"
#include "app/studio/widgets/mark_slider.h"
#include "app/studio/widgets/panel.h"

namespace lumorph::studio {
namespace {

constexpr int kReplayBarHeight = 48;
constexpr int kNarrowReplayBar = 900;
constexpr auto kOnlyShown = "A recording is shown; servos stay still";
constexpr double kSpeeds[] = {0.25, 0.5, 1.0, 2.0, 4.0};

QLabel* makeClock(const char* name, const char* widest, QWidget* parent) {
    auto* label = new QLabel(parent);
    label->setObjectName(name);
    label->setMinimumWidth(label->fontMetrics().horizontalAdvance(widest));
    return label;
}

class ReplayBar : public QWidget {
public:
    ReplayBar(Studio& studio, QWidget* parent) : QWidget(parent), studio_(studio), replay_(studio.replay) {
        setObjectName("replay.bar");
        setFixedHeight(kReplayBarHeight);
        auto* row = new QHBoxLayout(this);
        row->setContentsMargins(12, 0, 8, 0);
        row->setSpacing(8);
        addName(*row);
        addTime(*row);
        addTools(*row);
        connect(&replay_, &ReplayService::changed, this, [this] { refresh(); });
        connect(&replay_, &ReplayService::drivesServosChanged, this, [this] { refresh(); });
        connect(&replay_, &ReplayService::moved, this, [this] { showTime(); });
        refresh();
    }

protected:
    void paintEvent(QPaintEvent* /*event*/) override {
        QPainter painter(this);
        painter.fillRect(rect(), selectedColor(currentPalette()));
        painter.fillRect(0, 0, width(), 2, currentPalette().accent);
    }
    void resizeEvent(QResizeEvent* event) override {
        QWidget::resizeEvent(event);
        words_->setVisible(width() >= kNarrowReplayBar);
        elide();
    }

private:
    void addName(QHBoxLayout& row) {
        row.addWidget(new IconLabel("replay", IconRole::accent, 20, this));
        words_ = new QWidget(this);
        auto* lines = new QVBoxLayout(words_);
        lines->setContentsMargins(0, 6, 8, 6);
        lines->setSpacing(0);
        name_ = new QLabel(words_);
        name_->setObjectName("replay.name");
        QFont strong = name_->font();
        strong.setWeight(QFont::DemiBold);
        name_->setFont(strong);
        name_->setTextFormat(Qt::PlainText);
        what_ = new QLabel(kOnlyShown, words_);
        what_->setObjectName("replay.what");
        what_->setProperty("look", "muted");
        lines->addWidget(name_);
        lines->addWidget(what_);
        words_->setToolTip("What you edit meanwhile is kept, and seen as far as the recording does not say otherwise.");
        words_->setFixedWidth(what_->sizeHint().width() + 8);
        row.addWidget(words_);
    }

    void addTime(QHBoxLayout& row) {
        auto* play = new QToolButton(this);
        play->setObjectName("replay.playButton");
        play->setDefaultAction(studio_.commands.find("replay.play"));
        play->setToolButtonStyle(Qt::ToolButtonIconOnly);
        play->setIconSize(QSize(20, 20));
        row.addWidget(play);
        time_ = makeClock("replay.time", "0:00:00.0", this);
        time_->setAlignment(Qt::AlignRight | Qt::AlignVCenter);
        row.addWidget(time_);
        slider_ = new MarkSlider(this);
        slider_->setObjectName("replay.scrub");
        slider_->setAccessibleName("Time of the recording");
        connect(slider_, &MarkSlider::sought, &replay_, &ReplayService::seek);
        row.addWidget(slider_, 1);
        duration_ = makeClock("replay.duration", "0:00:00", this);
        row.addWidget(duration_);
    }

    void addTools(QHBoxLayout& row) {
        speed_ = new QComboBox(this);
        speed_->setObjectName("replay.speed");
        speed_->setToolTip("How fast it is shown");
        for (const double times : kSpeeds) speed_->addItem(QString::number(times) + " x", times);
        connect(speed_, &QComboBox::activated, this, [this] { replay_.setSpeed(speed_->currentData().toDouble()); });
        row.addWidget(speed_);
        row.addWidget(makeCommandButton(studio_.commands.find("replay.drive"), "replay.driveButton", this));
        auto* more = new QToolButton(this);
        more->setObjectName("replay.more");
        more->setText("More");
        more->setToolButtonStyle(Qt::ToolButtonTextOnly);
        more->setPopupMode(QToolButton::InstantPopup);
        auto* menu = new QMenu(more);
        for (const char* id : {"replay.verify", "replay.export", "replay.project"})
            menu->addAction(studio_.commands.find(id));
        more->setMenu(menu);
        row.addWidget(more);
        auto* live = new QPushButton("Back to live", this);
        live->setObjectName("replay.live");
        connect(live, &QPushButton::clicked, &replay_, &ReplayService::close);
        row.addWidget(live);
    }

    void refresh() {
        const auto& recording = replay_.recording();
        setVisible(recording != nullptr);
        if (!recording) {
            shown_.reset();
            return;
        }
        if (shown_.lock() != recording) take(recording);
        what_->setText(replay_.drivesServos() ? "A recording drives the servos" : kOnlyShown);
        const QSignalBlocker quiet(speed_);
        speed_->setCurrentIndex(speed_->findData(replay_.speed()));
        showTime();
    }

    void take(const std::shared_ptr<const Recording>& recording) {
        shown_ = recording;
        std::vector<MarkSlider::Mark> marks;
        for (const EventRow& event : recording->events)
            if (event.kind == "mark")
                marks.push_back({1e-6 * static_cast<double>(event.time.count()), QString::fromStdString(event.text)});
        slider_->setDuration(replay_.duration());
        slider_->setMarks(std::move(marks));
        duration_->setText(clockText(replay_.duration()));
        elide();
    }

    void showTime() {
        const double seconds = replay_.position();
        time_->setText(clockText(seconds) + '.' + QString::number(static_cast<int>(seconds * 10.0) % 10));
        if (!slider_->isSliderDown()) slider_->showSeconds(seconds);
    }

    void elide() {
        const QString name = QString::fromStdString(replay_.file().stem().string());
        name_->setText(name_->fontMetrics().elidedText(name, Qt::ElideMiddle, words_->width() - 8));
    }

    Studio& studio_;
    ReplayService& replay_;
    std::weak_ptr<const Recording> shown_;
    QWidget* words_ = nullptr;
    QLabel* name_ = nullptr;
    QLabel* what_ = nullptr;
    QLabel* time_ = nullptr;
    QLabel* duration_ = nullptr;
    MarkSlider* slider_ = nullptr;
    QComboBox* speed_ = nullptr;
};

} // namespace

QWidget* makeReplayBar(Studio& studio, QWidget* parent) {
    auto* bars = new QWidget(parent);
    auto* column = new QVBoxLayout(bars);
    column->setContentsMargins(0, 0, 0, 0);
    column->setSpacing(0);
    for (const char* place : {"record", "replay"}) column->addWidget(makeNoticeBar(studio.notices, place, bars));
    column->addWidget(new ReplayBar(studio, bars));
    return bars;
}

} // namespace lumorph::studio
