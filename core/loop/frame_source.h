#pragma once

#include <memory>

#include "core/base/clock.h"

namespace lumorph {

struct MatchFrame;
struct MatchWish;

/// Frames that were made elsewhere, such as those of a recording. One thread at a time asks for them.
class FrameSource {
public:
    virtual ~FrameSource() = default;
    /// The frame to be seen at `now`, by the loop's clock, of the wish's rig; the same object while it is the same.
    [[nodiscard]] virtual std::shared_ptr<const MatchFrame> frame(const MatchWish& wish, Microseconds now) = 0;
    /// Whether it will be another one later.
    [[nodiscard]] virtual bool moves() const = 0;
};

} // namespace lumorph
