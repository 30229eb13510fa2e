#include "app/workspaces/levels/level_editor.h"

#include <span>

#include <QApplication>
#include <QDialog>
#include <QFileDialog>
#include <QFileInfo>
#include <QHBoxLayout>
#include <QLabel>
#include <QMenu>
#include <QPointer>
#include <QPushButton>
#include <QScrollArea>
#include <QShortcut>
#include <QSpinBox>
#include <QStyle>
#include <QToolButton>
#include <QVBoxLayout>

#include "app/applications/labyrinth/labyrinth.h"
#include "app/studio/look/icons.h"
#include "app/studio/widgets/panel.h"
#include "app/workspaces/levels/level_canvas.h"
#include "app/workspaces/levels/level_form.h"
#include "app/workspaces/levels/level_palette.h"
#include "core/base/atomic_file.h"
#include "core/base/error.h"

namespace lumorph::studio {
namespace {

constexpr const char* kEditorName = "levels.dialog";
constexpr const char* kFolderKey = "folders/levels";

class LevelEditor : public QDialog {
public:
    LevelEditor(Studio& studio, QWidget* parent);

    void begin();

private:
    QWidget* makeTools();
    QWidget* makeFoot();
    QWidget* makeSide();
    QToolButton* addTool(QBoxLayout& row, const char* name, const char* iconName, const QString& text,
                         const QString& hint);
    QMenu* makeBeginnings();
    void listen();
    void showNow();
    void showFinding();
    void travel(void (LevelDraft::*way)());
    void take(labyrinth::Level level, const QString& step);
    void openFile();
    void save();
    void takeForm(); ///< what is typed and not yet finished
    void write(const std::filesystem::path& file);
    void play();
    void tell(const std::exception& error);
    QFileDialog* makeFileDialog(const char* name, const QString& title);

