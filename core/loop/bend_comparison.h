#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/loop/match_frame.h"
#include "core/motion/view_dependence.h"
#include "core/scene/show_frame.h"

namespace lumorph {

/// The device of one frame twice, to be seen beside each other: as it stands without view dependence, and bent for who
/// looks (R23; paper, Fig. 9). One thread at a time.
class BendComparison {
public:
    enum class Half { without, with };

    /// The frame `shown`, which was posed of `match`, with the device of that half. While a program compares
    /// (MatchFrame::comparesBend) both halves keep the shape that its servos follow, and the bend joins in by the
    /// larger stroke, as in the loop; else they are flat and bent alone. Without an eye or a rig it stays as it is.
    [[nodiscard]] ShowFrame half(const MatchFrame& match, ShowFrame shown, Half half);

private:
    [[nodiscard]] std::vector<double> strokes(const MatchFrame& match, const ShowFrame& shown, Half half);

    std::shared_ptr<const Rig> ruleRig_;
    std::optional<ViewRule> rule_; ///< of that rig: it takes tens of milliseconds to make
};

} // namespace lumorph
