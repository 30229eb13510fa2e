#include <fstream>
#include <regex>

#include <gtest/gtest.h>

#include <QDialog>
#include <QFontInfo>
#include <QLineEdit>
#include <QListWidget>
#include <QTest>
#include <QTextBrowser>

#include "app/studio/shell/guide_window.h"
#include "core/base/resources.h"
#include "tests/ui/studio_window.h"

namespace lumorph::studio {
namespace {

std::string textOf(const std::filesystem::path& file) {
    std::ifstream in(file);
    return {std::istreambuf_iterator<char>(in), {}};
}

TEST(GuidePages, AllAreFoundFromTheFirstAndLeadNowhereElse) {
    const std::filesystem::path folder = resourcesFolder() / "guide";
    const std::string index = textOf(folder / "index.md");
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() != ".md") continue;
        ++files;
        const std::string name = entry.path().filename().string();
        EXPECT_TRUE(name == "index.md" || index.find("](" + name + ")") != std::string::npos)
            << name << " is not named";
        const std::string text = textOf(entry.path());
        EXPECT_EQ(text.substr(0, 2), "# ") << name << " begins with its title";
        const std::regex link(R"(\]\(([^)]+)\))");
        for (std::sregex_iterator it(text.begin(), text.end(), link), end; it != end; ++it) {
            const std::string to = (*it)[1].str();
            EXPECT_TRUE(to.rfind("http", 0) == 0 || std::filesystem::exists(folder / to)) << name << ": " << to;
        }
    }
    const auto pages = guidePages();
    ASSERT_EQ(pages.size(), files);
    EXPECT_EQ(pages.front().file.stem(), "index");
    EXPECT_EQ(pages.at(1).title, "Your first device in ten minutes");
}

TEST(GuideWindow, F1OpensItSearchNarrowsItAndLinksTurnItsPages) {
    TemporaryFolder folder;
    test::StudioWindow window(folder / "session", "rig");
    QTest::keyClick(&window.window(), Qt::Key_F1);
    auto* text = window.find<QTextBrowser>("guide.text");
    ASSERT_TRUE(text);
    auto* list = window.find<QListWidget>("guide.pages");
    EXPECT_TRUE(text->toPlainText().startsWith("Lumorph's guide"));
    EXPECT_EQ(list->currentRow(), 0);
    window.screenshot("guide");

    // A click on the first link of the page.
    const QTextCursor cursor = text->document()->find("Your first device");
    ASSERT_FALSE(cursor.isNull());
    const QPoint at = text->cursorRect(cursor).center() - QPoint(4, 0);
    QTest::mouseClick(text->viewport(), Qt::LeftButton, {}, at);
    ASSERT_TRUE(test::eventually([&] { return text->toPlainText().startsWith("Your first device"); }));
    ASSERT_TRUE(list->currentItem());
    EXPECT_EQ(list->currentItem()->text(), "Your first device in ten minutes");
    window.screenshot("guide_first_device");

    auto* search = window.find<QLineEdit>("guide.search");
    QTest::keyClicks(search, "chessboard");
    EXPECT_GE(list->count(), 1);
    EXPECT_LT(list->count(), 4);
    bool calibrating = false;
    for (int k = 0; k < list->count(); ++k) calibrating |= list->item(k)->text() == "Calibrating projector and camera";
    EXPECT_TRUE(calibrating);
    search->clear();
    EXPECT_EQ(list->count(), static_cast<int>(guidePages().size()));

    // Another place of the studio opens it at its page; there is one window.
    openGuide(window.window(), "shape-resolution");
    EXPECT_TRUE(text->toPlainText().trimmed().startsWith("What a device can show"));
    EXPECT_EQ(window.window().findChildren<QDialog*>("dialog.guide").size(), 1);
    const auto sizeOf = [&](const QString& words) {
        const QTextCursor found = text->document()->find(words);
        return QFontInfo(found.charFormat().font()).pointSizeF();
    };
    EXPECT_GT(sizeOf("What a device can show"), sizeOf("How good is a device") + 3.0) << "a paragraph is no heading";
    window.screenshot("guide_shape_resolution");
    openGuide(window.window(), "no such page");
    EXPECT_TRUE(text->toPlainText().startsWith("Lumorph's guide"));
}

} // namespace
} // namespace lumorph::studio
