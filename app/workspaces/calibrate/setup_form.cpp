#include "app/workspaces/calibrate/setup_form.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <QAbstractItemView>
#include <QGuiApplication>
#include <QHBoxLayout>
#include <QPointer>
#include <QScreen>
#include <QSignalBlocker>
#include <QVBoxLayout>

#include "app/studio/widgets/panel.h"
#include "app/workspaces/calibrate/calibrate_commands.h"
#include "calibration/capture/genicam_camera.h"
#include "calibration/capture/mjpeg_camera.h"
#include "calibration/lab/lab_capture.h"

namespace lumorph::studio {
namespace {

constexpr int kListWidth = 300; // of lists whose words are longer than the dock is wide

struct PatternChoice {
    const char* words;
    const char* text; ///< as `parsePattern` reads it
    const char* hint;
};
constexpr PatternChoice kPatterns[] = {
    {"Gray code (robust)", "graycode", "Stripes and their inverses: works on any board, with any camera"},
    {"Phase shift (fewer images)", "phase:16x3+1x3", "Waves of grey: fewer images, but gamma must be right"}};

constexpr auto kOrderFile = "order"; // data of the choice that opens one

QWidget* pairOf(QWidget* first, const QString& between, QWidget* second, QWidget* parent) {
    auto* pair = new QWidget(parent);
    auto* row = new QHBoxLayout(pair);
    row->setContentsMargins(0, 0, 0, 0);
    row->setSpacing(4);
    row->addWidget(first, 1);
    auto* label = new QLabel(between, pair);
    label->setProperty("look", "muted");
    row->addWidget(label);
    row->addWidget(second, 1);
    return pair;
}

QLabel* nameOfRow(QWidget* row) { return row->findChild<QLabel*>(QString(), Qt::FindDirectChildrenOnly); }

} // namespace

SetupForm::SetupForm(const CalibrateParts& parts, QWidget* parent) : QWidget(parent), parts_(parts) {
    setObjectName("calibrate.setup");
    auto* column = new QVBoxLayout(this);
    column->setContentsMargins(0, 0, 0, 0);
    column->setSpacing(8);
    addSource(*column);
    rest_ = new QWidget(this);
    auto* rest = new QVBoxLayout(rest_);
    rest->setContentsMargins(0, 0, 0, 0);
    rest->setSpacing(8);
    addBoard(*rest);
    addPatterns(*rest);
    column->addWidget(rest_);
    connect(&parts_.service, &CalibrationService::changed, this, [this] { refresh(); });
    refresh();
}

void SetupForm::edit(const std::function<void(CalibrationSetup&)>& change) {
    CalibrationSetup setup = parts_.service.state().setup;
    change(setup);
    parts_.service.setSetup(setup);
}

ValueField* SetupForm::addNumber(const QString& name, Quantity quantity, double low, double high, double usual) {
    auto* field = new ValueField(quantity, low, high, usual, this);
    field->setObjectName(name);
    field->setRefusing(true);
    return field;
}

void SetupForm::addSource(QVBoxLayout& column) {
    column.addWidget(makeHeading("Pictures come from", this));
    way_ = new Segments({{"calibrate.way.lab", "Virtual lab", "Without any hardware; the truth is known"},
                         {"calibrate.way.folder", "Folder", "Images that were taken before"},
                         {"calibrate.way.camera", "Camera", "A camera of this machine and the projector's window"},
                         {"calibrate.way.crosshairs", "No camera", "A crosshair that you lay onto the device"}},
                        this);
    connect(way_, &Segments::chosen, this, [this](int way) { parts_.service.setWay(static_cast<CaptureWay>(way)); });
    column.addWidget(way_);
    wayWords_ = new QLabel(this);
    wayWords_->setObjectName("calibrate.way.words");
    wayWords_->setProperty("look", "muted");
    wayWords_->setWordWrap(true);
    column.addWidget(wayWords_);
    installed_ = new QComboBox(this);
    installed_->setObjectName("calibrate.projector");
    installed_->setToolTip("Which projector of the room is calibrated; each for itself, one after the other");
    installed_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
    installed_->setMinimumContentsLength(8);
    installedRow_ = makeRow("Pro&jector", installed_, this);
    column.addWidget(installedRow_);
    connect(installed_, &QComboBox::activated, this, [this](int number) {
        edit([number](CalibrationSetup& setup) { setup.installed = static_cast<std::size_t>(number); });
    });
    connect(&parts_.studio.document, &StudioDocument::changed, this, [this](StateParts changed) {
        if (changed & StatePart::installation) listProjectors();
    });
    screen_ = new QComboBox(this);
    screen_->setObjectName("calibrate.screen");
    screen_->setToolTip("The screen that is the projector; it shows its number there once it is chosen");
    screen_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
    screen_->setMinimumContentsLength(8);
    screenRow_ = makeRow("Projector a&t", screen_, this);
    column.addWidget(screenRow_);
    ProjectorOutputs& outputs = parts_.studio.outputs;
    connect(screen_, &QComboBox::activated, this, [this, &outputs] {
        const std::size_t projector = parts_.service.projector();
        outputs.useScreen(projector, screen_->currentData().toString());
        if (ProjectorWindow* shown = outputs.window(projector)) shown->identify();
        listScreens();
    });
    connect(&outputs, &ProjectorOutputs::changed, this, [this] { listScreens(); });
    connect(qGuiApp, &QGuiApplication::screenAdded, this, [this] { listScreens(); });
    folder_ = new QPushButton(this);
    folder_->setObjectName("calibrate.folder");
    folder_->setToolTip("In it one folder for each pose, each with the images of all patterns in their order");
    connect(folder_, &QPushButton::clicked, this, [this] { askForImages(parts_); });
    column.addWidget(folder_);
    patterns_ = new QPushButton("Patterns to show...", this);
    patterns_->setObjectName("calibrate.patterns.write");
    patterns_->setToolTip("All patterns as numbered pictures and as a film, to be shown by another program and "
                          "photographed by hand; the order is written beside them");
    connect(patterns_, &QPushButton::clicked, this, [this] { askToWritePatterns(parts_); });
    column.addWidget(patterns_);
    camera_ = new QComboBox(this);
    camera_->setObjectName("calibrate.camera");
    cameraRow_ = makeRow("C&amera", camera_, this);
    connect(camera_, &QComboBox::activated, this, [this] {
        edit([this](CalibrationSetup& setup) { setup.camera = camera_->currentData().toString().toStdString(); });
    });
    column.addWidget(cameraRow_);
    address_ = new QLineEdit(this);
    address_->setObjectName("calibrate.camera.address");
    address_->setAccessibleName("Address of a camera");
    address_->setPlaceholderText("http://192.168.0.7:8080/video");
    address_->setToolTip(
        "A telephone or network camera that sends MJPEG over HTTP, with user:password@ before its host "
        "where it asks for that");
    connect(address_, &QLineEdit::editingFinished, this, [this] {
        const std::string address = address_->text().trimmed().toStdString();
        if (address.empty() || address == parts_.service.state().setup.camera) return;
        edit([&](CalibrationSetup& setup) { setup.camera = address; });
    });
    addressRow_ = makeRow("or its add&ress", address_, this);
    column.addWidget(addressRow_);
    search_ = new QPushButton("Search the network", this);
    search_->setObjectName("calibrate.camera.search");
    search_->setToolTip("For industrial cameras: GigE Vision in this machine's networks, USB3 Vision");
    connect(search_, &QPushButton::clicked, this, [this] { searchCameras(); });
    column.addWidget(search_);
    saved_ = new QPushButton(this);
    saved_->setObjectName("calibrate.saved.folder");
    saved_->setAccessibleName("Folder in which poses are saved");
    savedRow_ = makeRow("&Save poses in", saved_, this);
    connect(saved_, &QPushButton::clicked, this, [this] { askForSaved(parts_); });
    column.addWidget(savedRow_);
    fault_ = new QComboBox(this);
    fault_->setObjectName("calibrate.fault");
    fault_->setToolTip("To see what the studio says when something goes wrong");
    fault_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
    fault_->setMinimumContentsLength(8);
    fault_->view()->setMinimumWidth(kListWidth);
    fault_->addItem("Nothing", -1);
    for (const Cause fault : labFaults())
        fault_->addItem(wordsOf(Finding{fault, {}, {}, {}, {}}).title, static_cast<int>(fault));
    faultRow_ = makeRow("&Goes wrong", fault_, this);
    connect(fault_, &QComboBox::activated, this, [this] {
        edit([this](CalibrationSetup& setup) {
            const int cause = fault_->currentData().toInt();
            setup.fault = cause < 0 ? std::nullopt : std::optional(static_cast<Cause>(cause));
        });
    });
    column.addWidget(faultRow_);
}

void SetupForm::addBoard(QVBoxLayout& column) {
    column.addWidget(makeHeading("Board", this));
    drawing_ = new BoardDrawing(this);
    column.addWidget(drawing_);
    kind_ = new QComboBox(this);
    kind_->setObjectName("calibrate.board.kind");
    kind_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
    kind_->setMinimumContentsLength(8);
    kind_->view()->setMinimumWidth(kListWidth);
    kind_->addItems({"Chessboard", "Circles, every second row shifted", "ChArUco (chessboard with markers)"});
    column.addWidget(makeRow("&Kind", kind_, this));
    connect(kind_, &QComboBox::activated, this, [this](int kind) {
        edit([kind](CalibrationSetup& setup) {
            setup.board.kind = static_cast<CalibrationBoard::Kind>(kind);
            const bool markers = setup.board.kind == CalibrationBoard::Kind::charuco;
            setup.board.marker = markers ? 0.75 * setup.board.spacing : 0.0;
            setup.board.dictionary.clear();
            setup.board.isOldLayout = false;
        });
    });
    columns_ = addNumber("calibrate.board.columns", Quantity::level, 2, 50, 9);
    rows_ = addNumber("calibrate.board.rows", Quantity::level, 2, 50, 7);
    QWidget* count = makeRow("Inner corners", pairOf(columns_, "×", rows_, this), this);
    countName_ = nameOfRow(count);
    columns_->setAccessibleName("Columns of the board");
    rows_->setAccessibleName("Rows of the board");
    column.addWidget(count);
    spacing_ = addNumber("calibrate.board.spacing", Quantity::plain, 0.1, 2000.0, 25.0);
    QWidget* spacing = makeRow("Side of a square, mm", spacing_, this);
    spacingName_ = nameOfRow(spacing);
    column.addWidget(spacing);
    marker_ = addNumber("calibrate.board.marker", Quantity::plain, 0.1, 2000.0, 20.0);
    markerRow_ = makeRow("Side of a marker, mm", marker_, this);
    column.addWidget(markerRow_);
    dictionary_ = new QComboBox(this);
    dictionary_->setObjectName("calibrate.board.dictionary");
    dictionary_->setToolTip("Which markers the board has; the studio finds it out by itself, which takes longer");
    dictionary_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
    dictionary_->setMinimumContentsLength(8);
    dictionary_->addItem("Found by itself", QString());
    for (const std::string& name : markerDictionaries())
        dictionary_->addItem(QString::fromStdString(name), QString::fromStdString(name));
    dictionaryRow_ = makeRow("&Markers", dictionary_, this);
    column.addWidget(dictionaryRow_);
    auto* print = new QPushButton("Board to print...", this);
    print->setObjectName("calibrate.board.print");
    print->setToolTip("A page as PDF, at true size, with a line to check the print by. Glue it to glass or a stiff "
                      "panel, and measure it: printers stretch");
    connect(print, &QPushButton::clicked, this, [this] { askToPrintBoard(parts_); });
    column.addWidget(print);
    connect(dictionary_, &QComboBox::activated, this, [this] {
        edit([this](CalibrationSetup& setup) {
            setup.board.dictionary = dictionary_->currentData().toString().toStdString();
        });
    });
    const auto whole = [](double value) { return static_cast<int>(std::lround(value)); };
    connect(columns_, &ValueField::committed, this, [this, whole](double value) {
        edit([&](CalibrationSetup& setup) { setup.board.columns = whole(value); });
    });
    connect(rows_, &ValueField::committed, this,
            [this, whole](double value) { edit([&](CalibrationSetup& setup) { setup.board.rows = whole(value); }); });
    connect(spacing_, &ValueField::committed, this,
            [this](double millimetres) { edit([&](CalibrationSetup& setup) { setup.board.spacing = millimetres; }); });
    connect(marker_, &ValueField::committed, this,
            [this](double millimetres) { edit([&](CalibrationSetup& setup) { setup.board.marker = millimetres; }); });
}

void SetupForm::addPatterns(QVBoxLayout& column) {
    column.addWidget(makeHeading("Projector", this));
    width_ = addNumber("calibrate.projector.width", Quantity::level, 16, 8192, 1280);
    height_ = addNumber("calibrate.projector.height", Quantity::level, 16, 8192, 800);
    width_->setAccessibleName("Width of the projector's picture in pixels");
    height_->setAccessibleName("Height of the projector's picture in pixels");
    projectorRow_ = makeRow("Pixels", pairOf(width_, "×", height_, this), this);
    column.addWidget(projectorRow_);
    connect(width_, &ValueField::committed, this, [this](double value) {
        edit([&](CalibrationSetup& setup) { setup.projector.width = static_cast<int>(std::lround(value)); });
    });
    connect(height_, &ValueField::committed, this, [this](double value) {
        edit([&](CalibrationSetup& setup) { setup.projector.height = static_cast<int>(std::lround(value)); });
    });
    pattern_ = new QComboBox(this);
    pattern_->setObjectName("calibrate.pattern");
    for (const PatternChoice& choice : kPatterns) {
        pattern_->addItem(choice.words, QString(choice.text));
        pattern_->setItemData(pattern_->count() - 1, choice.hint, Qt::ToolTipRole);
    }
    column.addWidget(makeRow("Pa&tterns", pattern_, this));
    connect(pattern_, &QComboBox::activated, this, [this] {
        const QString chosen = pattern_->currentData().toString();
        if (chosen == kOrderFile) {
            askForOrder(parts_);
            return refresh(); // until a file is chosen, what was chosen before holds
        }
        edit([&chosen](CalibrationSetup& setup) {
            setup.pattern = chosen.toStdString();
            setup.order.clear();
        });
    });
    poses_ = addNumber("calibrate.poses", Quantity::level, kFewestPoses, 30, 6);
    poses_->setToolTip("How many poses of the board are wanted; six are good");
    posesRow_ = makeRow("Poses wanted", poses_, this);
    column.addWidget(posesRow_);
    connect(poses_, &ValueField::committed, this, [this](double value) {
        edit([&](CalibrationSetup& setup) { setup.poses = static_cast<int>(std::lround(value)); });
    });
}

/// Of the room; one that is alone needs no choice.
void SetupForm::listProjectors() {
    const auto& projectors = parts_.studio.document.state().installation->projectors;
    const QSignalBlocker quiet(installed_);
    installed_->clear();
    for (std::size_t i = 0; i < projectors.size(); ++i)
        installed_->addItem(QString("%1  %2").arg(i + 1).arg(QString::fromStdString(projectors[i].name)));
    installed_->setCurrentIndex(static_cast<int>(parts_.service.projector()));
    installedRow_->setVisible(projectors.size() > 1);
}

/// Those of this machine, with their pixels.
void SetupForm::listScreens() {
    const QSignalBlocker quiet(screen_);
    const QString chosen = parts_.studio.outputs.screenOf(parts_.service.projector());
    screen_->clear();
    screen_->addItem("Choose a screen", QString());
    for (const QScreen* screen : QGuiApplication::screens()) {
        const QSize pixels = ProjectorOutputs::pixelsOf(*screen);
        screen_->addItem(QString("%1, %2 × %3").arg(screen->name()).arg(pixels.width()).arg(pixels.height()),
                         screen->name());
    }
    screen_->setCurrentIndex(chosen.isEmpty() ? 0 : std::max(0, screen_->findData(chosen)));
}

/// Where images were taken before, a file can say what each shows.
void SetupForm::listPatterns() {
    const CalibrationSetup& setup = parts_.service.state().setup;
    const int own = static_cast<int>(std::size(kPatterns));
    const QSignalBlocker quiet(pattern_);
    while (pattern_->count() > own) pattern_->removeItem(own);
    if (setup.way == CaptureWay::folder) {
        pattern_->addItem(setup.order.empty() ? "From an order file..."
                                              : "Order: " + QString::fromStdString(setup.order.filename().string()),
                          QString(kOrderFile));
        pattern_->setItemData(own, "A text file with one line for each image: what it shows", Qt::ToolTipRole);
    }
    const int chosen = setup.order.empty() ? pattern_->findData(QString::fromStdString(setup.pattern)) : own;
    pattern_->setCurrentIndex(std::max(0, chosen));
}

/// Those that the machine has now.
void SetupForm::listCameras() {
    const QSignalBlocker quiet(camera_);
    const QString chosen = QString::fromStdString(parts_.service.state().setup.camera);
    camera_->clear();
    std::vector<CameraInfo> found = lumorph::listCameras();
    found.insert(found.end(), networkCameras_.begin(), networkCameras_.end());
    const bool isListed =
        std::ranges::any_of(found, [&](const CameraInfo& info) { return QString::fromStdString(info.path) == chosen; });
    if (!chosen.isEmpty() && !isListed) found.push_back({chosen.toStdString(), {}});
    camera_->addItem(found.empty() ? "None connected" : "Choose a camera", QString());
    for (const CameraInfo& info : found) {
        const QString path = QString::fromStdString(info.path);
        camera_->addItem(info.name.empty() ? path : QString::fromStdString(info.name), path);
        camera_->setItemData(camera_->count() - 1, path, Qt::ToolTipRole);
    }
    camera_->setCurrentIndex(std::max(0, camera_->findData(chosen)));
    if (!address_->hasFocus()) address_->setText(isMjpegAddress(chosen.toStdString()) ? chosen : QString());
}

void SetupForm::searchCameras() {
    search_->setEnabled(false);
    search_->setText("Searching...");
    parts_.studio.jobs.run<std::vector<CameraInfo>>(
        "calibrate", "Looking for cameras", [](const Progress&) { return listGenicamCameras(); },
        [form = QPointer(this)](const std::vector<CameraInfo>& found) {
            if (!form) return;
            form->networkCameras_ = found;
            form->search_->setEnabled(true);
            form->search_->setText(found.empty() ? "No industrial camera answers; search again" : "Search again");
            form->listCameras();
        },
        [form = QPointer(this)](const std::exception&) {
            if (!form) return;
            form->search_->setEnabled(true);
            form->search_->setText("Search again");
        });
}

void SetupForm::refresh() {
    const CalibrationState& state = parts_.service.state();
    const CalibrationSetup& setup = state.setup;
    const bool lab = setup.way == CaptureWay::lab;
    const bool folder = setup.way == CaptureWay::folder;
    const bool byHand = setup.way == CaptureWay::crosshairs;
    way_->setChosen(static_cast<int>(setup.way));
    rest_->setVisible(!byHand);
    wayWords_->setText(lab ? "A simulated projector, camera and board. It tells at the end how near the result is to "
                             "the truth."
                       : byHand ? "You lay the projector\'s crosshair onto points of the device. Flaps stand raised, "
                                  "so that the points differ in height."
                       : folder ? "One folder for each pose of the board, each with the photographs of all patterns. "
                                  "What comes later is read by itself."
                                : "The patterns are shown in the projector's output window; the camera looks at them.");
    folder_->setVisible(folder);
    patterns_->setVisible(folder);
    folder_->setText(setup.folder.empty() ? "Choose a folder..."
                                          : QString::fromStdString(setup.folder.filename().string()));
    for (QWidget* part : {cameraRow_, addressRow_, static_cast<QWidget*>(search_)})
        part->setVisible(setup.way == CaptureWay::camera);
    if (setup.way == CaptureWay::camera && !camera_->view()->isVisible()) listCameras();
    savedRow_->setVisible(isLive(setup.way));
    saved_->setText(QString::fromStdString(setup.saved.filename().string()));
    saved_->setToolTip(QString::fromStdString(setup.saved.string()) +
                       "\nEach calibration gets a dated folder in it, with one folder for each pose");
    faultRow_->setVisible(lab && fault_->count() > 1);
    fault_->setCurrentIndex(std::max(0, fault_->findData(setup.fault ? static_cast<int>(*setup.fault) : -1)));
    drawing_->show(setup.board);
    const bool chess = setup.board.kind == CalibrationBoard::Kind::chess;
    const bool circles = setup.board.kind == CalibrationBoard::Kind::circles;
    kind_->setCurrentIndex(static_cast<int>(setup.board.kind));
    countName_->setText(chess ? "Inner corners" : circles ? "In a row × rows" : "Squares");
    spacingName_->setText(circles ? "Half a gap in a row, mm" : "Side of a square, mm");
    columns_->setValue(setup.board.columns);
    rows_->setValue(setup.board.rows);
    spacing_->setValue(setup.board.spacing);
    marker_->setValue(setup.board.marker);
    const bool hasMarkers = setup.board.kind == CalibrationBoard::Kind::charuco;
    markerRow_->setVisible(hasMarkers);
    dictionaryRow_->setVisible(hasMarkers);
    dictionary_->setCurrentIndex(std::max(0, dictionary_->findData(QString::fromStdString(setup.board.dictionary))));
    projectorRow_->setVisible(folder);
    width_->setValue(setup.projector.width);
    height_->setValue(setup.projector.height);
    if (!pattern_->view()->isVisible()) listPatterns();
    if (!installed_->view()->isVisible()) listProjectors();
    screenRow_->setVisible(setup.way == CaptureWay::camera || byHand);
    if (!screen_->view()->isVisible()) listScreens();
    posesRow_->setVisible(!folder);
    poses_->setValue(setup.poses);
    setEnabled(state.work == CalibrationState::Work::none);
}

} // namespace lumorph::studio
