#include "app/workspaces/rig/parts_dialog.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <utility>

#include <QComboBox>
#include <QDesktopServices>
#include <QDialog>
#include <QDialogButtonBox>
#include <QHeaderView>
#include <QLabel>
#include <QPushButton>
#include <QScrollArea>
#include <QTableWidget>
#include <QUrl>
#include <QVBoxLayout>

#include "app/studio/devices/device_shelf.h"
#include "app/studio/document/job_slots.h"
#include "app/studio/document/rig_edit.h"
#include "app/studio/widgets/panel.h"
#include "app/studio/widgets/value_field.h"
#include "app/workspaces/common/export_dialogs.h"
#include "app/workspaces/common/field_output.h"
#include "app/workspaces/rig/rig_facts.h"
#include "core/base/error.h"
#include "core/rig/parts/build_files.h"
#include "devices/firmware/part_board.h"

namespace lumorph::studio {

namespace {

const QString kPartsPlace = QStringLiteral("export.parts"); ///< of the plan's job, which only the window itself shows
const QString kTellPlace = QStringLiteral("rig");
const QString kServoKey = QStringLiteral("parts/servo");
const QString kBedKey = QStringLiteral("parts/bed");
const QString kToleranceKey = QStringLiteral("parts/tolerance");

constexpr int kNoteHeight = 84; ///< five lines

/// What is to be written, and for which rig.
struct Planned {
    std::shared_ptr<const Rig> rig;
    std::shared_ptr<const Rig> origin; ///< of the document's rig, by which it is known after edits
    std::shared_ptr<const BuildPlan> plan;
};

int piecesOf(const BuildPlan& plan) {
    int pieces = 0;
    for (const PrintPart& part : plan.parts) pieces += part.count;
    return pieces;
}

QString countOf(int count, const QString& one, const QString& more) {
    return QString("%1 %2").arg(count).arg(count == 1 ? one : more);
}

QString contentText(const BuildPlan& plan) {
    return QObject::tr("%1 to print, %2")
        .arg(countOf(piecesOf(plan), QObject::tr("piece"), QObject::tr("pieces")),
             countOf(static_cast<int>(plan.wiring.size()), QObject::tr("servo"), QObject::tr("servos")));
}

QString boardText(const BuildPlan& plan) {
    if (plan.wiring.empty()) return QObject::tr("none: nothing moves yet");
    if (plan.wiring.size() > kBoardServos) return QObject::tr("Pololu Maestros, set up in Devices");
    return QObject::tr("Arduino Pro Mini; its sketch goes along");
}

QString partSizeText(const PrintPart& part) {
    const glm::vec3 size = boundingBox(part.solid.mesh.positions).size();
    return QObject::tr("%1 × %2 × %3 mm")
        .arg(static_cast<double>(size.x), 0, 'f', 1)
        .arg(static_cast<double>(size.y), 0, 'f', 1)
        .arg(static_cast<double>(size.z), 0, 'f', 1);
}

/// The servos of Devices wired as the plan says, by one step of its undo.
void wireDevices(Studio& studio, const Planned& planned) {
    DeviceProfile profile = studio.devices.profile();
    wireAs(*planned.plan, profile);
    emit studio.commands.workspaceWanted("devices");
    if (!studio.devices.setProfile(profile, QObject::tr("Wire as the parts say"))) return;
    studio.notices.post("devices", {Notice::Level::info,
                                    QObject::tr("Set-up of the servos"),
                                    QObject::tr("pins, pulses and directions are those of the wiring table"),
                                    QObject::tr("Undo takes it back"),
                                    {}});
}

bool canBeWired(Studio& studio, const Planned& planned) {
    const DeviceProfile& profile = studio.devices.profile();
    return studio.document.state().rig.origin == planned.origin && profile.controller == ControllerKind::firmata &&
           profile.servos.size() == planned.plan->wiring.size() && profile.servos.size() <= kBoardServos &&
           !profile.servos.empty();
}

void tellWritten(Studio& studio, const Planned& planned, const std::filesystem::path& folder) {
    const QString place = QString::fromStdString(folder.string());
    Notice notice;
    notice.level = Notice::Level::info;
    notice.subject = QObject::tr("Parts of %1").arg(QString::fromStdString(planned.plan->device));
    notice.why = QObject::tr("%1, in %2").arg(contentText(*planned.plan), place);
    notice.remedy = QObject::tr("Begin with assembly.html there");
    notice.actions.push_back(
        {QObject::tr("Open the folder"), [place] { QDesktopServices::openUrl(QUrl::fromLocalFile(place)); }});
    if (canBeWired(studio, planned))
        notice.actions.push_back({QObject::tr("Set Devices up so"), [&studio, planned] {
                                      if (canBeWired(studio, planned)) wireDevices(studio, planned);
                                  }});
    studio.notices.post(kTellPlace, std::move(notice));
}

void askWhere(Studio& studio, QWidget* parent, const Planned& planned);

void tellFailed(Studio& studio, QWidget* parent, const Planned& planned, const std::exception& error) {
    Notice notice = noticeOf(error);
    notice.actions.push_back(
        {QObject::tr("Choose another place"), [&studio, parent, planned] { askWhere(studio, parent, planned); }});
    studio.notices.post(kTellPlace, std::move(notice));
}

std::filesystem::path writeParts(const Planned& planned, const std::filesystem::path& parent,
                                 const Progress& progress) {
    progress.report(0.0, "making the files");
    const QString name = fileNameOf(QString::fromStdString(planned.plan->device));
    std::filesystem::path folder = freshFolder(parent, name.toStdString() + " parts");
    writeBuildFolder(
        buildFiles(*planned.plan), folder,
        [&](const std::filesystem::path& made) { addBoardFiles(*planned.rig, *planned.plan, made); }, progress);
    return folder;
}

void askWhere(Studio& studio, QWidget* parent, const Planned& planned) {
    askFolder(parent, studio.settings, kPartsPlace, QObject::tr("Where to put the folder of the parts"),
              [&studio, parent, planned](const QString& chosen) {
                  studio.jobs.run<std::filesystem::path>(
                      kTellPlace, QObject::tr("Writing the parts"),
                      [planned, chosen = std::filesystem::path(chosen.toStdString())](const Progress& progress) {
                          return writeParts(planned, chosen, progress);
                      },
                      [&studio, planned](const std::filesystem::path& folder) { tellWritten(studio, planned, folder); },
                      [&studio, parent, planned](const std::exception& error) {
                          tellFailed(studio, parent, planned, error);
                      });
              });
}

class PartsDialog : public QDialog {
public:
    PartsDialog(Studio& studio, QWidget* parent);

private:
    QWidget* makeForm();
    QWidget* makeTable();
    QWidget* makeNotes();
    QWidget* makeButtons();
    /// A number of millimetres.
    ValueField* addNumber(QVBoxLayout& rows, const QString& label, const QString& name, const QString& tip,
                          ProfileLimits limits, double usual, const QString& key);
    QLabel* makeText(const QString& name, const char* look);
    void plan(); ///< anew, of the document's rig, beside the window; the newest choice wins
    void fitRig();
    void take(const Planned& planned);
    void refuse(const std::exception& why);

