#include "app/workspaces/scene/scene_central_view.h"

#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include <QVBoxLayout>
#include <QVariantAnimation>

#include "app/applications/demo.h"
#include "app/studio/rendering/show_frames.h"
#include "app/studio/shell/program_inputs.h"
#include "app/studio/viewport/gl_page.h"
#include "app/studio/viewport/viewport_widget.h"
#include "app/studio/widgets/panel.h"
#include "app/workspaces/common/body_axes.h"
#include "app/workspaces/common/field_colors.h"
#include "app/workspaces/common/field_scene.h"
#include "app/workspaces/scene/eye_orbit.h"
#include "app/workspaces/scene/item_handles.h"
#include "app/workspaces/scene/item_pick.h"
#include "app/workspaces/scene/latency_card.h"
#include "app/workspaces/scene/simulated_eye.h"
#include "app/workspaces/scene/view_bar.h"
#include "app/workspaces/scene/view_pane.h"
#include "core/base/error.h"
#include "core/loop/bend_comparison.h"

namespace lumorph::studio {
namespace {

constexpr int kViewMargin = 12;
constexpr int kNoticeWidth = 480;
constexpr int kInlayMargin = 20;
constexpr double kInlayLower = 0.3; ///< radians
constexpr int kFadeMilliseconds = 900;

/// The angle between two ways to look at a centre.
double degreesBetween(const glm::vec3& a, const glm::vec3& b, const glm::vec3& centre) {
    const glm::dvec3 u = glm::normalize(glm::dvec3(a - centre));
    const glm::dvec3 v = glm::normalize(glm::dvec3(b - centre));
    return Angle::radians(std::acos(std::clamp(glm::dot(u, v), -1.0, 1.0))).inDegrees();
}

ShowView viewOf(ShowView::Kind kind, ShowView::Bend bend = ShowView::Bend::asItIs) {
    ShowView view;
    view.kind = kind;
    view.bend = bend;
    return view;
}

} // namespace

struct SceneCentralView::Data {
    Data(SceneCentralView& stage, Studio& shared);

    ViewPane* addPane(ScenePane part, const ShowView& view, const QString& title);
    void addDevice();
    void addInlay();
    void addFloating();
    void arrange();
    void showForVisitors(bool on);
    void arrangeInlay();
    void takeViewKey(int key);
    void enlarge(ScenePane part);
    void showScene();    ///< of the device
    void showCaptions(); ///< of all pictures
    void showReason();
    void compare(bool on);
    void say();
    void beginDrag(ScenePane part, Qt::MouseButton button, Qt::KeyboardModifiers modifiers);
    void drag(ScenePane part, const QPointF& by);
    void endDrag(bool taken);
    void zoom(ScenePane part, double notches);
    void click(ScenePane part, const QPointF& at);
    void setObserver(std::optional<glm::vec3> eye);
    [[nodiscard]] QWidget* widgetOf(ScenePane part) const;
    [[nodiscard]] std::optional<CalibratedCamera> cameraOf(ScenePane part, const QSize& size);
    [[nodiscard]] QString eyeState() const;
    [[nodiscard]] QString labState() const;

