#include "app/studio/widgets/bundled_shelf.h"

#include <QGridLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QScrollArea>
#include <QScrollBar>
#include <QToolButton>

#include "app/studio/look/icons.h"

namespace lumorph::studio {
namespace {

constexpr QSize kPicture{112, 70};

QToolButton* makeTile(const BundledFile& bundled) {
    auto* tile = new QToolButton;
    tile->setObjectName("bundled." + QString::fromStdString(bundled.file.stem().string()));
    tile->setText(bundled.title);
    tile->setToolTip("Open " + bundled.title + ", which comes with the program");
    tile->setToolButtonStyle(Qt::ToolButtonTextUnderIcon);
    tile->setFocusPolicy(Qt::StrongFocus);
    tile->setIconSize(kPicture);
    const QPixmap picture(QString::fromStdString(bundled.picture.string()));
    if (picture.isNull())
        tile->setIcon(icon("file"));
    else
        tile->setIcon(picture);
    return tile;
}

} // namespace

void addBundledShelf(QFileDialog& dialog, const QString& title, const std::vector<BundledFile>& files,
                     const std::function<void(const std::filesystem::path&)>& open) {
    auto* grid = qobject_cast<QGridLayout*>(dialog.layout());
    if (grid == nullptr || files.empty()) return;
    auto* shelf = new QWidget;
    auto* row = new QHBoxLayout(shelf);
    row->setContentsMargins(0, 0, 0, 0);
    row->setSpacing(4);
    for (const BundledFile& bundled : files) {
        QToolButton* tile = makeTile(bundled);
        row->addWidget(tile);
        QObject::connect(tile, &QToolButton::clicked, &dialog, [&dialog, open, file = bundled.file] {
            dialog.reject();
            open(file);
        });
    }
    row->addStretch(1);
    // In a narrow dialog it scrolls instead of making that wider.
    auto* area = new QScrollArea(&dialog);
    area->setObjectName("bundled");
    area->setAccessibleName(title);
    area->setWidgetResizable(true);
    area->setFrameShape(QFrame::NoFrame);
    area->setFocusPolicy(Qt::NoFocus);
    area->setVerticalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
    area->setWidget(shelf);
    area->setFixedHeight(shelf->sizeHint().height() + area->horizontalScrollBar()->sizeHint().height());
    auto* heading = new QLabel(title, &dialog);
    heading->setProperty("look", "muted");
    const int below = grid->rowCount();
    grid->addWidget(heading, below, 0, 1, grid->columnCount());
    grid->addWidget(area, below + 1, 0, 1, grid->columnCount());
}

} // namespace lumorph::studio
