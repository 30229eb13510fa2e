#include <QLabel>
#include <QLineEdit>
#include <QStackedWidget>
#include <QTimer>

#include "app/studio/look/icons.h"
#include "app/studio/widgets/icon_label.h"
#include "app/studio/widgets/panel.h"
#include "app/workspaces/scene/item_rows.h"
#include "app/workspaces/scene/material_rows.h"
#include "app/workspaces/scene/scene_docks.h"
#include "app/workspaces/scene/scene_words.h"
#include "app/workspaces/scene/setup_rows.h"

namespace lumorph::studio {

namespace {

using Kind = SceneChoice::Kind;

/// The heading of a page: what is chosen, with its icon; an item's name can be changed here.
class Heading : public QWidget {
public:
    Heading(Studio& studio, SceneSelection& selection, QWidget* parent)
        : QWidget(parent), studio_(studio), selection_(selection),
          icon_(new IconLabel("box", IconRole::accent, 20, this)), name_(new QLineEdit(this)), title_(new QLabel(this)),
          kind_(new QLabel(this)) {
        name_->setObjectName("inspector.name");
        name_->setAccessibleName(tr("Name"));
        title_->setObjectName("inspector.title");
        title_->setProperty("look", "title");
        title_->setMinimumHeight(name_->sizeHint().height());
        kind_->setObjectName("inspector.kind");
        kind_->setProperty("look", "badge");
        auto* row = new QHBoxLayout(this);
        row->setContentsMargins(0, 0, 0, 4);
        row->setSpacing(8);
        row->addWidget(icon_);
        row->addWidget(name_, 1);
        row->addWidget(title_, 1);
        row->addWidget(kind_);
        connect(name_, &QLineEdit::editingFinished, this, [this] { rename(); });
    }

    void refresh() {
        const Scene& scene = *studio_.document.state().scene;
        const SceneChoice& choice = selection_.choice();
        if (const SceneItem* item = findItem(scene, selection_.item())) {
            show(QString::fromStdString(item->name), kindWord(*item), kindIcon(*item), true);
        } else if (choice.kind == Kind::projector) {
            const auto index = static_cast<std::size_t>(choice.index);
            const auto& projectors = studio_.document.state().installation->projectors;
            if (index < projectors.size()) show(QString::fromStdString(projectors[index].name), {}, "projector", true);
        } else if (choice.kind == Kind::device) {
            show(tr("Device"), {}, "device", false);
        } else if (choice.kind == Kind::table) {
            show(tr("Table"), {}, "table", false);
        } else if (choice.kind == Kind::viewer) {
            show(tr("Viewer"), {}, "viewer", false);
        } else if (choice.kind == Kind::room) {
            show(tr("Room light"), {}, "room", false);
        }
    }

private:
    void show(const QString& name, const QString& kind, const QString& iconName, bool editable) {
        icon_->setIcon(iconName, IconRole::accent);
        if (!(name_->hasFocus() && name_->isModified()) && name_->text() != name) {
            name_->setText(name);
            name_->setCursorPosition(0); // a long name shows how it begins
        }
        name_->setVisible(editable);
        title_->setVisible(!editable);
        title_->setText(name);
        kind_->setText(kind);
        kind_->setVisible(!kind.isEmpty() && kind != name);
    }

    void rename() {
        if (!name_->isModified()) return;
        name_->setModified(false);
        const std::string name = name_->text().trimmed().toStdString();
        const QString what = tr("Rename to %1").arg(name_->text().trimmed());
        const SceneChoice choice = selection_.choice();
        if (!name.empty() && choice.kind == Kind::projector)
            editInstallation(studio_.document, what, [&](Installation& installation) {
                installation.projectors.at(static_cast<std::size_t>(choice.index)).name = name;
            });
        else if (!name.empty())
            editScene(studio_.document, what, [&](Scene& scene) {
                if (SceneItem* item = itemOf(scene, selection_.item())) item->name = name;
            });
        refresh();
    }

    Studio& studio_;
    SceneSelection& selection_;
    IconLabel* icon_;
    QLineEdit* name_;
    QLabel* title_; ///< of what keeps its name
    QLabel* kind_;
};

class InspectorDock : public QWidget {
public:
    InspectorDock(Studio& studio, SceneSelection& selection)
        : studio_(studio), selection_(selection), stack_(new QStackedWidget(this)) {
        auto* layout = new QVBoxLayout(this);
        layout->setContentsMargins(0, 0, 0, 0);
        layout->addWidget(stack_);
        stack_->addWidget(makeEmptyState("scene", tr("Nothing is chosen"),
                                         tr("Choose a thing in the outliner or in the picture, and change it here."),
                                         nullptr));
        connect(&selection, &SceneSelection::changed, this, [this] { choose(); });
        connect(&studio.document, &StudioDocument::changed, this, [this](StateParts parts) {
            if (parts & (StatePart::scene | StatePart::installation)) refresh();
        });
        choose();
    }

