#include "app/studio/shell/stop_key_watch.h"

#include <atomic>
#include <cstdlib>
#include <thread>

#include <QTest>
#include <gtest/gtest.h>

namespace lumorph::studio {
namespace {

using std::chrono::milliseconds;

// Keys as a person's keyboard gives them, to whatever has the focus; here nothing has.
bool typeKeys(const std::string& keys) { return std::system(("xdotool " + keys).c_str()) == 0; }

/// Waits without an event loop: the window is stuck.
bool becomes(const std::atomic<int>& count, int wanted) {
    for (int i = 0; i < 100 && count != wanted; ++i) std::this_thread::sleep_for(milliseconds(20));
    return count == wanted;
}

TEST(StopKeyWatch, HearsEscTwiceWhileTheWindowIsStuckAndAnotherHasTheKeyboard) {
    std::atomic<int> count = 0;
    const studio::StopKeyWatch watch([&count] { ++count; });
    ASSERT_TRUE(watch.listens()) << watch.why().toStdString();
    ASSERT_TRUE(typeKeys("key Escape key Escape"));
    EXPECT_TRUE(becomes(count, 1));
    ASSERT_TRUE(typeKeys("key Escape key a key Escape key b"));
    std::this_thread::sleep_for(milliseconds(200));
    EXPECT_EQ(count, 1) << "another key came between";
}

TEST(StopKeyWatch, LeavesTheWindowAMomentToSayThatAPressClosedSomething) {
    std::atomic<int> count = 0;
    studio::StopKeyWatch watch([&count] { ++count; });
    ASSERT_TRUE(watch.listens()) << watch.why().toStdString();
    watch.setSomethingOpen(true);
    ASSERT_TRUE(typeKeys("key Escape key Escape"));
    EXPECT_TRUE(becomes(count, 1)) << "the window is stuck, and says nothing";
    // The first press closed something: the second is a first one.
    ASSERT_TRUE(typeKeys("key Escape"));
    std::this_thread::sleep_for(milliseconds(30));
    watch.forget();
    ASSERT_TRUE(typeKeys("key Escape"));
    std::this_thread::sleep_for(milliseconds(300));
    EXPECT_EQ(count, 1);
    ASSERT_TRUE(typeKeys("key a"));
    // The second did.
    ASSERT_TRUE(typeKeys("key Escape key Escape"));
    watch.forget();
    std::this_thread::sleep_for(milliseconds(300));
    EXPECT_EQ(count, 1);
}

TEST(StopKeyWatch, SaysWhyItCannotListen) {
    const QByteArray display = qgetenv("DISPLAY");
    qunsetenv("DISPLAY");
    const studio::StopKeyWatch watch([] {});
    qputenv("DISPLAY", display);
    EXPECT_FALSE(watch.listens());
    EXPECT_FALSE(watch.why().isEmpty());
}

} // namespace
} // namespace lumorph::studio
