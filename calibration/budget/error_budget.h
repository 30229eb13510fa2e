#pragma once

#include <array>
#include <optional>
#include <vector>

#include "calibration/budget/carried_device.h"
#include "calibration/budget/room_errors.h"
#include "calibration/budget/slip_model.h"

/// Where the millimetres come from: how far a picture slips on the device, as the viewer sees it, with the errors of
/// all parts of a room, and what would help most.
namespace lumorph {

/// One part of a budget.
struct BudgetItem {
    BudgetPart part = BudgetPart::projector;
    ErrorSource source = ErrorSource::assumed;
    double metres = 0.0; ///< root mean square over the device, as it is alone
    double share = 0.0;  ///< of the sum of squares, in [0, 1]
};

/// What measuring a part again would do.
struct BudgetAdvice {
    BudgetPart part = BudgetPart::projector;
    bool isFirst = false; ///< it was not measured in the room yet; else, and where simulated, taken as half as large
    double before = 0.0, after = 0.0; ///< metres, of all together
};

/// A plain value.
struct ErrorBudget {
    std::array<BudgetItem, kBudgetParts> items; ///< in the order of BudgetPart
    double total = 0.0;                         ///< metres: of all together, the squares added
    /// False: the tracker was never placed in the room; its part is what is left when it is laid in by a ruler.
    bool isTrackerPlaced = true;
    bool isSimulated = false;         ///< a part is the virtual lab's: the sum says nothing of this room
    std::vector<BudgetAdvice> advice; ///< a tracker that was never placed, then what helps most; less than a
                                      ///< twentieth is left out
    std::size_t places = 0;           ///< of the device that count
    /// By which frames look less far ahead than they should, because poses are predicted by
    /// `PoseStream::kFarthestAhead` at most after they were measured; 0 where that suffices. It is counted in what
    /// prediction leaves.
    double cutSeconds = 0.0;
    double cutMetres = 0.0; ///< that the hand goes meanwhile

    [[nodiscard]] const BudgetItem& itemOf(BudgetPart part) const { return items[static_cast<std::size_t>(part)]; }
};

/// Adds up. `rig` is that of `model` and `errors`. Throws as `predictionLeaves`.
[[nodiscard]] ErrorBudget budgetOf(const Rig& rig, const SlipModel& model, const RoomErrors& errors,
                                   const CarryingHand& hand = {});

} // namespace lumorph
