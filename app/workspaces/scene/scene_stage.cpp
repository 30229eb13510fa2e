#include "app/workspaces/scene/scene_stage.h"

#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include <QVBoxLayout>

#include "app/studio/rendering/show_frames.h"
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
#include "app/workspaces/scene/stage_bar.h"
#include "app/workspaces/scene/stage_pane.h"
#include "core/base/error.h"

namespace lumorph::studio {
namespace {

constexpr int kMargin = 12;
constexpr int kNoticeWidth = 480;

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

struct SceneStage::Data {
    Data(SceneStage& stage, Studio& shared);

    StagePane* addPane(StagePart part, const ShowView& view, const QString& title);
    void addDevice();
    void addFloating();
    void arrange();
    void enlarge(StagePart part);
    void showScene();    ///< of the device
    void showCaptions(); ///< of all pictures
    void showReason();
    void beginDrag(StagePart part, Qt::MouseButton button, Qt::KeyboardModifiers modifiers);
    void drag(StagePart part, const QPointF& by);
    void endDrag(bool taken);
    void zoom(StagePart part, double notches);
    void click(StagePart part, const QPointF& at);
    void setObserver(std::optional<glm::vec3> eye);
    [[nodiscard]] QWidget* widgetOf(StagePart part) const;
    [[nodiscard]] std::optional<CalibratedCamera> cameraOf(StagePart part, const QSize& size) const;
    [[nodiscard]] QString eyeState() const;
    [[nodiscard]] QString labState() const;

    SceneStage& self;
    Studio& studio;
    SimulatedEye viewer;
    FieldSceneBuilder builder;
    StageBar* bar;
    QWidget* views;
    std::map<StagePart, StagePane*> panes;
    std::map<StagePart, std::unique_ptr<ItemHandles>> handles;
    ViewportWidget* device = nullptr;
    PaneCaption* deviceCaption = nullptr;
    GlPage* page = nullptr;
    LatencyCard* latency = nullptr;
    QWidget* notices = nullptr;
    std::optional<StagePart> alone; ///< enlarged by a double click
    std::optional<glm::vec3> observer;
    bool observing = false; ///< this drag moves the observer, not the viewer
    bool active = false;
};

SceneStage::Data::Data(SceneStage& stage, Studio& shared)
    : self(stage), studio(shared), viewer(shared.document), bar(new StageBar(shared, &stage)),
      views(new QWidget(&stage)) {
    builder.setPatient(false);
    auto* column = new QVBoxLayout(&self);
    column->setContentsMargins(0, 0, 0, 0);
    column->setSpacing(0);
    column->addWidget(bar);
    column->addWidget(views, 1);
    addPane(StagePart::lab, viewOf(ShowView::Kind::lab), tr("Lab"));
    addPane(StagePart::eye, viewOf(ShowView::Kind::eye), tr("Eye"));
    addPane(StagePart::projector, viewOf(ShowView::Kind::projector), tr("Projector 1"));
    addPane(StagePart::cropped, viewOf(ShowView::Kind::lab, ShowView::Bend::atRest), tr("Cropped"));
    addPane(StagePart::uncropped, viewOf(ShowView::Kind::lab, ShowView::Bend::forViewer), tr("Uncropped"));
    addDevice();
    addFloating();
}

StagePane* SceneStage::Data::addPane(StagePart part, const ShowView& view, const QString& title) {
    static const std::map<StagePart, const char*> kNames{{StagePart::lab, "scene.lab"},
                                                         {StagePart::eye, "scene.eye"},
                                                         {StagePart::projector, "scene.projector"},
                                                         {StagePart::cropped, "scene.cropped"},
                                                         {StagePart::uncropped, "scene.uncropped"}};
    auto* pane = new StagePane(studio.show, view, title, views);
    pane->setObjectName(kNames.at(part));
    panes[part] = pane;
    connect(pane, &StagePane::enlarged, &self, [this, part] { enlarge(part); });
    if (part == StagePart::projector) return pane;
    connect(pane, &StagePane::dragBegan, &self,
            [this, part](Qt::MouseButton button, Qt::KeyboardModifiers held) { beginDrag(part, button, held); });
    connect(pane, &StagePane::dragged, &self, [this, part](const QPointF& by) { drag(part, by); });
    connect(pane, &StagePane::dragEnded, &self, [this](bool taken) { endDrag(taken); });
    connect(pane, &StagePane::wheeled, &self, [this, part](double notches) { zoom(part, notches); });
    connect(pane, &StagePane::clicked, &self, [this, part](const QPointF& at) { click(part, at); });
    const auto camera = [this, part](const QSize& size) { return cameraOf(part, size); };
    handles[part] = std::make_unique<ItemHandles>(studio.document, camera);
    pane->setOverlay(handles[part].get());
    return pane;
}

void SceneStage::Data::addDevice() {
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
        if (const auto& frame = studio.loop.frame()) bar->setSeconds(frame->sceneSeconds);
        showScene();
    });
}

