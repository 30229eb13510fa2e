#include <set>

#include <QDockWidget>
#include <QMenu>
#include <QPointer>
#include <QToolButton>
#include <QTreeView>

#include "app/studio/look/icons.h"
#include "app/studio/look/palette.h"
#include "app/studio/widgets/dock_parts.h"
#include "app/studio/widgets/panel.h"
#include "app/workspaces/scene/outliner_item.h"
#include "app/workspaces/scene/outliner_model.h"
#include "app/workspaces/scene/scene_commands.h"
#include "app/workspaces/scene/scene_docks.h"
#include "app/workspaces/scene/technique_commands.h"
#include "core/scene/material_library.h"

namespace lumorph::studio {

namespace {

/// What is chosen is drawn by its row; beside it there are only the marks that fold groups.
class Tree : public QTreeView {
public:
    using QTreeView::QTreeView;

protected:
    void drawBranches(QPainter* painter, const QRect& rect, const QModelIndex& index) const override {
        const Palette& colors = currentPalette();
        painter->fillRect(rect, colors.sunken);
        if (!model()->hasChildren(index)) return;
        const QRectF box(rect.right() - indentation() + 1, rect.center().y() - 6, 12, 12);
        paintIcon(*painter, box, isExpanded(index) ? "chevron-down" : "chevron-right", colors.textMuted);
    }
};

class OutlinerDock : public QWidget {
public:
    OutlinerDock(Studio& studio, SceneSelection& selection)
        : studio_(studio), selection_(selection), model_(new OutlinerModel(studio.document, this)),
          tree_(new Tree(this)) {
        setMinimumWidth(kLeastDockWidth);
        auto* layout = new QVBoxLayout(this);
        layout->setContentsMargins(16, 12, 16, 12);
        layout->setSpacing(8);
        layout->addWidget(makeNoticeBar(studio.notices, "scene", this));
        layout->addWidget(makeJobBar(studio.jobs, "scene", this));
        layout->addWidget(makeSwitch());
        layout->addWidget(makeTechniqueBar(studio, this));
        layout->addWidget(makeTools());
        layout->addWidget(tree_, 1);
        prepareTree();
        connect(&selection, &SceneSelection::changed, this, [this] { showChosen(); });
        connect(model_, &OutlinerModel::rebuilt, this, [this] { unfold(); });
        connect(&studio.notices, &Notices::changed, this, [this](const QString& place) { showNotice(place); });
        unfold();
    }

private:
    /// A notice of the scene stands here, so the dock comes to the front of those behind which it lies.
    void showNotice(const QString& place) {
        if (place != "scene" || studio_.notices.at("scene").empty()) return;
        if (auto* dock = qobject_cast<QDockWidget*>(parentWidget())) dock->raise();
    }

    /// Fig. 2 of the paper as a switch: servos, light, or both.
    QWidget* makeSwitch() {
        auto* bar = new QWidget(this);
        bar->setObjectName("scene.showing");
        auto* row = new QHBoxLayout(bar);
        row->setContentsMargins(0, 0, 0, 0);
        row->setSpacing(4);
        for (const char* id : {"physical", "light", "both"}) {
            QPushButton* button = makeCommandButton(studio_.commands.find(QString("scene.showing.") + id),
                                                    QString("scene.showing.") + id + ".button", bar);
            button->setProperty("look", "segment");
            row->addWidget(button, 1);
        }
        return bar;
    }

    QWidget* makeTools() {
        auto* bar = new QWidget(this);
        auto* row = new QHBoxLayout(bar);
        row->setContentsMargins(0, 0, 0, 0);
        row->setSpacing(4);
        auto* add = new QPushButton(tr("Add"), bar);
        add->setObjectName("scene.add");
        add->setIcon(icon("plus"));
        auto* menu = new QMenu(add);
        menu->setObjectName("scene.addMenu");
        menu->setToolTipsVisible(true);
        fillAddMenu(studio_.commands, *menu);
        add->setMenu(menu);
        row->addWidget(add, 1);
        for (const char* command : {"scene.duplicate", "scene.delete"})
            row->addWidget(makeCommandIcon(studio_.commands.find(command), QString(command) + ".button", bar));
        return bar;
    }

    void prepareTree() {
        tree_->setObjectName("scene.outliner");
        tree_->setAccessibleName(tr("What is in the scene"));
        tree_->setModel(model_);
        tree_->setHeaderHidden(true);
        tree_->setMouseTracking(true);
        tree_->setFrameShape(QFrame::NoFrame);
        tree_->setIndentation(14);
        tree_->setUniformRowHeights(true);
        tree_->setDragEnabled(true);
        tree_->setAcceptDrops(true);
        tree_->setDropIndicatorShown(true);
        tree_->setDragDropMode(QAbstractItemView::DragDrop);
        tree_->setDefaultDropAction(Qt::MoveAction);
        tree_->setEditTriggers(QAbstractItemView::EditKeyPressed | QAbstractItemView::DoubleClicked);
        tree_->setContextMenuPolicy(Qt::CustomContextMenu);
        auto* rows = new OutlinerItem(tree_);
        tree_->setItemDelegate(rows);
        connect(rows, &OutlinerItem::eyePressed, model_, [this](const QModelIndex& index) {
            model_->setVisible(index, !index.data(OutlinerModel::visibleRole).toBool());
        });
        connect(tree_->selectionModel(), &QItemSelectionModel::currentChanged, this, [this](const QModelIndex& index) {
            if (!showing_ && index.isValid()) selection_.choose(model_->choiceAt(index));
        });
        connect(tree_, &QTreeView::customContextMenuRequested, this, [this](const QPoint& at) { openMenu(at); });
        connect(tree_, &QTreeView::collapsed, this,
                [this](const QModelIndex& index) { folded_.insert(model_->choiceAt(index).index); });
        connect(tree_, &QTreeView::expanded, this,
                [this](const QModelIndex& index) { folded_.erase(model_->choiceAt(index).index); });
        connect(model_, &OutlinerModel::materialDropped, this, [this](const SceneChoice& onto, int number) {
            const std::vector<Material> all = readyMaterials();
            if (number >= 0 && number < static_cast<int>(all.size()))
                applyMaterial(studio_, onto, all[static_cast<std::size_t>(number)]);
        });
    }

    void openMenu(const QPoint& at) {
        QMenu menu(this);
        for (const char* command : {"scene.duplicate", "scene.hide", "scene.delete"})
            menu.addAction(studio_.commands.find(command));
        menu.addSeparator();
        fillAddMenu(studio_.commands, menu);
        menu.exec(tree_->viewport()->mapToGlobal(at));
    }

    /// Groups stay as the user folded them.
    void unfold() {
        const std::set<int> folded = folded_;
        tree_->expandAll();
        for (const int id : folded)
            if (const QModelIndex index = model_->indexOf({SceneChoice::Kind::item, id}); index.isValid())
                tree_->collapse(index);
        showChosen();
    }

    void showChosen() {
        const QModelIndex index = model_->indexOf(selection_.choice());
        if (index == tree_->currentIndex() && index.isValid()) return;
        showing_ = true;
        tree_->setCurrentIndex(index);
        if (!index.isValid()) tree_->clearSelection();
        showing_ = false;
    }

    Studio& studio_;
    SceneSelection& selection_;
    OutlinerModel* model_;
    QTreeView* tree_;
    std::set<int> folded_; ///< ids of groups
    bool showing_ = false;
};

} // namespace

QWidget* makeOutlinerDock(Studio& studio, SceneSelection& selection) { return new OutlinerDock(studio, selection); }

} // namespace lumorph::studio
