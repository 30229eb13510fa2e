#pragma once

#include <cstdlib>
#include <memory>
#include <utility>

#include <QMouseEvent>

#include "tests/ui/studio_window.h"

/// The pictures of the Scene workspace, and the mouse over them.
namespace lumorph::test {

/// Ten moves of the pressed left button.
inline void dragMouse(QWidget* on, const QPointF& from, const QPointF& by, Qt::KeyboardModifiers held = {},
                      bool release = true) {
    const QPointF start = from.toPoint(); // where a press can be
    QTest::mousePress(on, Qt::LeftButton, held, start.toPoint());
    for (int step = 1; step <= 10; ++step) {
        const QPointF at = start + by * step / 10;
        QMouseEvent move(QEvent::MouseMove, at, on->mapToGlobal(at), Qt::NoButton, Qt::LeftButton, held);
        QApplication::sendEvent(on, &move);
    }
    if (release) QTest::mouseRelease(on, Qt::LeftButton, held, (start + by).toPoint());
}

/// Until nothing moves and the newest frame is there in full quality. Where drawing is fast every frame is, so it has
/// to stay the newest for a while.
[[nodiscard]] inline bool stageSettles(StudioWindow& window) {
    std::shared_ptr<const MatchFrame> last;
    return eventually([&] {
        const studio::DrawnShow& newest = window.studio().show.newest();
        if (!newest.still || newest.match != window.studio().loop.frame()) return false;
        if (std::exchange(last, newest.match) == newest.match) return true;
        pass(std::chrono::milliseconds(300));
        return false;
    });
}

/// Share of the pixels that differ clearly.
[[nodiscard]] inline double differingShare(const QImage& a, const QImage& b) {
    if (a.size() != b.size()) return 1.0;
    int count = 0;
    for (int y = 0; y < a.height(); ++y)
        for (int x = 0; x < a.width(); ++x) {
            const QRgb p = a.pixel(x, y), q = b.pixel(x, y);
            count += std::abs(qRed(p) - qRed(q)) + std::abs(qGreen(p) - qGreen(q)) + std::abs(qBlue(p) - qBlue(q)) > 24;
        }
    return static_cast<double>(count) / (a.width() * a.height());
}

} // namespace lumorph::test
