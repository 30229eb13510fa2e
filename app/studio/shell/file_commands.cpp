#include "app/studio/shell/file_commands.h"

#include <algorithm>

#include <QAbstractFileIconProvider>
#include <QCursor>
#include <QDateTime>
#include <QDir>
#include <QFileDialog>
#include <QFileInfo>
#include <QLocale>
#include <QMenu>

#include "app/applications/registry/demos.h"
#include "app/studio/look/icons.h"
#include "app/studio/shell/kept_work_list.h"
#include "app/studio/shell/record_commands.h"
#include "app/studio/widgets/bundled_shelf.h"

namespace lumorph::studio {
namespace {

std::filesystem::path pathOf(const QString& text) { return std::filesystem::path(text.toStdString()); }

/// Icons of our own set for folders and files.
class FileIcons : public QAbstractFileIconProvider {
public:
    [[nodiscard]] QIcon icon(IconType type) const override {
        return studio::icon(type == File ? "file" : "folder", type == File ? IconRole::muted : IconRole::control);
    }
    [[nodiscard]] QIcon icon(const QFileInfo& file) const override { return icon(file.isDir() ? Folder : File); }
};

/// The dialog reads icons in a thread until it is gone, so what makes them is a base that outlives it.
struct HoldsFileIcons {
    FileIcons icons;
};

/// Qt's own dialog: it wears our look, and a test can type into it.
class StudioFileDialog : private HoldsFileIcons, public QFileDialog {
public:
    StudioFileDialog(QWidget& window, const QString& title, const QString& name) : QFileDialog(&window, title) {
        setObjectName(name);
        setOption(QFileDialog::DontUseNativeDialog);
        setOption(QFileDialog::DontUseCustomDirectoryIcons);
        setIconProvider(&icons);
        setAttribute(Qt::WA_DeleteOnClose);
        for (const char* mode : {"listModeButton", "detailModeButton"}) // one way to look at files is enough
            if (auto* button = findChild<QWidget*>(mode)) button->hide();
        resize(860, 560);
    }
};

QString lastFolder(const Studio& studio) { return studio.settings.value("files/folder", QDir::homePath()).toString(); }

void openWithDialog(Studio& studio, QWidget& window) {
    auto* dialog = new StudioFileDialog(window, "Open", "dialog.open");
    dialog->setFileMode(QFileDialog::ExistingFile);
    dialog->setDirectory(lastFolder(studio));
    dialog->setNameFilters(
        {"Everything Lumorph opens (*.lumorph *.lumorphrec *.mdf *.glb *.gltf *.obj *.stl *.ply *.off)",
         "Projects (*.lumorph)", "Recordings (*.lumorphrec)", "Fields (*.mdf)",
         "3D models and rigs (*.glb *.gltf *.obj *.stl *.ply *.off)", "All files (*)"});
    QObject::connect(dialog, &QFileDialog::fileSelected, &studio.project, [&studio](const QString& file) {
        studio.settings.setValue("files/folder", QFileInfo(file).absolutePath());
        studio.project.open(pathOf(file));
    });
    addBundledShelf(*dialog, "Rigs that come with Lumorph", bundledRigs(),
                    [&studio](const std::filesystem::path& file) { studio.project.openRig(file); });
    addBundledShelf(*dialog, "Targets that come with Lumorph", bundledTargets(),
                    [&studio](const std::filesystem::path& file) { studio.project.openTarget(file); });
    dialog->resize(QSize(860, 760).boundedTo(window.size() * 0.95));
    dialog->show();
}

void saveWithDialog(Studio& studio, QWidget& window) {
    auto* dialog = new StudioFileDialog(window, "Save project as", "dialog.saveAs");
    dialog->setAcceptMode(QFileDialog::AcceptSave);
    dialog->setFileMode(QFileDialog::AnyFile);
    dialog->setDefaultSuffix("lumorph");
    dialog->setNameFilter("Projects (*.lumorph)");
    const auto& file = studio.document.file();
    dialog->setDirectory(file.empty() ? lastFolder(studio) : QString::fromStdString(file.parent_path().string()));
    dialog->selectFile(file.empty() ? "Untitled.lumorph" : QString::fromStdString(file.filename().string()));
    QObject::connect(dialog, &QFileDialog::fileSelected, &studio.project, [&studio](const QString& chosen) {
        studio.settings.setValue("files/folder", QFileInfo(chosen).absolutePath());
        studio.project.saveAs(pathOf(chosen));
    });
    dialog->show();
}

/// These say what the device is; everything else is taken for a target, or a rig, by what is in it.
bool saysDevice(const std::filesystem::path& file) {
    const QString suffix = QString::fromStdString(file.extension().string()).toLower();
    std::error_code error;
    return suffix == ".lumorph" || suffix == ".mdf" || std::filesystem::is_directory(file, error);
}

void tellLeftOver(Notices& notices, const std::vector<std::filesystem::path>& left) {
    if (left.empty()) return;
    QStringList names;
    for (const auto& file : left) names << QString::fromStdString(file.filename().string());
    Notice notice;
    notice.level = Notice::Level::info;
    notice.subject = names.mid(0, 3).join(", ") + (names.size() > 3 ? " and more" : "");
    notice.why = "One target at a time: the first file was opened, these were not.";
    notices.post("project", notice);
}

/// The installations that stood in the room before, by date, under the pointer.
void offerEarlierInstallations(Studio& studio, QWidget& window) {
    auto* menu = new QMenu(&window);
    menu->setAttribute(Qt::WA_DeleteOnClose);
    menu->setObjectName("room.earlier.menu");
    for (const std::filesystem::path& file : studio.room.earlier()) {
        const QFileInfo info(QString::fromStdString(file.string()));
        menu->addAction(icon("projector"), QLocale().toString(info.lastModified(), QLocale::ShortFormat), &studio.room,
                        [&studio, file] { studio.room.bringBack(file); });
    }
    if (menu->isEmpty()) menu->addAction("There is no earlier installation yet")->setEnabled(false);
    menu->popup(QCursor::pos());
}

/// One for each demonstration; it is shown in the workspace in which it is seen best.
void addDemoCommands(Studio& studio) {
    for (const Demo& demo : demos()) {
        Commands::Options options;
        options.icon = "play";
        options.menu = "File";
        const QString title = QObject::tr("Demonstration: %1").arg(QString::fromStdString(demo.title.english));
        QAction* action = studio.commands.add(
            QString("demo.%1").arg(QString::fromStdString(demo.name)), title, options, [&studio, &demo] {
                emit studio.commands.workspaceWanted(QString::fromStdString(demo.workspace));
                studio.project.openDemo(demo.name, Audience::host, studio.settings.toldTo(demo.name));
            });
        action->setToolTip(QString::fromStdString(demo.sentence.english));
    }
}

} // namespace

void addFileCommands(Studio& studio, QWidget& window) {
    Commands& commands = studio.commands;
    const auto add = [&commands](const char* id, const char* text, const char* iconName, const QKeySequence& keys,
                                 std::function<void()> run) {
        Commands::Options options;
        options.icon = iconName;
        options.shortcut = keys;
        options.menu = "File";
        commands.add(id, text, options, std::move(run));
    };
    // What a notice offers. Targets have a dialog of their own, with the bundled ones in it.
    QObject::connect(&studio.project, &ProjectService::saveElsewhere, &window,
                     [&studio, &window] { saveWithDialog(studio, window); });
    QObject::connect(&studio.project, &ProjectService::chooseFile, &window, [&studio, &window](const QString& place) {
        if (place != "target") openWithDialog(studio, window);
    });
    add("file.new", "&New project", "file", QKeySequence::New, [&studio] { studio.project.newProject(); });
    add("file.open", "&Open...", "open", QKeySequence::Open, [&studio, &window] { openWithDialog(studio, window); });
    addKeptWorkCommand(studio, window);
    addDemoCommands(studio);
    QObject::connect(&studio.project, &ProjectService::programOpened, &studio.loop,
                     [&studio](const std::shared_ptr<ShowProgram>& program, const std::filesystem::path& keepsake) {
                         studio.keepsakes.keep(program, keepsake);
                         studio.loop.setProgram(program);
                     });
    add("file.save", "&Save", "save", QKeySequence::Save, [&studio, &window] {
        if (!studio.project.save()) saveWithDialog(studio, window);
    });
    add("file.saveAs", "Save &as...", "save", QKeySequence(Qt::CTRL | Qt::SHIFT | Qt::Key_S),
        [&studio, &window] { saveWithDialog(studio, window); });
    addRecordCommands(studio, window);
    add("room.earlier", "Earlier &installation...", "projector", {},
        [&studio, &window] { offerEarlierInstallations(studio, window); });
    QObject::connect(&studio.loop, &StudioLoop::failed, &window, [&studio](const QString& why) {
        studio.notices.post("viewport", {Notice::Level::error, "Show", why, "start it again", {}});
    });
    add("file.quit", "&Quit", "", QKeySequence(Qt::CTRL | Qt::Key_Q), [&window] { window.close(); });
    const auto remember = [&studio](const QString& path) { studio.settings.addRecentFile(path); };
    QObject::connect(&studio.project, &ProjectService::opened, &window, remember);
    QObject::connect(&studio.project, &ProjectService::saved, &window, remember);
}

void fillRecentMenu(Studio& studio, QMenu& menu) {
    menu.clear();
    for (const QString& path : studio.settings.recentFiles()) {
        const QFileInfo file(path);
        QAction* action = menu.addAction(icon(file.isDir() ? "folder" : "file"), file.fileName().replace('&', "&&"));
        action->setToolTip(path);
        QObject::connect(action, &QAction::triggered, &studio.project,
                         [&studio, path] { studio.project.open(pathOf(path)); });
    }
    if (menu.isEmpty()) {
        menu.addAction("No recent files")->setEnabled(false);
        return;
    }
    menu.addSeparator();
    QObject::connect(menu.addAction("Clear this list"), &QAction::triggered, &studio.settings,
                     &Settings::clearRecentFiles);
}

void openDropped(Studio& studio, const std::vector<std::filesystem::path>& files) {
    const auto device = std::find_if(files.begin(), files.end(), saysDevice);
    const auto target = std::find_if_not(files.begin(), files.end(), saysDevice);
    std::vector<std::filesystem::path> left;
    for (auto file = files.begin(); file != files.end(); ++file)
        if (file != device && file != target) left.push_back(*file);
    if (device != files.end()) studio.project.open(*device);
    if (target != files.end()) studio.project.open(*target);
    tellLeftOver(studio.notices, left);
}

} // namespace lumorph::studio
