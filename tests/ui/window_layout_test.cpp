#include <cstdlib>
#include <memory>

#include <QApplication>
#include <QDialogButtonBox>
#include <QDockWidget>
#include <QFileDialog>
#include <QLabel>
#include <QPushButton>
#include <QScreen>
#include <QScrollArea>
#include <QTest>
#include <QToolButton>
#include <QVBoxLayout>
#include <gtest/gtest.h>

#include "app/studio/shell/dialog_fit.h"
#include "app/studio/shell/main_window.h"
#include "app/workspaces/workspaces.h"
#include "core/base/resources.h"
#include "tests/core/temporary_folder.h"
#include "tests/ui/event_loop.h"
#include "tests/ui/studio_window.h"

namespace lumorph::studio {
namespace {

using namespace std::chrono_literals;
using test::eventually;

/// Starts of the window, one after the other, with settings of their own. A desktop's window manager puts frames
/// around.
class WindowLayout : public testing::Test {
protected:
    WindowLayout() { ::setenv("LUMORPH_SESSION", (folder_ / "session").c_str(), 1); }
    ~WindowLayout() override {
        close();
        ::unsetenv("LUMORPH_SESSION");
    }
    static void SetUpTestSuite() { QSettings(QSettings::IniFormat, QSettings::UserScope, "lumorph", "studio").clear(); }

    void start(bool withWorkspaces = false) {
        studio_ = std::make_unique<Studio>();
        test::drawLittle(*studio_);
        studio_->settings.setTourSeen(true);
        auto workspaces = withWorkspaces ? makeWorkspaces(*studio_) : std::vector<std::unique_ptr<Workspace>>();
        window_ = std::make_unique<MainWindow>(*studio_, std::move(workspaces));
        window_->show();
        ASSERT_TRUE(QTest::qWaitForWindowExposed(window_.get()));
        test::pass(700ms); // the window manager has the last word
    }
    void close() {
        if (window_) window_->close();
        window_.reset();
        studio_.reset();
    }

