#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "calibration/stages/simulated_question.h"
#include "calibration/stages/stage.h"

/// Where the calibration of a room stands, what comes next and why, and what was measured but is not in the room yet:
/// one for window and command line. A stage is known by its place among `calibrationStages`.
namespace lumorph {

/// The last check that found all well. A room does not hold it.
struct LastCheck {
    std::string date; ///< ISO 8601 in UTC; empty: there was none
    bool isSimulated = false;
};

/// Where a stage stands in a room.
struct StageStand {
    enum class How {
        open,    ///< never measured, or in doubt
        waits,   ///< what it needs was not measured yet
        entered, ///< by hand
        measured,
        simulated, ///< by the virtual lab, or with simulated devices
        spare,     ///< not needed in this room, or another stage measures the same
        stale      ///< something that it builds on was measured later
    };
    How how = How::open;
    /// What it waits for, what was measured after it, or what measures the same; else empty.
    std::optional<std::size_t> other;
    Origin origin; ///< of what the room has; of a check: the last
    bool operator==(const StageStand&) const = default;
};
/// "open", "waits" and so on.
[[nodiscard]] const char* keyOf(StageStand::How how) noexcept;
/// In a few words, such as "8 alignments, 2026-11-26T14:05:00Z" or "after pointer tip"; may be empty. `dateText` writes
/// dates in another way.
[[nodiscard]] std::string standText(const StageStand& stand,
                                    std::string (*dateText)(const std::string& date) = nullptr);

/// By stages.
[[nodiscard]] std::vector<StageStand> standsOf(const Installation& room, const LastCheck& checked = {});
/// The first that can be measured and should be; empty: all are.
[[nodiscard]] std::optional<std::size_t> nextStage(const std::vector<StageStand>& stands);
/// Why it should be, in a few words.
[[nodiscard]] std::string whyNext(std::size_t stage, const StageStand& stand);

/// What the measurement of a stage came to.
struct StageOutcome {
    StageResult result;
    std::shared_ptr<const StageRecording> recording; ///< that it was made of; null: of other files
    bool isGood = false;                             ///< it may be used; a check: nothing has moved
    bool changesRoom = false; ///< it has figures for the room; else it was refused, or nothing is to be changed
    bool isSimulated = false; ///< made in the virtual lab, or with simulated devices
    bool isUsed = false;      ///< the room has it
};
/// `believed`: the room in which it was measured.
[[nodiscard]] StageOutcome outcomeOf(StageResult result, const Installation& believed);
[[nodiscard]] StageOutcome outcomeOf(MeasuredStage measured, const Installation& believed);

/// Measures one stage at a time: its owner runs what is begun, hands over what that came to, and changes the room.
class CalibrationSession {
public:
    [[nodiscard]] const std::vector<StageStand>& stands() const noexcept { return stands_; }
    [[nodiscard]] std::optional<std::size_t> next() const { return nextStage(stands_); }
    [[nodiscard]] std::optional<std::size_t> running() const noexcept { return running_; }
    /// By stages; one that is used stays to be read.
    [[nodiscard]] const std::map<std::size_t, StageOutcome>& outcomes() const noexcept { return outcomes_; }
    [[nodiscard]] const StageOutcome* outcomeAt(std::size_t stage) const;
    /// Why a measurement came to nothing, by stages.
    [[nodiscard]] const std::map<std::size_t, std::string>& troubles() const noexcept { return troubles_; }
    /// The rest follows by itself.
    [[nodiscard]] bool goesOn() const noexcept { return goesOn_; }
    /// What the room holds, while `mayUse` asks; else empty.
    [[nodiscard]] const std::vector<std::string>& asked() const noexcept { return question_.asked(); }

    /// After each change of the room.
    void follow(const Installation& room);
    /// What came of the stage before goes. Only while none is running.
    void begin(std::size_t stage);
    /// The room with the pointer in doubt, where the result says that it was measured in wrong coordinates; else empty.
    /// With a result that is not good the rest ends.
    [[nodiscard]] std::optional<Installation> take(std::size_t stage, StageOutcome outcome, const Installation& room);
    /// It came to nothing, and the rest ends. Without words: it was cancelled.
    void fail(std::size_t stage, std::string why);
    void cancel();
    /// Whether the room may have what was measured: false where there is nothing, where it was refused, and where a
    /// lab's result would join what was measured or entered: that is asked first, and the next call is the yes.
    [[nodiscard]] bool mayUse(std::size_t stage, const Installation& room);
    void withdrawQuestion() { question_.withdraw(); }
    /// What came of it before, unless the room has it.
    void forget(std::size_t stage);

    /// All that is open or stale, in turn, each used when it is good.
    void measureRest();
    void endRest() { goesOn_ = false; }
    /// The stage whose turn it is; empty, and the rest has ended, where it waits for the user, where all are measured,
    /// and where it had its turn and is still open or stale, as by a recording from before.
    [[nodiscard]] std::optional<std::size_t>
    nextOfRest(const std::function<bool(std::size_t stage)>& waitsForUser = {});

private:
    std::vector<StageStand> stands_ = standsOf({});
    std::optional<std::size_t> running_;
    std::map<std::size_t, StageOutcome> outcomes_;
    std::map<std::size_t, std::string> troubles_;
    LastCheck checked_;
    SimulatedQuestion question_;
    bool goesOn_ = false;
    std::set<std::size_t> hadTurn_;
};

} // namespace lumorph
