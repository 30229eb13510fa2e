#pragma once

#include <QObject>
#include <QPointF>
#include <QSet>
#include <QWidget>

#include "app/studio/document/studio_loop.h"

namespace lumorph::studio {

/// Hands what is done to a view on to the application that shows: where the pointer stands over it as `pointer.x` and
/// `pointer.y`, -1 to 1 from its middle (`pointer.over` 0 once it leaves), and keys as `key.left`, `key.right`,
/// `key.up`, `key.down`, `key.restart` (R), `key.next` (N) and `key.attract` (A). Where none shows, the view keeps its
/// own keys.
class ProgramInputs : public QObject {
    Q_OBJECT
public:
    /// Belongs to the view; `loop` outlives it.
    ProgramInputs(StudioLoop& loop, QWidget& view);

protected:
    bool eventFilter(QObject* watched, QEvent* event) override;

private:
    void point(const QPointF& at);
    void letGo();
    bool press(int key, bool down);

    StudioLoop& loop_;
    QWidget& view_;
    QSet<int> held_;
    bool pointed_ = false;
};

} // namespace lumorph::studio
