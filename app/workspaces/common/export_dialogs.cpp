#include "app/workspaces/common/export_dialogs.h"

#include <cmath>

#include <QButtonGroup>
#include <QDialog>
#include <QDialogButtonBox>
#include <QDir>
#include <QFileDialog>
#include <QFileInfo>
#include <QLabel>
#include <QPushButton>
#include <QRadioButton>
#include <QStandardPaths>
#include <QVBoxLayout>

#include "app/studio/widgets/panel.h"
#include "app/studio/widgets/value_field.h"
#include "app/workspaces/common/style_form.h"

namespace lumorph::studio {
namespace {

const QString kFolderKey = QStringLiteral("export/folder");

QString lastFolder(const Settings& settings) {
    QString kept = settings.value(kFolderKey).toString();
    if (!kept.isEmpty() && QDir(kept).exists()) return kept;
    const QString documents = QStandardPaths::writableLocation(QStandardPaths::DocumentsLocation);
    return QDir(documents).exists() ? documents : QDir::homePath();
}

QFileDialog* makeFileDialog(QWidget* parent, Settings& settings, const QString& id, const QString& title) {
    auto* dialog = new QFileDialog(parent, title, lastFolder(settings));
    dialog->setObjectName(id + ".file");
    dialog->setAttribute(Qt::WA_DeleteOnClose);
    dialog->setOption(QFileDialog::DontUseNativeDialog);
    return dialog;
}

/// The folder of what is chosen is where the next one begins.
void openFor(QFileDialog* dialog, Settings& settings, std::function<void(const QString&)> chosen) {
    QObject::connect(dialog, &QFileDialog::fileSelected, dialog,
                     [&settings, chosen = std::move(chosen)](const QString& file) {
                         settings.setValue(kFolderKey, QFileInfo(file).absolutePath());
                         chosen(file);
                     });
    dialog->open();
}

/// A window of one column with a title, what is asked, and "accept" and "Cancel".
struct Asking {
    QDialog* dialog = nullptr;
    QVBoxLayout* layout = nullptr;
    QPushButton* accept = nullptr;
};

Asking makeAsking(QWidget* parent, const QString& id, const QString& title, const QString& accept) {
    Asking asking;
    asking.dialog = new QDialog(parent);
    asking.dialog->setObjectName(id + ".dialog");
    asking.dialog->setAttribute(Qt::WA_DeleteOnClose);
    asking.dialog->setWindowTitle(title);
    auto* outer = new QVBoxLayout(asking.dialog);
    outer->setContentsMargins(16, 16, 16, 16);
    outer->setSpacing(16);
    asking.layout = new QVBoxLayout;
    asking.layout->setSpacing(8);
    outer->addLayout(asking.layout);
    outer->addStretch(1);
    auto* buttons = new QDialogButtonBox;
    asking.accept = buttons->addButton(accept, QDialogButtonBox::AcceptRole);
    asking.accept->setObjectName(id + ".accept");
    asking.accept->setProperty("look", "primary");
    asking.accept->setDefault(true);
    buttons->addButton(QDialogButtonBox::Cancel)->setObjectName(id + ".cancel");
    QObject::connect(buttons, &QDialogButtonBox::accepted, asking.dialog, &QDialog::accept);
    QObject::connect(buttons, &QDialogButtonBox::rejected, asking.dialog, &QDialog::reject);
    outer->addWidget(buttons);
    outer->setSizeConstraint(QLayout::SetFixedSize);
    return asking;
}

ValueField* numberField(const QString& id, Quantity quantity, double low, double high, double value, double step) {
    auto* field = new ValueField(quantity, low, high, value);
    field->setObjectName(id);
    field->setStep(step);
    field->setValue(value);
    return field;
}

} // namespace

void askFile(QWidget* parent, Settings& settings, const QString& id, const QString& title, const QString& name,
             const std::vector<SaveKind>& kinds, std::function<void(const QString&)> chosen) {
    QFileDialog* dialog = makeFileDialog(parent, settings, id, title);
    dialog->setAcceptMode(QFileDialog::AcceptSave);
    dialog->setFileMode(QFileDialog::AnyFile);
    QStringList filters;
    for (const SaveKind& kind : kinds) filters += QObject::tr("%1 (*.%2)").arg(kind.text, kind.suffix);
    dialog->setNameFilters(filters);
    dialog->setDefaultSuffix(kinds.front().suffix);
    dialog->selectFile(name + "." + kinds.front().suffix);
    QObject::connect(dialog, &QFileDialog::filterSelected, dialog, [dialog, filters, kinds, name](const QString& text) {
        const qsizetype index = filters.indexOf(text);
        if (index < 0) return;
        const QString suffix = kinds[static_cast<std::size_t>(index)].suffix;
        dialog->setDefaultSuffix(suffix);
        const QStringList typed = dialog->selectedFiles();
        const QString base = typed.isEmpty() ? name : QFileInfo(typed.front()).completeBaseName();
        dialog->selectFile(base + "." + suffix);
    });
    openFor(dialog, settings, std::move(chosen));
}

void askFileToOpen(QWidget* parent, Settings& settings, const QString& id, const QString& title, const QString& filter,
                   std::function<void(const QString&)> chosen) {
    QFileDialog* dialog = makeFileDialog(parent, settings, id, title);
    dialog->setFileMode(QFileDialog::ExistingFile);
    dialog->setNameFilter(filter);
    openFor(dialog, settings, std::move(chosen));
}

void askNewFolder(QWidget* parent, Settings& settings, const QString& id, const QString& title, const QString& name,
                  std::function<void(const QString&)> chosen, const QString& accept) {
    QFileDialog* dialog = makeFileDialog(parent, settings, id, title);
    dialog->setAcceptMode(QFileDialog::AcceptSave);
    dialog->setFileMode(QFileDialog::AnyFile);
    dialog->setLabelText(QFileDialog::Accept, accept);
    dialog->selectFile(name);
    openFor(dialog, settings, std::move(chosen));
}

void askFolder(QWidget* parent, Settings& settings, const QString& id, const QString& title,
               std::function<void(const QString&)> chosen, const QString& accept) {
    QFileDialog* dialog = makeFileDialog(parent, settings, id, title);
    dialog->setFileMode(QFileDialog::Directory);
    dialog->setOption(QFileDialog::ShowDirsOnly);
    dialog->setLabelText(QFileDialog::Accept, accept.isEmpty() ? QObject::tr("Export here") : accept);
    QObject::connect(dialog, &QFileDialog::fileSelected, dialog,
                     [&settings, chosen = std::move(chosen)](const QString& folder) {
                         settings.setValue(kFolderKey, folder);
                         chosen(folder);
                     });
    dialog->open();
}

void askShape(QWidget* parent, std::function<void(bool)> chosen) {
    const QString id = QStringLiteral("export.mesh");
    const Asking asking = makeAsking(parent, id, QObject::tr("Export the shape"), QObject::tr("Choose a file..."));
    auto* estimated = new QRadioButton(QObject::tr("As the device &stands now"));
    estimated->setObjectName(id + ".estimated");
    estimated->setChecked(true);
    auto* wanted = new QRadioButton(QObject::tr("As it is &asked to stand"));
    wanted->setObjectName(id + ".wanted");
    auto* hint = new QLabel(QObject::tr("They differ while the servos are on their way.\n"
                                        "Written in metres, +Y up, as OBJ, GLB or STL."));
    hint->setProperty("look", "muted");
    for (QWidget* widget : std::initializer_list<QWidget*>{estimated, wanted, hint}) asking.layout->addWidget(widget);
    QObject::connect(asking.dialog, &QDialog::accepted, asking.dialog,
                     [estimated, chosen = std::move(chosen)] { chosen(estimated->isChecked()); });
    asking.dialog->open();
}

void askPicture(QWidget* parent, const PictureStyle& start, double ratio, const PreviewPainter& preview,
                std::function<void(const PictureStyle&)> chosen) {
    const QString id = QStringLiteral("export.picture");
    const Asking asking = makeAsking(parent, id, QObject::tr("Export a picture"), QObject::tr("Choose a file..."));
    const QSize asView(1920, std::max(64, static_cast<int>(std::lround(1920.0 / ratio))));
    PictureStyle style = start;
    if (!style.size.isValid() || style.size.isEmpty()) style.size = asView;
    auto* form = new StyleForm(id, style,
                               {{QObject::tr("As the view"), asView},
                                {QObject::tr("Full HD"), {1920, 1080}},
                                {QObject::tr("4K"), {3840, 2160}},
                                {QObject::tr("Square"), {2048, 2048}}},
                               preview);
    asking.layout->addWidget(form);
    QObject::connect(asking.dialog, &QDialog::accepted, asking.dialog,
                     [form, chosen = std::move(chosen)] { chosen(form->style()); });
    asking.dialog->open();
}

void askTurntable(QWidget* parent, const Turntable& start, const PreviewPainter& preview,
                  std::function<void(const Turntable&)> chosen) {
    const QString id = QStringLiteral("export.turntable");
    const Asking asking =
        makeAsking(parent, id, QObject::tr("Export a turntable video"), QObject::tr("Choose a file..."));
    auto* form = new StyleForm(id, start.style,
                               {{QObject::tr("HD"), {1280, 720}},
                                {QObject::tr("Full HD"), {1920, 1080}},
                                {QObject::tr("Square"), {1080, 1080}}},
                               preview);
    ValueField* seconds = numberField(id + ".seconds", Quantity::seconds, 0.5, 120.0, start.seconds, 0.5);
    ValueField* rate = numberField(id + ".rate", Quantity::plain, 1.0, 120.0, start.framesPerSecond, 1.0);
    auto* count = new QLabel;
    count->setObjectName(id + ".count");
    count->setProperty("look", "muted");
    asking.layout->addWidget(form);
    asking.layout->addWidget(makeRow(QObject::tr("One t&urn takes"), seconds));
    asking.layout->addWidget(makeRow(QObject::tr("&Frames a second"), rate));
    asking.layout->addWidget(count);
    const auto turntable = [form, seconds, rate] { return Turntable{form->style(), seconds->value(), rate->value()}; };
    const auto tell = [count, turntable] {
        count->setText(QObject::tr("%1 pictures, MP4 video").arg(turntable().frames()));
    };
    for (ValueField* field : {seconds, rate}) QObject::connect(field, &ValueField::committed, count, tell);
    tell();
    QObject::connect(asking.dialog, &QDialog::accepted, asking.dialog,
                     [turntable, chosen = std::move(chosen)] { chosen(turntable()); });
    asking.dialog->open();
}

} // namespace lumorph::studio