    Studio& studio_;
    LevelDraft draft_;
    LevelCanvas* canvas_;
    LevelPalette* palette_ = new LevelPalette;
    LevelForm* form_ = new LevelForm;
    QSpinBox* height_ = new QSpinBox;
    QToolButton *undo_ = nullptr, *redo_ = nullptr, *save_ = nullptr;
    QLabel *finding_ = new QLabel, *cell_ = new QLabel;
    QPushButton* play_ = nullptr;
    QString failure_; ///< of opening or saving, until something else is done
};

LevelEditor::LevelEditor(Studio& studio, QWidget* parent)
    : QDialog(parent), studio_(studio), canvas_(new LevelCanvas(draft_)) {
    setObjectName(kEditorName);
    setWindowTitle(tr("Levels of the labyrinth"));
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(16, 12, 16, 16);
    layout->setSpacing(8);
    layout->addWidget(makeTools());
    auto* middle = new QHBoxLayout;
    middle->setSpacing(16);
    palette_->setFixedWidth(180);
    middle->addWidget(palette_);
    middle->addWidget(canvas_, 1);
    middle->addWidget(makeSide());
    layout->addLayout(middle, 1);
    layout->addWidget(makeFoot());
    listen();
    palette_->choose(canvas_->piece());
    showNow();
    const QSize wanted(1320, 780);
    resize(parent ? wanted.boundedTo(parent->window()->size() - QSize(48, 64)).expandedTo(QSize(960, 600)) : wanted);
}

QToolButton* LevelEditor::addTool(QBoxLayout& row, const char* name, const char* iconName, const QString& text,
                                  const QString& hint) {
    auto* button = new QToolButton;
    button->setObjectName(name);
    button->setIcon(icon(iconName));
    button->setIconSize({18, 18});
    button->setText(text);
    button->setToolTip(hint);
    button->setAccessibleName(text);
    button->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
    button->setMinimumHeight(30);
    row.addWidget(button);
    return button;
}

/// What a level may begin with: nothing, or one that comes with the program.
QMenu* LevelEditor::makeBeginnings() {
    auto* menu = new QMenu(this);
    menu->addAction(tr("An empty room"), this, [this] { take(emptyLevel(), tr("Begin a level")); });
    menu->addSeparator();
    try {
        for (const labyrinth::Level& level : labyrinth::bundledLevels())
            menu->addAction(QString::fromStdString(level.name), this,
                            [this, level] { take(level, tr("Begin with another level")); });
    } catch (const std::exception& error) {
        tell(error);
    }
    return menu;
}

QWidget* LevelEditor::makeTools() {
    auto* tools = new QWidget;
    auto* row = new QHBoxLayout(tools);
    row->setContentsMargins(0, 0, 0, 0);
    row->setSpacing(4);
    QToolButton* fresh = addTool(*row, "levels.new", "file", tr("New"),
                                 tr("Begin with an empty room, or with a level "
                                    "that comes with the labyrinth"));
    fresh->setPopupMode(QToolButton::InstantPopup);
    fresh->setMenu(makeBeginnings());
    connect(addTool(*row, "levels.open", "open", tr("Open..."), tr("Open a level's text (Ctrl+O)")),
            &QToolButton::clicked, this, [this] { openFile(); });
    save_ = addTool(*row, "levels.save", "save", tr("Save..."), {});
    connect(save_, &QToolButton::clicked, this, [this] { save(); });
    row->addSpacing(12);
    undo_ = addTool(*row, "levels.undo", "undo", tr("Undo"), {});
    redo_ = addTool(*row, "levels.redo", "redo", tr("Redo"), {});
    row->addStretch(1);
    auto* label = new QLabel(tr("&Height of what is put"));
    label->setProperty("look", "muted");
    label->setBuddy(height_);
    height_->setObjectName("levels.height");
    height_->setAccessibleName(tr("Height of what is put"));
    height_->setRange(0, labyrinth::kMaxHeight);
    height_->setSuffix(tr(" steps"));
    height_->setMinimumWidth(104);
    height_->setToolTip(tr("Over the lowest floor; ramps, stairs and bridges take theirs from what lies beside them "
                           "(digits, [ and ])"));
    row->addWidget(label);
    row->addWidget(height_);
    return tools;
}

QWidget* LevelEditor::makeSide() {
    auto* area = new QScrollArea;
    area->setWidgetResizable(true);
    area->setFrameShape(QFrame::NoFrame);
    area->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
    area->setFixedWidth(272);
    area->setFocusPolicy(Qt::NoFocus);
    auto* inside = new QWidget;
    auto* column = new QVBoxLayout(inside);
    column->setContentsMargins(0, 0, 8, 0);
    column->addWidget(form_);
    column->addStretch(1);
    area->setWidget(inside);
    return area;
}

QWidget* LevelEditor::makeFoot() {
    auto* foot = new QWidget;
    auto* row = new QHBoxLayout(foot);
    row->setContentsMargins(0, 0, 0, 0);
    row->setSpacing(8);
    auto* texts = new QVBoxLayout;
    texts->setSpacing(2);
    finding_->setObjectName("levels.finding");
    finding_->setWordWrap(true);
    finding_->setMinimumHeight(2 * finding_->fontMetrics().lineSpacing()); // nothing moves when it says more
    cell_->setObjectName("levels.cell-text");
    cell_->setProperty("look", "muted");
    texts->addWidget(finding_);
    texts->addWidget(cell_);
    row->addLayout(texts, 1);
    auto* close = new QPushButton(tr("Close"));
    close->setObjectName("levels.close");
    close->setToolTip(tr("Loses nothing: it is as it was when you come back"));
    close->setAutoDefault(false);
    connect(close, &QPushButton::clicked, this, &QDialog::reject);
    play_ = new QPushButton(tr("Play it"));
    play_->setObjectName("levels.play");
    play_->setProperty("look", "primary");
    play_->setAutoDefault(false);
    play_->setToolTip(tr("Open the labyrinth with this level alone (F5)"));
    connect(play_, &QPushButton::clicked, this, [this] { play(); });
    row->addWidget(close, 0, Qt::AlignBottom);
    row->addWidget(play_, 0, Qt::AlignBottom);
    return foot;
}

void LevelEditor::listen() {
    connect(palette_, &LevelPalette::chosen, this, [this](const LevelPiece& piece) {
        canvas_->setPiece(piece);
        if (!QApplication::keyboardModifiers() && palette_->underMouse()) canvas_->setFocus();
    });
    connect(canvas_, &LevelCanvas::pieceChanged, this, [this] { palette_->choose(canvas_->piece()); });
    connect(canvas_, &LevelCanvas::heightChanged, this, [this] { height_->setValue(canvas_->pieceHeight()); });
    connect(canvas_, &LevelCanvas::cursorChanged, this, [this] { cell_->setText(canvas_->cursorText()); });
    connect(canvas_, &LevelCanvas::edited, this, [this] { showNow(); });
    connect(height_, &QSpinBox::valueChanged, canvas_, &LevelCanvas::setPieceHeight);
    connect(form_, &LevelForm::edited, this,
            [this](const QString& step) { take(form_->filled(draft_.level()), step); });
    connect(form_, &LevelForm::resized, this, [this](int columns, int rows) {
        draft_.resize(columns, rows);
        showNow();
    });
    const auto undo = [this] { travel(&LevelDraft::undo); };
    const auto redo = [this] { travel(&LevelDraft::redo); };
    connect(undo_, &QToolButton::clicked, this, undo);
    connect(redo_, &QToolButton::clicked, this, redo);
    const auto onKeys = [this](const QKeySequence& keys, const auto& run) {
        connect(new QShortcut(keys, this), &QShortcut::activated, this, run);
    };
    onKeys(QKeySequence("Ctrl+Z"), undo);
    onKeys(QKeySequence("Ctrl+Shift+Z"), redo);
    onKeys(QKeySequence("Ctrl+Y"), redo);
    onKeys(QKeySequence("Ctrl+O"), [this] { openFile(); });
    onKeys(QKeySequence("Ctrl+S"), [this] { save(); });
    onKeys(QKeySequence("F5"), [this] { play(); });
}

void LevelEditor::begin() {
    QDialog::open();
    raise();
    activateWindow();
    canvas_->setFocus();
}

void LevelEditor::take(labyrinth::Level level, const QString& step) {
    draft_.change(std::move(level), step.toStdString());
    showNow();
}

void LevelEditor::travel(void (LevelDraft::*way)()) {
    (draft_.*way)();
    showNow();
}

void LevelEditor::showNow() {
    failure_.clear();
    form_->show(draft_.level());
    canvas_->refresh();
    undo_->setEnabled(draft_.canUndo());
    redo_->setEnabled(draft_.canRedo());
    undo_->setToolTip(draft_.canUndo() ? tr("Undo: %1 (Ctrl+Z)").arg(QString::fromStdString(draft_.undoName()))
                                       : tr("Nothing to undo"));
    redo_->setToolTip(draft_.canRedo() ? tr("Redo: %1 (Ctrl+Shift+Z)").arg(QString::fromStdString(draft_.redoName()))
                                       : tr("Nothing to redo"));
    showFinding();
}

void LevelEditor::showFinding() {
    const LevelFinding* finding = draft_.firstFinding();
    const bool sound = !finding || !finding->prevents;
    play_->setEnabled(sound);
    save_->setToolTip(sound ? tr("Save the level's text (Ctrl+S)")
                            : tr("Save what there is, to go on another day (Ctrl+S)"));
    QString text = tr("It can be solved: the dotted line is a way to the goal.");
    if (finding) text = QString::fromStdString(finding->text);
    if (!failure_.isEmpty()) text = failure_;
    finding_->setText(text);
    finding_->setProperty("look", finding || !failure_.isEmpty() ? "warning" : "muted");
    finding_->style()->unpolish(finding_);
    finding_->style()->polish(finding_);
}

void LevelEditor::tell(const std::exception& error) {
    const Notice notice = noticeOf(error);
    failure_ = notice.subject + ": " + notice.why + ". " + notice.remedy + ".";
    showFinding();
}

QFileDialog* LevelEditor::makeFileDialog(const char* name, const QString& title) {
    if (auto* already = findChild<QFileDialog*>(name)) {
        already->raise();
        return nullptr;
    }
    auto* dialog = new QFileDialog(this, title, studio_.settings.value(kFolderKey).toString());
    dialog->setObjectName(name);
    dialog->setOption(QFileDialog::DontUseNativeDialog);
    dialog->setAttribute(Qt::WA_DeleteOnClose);
    dialog->setNameFilters({tr("Levels (*.txt)"), tr("All files (*)")});
    return dialog;
}

void LevelEditor::openFile() {
    QFileDialog* dialog = makeFileDialog("dialog.levels.open", tr("Open a level"));
    if (!dialog) return;
    dialog->setFileMode(QFileDialog::ExistingFile);
    connect(dialog, &QFileDialog::fileSelected, this, [this](const QString& file) {
        studio_.settings.setValue(kFolderKey, QFileInfo(file).absolutePath());
        try {
            take(labyrinth::readUnfinishedLevel(file.toStdString()), tr("Open a level"));
        } catch (const std::exception& error) {
            tell(error);
        }
    });
    dialog->open();
}

void LevelEditor::takeForm() { take(form_->filled(draft_.level()), tr("Change the name")); }

void LevelEditor::save() {
    takeForm();
    QFileDialog* dialog = makeFileDialog("dialog.levels.save", tr("Save the level"));
    if (!dialog) return;
    dialog->setAcceptMode(QFileDialog::AcceptSave);
    dialog->setFileMode(QFileDialog::AnyFile);
    dialog->setDefaultSuffix("txt");
    connect(dialog, &QFileDialog::fileSelected, this, [this](const QString& file) {
        studio_.settings.setValue(kFolderKey, QFileInfo(file).absolutePath());
        write(file.toStdString());
    });
    dialog->open();
}

void LevelEditor::write(const std::filesystem::path& file) {
    try {
        const std::string text = labyrinth::unfinishedLevelText(draft_.level());
        writeFileAtomically(file, std::as_bytes(std::span(text)));
        const LevelFinding* finding = draft_.firstFinding();
        const QString name = QString::fromStdString(file.string());
        finding_->setText(
            finding && finding->prevents
                ? tr("Saved: %1. It cannot be played yet: %2").arg(name, QString::fromStdString(finding->text))
                : tr("Saved: %1").arg(name));
    } catch (const std::exception& error) {
        tell(error);
    }
}

void LevelEditor::play() {
    takeForm();
    if (!play_->isEnabled()) return;
    emit studio_.commands.workspaceWanted("scene");
    studio_.project.openDemo("labyrinth", [level = draft_.level()](std::uint64_t seed) {
        return std::make_unique<labyrinth::LabyrinthProgram>(seed, std::vector{level});
    });
    accept();
}

/// Not what is active: the list of commands is a window, too, and goes.
QWidget* mainWindow() {
    for (QWidget* top : QApplication::topLevelWidgets())
        if (top->objectName() == "mainWindow") return top;
    return nullptr;
}

} // namespace

void addLevelCommand(Studio& studio) {
    Commands::Options options;
    options.icon = "grid";
    options.menu = "File";
    QAction* action = studio.commands.add("labyrinth.levels", QObject::tr("Levels of the labyrinth..."), options,
                                          [&studio, editor = QPointer<LevelEditor>()]() mutable {
                                              if (!editor) editor = new LevelEditor(studio, mainWindow());
                                              editor->begin();
                                          });
    action->setToolTip(QObject::tr("Paint a level of your own, and play it"));
}

} // namespace lumorph::studio
