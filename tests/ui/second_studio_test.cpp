#include <csignal>

#include <QLabel>
#include <QPushButton>
#include <sys/wait.h>
#include <unistd.h>

#include "app/studio/base/folder_lock.h"
#include "app/studio/document/scene_edit.h"
#include "core/scene/installation_store.h"
#include "tests/ui/studio_window.h"

// Two studios of one user: which of them has the sessions, the settings and the room.

namespace lumorph::test {
namespace {

using studio::FolderLock;
using namespace std::chrono_literals;

TEST(FolderLock, OfTwoProgramsOneHasItUntilItIsKilled) {
    const TemporaryFolder folder;
    const std::filesystem::path file = folder / "home/lock";
    std::array<int, 2> pipe{};
    ASSERT_EQ(::pipe(pipe.data()), 0);
    const pid_t child = ::fork();
    if (child == 0) { // nothing but system calls: threads of the parent do not exist here
        FolderLock lock(file);
        const char held = lock.tryLock() ? 'y' : 'n';
        (void)!::write(pipe[1], &held, 1);
        for (;;) ::pause();
    }
    char held = 0;
    ASSERT_EQ(::read(pipe[0], &held, 1), 1);
    EXPECT_EQ(held, 'y');
    FolderLock lock(file);
    EXPECT_FALSE(lock.tryLock());
    ASSERT_TRUE(lock.since());
    EXPECT_LT(std::abs(lock.since()->secsTo(QDateTime::currentDateTimeUtc())), 60);
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    EXPECT_TRUE(lock.tryLock());
    EXPECT_FALSE(FolderLock(file).tryLock());
    // Who removes the folder of a lock does not leave two of them that are held.
    FolderLock late(file);
    std::filesystem::remove_all(folder / "home");
    EXPECT_TRUE(late.tryLock());
    for (const int end : pipe) ::close(end);
}

QString homeNotice(StudioWindow& window) {
    for (const studio::Notice& notice : window.studio().notices.at("home"))
        if (notice.subject.contains("Lumorph")) return notice.subject + ": " + notice.why;
    return {};
}

TEST(SecondStudioWindow, SaysWhatItMeansAndTakesOver) {
    const TemporaryFolder folder;
    const std::filesystem::path config = studio::Settings().folder();
    studio::Settings().setTheme(Theme::dark);
    std::filesystem::remove_all(config / "installation");
    InstallationStore store(config / "installation");
    store.keep(defaultInstallation());
    const auto kept = [&] { return store.load()->tableSize.x; };
    const float before = kept();
    FolderLock room(config / "lock"), session(folder / "session/lock");
    ASSERT_TRUE(room.tryLock() && session.tryLock());
    StudioWindow window{folder / "session", "scene"};
    EXPECT_TRUE(homeNotice(window).contains("This window keeps a session of its own"))
        << homeNotice(window).toStdString();
    EXPECT_TRUE(homeNotice(window).contains("read only"));
    EXPECT_NE(window.find<QPushButton>("status.second"), nullptr);
    window.screenshot("second");
    window.studio().settings.setTheme(Theme::light);
    EXPECT_EQ(window.studio().settings.theme(), Theme::light) << "in this window it counts";
    EXPECT_EQ(studio::Settings().theme(), Theme::dark);
    studio::editInstallation(window.studio().document, "Widen the table",
                             [](Installation& installation) { installation.tableSize.x = 2.5F; });
    EXPECT_TRUE(eventually([&] {
        const auto all = window.studio().notices.at("home");
        return std::ranges::any_of(all, [](const auto& one) { return one.why.contains("in this window alone"); });
    }));
    EXPECT_EQ(kept(), before);
    InstallationVersion version;
    version.title = "measured in the second window";
    version.installation = *window.state().installation;
    EXPECT_FALSE(window.studio().room.takeVersion(version));
    EXPECT_TRUE(store.versions().empty());
    // The first ends.
    room.release();
    session.release();
    EXPECT_TRUE(eventually([&] { return homeNotice(window).contains("taken over"); }));
    EXPECT_EQ(window.findNow<QPushButton>("status.second"), nullptr);
    EXPECT_EQ(studio::Settings().theme(), Theme::light);
    EXPECT_EQ(window.state().installation->tableSize.x, before) << "the room's own";
    EXPECT_TRUE(eventually([&] { return std::filesystem::exists(folder / "session/1/session.lumorph"); }));
    window.screenshot("second-took-over");
    studio::Settings().setTheme(Theme::dark);
}

} // namespace
} // namespace lumorph::test
