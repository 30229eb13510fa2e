#include "app/workspaces/rig/draw_sheet.h"

#include <algorithm>
#include <memory>
#include <utility>

#include <QButtonGroup>
#include <QDialog>
#include <QFileDialog>
#include <QHBoxLayout>
#include <QLabel>
#include <QPointer>
#include <QPushButton>
#include <QShortcut>
#include <QSpinBox>
#include <QToolButton>
#include <QVBoxLayout>

#include "app/studio/document/job_slots.h"
#include "app/studio/look/icons.h"
#include "app/studio/widgets/dock_parts.h"
#include "app/studio/widgets/panel.h"
#include "app/studio/widgets/value_field.h"
#include "app/workspaces/rig/device_preview.h"
#include "app/workspaces/rig/sheet_canvas.h"
#include "app/workspaces/rig/sheet_form.h"
#include "app/workspaces/rig/sheet_history.h"
#include "core/base/error.h"
#include "core/rig/templates/sheet_file.h"
#include "core/rig/templates/sheet_outline.h"
#include "core/rig/templates/sheet_plan.h"

namespace lumorph::studio {

namespace {

constexpr const char* kDialogName = "rig.draw.dialog";
constexpr const char* kDrawPlace = "rig.draw"; ///< of its jobs; what goes wrong is told in the window itself
constexpr const char* kSvgFolder = "folders/svg";
constexpr int kMostCopies = 12;

QString begun(QString sentence) {
    if (!sentence.isEmpty()) sentence[0] = sentence[0].toUpper();
    return sentence;
}

/// "Bend line 'flap 2': it is shorter than 6 mm. Draw it across the sheet."
QString sentenceOf(const QString& subject, const QString& why, const QString& remedy) {
    return QObject::tr("%1: %2. %3.").arg(subject, why, begun(remedy));
}

QFrame* makeDivider() {
    auto* divider = new QFrame;
    divider->setFrameShape(QFrame::VLine);
    divider->setFixedHeight(20);
    return divider;
}

class DrawSheet : public QDialog {
public:
    DrawSheet(Studio& studio, QWidget* parent);

    /// Shows it with another drawing, or with the one it has when that is the same. `before`: the rig that it is the
    /// drawing of; empty for a new device.
    void begin(SheetDevice drawing, std::shared_ptr<const RigParts> before);

protected:
    void showEvent(QShowEvent* event) override;
    void hideEvent(QHideEvent* event) override;

private:
    QWidget* makeTools();
    QWidget* makeSide();
    QWidget* makeFoot();
    QToolButton* addButton(QBoxLayout& row, const QString& name, const QString& icon, const QString& text,
                           const QString& hint);
    void addTool(QBoxLayout& row, SheetTool tool, const QString& name, const QString& icon, const QString& text,
                 const QString& hint);
    void listen();
    void edit(const SheetDevice& device, const QString& step);
    void preview(const SheetDevice& device);
    void showNow(); ///< the drawing as it is, everywhere
    void showTexts();
    void travel(void (SheetHistory::*way)() noexcept);
    void copy(const QString& step,
              const std::function<SheetDevice(const SheetDevice&, std::optional<std::size_t>)>& of);
    void importOutline();
    void tell(const std::exception& error);
    void plan(const SheetDevice& device); ///< beside the window; while one is at work the newest waits
    void planNow();
    void take(const std::shared_ptr<const SheetPlan>& plan, const SheetDevice& device);
    [[nodiscard]] bool canBeMade() const; ///< as far as it is known
    void useIt();

