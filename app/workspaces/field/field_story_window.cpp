#include "app/workspaces/field/field_story_window.h"

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

#include <QApplication>
#include <QButtonGroup>
#include <QComboBox>
#include <QDialog>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QShortcut>
#include <QSlider>
#include <QSplitter>
#include <QStackedWidget>
#include <QTimer>
#include <QToolButton>

#include "app/studio/document/job_slots.h"
#include "app/studio/look/icons.h"
#include "app/studio/viewport/viewport_widget.h"
#include "app/studio/widgets/dock_parts.h"
#include "app/studio/widgets/panel.h"
#include "app/studio/widgets/throttle.h"
#include "app/workspaces/common/field_colors.h"
#include "app/workspaces/field/story_canvas.h"
#include "app/workspaces/field/story_export.h"
#include "app/workspaces/field/story_scene.h"

namespace lumorph::studio {

namespace {

constexpr const char* kWindowName = "story.window";
const QString kStoryPlace = QStringLiteral("story");
const QString kFieldPlaceOfBuild = QStringLiteral("field");
constexpr int kAgainMilliseconds = 150;
constexpr int kRunMilliseconds = 3000; ///< through all levels

/// From the front, a little from the right and from above: what is in front of the plane is cut away.
ViewCamera storyCamera() {
    ViewCamera camera;
    camera.yaw = Angle::degrees(28.0);
    camera.pitch = Angle::degrees(24.0);
    return camera;
}

/// The target as it stands at this moment.
StoryTarget targetNow(Studio& studio) {
    const StudioState& state = studio.document.state();
    StoryTarget now{state.target.target, state.placement.deviceFromTarget(), 0.0, state.placement.relief};
    const auto& frame = studio.loop.frame();
    if (!frame || !now.target || frame->target != now.target) return now;
    now.seconds = frame->seconds;
    if (frame->turned != Angle()) now.deviceFromTarget = frame->deviceFromTarget;
    return now;
}

class FieldStoryWindow : public QDialog {
public:
    FieldStoryWindow(Studio& studio, QWidget* parent);

    /// Begins at the first step, with what is open now.
    void begin();

protected:
    void showEvent(QShowEvent* event) override;
    void hideEvent(QHideEvent* event) override;

private:
    QWidget* makeSteps();
    QWidget* makePictures();
    QWidget* makeControls();
    QWidget* makeNoTarget();
    QWidget* makeMissing();
    QWidget* makeFoot();
    QWidget* makeLabelled(const QString& text, QWidget* control, QHBoxLayout& row);
    void addKeys();
    void listen();

    void tellAgain(); ///< of what the document holds now
    void buildWhereMissing();
    void take(const std::shared_ptr<const Story>& story);
    void countReach();
    void goTo(int step);
    void setView(const StoryView& view);
    void setPlane(const VoxelPlane& plane);
    void run(bool on);
    void runOn();
    void showNow();
    void showControls();
    void showScene(); ///< made beside the window; while one is at work the newest waits
    [[nodiscard]] StoryPicture picture() const { return {story_, reach_, view_}; }
    [[nodiscard]] StoryShot shot() const;

    Studio& studio_;
    JobSlots jobs_;
    std::shared_ptr<const Story> story_;
    std::shared_ptr<const JointReach> reach_;
    std::weak_ptr<const MatchField> reachOf_;
    std::shared_ptr<StorySceneBuilder> builder_;
    StoryView view_;
    bool planeChosen_ = false; ///< by the user, so that it stays
    bool sceneBusy_ = false, sceneAgain_ = false, unframed_ = true;
    std::weak_ptr<const MatchField> framedField_;

