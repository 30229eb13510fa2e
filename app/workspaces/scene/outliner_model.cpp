#include "app/workspaces/scene/outliner_model.h"

#include <algorithm>
#include <map>

#include <QColor>
#include <QIODevice>
#include <QMimeData>

#include "app/workspaces/scene/scene_form.h"
#include "app/workspaces/scene/scene_words.h"

namespace lumorph::studio {

namespace {

constexpr const char* kItemMime = "application/x-lumorph-item";
constexpr int kRoot = 0, kThings = 1, kSetup = 2;

} // namespace

OutlinerModel::OutlinerModel(StudioDocument& document, QObject* parent)
    : QAbstractItemModel(parent), document_(document),
      nodes_(nodesOf(*document.state().scene, *document.state().installation)) {
    connect(&document, &StudioDocument::changed, this, [this](StateParts parts) {
        if (parts & (StatePart::scene | StatePart::installation)) take();
    });
}

std::vector<OutlinerModel::Node> OutlinerModel::nodesOf(const Scene& scene, const Installation& installation) {
    std::vector<Node> nodes;
    const auto add = [&nodes](Node::Kind kind, const SceneChoice& choice, int parent) {
        const int number = static_cast<int>(nodes.size());
        const int row = parent < 0 ? 0 : static_cast<int>(nodes[static_cast<std::size_t>(parent)].children.size());
        nodes.push_back({kind, choice, parent, row, {}});
        if (parent >= 0) nodes[static_cast<std::size_t>(parent)].children.push_back(number);
        return number;
    };
    add(Node::Kind::root, {}, -1);
    add(Node::Kind::things, {}, kRoot);
    add(Node::Kind::setup, {}, kRoot);
    std::map<int, int> groups;
    for (const SceneItem& item : scene.items) { // a group stands before its members
        const auto group = groups.find(item.parent);
        groups[item.id] = add(Node::Kind::choice, {SceneChoice::Kind::item, item.id},
                              group == groups.end() ? kThings : group->second);
    }
    if (scene.items.empty()) add(Node::Kind::nothing, {}, kThings);
    add(Node::Kind::choice, {SceneChoice::Kind::device, 0}, kSetup);
    add(Node::Kind::choice, {SceneChoice::Kind::table, 0}, kSetup);
    for (std::size_t i = 0; i < installation.projectors.size(); ++i)
        add(Node::Kind::choice, {SceneChoice::Kind::projector, static_cast<int>(i)}, kSetup);
    add(Node::Kind::choice, {SceneChoice::Kind::viewer, 0}, kSetup);
    add(Node::Kind::choice, {SceneChoice::Kind::room, 0}, kSetup);
    return nodes;
}

void OutlinerModel::take() {
    std::vector<Node> next = nodesOf(scene(), installation());
    if (next == nodes_) {
        for (std::size_t i = 0; i < nodes_.size(); ++i)
            if (!nodes_[i].children.empty()) {
                const int last = static_cast<int>(nodes_[i].children.size()) - 1;
                const QModelIndex group =
                    i == 0 ? QModelIndex() : createIndex(nodes_[i].row, 0, static_cast<quintptr>(i));
                emit dataChanged(index(0, 0, group), index(last, 0, group));
            }
        return;
    }
    beginResetModel();
    nodes_ = std::move(next);
    endResetModel();
    emit rebuilt();
}

const OutlinerModel::Node& OutlinerModel::nodeAt(const QModelIndex& index) const {
    return nodes_[index.isValid() ? static_cast<std::size_t>(index.internalId()) : 0];
}

const SceneItem* OutlinerModel::itemAt(const QModelIndex& index) const {
    const Node& node = nodeAt(index);
    return node.choice.kind == SceneChoice::Kind::item ? findItem(scene(), node.choice.index) : nullptr;
}

SceneChoice OutlinerModel::choiceAt(const QModelIndex& index) const { return nodeAt(index).choice; }

QModelIndex OutlinerModel::indexOf(const SceneChoice& choice) const {
    if (choice.kind == SceneChoice::Kind::nothing) return {};
    for (std::size_t i = 0; i < nodes_.size(); ++i)
        if (nodes_[i].choice == choice) return createIndex(nodes_[i].row, 0, static_cast<quintptr>(i));
    return {};
}

void OutlinerModel::setVisible(const QModelIndex& index, bool visible) {
    const SceneItem* item = itemAt(index);
    if (!item) return;
    editScene(document_,
              visible ? tr("Show %1").arg(QString::fromStdString(item->name))
                      : tr("Hide %1").arg(QString::fromStdString(item->name)),
              [id = item->id, visible](Scene& scene) {
                  if (SceneItem* found = itemOf(scene, id)) found->visible = visible;
              });
}

QModelIndex OutlinerModel::index(int row, int column, const QModelIndex& parent) const {
    const Node& group = nodeAt(parent);
    if (column != 0 || row < 0 || row >= static_cast<int>(group.children.size())) return {};
    return createIndex(row, 0, static_cast<quintptr>(group.children[static_cast<std::size_t>(row)]));
}

QModelIndex OutlinerModel::parent(const QModelIndex& index) const {
    const int parent = nodeAt(index).parent;
    if (parent <= kRoot) return {};
    return createIndex(nodes_[static_cast<std::size_t>(parent)].row, 0, static_cast<quintptr>(parent));
}

int OutlinerModel::rowCount(const QModelIndex& parent) const {
    return static_cast<int>(nodeAt(parent).children.size());
}

int OutlinerModel::columnCount(const QModelIndex& /*parent*/) const { return 1; }

QString OutlinerModel::nameOf(const Node& node) const {
    switch (node.kind) {
    case Node::Kind::things:
        return tr("Things");
    case Node::Kind::setup:
        return tr("Setup");
    case Node::Kind::nothing:
        return tr("Nothing yet. Add something above.");
    case Node::Kind::root:
        return {};
    case Node::Kind::choice:
        break;
    }
    const auto index = static_cast<std::size_t>(node.choice.index);
    switch (node.choice.kind) {
    case SceneChoice::Kind::item:
        if (const SceneItem* item = findItem(scene(), node.choice.index)) return QString::fromStdString(item->name);
        return {};
    case SceneChoice::Kind::device:
        return tr("Device");
    case SceneChoice::Kind::table:
        return tr("Table");
    case SceneChoice::Kind::projector:
        return index < installation().projectors.size() ? QString::fromStdString(installation().projectors[index].name)
                                                        : QString();
    case SceneChoice::Kind::viewer:
        return tr("Viewer");
    case SceneChoice::Kind::room:
        return tr("Room light");
    case SceneChoice::Kind::nothing:
        break;
    }
    return {};
}

QString OutlinerModel::iconOf(const Node& node) const {
    switch (node.choice.kind) {
    case SceneChoice::Kind::item:
        if (const SceneItem* item = findItem(scene(), node.choice.index)) return kindIcon(*item);
        return {};
    case SceneChoice::Kind::device:
        return "device";
    case SceneChoice::Kind::table:
        return "table";
    case SceneChoice::Kind::projector:
        return "projector";
    case SceneChoice::Kind::viewer:
        return "viewer";
    case SceneChoice::Kind::room:
        return "room";
    case SceneChoice::Kind::nothing:
        break;
    }
    return {};
}

QVariant OutlinerModel::data(const QModelIndex& index, int role) const {
    const Node& node = nodeAt(index);
    const SceneItem* item = itemAt(index);
    switch (role) {
    case Qt::DisplayRole:
    case Qt::EditRole:
        return nameOf(node);
    case Qt::ToolTipRole:
        return item ? (canBePhysical(*item) ? kindWord(*item) + ". " + roleSentence(item->role) : kindWord(*item))
                    : QString();
    case Qt::AccessibleTextRole:
        return item && !item->visible ? tr("%1, hidden").arg(nameOf(node)) : nameOf(node);
    case iconRole:
        return iconOf(node);
    case badgeRole:
        return item && item->role != ItemRole::virtualOnly ? roleWord(item->role) : QString();
    case visibleRole:
        return !item || item->visible;
    case canHideRole:
        return item != nullptr;
    case headingRole:
        return node.kind == Node::Kind::things || node.kind == Node::Kind::setup;
    case mutedRole:
        return node.kind == Node::Kind::nothing || (item && !item->visible);
    case swatchRole:
        if (item && hasMaterial(*item) && !std::holds_alternative<MeshItem>(item->kind))
            return toColor(item->material.color);
        if (node.choice.kind == SceneChoice::Kind::device) return toColor(scene().device.material.color);
        if (node.choice.kind == SceneChoice::Kind::table) return toColor(scene().table.material.color);
        return {};
    default:
        return {};
    }
}

bool OutlinerModel::setData(const QModelIndex& index, const QVariant& value, int role) {
    const SceneChoice choice = choiceAt(index);
    const std::string name = value.toString().trimmed().toStdString();
    if (role != Qt::EditRole || name.empty() || value.toString() == nameOf(nodeAt(index))) return false;
    const QString what = tr("Rename %1").arg(nameOf(nodeAt(index)));
    if (choice.kind == SceneChoice::Kind::projector)
        editInstallation(document_, what, [&](Installation& installation) {
            installation.projectors.at(static_cast<std::size_t>(choice.index)).name = name;
        });
    else
        editScene(document_, what, [&](Scene& scene) {
            if (SceneItem* item = itemOf(scene, choice.index)) item->name = name;
        });
    return true;
}

Qt::ItemFlags OutlinerModel::flags(const QModelIndex& index) const {
    const Node& node = nodeAt(index);
    switch (node.kind) {
    case Node::Kind::root:
        return Qt::NoItemFlags;
    case Node::Kind::things:
        return Qt::ItemIsEnabled | Qt::ItemIsDropEnabled;
    case Node::Kind::setup:
    case Node::Kind::nothing:
        return Qt::ItemIsEnabled;
    case Node::Kind::choice:
        break;
    }
    Qt::ItemFlags flags = Qt::ItemIsEnabled | Qt::ItemIsSelectable;
    if (node.choice.kind == SceneChoice::Kind::item)
        flags |= Qt::ItemIsEditable | Qt::ItemIsDragEnabled | Qt::ItemIsDropEnabled;
    if (node.choice.kind == SceneChoice::Kind::projector) flags |= Qt::ItemIsEditable;
    if (node.choice.kind == SceneChoice::Kind::device || node.choice.kind == SceneChoice::Kind::table)
        flags |= Qt::ItemIsDropEnabled;
    return flags;
}

QStringList OutlinerModel::mimeTypes() const { return {kItemMime, kMaterialMime}; }

QMimeData* OutlinerModel::mimeData(const QModelIndexList& indexes) const {
    if (indexes.isEmpty()) return nullptr;
    auto* data = new QMimeData;
    data->setData(kItemMime, QByteArray::number(choiceAt(indexes.front()).index));
    return data;
}

bool OutlinerModel::canDropMimeData(const QMimeData* data, Qt::DropAction /*action*/, int /*row*/, int /*column*/,
                                    const QModelIndex& parent) const {
    if (data->hasFormat(kMaterialMime)) return choiceAt(parent).kind != SceneChoice::Kind::nothing;
    if (!data->hasFormat(kItemMime)) return false;
    const SceneItem* group = itemAt(parent);
    return nodeAt(parent).kind == Node::Kind::things || (group && std::holds_alternative<GroupItem>(group->kind));
}

bool OutlinerModel::dropMimeData(const QMimeData* data, Qt::DropAction action, int row, int column,
                                 const QModelIndex& parent) {
    if (!canDropMimeData(data, action, row, column, parent)) return false;
    if (data->hasFormat(kMaterialMime)) {
        emit materialDropped(choiceAt(parent), data->data(kMaterialMime).toInt());
        return false;
    }
    const int id = data->data(kItemMime).toInt();
    const SceneItem* group = itemAt(parent);
    const int before = row >= 0 ? choiceAt(index(row, 0, parent)).index : 0;
    const SceneItem* moved = findItem(scene(), id);
    if (!moved) return false;
    editScene(document_, tr("Move %1").arg(QString::fromStdString(moved->name)),
              [id, into = group ? group->id : 0, before](Scene& scene) { moveItem(scene, id, into, before); });
    return false; // the document has moved it already; the view must not take the row away
}

} // namespace lumorph::studio
