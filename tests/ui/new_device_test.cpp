#include <gtest/gtest.h>

#include <QSlider>

#include "core/rig/rig_file.h"
#include "core/rig/templates/rig_templates.h"
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

} // namespace
} // namespace lumorph::studio
