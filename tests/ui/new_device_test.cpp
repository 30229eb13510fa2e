#include <gtest/gtest.h>

#include <fstream>

#include <QListWidget>
#include <QSlider>

#include "core/geometry/mesh_file.h"
#include "core/geometry/model.h"
#include "core/rig/rig_file.h"
#include "core/rig/templates/bundled_rigs.h"
#include "core/rig/templates/rig_templates.h"
#include "tests/support/small_rigs.h"
#include "tests/ui/file_dialog.h"
#include "tests/ui/studio_window.h"

namespace lumorph::studio {
namespace {

using test::eventually;

struct NewDevice : testing::Test {
    void SetUp() override {
        window.command("New device");
        accept = window.find<QPushButton>("rig.new.accept");
        ASSERT_NE(accept, nullptr);
        ASSERT_TRUE(canBeMade());
    }
    [[nodiscard]] bool canBeMade() {
        return eventually([&] { return accept->isEnabled(); }, std::chrono::seconds(20));
    }
    void choose(const QString& kind) {
        auto* button = window.find<QAbstractButton>("rig.new.kind." + kind);
        QTest::mouseClick(button, Qt::LeftButton);
        ASSERT_TRUE(canBeMade());
    }
    [[nodiscard]] std::vector<glm::vec3> seen() {
        const auto& scene = window.find<ViewportWidget>("rig.new.view")->scene();
        return scene && !scene->surfaces.empty() ? *scene->surfaces.front().positions : std::vector<glm::vec3>();
    }

