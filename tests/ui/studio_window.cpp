#include "tests/ui/studio_window.h"

#include <cstdlib>
#include <fstream>

#include <malloc.h>

#include <QAbstractButton>
#include <QAbstractSlider>
#include <QDragEnterEvent>
#include <QDropEvent>
#include <QLineEdit>
#include <QMimeData>
#include <QPointer>
#include <QScreen>
#include <QUrl>

#include "app/workspaces/workspaces.h"

namespace lumorph::test {

using namespace std::chrono_literals;

int soakFactor() {
    const char* factor = std::getenv("LUMORPH_SOAK");
    return factor ? std::max(1, std::atoi(factor)) : 1;
}

double residentMegabytes() {
    std::ifstream file("/proc/self/statm");
    double pages = 0.0;
    file >> pages >> pages;
    return pages * 4096.0 / 1e6;
}

double allocatedMegabytes() {
    const struct mallinfo2 heap = ::mallinfo2();
    return static_cast<double>(heap.uordblks + heap.hblkhd) / 1e6;
}

void drawLittle(studio::Studio& studio) {
    if (const char* share = std::getenv("LUMORPH_TEST_DRAWS")) studio.renderer.setShare(std::atof(share));
}

void setPlaying(studio::Studio& studio, bool on) {
    studio.document.complete([on](studio::StudioState& state) { state.playback.playing = on; });
}

StudioWindow::StudioWindow(const std::filesystem::path& session, const QString& workspace) {
    const bool again = std::filesystem::exists(session);
    ::setenv("LUMORPH_SESSION", session.c_str(), 1);
    // A test begins in the virtual lab, whatever room the one before left.
    if (!again || std::filesystem::is_empty(session)) {
        std::filesystem::remove_all(studio::Settings().folder() / "installation");
        for (const char* lab : {"lab/unpacked", "lab/next"}) studio::Settings().remove(lab);
        for (const char* view : {"camera/field", "camera/rig"}) studio::Settings().setValue(view, {});
    }
    studio_ = std::make_unique<studio::Studio>();
    drawLittle(*studio_);
    studio_->settings.setTourSeen(true);
    window_ = std::make_unique<studio::MainWindow>(*studio_, studio::makeWorkspaces(*studio_));
    window_->showWorkspace(workspace);
    window_->resize(QSize(1600, 1000).boundedTo(window_->screen()->availableSize())); // less at 200 % scaling
    window_->show();
    (void)QTest::qWaitForWindowExposed(window_.get());
    bool there = false;
    if (again) {
        studio_->project.restoreSession([&there] { there = true; });
    } else {
        studio_->project.openDemo("field");
        there = true;
    }
    EXPECT_TRUE(eventually([&] { return there && state().field.field && studio_->loop.frame(); }));
    if (!again) setPlaying(*studio_, false);
}

StudioWindow::~StudioWindow() {
    window_.reset();
    studio_.reset();
    ::unsetenv("LUMORPH_SESSION");
}

void StudioWindow::click(const QString& name) {
    if (auto* button = find<QWidget>(name)) QTest::mouseClick(button, Qt::LeftButton);
}

void StudioWindow::hold(const QString& name, std::chrono::milliseconds time) {
    const QPointer<QWidget> button = find<QWidget>(name);
    if (!button) return;
    QTest::mousePress(button, Qt::LeftButton);
    (void)eventually([&] { return !button || !button->isVisible(); }, time);
    if (button && button->isVisible()) QTest::mouseRelease(button, Qt::LeftButton);
}

void StudioWindow::enter(const QString& name, const QString& text, Qt::Key then) {
    auto* field = find<QLineEdit>(name);
    if (!field) return;
    // Tab takes the focus on, and so commits, in the active window alone; a busy machine makes a dialog that late.
    (void)eventually([field] { return field->isActiveWindow(); }, 5s);
    field->setFocus();
    QTest::keyClick(field, Qt::Key_A, Qt::ControlModifier);
    QTest::keyClicks(field, text);
    QTest::keyClick(field, then);
}

void StudioWindow::command(const QString& words) {
    window_->activateWindow();
    (void)eventually([this] { return window_->isActiveWindow(); }, 5s); // a shortcut is the active window's alone
    QTest::keyClick(window_.get(), Qt::Key_K, Qt::ControlModifier);
    auto* input = find<QLineEdit>("palette.input");
    if (!input) return;
    QTest::keyClicks(input, words);
    QTest::keyClick(input, Qt::Key_Return);
}

void StudioWindow::drop(const std::filesystem::path& file, QWidget* onto) {
    QWidget& aim = onto ? *onto : view();
    QMimeData data;
    data.setUrls({QUrl::fromLocalFile(QString::fromStdString(file.string()))});
    const QPoint at = aim.mapTo(window_.get(), aim.rect().center());
    QDragEnterEvent enters(at, Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
    QApplication::sendEvent(window_.get(), &enters);
    EXPECT_TRUE(enters.isAccepted());
    pass(50ms);
    QDropEvent drops(at, Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
    QApplication::sendEvent(window_.get(), &drops);
}

void StudioWindow::slide(const QString& name, double share) {
    auto* slider = find<QAbstractSlider>(name);
    if (!slider) return;
    const auto at = [slider](double value) {
        return QPoint(10 + static_cast<int>(value * (slider->width() - 20)), slider->height() / 2);
    };
    const double now =
        static_cast<double>(slider->value() - slider->minimum()) / std::max(1, slider->maximum() - slider->minimum());
    QTest::mousePress(slider, Qt::LeftButton, {}, at(now));
    for (int step = 1; step <= 20; ++step) {
        QTest::mouseMove(slider, at(now + (share - now) * step / 20.0));
        pass(5ms);
    }
    QTest::mouseRelease(slider, Qt::LeftButton, {}, at(share));
}

QString StudioWindow::text(const QString& label) {
    if (const auto* button = findNow<QAbstractButton>(label)) return button->text();
    const auto* found = find<QLabel>(label);
    return found ? found->text() : QString();
}

bool StudioWindow::settles() {
    QElapsedTimer quiet; // for a while: the end of one job may begin another
    return eventually([&] {
        const bool settled = studio_->jobs.running().empty() && view().settled();
        if (!settled) quiet.invalidate();
        if (settled && !quiet.isValid()) quiet.start();
        return settled && quiet.elapsed() >= 150;
    });
}

void StudioWindow::screenshot(const QString& name, std::chrono::milliseconds after) {
    const char* folder = std::getenv("LUMORPH_SCREENSHOTS");
    if (!folder) return;
    pass(after); // dialogs and menus appear
    QGuiApplication::primaryScreen()->grabWindow(0).save(QString(folder) + '/' + name + ".png");
}

} // namespace lumorph::test