void SceneStage::Data::addFloating() {
    page = new GlPage([this] { studio.renderer.retry(); }, views);
    latency = new LatencyCard(studio.show, views);
    latency->hide();
    notices = new QWidget(views);
    auto* column = new QVBoxLayout(notices);
    column->setContentsMargins(0, 0, 0, 0);
    column->setSpacing(8);
    column->addWidget(makeNoticeBar(studio.notices, "viewport", notices));
    column->addWidget(makeNoticeBar(studio.notices, "output", notices));
    column->addStretch(1);
    notices->setMaximumWidth(kNoticeWidth);
    connect(&studio.notices, &Notices::changed, &self, [this] { arrange(); });
    connect(&studio.renderer, &RenderThread::ready, &self, [this] { showReason(); });
    connect(&studio.show, &ShowFeed::shown, &self, [this] {
        const double seconds = studio.show.newest().match->sceneSeconds;
        for (const auto& [part, one] : handles) one->setSeconds(seconds);
        showCaptions();
    });
    connect(bar, &StageBar::modeChanged, &self, [this] {
        alone.reset();
        arrange();
    });
    connect(bar, &StageBar::elsewhereChanged, &self, [this] {
        if (!bar->elsewhere())
            setObserver(std::nullopt);
        else if (!observer)
            setObserver(viewer.eye());
    });
    connect(bar, &StageBar::latencyChanged, &self, [this] { latency->setVisible(bar->latencyShown()); });
    connect(bar, &StageBar::nextProjector, &self, [this] {
        StagePane* pane = panes.at(StagePart::projector);
        ShowView view = pane->view();
        const std::size_t count = studio.document.state().scene->projectors.size();
        view.projector = count == 0 ? 0 : (view.projector + 1) % count;
        pane->setView(view);
        showCaptions();
    });
}

QWidget* SceneStage::Data::widgetOf(StagePart part) const {
    if (part == StagePart::device) return device;
    return panes.at(part);
}

void SceneStage::Data::arrange() {
    const QSize size = views->size();
    std::map<QWidget*, QRect> boxes;
    if (alone)
        boxes[widgetOf(*alone)] = QRect(QPoint(0, 0), size);
    else
        for (const StagePlace& place : stageLayout(bar->mode(), size)) boxes[widgetOf(place.part)] = place.box;
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
        QRect(QPoint(size.width() - card.width() - kMargin, size.height() - card.height() - kMargin), card));
    const int wide = std::min(kNoticeWidth, size.width() - 2 * kMargin);
    notices->setGeometry((size.width() - wide) / 2, kMargin, wide, notices->sizeHint().height());
    latency->raise();
    notices->raise();
    showScene();
    showCaptions();
}

void SceneStage::Data::enlarge(StagePart part) {
    if (alone)
        alone.reset();
    else
        alone = part;
    arrange();
}

void SceneStage::Data::showScene() {
    const auto& frame = studio.loop.frame();
    if (!active || !device->isVisible() || !frame) return;
    FieldDisplay display;
    display.showTarget = false;
    display.showMismatch = false;
    device->setScene(builder.build(*frame, display, false));
}

QString SceneStage::Data::eyeState() const {
    const auto& match = studio.show.newest().match;
    if (match && !match->viewer.empty()) return tr("what %1 should see").arg(QString::fromStdString(match->viewer));
    if (!viewer.moving()) return tr("what the viewer should see");
    const EyePlace place = placeOf(viewer.eye(), viewer.centre());
    return tr("elevation %1°, %2 cm away")
        .arg(place.elevation.inDegrees(), 0, 'f', 0)
        .arg(100.0 * place.distance, 0, 'f', 0);
}

QString SceneStage::Data::labState() const {
    if (!observer) return tr("the lit device, as the viewer sees it");
    const double degrees = degreesBetween(*observer, viewer.eye(), viewer.centre());
    return tr("seen from elsewhere, %1° off the viewer").arg(degrees, 0, 'f', 0);
}

