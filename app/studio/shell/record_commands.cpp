#include "app/studio/shell/record_commands.h"

#include <QDesktopServices>
#include <QDialog>
#include <QDialogButtonBox>
#include <QDir>
#include <QFileDialog>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QUrl>
#include <QVBoxLayout>

#include "app/studio/look/icons.h"

namespace lumorph::studio {
namespace {

namespace fs = std::filesystem;

constexpr auto kKind = "Recordings (*.lumorphrec)";
constexpr auto kTablesKey = "replay/tables";

QAction* addRecordAction(Studio& studio, const char* id, const QString& text, const char* icon, const QString& tip,
                         std::function<void()> run, const char* keys = "", bool inMenu = true) {
    Commands::Options options;
    options.icon = icon;
    options.shortcut = QKeySequence(keys);
    options.menu = inMenu ? "File" : "";
    QAction* action = studio.commands.add(id, text, options, std::move(run));
    action->setToolTip(tip);
    return action;
}

QString textOf(const fs::path& path) { return QString::fromStdString(path.string()); }

/// The nearest folder that is there.
QString folderThere(fs::path folder) {
    std::error_code ignored;
    while (!fs::is_directory(folder, ignored) && folder.has_relative_path()) folder = folder.parent_path();
    return textOf(folder);
}

QFileDialog* makeFileDialog(QWidget& window, const char* name, const QString& title, const QString& folder) {
    auto* dialog = new QFileDialog(&window, title, folder);
    dialog->setObjectName(name);
    dialog->setAttribute(Qt::WA_DeleteOnClose);
    dialog->setOption(QFileDialog::DontUseNativeDialog);
    return dialog;
}

void askWhereTo(Studio& studio, QWidget& window) {
    const fs::path fresh = studio.recorder.freshFile();
    QFileDialog* dialog = makeFileDialog(window, "dialog.record", "Record to", folderThere(studio.recorder.folder()));
    dialog->setAcceptMode(QFileDialog::AcceptSave);
    dialog->setDefaultSuffix("lumorphrec");
    dialog->setNameFilter(kKind);
    dialog->selectFile(textOf(fresh.filename()));
    dialog->setLabelText(QFileDialog::Accept, "Record");
    QObject::connect(dialog, &QFileDialog::fileSelected, &studio.recorder,
                     [&studio](const QString& file) { studio.recorder.start(file.toStdString()); });
    dialog->open();
}

void askWhatToReplay(Studio& studio, QWidget& window) {
    QFileDialog* dialog =
        makeFileDialog(window, "dialog.replay", "Open recording", folderThere(studio.recorder.folder()));
    dialog->setFileMode(QFileDialog::ExistingFile);
    dialog->setNameFilter(kKind);
    QObject::connect(dialog, &QFileDialog::fileSelected, &studio.replay,
                     [&studio](const QString& file) { studio.replay.open(file.toStdString()); });
    dialog->open();
}

void askForTables(Studio& studio, QWidget& window) {
    const QString beside = folderThere(studio.replay.file().parent_path());
    QFileDialog* dialog = makeFileDialog(window, "dialog.tables", "Export tables into a folder",
                                         studio.settings.value(kTablesKey, beside).toString());
    dialog->setFileMode(QFileDialog::Directory);
    dialog->setOption(QFileDialog::ShowDirsOnly);
    dialog->setLabelText(QFileDialog::Accept, "Export here");
    QObject::connect(dialog, &QFileDialog::fileSelected, &studio.replay, [&studio](const QString& folder) {
        studio.settings.setValue(kTablesKey, folder);
        studio.replay.exportTables(folder.toStdString());
    });
    dialog->open();
}

/// The moment counts at which the command came, not the one at which its words are typed.
void askMark(Studio& studio, QWidget& window) {
    if (window.findChild<QDialog*>("dialog.mark")) return;
    const Microseconds when = SteadyClock().now();
    auto* dialog = new QDialog(&window);
    dialog->setObjectName("dialog.mark");
    dialog->setAttribute(Qt::WA_DeleteOnClose);
    dialog->setWindowTitle("Mark this moment");
    auto* column = new QVBoxLayout(dialog);
    column->setContentsMargins(16, 16, 16, 16);
    column->setSpacing(8);
    auto* text = new QLineEdit(dialog);
    text->setObjectName("mark.text");
    text->setPlaceholderText("What happened at " + clockText(studio.recorder.seconds()) + "?");
    text->setMinimumWidth(320);
    text->setMaxLength(200);
    auto* buttons = new QDialogButtonBox(QDialogButtonBox::Cancel, dialog);
    QPushButton* put = buttons->addButton("Mark", QDialogButtonBox::AcceptRole);
    put->setObjectName("mark.accept");
    put->setProperty("look", "primary");
    put->setDefault(true);
    QObject::connect(buttons, &QDialogButtonBox::accepted, dialog, &QDialog::accept);
    QObject::connect(buttons, &QDialogButtonBox::rejected, dialog, &QDialog::reject);
    QObject::connect(dialog, &QDialog::accepted, &studio.recorder,
                     [&studio, text, when] { studio.recorder.mark(text->text(), when); });
    column->addWidget(text);
    column->addWidget(buttons);
    dialog->open();
}

void showFolder(const fs::path& file) { QDesktopServices::openUrl(QUrl::fromLocalFile(textOf(file.parent_path()))); }

void addRecording(Studio& studio, QWidget& window) {
    RecordingService& record = studio.recorder;
    QAction* start = addRecordAction(
        studio, "record.start", "&Record", "record",
        "Records the show: poses, levels, servos, and what happens, until you stop it", [&record] { record.start(); },
        "Ctrl+Alt+R");
    QAction* startAs =
        addRecordAction(studio, "record.startAs", "Record to...", "record", "The same, into a file that you choose",
                        [&studio, &window] { askWhereTo(studio, window); });
    QAction* mark = addRecordAction(
        studio, "record.mark", "&Mark this moment...", "mark", "Puts a mark with your words into the recording",
        [&studio, &window] { askMark(studio, window); }, "Ctrl+Alt+M");
    QAction* stop = addRecordAction(
        studio, "record.stop", "Stop recording", "pause", "Completes the file", [&record] { record.stop(); },
        "Ctrl+Alt+S");
    QAction* folder = addRecordAction(
        studio, "record.folder", "Show the folder of the recordings", "folder", {},
        [&record] { showFolder(record.file().empty() ? record.freshFile() : record.file()); }, "", false);
    const auto follow = [=, &record] {
        const bool idle = record.phase() == RecordingService::Phase::idle;
        start->setEnabled(idle);
        startAs->setEnabled(idle);
        stop->setEnabled(!idle);
        mark->setEnabled(record.phase() == RecordingService::Phase::recording);
        folder->setEnabled(true);
    };
    QObject::connect(&record, &RecordingService::changed, start, follow);
    follow();
    QObject::connect(&record, &RecordingService::chooseFile, &window,
                     [&studio, &window] { askWhereTo(studio, window); });
    QObject::connect(&record, &RecordingService::showWanted, &studio.replay,
                     [&studio](const QString& file) { studio.replay.open(file.toStdString()); });
}

void addReplay(Studio& studio, QWidget& window) {
    ReplayService& replay = studio.replay;
    addRecordAction(studio, "replay.open", "Open recordin&g...", "replay", "Shows a recorded session again",
                    [&studio, &window] { askWhatToReplay(studio, window); });
    QAction* play = addRecordAction(
        studio, "replay.play", "Play the recording", "play", {}, [&replay] { replay.setPlaying(!replay.playing()); },
        "Ctrl+Alt+Space", false);
    QAction* drive = addRecordAction(
        studio, "replay.drive", "Drive the servos by it...", "actuator", {},
        [&studio, &replay] {
            replay.drivesServos() ? replay.setDrivesServos(false)
                                  : studio.devices.askStart(DeviceService::StartBy::recording);
        },
        "", false);
    QAction* verify = addRecordAction(
        studio, "replay.verify", "Verify the servo bytes", "check",
        "Runs what went into the servo controller again and compares what comes out, bit for bit",
        [&replay] { replay.verify(); }, "", false);
    QAction* tables = addRecordAction(
        studio, "replay.export", "Export CSV...", "export", "Tables of frames, poses, events and servo traffic",
        [&studio, &window] { askForTables(studio, window); }, "", false);
    QAction* project = addRecordAction(
        studio, "replay.project", "Open the recorded project", "open", "A copy of the project as it was recorded",
        [&replay] { replay.openProject(); }, "", false);
    QAction* close = addRecordAction(
        studio, "replay.close", "Close the recording", "close", "Back to the live show", [&replay] { replay.close(); },
        "Ctrl+Alt+W", false);
    const auto follow = [=, &studio, &replay] {
        for (QAction* action : {play, verify, tables, project, close})
            action->setEnabled(replay.recording() != nullptr);
        play->setText(replay.playing() ? "Pause the recording" : "Play the recording");
        play->setIcon(icon(replay.playing() ? "pause" : "play"));
        const bool board = studio.devices.status().phase != LinkPhase::off;
        const bool drives = replay.drivesServos();
        drive->setEnabled(replay.recording() != nullptr && board);
        drive->setText(drives ? "Keep the servos still" : "Drive the servos by it...");
        drive->setToolTip(drives  ? "The recording goes on to be shown; the servos stay where they are"
                          : board ? "Shows what would move, and asks; until then the recording is only shown"
                                  : "No device is connected: the recording is only shown");
    };
    QObject::connect(&replay, &ReplayService::changed, play, follow);
    QObject::connect(&replay, &ReplayService::drivesServosChanged, play, follow);
    QObject::connect(&studio.devices, &DeviceService::changed, play, follow);
    follow();
    QObject::connect(&studio.project, &ProjectService::recordingChosen, &replay,
                     [&replay](const QString& file) { replay.open(file.toStdString()); });
}

} // namespace

void addRecordCommands(Studio& studio, QWidget& window) {
    addRecording(studio, window);
    addReplay(studio, window);
}

} // namespace lumorph::studio