    SceneCentralView& self;
    Studio& studio;
    SimulatedEye viewer;
    FieldSceneBuilder builder;
    ViewBar* bar;
    QWidget* views;
    std::map<ScenePane, ViewPane*> panes;
    std::map<ScenePane, std::unique_ptr<ItemHandles>> handles;
    ViewPane* inlay = nullptr;          ///< the bare device, for visitors
    bool inlayHidden = false;           ///< by a key
    QVariantAnimation fade;             ///< of the light
    std::vector<ProgramInputs*> inputs; ///< of the panes that visitors may play in
    ViewportWidget* device = nullptr;
    PaneCaption* deviceCaption = nullptr;
    GlPage* page = nullptr;
    LatencyCard* latency = nullptr;
    QWidget* notices = nullptr;
    std::optional<ScenePane> alone;          ///< enlarged by a double click, or for visitors
    std::optional<ScenePane> aloneElsewhere; ///< for the host while visitors have it, and the other way round
    std::optional<glm::vec3> observer;
    BendComparison bends;   ///< for who points into halves of a comparison
    bool comparing = false; ///< the program that shows wants the halves seen
    bool observing = false; ///< this drag moves the observer, not the viewer
    bool active = false;
    bool forVisitors = false;
};

SceneCentralView::Data::Data(SceneCentralView& stage, Studio& shared)
    : self(stage), studio(shared), viewer(shared.document), bar(new ViewBar(shared, &stage)),
      views(new QWidget(&stage)) {
    builder.setPatient(false);
    auto* column = new QVBoxLayout(&self);
    column->setContentsMargins(0, 0, 0, 0);
    column->setSpacing(0);
    column->addWidget(bar);
    column->addWidget(views, 1);
    addPane(ScenePane::lab, viewOf(ShowView::Kind::lab), tr("Lab"));
    addPane(ScenePane::eye, viewOf(ShowView::Kind::eye), tr("Eye"));
    addPane(ScenePane::projector, viewOf(ShowView::Kind::projector), tr("Projector 1"));
    addPane(ScenePane::cropped, viewOf(ShowView::Kind::lab, ShowView::Bend::without), tr("Cropped"));
    addPane(ScenePane::uncropped, viewOf(ShowView::Kind::lab, ShowView::Bend::forViewer), tr("Uncropped"));
    addDevice();
    addInlay();
    addFloating();
}

ViewPane* SceneCentralView::Data::addPane(ScenePane part, const ShowView& view, const QString& title) {
    static const std::map<ScenePane, const char*> kNames{{ScenePane::lab, "scene.lab"},
                                                         {ScenePane::eye, "scene.eye"},
                                                         {ScenePane::projector, "scene.projector"},
                                                         {ScenePane::cropped, "scene.cropped"},
                                                         {ScenePane::uncropped, "scene.uncropped"}};
    auto* pane = new ViewPane(studio.show, view, title, views);
    pane->setObjectName(kNames.at(part));
    panes[part] = pane;
    connect(pane, &ViewPane::enlarged, &self, [this, part] { enlarge(part); });
    connect(pane, &ViewPane::viewKey, &self, [this](int key) { takeViewKey(key); });
    if (part == ScenePane::projector) return pane;
    inputs.push_back(new ProgramInputs(studio.loop, *pane));
    connect(pane, &ViewPane::dragBegan, &self,
            [this, part](Qt::MouseButton button, Qt::KeyboardModifiers held) { beginDrag(part, button, held); });
    connect(pane, &ViewPane::dragged, &self, [this, part](const QPointF& by) { drag(part, by); });
    connect(pane, &ViewPane::dragEnded, &self, [this](bool taken) { endDrag(taken); });
    connect(pane, &ViewPane::wheeled, &self, [this, part](double notches) { zoom(part, notches); });
    connect(pane, &ViewPane::clicked, &self, [this, part](const QPointF& at) { click(part, at); });
    const auto camera = [this, part](const QSize& size) { return cameraOf(part, size); };
    handles[part] = std::make_unique<ItemHandles>(studio.document, camera);
    pane->setOverlay(handles[part].get());
    return pane;
}

void SceneCentralView::Data::addDevice() {
    device = new ViewportWidget(studio.renderer, views);
    device->setObjectName("scene.viewport");
    device->setAccessibleName(tr("Device without light"));
    new BodyAxes(studio, device);
    deviceCaption = new PaneCaption(tr("Device"), device);
    deviceCaption->setText(tr("Device"), tr("without light"));
    builder.setColors(fieldSceneColors(studio.settings.theme()));
    connect(&studio.settings, &Settings::themeChanged, &self, [this] {
        builder.setColors(fieldSceneColors(studio.settings.theme()));
        showScene();
    });
    connect(&studio.loop, &StudioLoop::framed, &self, [this] {
        if (const auto& frame = studio.loop.frame()) {
            bar->setSeconds(frame->sceneSeconds);
            compare(frame->comparesBend);
        }
        showScene();
    });
}

/// A small view of the device without light: in the large one projected light hides that the shape changes.
void SceneCentralView::Data::addInlay() {
    ShowView bare = viewOf(ShowView::Kind::lab);
    bare.lit = false;
    bare.lower = kInlayLower;
    inlay = new ViewPane(studio.show, bare, tr("Device without light"), views);
    inlay->setObjectName("scene.inlay");
    inlay->setAttribute(Qt::WA_TransparentForMouseEvents);
    inlay->setFocusPolicy(Qt::NoFocus);
    inlay->setFramed(true);
    inlay->caption().hide();
    inlay->hide();
    connect(&studio.settings, &Settings::bareInlayChanged, &self, [this] { arrange(); });
    fade.setDuration(kFadeMilliseconds);
    fade.setStartValue(1.0);
    fade.setEndValue(0.0);
    connect(&fade, &QVariantAnimation::valueChanged, &self, [this](const QVariant& share) {
        for (const auto& [part, pane] : panes)
            if (part != ScenePane::projector) pane->setLight(share.toDouble());
    });
}

void SceneCentralView::Data::takeViewKey(int key) {
    if (key == Qt::Key_B) {
        inlayHidden = !inlayHidden;
        return arrangeInlay();
    }
    const bool away = fade.direction() == QVariantAnimation::Forward && fade.currentValue().toDouble() < 1.0;
    fade.setDirection(away ? QVariantAnimation::Backward : QVariantAnimation::Forward);
    if (fade.state() != QVariantAnimation::Running) fade.start();
}

void SceneCentralView::Data::arrangeInlay() {
    using Corner = BareInlay::Corner;
    const BareInlay wanted = studio.settings.bareInlay();
    const bool shown = forVisitors && !comparing && !inlayHidden && wanted.corner != Corner::none &&
                       alone != ScenePane::device && !page->isVisibleTo(views);
    const int wide = static_cast<int>(std::lround(wanted.share * views->width()));
    QRect box(kInlayMargin, kInlayMargin, wide, wide * 5 / 8);
    if (wanted.corner == Corner::topRight) box.moveRight(views->width() - kInlayMargin);
    if (wanted.corner == Corner::bottomLeft) box.moveBottom(views->height() - kInlayMargin);
    inlay->setGeometry(box);
    inlay->setVisible(shown);
    inlay->raise();
}

void SceneCentralView::Data::addFloating() {
    page = new GlPage([this] { studio.renderer.retry(); }, views);
    latency = new LatencyCard(studio.show, views);
    latency->hide();
    notices = new QWidget(views);
    auto* column = new QVBoxLayout(notices);
    column->setContentsMargins(0, 0, 0, 0);
    column->setSpacing(8);
    column->addWidget(makeNoticeBar(studio.notices, "viewport", notices));
    column->addWidget(makeNoticeBar(studio.notices, "project", notices));
    column->addWidget(makeNoticeBar(studio.notices, "output", notices));
    column->addWidget(makeNoticeBar(studio.notices, "visitors", notices));
    column->addWidget(makeNoticeBar(studio.notices, "calibrate", notices)); // of the watch
    column->addStretch(1);
    notices->setMaximumWidth(kNoticeWidth);
    connect(&studio.notices, &Notices::changed, &self, [this] { arrange(); });
    connect(&studio.settings, &Settings::languageChanged, &self, [this] { say(); });
    connect(&studio.renderer, &RenderThread::ready, &self, [this] { showReason(); });
    connect(&studio.project, &ProjectService::programOpened, &self, [this] {
        if (forVisitors) showForVisitors(true);
    });
    connect(&studio.show, &ShowFeed::shown, &self, [this] {
        const double seconds = studio.show.newest().match->sceneSeconds;
        for (const auto& [part, one] : handles) one->setSeconds(seconds);
        showCaptions();
    });
    connect(bar, &ViewBar::modeChanged, &self, [this] {
        alone.reset();
        arrange();
    });
    connect(bar, &ViewBar::elsewhereChanged, &self, [this] {
        if (!bar->elsewhere())
            setObserver(std::nullopt);
        else if (!observer)
            setObserver(viewer.eye());
    });
    connect(bar, &ViewBar::latencyChanged, &self, [this] { latency->setVisible(bar->latencyShown()); });
    connect(bar, &ViewBar::nextProjector, &self, [this] {
        ViewPane* pane = panes.at(ScenePane::projector);
        ShowView view = pane->view();
        const std::size_t count = studio.document.state().installation->projectors.size();
        view.projector = count == 0 ? 0 : (view.projector + 1) % count;
        pane->setView(view);
        showCaptions();
    });
}

QWidget* SceneCentralView::Data::widgetOf(ScenePane part) const {
    if (part == ScenePane::device) return device;
    return panes.at(part);
}

void SceneCentralView::Data::arrange() {
    const QSize size = views->size();
    std::map<QWidget*, QRect> boxes;
    if (comparing)
        for (const StagePlace& place : viewLayout(StageMode::compare, size)) boxes[widgetOf(place.part)] = place.box;
    else if (alone)
        boxes[widgetOf(*alone)] = QRect(QPoint(0, 0), size);
    else
        for (const StagePlace& place : viewLayout(bar->mode(), size)) boxes[widgetOf(place.part)] = place.box;
    std::vector<QWidget*> all{device};
    for (const auto& [part, pane] : panes) all.push_back(pane);
    for (QWidget* one : all) {
        const auto box = boxes.find(one);
        if (box != boxes.end()) one->setGeometry(box->second);
        one->setVisible(box != boxes.end() && !page->isVisibleTo(views));
    }
    page->setGeometry(views->rect());
    const QSize card = latency->sizeHint();
    latency->setGeometry(
        QRect(QPoint(size.width() - card.width() - kViewMargin, size.height() - card.height() - kViewMargin), card));
    const int wide = std::min(kNoticeWidth, size.width() - 2 * kViewMargin);
    notices->setGeometry((size.width() - wide) / 2, kViewMargin, wide, notices->sizeHint().height());
    arrangeInlay();
    latency->raise();
    notices->raise();
    showScene();
    showCaptions();
}

/// Whatever is seen gives way to both halves while the program compares; who had the keyboard has it there.
void SceneCentralView::Data::compare(bool on) {
    if (std::exchange(comparing, on) == on) return;
    const bool keys = self.isAncestorOf(self.window()->focusWidget());
    arrange();
    say();
    if (!keys) return;
    for (const ScenePane part : {ScenePane::uncropped, ScenePane::eye, ScenePane::lab})
        if (panes.at(part)->isVisible()) return panes.at(part)->setFocus(Qt::MouseFocusReason); // no ring
}

/// In the visitors' language, the halves large; a host has captions.
void SceneCentralView::Data::say() {
    const bool said = comparing && forVisitors;
    panes.at(ScenePane::cropped)->setLabel(said ? studio.settings.say(bendCaptions()[0]) : QString());
    panes.at(ScenePane::uncropped)->setLabel(said ? studio.settings.say(bendCaptions()[1]) : QString());
    const QString waiting =
        forVisitors ? studio.settings.say({"One moment...", "Einen Moment..."}) : tr("Preparing the view...");
    for (const ScenePane part : {ScenePane::lab, ScenePane::eye, ScenePane::cropped, ScenePane::uncropped})
        panes.at(part)->setWaiting(waiting);
}

/// A demonstration is seen by one eye, and large; a host's own show as he has arranged it.
void SceneCentralView::Data::showForVisitors(bool on) {
    if (on != std::exchange(forVisitors, on)) std::swap(alone, aloneElsewhere);
    inlayHidden = false;
    fade.stop();
    fade.setDirection(QVariantAnimation::Forward);
    fade.setCurrentTime(0);
    if (on) alone = studio.project.demo() != nullptr ? std::optional(ScenePane::eye) : aloneElsewhere;
    for (ProgramInputs* one : inputs) one->setForVisitors(on);
    for (const auto& [part, pane] : panes) pane->caption().setVisible(!on);
    deviceCaption->setVisible(!on);
    bar->setVisible(!on);
    notices->setVisible(!on);
    latency->setVisible(!on && bar->latencyShown());
    self.layout()->activate();
    arrange();
    say();
}

void SceneCentralView::Data::enlarge(ScenePane part) {
    if (alone)
        alone.reset();
    else
        alone = part;
    arrange();
}

void SceneCentralView::Data::showScene() {
    const auto& frame = studio.loop.frame();
    if (!active || !device->isVisible() || !frame) return;
    FieldDisplay display;
    display.showTarget = false;
    display.showMismatch = false;
    device->setScene(builder.build(*frame, display, false));
}

QString SceneCentralView::Data::eyeState() const {
    const auto& match = studio.show.newest().match;
    if (match && !match->viewer.empty()) return tr("what %1 should see").arg(QString::fromStdString(match->viewer));
    if (!viewer.moving()) return tr("what the viewer should see");
    const EyePlace place = placeOf(viewer.eye(), viewer.centre());
    return tr("elevation %1°, %2 cm away")
        .arg(place.elevation.inDegrees(), 0, 'f', 0)
        .arg(100.0 * place.distance, 0, 'f', 0);
}

QString SceneCentralView::Data::labState() const {
    if (!observer) return tr("the lit device, as the viewer sees it");
    const double degrees = degreesBetween(*observer, viewer.eye(), viewer.centre());
    return tr("seen from elsewhere, %1° off the viewer").arg(degrees, 0, 'f', 0);
}

void SceneCentralView::Data::showCaptions() {
    panes.at(ScenePane::eye)->caption().setText(tr("Eye"), eyeState(), viewer.moving());
    panes.at(ScenePane::lab)->caption().setText(tr("Lab"), labState(), observer.has_value());
    panes.at(ScenePane::cropped)
        ->caption()
        .setText(tr("Cropped"), comparing ? tr("the device takes the shape alone") : tr("the device lies flat"));
    panes.at(ScenePane::uncropped)->caption().setText(tr("Uncropped"), tr("its far edges bend up for the viewer"));
    ViewPane* projector = panes.at(ScenePane::projector);
    const auto& all = studio.document.state().installation->projectors;
    const std::size_t number = projector->view().projector;
    const QString title = tr("Projector %1").arg(number + 1);
    if (number >= all.size()) {
        projector->caption().setText(title, tr("there is none in this room"));
        projector->setWaiting(tr("Add a projector in the Library, and its picture stands here."));
        return;
    }
    const glm::ivec2 size = all[number].camera.size;
    projector->caption().setText(title, all[number].enabled ? tr("what is sent out, %1 × %2").arg(size.x).arg(size.y)
                                                            : tr("switched off"));
}

void SceneCentralView::Data::showReason() {
    const auto why = studio.renderer.failure();
    page->setReason(why.value_or(QString()));
    page->setVisible(why.has_value());
    arrange();
}

void SceneCentralView::Data::setObserver(std::optional<glm::vec3> eye) {
    observer = eye;
    ViewPane* pane = panes.at(ScenePane::lab);
    ShowView view = pane->view();
    view.observer = eye;
    pane->setView(view);
    showCaptions();
}

/// In the lab another button or Ctrl leads the observer away from the viewer.
void SceneCentralView::Data::beginDrag(ScenePane part, Qt::MouseButton button, Qt::KeyboardModifiers modifiers) {
    const bool asked = button == Qt::RightButton || modifiers.testFlag(Qt::ControlModifier);
    if (part == ScenePane::lab && asked) bar->setElsewhere(true);
    observing = part == ScenePane::lab && bar->elsewhere();
}

void SceneCentralView::Data::drag(ScenePane part, const QPointF& by) {
    const QSize size = widgetOf(part)->size();
    if (!observing) {
        viewer.drag(by, size);
    } else {
        const glm::vec2 pixels(static_cast<float>(by.x()), static_cast<float>(by.y()));
        setObserver(
            orbitedEye(observer.value_or(viewer.eye()), viewer.centre(), pixels, {size.width(), size.height()}));
    }
    showCaptions();
}

void SceneCentralView::Data::endDrag(bool taken) {
    if (!std::exchange(observing, false)) viewer.end(taken);
    showCaptions();
}

void SceneCentralView::Data::zoom(ScenePane part, double notches) {
    if (part == ScenePane::lab && observer)
        setObserver(nearerEye(*observer, viewer.centre(), notches));
    else
        viewer.zoom(notches);
    showCaptions();
}

void SceneCentralView::Data::click(ScenePane part, const QPointF& at) {
    const auto& frame = studio.show.newest().frame;
    const auto camera = cameraOf(part, panes.at(part)->size());
    if (!frame || !camera) return;
    emit self.picked(pickItem(*frame, rayThrough(*camera, {static_cast<float>(at.x()), static_cast<float>(at.y())})));
}

/// Of the newest picture, in pixels of the desktop; empty while there is none or nothing can be seen from there.
std::optional<CalibratedCamera> SceneCentralView::Data::cameraOf(ScenePane part, const QSize& size) {
    const auto& frame = studio.show.newest().frame;
    if (!frame || size.isEmpty()) return std::nullopt;
    try {
        const glm::ivec2 pixels(size.width(), size.height());
        if (part == ScenePane::cropped || part == ScenePane::uncropped) // as they are drawn
            return labCamera(bends.half(*studio.show.newest().match, *frame, BendComparison::Half::with), std::nullopt,
                             pixels);
        return labCamera(*frame, part == ScenePane::lab ? observer : std::nullopt, pixels);
    } catch (const InvalidInput&) { // among what is to be seen
        return std::nullopt;
    }
}

SceneCentralView::SceneCentralView(Studio& studio, QWidget* parent) : QWidget(parent) {
    setObjectName("scene.stage");
    data_ = std::make_unique<Data>(*this, studio);
    data_->showReason();
}

SceneCentralView::~SceneCentralView() {
    // The panes outlive the handles over them.
    setActive(false);
    for (const auto& [part, pane] : data_->panes) pane->setOverlay(nullptr);
}

void SceneCentralView::setActive(bool active) {
    data_->active = active;
    for (const auto& [part, pane] : data_->panes) pane->setActive(active);
    data_->inlay->setActive(active);
    data_->device->setActive(active);
    data_->showScene();
}

void SceneCentralView::setForVisitors(bool on) {
    data_->showForVisitors(on);
    if (on) setSelected(0);
}

void SceneCentralView::setSelected(int item) {
    if (data_->forVisitors) item = 0;
    for (const auto& [part, handles] : data_->handles) {
        handles->setItem(item);
        data_->panes.at(part)->update();
    }
}

void SceneCentralView::resizeEvent(QResizeEvent* event) {
    QWidget::resizeEvent(event);
    // The column has given the views their room by now.
    layout()->activate();
    data_->arrange();
}

} // namespace lumorph::studio
