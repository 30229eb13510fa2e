#include <algorithm>
#include <cmath>
#include <numbers>

#include <QLabel>
#include <QSlider>
#include <glm/geometric.hpp>

#include "app/studio/widgets/panel.h"
#include "app/workspaces/scene/direction_dial.h"
#include "app/workspaces/scene/item_rows.h"
#include "app/workspaces/scene/sun_path.h"

namespace lumorph::studio {

namespace {

constexpr int kTicksAnHour = 12; ///< of the slider: five minutes each

Part<LightItem> lightOf(const Part<SceneItem>& item) {
    return within<LightItem>(item, [](auto& found) { return std::get_if<LightItem>(&found.kind); });
}

/// Towards it, and how far it is away.
glm::vec3 directionTo(const SceneItem& item) {
    return glm::length(item.position) > 1e-6F ? glm::normalize(item.position) : glm::vec3(0.0F, 1.0F, 0.0F);
}

void turnTo(SceneItem& item, const glm::vec3& direction) {
    const float distance = glm::length(item.position);
    item.position = (distance > 1e-3F ? distance : 1.0F) * direction;
}

void addDial(SceneForm& form, const Part<SceneItem>& item) {
    auto* dial = new DirectionDial(&form);
    dial->setObjectName("item.light.dial");
    dial->setAccessibleName(QObject::tr("Direction of the light"));
    auto* held = new QWidget(&form);
    auto* row = new QHBoxLayout(held);
    row->setContentsMargins(0, 0, 0, 0);
    row->addStretch(1);
    row->addWidget(dial);
    row->addStretch(1);
    form.add(held);
    const auto change = [item](const glm::vec3& direction) {
        return [item, direction](StudioState& state) {
            if (SceneItem* found = item.write(state)) turnTo(*found, direction);
        };
    };
    StudioDocument& document = form.document();
    QObject::connect(dial, &DirectionDial::previewed, &form,
                     [&document, change](const glm::vec3& direction) { document.preview(change(direction)); });
    QObject::connect(dial, &DirectionDial::committed, &form, [&document, change](const glm::vec3& direction) {
        document.preview(change(direction));
        document.commitPreview(QObject::tr("Move the light"));
    });
    QObject::connect(dial, &DirectionDial::reverted, &form, [&document] { document.cancelPreview(); });
    form.onRefresh([dial, item](const StudioState& state) {
        if (const SceneItem* found = item.read(state)) dial->setDirection(directionTo(*found));
    });
}

/// The sun rises at 6 on the right, stands highest at 12 and sets at 18 on the left.
void addHour(SceneForm& form, const Part<SceneItem>& item) {
    auto* slider = new QSlider(Qt::Horizontal, &form);
    slider->setObjectName("item.light.hour");
    slider->setAccessibleName(QObject::tr("Hour of the day"));
    slider->setRange(6 * kTicksAnHour + 2, 18 * kTicksAnHour - 2);
    slider->setPageStep(kTicksAnHour);
    auto* label = new QLabel(&form);
    label->setObjectName("item.light.time");
    label->setMinimumWidth(label->fontMetrics().horizontalAdvance("00:00"));
    auto* both = new QWidget(&form);
    auto* row = new QHBoxLayout(both);
    row->setContentsMargins(0, 0, 0, 0);
    row->addWidget(slider, 1);
    row->addWidget(label);
    both->setFocusProxy(slider);
    QWidget* line = makeRow(QObject::tr("Hour of the day"), both, &form);
    form.add(line);
    StudioDocument& document = form.document();
    QObject::connect(slider, &QSlider::valueChanged, &form, [&document, slider, item](int ticks) {
        document.preview([item, ticks](StudioState& state) {
            if (SceneItem* found = item.write(state))
                turnTo(*found, sunAt(static_cast<double>(ticks) / kTicksAnHour, directionTo(*found)));
        });
        if (!slider->isSliderDown()) document.commitPreview(QObject::tr("Move the sun"));
    });
    QObject::connect(slider, &QSlider::sliderReleased, &form,
                     [&document] { document.commitPreview(QObject::tr("Move the sun")); });
    form.onRefresh([slider, label, item](const StudioState& state) {
        const SceneItem* found = item.read(state);
        if (!found) return;
        const double hour = hourOf(directionTo(*found));
        const QSignalBlocker quiet(slider);
        if (!slider->isSliderDown()) slider->setValue(static_cast<int>(std::lround(hour * kTicksAnHour)));
        const int minutes = static_cast<int>(std::lround(hour * 60.0));
        label->setText(QString("%1:%2").arg(minutes / 60).arg(minutes % 60, 2, 10, QChar('0')));
    });
    form.showWhile(line, [part = lightOf(item)](const StudioState& state) {
        const LightItem* light = part.read(state);
        return light && light->kind == LightItem::Kind::sun;
    });
}

} // namespace

void addLightRows(SceneForm& form, const Part<SceneItem>& item) {
    const auto part = lightOf(item);
    form.showWhile(&form.section("item.section.light", QObject::tr("Light")),
                   [part](const StudioState& state) { return part.read(state) != nullptr; });
    form.segments(
        {"item.light.kind", QObject::tr("Kind"), {}},
        {{"item.light.sun", QObject::tr("Sun"), QObject::tr("Far away: all its rays are parallel")},
         {"item.light.lamp", QObject::tr("Lamp"), QObject::tr("It stands at its place and fades with distance")}},
        part, [](auto& light) -> auto& { return light.kind; });
    addDial(form, item);
    addHour(form, item);
    form.color(
        {"item.light.color", QObject::tr("Light colour"), {}}, part, [](auto& light) -> auto& { return light.color; });
    form.number(
        {"item.light.intensity", QObject::tr("Intensity"),
         QObject::tr("1 makes white paper white where the light meets it head on")},
        {Quantity::plain, 0.0, 100.0, 1.0, 0.05}, part, [](auto& light) -> auto& { return light.intensity; });
    form.number(
        {"item.light.softness", QObject::tr("Softness"), QObject::tr("How soft its shadows are")},
        {Quantity::share, 0.0, 1.0, 0.1}, part, [](auto& light) -> auto& { return light.softness; });
    form.check(
        {"item.light.shadows", QObject::tr("Casts shadows"), {}}, part,
        [](auto& light) -> auto& { return light.shadows; });
}

} // namespace lumorph::studio
