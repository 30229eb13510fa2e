#include "app/workspaces/scene/scene_words.h"

#include <QDateTime>
#include <QLocale>
#include <QObject>

namespace lumorph::studio {

namespace {

template <class... Cases> struct Overloaded : Cases... { using Cases::operator()...; };

struct Words {
    QString word, icon;
};

Words shapeWords(const ShapeItem& shape) {
    switch (shape.form) {
    case ShapeItem::Form::box:
        return {QObject::tr("Box"), "box"};
    case ShapeItem::Form::sphere:
        return {QObject::tr("Sphere"), "sphere"};
    case ShapeItem::Form::cylinder:
        return {QObject::tr("Cylinder"), "cylinder"};
    case ShapeItem::Form::plane:
        break;
    }
    return {QObject::tr("Plane"), "plane"};
}

Words wordsOf(const SceneItem& item) {
    return std::visit(Overloaded{[](const MeshItem&) -> Words {
                                     return {QObject::tr("Model"), "surface"};
                                 },
                                 [](const TargetItem&) -> Words {
                                     return {QObject::tr("Target"), "target"};
                                 },
                                 [](const ShapeItem& shape) { return shapeWords(shape); },
                                 [](const HeightItem& height) -> Words {
                                     if (height.image.empty()) return {QObject::tr("Water"), "water"};
                                     return {QObject::tr("Heights"), "heights"};
                                 },
                                 [](const FogItem&) -> Words {
                                     return {QObject::tr("Fog"), "fog"};
                                 },
                                 [](const LightItem& light) -> Words {
                                     if (light.kind == LightItem::Kind::sun) return {QObject::tr("Sun"), "sun"};
                                     return {QObject::tr("Lamp"), "lamp"};
                                 },
                                 [](const GroupItem&) -> Words {
                                     return {QObject::tr("Group"), "folder"};
                                 }},
                      item.kind);
}

} // namespace

QString kindWord(const SceneItem& item) { return wordsOf(item).word; }
QString kindIcon(const SceneItem& item) { return wordsOf(item).icon; }

QString roleWord(ItemRole role) {
    switch (role) {
    case ItemRole::physical:
        return QObject::tr("Physical");
    case ItemRole::split:
        return QObject::tr("Split");
    case ItemRole::virtualOnly:
        break;
    }
    return QObject::tr("Light");
}

QString roleSentence(ItemRole role) {
    switch (role) {
    case ItemRole::physical:
        return QObject::tr("The servos take its shape, and light draws it there.");
    case ItemRole::split:
        return QObject::tr("The servos follow its slow, long waves; light draws all that is too fine or too fast.");
    case ItemRole::virtualOnly:
        break;
    }
    return QObject::tr("Light alone draws it; the servos do not move for it.");
}

bool canBePhysical(const SceneItem& item) {
    return std::holds_alternative<MeshItem>(item.kind) || std::holds_alternative<TargetItem>(item.kind) ||
           std::holds_alternative<ShapeItem>(item.kind) || std::holds_alternative<HeightItem>(item.kind);
}

bool hasMaterial(const SceneItem& item) { return canBePhysical(item); }

QString originWords(const Origin& origin) {
    const QDateTime date = QDateTime::fromString(QString::fromStdString(origin.date), Qt::ISODate).toLocalTime();
    const QString on =
        date.isValid() ? QObject::tr(" on %1").arg(QLocale().toString(date.date(), QLocale::ShortFormat)) : QString();
    const QString method = QString::fromStdString(origin.method);
    switch (origin.way) {
    case Origin::Way::entered:
        return (method.isEmpty() ? QObject::tr("entered by hand") : QObject::tr("taken from %1").arg(method)) + on;
    case Origin::Way::measured:
        return (method.isEmpty() ? QObject::tr("measured") : QObject::tr("measured (%1)").arg(method)) + on;
    case Origin::Way::simulated:
        return (method.isEmpty() ? QObject::tr("simulated in the virtual lab")
                                 : QObject::tr("simulated in the virtual lab (%1)").arg(method)) +
               on;
    case Origin::Way::recorded:
        return (method.isEmpty() ? QObject::tr("measured by a recording") : QObject::tr("measured, %1").arg(method)) +
               on;
    case Origin::Way::assumed:
        break;
    }
    return QObject::tr("assumed, as in the virtual lab");
}

} // namespace lumorph::studio