    QButtonGroup* steps_ = new QButtonGroup(this);
    QLabel *title_ = new QLabel, *text_ = new QLabel, *stale_ = new QLabel;
    QStackedWidget* pages_ = new QStackedWidget;
    QLabel* missing_ = new QLabel;
    QPushButton* build_ = new QPushButton;
    StoryCanvas* canvas_ = new StoryCanvas;
    ViewportWidget* view3d_;
    QStackedWidget* cuts_ = new QStackedWidget; ///< the plane, or what to do without a target
    QComboBox *actuator_ = new QComboBox, *side_ = new QComboBox;
    QSlider *level_ = new QSlider(Qt::Horizontal), *plane_ = new QSlider(Qt::Horizontal);
    QLabel *levelText_ = nullptr, *planeText_ = nullptr;
    QToolButton* run_ = new QToolButton;
    std::array<QWidget*, 2> actuatorParts_{}, levelParts_{};
    QPushButton *back_ = new QPushButton, *next_ = new QPushButton, *picture_ = new QPushButton,
                *video_ = new QPushButton;
    std::array<QShortcut*, 2> arrows_{};
    QTimer running_;
    Throttle again_{kAgainMilliseconds}; ///< while something is dragged
};

FieldStoryWindow::FieldStoryWindow(Studio& studio, QWidget* parent)
    : QDialog(parent), studio_(studio), jobs_(*this, studio.jobs, studio.notices),
      view3d_(new ViewportWidget(studio.renderer)) {
    setObjectName(kWindowName);
    setWindowTitle(tr("How the field works"));
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(16, 12, 16, 16);
    layout->setSpacing(8);
    layout->addWidget(makeSteps());
    title_->setObjectName("story.title");
    title_->setProperty("look", "title");
    text_->setObjectName("story.text");
    text_->setWordWrap(true);
    text_->setMinimumHeight(2 * text_->fontMetrics().lineSpacing() + 4);
    text_->setAlignment(Qt::AlignLeft | Qt::AlignTop);
    stale_->setObjectName("story.stale");
    stale_->setProperty("look", "warning");
    stale_->setText(tr("The field is of the rig before your edit; so is this story."));
    layout->addWidget(title_);
    layout->addWidget(text_);
    layout->addWidget(stale_);
    for (const char* place : {"story", "export"}) {
        layout->addWidget(makeNoticeBar(studio.notices, place));
        layout->addWidget(makeJobBar(studio.jobs, place));
    }
    pages_->addWidget(makePictures());
    pages_->addWidget(makeMissing());
    layout->addWidget(pages_, 1);
    layout->addWidget(makeControls());
    layout->addWidget(makeFoot());
    addKeys();
    listen();
    const QSize wanted(1360, 860);
    resize(parent ? wanted.boundedTo(parent->window()->size() - QSize(32, 48)).expandedTo(QSize(960, 620)) : wanted);
}

QWidget* FieldStoryWindow::makeSteps() {
    auto* row = new QWidget;
    auto* layout = new QHBoxLayout(row);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(4);
    for (int step = 0; step < kStorySteps; ++step) {
        auto* button = new QToolButton;
        const QString name = nameOf(static_cast<StoryStep>(step));
        button->setObjectName(QString("story.step.%1").arg(step + 1));
        button->setText(QString("%1  %2").arg(step + 1).arg(name));
        button->setAccessibleName(tr("Step %1, %2").arg(step + 1).arg(name));
        button->setCheckable(true);
        steps_->addButton(button, step);
        layout->addWidget(button);
    }
    layout->addStretch(1);
    connect(steps_, &QButtonGroup::idClicked, this, &FieldStoryWindow::goTo);
    return row;
}

QWidget* FieldStoryWindow::makePictures() {
    auto* split = new QSplitter(Qt::Horizontal);
    split->setChildrenCollapsible(false);
    cuts_->addWidget(canvas_);
    cuts_->addWidget(makeNoTarget());
    split->addWidget(cuts_);
    view3d_->setObjectName("story.view");
    view3d_->setAccessibleName(tr("The same on the device, cut open at the plane"));
    view3d_->setMinimumWidth(280);
    split->addWidget(view3d_);
    split->setStretchFactor(0, 62);
    split->setStretchFactor(1, 38);
    split->setSizes({820, 500});
    connect(canvas_, &StoryCanvas::actuatorChosen, this,
            [this](int actuator) { actuator_->setCurrentIndex(actuator); });
    connect(canvas_, &StoryCanvas::levelChosen, level_, &QSlider::setValue);
    connect(canvas_, &StoryCanvas::planeMoved, this, [this](int by) { plane_->setValue(plane_->value() + by); });
    return split;
}

QWidget* FieldStoryWindow::makeNoTarget() {
    auto* page = new QWidget;
    auto* layout = new QVBoxLayout(page);
    layout->addStretch(1);
    layout->addWidget(makeEmptyState("target", tr("No target yet"),
                                     tr("From here on the story is told with the shape that the device is to take."),
                                     studio_.commands.find("target.open")));
    layout->addWidget(makeCommandButton(studio_.commands.find("target.dunes"), "story.target.dunes", page), 0,
                      Qt::AlignHCenter);
    layout->addStretch(1);
    return page;
}

QWidget* FieldStoryWindow::makeMissing() {
    auto* page = new QWidget;
    auto* layout = new QVBoxLayout(page);
    missing_->setObjectName("story.missing");
    missing_->setAlignment(Qt::AlignCenter);
    missing_->setWordWrap(true);
    build_->setObjectName("story.build");
    build_->setText(tr("Build the field"));
    build_->setProperty("look", "primary");
    connect(build_, &QPushButton::clicked, this, [this] { studio_.project.buildField({}); });
    layout->addStretch(1);
    layout->addWidget(missing_);
    layout->addWidget(makeNoticeBar(studio_.notices, kFieldPlaceOfBuild));
    layout->addWidget(makeJobBar(studio_.jobs, kFieldPlaceOfBuild));
    layout->addWidget(build_, 0, Qt::AlignHCenter);
    layout->addStretch(1);
    return page;
}

QWidget* FieldStoryWindow::makeLabelled(const QString& text, QWidget* control, QHBoxLayout& row) {
    auto* label = new QLabel(text);
    label->setBuddy(control);
    label->setProperty("look", "muted");
    row.addWidget(label);
    row.addWidget(control);
    return label;
}

QWidget* FieldStoryWindow::makeControls() {
    auto* controls = new QWidget;
    auto* row = new QHBoxLayout(controls);
    row->setContentsMargins(0, 0, 0, 0);
    row->setSpacing(8);
    actuator_->setObjectName("story.actuator");
    actuator_->setAccessibleName(tr("Actuator"));
    actuator_->setMinimumContentsLength(16);
    actuatorParts_ = {makeLabelled(tr("&Actuator"), actuator_, *row), actuator_};
    level_->setObjectName("story.level");
    level_->setAccessibleName(tr("Level"));
    levelParts_ = {makeLabelled(tr("&Level"), level_, *row), level_};
    row->setStretchFactor(level_, 2);
    row->addWidget(levelText_ = makeNumber("story.level.value", "200", controls));
    run_->setObjectName("story.run");
    run_->setIcon(icon("play"));
    run_->setCheckable(true);
    run_->setToolTip(tr("Runs through all levels"));
    run_->setAccessibleName(tr("Run through all levels"));
    row->addWidget(run_);
    side_->setObjectName("story.side");
    side_->setAccessibleName(tr("From which side the cut is seen"));
    side_->addItems({tr("from the front"), tr("from the right")});
    makeLabelled(tr("&Cut, seen"), side_, *row);
    plane_->setObjectName("story.plane");
    plane_->setAccessibleName(tr("Place of the cut along the device"));
    plane_->setToolTip(tr("Moves the cut along the device; the wheel over the picture does too"));
    row->addWidget(plane_, 2);
    row->addWidget(planeText_ = makeNumber("story.plane.value", "4096", controls));
    connect(actuator_, &QComboBox::currentIndexChanged, this, [this](int index) {
        if (index < 0 || !story_) return;
        StoryView view = view_;
        view.actuator = static_cast<std::size_t>(index);
        planeChosen_ = false;
        setView(view);
    });
    connect(level_, &QSlider::valueChanged, this, [this](int level) {
        StoryView view = view_;
        view.level = level;
        setView(view);
    });
    connect(level_, &QSlider::actionTriggered, this, [this] { run(false); });
    connect(level_, &QSlider::sliderPressed, this, [this] { run(false); });
    connect(run_, &QToolButton::toggled, this, &FieldStoryWindow::run);
    connect(side_, &QComboBox::activated, this, [this](int index) {
        const int axis = index == 0 ? 2 : 0;
        if (story_) setPlane({axis, story_->field->field.frame.dimensions[axis] / 2});
    });
    connect(plane_, &QSlider::valueChanged, this, [this](int index) { setPlane({view_.plane.axis, index}); });
    connect(&running_, &QTimer::timeout, this, &FieldStoryWindow::runOn);
    return controls;
}

QWidget* FieldStoryWindow::makeFoot() {
    auto* foot = new QWidget;
    auto* row = new QHBoxLayout(foot);
    row->setContentsMargins(0, 0, 0, 0);
    row->setSpacing(8);
    const auto add = [&](QPushButton* button, const QString& name, const QString& text, const QString& tip) {
        button->setObjectName(name);
        button->setText(text);
        button->setToolTip(tip);
        button->setAutoDefault(false);
        row->addWidget(button);
    };
    add(picture_, "story.picture", tr("Export &picture..."), tr("This step as a page, PNG of any size"));
    add(video_, "story.video", tr("Export &video..."), tr("All steps one after the other, MP4"));
    row->addStretch(1);
    add(back_, "story.back", tr("&Back"), tr("The step before (left arrow)"));
    add(next_, "story.next", tr("&Next"), tr("The next step (right arrow)"));
    next_->setProperty("look", "primary");
    next_->setDefault(true);
    connect(back_, &QPushButton::clicked, this, [this] { goTo(static_cast<int>(view_.step) - 1); });
    connect(next_, &QPushButton::clicked, this, [this] {
        if (static_cast<int>(view_.step) + 1 == kStorySteps) return accept();
        goTo(static_cast<int>(view_.step) + 1);
    });
    connect(picture_, &QPushButton::clicked, this, [this] { exportStoryPicture(studio_, this, shot()); });
    connect(video_, &QPushButton::clicked, this, [this] { exportStoryVideo(studio_, this, shot()); });
    return foot;
}

/// Left and right arrow step, but where a slider or the view takes them.
void FieldStoryWindow::addKeys() {
    arrows_ = {new QShortcut(Qt::Key_Left, this), new QShortcut(Qt::Key_Right, this)};
    for (std::size_t k = 0; k < arrows_.size(); ++k)
        connect(arrows_[k], &QShortcut::activated, this,
                [this, by = k == 0 ? -1 : 1] { goTo(static_cast<int>(view_.step) + by); });
    for (const auto& [key, by] : {std::pair{Qt::Key_PageUp, -1}, std::pair{Qt::Key_PageDown, 1}})
        connect(new QShortcut(key, this), &QShortcut::activated, this,
                [this, by = by] { goTo(static_cast<int>(view_.step) + by); });
    connect(qApp, &QApplication::focusChanged, this, [this](QWidget*, QWidget* now) {
        const bool own = qobject_cast<QSlider*>(now) != nullptr;
        for (QShortcut* arrow : arrows_) arrow->setEnabled(!own);
    });
}

void FieldStoryWindow::listen() {
    connect(&studio_.document, &StudioDocument::changed, this, [this](StateParts parts) {
        const StateParts ours = StateParts(StatePart::rig) | StatePart::rigEdited | StatePart::field |
                                StatePart::target | StatePart::placement;
        if (isVisible() && (parts & ours)) again_.request();
    });
    connect(&again_, &Throttle::due, this, [this] {
        if (isVisible()) tellAgain();
    });
    connect(&studio_.jobs, &Jobs::finished, this, [this] {
        if (isVisible() && !story_) showControls();
    });
    connect(&studio_.settings, &Settings::themeChanged, this, [this] {
        builder_.reset();
        canvas_->setColors(currentPalette());
        showNow();
    });
}

void FieldStoryWindow::showEvent(QShowEvent* event) {
    QDialog::showEvent(event);
    view3d_->setActive(true);
}

void FieldStoryWindow::hideEvent(QHideEvent* event) {
    run(false);
    view3d_->setActive(false);
    jobs_.stop("story");
    jobs_.stop("reach");
    if (!reach_) reachOf_.reset();
    QDialog::hideEvent(event);
}

void FieldStoryWindow::begin() {
    view_.step = StoryStep::states;
    planeChosen_ = false;
    QDialog::show();
    raise();
    activateWindow();
    next_->setFocus();
    tellAgain();
    buildWhereMissing();
    run(true);
}

void FieldStoryWindow::buildWhereMissing() {
    const StudioState& state = studio_.document.state();
    const std::vector<Jobs::Status> jobs = studio_.jobs.running();
    const bool coming =
        std::ranges::any_of(jobs, [](const Jobs::Status& job) { return job.place == kFieldPlaceOfBuild; });
    const bool moves = state.rig.rig && state.rig.rig->actuatorCount() > 0;
    if (moves && !state.field.field && !coming) studio_.project.buildField({});
}

void FieldStoryWindow::tellAgain() {
    const auto& held = studio_.document.state().field;
    stale_->setVisible(held.field && held.stale);
    if (!held.field || held.field->field.actuators.empty()) {
        story_.reset();
        return showNow();
    }
    jobs_.run<std::shared_ptr<const Story>>(
        "story", kStoryPlace, tr("Preparing the story"),
        [field = held.field, target = targetNow(studio_)](const Progress& progress) {
            return makeStory(field, target, progress);
        },
        [this](const std::shared_ptr<const Story>& story) { take(story); });
}

void FieldStoryWindow::take(const std::shared_ptr<const Story>& story) {
    const bool same = story_ && story_->field == story->field;
    story_ = story;
    if (!same) {
        unframed_ = framedField_.lock() != story->field;
        const QSignalBlocker quiet(actuator_);
        actuator_->clear();
        for (const ActuatorField& one : story->field->field.actuators)
            actuator_->addItem(QString::fromStdString(one.name));
        if (view_.actuator >= story->rig->actuatorCount()) view_.actuator = 0;
        actuator_->setCurrentIndex(static_cast<int>(view_.actuator));
        view_.level = running_.isActive() ? 0 : story->field->field.levels - 1;
        planeChosen_ = false;
    }
    countReach();
    setView(view_);
}

void FieldStoryWindow::countReach() {
    if (reachOf_.lock() == story_->field) return;
    reachOf_ = story_->field;
    reach_.reset();
    jobs_.run<std::shared_ptr<const JointReach>>(
        "reach", kStoryPlace, tr("Counting what only two actuators together reach"),
        [field = story_->field](const Progress& progress) -> std::shared_ptr<const JointReach> {
            return std::make_shared<const JointReach>(jointReach(field->coverage, progress));
        },
        [this](const std::shared_ptr<const JointReach>& reach) {
            reach_ = reach;
            if (story_) setView(view_);
        });
}

void FieldStoryWindow::goTo(int step) {
    StoryView view = view_;
    view.step = static_cast<StoryStep>(std::clamp(step, 0, kStorySteps - 1));
    if (view.step != view_.step) planeChosen_ = false;
    if (!story_) {
        view_ = view;
        return showNow();
    }
    const bool levels = view.step <= StoryStep::field;
    if (levels && view.step != view_.step) view.level = 0;
    setView(view);
    run(levels);
}

void FieldStoryWindow::setView(const StoryView& view) {
    view_ = view;
    if (story_ && !planeChosen_) view_.plane = tellingPlane(picture());
    showNow();
}

void FieldStoryWindow::setPlane(const VoxelPlane& plane) {
    if (!story_ || plane == view_.plane) return;
    view_.plane = plane;
    planeChosen_ = true;
    showNow();
}

void FieldStoryWindow::run(bool on) {
    const bool runs = on && story_ && view_.step <= StoryStep::field;
    {
        const QSignalBlocker quiet(run_);
        run_->setChecked(runs);
    }
    run_->setIcon(icon(runs ? "pause" : "play"));
    if (!runs && on) return running_.start(100); // begins with the story
    if (!runs) return running_.stop();
    if (view_.level + 1 >= story_->field->field.levels) level_->setValue(0);
    running_.start(std::max(16, kRunMilliseconds / story_->field->field.levels));
}

void FieldStoryWindow::runOn() {
    if (!story_) return;
    if (!run_->isChecked()) return run(view_.step <= StoryStep::field);
    if (view_.level + 1 >= story_->field->field.levels) return run(false);
    level_->setValue(view_.level + 1);
}

void FieldStoryWindow::showNow() {
    showControls();
    if (!story_) return;
    const StoryWords words = wordsOf(picture());
    title_->setText(words.title);
    text_->setText(words.text);
    if (canBeTold(picture())) canvas_->setPicture(picture());
    showScene();
}

void FieldStoryWindow::showControls() {
    const int step = static_cast<int>(view_.step);
    if (QAbstractButton* button = steps_->button(step)) button->setChecked(true);
    pages_->setCurrentIndex(story_ ? 0 : 1);
    back_->setEnabled(step > 0);
    next_->setText(step + 1 < kStorySteps ? tr("&Next") : tr("&Done"));
    for (QWidget* part : {static_cast<QWidget*>(picture_), static_cast<QWidget*>(video_)})
        part->setEnabled(story_ != nullptr);
    const bool levels = story_ && view_.step <= StoryStep::field;
    const bool actuators = levels || (story_ && view_.step == StoryStep::votes && story_->match);
    for (QWidget* part : actuatorParts_) part->setVisible(actuators);
    for (QWidget* part : levelParts_) part->setVisible(levels);
    levelText_->setVisible(levels);
    run_->setVisible(levels);
    cuts_->setCurrentIndex(!story_ || canBeTold(picture()) ? 0 : 1);
    side_->setEnabled(story_ != nullptr);
    plane_->setEnabled(story_ != nullptr);
    if (!story_) {
        const bool rig = studio_.document.state().rig.rig != nullptr;
        const std::vector<Jobs::Status> jobs = studio_.jobs.running();
        const bool moves = rig && studio_.document.state().rig.rig->actuatorCount() > 0;
        const bool coming = moves && !jobs.empty();
        title_->setText(nameOf(view_.step));
        text_->clear();
        missing_->setText(
            !rig     ? tr("No rig is open. Open or make one; the story is told of it.")
            : !moves ? tr("This device has no actuators yet. Add one; the story is told of what it moves.")
            : coming ? tr("This device has no field yet. It is being built; the story begins when it is there.")
                     : tr("This device has no field yet. The story is told of its own."));
        build_->setVisible(moves && !coming);
        return;
    }
    const QSignalBlocker quietLevel(level_), quietPlane(plane_), quietSide(side_);
    level_->setRange(0, story_->field->field.levels - 1);
    level_->setValue(view_.level);
    levelText_->setText(QString::number(view_.level));
    side_->setCurrentIndex(view_.plane.axis == 2 ? 0 : 1);
    plane_->setRange(0, story_->field->field.frame.dimensions[view_.plane.axis] - 1);
    plane_->setValue(view_.plane.index);
    planeText_->setText(QString::number(view_.plane.index));
}

void FieldStoryWindow::showScene() {
    sceneAgain_ = sceneBusy_;
    if (sceneBusy_) return;
    sceneBusy_ = true;
    if (!builder_) builder_ = std::make_shared<StorySceneBuilder>(fieldSceneColors(studio_.settings.theme()));
    using Scene = std::shared_ptr<const ViewportScene>;
    const auto over = [this] {
        sceneBusy_ = false;
        if (std::exchange(sceneAgain_, false) && story_) showScene();
    };
    jobs_.runWith<Scene>(
        "scene", kStoryPlace, tr("Drawing the device"),
        [builder = builder_, picture = picture()](const Progress&) { return builder->build(picture); },
        [this, over](const Scene& scene) {
            view3d_->setScene(scene);
            if (std::exchange(unframed_, false) && view3d_->height() > 1) {
                framedField_ = story_ ? story_->field : nullptr;
                const float aspect = static_cast<float>(view3d_->width()) / static_cast<float>(view3d_->height());
                view3d_->setCamera(framed(storyCamera(), scene->bounds, aspect, 0.92F));
            }
            over();
        },
        [over](const std::exception&) { over(); });
}

StoryShot FieldStoryWindow::shot() const {
    return {picture(), view3d_->camera(), static_cast<double>(view3d_->width()) / std::max(1, view3d_->height())};
}

} // namespace

void addFieldStory(Studio& studio, const std::function<QWidget*()>& parent) {
    Commands::Options options;
    options.icon = "help";
    options.menu = "Help";
    QAction* action =
        studio.commands.add("field.story", QObject::tr("How the &field works"), options, [&studio, parent] {
            QWidget* window = parent();
            if (window == nullptr) return;
            auto* open = dynamic_cast<FieldStoryWindow*>(window->findChild<QDialog*>(kWindowName));
            (open ? open : new FieldStoryWindow(studio, window))->begin();
        });
    action->setToolTip(QObject::tr("The mechanical distance field in six steps, on your own device"));
}

} // namespace lumorph::studio
