#include "app/workspaces/field/pose_dock.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <QComboBox>
#include <QListWidget>
#include <QPainter>
#include <QScrollArea>
#include <QScrollBar>
#include <QSignalBlocker>
#include <QStackedLayout>
#include <QVBoxLayout>

#include "app/studio/look/palette.h"
#include "app/studio/widgets/dock_parts.h"
#include "app/studio/widgets/panel.h"
#include "app/studio/widgets/throttle.h"
#include "app/studio/widgets/value_field.h"
#include "app/workspaces/field/pose_timeline.h"

namespace lumorph::studio {

namespace {

constexpr int kListWidth = 232;
constexpr int kRefreshMilliseconds = 40;
constexpr QSize kBars(44, 20);
constexpr std::array<Easing, 3> kEasings = {Easing::minimumJerk, Easing::smooth, Easing::linear};

/// A pose as bars, one an actuator.
QIcon barsOf(const std::vector<double>& strokes, qreal ratio) {
    QPixmap picture(kBars * ratio);
    picture.setDevicePixelRatio(ratio);
    picture.fill(Qt::transparent);
    QPainter painter(&picture);
    const Palette& colors = currentPalette();
    const double width =
        static_cast<double>(kBars.width()) / std::max<double>(1.0, static_cast<double>(strokes.size()));
    for (std::size_t k = 0; k < strokes.size(); ++k) {
        const double height = 1.0 + strokes[k] * (kBars.height() - 1.0);
        const double gap = width > 3.0 ? 1.0 : 0.0;
        painter.fillRect(QRectF(static_cast<double>(k) * width, kBars.height() - height, width - gap, height),
                         colors.accent);
    }
    QIcon bars(picture);
    bars.addPixmap(picture, QIcon::Selected); // else it is tinted, and dim
    return bars;
}

class PoseDock : public QWidget {
public:
    PoseDock(Studio& studio, PoseDesk& desk)
        : studio_(studio), desk_(desk), stack_(new QStackedLayout(this)), list_(new QListWidget),
          timeline_(new PoseTimeline), scroll_(new QScrollArea), refresh_(new Throttle(kRefreshMilliseconds, this)) {
        stack_->addWidget(makeEmptyState("mark", "No poses yet",
                                         "Move the device with the sliders, then keep how it stands under a name. "
                                         "Poses one after the other make a sequence that the device plays.",
                                         studio.commands.find("poses.keep"), this));
        auto* content = new QWidget(this);
        auto* row = new QHBoxLayout(content);
        row->setContentsMargins(16, 8, 16, 12);
        row->setSpacing(16);
        row->addWidget(makePoses());
        row->addWidget(makeSequence(), 1);
        stack_->addWidget(content);
        connect(&desk, &PoseDesk::changed, this, [this] { showAll(); });
        connect(&desk, &PoseDesk::kept, this, [this](int pose) { nameIt(pose); });
        connect(&studio.loop, &StudioLoop::framed, refresh_, &Throttle::request);
        connect(refresh_, &Throttle::due, this, [this] { follow(); });
        connect(&studio.settings, &Settings::themeChanged, this, [this] {
            listed_ = {};
            showAll();
        });
        showAll();
    }

    [[nodiscard]] QSize sizeHint() const override { return {800, 208}; }

protected:
    void showEvent(QShowEvent* event) override {
        QWidget::showEvent(event);
        showAll();
    }
    void resizeEvent(QResizeEvent* event) override {
        QWidget::resizeEvent(event);
        makeRoom();
    }
    bool eventFilter(QObject* watched, QEvent* event) override {
        if (watched == scroll_->viewport() && event->type() == QEvent::Resize) makeRoom();
        return QWidget::eventFilter(watched, event);
    }

private:
    QToolButton* iconOf(const char* command, QWidget* parent) {
        return makeCommandIcon(studio_.commands.find(QString("poses.") + command), QString("poses.") + command, parent);
    }

    /// With the short words of the command beside its icon.
    QToolButton* wordsOf(const char* command, QWidget* parent) {
        QToolButton* button = iconOf(command, parent);
        button->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
        return button;
    }

    QWidget* makePoses() {
        auto* column = new QWidget;
        column->setFixedWidth(kListWidth);
        auto* layout = new QVBoxLayout(column);
        layout->setContentsMargins(0, 0, 0, 0);
        layout->setSpacing(4);
        auto* bar = new QHBoxLayout;
        bar->setSpacing(4);
        bar->addWidget(wordsOf("keep", column));
        bar->addStretch(1);
        for (const char* command : {"go", "update", "addStep", "remove"}) bar->addWidget(iconOf(command, column));
        layout->addLayout(bar);
        list_->setObjectName("poses.list");
        list_->setAccessibleName("Poses");
        list_->setToolTip("Double click renames a pose");
        list_->setIconSize(kBars);
        list_->setEditTriggers(QAbstractItemView::DoubleClicked | QAbstractItemView::EditKeyPressed);
        connect(list_, &QListWidget::currentRowChanged, this, [this](int row) { desk_.choosePose(row); });
        connect(list_, &QListWidget::itemChanged, this,
                [this](QListWidgetItem* item) { desk_.rename(list_->row(item), item->text()); });
        layout->addWidget(list_, 1);
        return column;
    }

