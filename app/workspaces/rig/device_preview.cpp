#include "app/workspaces/rig/device_preview.h"

#include <utility>
#include <vector>

#include <QTimer>
#include <QVBoxLayout>

#include "app/studio/widgets/panel.h"
#include "app/workspaces/common/field_colors.h"

namespace lumorph::studio {

namespace {

constexpr int kRaisedAtFirst = 60; ///< percent: what a device is can only be seen when it moves

} // namespace

DevicePreview::DevicePreview(Studio& studio, const QString& prefix, QWidget* parent)
    : QWidget(parent), view_(new ViewportWidget(studio.renderer)), raised_(new QSlider(Qt::Horizontal)) {
    builder_.setPatient(false);
    builder_.setColors(fieldSceneColors(studio.settings.theme()));
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(8);
    view_->setObjectName(prefix + ".view");
    view_->setAccessibleName(tr("The device as it would be"));
    view_->setActive(true);
    layout->addWidget(view_, 1);
    raised_->setObjectName(prefix + ".raised");
    raised_->setRange(0, 100);
    raised_->setValue(kRaisedAtFirst);
    raised_->setToolTip(tr("Moves all actuators of this picture from rest to full stroke"));
    layout->addWidget(makeRow(tr("&Rehearse"), raised_));
    connect(raised_, &QSlider::valueChanged, this, &DevicePreview::refresh);
    connect(&studio.settings, &Settings::themeChanged, this, [this, &studio] {
        builder_.setColors(fieldSceneColors(studio.settings.theme()));
        refresh();
    });
}

void DevicePreview::show(std::shared_ptr<const Rig> rig) {
    rig_ = std::move(rig);
    refresh();
}

void DevicePreview::refresh() {
    if (!rig_) return view_->setScene(std::make_shared<const ViewportScene>());
    MatchFrame frame;
    frame.rig = rig_;
    frame.estimatedStrokes.assign(rig_->actuatorCount(), 0.01 * raised_->value());
    std::vector<glm::vec3> positions(rig_->restMesh().positions.size());
    rig_->deform(frame.estimatedStrokes, positions);
    frame.devicePositions = std::make_shared<const std::vector<glm::vec3>>(std::move(positions));
    view_->setScene(builder_.build(frame, {}, false));
    if (std::exchange(reframes_, false)) view_->frameAll();
    constexpr int kSoon = 30;
    if (builder_.pending()) QTimer::singleShot(kSoon, this, &DevicePreview::refresh);
}

} // namespace lumorph::studio
