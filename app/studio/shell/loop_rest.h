#pragma once

#include "app/studio/shell/studio.h"

namespace lumorph::studio {

/// Pauses the loop while its frames have no reader: nothing of the window is seen, no view of the show is wanted (a
/// projector's window, the watch of the running show), no controller is connected, no recording runs, no tracker is
/// open, and no job runs that may need frames.
class LoopRest : public QObject {
    Q_OBJECT
public:
    /// `studio` outlives it.
    LoopRest(Studio& studio, QObject* parent);

    /// Whether somebody sees the window's views; at first they do.
    void setSeen(bool seen);

private:
    void follow();
    [[nodiscard]] bool isFollowed() const;

    Studio& studio_;
    bool seen_ = true;
};

} // namespace lumorph::studio
