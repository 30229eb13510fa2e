#include "app/workspaces/scene/setup_rows.h"

#include <numbers>

#include <QLabel>

#include "app/workspaces/scene/euler.h"
#include "app/workspaces/scene/material_rows.h"
#include "app/workspaces/scene/repeated_rows.h"
#include "app/workspaces/scene/scene_words.h"
#include "core/loop/prediction_gain.h"

namespace lumorph::studio {

namespace {

constexpr double kFarthestSetup = 20.0; ///< metres
constexpr double kSetupTurn = 2.0 * std::numbers::pi;

Part<DeviceSkin> devicePart() {
    return makePart<DeviceSkin>([](auto& scene) { return &scene.device; });
}

Part<Scene> whole() {
    return makePart<Scene>([](auto& scene) { return &scene; });
}

Part<Installation> room() {
    return makeInstallationPart<Installation>([](auto& installation) { return &installation; });
}

bool always(const StudioState& /*state*/) { return true; }

QString bareSurfaceTip() {
    return QObject::tr("Its own colour without projection: projectors make up for it. White until measured");
}

void addShrink(SceneForm& form, const Part<DeviceSkin>& device) {
    form.section("device.section.optics", QObject::tr("Shrinking and holes"), false);
    form.number(
        {"device.shrink", QObject::tr("Shrink by"),
         QObject::tr("The rim shows the table, so that the device looks smaller")},
        {Quantity::share, 0.0, 0.9, 0.0}, device, [](auto& skin) -> auto& { return skin.shrink; });
    addRepeatedRows<DeviceSkin::Hole>(
        form, {"device.hole", QObject::tr("Hole"), QObject::tr("Add a hole")},
        within<std::vector<DeviceSkin::Hole>>(device, [](auto& skin) { return &skin.holes; }),
        [](SceneForm& rows, const Part<DeviceSkin::Hole>& hole, const QString& name) {
            rows.vector(
                {name + ".centre", QObject::tr("Middle"), QObject::tr("On the device at rest")},
                {Quantity::length, -1.0, 1.0}, "xz", hole, [](auto& one) -> auto& { return one.centre; });
            rows.number(
                {name + ".radius", QObject::tr("Radius"), {}}, {Quantity::length, 1e-4, 1.0, 0.015}, hole,
                [](auto& one) -> auto& { return one.radius; });
        });
}

void addCreases(SceneForm& form, const Part<DeviceSkin>& device) {
    form.section("device.section.creases", QObject::tr("Edges"), false);
    const auto creases = memberOf<DeviceSkin::Creases>(
        device, [](auto& skin) -> auto& { return skin.creases; });
    form.number(
        {"device.creases.emphasis", QObject::tr("Emphasis"),
         QObject::tr("Above 0 edges are drawn sharp, below 0 they are blurred away")},
        {Quantity::share, -1.0, 1.0, 0.0}, creases, [](auto& edge) -> auto& { return edge.emphasis; });
    form.number(
        {"device.creases.threshold", QObject::tr("From an angle of"), QObject::tr("What counts as an edge")},
        {Quantity::angle, 0.0, std::numbers::pi, 8.0 * std::numbers::pi / 180.0}, creases,
        [](auto& edge) -> auto& { return edge.threshold; });
    form.number(
        {"device.creases.width", QObject::tr("Width"), {}}, {Quantity::length, 1e-4, 0.1, 0.002, 0.0005}, creases,
        [](auto& edge) -> auto& { return edge.width; });
    form.color(
        {"device.creases.color", QObject::tr("Edge colour"), {}}, creases,
        [](auto& edge) -> auto& { return edge.color; });
}

/// Where the device lies while no tracker says so.
void addDevicePlace(SceneForm& form) {
    form.section("device.section.place", QObject::tr("Where it lies"), false);
    std::vector<SceneForm::NumberRow> position;
    std::vector<SceneForm::NumberRow> rotation;
    const QStringList turns{QObject::tr("Heading"), QObject::tr("tilt"), QObject::tr("roll")};
    for (int axis = 0; axis < 3; ++axis) {
        const QString letter(QChar::fromLatin1("xyz"[axis]));
        position.push_back(
            {{"device.position." + letter, QObject::tr("Position %1").arg(letter), QObject::tr("On the table")},
             {Quantity::length, -kFarthestSetup, kFarthestSetup},
             [axis](const StudioState& state) {
                 return std::optional<double>(state.installation->worldFromDevice[3][axis]);
             },
             [axis](StudioState& state, double value) {
                 installationToEdit(state).worldFromDevice[3][axis] = static_cast<float>(value);
             }});
        rotation.push_back({{"device.rotation." + letter, turns[axis], {}},
                            {Quantity::angle, -kSetupTurn, kSetupTurn},
                            [axis](const StudioState& state) {
                                const glm::dquat turned(glm::quat_cast(glm::mat3(state.installation->worldFromDevice)));
                                return std::optional(headingTiltRoll(turned)[axis]);
                            },
                            [axis](StudioState& state, double value) {
                                glm::mat4& place = installationToEdit(state).worldFromDevice;
                                glm::dvec3 angles = headingTiltRoll(glm::dquat(glm::quat_cast(glm::mat3(place))));
                                angles[axis] = value;
                                const glm::vec4 origin = place[3];
                                place = glm::mat4(glm::mat4_cast(fromHeadingTiltRoll(angles)));
                                place[3] = origin;
                            }});
    }
    form.addNumbers(QObject::tr("Position"), position);
    form.addNumbers(QObject::tr("Rotation"), rotation);
    QLabel* sentence = form.sentence("device.place.sentence");
    form.onRefresh([sentence](const StudioState& state) {
        sentence->setText(QObject::tr("It is %1. A tracker that sees the device takes this over.")
                              .arg(originWords(state.installation->origins.devicePlace)));
    });
}

/// What looking ahead gains with the room's delays, in a sentence.
class GainWords {
public:
    QString of(const Installation& room) {
        if (!(room.predictionSeconds > 0.0))
            return QObject::tr("What moves is lit where it was, not where it will be.");
        // A simulated motion of some milliseconds: not for each refresh.
        if (light_ != room.predictionSeconds || tracker_ != room.trackerSeconds) {
            gain_ = predictionGain(room, room);
            light_ = room.predictionSeconds;
            tracker_ = room.trackerSeconds;
        }
        return QObject::tr("At 30 cm/s: %1 mm beside instead of %2 mm. The delays are %3.")
            .arg(1e3 * gain_.with.atSpeed, 0, 'f', 0)
            .arg(1e3 * gain_.without.atSpeed, 0, 'f', 0)
            .arg(originWords(room.origins.delays));
    }

private:
    double light_ = 0.0, tracker_ = 0.0;
    PredictionGain gain_;
};

} // namespace

void addDeviceRows(SceneForm& form, Studio& studio) {
    const auto device = devicePart();
    form.segments(
        {"device.show", QObject::tr("What the device shows"), {}},
        {{"device.show.material", QObject::tr("Its material"), QObject::tr("And what lies on it")},
         {"device.show.content", QObject::tr("Things alone"), QObject::tr("The device is a mere screen")}},
        device, [](auto& skin) -> auto& { return skin.show; });
    form.color(
        {"device.surfaceColor", QObject::tr("Bare surface"), bareSurfaceTip()}, room(),
        [](auto& all) -> auto& { return all.deviceColor; });
    addMaterialRows(form, studio, "device.material",
                    memberOf<Material>(
                        device, [](auto& skin) -> auto& { return skin.material; }),
                    always);
    addCreases(form, device);
    addShrink(form, device);
    addDevicePlace(form);
    form.endSection();
}

void addTableRows(SceneForm& form, Studio& studio) {
    const auto table = makePart<Table>([](auto& scene) { return &scene.table; });
    form.vector(
        {"table.size", QObject::tr("Size"), QObject::tr("Width and depth")},
        {Quantity::length, 0.01, kFarthestSetup, 1.0, 0.01}, "xz", room(),
        [](auto& all) -> auto& { return all.tableSize; });
    form.color(
        {"table.surfaceColor", QObject::tr("Bare surface"), bareSurfaceTip()}, room(),
        [](auto& all) -> auto& { return all.tableColor; });
    addMaterialRows(form, studio, "table.material",
                    memberOf<Material>(
                        table, [](auto& found) -> auto& { return found.material; }),
                    always);
}

void addViewerRows(SceneForm& form, Studio& studio) {
    form.section("viewer.section.eye", QObject::tr("Simulated eye"));
    form.vector(
        {"viewer.eye", QObject::tr("Eye"), QObject::tr("Above the table; z towards the front")},
        {Quantity::length, -kFarthestSetup, kFarthestSetup, 0.4, 0.01}, "xyz", room(),
        [](auto& all) -> auto& { return all.eye; });
    QLabel* who = form.sentence("viewer.who");
    const auto tell = [who, &studio] {
        const auto& frame = studio.loop.frame();
        who->setText(frame && !frame->viewer.empty()
                         ? QObject::tr("The show follows %1.").arg(QString::fromStdString(frame->viewer))
                         : QObject::tr("Nobody is tracked, so the show follows this eye."));
    };
    form.onRefresh([tell](const StudioState&) { tell(); });
    form.section("viewer.section.tracking", QObject::tr("Tracked viewers"));
    form.choice(
        {"viewer.choice", QObject::tr("Follow"), {}},
        {QObject::tr("The nearest, calmly"), QObject::tr("The first who came"), QObject::tr("Always the nearest"),
         QObject::tr("Nobody")},
        room(), [](auto& all) -> auto& { return all.viewer; });
    form.vector(
        {"viewer.eyeFromHead", QObject::tr("Eye from head"),
         QObject::tr("Where the eye is in the frame of the tracked head's body")},
        {Quantity::length, -1.0, 1.0, 0.0, 0.005}, "xyz", room(), [](auto& all) -> auto& { return all.eyeFromHead; });
    form.number(
        {"viewer.prediction", QObject::tr("Look ahead"),
         QObject::tr("The delay from tracker to light; heads are expected where they will be by then. "
                     "Where drawing takes longer, that counts. 0: they are shown where they are now")},
        {Quantity::seconds, 0.0, 0.15, 0.06, 0.005}, room(), [](auto& all) -> auto& { return all.predictionSeconds; });
    QLabel* gain = form.sentence("viewer.prediction.gain");
    form.onRefresh([gain, words = GainWords{}](const StudioState& state) mutable {
        gain->setText(words.of(*state.installation));
    });
    form.section("viewer.section.dependence", QObject::tr("View-dependent shape"));
    const auto rule = makePart<ViewDependence>([](auto& all) { return &all.viewDependence; });
    form.check(
        {"viewer.dependence", QObject::tr("The device bends towards the viewer"),
         QObject::tr("Its far side rises while it is seen at a low angle")},
        rule, [](auto& view) -> auto& { return view.on; });
    form.number(
        {"viewer.theta", QObject::tr("Largest bend"), QObject::tr("At grazing view; from above nothing bends")},
        {Quantity::angle, 0.01, std::numbers::pi / 2.0, std::numbers::pi / 2.0}, rule,
        [](auto& view) -> auto& { return view.theta; });
    form.endSection();
}

void addRoomRows(SceneForm& form) {
    const auto scene = whole();
    form.color(
        {"room.sky", QObject::tr("Sky"), QObject::tr("Light from everywhere")}, scene,
        [](auto& all) -> auto& { return all.sky; });
    form.number(
        {"room.exposure", QObject::tr("Exposure"), {}}, {Quantity::plain, 0.01, 100.0, 1.0, 0.05}, scene,
        [](auto& all) -> auto& { return all.exposure; });
    form.check(
        {"room.toneMapping", QObject::tr("Soft highlights"), QObject::tr("Else what is too bright is white")}, scene,
        [](auto& all) -> auto& { return all.toneMapping; });
}

} // namespace lumorph::studio
