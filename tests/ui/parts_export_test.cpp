#include <fstream>
#include <map>
#include <sstream>

#include <QComboBox>
#include <QProcess>
#include <QTableWidget>
#include <gtest/gtest.h>

#include "app/studio/document/rig_edit.h"
#include "core/rig/rig_file.h"
#include "core/rig/templates/bundled_rigs.h"
#include "core/rig/templates/rig_templates.h"
#include "tests/support/small_rigs.h"
#include "tests/ui/file_dialog.h"
#include "tests/ui/studio_window.h"

namespace lumorph::studio {
namespace {

using test::eventually;
namespace fs = std::filesystem;

std::string contentOf(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

std::map<std::string, std::string> filesIn(const fs::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_regular_file()) files[fs::relative(entry.path(), folder).string()] = contentOf(entry.path());
    return files;
}

/// The rows of a table, without its heading; no field of these holds a comma.
std::vector<std::vector<std::string>> literalRows(const fs::path& csv) {
    std::vector<std::vector<std::string>> rows;
    std::ifstream stream(csv);
    for (std::string line; std::getline(stream, line);) {
        rows.emplace_back();
        std::istringstream cells(line);
        for (std::string cell; std::getline(cells, cell, ',');) {
            while (!cell.empty() && cell.back() == '\r') cell.pop_back();
            rows.back().push_back(cell);
        }
    }
    if (!rows.empty()) rows.erase(rows.begin());
    return rows;
}

/// One window for all, because each starts a studio.
struct PartsExport : testing::Test {
    static void SetUpTestSuite() {
        folder = std::make_unique<TemporaryFolder>();
        window = std::make_unique<test::StudioWindow>(*folder / "session", "rig");
    }
    static void TearDownTestSuite() {
        window.reset();
        folder.reset();
    }

    void SetUp() override {
        window->studio().settings.remove("parts/servo");
        window->studio().settings.remove("parts/bed");
        window->studio().settings.remove("parts/tolerance");
    }
    static void open() {
        window->command("Export parts to build");
        ASSERT_NE(window->find<QWidget>("export.parts.dialog"), nullptr);
    }
    static bool planned() {
        return eventually([] { return window->find<QPushButton>("export.parts.accept")->isEnabled(); },
                          std::chrono::seconds(30));
    }
    static void take(const Rig& rig) {
        window->studio().project.takeRig(std::make_shared<const Rig>(rig), "another");
        ASSERT_TRUE(eventually(
            [&] {
                const auto& now = window->state().rig.rig;
                return now && now->parts() == rig.parts();
            },
            std::chrono::seconds(30)));
    }
    static Notice told() {
        for (const Notice& notice : window->studio().notices.at("rig"))
            if (notice.subject.startsWith("Parts of")) return notice;
        return {};
    }
    static std::vector<std::string> tableOf() {
        std::vector<std::string> parts;
        const auto* table = window->find<QTableWidget>("export.parts.table");
        for (int row = 0; row < table->rowCount(); ++row)
            parts.push_back(table->item(row, 0)->text().toStdString() + " " +
                            table->item(row, 1)->text().toStdString());
        return parts;
    }

