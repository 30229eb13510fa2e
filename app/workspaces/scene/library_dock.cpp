#include <QDrag>
#include <QLabel>
#include <QListWidget>
#include <QMimeData>
#include <QPointer>

#include "app/studio/widgets/panel.h"
#include "app/workspaces/scene/material_shelf.h"
#include "app/workspaces/scene/outliner_model.h"
#include "app/workspaces/scene/scene_commands.h"
#include "app/workspaces/scene/scene_docks.h"
#include "app/workspaces/scene/scene_words.h"
#include "core/scene/material_library.h"

namespace lumorph::studio {

namespace {

constexpr int kPicture = 72;
constexpr int kCellWidth = 88, kCellHeight = 104;

/// A grid of which each entry can be dragged onto a row of the outliner.
class Shelf : public QListWidget {
public:
    explicit Shelf(QWidget* parent) : QListWidget(parent) {
        setObjectName("library.shelf");
        setAccessibleName(tr("Ready materials"));
        setViewMode(QListView::IconMode);
        setIconSize({kPicture, kPicture});
        setGridSize({kCellWidth, kCellHeight});
        setResizeMode(QListView::Adjust);
        setMovement(QListView::Static);
        setUniformItemSizes(true);
        setWordWrap(true);
        setFrameShape(QFrame::NoFrame);
        setDragEnabled(true);
        setDragDropMode(QAbstractItemView::DragOnly);
    }

protected:
    [[nodiscard]] QMimeData* mimeData(const QList<QListWidgetItem*>& items) const override {
        if (items.isEmpty()) return nullptr;
        auto* number = new QMimeData;
        number->setData(kMaterialMime, QByteArray::number(row(items.front())));
        return number;
    }
};

class LibraryDock : public QWidget {
public:
    LibraryDock(Studio& studio, SceneSelection& selection)
        : studio_(studio), selection_(selection), hint_(new QLabel(this)), shelf_(new Shelf(this)) {
        hint_->setObjectName("library.hint");
        hint_->setProperty("look", "muted");
        hint_->setWordWrap(true);
        setMinimumWidth(kLeastDockWidth);
        auto* layout = new QVBoxLayout(this);
        layout->setContentsMargins(16, 12, 12, 12);
        layout->setSpacing(8);
        layout->addWidget(hint_);
        layout->addWidget(makeJobBar(studio.jobs, "library", this));
        layout->addWidget(shelf_, 1);
        for (const Material& material : readyMaterials()) {
            auto* item = new QListWidgetItem(QString::fromStdString(material.name), shelf_);
            item->setSizeHint({kCellWidth - 4, kCellHeight - 4});
            item->setTextAlignment(Qt::AlignHCenter | Qt::AlignTop);
            item->setToolTip(tr("Click: use it for what is chosen. Drag: drop it on a row of the outliner."));
        }
        connect(shelf_, &QListWidget::itemClicked, this, [this](QListWidgetItem* item) { use(shelf_->row(item)); });
        connect(shelf_, &QListWidget::itemActivated, this, [this](QListWidgetItem* item) { use(shelf_->row(item)); });
        connect(&selection, &SceneSelection::changed, this, [this] { describe(); });
        connect(&studio.document, &StudioDocument::changed, this, [this](StateParts parts) {
            if (parts & StatePart::scene) describe();
        });
        describe();
    }

protected:
    void showEvent(QShowEvent* event) override {
        QWidget::showEvent(event);
        // A dock that lies behind another is shown for a moment before it is put there.
        QTimer::singleShot(0, this, [this] {
            if (isVisible() && !std::exchange(painted_, true)) paint();
        });
    }

private:
    void paint() {
        studio_.jobs.run<std::vector<QImage>>(
            "library", tr("Painting the materials"),
            [](const Progress& progress) { return paintShelf(2 * kPicture, progress); },
            [self = QPointer<LibraryDock>(this)](const std::vector<QImage>& pictures) {
                if (self) self->show(pictures);
            },
            [&notices = studio_.notices](const std::exception& error) { notices.post("scene", noticeOf(error)); });
    }

    void show(const std::vector<QImage>& pictures) {
        for (std::size_t i = 0; i < pictures.size(); ++i) {
            QPixmap picture = QPixmap::fromImage(pictures[i]);
            picture.setDevicePixelRatio(2.0);
            QIcon icon;
            for (const QIcon::Mode mode : {QIcon::Normal, QIcon::Selected}) icon.addPixmap(picture, mode);
            if (QListWidgetItem* item = shelf_->item(static_cast<int>(i))) item->setIcon(icon);
        }
    }

    /// A double click, or Enter after a click, finds it in use already and changes nothing.
    void use(int row) {
        const std::vector<Material> all = readyMaterials();
        if (row >= 0 && row < static_cast<int>(all.size()))
            applyMaterial(studio_, selection_.choice(), all[static_cast<std::size_t>(row)]);
    }

    void describe() {
        hint_->setText(takerName().isEmpty() ? tr("Choose a thing, the device or the table, then click a material.")
                                             : tr("Click a material for \"%1\".").arg(takerName()));
    }

    [[nodiscard]] QString takerName() const {
        const SceneItem* item = findItem(*studio_.document.state().scene, selection_.item());
        if (item) return hasMaterial(*item) ? QString::fromStdString(item->name) : QString();
        if (selection_.choice().kind == SceneChoice::Kind::device) return tr("Device");
        return selection_.choice().kind == SceneChoice::Kind::table ? tr("Table") : QString();
    }

    Studio& studio_;
    SceneSelection& selection_;
    QLabel* hint_;
    Shelf* shelf_;
    bool painted_ = false;
};

} // namespace

QWidget* makeLibraryDock(Studio& studio, SceneSelection& selection) { return new LibraryDock(studio, selection); }

} // namespace lumorph::studio
