#include <algorithm>
#include <cmath>

#include <QLabel>
#include <QTimer>

#include "app/workspaces/scene/projector_pose.h"
#include "app/workspaces/scene/projector_reach.h"
#include "app/workspaces/scene/scene_words.h"
#include "app/workspaces/scene/setup_rows.h"
#include "core/base/srgb.h"

namespace lumorph::studio {

namespace {

constexpr double kFarthestProjector = 20.0; ///< metres
constexpr int kLookMilliseconds = 500;
constexpr double kWorthTelling = 0.01; ///< share of the device

SceneForm::NumberRow placeRow(const Part<InstalledProjector>& projector, int axis) {
    const QString letter(QChar::fromLatin1("xyz"[axis]));
    return {
        {"projector.position." + letter, QObject::tr("Position %1").arg(letter), QObject::tr("y is above the table")},
        {Quantity::length, -kFarthestProjector, kFarthestProjector, axis == 1 ? 2.0 : 0.0, 0.01},
        [projector, axis](const StudioState& state) -> std::optional<double> {
            const InstalledProjector* found = projector.read(state);
            return found ? std::optional(positionOf(found->camera)[axis]) : std::nullopt;
        },
        [projector, axis](StudioState& state, double value) {
            InstalledProjector* found = projector.write(state);
            if (!found) return;
            glm::dvec3 position = positionOf(found->camera);
            position[axis] = value;
            carryTo(found->camera, position);
        }};
}

SceneForm::NumberRow lookRow(const Part<InstalledProjector>& projector, int axis) {
    const QString letter(QChar::fromLatin1("xz"[axis]));
    return {{"projector.look." + letter, QObject::tr("Looks at %1").arg(letter),
             QObject::tr("Where the middle of its picture falls on the table")},
            {Quantity::length, -kFarthestProjector, kFarthestProjector, 0.0, 0.01},
            [projector, axis](const StudioState& state) -> std::optional<double> {
                const InstalledProjector* found = projector.read(state);
                const auto point = found ? lookPoint(found->camera) : std::nullopt;
                return point ? std::optional((*point)[axis]) : std::nullopt;
            },
            [projector, axis](StudioState& state, double value) {
                InstalledProjector* found = projector.write(state);
                if (!found) return;
                glm::dvec2 point = lookPoint(found->camera).value_or(glm::dvec2(0.0));
                point[axis] = value;
                lookAt(found->camera, point);
            }};
}

QString warningOf(const ProjectorReach& reach) {
    const auto percent = [](double share) { return QString::number(std::max(1.0, std::round(100.0 * share)), 'f', 0); };
    if (reach.missed > 1.0 - kWorthTelling) return QObject::tr("Its light does not meet the device at all.");
    QStringList told;
    if (reach.missed > kWorthTelling)
        told << QObject::tr("%1 % of the device lies outside its picture.").arg(percent(reach.missed));
    if (reach.steep > kWorthTelling)
        told << QObject::tr("%1 % is met at more than %2°, where light is dim and blurred.")
                    .arg(percent(reach.steep))
                    .arg(kSteepDegrees);
    if (reach.dim > kWorthTelling)
        told << QObject::tr(
                    "%1 % cannot become white: too far, too slanting, or too dark a surface. A higher peak or a "
                    "lower exposure helps.")
                    .arg(percent(reach.dim));
    return told.join(' ');
}

/// What its light does not reach well, as the device stands now.
void addWarning(SceneForm& form, Studio& studio, const Part<InstalledProjector>& projector) {
    QLabel* warning = form.sentence("projector.warning");
    warning->setProperty("look", "warning");
    const auto look = [warning, &studio, projector] {
        const StudioState& state = studio.document.state();
        const InstalledProjector* found = projector.read(state);
        const auto& frame = studio.loop.frame();
        QString text;
        if (found && found->enabled && frame && frame->rig && frame->devicePositions)
            text = warningOf(reachOf(*found, linearFromSrgb(state.installation->deviceColor), *frame->devicePositions,
                                     frame->rig->restMesh().triangles, frame->worldFromDevice));
        warning->setText(text);
        warning->setVisible(!text.isEmpty());
    };
    auto* often = new QTimer(&form);
    QObject::connect(often, &QTimer::timeout, &form, [&form, look] {
        if (form.isVisible()) look();
    });
    often->start(kLookMilliseconds);
    form.onRefresh([look](const StudioState&) { look(); });
}

void addPlace(SceneForm& form, const Part<InstalledProjector>& projector) {
    form.section("projector.section.place", QObject::tr("Place"));
    form.addNumbers(QObject::tr("Position"), {placeRow(projector, 0), placeRow(projector, 1), placeRow(projector, 2)});
    form.addNumbers(QObject::tr("Looks at"), {lookRow(projector, 0), lookRow(projector, 1)});
}

void addLens(SceneForm& form, const Part<InstalledProjector>& projector) {
    form.section("projector.section.lens", QObject::tr("Lens"), false);
    const auto camera = memberOf<CalibratedCamera>(
        projector, [](auto& found) -> auto& { return found.camera; });
    form.vector(
        {"projector.size", QObject::tr("Pixels"), QObject::tr("Width and height of its picture")},
        {Quantity::level, 16.0, 8192.0, 1920.0, 1.0}, "xy", camera, [](auto& lens) -> auto& { return lens.size; });
    form.vector(
        {"projector.focal", QObject::tr("Focal length"), QObject::tr("In pixels")},
        {Quantity::plain, 1.0, 1e5, 1500.0, 10.0}, "xy", camera, [](auto& lens) -> auto& { return lens.focal; });
    form.vector(
        {"projector.principal", QObject::tr("Principal point"),
         QObject::tr("In pixels from the middle of the top left one; a lens shift puts it outside")},
        {Quantity::plain, -1e5, 1e5, 639.5, 1.0}, "xy", camera, [](auto& lens) -> auto& { return lens.principal; });
    const auto focus = memberOf<LensFocus>(
        projector, [](auto& found) -> auto& { return found.focus; });
    form.number(
        {"projector.aperture", QObject::tr("Aperture"),
         QObject::tr("Width of the lens' opening: focal length divided by f-number; 0 where it is not known")},
        {Quantity::length, 0.0, 0.5, 0.0, 0.001}, focus, [](auto& lens) -> auto& { return lens.aperture; });
    form.number(
        {"projector.focus", QObject::tr("Focused at"), QObject::tr("How far before the lens its picture is sharp")},
        {Quantity::length, 0.05, kFarthestProjector, 2.0, 0.01}, focus,
        [](auto& lens) -> auto& { return lens.focusDistance; });
    const char* const names[] = {"k1", "k2", "p1", "p2", "k3"};
    for (std::size_t i = 0; i < 5; ++i)
        form.number(
            {QString("projector.distortion.") + names[i], QObject::tr("Distortion %1").arg(names[i]), {}},
            {Quantity::plain, -10.0, 10.0, 0.0, 0.001},
            camera, [i](auto& lens) -> auto& { return lens.distortion[i]; });
}

void addLight(SceneForm& form, const Part<InstalledProjector>& projector) {
    form.section("projector.section.light", QObject::tr("Light"), false);
    form.number(
        {"projector.peak", QObject::tr("Peak"),
         QObject::tr("Full white, where 1 is white paper in the picture; more reaches slanting places")},
        {Quantity::plain, 0.01, 100.0, 3.0, 0.1}, projector, [](auto& found) -> auto& { return found.peak; });
    form.number(
        {"projector.reference", QObject::tr("Measured at"), QObject::tr("The distance at which that holds")},
        {Quantity::length, 0.05, kFarthestProjector, 2.0, 0.01}, projector,
        [](auto& found) -> auto& { return found.referenceDistance; });
    form.number(
        {"projector.gamma", QObject::tr("Gamma"), QObject::tr("0 is the curve of sRGB")},
        {Quantity::plain, 0.0, 5.0, 0.0, 0.05}, projector, [](auto& found) -> auto& { return found.gamma; });
    form.vector(
        {"projector.gain", QObject::tr("Gain"), QObject::tr("Of red, green and blue, one against the others")},
        {Quantity::share, 0.01, 10.0, 1.0}, "rgb", projector, [](auto& found) -> auto& { return found.gain; });
    const auto room = makeInstallationPart<Installation>([](auto& all) { return &all; });
    form.check(
        {"projector.compensation", QObject::tr("Even out slant and distance"),
         QObject::tr("Slanting and far places get more light, for all projectors")},
        room, [](auto& all) -> auto& { return all.compensation; });
}

/// Where its figures came from, so that one knows how far to trust them.
void addOrigins(SceneForm& form, const Part<InstalledProjector>& projector) {
    QLabel* sentence = form.sentence("projector.origins");
    form.onRefresh([sentence, projector](const StudioState& state) {
        const InstalledProjector* found = projector.read(state);
        if (found)
            sentence->setText(
                QObject::tr("Place: %1. Lens: %2. Light: %3.")
                    .arg(originWords(found->pose), originWords(found->lens), originWords(found->response)));
    });
}

} // namespace

void addProjectorRows(SceneForm& form, Studio& studio, const Part<InstalledProjector>& projector) {
    form.check(
        {"projector.enabled", QObject::tr("In use"), {}}, projector,
        [](auto& found) -> auto& { return found.enabled; });
    addWarning(form, studio, projector);
    addOrigins(form, projector);
    addPlace(form, projector);
    addLens(form, projector);
    addLight(form, projector);
    form.endSection();
}

} // namespace lumorph::studio
