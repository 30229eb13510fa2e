#pragma once

#include <chrono>
#include <functional>

#include <QCoreApplication>
#include <QElapsedTimer>
#include <QEventLoop>
#include <QTimer>

namespace lumorph::test {

/// Timers and queued calls need an application; the first to ask makes one where the program has none.
inline void needApplication() {
    if (QCoreApplication::instance()) return;
    static int count = 1;
    static char name[] = "test";
    static char* arguments[] = {name, nullptr};
    static const QCoreApplication application(count, arguments);
}

/// Lets events run until a condition holds; false when it never did.
[[nodiscard]] inline bool eventually(const std::function<bool()>& holds,
                                     std::chrono::milliseconds patience = std::chrono::seconds(60)) {
    QElapsedTimer since;
    since.start();
    // processEvents with a time limit does not wait, it turns round and round: a core for each waiting test.
    QTimer wake;
    wake.start(5);
    while (true) {
        const qint64 begun = since.nsecsElapsed();
        if (holds()) return true;
        const qint64 ended = since.nsecsElapsed();
        if (ended / 1000000 > patience.count()) return false;
        // A look at all widgets takes long beside an event: looking takes a tenth of the time at most.
        const qint64 next = ended + 9 * (ended - begun);
        do QCoreApplication::processEvents(QEventLoop::AllEvents | QEventLoop::WaitForMoreEvents);
        while (since.nsecsElapsed() < next);
    }
}

/// Lets events run for a while, to see that something does not happen.
inline void pass(std::chrono::milliseconds time) {
    (void)eventually([] { return false; }, time);
}

} // namespace lumorph::test
