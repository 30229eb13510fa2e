#include <filesystem>

#include <QPushButton>

#include "app/studio/document/scene_edit.h"
#include "core/base/resources.h"
#include "tests/ui/file_dialog.h"
#include "tests/ui/studio_window.h"

// What a scene names and the disk has no longer: the notice in the window, and its button.

namespace lumorph::test {
namespace {

namespace fs = std::filesystem;

class SceneRelink : public ::testing::Test {
protected:
    SceneRelink() : window(folder_ / "session", "scene") {}

    [[nodiscard]] const Scene& scene() { return *window.state().scene; }
    [[nodiscard]] const SceneAssets& assets() { return *window.state().assets; }
    void edit(const std::function<void(Scene&)>& change) {
        studio::editScene(window.studio().document, "Edit", change);
        ASSERT_TRUE(eventually([&] { return window.studio().jobs.running().empty() && window.state().assets; }));
    }
    void relinkTo(const fs::path& file) {
        auto* button = window.find<QPushButton>("notice.action.0");
        ASSERT_NE(button, nullptr);
        EXPECT_EQ(button->text(), "Relink...");
        window.screenshot("scene-relink");
        window.click("notice.action.0");
        answerFileDialog(window, "dialog.sceneFile", file, "Open");
    }

    TemporaryFolder folder_;
    StudioWindow window;
};

TEST_F(SceneRelink, AMissingModelIsShownAgainFromWhereItIs) {
    const fs::path there = folder_.path() / "moved.glb";
    fs::copy_file(resourceFile("models/tablet.glb"), there);
    const std::string gone = (folder_.path() / "gone.glb").string();
    edit([&](Scene& scene) {
        SceneItem item;
        item.name = "Model";
        item.kind = MeshItem{gone};
        studio::addItem(scene, std::move(item));
    });
    EXPECT_FALSE(assets().models.contains(gone));
    relinkTo(there);
    EXPECT_TRUE(eventually([&] { return assets().models.contains(there.string()); }));
    EXPECT_TRUE(eventually([&] { return window.findNow<QPushButton>("notice.action.0") == nullptr; }));
    EXPECT_EQ(std::get<MeshItem>(scene().items.back().kind).model, there.string());
}

TEST_F(SceneRelink, AMissingPictureIsShownAgainFromWhereItIs) {
    const fs::path there = folder_.path() / "moved.png";
    ASSERT_TRUE(QImage(8, 8, QImage::Format_RGB32).save(QString::fromStdString(there.string())));
    const std::string gone = (folder_.path() / "gone.png").string();
    edit([&](Scene& scene) { scene.table.material.colorTexture.image = gone; });
    EXPECT_EQ(assets().problems.count(gone), 1U);
    relinkTo(there);
    EXPECT_TRUE(eventually([&] { return assets().images.contains(there.string()) && assets().problems.empty(); }));
    EXPECT_TRUE(eventually([&] { return window.findNow<QPushButton>("notice.action.0") == nullptr; }));
    EXPECT_EQ(scene().table.material.colorTexture.image, there.string());
}

} // namespace
} // namespace lumorph::test