    QWidget* makeTransport() {
        auto* bar = new QWidget;
        auto* layout = new QHBoxLayout(bar);
        layout->setContentsMargins(0, 0, 0, 0);
        layout->setSpacing(4);
        for (const char* command : {"play", "stop", "loop"}) layout->addWidget(iconOf(command, bar));
        time_ = makeNumber("poses.time", "000.0 / 000.0 s", bar);
        time_->setAlignment(Qt::AlignLeft | Qt::AlignVCenter);
        layout->addSpacing(8);
        layout->addWidget(time_);
        layout->addStretch(1);
        layout->addWidget(wordsOf("export", bar));
        return bar;
    }

    QWidget* makeSequence() {
        auto* column = new QWidget;
        auto* layout = new QVBoxLayout(column);
        layout->setContentsMargins(0, 0, 0, 0);
        layout->setSpacing(4);
        layout->addWidget(makeTransport());
        timeline_->setObjectName("poses.timeline");
        scroll_->setObjectName("poses.scroll");
        scroll_->setWidget(timeline_);
        scroll_->setFrameShape(QFrame::NoFrame);
        scroll_->setVerticalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
        scroll_->setFixedHeight(timeline_->height() + 14);
        scroll_->viewport()->installEventFilter(this);
        layout->addWidget(scroll_);
        hint_ = makeLine("poses.hint", "muted");
        hint_->setText("Choose a pose and add it to the sequence with +. It needs at least one step to play.");
        layout->addWidget(hint_);
        layout->addWidget(makeStepForm());
        fit_ = makeLine("poses.fit", "warning");
        slowed_ = makeLine("poses.slowed", "warning");
        layout->addWidget(fit_);
        layout->addWidget(slowed_);
        layout->addWidget(makeNoticeBar(studio_.notices, kPosePlace, column));
        layout->addStretch(1);
        connect(timeline_, &PoseTimeline::chosen, this, [this](int step) { desk_.chooseStep(step); });
        connect(timeline_, &PoseTimeline::moved, this, [this](int from, int to) { desk_.moveStep(from, to); });
        connect(timeline_, &PoseTimeline::removed, this, [this] { desk_.removeStep(); });
        return column;
    }

    QLabel* makeLine(const QString& name, const char* look) {
        auto* label = new QLabel;
        label->setObjectName(name);
        label->setProperty("look", look);
        label->setWordWrap(true);
        return label;
    }

    QWidget* makeStepForm() {
        form_ = new QWidget;
        auto* layout = new QHBoxLayout(form_);
        layout->setContentsMargins(0, 0, 0, 0);
        layout->setSpacing(8);
        title_ = new QLabel;
        title_->setObjectName("poses.step");
        layout->addWidget(title_);
        travel_ = addSeconds(*layout, "&Way", "travel", "How long the way to this pose takes",
                             [](PoseStep& step, double value) { step.travelSeconds = value; });
        hold_ = addSeconds(*layout, "&Hold", "hold", "How long the device stays in it",
                           [](PoseStep& step, double value) { step.holdSeconds = value; });
        easing_ = new QComboBox;
        easing_->setObjectName("poses.easing");
        easing_->setAccessibleName("How it moves");
        easing_->addItem("Natural", "");
        easing_->addItem("Smooth");
        easing_->addItem("Even");
        easing_->setItemData(0, "As hands move: least jerk (minimum jerk)", Qt::ToolTipRole);
        easing_->setItemData(1, "Starts and ends at rest (cubic)", Qt::ToolTipRole);
        easing_->setItemData(2, "The same speed all the way (linear)", Qt::ToolTipRole);
        easing_->setToolTip("How it moves: as hands do, smoothly, or at the same speed all the way");
        connect(easing_, &QComboBox::activated, this, [this](int index) {
            desk_.editStep("Change how a step moves",
                           [index](PoseStep& step) { step.easing = kEasings.at(static_cast<std::size_t>(index)); });
        });
        layout->addWidget(easing_);
        layout->addStretch(1);
        layout->addWidget(iconOf("removeStep", form_));
        return form_;
    }

    ValueField* addSeconds(QHBoxLayout& layout, const QString& text, const QString& name, const QString& tip,
                           const std::function<void(PoseStep&, double)>& set) {
        auto* label = new QLabel(text);
        auto* field = new ValueField(Quantity::seconds, 0.0, kMaxStepSeconds, name == "travel" ? 1.0 : 0.5);
        field->setObjectName("poses." + name);
        field->setAccessibleName(tip);
        field->setToolTip(tip + ".\n" + field->toolTip());
        field->setStep(0.1);
        field->setFixedWidth(88);
        label->setBuddy(field);
        connect(field, &ValueField::previewed, this,
                [this, set](double value) { desk_.previewStep([&](PoseStep& step) { set(step, value); }); });
        connect(field, &ValueField::committed, this, [this, set](double value) {
            desk_.previewStep([&](PoseStep& step) { set(step, value); });
            studio_.document.commitPreview("Change a step's time");
        });
        connect(field, &ValueField::reverted, this, [this] { studio_.document.cancelPreview(); });
        layout.addWidget(label);
        layout.addWidget(field);
        return field;
    }