    TemporaryFolder folder;
    test::StudioWindow window{folder / "session"};
    QPushButton* accept = nullptr;
};

TEST_F(NewDevice, ItIsSeenWhileItsMeasuresChangeAndBecomesTheRigByOneStep) {
    const StudioState before = window.state();
    choose("flower");
    window.enter("rig.new.petals", "4", Qt::Key_Tab);
    ASSERT_TRUE(eventually([&] { return window.text("rig.new.facts").contains("Servos: 4"); }));
    window.enter("rig.new.diameter", "30 cm", Qt::Key_Tab);
    ASSERT_TRUE(canBeMade());
    const std::vector<TemplateChoice> choices{{"petals", 4.0}, {"diameter", 30.0}};
    const Rig wanted = rigOf(rigTemplate("flower"), choices);

    // The picture is the device with all actuators where the slider says.
    for (const int percent : {0, 100}) {
        window.find<QSlider>("rig.new.raised")->setValue(percent);
        std::vector<glm::vec3> expected(wanted.restMesh().positions.size());
        wanted.deform(std::vector<double>(4, 0.01 * percent), expected);
        ASSERT_TRUE(eventually([&] { return seen() == expected; })) << percent;
    }
    EXPECT_EQ(window.state().rig.rig, before.rig.rig) << "nothing changes before it is accepted";
    window.screenshot("new_device");

    window.click("rig.new.accept");
    ASSERT_TRUE(eventually([&] { return window.state().rig.rig->actuatorCount() == 4; }, std::chrono::seconds(20)));
    EXPECT_EQ(writeRigGlb(*window.state().rig.rig), writeRigGlb(wanted));
    EXPECT_TRUE(window.state().rig.path.empty());
    ASSERT_TRUE(eventually([&] { return window.state().field.field != nullptr; }, std::chrono::seconds(60)))
        << "its field is built by itself";
    while (window.state().rig.rig != before.rig.rig && window.studio().document.undoStack().canUndo())
        window.studio().document.undoStack().undo();
    EXPECT_EQ(window.state().rig.rig, before.rig.rig);
    EXPECT_EQ(window.state().field.field, before.field.field);
}

TEST_F(NewDevice, MeasuresThatMakeNoneSayWhyAndTheLastOneStaysInSight) {
    const StudioState before = window.state();
    choose("phone");
    const auto sound = seen();
    window.enter("rig.new.corner", "7 cm", Qt::Key_Tab);
    ASSERT_TRUE(eventually([&] { return window.text("rig.new.wrong").contains("nothing would be left"); }));
    EXPECT_FALSE(accept->isEnabled());
    EXPECT_EQ(seen(), sound);
    window.enter("rig.new.corner", "2 cm", Qt::Key_Tab);
    ASSERT_TRUE(canBeMade());
    EXPECT_EQ(window.text("rig.new.wrong"), "");

    window.enter("rig.new.width", "9 m", Qt::Key_Tab);
    EXPECT_NE(window.text("rig.new.wrong"), "") << "out of range";
    window.click("rig.new.cancel");
    EXPECT_EQ(window.state().rig.rig, before.rig.rig);
    EXPECT_EQ(window.state().field.field, before.field.field);
}

/// The hills without what says that they are a rig: shape keys of a mesh, as a modelling tool exports them.
std::filesystem::path plainHills(const std::filesystem::path& file) {
    Model model = readGlb(writeRigGlb(hillsRig()), "hills.glb");
    model.extras = nullptr;
    for (Model::Mesh& mesh : model.meshes) mesh.extras = nullptr;
    for (Model::Node& node : model.nodes) node.extras = nullptr;
    const std::vector<std::byte> bytes = writeGlb(model);
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    return file;
}

void clickBox(QListWidget& list, int row) {
    const QRect item = list.visualItemRect(list.item(row));
    QTest::mouseClick(list.viewport(), Qt::LeftButton, {}, {item.left() + 10, item.center().y()});
}

TEST_F(NewDevice, ShapeKeysOfAModelAreOfferedAndThoseTickedAreItsActuators) {
    const auto file = plainHills(folder / "hills.glb");
    const std::vector<ActuatorOffer> offers = offeredActuators(file);
    ASSERT_GT(offers.size(), 1U);
    window.click("rig.new.mesh");
    test::answerFileDialog(window, "rig.new.file", file, "Open");
    auto* list = window.find<QListWidget>("rig.new.offers");
    ASSERT_NE(list, nullptr);
    ASSERT_TRUE(canBeMade());
    ASSERT_EQ(list->count(), static_cast<int>(offers.size()));
    EXPECT_TRUE(window.text("rig.new.facts").contains(QString("Servos: %1").arg(offers.size())));
    EXPECT_TRUE(list->item(0)->text().startsWith(QString::fromStdString(offers[0].name)));
    window.screenshot("new_device_mesh");
    for (int row = 0; row < list->count(); ++row) clickBox(*list, row);
    EXPECT_TRUE(eventually([&] { return window.text("rig.new.wrong").contains("Tick at least one"); }));
    EXPECT_FALSE(accept->isEnabled());
    clickBox(*list, 1);
    ASSERT_TRUE(canBeMade());
    EXPECT_EQ(window.text("rig.new.wrong"), "");
    window.click("rig.new.accept");
    ASSERT_TRUE(eventually([&] { return window.state().rig.rig->actuatorCount() == 1; }, std::chrono::seconds(20)));
    EXPECT_EQ(window.state().rig.rig->actuators()[0].name, offers[1].name);
}

TEST_F(NewDevice, AFolderOfStatesBecomesTheRigAndAMeshInOneStateSaysWhy) {
    const auto states = folder / "lid";
    std::filesystem::create_directory(states);
    TriangleMesh mesh = test::boxMesh({0, 0, 0}, {0.1F, 0.02F, 0.1F}, 2);
    writeMesh(mesh, states / "rest.obj");
    for (glm::vec3& p : mesh.positions)
        if (p.y > 0.01F) p.y += 0.03F;
    writeMesh(mesh, states / "lid_1.obj");

    window.click("rig.new.mesh");
    test::answerFileDialog(window, "rig.new.file", states / "rest.obj", "Open");
    ASSERT_TRUE(eventually([&] { return window.text("rig.new.wrong").contains("one state"); }));
    EXPECT_TRUE(window.text("rig.new.wrong").contains("folder of one mesh a state"));
    EXPECT_FALSE(accept->isEnabled());
    window.screenshot("new_device_one_state");

    window.click("rig.new.states");
    test::answerFileDialog(window, "rig.new.file", states, "Choose");
    ASSERT_TRUE(canBeMade());
    EXPECT_EQ(window.text("rig.new.wrong"), "");
    EXPECT_TRUE(window.text("rig.new.facts").contains("Servos: 1"));
    EXPECT_TRUE(window.find<QAbstractButton>("rig.new.states")->isChecked());
    // A dialog that is given up leaves what was shown.
    window.click("rig.new.mesh");
    auto* asked = window.find<QDialog>("rig.new.file");
    ASSERT_NE(asked, nullptr);
    QTest::keyClick(asked, Qt::Key_Escape);
    EXPECT_TRUE(eventually([&] { return window.find<QAbstractButton>("rig.new.states")->isChecked(); }));
    EXPECT_TRUE(accept->isEnabled());
    window.click("rig.new.accept");
    ASSERT_TRUE(eventually([&] { return window.state().rig.rig->actuatorCount() == 1; }, std::chrono::seconds(20)));
    EXPECT_EQ(window.state().rig.rig->actuators()[0].name, "lid");
    EXPECT_NEAR(window.state().rig.rig->reach().max.y, 0.05, 1e-5);
}

} // namespace
} // namespace lumorph::studio