    TemporaryFolder folder_;
    std::unique_ptr<Studio> studio_;
    std::unique_ptr<MainWindow> window_;
};

TEST_F(WindowLayout, TheWindowStandsWhereItStoodOverThreeStarts) {
    start();
    const QRect frame = window_->frameGeometry();
    ASSERT_GT(frame.height(), window_->height()) << "this display has no window manager, so nothing is tested";
    window_->setGeometry(210, 130, 1111, 707);
    test::pass(500ms);
    const QRect there = window_->geometry();
    EXPECT_EQ(there.size(), QSize(1111, 707));
    for (int again = 0; again < 3; ++again) {
        close();
        start();
        EXPECT_EQ(window_->geometry(), there) << "start " << again + 2;
    }
}

TEST_F(WindowLayout, AWindowFromALargerScreenComesIntoSight) {
    start();
    const QRect screen = window_->screen()->availableGeometry();
    window_->setGeometry(screen.width() - 300, screen.height() - 200, 1200, 800);
    test::pass(500ms);
    close();
    start();
    EXPECT_TRUE(screen.contains(window_->frameGeometry()))
        << window_->x() << ' ' << window_->y() << ' ' << window_->width() << ' ' << window_->height();
}

TEST_F(WindowLayout, AWidenedDockKeepsItsWidth) {
    start(true);
    window_->setGeometry(100, 80, 1400, 820);
    window_->showWorkspace("scene");
    test::pass(600ms);
    const auto outliner = [this] { return window_->findChild<QDockWidget*>("dock.scene.outliner"); };
    auto* page = qobject_cast<QMainWindow*>(outliner()->parentWidget());
    ASSERT_NE(page, nullptr);
    page->resizeDocks({outliner()}, {463}, Qt::Horizontal);
    test::pass(200ms);
    ASSERT_EQ(outliner()->width(), 463);
    for (int again = 0; again < 2; ++again) {
        close();
        start(true);
        EXPECT_EQ(outliner()->width(), 463);
    }
}

TEST_F(WindowLayout, ADialogThatIsTooTallScrollsAndKeepsItsButtons) {
    QDialog dialog;
    auto* column = new QVBoxLayout(&dialog);
    for (int i = 0; i < 80; ++i) column->addWidget(new QPushButton(QString("Row %1").arg(i)));
    auto* buttons = new QDialogButtonBox(QDialogButtonBox::Close, &dialog);
    column->addWidget(buttons);
    fitDialog(dialog);
    dialog.show();
    ASSERT_TRUE(QTest::qWaitForWindowExposed(&dialog));
    test::pass(300ms);
    EXPECT_TRUE(dialog.screen()->availableGeometry().contains(dialog.frameGeometry()));
    EXPECT_NE(dialog.findChild<QScrollArea*>("dialog.scroll"), nullptr);
    EXPECT_TRUE(buttons->isVisible());
    EXPECT_TRUE(dialog.rect().contains(QRect(buttons->mapTo(&dialog, QPoint()), buttons->size())));
}

TEST_F(WindowLayout, LinesThatWrapAreNotCutInADialog) {
    QDialog dialog;
    auto* column = new QVBoxLayout(&dialog);
    auto* text = new QLabel(QString("Every word of this has to be read. ").repeated(30));
    text->setWordWrap(true);
    column->addWidget(text);
    column->addWidget(new QPushButton("Close"));
    dialog.resize(240, 120);
    fitDialog(dialog);
    dialog.show();
    ASSERT_TRUE(QTest::qWaitForWindowExposed(&dialog));
    EXPECT_EQ(dialog.width(), 240);
    EXPECT_GE(text->height(), text->heightForWidth(text->width()));
}

TEST_F(WindowLayout, ARunningTestPatternIsSeenAndOneClickEndsIt) {
    start();
    auto* chip = window_->findChild<QPushButton*>("status.pattern");
    ASSERT_NE(chip, nullptr);
    EXPECT_FALSE(chip->isVisible());
    studio_->outputs.setPattern(TestPattern::grid);
    EXPECT_TRUE(chip->isVisible());
    EXPECT_TRUE(chip->text().contains(nameOf(TestPattern::grid))) << chip->text().toStdString();
    QTest::mouseClick(chip, Qt::LeftButton);
    EXPECT_EQ(studio_->outputs.pattern(), TestPattern::none);
    EXPECT_FALSE(chip->isVisible());
}

TEST_F(WindowLayout, AllNoticesAreDismissedByOneClick) {
    start();
    for (const char* place : {"target", "field", "output"})
        studio_->notices.post(place, {Notice::Level::warning, QString("About ") + place, "Why.", "Do.", {}});
    auto* warnings = window_->findChild<QPushButton*>("status.warnings");
    QTest::mouseClick(warnings, Qt::LeftButton);
    auto* all = window_->findChild<QPushButton*>("notices.dismissAll");
    ASSERT_NE(all, nullptr);
    QTest::mouseClick(all, Qt::LeftButton);
    EXPECT_TRUE(studio_->notices.at().empty());
    EXPECT_TRUE(eventually([&] { return warnings->text() == "No warnings"; }));
}

TEST_F(WindowLayout, OpenOffersWhatIsBundledWithPictures) {
    start();
    studio_->commands.find("file.open")->trigger();
    QPointer<QFileDialog> dialog = window_->findChild<QFileDialog*>("dialog.open");
    ASSERT_TRUE(dialog);
    for (const char* folder : {"models", "targets"})
        for (const auto& entry : std::filesystem::directory_iterator(resourcesFolder() / folder)) {
            if (entry.path().extension() != ".glb") continue;
            const std::string name = entry.path().stem().string();
            auto* tile = dialog->findChild<QToolButton*>(QString::fromStdString("bundled." + name));
            ASSERT_NE(tile, nullptr) << name;
            const QImage shown = tile->icon().pixmap(tile->iconSize()).toImage().convertToFormat(QImage::Format_RGB32);
            const QImage file(
                QString::fromStdString((resourcesFolder() / "thumbnails" / folder / (name + ".png")).string()));
            ASSERT_EQ(file.size(), QSize(320, 200)) << name << " has no picture";
            EXPECT_GT(shown.width(), 90) << name;
        }
    QTest::mouseClick(dialog->findChild<QToolButton*>("bundled.hills"), Qt::LeftButton);
    EXPECT_TRUE(eventually([&] {
        const auto& rig = studio_->document.state().rig.rig;
        return rig && rig->name() == "hills";
    }));
    EXPECT_TRUE(eventually([&] { return !dialog; }));
}

} // namespace
} // namespace lumorph::studio
