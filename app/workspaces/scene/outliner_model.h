#pragma once

#include <memory>
#include <vector>

#include <QAbstractItemModel>

#include "app/studio/document/scene_edit.h"
#include "app/workspaces/scene/scene_selection.h"

namespace lumorph::studio {

/// The scene as a tree: its things, and below them what is always there. Names are edited, and things dragged, in the
/// document. Rows keep their index while the tree's shape is the same.
class OutlinerModel : public QAbstractItemModel {
    Q_OBJECT
public:
    /// What a row has to tell beside its name.
    enum Role { iconRole = Qt::UserRole, badgeRole, visibleRole, canHideRole, headingRole, mutedRole, swatchRole };

    explicit OutlinerModel(StudioDocument& document, QObject* parent = nullptr);

    [[nodiscard]] SceneChoice choiceAt(const QModelIndex& index) const;
    [[nodiscard]] QModelIndex indexOf(const SceneChoice& choice) const;
    void setVisible(const QModelIndex& index, bool visible);

    [[nodiscard]] QModelIndex index(int row, int column, const QModelIndex& parent = {}) const override;
    [[nodiscard]] QModelIndex parent(const QModelIndex& index) const override;
    [[nodiscard]] int rowCount(const QModelIndex& parent = {}) const override;
    [[nodiscard]] int columnCount(const QModelIndex& parent = {}) const override;
    [[nodiscard]] QVariant data(const QModelIndex& index, int role) const override;
    bool setData(const QModelIndex& index, const QVariant& value, int role) override;
    [[nodiscard]] Qt::ItemFlags flags(const QModelIndex& index) const override;
    [[nodiscard]] Qt::DropActions supportedDropActions() const override { return Qt::MoveAction | Qt::CopyAction; }
    [[nodiscard]] QStringList mimeTypes() const override;
    [[nodiscard]] QMimeData* mimeData(const QModelIndexList& indexes) const override;
    [[nodiscard]] bool canDropMimeData(const QMimeData* data, Qt::DropAction action, int row, int column,
                                       const QModelIndex& parent) const override;
    bool dropMimeData(const QMimeData* data, Qt::DropAction action, int row, int column,
                      const QModelIndex& parent) override;

signals:
    /// A material of the library was dropped on a row.
    void materialDropped(const lumorph::studio::SceneChoice& onto, int material);
    /// The tree has another shape now.
    void rebuilt();

private:
    /// One row; the tree holds its rows by number, so that an index can name one.
    struct Node {
        enum class Kind { root, things, setup, nothing, choice };
        Kind kind = Kind::choice;
        SceneChoice choice;
        int parent = -1;
        int row = 0;
        std::vector<int> children;
        bool operator==(const Node&) const = default;
    };
    [[nodiscard]] static std::vector<Node> nodesOf(const Scene& scene, const Installation& installation);
    [[nodiscard]] const Node& nodeAt(const QModelIndex& index) const;
    [[nodiscard]] const SceneItem* itemAt(const QModelIndex& index) const;
    [[nodiscard]] const Scene& scene() const { return *document_.state().scene; }
    [[nodiscard]] const Installation& installation() const { return *document_.state().installation; }
    [[nodiscard]] QString nameOf(const Node& node) const;
    [[nodiscard]] QString iconOf(const Node& node) const;
    void take();

    StudioDocument& document_;
    std::vector<Node> nodes_;
};

/// What a dragged material of the library is called as mime data; its number as text.
inline constexpr const char* kMaterialMime = "application/x-lumorph-material";

} // namespace lumorph::studio