    /// Its rows are cut off in less.
    [[nodiscard]] QSize minimumSizeHint() const override {
        return QWidget::minimumSizeHint().expandedTo({kLeastDockWidth, 0});
    }

protected:
    void showEvent(QShowEvent* event) override {
        QWidget::showEvent(event);
        refresh();
    }

private:
    struct Page {
        QWidget* widget = nullptr;
        Heading* heading = nullptr;
        SceneForm* form = nullptr;
    };

    /// Pages are made when they are first needed: together they are some hundreds of controls.
    Page& pageOf(Kind kind) {
        Page& page = pages_[kind];
        if (page.widget) return page;
        const Column column = makeColumn();
        page.widget = column.widget;
        page.heading = new Heading(studio_, selection_, column.widget);
        page.form = new SceneForm(studio_.document);
        column.layout->setContentsMargins(16, 12, 16, 16);
        column.layout->addWidget(page.heading);
        column.layout->addWidget(page.form);
        fill(*page.form, kind);
        stack_->addWidget(page.widget);
        return page;
    }

    void fill(SceneForm& form, Kind kind) {
        switch (kind) {
        case Kind::item:
            fillItem(form);
            return;
        case Kind::device:
            return addDeviceRows(form, studio_);
        case Kind::table:
            return addTableRows(form, studio_);
        case Kind::projector:
            return addProjectorRows(form, studio_, chosenProjector());
        case Kind::viewer:
            return addViewerRows(form, studio_);
        case Kind::room:
            return addRoomRows(form);
        case Kind::nothing:
            return;
        }
    }

    /// In three turns of the event loop: these are the most controls of all pages.
    void fillItem(SceneForm& form) {
        const auto item = makePart<SceneItem>([this](auto& scene) -> decltype(scene.items.data()) {
            for (auto& one : scene.items)
                if (one.id == selection_.item()) return &one;
            return nullptr;
        });
        addItemRows(form, studio_, item);
        QTimer::singleShot(0, &form, [this, &form, item] {
            addKindRows(form, studio_, item);
            refresh();
            QTimer::singleShot(0, &form, [this, &form, item] {
                addItemMaterial(form, item);
                refresh();
            });
        });
    }

    void addItemMaterial(SceneForm& form, const Part<SceneItem>& item) {
        const auto mesh = [item](const StudioState& state) -> const MeshItem* {
            const SceneItem* found = item.read(state);
            return found ? std::get_if<MeshItem>(&found->kind) : nullptr;
        };
        addMaterialRows(
            form, studio_, "item.material",
            memberOf<Material>(
                item, [](auto& found) -> auto& { return found.material; }),
            [mesh](const StudioState& state) { return mesh(state) == nullptr; },
            [item, mesh](const StudioState& state) {
                const SceneItem* found = item.read(state);
                return found && hasMaterial(*found) && !(mesh(state) && mesh(state)->ownMaterials);
            });
    }

    Part<InstalledProjector> chosenProjector() {
        return makeInstallationPart<InstalledProjector>([this](auto& room) -> decltype(room.projectors.data()) {
            const auto index = static_cast<std::size_t>(selection_.choice().index);
            const bool there = selection_.choice().kind == Kind::projector && index < room.projectors.size();
            return there ? &room.projectors[index] : nullptr;
        });
    }

    void choose() {
        const Kind kind = selection_.choice().kind;
        if (kind == Kind::nothing)
            stack_->setCurrentIndex(0);
        else
            stack_->setCurrentWidget(pageOf(kind).widget);
        refresh();
    }

    void refresh() {
        const auto page = pages_.find(selection_.choice().kind);
        if (!isVisible() || page == pages_.end()) return;
        page->second.heading->refresh();
        page->second.form->refresh();
    }

    Studio& studio_;
    SceneSelection& selection_;
    QStackedWidget* stack_;
    std::map<Kind, Page> pages_;
};

} // namespace

QWidget* makeInspectorDock(Studio& studio, SceneSelection& selection) { return new InspectorDock(studio, selection); }

} // namespace lumorph::studio
