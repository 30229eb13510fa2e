#pragma once

#include <vector>

#include <QString>

#include "app/studio/document/studio_document.h"
#include "app/studio/document/studio_loop.h"

namespace lumorph::studio {

/// Whether a frame shows the device of a state: a frame that was begun before an edit may come after it.
[[nodiscard]] bool isOf(const MatchFrame& frame, const StudioState& state);

/// Moves actuators by hand. Whoever takes an actuator becomes the driver of all, in the same step of undo; the
/// other actuators stay where they are asked to be at that moment. Lives in the window's thread.
class HandControl {
public:
    HandControl(StudioDocument& document, StudioLoop& loop) : document_(document), loop_(loop) {}

    /// What the actuators are asked for now, one stroke each.
    [[nodiscard]] std::vector<double> strokes() const;
    /// During a drag: shown at once, one step of undo when it is committed.
    void preview(std::size_t actuator, double stroke);
    void commit(std::size_t actuator, double stroke);
    void cancel() { document_.cancelPreview(); }
    /// All actuators, in one step of undo called `what`.
    void moveAll(const QString& what, std::vector<double> strokes);

private:
    [[nodiscard]] QString nameOf(std::size_t actuator) const;

    StudioDocument& document_;
    StudioLoop& loop_;
    std::vector<double> base_; ///< where a drag began
};

} // namespace lumorph::studio
