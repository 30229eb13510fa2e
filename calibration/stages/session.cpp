#include "calibration/stages/session.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "calibration/verify/room_verification.h"
#include "core/base/text.h"

namespace lumorph {
namespace {

using How = StageStand::How;

bool isWantedIn(const CalibrationStage& stage, const Installation& room) {
    return !stage.isWanted || stage.isWanted(room);
}

/// Where several projectors are measured together, what builds on one of them builds on that.
std::size_t needIn(std::size_t need, const Installation& room) {
    const std::size_t together = placeOfStage("room");
    const bool isTogether = need == placeOfStage("projector") && isWantedIn(calibrationStages()[together], room);
    return isTogether ? together : need;
}

/// Alone, whatever those before it are.
StageStand ownStand(const CalibrationStage& stage, const Installation& room, const LastCheck& checked) {
    StageStand stand;
    if (!stage.isCheck()) {
        if (const Origin* origin = stage.origin(room)) stand.origin = *origin;
    } else if (!checked.date.empty()) {
        stand.origin = {checked.isSimulated ? Origin::Way::simulated : Origin::Way::measured, "still good",
                        checked.date};
    }
    if (stand.origin.way == Origin::Way::entered)
        stand.how = How::entered;
    else if (stand.origin.isCalibrated())
        stand.how = stand.origin.way == Origin::Way::simulated ? How::simulated : How::measured;
    return stand;
}

/// Figures that its room would get.
bool changesRoom(const StageResult& result, const Installation& believed) {
    if (std::holds_alternative<ServoMeasurement>(result)) return isGood(result);
    if (!std::holds_alternative<VerifiedRoom>(result)) return !refusalOf(result);
    // Where it is not known what has moved there is nothing to be put right.
    Installation with = believed;
    takeCorrections(roomOf(result), with);
    return with != believed;
}

/// Refused because the tracker's coordinates are mirrored or in another unit: what was measured by the same tracker
/// before is as wrong, though it fits itself.
bool doubtsTracker(const StageResult& result) {
    const std::optional<Finding> refusal = refusalOf(result);
    return refusal && (refusal->cause == Cause::mirrored || refusal->cause == Cause::wrongUnits);
}

} // namespace

const char* keyOf(StageStand::How how) noexcept {
    constexpr const char* kKeys[] = {"open", "waits", "entered", "measured", "simulated", "spare", "stale"};
    return kKeys[static_cast<std::size_t>(how)];
}

std::string standText(const StageStand& stand, std::string (*dateText)(const std::string& date)) {
    const auto title = [&stand] { return std::string(calibrationStages()[stand.other.value()].title); };
    switch (stand.how) {
    case How::open: // what was put in doubt says why
        return stand.origin.method;
    case How::waits:
        return "after " + lowerCase(title());
    case How::entered:
        return "entered by hand";
    case How::spare:
        return stand.other ? "one alone; the next measures all together" : "";
    case How::stale:
        return title() + " was measured after it";
    default:
        break;
    }
    const std::string date = dateText ? dateText(stand.origin.date) : stand.origin.date;
    return stand.origin.method + (stand.origin.method.empty() || date.empty() ? "" : ", ") + date;
}

std::vector<StageStand> standsOf(const Installation& room, const LastCheck& checked) {
    const auto& stages = calibrationStages();
    std::vector<StageStand> stands(stages.size());
    for (std::size_t k = 0; k < stages.size(); ++k) stands[k] = ownStand(stages[k], room, checked);
    for (std::size_t k = 0; k < stages.size(); ++k) {
        StageStand& stand = stands[k];
        if (const std::size_t same = needIn(k, room); stand.how == How::open && same != k) {
            stand.how = How::spare;
            stand.other = same;
        }
        if (!isWantedIn(stages[k], room)) {
            // The place of one projector alone says nothing of several.
            if (stand.how == How::open || k == placeOfStage("room")) stand.how = How::spare;
            continue;
        }
        for (const std::string_view key : stages[k].needs) {
            const std::size_t need = needIn(placeOfStage(key), room);
            const StageStand& before = stands[need];
            if (stand.how == How::open && (before.how == How::open || before.how == How::waits)) {
                stand.how = How::waits;
                stand.other = need;
            } else if ((stand.how == How::measured || stand.how == How::simulated) && before.origin.isCalibrated() &&
                       before.origin.date > stand.origin.date) { // dates of one form are in the order of their texts
                stand.how = How::stale;
                stand.other = need;
            }
        }
    }
    return stands;
}

std::optional<std::size_t> nextStage(const std::vector<StageStand>& stands) {
    const auto found = std::ranges::find_if(
        stands, [](const StageStand& stand) { return stand.how == How::open || stand.how == How::stale; });
    if (found == stands.end()) return std::nullopt;
    return static_cast<std::size_t>(found - stands.begin());
}

std::string whyNext(std::size_t stage, const StageStand& stand) {
    std::string known = standText(stand);
    if (!known.empty()) return known;
    return calibrationStages()[stage].isCheck() ? "nothing was checked since" : "it was not measured yet";
}

StageOutcome outcomeOf(StageResult result, const Installation& believed) {
    StageOutcome outcome;
    outcome.isGood = isGood(result);
    outcome.changesRoom = changesRoom(result, believed);
    outcome.result = std::move(result);
    return outcome;
}

StageOutcome outcomeOf(MeasuredStage measured, const Installation& believed) {
    StageOutcome outcome = outcomeOf(std::move(measured.result), believed);
    outcome.isSimulated = measured.recording.source.isSimulated();
    outcome.recording = std::make_shared<const StageRecording>(std::move(measured.recording));
    return outcome;
}

const StageOutcome* CalibrationSession::outcomeAt(std::size_t stage) const {
    const auto found = outcomes_.find(stage);
    return found == outcomes_.end() ? nullptr : &found->second;
}

void CalibrationSession::follow(const Installation& room) {
    stands_ = standsOf(room, checked_);
    for (auto& [stage, outcome] : outcomes_) {
        outcome.isUsed = outcome.isGood;
        if (!outcome.changesRoom) continue;
        Installation with = room;
        calibrationStages()[stage].apply(roomOf(outcome.result), with);
        outcome.isUsed = with == room;
    }
}

void CalibrationSession::begin(std::size_t stage) {
    withdrawQuestion();
    running_ = stage;
    outcomes_.erase(stage);
    troubles_.erase(stage);
}

std::optional<Installation> CalibrationSession::take(std::size_t stage, StageOutcome outcome,
                                                     const Installation& room) {
    running_.reset();
    goesOn_ = goesOn_ && outcome.isGood;
    if (calibrationStages()[stage].isCheck())
        checked_ = {outcome.isGood ? utcDate() : std::string(), outcome.isSimulated};
    const bool isInDoubt =
        stage == placeOfStage("tracker") && doubtsTracker(outcome.result) && room.origins.pointer.isCalibrated();
    outcomes_[stage] = std::move(outcome);
    follow(room);
    if (!isInDoubt) return std::nullopt;
    // Swings in a mirrored or wrongly scaled world fit a tip as well as true ones: only the tracker's dots tell. So the
    // tip that was measured before does not stay as good; its figure stays, because there is no better one.
    outcomes_.erase(placeOfStage("pointer"));
    Installation doubted = room;
    doubted.origins.pointer = {
        Origin::Way::assumed,
        "in doubt: it was measured in coordinates that the tracker link refused; measure it again", ""};
    return doubted;
}

void CalibrationSession::fail(std::size_t stage, std::string why) {
    cancel();
    if (!why.empty()) troubles_[stage] = std::move(why);
}

void CalibrationSession::cancel() {
    goesOn_ = false;
    running_.reset();
}

bool CalibrationSession::mayUse(std::size_t stage, const Installation& room) {
    const StageOutcome* outcome = outcomeAt(stage);
    if (!outcome || !outcome->changesRoom) return outcome && outcome->isGood;
    return !outcome->isSimulated || !question_.asks(room);
}

void CalibrationSession::forget(std::size_t stage) {
    withdrawQuestion();
    troubles_.erase(stage);
    if (const StageOutcome* outcome = outcomeAt(stage); outcome && !outcome->isUsed) outcomes_.erase(stage);
}

void CalibrationSession::measureRest() {
    goesOn_ = true;
    hadTurn_.clear();
}

std::optional<std::size_t> CalibrationSession::nextOfRest(const std::function<bool(std::size_t stage)>& waitsForUser) {
    const std::optional<std::size_t> turn = next();
    goesOn_ = goesOn_ && turn && !(waitsForUser && waitsForUser(*turn)) && hadTurn_.insert(*turn).second;
    return goesOn_ ? turn : std::nullopt;
}

} // namespace lumorph