    Studio& studio_;
    JobSlots jobs_;
    Planned planned_;
    QComboBox* servo_ = new QComboBox;
    ValueField* bed_ = nullptr;
    ValueField* tolerance_ = nullptr;
    QLabel* board_ = nullptr;
    QLabel* summary_ = nullptr;
    QLabel* notes_ = nullptr;
    QScrollArea* noteArea_ = new QScrollArea;
    QLabel* wrong_ = nullptr;
    QTableWidget* table_ = new QTableWidget;
    QPushButton* fit_ = nullptr;
    QPushButton* write_ = nullptr;
};

PartsDialog::PartsDialog(Studio& studio, QWidget* parent)
    : QDialog(parent), studio_(studio), jobs_(*this, studio.jobs, studio.notices) {
    const StudioState::RigAsset& asset = studio.document.state().rig;
    planned_ = {asset.rig, asset.origin, nullptr};
    setObjectName("export.parts.dialog");
    setAttribute(Qt::WA_DeleteOnClose);
    setWindowTitle(tr("Export parts to build"));
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(16, 16, 16, 16);
    layout->setSpacing(12);
    layout->addWidget(makeForm());
    summary_ = makeText("export.parts.summary", "muted");
    layout->addWidget(summary_);
    layout->addWidget(makeTable(), 1);
    notes_ = makeText("export.parts.notes", "muted");
    layout->addWidget(makeNotes());
    wrong_ = makeText("export.parts.wrong", "warning");
    layout->addWidget(wrong_);
    layout->addWidget(makeJobBar(studio.jobs, kPartsPlace));
    layout->addWidget(makeButtons());
    resize(560, 620);
    plan();
}

QLabel* PartsDialog::makeText(const QString& name, const char* look) {
    auto* label = new QLabel;
    label->setObjectName(name);
    label->setProperty("look", look);
    label->setTextFormat(Qt::PlainText);
    label->setWordWrap(true);
    label->hide();
    return label;
}

QWidget* PartsDialog::makeForm() {
    auto* form = new QWidget;
    auto* rows = new QVBoxLayout(form);
    rows->setContentsMargins(0, 0, 0, 0);
    rows->setSpacing(4);
    servo_->setObjectName("export.parts.servo");
    for (const ServoBody& body : servoBodies()) servo_->addItem(shownText(body.name));
    servo_->setCurrentIndex(std::max(0, servo_->findText(studio_.settings.value(kServoKey).toString())));
    servo_->setToolTip(tr("What the seats hold, as its published drawing measures it"));
    connect(servo_, &QComboBox::activated, this, [this] {
        studio_.settings.setValue(kServoKey, servo_->currentText());
        plan();
    });
    rows->addWidget(makeRow(tr("&Servo"), servo_));
    const PartOptions usual;
    bed_ = addNumber(*rows, tr("Print &bed (mm)"), "export.parts.bed",
                     tr("Sides of the printer's bed; larger parts come in pieces with dovetails"), {50.0, 2000.0},
                     usual.bed, kBedKey);
    bed_->setStep(10.0);
    tolerance_ = addNumber(*rows, tr("&Tolerance (mm)"), "export.parts.tolerance",
                           tr("Between a part and what goes into it, on every side"), {0.0, 1.0}, usual.tolerance,
                           kToleranceKey);
    tolerance_->setStep(0.05);
    board_ = new QLabel;
    board_->setObjectName("export.parts.board");
    board_->setToolTip(tr("What drives the servos; the wiring table tells its pins"));
    rows->addWidget(makeRow(tr("Board"), board_));
    return form;
}

ValueField* PartsDialog::addNumber(QVBoxLayout& rows, const QString& label, const QString& name, const QString& tip,
                                   ProfileLimits limits, double usual, const QString& key) {
    auto* field = new ValueField(Quantity::plain, limits.least, limits.most, usual);
    field->setObjectName(name);
    field->setToolTip(tip + ".\n" + field->toolTip());
    field->setRefusing(true);
    field->setValue(std::clamp(studio_.settings.value(key, usual).toDouble(), limits.least, limits.most));
    connect(field, &ValueField::committed, this, [this, key](double value) {
        studio_.settings.setValue(key, value);
        plan();
    });
    connect(field, &ValueField::refused, this, [this](const QString& why) {
        wrong_->setText(why);
        wrong_->show();
    });
    rows.addWidget(makeRow(label, field));
    return field;
}

QWidget* PartsDialog::makeTable() {
    table_->setObjectName("export.parts.table");
    table_->setAccessibleName(tr("Parts to print"));
    table_->setColumnCount(3);
    table_->setHorizontalHeaderLabels({tr("Pieces"), tr("Part"), tr("Size")});
    table_->verticalHeader()->hide();
    table_->horizontalHeader()->setSectionResizeMode(QHeaderView::ResizeToContents);
    table_->horizontalHeader()->setSectionResizeMode(1, QHeaderView::Stretch);
    table_->horizontalHeader()->setDefaultAlignment(Qt::AlignLeft | Qt::AlignVCenter);
    table_->setShowGrid(false);
    table_->setSelectionMode(QAbstractItemView::NoSelection);
    table_->setEditTriggers(QAbstractItemView::NoEditTriggers);
    table_->setFocusPolicy(Qt::NoFocus);
    return table_;
}

/// As high as it has to be, and scrolled where a device of many flaps has many.
QWidget* PartsDialog::makeNotes() {
    noteArea_->setWidget(notes_);
    noteArea_->setWidgetResizable(true);
    noteArea_->setFrameShape(QFrame::NoFrame);
    noteArea_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
    noteArea_->setFixedHeight(kNoteHeight);
    noteArea_->hide();
    notes_->setAlignment(Qt::AlignTop);
    return noteArea_;
}

QWidget* PartsDialog::makeButtons() {
    auto* buttons = new QDialogButtonBox;
    write_ = buttons->addButton(tr("Choose a folder..."), QDialogButtonBox::AcceptRole);
    write_->setObjectName("export.parts.accept");
    write_->setProperty("look", "primary");
    write_->setDefault(true);
    buttons->addButton(QDialogButtonBox::Cancel)->setObjectName("export.parts.cancel");
    fit_ = buttons->addButton(tr("&Fit the rig to its levers"), QDialogButtonBox::ActionRole);
    fit_->setObjectName("export.parts.fit");
    fit_->setToolTip(tr("Ranges end where these levers end, and half of a pulse is what half of it lifts: field, light "
                        "and servos then agree with what is built. One step of undo"));
    fit_->hide();
    connect(fit_, &QPushButton::clicked, this, &PartsDialog::fitRig);
    connect(buttons, &QDialogButtonBox::accepted, this, [this] {
        if (!planned_.plan) return;
        accept();
        askWhere(studio_, parentWidget(), planned_);
    });
    connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
    return buttons;
}

void PartsDialog::plan() {
    planned_.plan.reset();
    write_->setEnabled(false);
    fit_->hide();
    PartOptions options;
    options.servo = servoBodies()[static_cast<std::size_t>(servo_->currentIndex())];
    options.bed = bed_->value();
    options.tolerance = tolerance_->value();
    jobs_.runWith<Planned>(
        "plan", kPartsPlace, tr("Planning the parts"),
        [planned = planned_, parts = studio_.document.state().rig.parts, options](const Progress& progress) mutable {
            if (parts && *parts != planned.rig->parts()) planned.rig = std::make_shared<const Rig>(*parts);
            planned.plan = std::make_shared<const BuildPlan>(buildPlanOf(*planned.rig, options, progress));
            return planned;
        },
        [this](const Planned& planned) { take(planned); }, [this](const std::exception& error) { refuse(error); });
}

void PartsDialog::take(const Planned& planned) {
    planned_ = planned;
    const std::shared_ptr<const BuildPlan>& plan = planned_.plan;
    write_->setEnabled(true);
    fit_->setVisible(withLevers(*planned_.rig, *plan) != planned_.rig->parts());
    wrong_->hide();
    board_->setText(boardText(*plan));
    summary_->setText(contentText(*plan) + tr(". Besides: parts list, wiring table, assembly page."));
    summary_->show();
    QStringList notes;
    for (const std::string& note : plan->notes) notes += QString::fromStdString(note);
    notes_->setText(notes.join('\n'));
    notes_->show();
    noteArea_->setVisible(!notes.isEmpty());
    table_->setRowCount(static_cast<int>(plan->parts.size()));
    for (int row = 0; const PrintPart& part : plan->parts) {
        auto* count = new QTableWidgetItem(QString::number(part.count));
        auto* name = new QTableWidgetItem(QString::fromStdString(part.name));
        name->setToolTip(QString::fromStdString(part.use + ". " + part.material));
        table_->setItem(row, 0, count);
        table_->setItem(row, 1, name);
        table_->setItem(row, 2, new QTableWidgetItem(partSizeText(part)));
        ++row;
    }
}

void PartsDialog::fitRig() {
    if (!planned_.plan) return;
    editRig(studio_.document, tr("Fit the rig to its levers"),
            [this](RigParts& parts) { parts = withLevers(*planned_.rig, *planned_.plan); });
    plan();
}

/// Without parts there is nothing to choose a folder for.
void PartsDialog::refuse(const std::exception& why) {
    const Notice notice = noticeOf(why);
    wrong_->setText(tr("%1: %2. %3.").arg(notice.subject, notice.why, notice.remedy));
    wrong_->show();
    summary_->hide();
    noteArea_->hide();
    table_->setRowCount(0);
    board_->clear();
}

} // namespace

void openPartsDialog(Studio& studio, QWidget* parent) {
    if (!studio.document.state().rig.rig) return;
    if (auto* open = parent->findChild<QDialog*>("export.parts.dialog")) {
        open->raise();
        open->activateWindow();
        return;
    }
    (new PartsDialog(studio, parent))->open();
}

} // namespace lumorph::studio
