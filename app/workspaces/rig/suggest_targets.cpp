#include "app/workspaces/rig/suggest_targets.h"

#include <utility>

#include <QFileDialog>
#include <QHBoxLayout>
#include <QMenu>
#include <QPushButton>
#include <QVBoxLayout>

#include "app/studio/base/bundled_files.h"
#include "app/studio/look/icons.h"
#include "app/workspaces/common/export_dialogs.h"
#include "core/base/error.h"
#include "core/mdf/target_library.h"

namespace lumorph::studio {

namespace {

constexpr int kFile = Qt::UserRole;
constexpr QSize kPicture{40, 25};
constexpr const char* kFolderKey = "folders/suggestTargets";

std::filesystem::path fileOf(const QListWidgetItem& item) { return {item.data(kFile).toString().toStdU16String()}; }

QPushButton* makeFlat(const QString& text, const QString& name) {
    auto* button = new QPushButton(text);
    button->setObjectName(name);
    button->setProperty("look", "flat");
    return button;
}

} // namespace

SuggestTargets::SuggestTargets(Settings& settings, Notices& notices, QString place, QWidget* parent)
    : QWidget(parent), settings_(settings), notices_(notices), place_(std::move(place)), list_(new QListWidget) {
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(4);
    list_->setObjectName("rig.suggest.targets");
    list_->setAccessibleName(tr("Shapes that count"));
    list_->setIconSize(kPicture);
    list_->setUniformItemSizes(true);
    list_->setFixedHeight(150);
    for (const BundledFile& bundled : bundledTargets()) {
        QListWidgetItem* item = addItem(bundled.title, bundled.file);
        item->setIcon(bundled.picture.empty() ? icon("target")
                                              : QIcon(QString::fromStdString(bundled.picture.string())));
    }
    layout->addWidget(list_);
    auto* row = new QHBoxLayout;
    row->setSpacing(4);
    auto* add = makeFlat(tr("Add shapes"), "rig.suggest.add");
    auto* menu = new QMenu(add);
    menu->addAction(tr("Files..."), this, [this] { askFiles(); });
    menu->addAction(tr("All of a folder..."), this, [this] {
        askFolder(
            window(), settings_, "rig.suggest.folder", tr("Add the shapes of a folder"),
            [this](const QString& folder) { addFolder(folder); }, tr("Add"));
    });
    add->setMenu(menu);
    auto* all = makeFlat(tr("All"), "rig.suggest.all");
    auto* none = makeFlat(tr("None"), "rig.suggest.none");
    connect(all, &QPushButton::clicked, this, [this] { tickAll(true); });
    connect(none, &QPushButton::clicked, this, [this] { tickAll(false); });
    row->addWidget(add);
    row->addStretch(1);
    row->addWidget(all);
    row->addWidget(none);
    layout->addLayout(row);
    connect(list_, &QListWidget::itemChanged, this, &SuggestTargets::changed);
}

QListWidgetItem* SuggestTargets::addItem(const QString& title, const std::filesystem::path& file) {
    auto* item = new QListWidgetItem(title);
    item->setFlags(item->flags() | Qt::ItemIsUserCheckable);
    item->setCheckState(Qt::Checked);
    item->setData(kFile, QString::fromStdU16String(file.u16string()));
    item->setToolTip(QString::fromStdU16String(file.u16string()));
    list_->addItem(item);
    return item;
}

std::vector<std::filesystem::path> SuggestTargets::ticked() const {
    std::vector<std::filesystem::path> files;
    for (int k = 0; k < list_->count(); ++k)
        if (list_->item(k)->checkState() == Qt::Checked) files.push_back(fileOf(*list_->item(k)));
    return files;
}

void SuggestTargets::add(const std::vector<std::filesystem::path>& files) {
    for (const std::filesystem::path& file : files) {
        QListWidgetItem* known = nullptr;
        for (int k = 0; k < list_->count(); ++k)
            if (fileOf(*list_->item(k)) == file) known = list_->item(k);
        if (!known) {
            known = addItem(QString::fromStdU16String(file.filename().u16string()), file);
            known->setIcon(icon("file"));
        }
        known->setCheckState(Qt::Checked);
        list_->scrollToItem(known);
    }
    emit changed();
}

void SuggestTargets::tickAll(bool on) {
    for (int k = 0; k < list_->count(); ++k) list_->item(k)->setCheckState(on ? Qt::Checked : Qt::Unchecked);
}

void SuggestTargets::askFiles() {
    auto* dialog = new QFileDialog(window(), tr("Add shapes"), settings_.value(kFolderKey).toString());
    dialog->setObjectName("dialog.suggest");
    dialog->setOption(QFileDialog::DontUseNativeDialog);
    dialog->setAttribute(Qt::WA_DeleteOnClose);
    dialog->setFileMode(QFileDialog::ExistingFiles);
    dialog->setNameFilters({tr("Meshes (*.glb *.gltf *.obj *.stl *.ply *.off)"), tr("All files (*)")});
    connect(dialog, &QFileDialog::filesSelected, this, [this](const QStringList& chosen) {
        std::vector<std::filesystem::path> files;
        for (const QString& file : chosen) files.emplace_back(file.toStdU16String());
        if (!chosen.isEmpty()) settings_.setValue(kFolderKey, QFileInfo(chosen.front()).absolutePath());
        add(files);
    });
    dialog->open();
}

void SuggestTargets::addFolder(const QString& folder) {
    try {
        add(meshFilesIn(std::filesystem::path(folder.toStdU16String())));
    } catch (const Error& error) {
        notices_.post(place_, noticeOf(error));
    }
}

} // namespace lumorph::studio
