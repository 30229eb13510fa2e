// Every way in which the studio ends, with six servos live on stock firmware, which lets go of nothing by itself.

#include "app/studio/shell/way_out.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>
#include <xcb/xcb.h>

#include <QProcess>
#include <QSocketNotifier>
#include <gtest/gtest.h>

#include "devices/simulator/board_at_port.h"
#include "tests/support/long_tests.h"
#include "tests/ui/studio_window.h"

namespace {

/// A disk that hangs, for all that is written by this program.
std::atomic<bool> diskHangs = false;

} // namespace

extern "C" int fsync(int file) {
    while (diskHangs) ::usleep(10'000);
    return static_cast<int>(::syscall(SYS_fsync, file));
}

namespace lumorph::test {
namespace {

using namespace std::chrono_literals;
using WallClock = std::chrono::steady_clock;

/// A studio whose servos follow the show, until something ends it. Run by the test below, which reads what it prints.
TEST(StudioEndsChild, DISABLED_DrivesServosUntilItEnds) {
    const std::filesystem::path folder = qEnvironmentVariable("LUMORPH_TEST_FILES").toStdString();
    StudioWindow window(folder / "session", "devices");
    studio::WayOut wayOut(window.window(), window.studio());
    studio::DeviceService& devices = window.studio().devices;
    DeviceProfile profile = devices.profile();
    profile.restOnExit = false;
    profile.staggerSeconds = 0.02;
    ASSERT_TRUE(devices.setProfile(profile));
    devices.connectTo(qEnvironmentVariable("LUMORPH_TEST_PORT"), ControllerKind::firmata);
    devices.setShown(true);
    ASSERT_TRUE(eventually([&] { return devices.status().phase == LinkPhase::disarmed; }));
    devices.start(true);
    ASSERT_TRUE(eventually([&] { return devices.status().phase == LinkPhase::live; }));
    const QSocketNotifier escape(STDIN_FILENO, QSocketNotifier::Read);
    QObject::connect(&escape, &QSocketNotifier::activated, [&window] {
        char word = 0;
        if (::read(STDIN_FILENO, &word, 1) != 1) std::_Exit(3);
        for (int i = 0; i < 2; ++i) QTest::keyClick(&window.window(), Qt::Key_Escape);
    });
    diskHangs = qEnvironmentVariableIsSet("LUMORPH_TEST_DISK_HANGS");
    std::printf("live %llu\n", static_cast<unsigned long long>(window.window().winId()));
    std::fflush(stdout);
    std::_Exit(wayOut.exec());
}

enum class EndedBy { sent, close, escapeTwice, kill, server };

struct StudioEnd {
    const char* name;
    EndedBy how;
    std::vector<int> sent; ///< signals, 20 ms apart
    int exitCode = -1;     ///< -1: it ends by a signal, or does not end
    bool always = false;   ///< also in the short form
    bool diskHangs = false;
};
const StudioEnd kStudioEnds[] = {
    {"its window is closed", EndedBy::close, {}, 0, true},
    {"SIGTERM", EndedBy::sent, {SIGTERM}, 0},
    {"Esc Esc", EndedBy::escapeTwice, {}},
    {"Ctrl+C twice", EndedBy::sent, {SIGINT, SIGINT}},
    {"SIGTERM twice", EndedBy::sent, {SIGTERM, SIGTERM}, -1, true},
    {"SIGHUP twice", EndedBy::sent, {SIGHUP, SIGHUP}, 0, true},
    {"SIGQUIT", EndedBy::sent, {SIGQUIT}, 0},
    {"xkill", EndedBy::kill, {}, 1, true},
    {"the X server ends", EndedBy::server, {}, 1, true},
    {"a disk hangs, SIGTERM", EndedBy::sent, {SIGTERM}, -1, true, true},
    {"SIGSEGV", EndedBy::sent, {SIGSEGV}},
    {"SIGABRT", EndedBy::sent, {SIGABRT}},
    {"SIGKILL", EndedBy::sent, {SIGKILL}},
    {"hang of 3 s", EndedBy::sent, {SIGSTOP}},
};

/// A display of its own, which can be ended.
class OwnDisplay {
public:
    OwnDisplay() {
        server_.start("Xvfb", {"-displayfd", "1", "-screen", "0", "1280x800x24", "-nolisten", "tcp"});
        QByteArray number;
        (void)eventually([&] {
            number += server_.readAllStandardOutput();
            return number.endsWith('\n');
        });
        name_ = ":" + QString::fromUtf8(number.trimmed());
    }
    [[nodiscard]] QString name() const { return name_; }
    void end() {
        server_.kill();
        (void)server_.waitForFinished();
    }

private:
    QProcess server_;
    QString name_;
};

class StudioEnding {
public:
    explicit StudioEnding(const StudioEnd& row) : row_(row) {
        auto environment = QProcessEnvironment::systemEnvironment();
        environment.insert("LUMORPH_TEST_FILES", QString::fromStdString(folder_.path().string()));
        environment.insert("LUMORPH_TEST_PORT", QString::fromStdString(board_.address()));
        environment.insert("TMPDIR", QString::fromStdString(folder_.path().string()));
        if (row.diskHangs) environment.insert("LUMORPH_TEST_DISK_HANGS", "1");
        if (row.how == EndedBy::server) display_ = std::make_unique<OwnDisplay>();
        if (display_) environment.insert("DISPLAY", display_->name());
        child_.setProcessEnvironment(environment);
        child_.start(QCoreApplication::applicationFilePath(),
                     {"--gtest_also_run_disabled_tests", "--gtest_filter=StudioEndsChild.*"});
    }
    ~StudioEnding() {
        child_.kill();
        (void)child_.waitForFinished();
    }

    void play() {
        SCOPED_TRACE(row_.name);
        ASSERT_TRUE(eventually([this] { return live(); }, 120s)) << output_.toStdString();
        ASSERT_TRUE(eventually([this] { return board_.driven() == 6; }));
        const WallClock::time_point begin = WallClock::now();
        end();
        EXPECT_TRUE(eventually([this] { return board_.driven() == 0; }, 15s));
        const double seconds = std::chrono::duration<double>(board_.lastDriven() - begin).count();
        std::printf("  %-24s %6.3f s\n", row_.name, seconds);
        const bool hangs = !row_.sent.empty() && row_.sent.front() == SIGSTOP;
        EXPECT_LT(seconds, hangs ? 2.0 : 1.0);
        if (hangs) {
            std::this_thread::sleep_until(begin + 3s);
            ::kill(pid(), SIGCONT);
        }
        EXPECT_FALSE(eventually([this] { return board_.driven() > 0; }, hangs ? 1500ms : 300ms)) << "driven again";
        if (row_.exitCode < 0) return;
        EXPECT_TRUE(eventually([this] { return child_.state() == QProcess::NotRunning; }));
        EXPECT_EQ(child_.exitStatus(), QProcess::NormalExit);
        EXPECT_EQ(child_.exitCode(), row_.exitCode) << child_.readAllStandardError().toStdString();
    }

private:
    [[nodiscard]] pid_t pid() const { return static_cast<pid_t>(child_.processId()); }
    bool live() {
        output_ += child_.readAllStandardOutput();
        const qsizetype at = output_.indexOf("live ");
        if (at < 0 || output_.indexOf('\n', at) < 0) return false;
        window_ = output_.mid(at + 5, output_.indexOf('\n', at) - at - 5).toUInt();
        return true;
    }
    void end() {
        switch (row_.how) {
        case EndedBy::sent:
            for (const int signal : row_.sent) {
                ::kill(pid(), signal);
                if (row_.sent.size() > 1) std::this_thread::sleep_for(20ms);
            }
            break;
        case EndedBy::escapeTwice:
            child_.write("e");
            break;
        case EndedBy::server:
            display_->end();
            break;
        case EndedBy::close:
        case EndedBy::kill:
            askServer();
            break;
        }
    }
    /// What a window manager does to a window.
    void askServer() const {
        xcb_connection_t* server = xcb_connect(nullptr, nullptr);
        if (row_.how == EndedBy::kill) {
            xcb_kill_client(server, window_);
        } else {
            const auto atom = [server](const std::string& name) {
                auto* reply = xcb_intern_atom_reply(
                    server, xcb_intern_atom(server, 0, static_cast<std::uint16_t>(name.size()), name.c_str()), nullptr);
                const xcb_atom_t found = reply->atom;
                std::free(reply);
                return found;
            };
            xcb_client_message_event_t event{};
            event.response_type = XCB_CLIENT_MESSAGE;
            event.format = 32;
            event.window = window_;
            event.type = atom("WM_PROTOCOLS");
            event.data.data32[0] = atom("WM_DELETE_WINDOW");
            xcb_send_event(server, 0, window_, 0, reinterpret_cast<const char*>(&event));
        }
        // An answer, so that what was asked before it is done when the connection ends.
        std::free(xcb_get_input_focus_reply(server, xcb_get_input_focus(server), nullptr));
        xcb_disconnect(server);
    }

    const StudioEnd& row_;
    TemporaryFolder folder_;
    BoardAtPort board_{"uno"};
    std::unique_ptr<OwnDisplay> display_;
    QProcess child_;
    QByteArray output_;
    xcb_window_t window_ = 0;
};

// The long form (LUMORPH_LONG_TESTS=1) plays all of them.
TEST(StudioEnds, HoweverTheStudioEndsServosAreLetGoWithinASecond) {
    constexpr rlimit kNoCore{0, 0};
    ::setrlimit(RLIMIT_CORE, &kNoCore);
    constexpr std::size_t kAtOnce = 3;
    std::vector<std::unique_ptr<StudioEnding>> endings;
    const auto playAll = [&endings] {
        for (const auto& ending : endings) ending->play();
        endings.clear();
    };
    for (const StudioEnd& row : kStudioEnds) {
        if (!row.always && !longTests()) continue;
        endings.push_back(std::make_unique<StudioEnding>(row));
        if (endings.size() == kAtOnce) playAll();
    }
    playAll();
}

} // namespace
} // namespace lumorph::test