void SceneStage::Data::showCaptions() {
    panes.at(StagePart::eye)->caption().setText(tr("Eye"), eyeState(), viewer.moving());
    panes.at(StagePart::lab)->caption().setText(tr("Lab"), labState(), observer.has_value());
    panes.at(StagePart::cropped)->caption().setText(tr("Cropped"), tr("the device lies flat"));
    panes.at(StagePart::uncropped)->caption().setText(tr("Uncropped"), tr("its far edges bend up for the viewer"));
    StagePane* projector = panes.at(StagePart::projector);
    const auto& all = studio.document.state().scene->projectors;
    const std::size_t number = projector->view().projector;
    const QString title = tr("Projector %1").arg(number + 1);
    if (number >= all.size()) {
        projector->caption().setText(title, tr("there is none in this scene"));
        projector->setWaiting(tr("Add a projector in the Library, and its picture stands here."));
        return;
    }
    const glm::ivec2 size = all[number].camera.size;
    projector->caption().setText(title, all[number].enabled ? tr("what is sent out, %1 × %2").arg(size.x).arg(size.y)
                                                            : tr("switched off"));
}

void SceneStage::Data::showReason() {
    const auto why = studio.renderer.failure();
    page->setReason(why.value_or(QString()));
    page->setVisible(why.has_value());
    arrange();
}

void SceneStage::Data::setObserver(std::optional<glm::vec3> eye) {
    observer = eye;
    StagePane* pane = panes.at(StagePart::lab);
    ShowView view = pane->view();
    view.observer = eye;
    pane->setView(view);
    showCaptions();
}

/// In the lab another button or Ctrl leads the observer away from the viewer.
void SceneStage::Data::beginDrag(StagePart part, Qt::MouseButton button, Qt::KeyboardModifiers modifiers) {
    const bool asked = button == Qt::RightButton || modifiers.testFlag(Qt::ControlModifier);
    if (part == StagePart::lab && asked) bar->setElsewhere(true);
    observing = part == StagePart::lab && bar->elsewhere();
}

void SceneStage::Data::drag(StagePart part, const QPointF& by) {
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

void SceneStage::Data::endDrag(bool taken) {
    if (!std::exchange(observing, false)) viewer.end(taken);
    showCaptions();
}

void SceneStage::Data::zoom(StagePart part, double notches) {
    if (part == StagePart::lab && observer)
        setObserver(nearerEye(*observer, viewer.centre(), notches));
    else
        viewer.zoom(notches);
    showCaptions();
}

void SceneStage::Data::click(StagePart part, const QPointF& at) {
    const auto& frame = studio.show.newest().frame;
    const auto camera = cameraOf(part, panes.at(part)->size());
    if (!frame || !camera) return;
    emit self.picked(pickItem(*frame, rayThrough(*camera, {static_cast<float>(at.x()), static_cast<float>(at.y())})));
}

/// Of the newest picture, in pixels of the desktop; empty while there is none or nothing can be seen from there.
std::optional<CalibratedCamera> SceneStage::Data::cameraOf(StagePart part, const QSize& size) const {
    const auto& frame = studio.show.newest().frame;
    if (!frame || size.isEmpty()) return std::nullopt;
    try {
        return labCamera(*frame, part == StagePart::lab ? observer : std::nullopt, {size.width(), size.height()});
    } catch (const InvalidInput&) { // among what is to be seen
        return std::nullopt;
    }
}

SceneStage::SceneStage(Studio& studio, QWidget* parent) : QWidget(parent) {
    setObjectName("scene.stage");
    data_ = std::make_unique<Data>(*this, studio);
    data_->showReason();
}

SceneStage::~SceneStage() {
    // The panes outlive the handles over them.
    setActive(false);
    for (const auto& [part, pane] : data_->panes) pane->setOverlay(nullptr);
}

void SceneStage::setActive(bool active) {
    data_->active = active;
    for (const auto& [part, pane] : data_->panes) pane->setActive(active);
    data_->device->setActive(active);
    data_->showScene();
}

void SceneStage::setSelected(int item) {
    for (const auto& [part, handles] : data_->handles) {
        handles->setItem(item);
        data_->panes.at(part)->update();
    }
}

void SceneStage::resizeEvent(QResizeEvent* event) {
    QWidget::resizeEvent(event);
    // The column has given the views their room by now.
    layout()->activate();
    data_->arrange();
}

} // namespace lumorph::studio
