#include "app/workspaces/field/field_central_view.h"

#include <QGridLayout>
#include <QLabel>

#include "app/studio/widgets/dock_parts.h"
#include "app/studio/widgets/panel.h"
#include "app/workspaces/common/body_axes.h"

namespace lumorph::studio {

namespace {

constexpr int kViewMargin = 16;
constexpr int kNoticeWidth = 480;
constexpr int kNarrow = 800;
constexpr int kMarksHeight = 56; ///< of the axes and the words beside them

QFrame* makeBar(QWidget* parent) {
    auto* bar = new QFrame(parent);
    bar->setFrameShape(QFrame::VLine);
    bar->setFixedHeight(20);
    return bar;
}

} // namespace

FieldCentralView::FieldCentralView(Studio& studio, Throttle& numbers, QWidget* parent)
    : QWidget(parent), studio_(studio), viewport_(new ViewportWidget(studio.renderer, this)),
      readout_(new FitReadout(this)), timeline_(new Timeline(studio, this)) {
    setObjectName("field.stage");
    viewport_->setObjectName("field.viewport");
    viewport_->setAccessibleName("Device and target");
    new BodyAxes(studio, viewport_);
    // All lie in the same grid: the viewport fills it, the others keep to its corners.
    auto* grid = new QGridLayout(this);
    grid->setContentsMargins(0, 0, 0, 0);
    grid->setSpacing(0);
    grid->addWidget(viewport_, 0, 0, 3, 3);
    const auto lay = [grid](QWidget* widget, int row, Qt::Alignment alignment) {
        auto* padded = new QVBoxLayout;
        padded->setContentsMargins(kViewMargin, kViewMargin, kViewMargin, kViewMargin);
        padded->addWidget(widget);
        grid->addLayout(padded, row, 0, 1, 3, alignment);
        widget->raise();
        return padded;
    };
    lay(tools_ = makeTools(), 0, Qt::AlignLeft | Qt::AlignTop);
    lay(makeHint(), 1, Qt::AlignCenter);
    lay(notices_ = makeNotices(), 1, Qt::AlignHCenter | Qt::AlignTop);
    timelineMargins_ = lay(timeline_, 2, Qt::AlignHCenter | Qt::AlignBottom);
    readoutMargins_ = lay(readout_, 2, Qt::AlignRight | Qt::AlignBottom);
    grid->setRowStretch(1, 1);
    connect(&numbers, &Throttle::due, this, [this] {
        if (studio_.loop.frame()) readout_->show(*studio_.loop.frame());
    });
    refresh();
}

void FieldCentralView::resizeEvent(QResizeEvent* event) {
    QWidget::resizeEvent(event);
    // Side by side where there is room; else above each other, and above the marks in the corner.
    const bool narrow = width() < kNarrow;
    const int below = narrow ? kViewMargin + kMarksHeight : kViewMargin;
    timelineMargins_->setContentsMargins(kViewMargin, kViewMargin, kViewMargin, below);
    readout_->setCompact(narrow);
    const int timeline = narrow ? timeline_->sizeHint().height() + kViewMargin / 2 : 0;
    readoutMargins_->setContentsMargins(kViewMargin, kViewMargin, kViewMargin, below + timeline);
}

QWidget* FieldCentralView::makeTools() {
    auto* card = new FloatingCard(this);
    card->setObjectName("field.tools");
    auto* layout = new QHBoxLayout(card);
    layout->setContentsMargins(4, 4, 4, 4);
    layout->setSpacing(4);
    const auto add = [&](const char* command) {
        layout->addWidget(makeCommandIcon(studio_.commands.find(command), QString("tools.") + command, card));
    };
    add("target.open");
    layout->addWidget(makeBar(card));
    add("target.fit");
    add("target.autoPlace");
    add("view.gizmo");
    layout->addWidget(makeBar(card));
    add("target.spin");
    add("match.live");
    layout->addWidget(makeBar(card));
    add("view.frameAll");
    layout->addWidget(makeBar(card));
    add("field.story");
    return card;
}

QWidget* FieldCentralView::makeHint() {
    hint_ = new FloatingCard(this);
    hint_->setObjectName("field.hint");
    auto* title = new QLabel("Drop a 3D model here", hint_);
    title->setProperty("look", "title");
    title->setAlignment(Qt::AlignHCenter);
    auto* text = new QLabel("and watch the device take its shape. OBJ, STL, PLY, OFF or glTF, moving ones too.", hint_);
    text->setProperty("look", "muted");
    text->setAlignment(Qt::AlignHCenter);
    text->setWordWrap(true);
    auto* open = makeCommandButton(studio_.commands.find("target.open"), "hint.open", hint_, true);
    auto* buttons = new QHBoxLayout;
    buttons->setSpacing(8);
    buttons->addStretch(1);
    buttons->addWidget(open);
    buttons->addWidget(makeCommandButton(studio_.commands.find("target.bloom"), "hint.bloom", hint_));
    buttons->addStretch(1);
    auto* layout = new QVBoxLayout(hint_);
    layout->setContentsMargins(24, 24, 24, 24);
    layout->setSpacing(8);
    layout->addWidget(title);
    layout->addWidget(text);
    layout->addSpacing(8);
    layout->addLayout(buttons);
    hint_->setFixedWidth(360);
    return hint_;
}

QWidget* FieldCentralView::makeNotices() {
    auto* column = new QWidget(this);
    column->setMaximumWidth(kNoticeWidth);
    auto* layout = new QVBoxLayout(column);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(8);
    layout->addWidget(makeNoticeBar(studio_.notices, "viewport", column));
    layout->addWidget(makeNoticeBar(studio_.notices, "project", column));
    targetNotices_ = new QWidget(column);
    auto* held = new QVBoxLayout(targetNotices_);
    held->setContentsMargins(0, 0, 0, 0);
    held->addWidget(makeNoticeBar(studio_.notices, "target", targetNotices_));
    layout->addWidget(targetNotices_);
    layout->addWidget(makeNoticeBar(studio_.notices, "export", column));
    layout->addWidget(makeJobBar(studio_.jobs, "", column));
    return column;
}

void FieldCentralView::setTargetNoticesShown(bool shown) { targetNotices_->setVisible(shown); }

void FieldCentralView::setForVisitors(bool on) {
    forVisitors_ = on;
    tools_->setVisible(!on);
    notices_->setVisible(!on);
    refresh();
}

void FieldCentralView::refresh() {
    const StudioState& state = studio_.document.state();
    hint_->setVisible(!forVisitors_ && !state.target.target && state.rig.rig);
    timeline_->refresh();
    if (forVisitors_) timeline_->hide();
    if (!state.target.target) readout_->hide();
}

} // namespace lumorph::studio