    /// The name of a new pose is the first thing one wants to change.
    void nameIt(int pose) {
        showAll();
        if (!isVisible() || pose >= list_->count()) return;
        list_->setFocus();
        list_->editItem(list_->item(pose));
    }

    void showAll() {
        const PoseBook& book = desk_.book();
        stack_->setCurrentIndex(book.sequence.poses.empty() ? 0 : 1);
        showList();
        showTimeline();
        follow();
    }

    void showList() {
        const PoseSequence sequence = sequenceFor(desk_.book(), desk_.actuatorNames());
        const QSignalBlocker quiet(list_);
        const bool same = static_cast<std::size_t>(list_->count()) == sequence.poses.size();
        if (!same || listed_ != sequence.poses) {
            // A row that stays is kept, so that a name being typed elsewhere is not lost.
            while (list_->count() > static_cast<int>(sequence.poses.size())) delete list_->takeItem(list_->count() - 1);
            for (std::size_t k = 0; k < sequence.poses.size(); ++k) showRow(static_cast<int>(k), sequence.poses[k]);
            listed_ = sequence.poses;
        } else {
            for (std::size_t k = 0; k < sequence.poses.size(); ++k)
                list_->item(static_cast<int>(k))->setText(QString::fromStdString(sequence.poses[k].name));
        }
        list_->setCurrentRow(desk_.pose());
    }

    void showRow(int row, const NamedPose& pose) {
        QListWidgetItem* item = list_->item(row);
        if (!item) {
            item = new QListWidgetItem(list_);
            item->setFlags(item->flags() | Qt::ItemIsEditable);
        }
        item->setText(QString::fromStdString(pose.name));
        item->setIcon(barsOf(pose.strokes, devicePixelRatioF()));
    }

    void makeRoom() { timeline_->setRoom(scroll_->viewport()->width()); }

    void showTimeline() {
        const PoseSequence& set = desk_.book().sequence;
        const auto planned = desk_.planned();
        makeRoom();
        timeline_->setSequence(set, planned.value_or(set));
        timeline_->setChosen(desk_.step());
        const bool any = !set.steps.empty();
        scroll_->setVisible(any);
        hint_->setVisible(!any);
        form_->setVisible(any);
        const bool chosen = desk_.step() >= 0;
        for (QWidget* part : std::initializer_list<QWidget*>{travel_, hold_, easing_}) part->setEnabled(chosen);
        title_->setText(chosen ? QString("Step %1").arg(desk_.step() + 1) : QString("Choose a step"));
        if (chosen) {
            const PoseStep& step = set.steps[static_cast<std::size_t>(desk_.step())];
            travel_->setValue(step.travelSeconds);
            hold_->setValue(step.holdSeconds);
            easing_->setCurrentIndex(static_cast<int>(std::ranges::find(kEasings, step.easing) - kEasings.begin()));
        }
        const auto say = [](QLabel* label, const QString& text) {
            label->setText(text);
            label->setVisible(!text.isEmpty());
        };
        say(fit_, desk_.fitText());
    }

    /// What changes while the device moves.
    void follow() {
        if (!isVisible()) return;
        const auto planned = desk_.planned();
        if (planned) timeline_->setSequence(desk_.book().sequence, *planned);
        const QString slow = desk_.slowedText();
        slowed_->setText(slow);
        slowed_->setVisible(!slow.isEmpty());
        const auto seconds = desk_.seconds();
        timeline_->setPlayhead(seconds);
        time_->setText(
            planned ? QString("%1 / %2 s").arg(seconds.value_or(0.0), 0, 'f', 1).arg(durationOf(*planned), 0, 'f', 1)
                    : QString());
        if (seconds) scroll_->ensureVisible(static_cast<int>(timeline_->playheadX()), 0, 40, 0);
        if (desk_.state() == PoseDesk::State::playing) refresh_->request();
    }

    Studio& studio_;
    PoseDesk& desk_;
    QStackedLayout* stack_;
    QListWidget* list_;
    PoseTimeline* timeline_;
    QScrollArea* scroll_;
    Throttle* refresh_;
    QLabel *time_ = nullptr, *hint_ = nullptr, *fit_ = nullptr, *slowed_ = nullptr, *title_ = nullptr;
    QWidget* form_ = nullptr;
    ValueField *travel_ = nullptr, *hold_ = nullptr;
    QComboBox* easing_ = nullptr;
    std::vector<NamedPose> listed_;
};

} // namespace

QWidget* makePoseDock(Studio& studio, PoseDesk& desk) { return new PoseDock(studio, desk); }

} // namespace lumorph::studio