    inline static std::unique_ptr<TemporaryFolder> folder;
    inline static std::unique_ptr<test::StudioWindow> window;
};

TEST_F(PartsExport, WritesWhatTheCommandLineWritesAndDevicesTakesItsWiring) {
    open();
    ASSERT_TRUE(planned());
    EXPECT_EQ(window->text("export.parts.board"), "Arduino Pro Mini; its sketch goes along");
    window->enter("export.parts.bed", "180", Qt::Key_Tab);
    window->enter("export.parts.tolerance", "0.3", Qt::Key_Tab);
    ASSERT_TRUE(planned());
    const std::vector<std::string> seen = tableOf();
    EXPECT_GT(seen.size(), 5U);
    window->screenshot("parts_dialog");
    window->click("export.parts.accept");
    const fs::path chosen = *folder / "chosen";
    fs::create_directory(chosen);
    test::answerFileDialog(*window, "export.parts.file", chosen, "Export here");
    ASSERT_TRUE(eventually([] { return !told().why.isEmpty(); }, std::chrono::seconds(60)));
    const fs::path made = chosen / (window->state().rig.rig->name() + " parts");
    EXPECT_TRUE(told().why.contains(QString::fromStdString(made.string()))) << told().why.toStdString();
    EXPECT_EQ(told().level, Notice::Level::info);
    window->screenshot("parts_written");

    // The same as by the command line.
    const fs::path rig = *folder / "rig.glb";
    const std::vector<std::byte> bytes = writeRigGlb(*window->state().rig.rig);
    std::ofstream(rig, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    const fs::path expected = *folder / "expected";
    QProcess program;
    program.start(QString(LUMORPH_BIN_DIR) + "/lumorph",
                  {"rig", "parts", QString::fromStdString(rig.string()), "--bed", "18cm", "--tolerance", "0.3mm", "-o",
                   QString::fromStdString(expected.string())});
    ASSERT_TRUE(program.waitForFinished(60000));
    ASSERT_EQ(program.exitCode(), 0) << program.readAllStandardError().toStdString();
    const auto written = filesIn(made);
    const auto wanted = filesIn(expected);
    ASSERT_GT(wanted.size(), 10U);
    for (const auto& [name, content] : wanted) {
        ASSERT_TRUE(written.contains(name)) << name;
        if (name.ends_with(".3mf")) continue; // it holds the time and new identifiers
        EXPECT_TRUE(written.at(name) == content) << name;
    }
    EXPECT_EQ(written.size(), wanted.size());
    std::vector<std::string> listed;
    for (const std::string& part : seen) listed.push_back(part.substr(part.find(' ') + 1) + ".stl");
    for (const std::string& name : listed) EXPECT_TRUE(written.contains(name)) << name << " is in the window's list";

    // Devices takes pins, pulses and directions from the wiring table.
    const DeviceProfile before = window->studio().devices.profile();
    const auto* card = window->find<QWidget>("notices.rig");
    ASSERT_NE(card, nullptr);
    QAbstractButton* set = nullptr;
    for (auto* button : card->findChildren<QAbstractButton*>())
        if (button->isVisible() && button->text().contains("Set Devices up")) set = button;
    ASSERT_NE(set, nullptr);
    QTest::mouseClick(set, Qt::LeftButton);
    const auto rows = literalRows(made / "wiring.csv");
    const DeviceProfile& profile = window->studio().devices.profile();
    ASSERT_EQ(rows.size(), profile.servos.size());
    for (std::size_t k = 0; k < rows.size(); ++k) {
        const ServoSetup& servo = profile.servos[k];
        EXPECT_EQ(rows[k].at(1), std::to_string(k)) << "channels are counted from 0";
        EXPECT_EQ(servo.channel, std::stoi(rows[k].at(2)));
        EXPECT_NEAR(servo.reversed ? servo.pulseMax : servo.pulseMin, std::stod(rows[k].at(3)), 1.0);
        EXPECT_NEAR(servo.reversed ? servo.pulseMin : servo.pulseMax, std::stod(rows[k].at(4)), 1.0);
    }
    EXPECT_NE(profile, before);
    window->studio().devices.undoStack().undo();
    EXPECT_EQ(window->studio().devices.profile(), before);
    window->click("tab.rig");
}

/// Where a flap's range ends, radians.
double endOf(const RigParts& parts, std::size_t actuator) {
    return std::get<Bend>(parts.actuators.at(actuator).deformer).max.inRadians();
}

TEST_F(PartsExport, TheRigIsFittedToItsLeversAndDevicesFollowsOrAsks) {
    take(cutTabletRig());
    const RigParts drawn = *window->state().rig.parts;
    const DeviceProfile before = window->studio().devices.profile();
    open();
    ASSERT_TRUE(planned());
    EXPECT_TRUE(window->text("export.parts.notes").contains("degrees"));
    window->screenshot("parts_fit");
    window->click("export.parts.fit");
    ASSERT_TRUE(planned());
    EXPECT_EQ(window->findNow<QPushButton>("export.parts.fit"), nullptr) << "nothing is left to fit";
    window->click("export.parts.cancel");
    ASSERT_TRUE(eventually([] { return window->state().rig.compiled; }, std::chrono::seconds(30)));
    const RigParts fitted = *window->state().rig.parts;
    for (std::size_t k = 0; k < drawn.actuators.size(); ++k) {
        EXPECT_LE(endOf(fitted, k), endOf(drawn, k));
        const ServoSetup& servo = window->studio().devices.profile().servos.at(k);
        EXPECT_EQ(servo.curve, fitted.actuators[k].drive.curve);
        EXPECT_FALSE(servo.curve.empty());
        EXPECT_EQ(servo.pulseMax, std::max(fitted.actuators[k].drive.pulseMin, fitted.actuators[k].drive.pulseMax));
    }
    EXPECT_LT(endOf(fitted, 0), endOf(drawn, 0)) << "a corner";
    // As undo does; the field, which is built meanwhile, has steps of its own.
    const auto becomes = [](const RigParts& wanted) {
        editRig(window->studio().document, "Another", [&](RigParts& parts) { parts = wanted; });
        ASSERT_TRUE(eventually([&] { return window->state().rig.rig->parts() == wanted; }, std::chrono::seconds(30)));
    };
    becomes(drawn);
    EXPECT_EQ(window->studio().devices.profile().servos, before.servos);

    // What was set up by hand stays, and it is said.
    DeviceProfile own = before;
    own.servos[1].pulseMax = 1900.0;
    ASSERT_TRUE(window->studio().devices.setProfile(own, "Own"));
    becomes(fitted);
    ASSERT_TRUE(eventually([] { return !window->studio().notices.at("servo").empty(); }, std::chrono::seconds(30)));
    EXPECT_EQ(window->studio().devices.profile().servos[1].pulseMax, 1900.0);
    EXPECT_FALSE(window->studio().devices.profile().servos[0].curve.empty());
    const Notice notice = window->studio().notices.at("servo").front();
    ASSERT_EQ(notice.actions.size(), 1U);
    notice.actions[0].run();
    EXPECT_EQ(window->studio().devices.profile().servos[1].curve, fitted.actuators[1].drive.curve);
    window->studio().notices.dismissAll("servo");
}

TEST_F(PartsExport, OfARigThatIsNoSheetAreSeatsAndTheReasonIsSaid) {
    take(test::armRig());
    open();
    ASSERT_TRUE(planned());
    EXPECT_TRUE(window->text("export.parts.notes").contains("no housing"));
    EXPECT_TRUE(window->text("export.parts.notes").contains("begin with a sheet or a pin display"));
    EXPECT_EQ(tableOf(), (std::vector<std::string>{"3 seat", "3 seat-cap"}));
    window->screenshot("parts_seats");
    window->click("export.parts.cancel");
}

TEST_F(PartsExport, WhatCannotBeBuiltIsRefusedWithItsReasonAndTheNextChoiceMendsIt) {
    take(rigOf(rigTemplate("sheet"), {}));
    open();
    ASSERT_TRUE(planned()) << "a sheet without a flap has a housing";
    window->enter("export.parts.bed", "10", Qt::Key_Tab);
    EXPECT_TRUE(window->text("export.parts.wrong").contains("1")) << "out of range";
    EXPECT_TRUE(planned());
    window->click("export.parts.cancel");

    // A seat for a large servo is longer than the smallest bed.
    take(test::armRig());
    open();
    ASSERT_TRUE(planned());
    auto* servo = window->find<QComboBox>("export.parts.servo");
    servo->setFocus();
    QTest::keyClick(servo, Qt::Key_End);
    window->enter("export.parts.bed", "50", Qt::Key_Tab);
    ASSERT_TRUE(
        eventually([] { return window->text("export.parts.wrong").contains("print bed"); }, std::chrono::seconds(20)))
        << window->text("export.parts.wrong").toStdString();
    EXPECT_FALSE(window->find<QPushButton>("export.parts.accept")->isEnabled());
    EXPECT_EQ(window->find<QTableWidget>("export.parts.table")->rowCount(), 0);
    window->screenshot("parts_refused");
    window->enter("export.parts.bed", "220", Qt::Key_Tab);
    EXPECT_TRUE(planned());
    window->click("export.parts.cancel");
}

} // namespace
} // namespace lumorph::studio
