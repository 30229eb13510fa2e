#include <filesystem>
#include <fstream>
#include <memory>
#include <random>

#include <QAction>
#include <QCheckBox>
#include <QComboBox>
#include <QJsonArray>
#include <QJsonDocument>
#include <QJsonObject>
#include <QLabel>
#include <QListWidget>
#include <QProcess>

#include "app/studio/calibration/capture_bench.h"
#include "app/studio/calibration/pose_pictures.h"
#include "app/studio/document/scene_edit.h"
#include "app/workspaces/calibrate/capture_picture.h"
#include "calibration/lab/board_lab.h"
#include "calibration/lab/lab_capture.h"
#include "calibration/report/calibration_file.h"
#include "tests/ui/file_dialog.h"

// A projector is calibrated in the window by the mouse alone: in the lab, and from a folder of images with a fault.

namespace lumorph::test {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr glm::ivec2 kSmall{480, 270}; // pixels of the projector, so that a capture takes seconds
constexpr auto kBoard = "chess:9x7:25";

Installation smallRoom() {
    Installation room = defaultInstallation();
    room.projectors.front().camera = withSize(room.projectors.front().camera, kSmall);
    return room;
}

std::vector<fs::path> entriesOf(const fs::path& folder) {
    return {fs::directory_iterator(folder), fs::directory_iterator()};
}

/// What `lumorph calibrate procam` makes of a folder of poses.
QJsonObject solvedByCommandLine(const fs::path& folder) {
    QProcess program;
    program.start(LUMORPH_BIN_DIR "/lumorph", {"calibrate", "procam", QString::fromStdString(folder), "--board", kBoard,
                                               "--projector", QString("%1x%2").arg(kSmall.x).arg(kSmall.y), "--json"});
    EXPECT_TRUE(program.waitForFinished(60'000));
    EXPECT_EQ(program.exitCode(), 0) << program.readAllStandardError().toStdString();
    return QJsonDocument::fromJson(program.readAllStandardOutput()).object();
}

void forgetCalibrations() {
    const studio::Settings settings;
    fs::remove_all(settings.folder() / "installation");
}

/// One start of the window for the whole file.
struct Window {
    [[nodiscard]] QString title() { return studio.text("calibrate.card.title"); }
    [[nodiscard]] QString button() {
        const auto* next = studio.findNow<QAbstractButton>("calibrate.card.next");
        return next ? next->text() : QString();
    }
    [[nodiscard]] bool offers(const QString& words, std::chrono::milliseconds time = 180s) {
        return eventually([&] { return button().startsWith(words); }, time);
    }
    void next() {
        pass(std::chrono::milliseconds(QApplication::doubleClickInterval() + 50)); // two steps, no double click
        studio.click("calibrate.card.next");
    }
    [[nodiscard]] QString step(const QString& id) { return studio.text("calibrate.step." + id + ".how"); }
    [[nodiscard]] const InstalledProjector& projector() const {
        return studio.state().installation->projectors.front();
    }
    [[nodiscard]] std::size_t notices() { return studio.studio().notices.at("calibrate").size(); }
    /// The result, as it is exported.
    [[nodiscard]] CalibrationRecord written() {
        const fs::path file = folder / "written.json";
        fs::remove(file);
        studio.studio().commands.find("calibrate.export")->trigger();
        answerFileDialog(studio, "calibrate.export.file", file);
        EXPECT_TRUE(eventually([&] { return fs::exists(file); }, 10s));
        return readCalibration(file);
    }
    [[nodiscard]] std::string story() {
        return (title() + " [" + button() + "] " + studio.text("calibrate.card.text")).toStdString();
    }

    TemporaryFolder folder;
    struct Forgotten {
        explicit Forgotten(const fs::path& folder) {
            forgetCalibrations();
            studio::Settings settings; // before the window reads them
            for (const char* key : {"calibrate/way", "calibrate/lab/board", "calibrate/folder/folder"})
                settings.remove(key);
            settings.setValue("calibrate/lab/poses", 4);
            std::ofstream(folder / "file") << "no folder";
            settings.setValue("calibrate/saved", QString::fromStdString(folder / "file" / "poses"));
        }
        ~Forgotten() { forgetCalibrations(); }
    } forgotten_{folder.path()};
    mutable StudioWindow studio{folder / "session", "scene"};
};

class Calibrate : public ::testing::Test {
protected:
    static void SetUpTestSuite() {
        window = std::make_unique<Window>();
        studio::editInstallation(window->studio.studio().document, "Set up",
                                 [](Installation& room) { room = smallRoom(); });
        window->studio.window().showWorkspace("calibrate");
    }
    static void TearDownTestSuite() { window.reset(); }

    static std::unique_ptr<Window> window;
};

std::unique_ptr<Window> Calibrate::window;

TEST_F(Calibrate, TheLabLeadsFromNothingToAProjectorThatTheSceneUses) {
    Window& w = *window;
    ASSERT_TRUE(w.offers("Photograph pose 1 of 4"));
    EXPECT_EQ(w.step("poses"), "Needs you");
    EXPECT_EQ(w.step("projector"), "Not begun");
    w.studio.screenshot("calibrate-begin");
    w.next();
    ASSERT_TRUE(w.offers("Photograph pose 2 of 4")) << w.story();
    // Where poses are to be saved is a file. That is told, and spoils nothing.
    EXPECT_EQ(w.studio.text("calibrate.saved"), "not saved yet: 1");
    EXPECT_EQ(w.notices(), 1U);
    fs::create_directory(w.folder / "poses");
    w.studio.click("calibrate.saved.folder");
    answerFileDialog(w.studio, "calibrate.saved.file", w.folder / "poses", "Choose");
    ASSERT_TRUE(eventually([&] { return w.studio.text("calibrate.saved").startsWith("Saved in "); }, 60s));
    EXPECT_EQ(w.notices(), 0U);
    EXPECT_TRUE(w.offers("Photograph pose 2 of 4")) << "another folder is no other calibration: " << w.story();
    w.studio.click("calibrate.rest");
    ASSERT_TRUE(w.offers("Use this calibration")) << w.story();
    for (const char* step : {"setup", "poses", "camera", "projector"}) EXPECT_EQ(w.step(step), "Good") << step;
    w.studio.screenshot("calibrate-good");
    EXPECT_EQ(w.notices(), 0U);
    // One more pose: where it should be is seen, and the result stays until there is a better one.
    const QString headline = w.studio.text("calibrate.headline");
    EXPECT_TRUE(headline.endsWith(" mm"));
    EXPECT_TRUE(eventually(
        [&] { return w.studio.find<studio::CapturePicture>("calibrate.picture")->marks().ghost.size() == 4; }));
    w.studio.screenshot("calibrate-another");
    w.studio.click("calibrate.another");
    ASSERT_TRUE(w.offers("Cancel", 5s)) << w.story();
    EXPECT_EQ(w.studio.text("calibrate.headline"), headline);
    w.next();
    ASSERT_TRUE(w.offers("Use this calibration", 5s)) << w.story();
    EXPECT_EQ(w.studio.text("calibrate.headline"), headline);
    const std::vector<fs::path> dated = entriesOf(w.folder / "poses");
    ASSERT_EQ(dated.size(), 1U);
    EXPECT_EQ(entriesOf(dated.front()).size(), 5U) << "four poses, and the mark of the lab";
    const QJsonObject again = solvedByCommandLine(dated.front());
    // What the lab truly is, from a lab of its own.
    const CalibratedCamera truth = studio::openLabBench({}, smallRoom())->truth()->projectors.front().camera;
    const auto away = [&] { return glm::length(positionOf(w.projector().camera) - positionOf(truth)); };
    const double before = away();
    EXPECT_GT(before, 0.03); // metres: the room has it wrong
    w.next();
    // The room was entered by hand: what the lab made joins it only when that is meant.
    ASSERT_TRUE(w.offers("Use it as simulated")) << w.story();
    EXPECT_EQ(w.title(), "This room holds what was measured or entered");
    EXPECT_NE(w.projector().lens.way, Origin::Way::simulated);
    w.studio.screenshot("calibrate-asks");
    w.next();
    ASSERT_TRUE(eventually([&] { return w.projector().lens.way == Origin::Way::simulated; })) << w.story();
    EXPECT_TRUE(again["simulated"].toBool());
    EXPECT_TRUE(w.studio.studio().room.versions().front().version.isSimulated);
    EXPECT_LT(away(), 0.008);
    EXPECT_NEAR(w.projector().camera.focal.x, truth.focal.x, 0.01 * truth.focal.x);
    // The command line finds the same in what was saved.
    EXPECT_NEAR(again["projector"]["K"][0][0].toDouble(), w.projector().camera.focal.x, 1e-4);
    // On the table, where it counts: a place 10 cm aside gets the light that is meant for it.
    for (const glm::dvec3 place : {glm::dvec3(0.0), glm::dvec3(0.1, 0.0, 0.0), glm::dvec3(-0.05, 0.0, 0.08)}) {
        const auto believed = pixelOf(w.projector().camera, place);
        const auto trueAt = pixelOf(truth, place);
        ASSERT_TRUE(believed && trueAt);
        EXPECT_LT(glm::length(*believed - *trueAt), 1.5) << place.x; // a pixel is a millimetre here
    }
    EXPECT_EQ(w.step("room"), "Good");
    EXPECT_EQ(w.button(), "Go on with the chain") << "nothing is left to do here";
    // Kept, beside what stood there before.
    EXPECT_EQ(w.studio.studio().room.versions().size(), 2U);
    w.studio.studio().document.undoStack().undo();
    EXPECT_NEAR(away(), before, 1e-9);
    EXPECT_TRUE(w.offers("Use this calibration"));
    w.studio.studio().document.undoStack().redo();
    EXPECT_LT(away(), 0.008);
}

TEST_F(Calibrate, AFolderWithAFaultIsRefusedByCausePlaceAndRemedy) {
    Window& w = *window;
    LabCapture capture;
    capture.room = smallRoom();
    capture.board = kBoard;
    capture.poses = 5;
    capture.seed = 8;
    capture.fault = Cause::rigMoved; // it stays moved: in the last pose, so that the others are of one place
    LabCapturer capturer(capture);
    const fs::path folder = w.folder / "captured";
    writeLabCapture(capturer, folder);
    ASSERT_EQ(capturer.faults().size(), 1U);
    const std::string view = capturer.faults().front().view;
    const fs::path later = folder / "pose_02"; // is photographed while the others are judged
    ASSERT_NE(view, "pose_02");
    fs::rename(later, w.folder / "later");

    w.studio.click("calibrate.way.folder");
    ASSERT_TRUE(w.offers("Choose a folder"));
    w.next();
    answerFileDialog(w.studio, "calibrate.folder.file", folder, "Choose");
    ASSERT_TRUE(w.offers("Read the images")) << w.story();
    w.studio.enter("calibrate.projector.width", QString::number(kSmall.x));
    w.studio.enter("calibrate.projector.height", QString::number(kSmall.y));
    w.next();
    ASSERT_TRUE(w.offers("Leave " + QString::fromStdString(view) + " out")) << w.story();
    EXPECT_EQ(w.title(), "Something moved");
    EXPECT_TRUE(w.studio.text("calibrate.card.text").contains(QString::fromStdString(view))) << w.story();
    EXPECT_EQ(w.step("poses"), "Refused");
    EXPECT_EQ(w.studio.findNow<QLabel>("calibrate.headline"), nullptr) << "a number that cannot be trusted is shown";
    w.studio.screenshot("calibrate-refused");
    w.next(); // the remedy that is offered
    ASSERT_TRUE(w.offers("Use this calibration")) << w.story();
    EXPECT_NE(w.studio.findNow<QLabel>("calibrate.headline"), nullptr);
    w.studio.screenshot("calibrate-mended");
    fs::create_directory(later);
    const std::vector<fs::path> photographs = entriesOf(w.folder / "later");
    for (std::size_t k = 0; k < photographs.size(); ++k) {
        fs::rename(photographs[k], later / photographs[k].filename());
        if (k != 4) continue;
        const QString sofar = QString("pose_02 has 5 of %1 photographs so far").arg(photographs.size());
        ASSERT_TRUE(eventually([&] { return w.studio.text("calibrate.card.text").contains(sofar); }, 60s)) << w.story();
        w.studio.screenshot("calibrate-arriving");
    }
    const auto isListed = [&] { return w.studio.findNow<QListWidget>("calibrate.poses.list")->count() == 5; };
    ASSERT_TRUE(eventually(isListed)) << "what came later is read by itself: " << w.story();
    ASSERT_TRUE(w.offers("Use this calibration")) << w.story();
    EXPECT_FALSE(w.story().find("so far") != std::string::npos) << w.story();

    // From here on what was read is enough: the images may be gone.
    fs::rename(folder, w.folder / "away");
    const auto chosen = [&] { return w.studio.findNow<QListWidget>("calibrate.poses.list")->currentRow(); };
    const auto focal = [&] { return w.studio.text("calibrate.figure.projectorFocal"); };
    const auto distance = [&] {
        const CalibrationRecord record = w.written();
        return cv::norm(cv::Vec3d(&record.result.projectorFromCamera[3]));
    };
    const auto flat = [&] { return w.studio.find<QComboBox>("calibrate.flat")->currentText(); };
    const QString withAll = focal(), first = flat(), headline = w.studio.text("calibrate.headline");
    const double apart = distance();
    auto* list = w.studio.find<QListWidget>("calibrate.poses.list");
    list->setCurrentRow(0);   // by itself the one that lay on the table
    const auto toggle = [&] { // its words end long before its box does
        auto* box = w.studio.find<QCheckBox>("calibrate.leaveOut");
        QTest::mouseClick(box, Qt::LeftButton, Qt::NoModifier, {8, box->height() / 2});
    };
    ASSERT_GE(chosen(), 0);
    toggle();
    ASSERT_TRUE(w.offers("Use this calibration")) << w.story();
    EXPECT_NE(focal(), withAll);
    EXPECT_NE(flat(), first);
    toggle();
    ASSERT_TRUE(w.offers("Use this calibration")) << w.story();
    EXPECT_EQ(focal(), withAll) << "the same poses make the same result";
    EXPECT_EQ(flat(), first);
    EXPECT_EQ(w.studio.text("calibrate.headline"), headline);
    // A square that was measured wrongly: all lengths follow it, and nothing else changes.
    w.studio.enter("calibrate.board.spacing", "50");
    ASSERT_TRUE(w.offers("Use this calibration")) << w.story();
    EXPECT_EQ(focal(), withAll);
    EXPECT_NEAR(distance(), 2.0 * apart, 1e-3 * apart);
    w.studio.enter("calibrate.board.spacing", "25");
    ASSERT_TRUE(w.offers("Use this calibration")) << w.story();
    EXPECT_NEAR(distance(), apart, 1e-3 * apart);
    fs::rename(w.folder / "away", folder);

    // What the images show may be told by a file, which may be wrong.
    const fs::path order = w.folder / "order.txt";
    std::ofstream(order) << "white\ncolumn bit 99\n";
    auto* patterns = w.studio.find<QComboBox>("calibrate.pattern");
    ASSERT_EQ(patterns->count(), 3);
    patterns->setCurrentIndex(2);
    emit patterns->activated(2);
    answerFileDialog(w.studio, "calibrate.order.file", order, "Open");
    ASSERT_TRUE(w.offers("Read the images")) << w.story();
    EXPECT_EQ(patterns->currentText(), "Order: order.txt");
    w.next();
    ASSERT_TRUE(eventually([&] { return w.title() == "That did not work"; }, 20s)) << w.story();
    EXPECT_TRUE(w.studio.text("calibrate.card.text").contains("line 2")) << w.story();
    patterns->setCurrentIndex(0);
    emit patterns->activated(0);
    EXPECT_TRUE(w.offers("Read the images")) << w.story();
    EXPECT_EQ(patterns->itemText(2), "From an order file...");

    // A camera photographed them on another day, and nobody used them yet: one goes on with them.
    fs::remove_all(folder / view);
    studio::Settings& settings = w.studio.studio().settings;
    settings.setValue("calibrate/unfinished", QString::fromStdString(folder.string()));
    settings.setValue("calibrate/camera/board", kBoard);
    settings.setValue("calibrate/camera/camera", "");
    w.studio.click("calibrate.way.camera");
    EXPECT_TRUE(w.studio.text("calibrate.earlier").startsWith("4 poses of the board, photographed today, "))
        << w.story();
    w.studio.screenshot("calibrate-earlier");
    w.studio.click("calibrate.goOn");
    ASSERT_TRUE(eventually([&] { return w.studio.findNow<QLabel>("calibrate.headline") != nullptr; }, 60s))
        << w.story();
    EXPECT_EQ(focal(), withAll) << "the same poses make the same result";
    EXPECT_EQ(w.studio.findNow<QListWidget>("calibrate.poses.list")->count(), 4);
    EXPECT_TRUE(w.studio.text("calibrate.saved").contains("captured")) << "what follows is saved beside them";
    EXPECT_EQ(w.studio.findNow<QWidget>("calibrate.goOn"), nullptr);
    w.studio.studio().commands.find("calibrate.anew")->trigger();
    ASSERT_TRUE(eventually([&] { return !w.studio.findNow<QLabel>("calibrate.headline"); }, 10s));
    EXPECT_EQ(w.studio.findNow<QWidget>("calibrate.goOn"), nullptr) << "they were thrown away";
    EXPECT_TRUE(fs::exists(folder)) << "their pictures stay";
}

/// As SLStudio writes it, and beside it a camera alone.
constexpr auto kSlStudio = R"(<?xml version="1.0"?>
<opencv_storage>
<Kc type_id="opencv-matrix"><rows>3</rows><cols>3</cols><dt>d</dt>
<data>1180.5 0. 642.25 0. 1181. 478.75 0. 0. 1.</data></Kc>
<kc type_id="opencv-matrix"><rows>1</rows><cols>5</cols><dt>d</dt><data>-0.31 0.12 0. 0. 0.</data></kc>
<Kp type_id="opencv-matrix"><rows>3</rows><cols>3</cols><dt>d</dt>
<data>1700. 0. 330. 0. 1700. 300. 0. 0. 1.</data></Kp>
<Rp type_id="opencv-matrix"><rows>3</rows><cols>3</cols><dt>d</dt><data>1. 0. 0. 0. 1. 0. 0. 0. 1.</data></Rp>
<Tp type_id="opencv-matrix"><rows>3</rows><cols>1</cols><dt>d</dt><data>-210. 12. 35.</data></Tp>
<frameWidth>1280</frameWidth><frameHeight>960</frameHeight>
</opencv_storage>
)";
constexpr auto kCameraAlone = "image_width: 1280\nimage_height: 960\ndistortion_model: plumb_bob\n"
                              "camera_matrix: [[1180.5, 0, 642.25], [0, 1181, 478.75], [0, 0, 1]]\n"
                              "distortion_coefficients: [-0.31, 0.12, 0, 0, 0]\n";
constexpr auto kFisheye = "image_width: 1280\nimage_height: 960\ndistortion_model: equidistant\n"
                          "K: [1180.5, 0, 642.25, 0, 1181, 478.75, 0, 0, 1]\nD: [-0.01, 0.004, 0.002, -0.001]\n";

TEST_F(Calibrate, ImportedFileEndsWithAButtonThatUsesItAndSaysNoMoreThanTheFile) {
    Window& w = *window;
    const auto importText = [&](const char* name, const char* text) {
        std::ofstream(w.folder / name) << text;
        w.studio.studio().commands.find("calibrate.import")->trigger();
        answerFileDialog(w.studio, "calibrate.import.file", w.folder / name, "Open");
    };
    // Where one photographs in the lab it was the next pose that was offered.
    w.studio.click("calibrate.way.lab");
    const double before = w.projector().camera.focal.x;
    const glm::dvec3 place = positionOf(w.projector().camera);
    importText("calibration.xml", kSlStudio);
    ASSERT_TRUE(w.offers("Use this calibration", 20s)) << w.story();
    EXPECT_EQ(w.title(), "A calibration from a file");
    EXPECT_EQ(w.step("camera"), "Good");
    EXPECT_EQ(w.step("projector"), "Good");
    EXPECT_EQ(w.studio.text("calibrate.headline"), "not known");
    EXPECT_EQ(w.studio.text("calibrate.figure.projectorError"), "unknown");
    EXPECT_EQ(w.studio.text("calibrate.figure.projectorFocal"), "1700.0 px") << "nobody said how sure it is";
    EXPECT_EQ(w.studio.findNow<QWidget>("calibrate.residuals"), nullptr) << "no points, no arrows";
    EXPECT_FALSE(w.studio.text("calibrate.step.projector.words").contains("±"));
    w.studio.screenshot("calibrate-imported");
    w.next();
    ASSERT_TRUE(eventually([&] { return w.projector().camera.focal.x == 1700.0; }, 10s)) << w.story();
    EXPECT_EQ(w.title(), "Calibrated, and in use");
    EXPECT_EQ(w.projector().lens.method, "read from a file");
    EXPECT_LT(glm::length(positionOf(w.projector().camera) - place), 1e-12) << "the file says nothing of the room";
    // What the room has decides, not a date.
    w.studio.studio().document.undoStack().undo();
    EXPECT_TRUE(w.offers("Use this calibration", 10s)) << w.story();
    EXPECT_EQ(w.projector().camera.focal.x, before);
    importText("again.xml", kSlStudio);
    w.studio.studio().document.undoStack().redo();
    EXPECT_TRUE(eventually([&] { return w.title() == "Calibrated, and in use"; }, 10s)) << w.story();
    w.studio.studio().document.undoStack().undo();

    // Names have one ending, and a dialog begins where the one before ended.
    w.studio.studio().commands.find("calibrate.export")->trigger();
    auto* dialog = w.studio.find<QFileDialog>("calibrate.export.file");
    EXPECT_EQ(dialog->directory().absolutePath().toStdString(), w.folder.path().string());
    EXPECT_EQ(dialog->selectedFiles().value(0).toStdString(), (w.folder / "calibration.json").string());
    dialog->selectNameFilter(dialog->nameFilters().back());
    emit dialog->filterSelected(dialog->nameFilters().back());
    EXPECT_EQ(dialog->selectedFiles().value(0).toStdString(), (w.folder / "calibration.yaml").string());
    dialog->reject();

    importText("fisheye.yaml", kFisheye);
    ASSERT_TRUE(eventually([&] { return w.notices() == 1; }, 10s));
    const studio::Notice notice = w.studio.studio().notices.at("calibrate").front();
    EXPECT_TRUE(notice.subject.contains("fisheye.yaml, line 3")) << notice.subject.toStdString();
    EXPECT_TRUE(notice.why.contains("equidistant")) << notice.why.toStdString();
    EXPECT_EQ(w.title(), "A calibration from a file") << "the result before stays";

    importText("camera.yaml", kCameraAlone);
    ASSERT_TRUE(eventually([&] { return w.step("projector") == "Not begun"; }, 10s)) << w.story();
    EXPECT_EQ(w.notices(), 0U) << "the error of the file before is gone";
    EXPECT_EQ(w.studio.text("calibrate.step.projector.words"), "Not in this file");
    EXPECT_EQ(w.studio.findNow<QLabel>("calibrate.figure.projectorFocal"), nullptr);
    w.studio.screenshot("calibrate-imported-camera");
    ASSERT_TRUE(w.offers("Use this calibration", 10s)) << w.story();
    w.next();
    ASSERT_TRUE(eventually([&] { return w.title() == "Calibrated, and in use"; }, 10s)) << w.story();
    EXPECT_EQ(w.projector().camera.focal.x, before) << "a camera moves no projector";
    EXPECT_EQ(w.studio.state().installation->cameras.front().camera.focal.x, 1180.5);
    w.studio.studio().document.undoStack().undo();
    w.studio.studio().commands.find("calibrate.anew")->trigger();
    EXPECT_TRUE(w.offers("Photograph pose 1", 30s)) << w.story();
}

TEST(CalibrationQuestion, WhatMayBeSoIsAskedAndUsedWithAYes) {
    studio::CalibrationState state;
    state.setup.way = studio::CaptureWay::folder;
    state.setup.folder = "/captures";
    const auto asked = [&](const std::optional<Finding>& doubt) {
        auto result = std::make_shared<studio::CalibrationResult>();
        result->solved.projector.size = {1023, 768};
        if (doubt) result->solved.warnings.push_back(*doubt);
        state.result = std::move(result);
        return studio::nextOf(state);
    };
    EXPECT_EQ(asked(std::nullopt).button, "Use this calibration");
    const Finding size{Cause::projectorSize, "", "", "1023 x 768 is no usual size", "check the size"};
    EXPECT_EQ(asked(size).title, "Has the projector 1023 × 768 pixels?");
    EXPECT_EQ(asked(size).what, studio::NextStep::Do::use);
    EXPECT_EQ(asked(size).button, "Yes, use this calibration");
    EXPECT_TRUE(asked(size).text.contains("1023 x 768 is no usual size"));
    const Finding length{Cause::unlikelyLength, "", "", "points of the board are 0.001 mm apart", "give millimetres"};
    EXPECT_EQ(asked(length).title, "Are these lengths right?");
    const Finding turned{Cause::phaseOrder, "", "", "the projector would hang upside down", "check the steps' order"};
    EXPECT_EQ(asked(turned).title, "Does the projector hang upside down?");
    EXPECT_EQ(studio::wordsOfDoubt(size).title, "Is the projector's size right?") << "it is not stated";
    EXPECT_EQ(studio::wordsOf(size).title, "The projector has another size") << "of a refusal it is";
}

TEST(CalibrationPoses, AreSolvedAgainWhereTheResultLacksOneAndTheFreeNumberIsTaken) {
    studio::CalibrationState state;
    state.setup.poses = 4;
    auto result = std::make_shared<studio::CalibrationResult>();
    const auto seen = std::make_shared<const ViewObservations>();
    for (int k = 0; k < 4; ++k) {
        state.poses.push_back({studio::nameOfPose(k), nullptr, seen, {}, {}});
        result->solved.views.emplace_back().name = studio::nameOfPose(k);
    }
    state.result = result;
    EXPECT_EQ(studio::nextOf(state).what, studio::NextStep::Do::use);
    EXPECT_EQ(studio::freeNumber(state), 4);
    state.poses.push_back({studio::nameOfPose(4), nullptr, seen, {}, {}}); // and solving it was cancelled
    EXPECT_EQ(studio::nextOf(state).what, studio::NextStep::Do::solve);
    // One that all others contradict is taken again, and no other is replaced.
    state.refusal = Finding{Cause::cameraMoved, "pose_3", "", "it moved", "take it again"};
    EXPECT_EQ(studio::nextOf(state).what, studio::NextStep::Do::photographAgain);
    EXPECT_EQ(studio::freeNumber(state), 2);
    // Of a folder that was not read to its end.
    state.refusal.reset();
    state.result = nullptr;
    state.setup.way = studio::CaptureWay::folder;
    state.setup.folder = "/captures";
    EXPECT_EQ(studio::nextOf(state).what, studio::NextStep::Do::read);
    state.isReadWhole = true;
    EXPECT_EQ(studio::nextOf(state).what, studio::NextStep::Do::solve);
}

TEST(BoardGuide, LiesInWhatTheProjectorLights) {
    for (const char* text : {kBoard, "chess:6x9:30", "circles:4x11:20"})
        for (const cv::Rect lit : {cv::Rect(0, 0, 1280, 1024), cv::Rect(500, 300, 400, 250), cv::Rect(20, 40, 300, 900),
                                   cv::Rect(100, 700, 1100, 200)})
            for (int pose = 0; pose < 9; ++pose)
                for (const cv::Point2d& corner : studio::guideOutline(parseCalibrationBoard(text), lit, 1600.0, pose)) {
                    EXPECT_GE(corner.x, lit.x - 1e-6) << text << ", " << pose << ", " << lit;
                    EXPECT_GE(corner.y, lit.y - 1e-6) << text << ", " << pose << ", " << lit;
                    EXPECT_LE(corner.x, lit.x + lit.width + 1e-6) << text << ", " << pose << ", " << lit;
                    EXPECT_LE(corner.y, lit.y + lit.height + 1e-6) << text << ", " << pose << ", " << lit;
                }
}

TEST(PosePictures, KnowWhereLightWasSeenButForStrayPixels) {
    DecodedView decoded;
    const cv::Size size(400, 300);
    for (cv::Mat1f* map : {&decoded.column, &decoded.row, &decoded.confidence}) *map = cv::Mat1f(size, 0.0F);
    decoded.white = cv::Mat1b(size, uchar(90));
    const cv::Rect light(120, 60, 200, 150);
    decoded.confidence(light) = 0.8F;
    std::mt19937 dice(11);
    for (int i = 0; i < 200; ++i)
        decoded.confidence(static_cast<int>(dice() % 300U), static_cast<int>(dice() % 400U)) = 0.3F;
    const cv::Rect seen = studio::picturesOf(decoded, {1280, 800}).lit;
    EXPECT_GT((seen & light).area(), 0.9 * light.area());
    EXPECT_LT((seen | light).area(), 1.05 * light.area());
    decoded.confidence = 0.0F;
    EXPECT_TRUE(studio::picturesOf(decoded, {1280, 800}).lit.empty());
}

} // namespace
} // namespace lumorph::test