    Studio& studio_;
    JobSlots jobs_;
    SheetHistory history_;
    std::shared_ptr<const RigParts> before_;
    std::shared_ptr<const SheetPlan> plan_;
    SheetDevice planned_; ///< what `plan_` is of
    SheetDevice working_; ///< what is being planned
    SheetDevice wished_;  ///< what is to be planned
    std::optional<Jobs::Id> planning_;
    bool makesSoon_ = false;         ///< as soon as what is wished is planned
    std::vector<glm::dvec2> framed_; ///< the outline that the preview was framed for
    SheetCanvas* canvas_ = new SheetCanvas;
    SheetForm* form_ = new SheetForm;
    DevicePreview* preview_;
    QButtonGroup* tools_ = nullptr;
    QToolButton *undo_ = nullptr, *redo_ = nullptr, *mirror_ = nullptr, *around_ = nullptr;
    QSpinBox* copies_ = new QSpinBox;
    QLabel *hint_ = new QLabel, *wrong_ = new QLabel, *facts_ = new QLabel;
    QPushButton* make_ = nullptr;
};

DrawSheet::DrawSheet(Studio& studio, QWidget* parent)
    : QDialog(parent), studio_(studio), jobs_(*this, studio.jobs, studio.notices),
      preview_(new DevicePreview(studio, kDrawPlace)) {
    setObjectName(kDialogName);
    setWindowTitle(tr("Draw a device"));
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(16, 12, 16, 16);
    layout->setSpacing(8);
    layout->addWidget(makeTools());
    auto* middle = new QHBoxLayout;
    middle->setSpacing(16);
    middle->addWidget(canvas_, 1);
    middle->addWidget(makeSide());
    layout->addLayout(middle, 1);
    layout->addWidget(makeFoot());
    listen();
    const QSize wanted(1360, 800);
    resize(parent ? wanted.boundedTo(parent->window()->size() - QSize(48, 64)).expandedTo(QSize(960, 600)) : wanted);
}

QToolButton* DrawSheet::addButton(QBoxLayout& row, const QString& name, const QString& iconName, const QString& text,
                                  const QString& hint) {
    auto* button = new QToolButton;
    button->setObjectName(name);
    button->setIcon(icon(iconName));
    button->setIconSize({18, 18});
    button->setText(text);
    button->setToolTip(hint);
    button->setToolButtonStyle(text.isEmpty() ? Qt::ToolButtonIconOnly : Qt::ToolButtonTextBesideIcon);
    button->setMinimumHeight(30);
    row.addWidget(button);
    return button;
}

void DrawSheet::addTool(QBoxLayout& row, SheetTool tool, const QString& name, const QString& iconName,
                        const QString& text, const QString& hint) {
    QToolButton* button = addButton(row, name, iconName, text, hint);
    button->setCheckable(true);
    tools_->addButton(button, static_cast<int>(tool));
}

QWidget* DrawSheet::makeTools() {
    auto* tools = new QWidget;
    auto* row = new QHBoxLayout(tools);
    row->setContentsMargins(0, 0, 0, 0);
    row->setSpacing(4);
    tools_ = new QButtonGroup(tools);
    addTool(*row, SheetTool::select, "sheet.tool.select", "pointer", tr("Select"),
            tr("Choose and move what is drawn (V)"));
    row->addWidget(makeDivider());
    addTool(*row, SheetTool::rectangle, "sheet.tool.rectangle", "rectangle", tr("Rectangle"),
            tr("Draw the sheet's outline as a rectangle (R)"));
    addTool(*row, SheetTool::ellipse, "sheet.tool.ellipse", "ellipse", tr("Ellipse"),
            tr("Draw the sheet's outline as an ellipse or circle (E)"));
    addTool(*row, SheetTool::polygon, "sheet.tool.polygon", "polygon", tr("Polygon"),
            tr("Draw the sheet's outline corner by corner (P)"));
    QToolButton* import = addButton(*row, "sheet.import", "open", tr("Import..."),
                                    tr("Take the outline from an SVG drawing with one closed shape"));
    connect(import, &QToolButton::clicked, this, &DrawSheet::importOutline);
    row->addWidget(makeDivider());
    addTool(*row, SheetTool::line, "sheet.tool.line", "bend-line", tr("Bend line"),
            tr("Draw a line along which a part of the sheet bends up (B)"));
    row->addWidget(makeDivider());
    mirror_ = addButton(*row, "sheet.mirror", "mirror", tr("Mirror all"), {});
    around_ = addButton(*row, "sheet.around", "around", tr("All around"), {});
    for (QToolButton* button : {mirror_, around_}) // what is beside them stays when they tell of one line
        button->setStyleSheet("QToolButton { min-width: 104px; }");
    copies_->setObjectName("sheet.copies");
    copies_->setRange(2, kMostCopies);
    copies_->setValue(4);
    copies_->setPrefix("× ");
    copies_->setToolTip(tr("How many there are around the middle, with the one that is copied"));
    copies_->setFixedWidth(64);
    row->addWidget(copies_);
    row->addStretch(1);
    QToolButton* snap = addButton(*row, "sheet.snap", "magnet", {},
                                  tr("Snap to the grid, edges, corners and ends; hold Ctrl to place freely once"));
    snap->setCheckable(true);
    snap->setChecked(true);
    connect(snap, &QToolButton::toggled, canvas_, &SheetCanvas::setSnapping);
    QToolButton* all = addButton(*row, "sheet.all", "frame", {}, tr("Show the whole drawing (Home)"));
    connect(all, &QToolButton::clicked, canvas_, &SheetCanvas::showAll);
    row->addWidget(makeDivider());
    undo_ = addButton(*row, "sheet.undo", "undo", {}, {});
    redo_ = addButton(*row, "sheet.redo", "redo", {}, {});
    return tools;
}

QWidget* DrawSheet::makeSide() {
    auto* side = new QWidget;
    side->setFixedWidth(340);
    auto* layout = new QVBoxLayout(side);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(8);
    preview_->setMinimumHeight(220);
    facts_->setObjectName("sheet.facts");
    facts_->setProperty("look", "muted");
    facts_->setWordWrap(true);
    layout->addWidget(preview_, 1);
    layout->addWidget(facts_);
    form_->setSizePolicy(QSizePolicy::Preferred, QSizePolicy::Fixed);
    layout->addWidget(form_);
    return side;
}

QWidget* DrawSheet::makeFoot() {
    auto* foot = new QWidget;
    auto* row = new QHBoxLayout(foot);
    row->setContentsMargins(0, 0, 0, 0);
    row->setSpacing(8);
    auto* texts = new QVBoxLayout;
    texts->setSpacing(2);
    wrong_->setObjectName("sheet.wrong");
    wrong_->setProperty("look", "warning");
    wrong_->setWordWrap(true);
    wrong_->hide();
    QSizePolicy kept = wrong_->sizePolicy(); // the page stays where it is when it speaks
    kept.setRetainSizeWhenHidden(true);
    wrong_->setSizePolicy(kept);
    hint_->setObjectName("sheet.hint");
    hint_->setWordWrap(true);
    texts->addWidget(wrong_);
    texts->addWidget(hint_);
    row->addLayout(texts, 1);
    auto* close = new QPushButton(tr("Close"));
    close->setObjectName("sheet.close");
    close->setToolTip(tr("Loses nothing: the next time that you draw, Ctrl+Z leads back to this"));
    close->setAutoDefault(false);
    connect(close, &QPushButton::clicked, this, &QDialog::reject);
    make_ = new QPushButton(tr("Make this device"));
    make_->setObjectName("sheet.accept");
    make_->setProperty("look", "primary");
    make_->setAutoDefault(false);
    connect(make_, &QPushButton::clicked, this, &DrawSheet::useIt);
    auto* working = new QWidget; // of one size, so that nothing moves when the bar in it comes and goes
    working->setFixedSize(300, 40);
    auto* bar = new QVBoxLayout(working);
    bar->setContentsMargins(0, 0, 0, 0);
    bar->addWidget(makeJobBar(studio_.jobs, kDrawPlace));
    row->addWidget(working, 0, Qt::AlignBottom);
    row->addWidget(close, 0, Qt::AlignBottom);
    row->addWidget(make_, 0, Qt::AlignBottom);
    return foot;
}

void DrawSheet::listen() {
    connect(tools_, &QButtonGroup::idClicked, this, [this](int id) {
        canvas_->setTool(static_cast<SheetTool>(id));
        canvas_->setFocus();
    });
    connect(canvas_, &SheetCanvas::toolChanged, this,
            [this] { tools_->button(static_cast<int>(canvas_->tool()))->setChecked(true); });
    connect(canvas_, &SheetCanvas::previewed, this, &DrawSheet::plan);
    connect(canvas_, &SheetCanvas::edited, this, &DrawSheet::edit);
    connect(canvas_, &SheetCanvas::reverted, this, &DrawSheet::showNow);
    connect(canvas_, &SheetCanvas::chosenChanged, this, [this] {
        form_->show(history_.now(), canvas_->chosenLine());
        showTexts();
    });
    connect(canvas_, &SheetCanvas::hintChanged, this, &DrawSheet::showTexts);
    connect(form_, &SheetForm::previewed, this, &DrawSheet::preview);
    connect(form_, &SheetForm::edited, this, &DrawSheet::edit);
    connect(form_, &SheetForm::reverted, this, &DrawSheet::showNow);
    connect(form_, &SheetForm::otherSideWanted, this, [this] {
        const auto line = canvas_->chosenLine();
        if (!line) return;
        const bool known = plan_ && *line < plan_->flaps.size();
        edit(withOtherSide(history_.now(), *line, known ? plan_->flaps[*line] : std::vector<glm::dvec2>()),
             tr("Move the other side"));
    });
    connect(form_, &SheetForm::removeWanted, this, [this] {
        const auto line = canvas_->chosenLine();
        if (!line) return;
        canvas_->choose({});
        edit(withoutLine(history_.now(), *line), tr("Delete a bend line"));
    });
    connect(mirror_, &QToolButton::clicked, this, [this] {
        copy(tr("Mirror"),
             [](const SheetDevice& device, std::optional<std::size_t> line) { return mirrored(device, line); });
    });
    connect(around_, &QToolButton::clicked, this, [this] {
        copy(tr("Copy around"), [count = copies_->value()](const SheetDevice& device, std::optional<std::size_t> line) {
            return repeatedAround(device, count, line);
        });
    });
    const auto onKeys = [this](const QKeySequence& keys, const auto& run) {
        connect(new QShortcut(keys, this), &QShortcut::activated, this, run);
    };
    const auto undo = [this] { travel(&SheetHistory::undo); };
    const auto redo = [this] { travel(&SheetHistory::redo); };
    onKeys(QKeySequence("Ctrl+Z"), undo);
    onKeys(QKeySequence("Ctrl+Shift+Z"), redo);
    onKeys(QKeySequence("Ctrl+Y"), redo);
    connect(undo_, &QToolButton::clicked, this, undo);
    connect(redo_, &QToolButton::clicked, this, redo);
    connect(&studio_.jobs, &Jobs::finished, this, [this](int id) {
        if (planning_ != id) return;
        planning_.reset();
        if (working_ != wished_ && isVisible()) planNow(); // one that was cancelled is not begun again
    });
}

void DrawSheet::begin(SheetDevice drawing, std::shared_ptr<const RigParts> before) {
    before_ = std::move(before);
    drawing = parseSheetDevice(writeSheetDevice(drawing), drawing.name);
    const bool other = drawing != history_.now();
    if (other) {
        canvas_->choose({});
        history_.push(std::move(drawing), tr("Begin a drawing"));
    }
    showNow();
    canvas_->setTool(history_.now().outline.empty() ? SheetTool::rectangle : SheetTool::line);
    tools_->button(static_cast<int>(canvas_->tool()))->setChecked(true);
    open();
    if (other) canvas_->showAll();
    canvas_->setFocus();
}

void DrawSheet::showEvent(QShowEvent* event) {
    preview_->setActive(true);
    QDialog::showEvent(event);
}

void DrawSheet::hideEvent(QHideEvent* event) {
    preview_->setActive(false);
    if (planning_) studio_.jobs.cancel(*planning_);
    QDialog::hideEvent(event);
}

void DrawSheet::edit(const SheetDevice& device, const QString& step) {
    // As its text holds it, so that a drawing that is taken up again makes the very same device.
    const SheetDevice drawn = parseSheetDevice(writeSheetDevice(device), device.name);
    if (drawn != history_.now()) history_.push(drawn, step);
    showNow();
}

void DrawSheet::preview(const SheetDevice& device) {
    canvas_->show(device);
    plan(device);
}

void DrawSheet::travel(void (SheetHistory::*way)() noexcept) {
    (history_.*way)();
    showNow();
}

void DrawSheet::showNow() {
    const SheetDevice& now = history_.now();
    canvas_->show(now);
    form_->show(now, canvas_->chosenLine());
    if (framed_ != now.outline) {
        framed_ = now.outline;
        preview_->frameNext();
    }
    plan(now);
    undo_->setEnabled(history_.canUndo());
    redo_->setEnabled(history_.canRedo());
    undo_->setToolTip(history_.canUndo() ? tr("Undo: %1 (Ctrl+Z)").arg(history_.undoText()) : tr("Nothing to undo"));
    redo_->setToolTip(history_.canRedo() ? tr("Redo: %1 (Ctrl+Shift+Z)").arg(history_.redoText())
                                         : tr("Nothing to redo"));
}

void DrawSheet::showTexts() {
    hint_->setText(canvas_->hint());
    const bool line = canvas_->chosenLine().has_value();
    mirror_->setText(line ? tr("Mirror line") : tr("Mirror all"));
    around_->setText(line ? tr("Line around") : tr("All around"));
    mirror_->setToolTip(line ? tr("A copy of the chosen bend line, left for right about the middle of the page")
                             : tr("A copy of sheet and bend lines, left for right about the middle of the page"));
    around_->setToolTip(line ? tr("Copies of the chosen bend line around the middle of the page")
                             : tr("Copies of sheet and bend lines around the middle of the page: one petal becomes a "
                                  "flower"));
    const bool any = !history_.now().outline.empty();
    for (QWidget* widget : {static_cast<QWidget*>(mirror_), static_cast<QWidget*>(around_)}) widget->setEnabled(any);
}

void DrawSheet::copy(const QString& step,
                     const std::function<SheetDevice(const SheetDevice&, std::optional<std::size_t>)>& of) {
    try {
        edit(of(history_.now(), canvas_->chosenLine()), step);
    } catch (const std::exception& error) {
        tell(error);
    }
    canvas_->setFocus();
}

void DrawSheet::tell(const std::exception& error) {
    const Notice notice = noticeOf(error);
    wrong_->setText(sentenceOf(notice.subject, notice.why, notice.remedy));
    wrong_->show();
}

void DrawSheet::importOutline() {
    if (auto* open = findChild<QFileDialog*>("dialog.svg")) return open->raise();
    auto* dialog = new QFileDialog(this, tr("Import an outline"), studio_.settings.value(kSvgFolder).toString());
    dialog->setObjectName("dialog.svg");
    dialog->setOption(QFileDialog::DontUseNativeDialog);
    dialog->setAttribute(Qt::WA_DeleteOnClose);
    dialog->setFileMode(QFileDialog::ExistingFile);
    dialog->setNameFilters({tr("SVG drawings (*.svg)"), tr("All files (*)")});
    connect(dialog, &QFileDialog::fileSelected, this, [this](const QString& file) {
        studio_.settings.setValue(kSvgFolder, QFileInfo(file).absolutePath());
        jobs_.runWith<std::vector<glm::dvec2>>(
            "import", kDrawPlace, tr("Reading the outline"),
            [path = std::filesystem::path(file.toStdU16String())](const Progress&) {
                return checkedOutline(readOutline(path), path.filename().string());
            },
            [this](std::vector<glm::dvec2> outline) {
                edit(withOutline(history_.now(), std::move(outline)), tr("Import an outline"));
                canvas_->showAll();
                canvas_->setTool(SheetTool::line);
            },
            [this](const std::exception& error) { tell(error); });
    });
    dialog->open();
}

void DrawSheet::plan(const SheetDevice& device) {
    wished_ = device;
    makesSoon_ = false;
    make_->setEnabled(canBeMade());
    if (wished_.outline.empty()) {
        facts_->setText(tr("Nothing is drawn yet."));
        wrong_->hide();
        canvas_->setPlan(nullptr);
        preview_->show(nullptr);
    } else if (!planning_ && !(plan_ && planned_ == wished_)) {
        planNow();
    }
}

void DrawSheet::planNow() {
    if (wished_.outline.empty()) return;
    working_ = wished_;
    const auto work = [device = wished_, before = before_](const Progress& progress) {
        auto plan = std::make_shared<SheetPlan>(planSheet(device, progress));
        if (before && plan->rig)
            plan->rig = std::make_shared<const Rig>(carriedOver(RigParts(plan->rig->parts()), *before));
        return std::shared_ptr<const SheetPlan>(std::move(plan));
    };
    planning_ = studio_.jobs.run<std::shared_ptr<const SheetPlan>>(
        kDrawPlace, tr("Making the device"), work,
        [alive = QPointer(this), device = wished_](const std::shared_ptr<const SheetPlan>& plan) {
            if (alive) alive->take(plan, device);
        },
        [alive = QPointer(this), device = wished_](const std::exception& error) { // of memory, say
            auto none = std::make_shared<SheetPlan>();
            none->refusals.push_back({std::nullopt, "sheet", error.what(), "simplify the drawing"});
            if (alive) alive->take(none, device);
        });
}

void DrawSheet::take(const std::shared_ptr<const SheetPlan>& plan, const SheetDevice& device) {
    plan_ = plan;
    planned_ = device;
    canvas_->setPlan(plan);
    make_->setEnabled(canBeMade());
    wrong_->setVisible(!plan->refusals.empty());
    if (!plan->refusals.empty()) {
        const SheetRefusal& first = plan->refusals.front();
        QString text = sentenceOf(begun(QString::fromStdString(first.subject)), QString::fromStdString(first.why),
                                  QString::fromStdString(first.remedy));
        if (plan->refusals.size() > 1) text += tr(" (%1 more)").arg(plan->refusals.size() - 1);
        wrong_->setText(text);
    }
    if (!plan->rig) return;
    const auto size = plan->rig->reach().size();
    facts_->setText(
        tr("Servos: %1. Over all states it takes %2.")
            .arg(plan->rig->actuatorCount())
            .arg(sizeText(static_cast<double>(size.x), static_cast<double>(size.y), static_cast<double>(size.z))));
    preview_->show(plan->rig);
    if (makesSoon_) useIt();
}

bool DrawSheet::canBeMade() const {
    const bool known = plan_ && planned_ == wished_;
    return known ? plan_->whole() : !wished_.outline.empty();
}

void DrawSheet::useIt() {
    if (!canBeMade()) return;
    makesSoon_ = planned_ != wished_ || !plan_; // whoever is quicker than the solid need not press again
    if (makesSoon_) return;
    const auto use = [this](const std::shared_ptr<const Rig>& rig) {
        accept();
        studio_.project.takeRig(rig, QString::fromStdString(rig->name()));
    };
    if (!plan_->rig->parts().sheet) return use(plan_->rig);
    // What is seen is solved coarsely.
    make_->setEnabled(false);
    jobs_.runWith<std::shared_ptr<const Rig>>(
        "solve", kDrawPlace, tr("Solving the sheet"),
        [device = planned_, before = before_](const Progress& progress) {
            RigParts parts = sheetRig(device, progress).parts();
            if (before) parts = carriedOver(std::move(parts), *before);
            return std::make_shared<const Rig>(std::move(parts));
        },
        use,
        [this](const std::exception& error) {
            tell(error);
            make_->setEnabled(canBeMade());
        });
}

DrawSheet& drawSheetOf(Studio& studio, QWidget* parent) {
    auto* open = dynamic_cast<DrawSheet*>(parent->findChild<QDialog*>(kDialogName));
    return open ? *open : *new DrawSheet(studio, parent);
}

} // namespace

void openDrawSheet(Studio& studio, QWidget* parent, SheetDevice drawing) {
    drawSheetOf(studio, parent).begin(std::move(drawing), nullptr);
}

void openDrawingOfRig(Studio& studio, QWidget* parent) {
    const std::shared_ptr<const RigParts> parts = studio.document.state().rig.parts;
    if (!parts || parts->drawing.empty()) return;
    try {
        SheetDevice drawing = parseSheetDevice(parts->drawing, "the drawing of '" + parts->name + "'");
        // Actuators that were renamed since stand for the lines that they were made of.
        if (drawing.bends.size() == parts->actuators.size())
            for (std::size_t k = 0; k < drawing.bends.size(); ++k) drawing.bends[k].name = parts->actuators[k].name;
        drawSheetOf(studio, parent).begin(std::move(drawing), parts);
    } catch (const std::exception& error) {
        studio.notices.post("rig", noticeOf(error));
    }
}

RigParts carriedOver(RigParts made, const RigParts& before) {
    for (Actuator& actuator : made.actuators) {
        const auto old = std::ranges::find(before.actuators, actuator.name, &Actuator::name);
        if (old == before.actuators.end()) continue;
        const auto *bend = std::get_if<Bend>(&actuator.deformer), *was = std::get_if<Bend>(&old->deformer);
        if (bend && was && bend->max == was->max) actuator.maxVelocity = old->maxVelocity;
        actuator.levels = old->levels;
        actuator.dampingRatio = old->dampingRatio;
        actuator.drive = old->drive;
    }
    return made;
}

} // namespace lumorph::studio
