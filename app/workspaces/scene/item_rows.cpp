#include "app/workspaces/scene/item_rows.h"

#include <numbers>

#include <QLabel>

#include "app/workspaces/scene/euler.h"
#include "app/workspaces/scene/item_fit.h"
#include "app/workspaces/scene/scene_words.h"

namespace lumorph::studio {

namespace {

constexpr double kFarthestItem = 10.0; ///< metres
constexpr double kItemTurn = 2.0 * std::numbers::pi;

bool isLight(const SceneItem* item) { return item && std::holds_alternative<LightItem>(item->kind); }
bool isTarget(const SceneItem* item) { return item && std::holds_alternative<TargetItem>(item->kind); }
bool isSun(const SceneItem* item) {
    const auto* light = item ? std::get_if<LightItem>(&item->kind) : nullptr;
    return light && light->kind == LightItem::Kind::sun;
}

void addRole(SceneForm& form, Studio& studio, const Part<SceneItem>& item) {
    CollapsibleSection& section = form.section("item.section.role", QObject::tr("Servos or light"), true);
    form.showWhile(&section, [item](const StudioState& state) {
        const SceneItem* found = item.read(state);
        return found && canBePhysical(*found);
    });
    form.addSegments(
        {"item.role", QObject::tr("Role"), {}},
        {{"item.role.light", roleWord(ItemRole::virtualOnly), roleSentence(ItemRole::virtualOnly)},
         {"item.role.physical", roleWord(ItemRole::physical), roleSentence(ItemRole::physical)},
         {"item.role.split", roleWord(ItemRole::split), roleSentence(ItemRole::split)}},
        [item](const StudioState& state) -> std::optional<int> {
            const SceneItem* found = item.read(state);
            return found ? std::optional(static_cast<int>(found->role)) : std::nullopt;
        },
        [item](StudioState& state, int role) {
            const SceneItem* found = item.read(state);
            const int id = found ? found->id : 0;
            setItemRole(sceneToEdit(state), id, static_cast<ItemRole>(role));
        });
    QLabel* sentence = form.sentence("item.role.sentence");
    form.onRefresh([sentence, item](const StudioState& state) {
        const SceneItem* found = item.read(state);
        if (found) sentence->setText(roleSentence(found->role));
    });
    addItemFitRows(form, studio, item);
    QLabel* other = form.sentence("item.role.other");
    form.onRefresh([other, item](const StudioState& state) {
        const SceneItem* found = item.read(state);
        const SceneItem* driving = drivingItem(*state.scene);
        const bool another = found && driving && driving->id != found->id;
        other->setVisible(another);
        if (another)
            other->setText(QObject::tr("The servos follow \"%1\" now; they can follow one thing at a time.")
                               .arg(QString::fromStdString(driving->name)));
    });
}

QWidget* addRotation(SceneForm& form, const Part<SceneItem>& item) {
    struct Turn {
        const char* name;
        QString label, hint;
    };
    const Turn turns[] = {{"item.rotation.heading", QObject::tr("Heading"), QObject::tr("About the upright axis")},
                          {"item.rotation.tilt", QObject::tr("tilt"), QObject::tr("Towards the front and back")},
                          {"item.rotation.roll", QObject::tr("roll"), QObject::tr("To the sides")}};
    std::vector<SceneForm::NumberRow> rows;
    for (int axis = 0; axis < 3; ++axis) {
        const Turn& turn = turns[axis];
        rows.push_back({{turn.name, turn.label, turn.hint},
                        {Quantity::angle, -kItemTurn, kItemTurn},
                        [item, axis](const StudioState& state) -> std::optional<double> {
                            const SceneItem* found = item.read(state);
                            return found ? std::optional(headingTiltRoll(glm::dquat(found->rotation))[axis])
                                         : std::nullopt;
                        },
                        [item, axis](StudioState& state, double value) {
                            SceneItem* found = item.write(state);
                            if (!found) return;
                            glm::dvec3 angles = headingTiltRoll(glm::dquat(found->rotation));
                            angles[axis] = value;
                            found->rotation = glm::quat(fromHeadingTiltRoll(angles));
                        }});
    }
    return form.addNumbers(QObject::tr("Rotation"), rows);
}

void addPlace(SceneForm& form, const Part<SceneItem>& item) {
    CollapsibleSection& section = form.section("item.section.place", QObject::tr("Place"), true);
    form.showWhile(&section, [item](const StudioState& state) {
        const SceneItem* found = item.read(state);
        return found && !isTarget(found);
    });
    const auto standsStill = [item](const StudioState& state) { return !isLight(item.read(state)); };
    form.showWhile(
        form.vector(
            {"item.position", QObject::tr("Position"), QObject::tr("x to the right, y up, z towards the viewer")},
            {Quantity::length, -kFarthestItem, kFarthestItem}, "xyz", item,
            [](auto& found) -> auto& { return found.position; }),
        [item](const StudioState& state) { return !isSun(item.read(state)); });
    form.showWhile(addRotation(form, item), standsStill);
    QWidget* scale = form.vector(
        {"item.scale", QObject::tr("Scale"), QObject::tr("100 % is as it was made")},
        {Quantity::share, 0.001, 1000.0, 1.0, 0.01}, "xyz", item, [](auto& found) -> auto& { return found.scale; });
    form.showWhile(scale, standsStill);
    Segments* anchor = form.segments(
        {"item.anchor", QObject::tr("Rides on"), {}},
        {{"item.anchor.device", QObject::tr("On the device"), QObject::tr("It goes where the device goes")},
         {"item.anchor.world", QObject::tr("On the table"), QObject::tr("It stays while the device is moved")}},
        item, [](auto& found) -> auto& { return found.anchor; });
    form.showWhile(anchor, [item](const StudioState& state) {
        const SceneItem* found = item.read(state);
        return found && found->parent == 0;
    });
}

void addMotion(SceneForm& form, const Part<SceneItem>& item) {
    CollapsibleSection& section = form.section("item.section.motion", QObject::tr("Motion"), false);
    form.showWhile(&section, [item](const StudioState& state) {
        const SceneItem* found = item.read(state);
        return found && !isTarget(found) && !isLight(found);
    });
    form.number(
        {"item.motion.spin", QObject::tr("Turns a second"), QObject::tr("About the upright axis")},
        {Quantity::angle, -kItemTurn, kItemTurn, 0.0, std::numbers::pi / 36.0}, item,
        [](auto& found) -> auto& { return found.motion.spin; });
    form.number(
        {"item.motion.bob", QObject::tr("Rises and falls"), QObject::tr("How far, up and down")},
        {Quantity::length, 0.0, 1.0, 0.0}, item, [](auto& found) -> auto& { return found.motion.bob; });
    form.number(
        {"item.motion.bobPeriod", QObject::tr("Once in"), {}}, {Quantity::seconds, 0.05, 600.0, 3.0}, item,
        [](auto& found) -> auto& { return found.motion.bobPeriod; });
}

} // namespace

void addItemRows(SceneForm& form, Studio& studio, const Part<SceneItem>& item) {
    form.check(
        {"item.visible", QObject::tr("Visible"), QObject::tr("Light draws it")}, item,
        [](auto& found) -> auto& { return found.visible; });
    form.showWhile(form.number(
                       {"item.opacity", QObject::tr("Opacity"), {}}, {Quantity::share, 0.0, 1.0, 1.0}, item,
                       [](auto& found) -> auto& { return found.opacity; }),
                   [item](const StudioState& state) {
                       const SceneItem* found = item.read(state);
                       return found && hasMaterial(*found);
                   });
    addRole(form, studio, item);
    addPlace(form, item);
    addMotion(form, item);
    form.endSection();
}

} // namespace lumorph::studio
