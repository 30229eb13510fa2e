#pragma once

#include <QMouseEvent>
#include <QObject>
#include <QPointF>
#include <QSet>
#include <QWidget>

#include "app/studio/document/studio_loop.h"

namespace lumorph::studio {

/// Hands what is done to a view on to the application that shows: where the pointer stands over it as `pointer.x` and
/// `pointer.y`, -1 to 1 from its middle (`pointer.over` 0 once it leaves), `pointer.held` while visitors press, `wheel`
/// in notches, and keys as `key.left`, `key.right`, `key.up`, `key.down`, `key.restart` (R), `key.next` (N),
/// `key.attract` (A), `key.off` (O) and `key.0` to `key.9`. Where none shows, the view keeps its own keys.
class ProgramInputs : public QObject {
    Q_OBJECT
public:
    /// Belongs to the view; `loop` outlives it.
    ProgramInputs(StudioLoop& loop, QWidget& view);

    /// Visitors stand before the view: pressing and touching are pointing, too, and nothing leads the eye around.
    void setForVisitors(bool on) { forVisitors_ = on; }

protected:
    bool eventFilter(QObject* watched, QEvent* event) override;

private:
    [[nodiscard]] bool pointByPress(const QEvent& event);
    void point(const QPointF& at);
    void letGo();
    bool press(int key, bool down);

    StudioLoop& loop_;
    QWidget& view_;
    QSet<int> held_;
    bool pointed_ = false;
    bool forVisitors_ = false;
};

/// Whether an application may have that key.
[[nodiscard]] bool isProgramKey(int key);
/// Whether the view itself has that key of visitors: B the bare device, L the light.
[[nodiscard]] bool isViewKey(int key);
/// Whether a view hands on to applications what is done to it.
[[nodiscard]] bool takesProgramInputs(const QObject& view);

} // namespace lumorph::studio
