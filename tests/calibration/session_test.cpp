#include "calibration/stages/session.h"

#include <gtest/gtest.h>

#include "core/base/error.h"

// Where the calibration of a room stands without a window: what waits for what, what comes next, and what becomes of a
// result.

namespace lumorph {
namespace {

using How = StageStand::How;

const std::size_t kProjector = placeOfStage("projector"), kRoom = placeOfStage("room"), kLight = placeOfStage("light"),
                  kPointer = placeOfStage("pointer"), kTracker = placeOfStage("tracker"), kEye = placeOfStage("eye"),
                  kCheck = placeOfStage("verify");

Origin simulatedAt(const char* date) { return {Origin::Way::simulated, "8 swings", date}; }

/// A room whose projector was measured.
Installation measuredRoom() {
    Installation room = defaultInstallation();
    room.projectors.front().lens = room.projectors.front().pose = simulatedAt("2026-11-20T10:00:00Z");
    return room;
}

/// A pointer tip as a lab measured it, or as its coordinates were refused.
StageOutcome touched(const Installation& room, std::optional<Cause> refused = std::nullopt) {
    Registration found;
    found.installation = room;
    found.installation.pointerTip = {0.01F, -0.16F, 0.0F};
    found.installation.origins.pointer = simulatedAt("2026-11-20T11:00:00Z");
    found.fresh.points.assign(FreshCheck::kFewest, {});
    found.fresh.allowed = 0.001;
    if (refused) found.refusal = Finding{*refused, "", "", "they are mirrored", "set the tracker's axes"};
    StageOutcome outcome = outcomeOf(StageResult(std::move(found)), room);
    outcome.isSimulated = true;
    return outcome;
}

TEST(CalibrationSession, AFreshRoomBeginsWithWhatAllBuildsOn) {
    CalibrationSession session;
    session.follow(defaultInstallation());
    const struct {
        const char* stage;
        How how;
        const char* other; // empty: none
    } kRows[] = {{"projector", How::open, ""},         {"room", How::spare, ""},
                 {"light", How::waits, "projector"},   {"pointer", How::open, ""},
                 {"tracker", How::waits, "projector"}, {"body", How::waits, "pointer"},
                 {"eye", How::waits, "pointer"},       {"servos", How::waits, "projector"},
                 {"delays", How::waits, "tracker"},    {"verify", How::open, ""},
                 {"mirror", How::spare, ""},           {"device", How::spare, ""}};
    ASSERT_EQ(session.stands().size(), std::size(kRows));
    for (std::size_t k = 0; k < std::size(kRows); ++k) {
        const StageStand& stand = session.stands()[k];
        EXPECT_STREQ(calibrationStages()[k].key, kRows[k].stage);
        EXPECT_STREQ(keyOf(stand.how), keyOf(kRows[k].how)) << kRows[k].stage;
        EXPECT_STREQ(stand.other ? calibrationStages()[*stand.other].key : "", kRows[k].other) << kRows[k].stage;
    }
    EXPECT_EQ(session.next(), kProjector);
    EXPECT_EQ(whyNext(kProjector, session.stands()[kProjector]), "it was not measured yet");
    EXPECT_EQ(standText(session.stands()[kLight]), "after projector and camera");
    EXPECT_THROW((void)placeOfStage("nothing"), InvalidInput);
}

TEST(CalibrationSession, WhatBuildsOnAPointerFollowsIt) {
    Installation room = measuredRoom();
    room.origins.pointer = simulatedAt("2026-11-20T11:00:00Z");
    const std::vector<StageStand> stands = standsOf(room);
    EXPECT_EQ(stands[kPointer].how, How::simulated);
    EXPECT_EQ(standText(stands[kPointer]), "8 swings, 2026-11-20T11:00:00Z");
    EXPECT_EQ(stands[kTracker].how, How::open);
    EXPECT_EQ(stands[kEye].how, How::waits);
    EXPECT_EQ(stands[kEye].other, kTracker);
    EXPECT_EQ(nextStage(stands), kLight);
}

TEST(CalibrationSession, AMeasurementIsStaleOnceWhatItBuildsOnIsNewer) {
    Installation room = measuredRoom();
    room.origins.pointer = simulatedAt("2026-11-20T11:00:00Z");
    room.origins.tracker = simulatedAt("2026-11-20T10:30:00Z");
    const StageStand stand = standsOf(room)[kTracker];
    EXPECT_EQ(stand.how, How::stale);
    EXPECT_EQ(stand.other, kPointer);
    EXPECT_EQ(whyNext(kTracker, stand), "Pointer tip was measured after it");
    room.origins.tracker.way = Origin::Way::entered;
    EXPECT_EQ(standsOf(room)[kTracker].how, How::entered) << "whoever entered it answers for it";
}

TEST(CalibrationSession, SeveralProjectorsAreMeasuredTogether) {
    Installation room = defaultInstallation();
    room.projectors.push_back(room.projectors.front());
    const std::vector<StageStand> stands = standsOf(room);
    EXPECT_EQ(stands[kProjector].how, How::spare);
    EXPECT_EQ(stands[kProjector].other, kRoom);
    EXPECT_EQ(nextStage(stands), kRoom);
    EXPECT_EQ(stands[kLight].other, kRoom) << "what builds on one builds on all";
    room.projectors.back().enabled = false;
    EXPECT_EQ(nextStage(standsOf(room)), kProjector) << "one that is off is not there";
}

TEST(CalibrationSession, ACheckThatFindsAllWellIsTheLast) {
    const Installation room = measuredRoom();
    CalibrationSession session;
    VerifiedRoom check;
    check.installation = room;
    check.check.verdict = RoomCheck::Verdict::good;
    session.begin(kCheck);
    EXPECT_EQ(session.running(), kCheck);
    EXPECT_FALSE(session.take(kCheck, outcomeOf(StageResult(check), room), room));
    EXPECT_FALSE(session.running());
    EXPECT_EQ(session.stands()[kCheck].how, How::measured);
    EXPECT_TRUE(session.outcomeAt(kCheck)->isUsed) << "there is nothing to be changed";
    check.check.verdict = RoomCheck::Verdict::moved;
    (void)session.take(kCheck, outcomeOf(StageResult(check), room), room);
    EXPECT_EQ(session.stands()[kCheck].how, How::open);
    EXPECT_FALSE(session.mayUse(kCheck, room)) << "where it is not known what has moved nothing is put right";
}

TEST(CalibrationSession, ARefusedTrackerPutsTheMeasuredPointerInDoubt) {
    Installation room = measuredRoom();
    room.pointerTip = {0.01F, -0.16F, 0.0F};
    room.origins.pointer = simulatedAt("2026-11-20T11:00:00Z");
    CalibrationSession session;
    session.measureRest();
    for (const auto& [cause, isDoubted] :
         {std::pair(Cause::mirrored, true), {Cause::wrongUnits, true}, {Cause::tooFewPoints, false}}) {
        const auto doubted = session.take(kTracker, touched(room, cause), room);
        ASSERT_EQ(doubted.has_value(), isDoubted);
        EXPECT_FALSE(session.goesOn());
        EXPECT_FALSE(session.mayUse(kTracker, room));
        if (!doubted) continue;
        EXPECT_EQ(doubted->pointerTip, room.pointerTip) << "nobody has a better one";
        session.follow(*doubted);
        EXPECT_EQ(session.stands()[kPointer].how, How::open);
        EXPECT_EQ(standText(session.stands()[kPointer]).rfind("in doubt: ", 0), 0U);
    }
    EXPECT_FALSE(session.take(kEye, touched(room, Cause::mirrored), room)) << "only the tracker's dots tell";
    room.origins.pointer.way = Origin::Way::entered;
    EXPECT_FALSE(session.take(kTracker, touched(room, Cause::mirrored), room));
}

TEST(CalibrationSession, ALabsResultAsksBeforeItJoinsWhatWasMeasured) {
    Installation room = measuredRoom();
    CalibrationSession session;
    (void)session.take(kPointer, touched(room), room);
    EXPECT_TRUE(session.mayUse(kPointer, room)) << "all of it is simulated";
    room.origins.tracker = {Origin::Way::measured, "12 dots", "2026-11-20T09:00:00Z"};
    EXPECT_FALSE(session.mayUse(kPointer, room));
    EXPECT_EQ(session.asked().size(), 1U);
    session.withdrawQuestion();
    EXPECT_FALSE(session.mayUse(kPointer, room)) << "no answer was given";
    EXPECT_TRUE(session.mayUse(kPointer, room)) << "that was a yes";
    StageOutcome real = touched(room);
    real.isSimulated = false;
    room.origins.delays.way = Origin::Way::measured;
    (void)session.take(kPointer, std::move(real), room);
    EXPECT_TRUE(session.mayUse(kPointer, room)) << "what was measured joins what was measured";
}

TEST(CalibrationSession, AResultIsUsedOnceTheRoomHasItAndStays) {
    Installation room = measuredRoom();
    CalibrationSession session;
    (void)session.take(kPointer, touched(room), room);
    EXPECT_FALSE(session.outcomeAt(kPointer)->isUsed);
    calibrationStages()[kPointer].apply(roomOf(session.outcomeAt(kPointer)->result), room);
    session.follow(room);
    EXPECT_TRUE(session.outcomeAt(kPointer)->isUsed);
    session.forget(kPointer);
    EXPECT_TRUE(session.outcomeAt(kPointer)) << "it is still to be read";
    session.follow(measuredRoom());
    session.forget(kPointer);
    EXPECT_FALSE(session.outcomeAt(kPointer));
    session.begin(kPointer);
    session.fail(kPointer, "no tracker");
    EXPECT_FALSE(session.running());
    EXPECT_EQ(session.troubles().at(kPointer), "no tracker");
}

TEST(CalibrationSession, TheRestEndsWhereItWaitsAndWhereATurnCameToNothing) {
    const Installation room = measuredRoom();
    CalibrationSession session;
    session.follow(room);
    EXPECT_FALSE(session.nextOfRest()) << "nobody began it";
    session.measureRest();
    EXPECT_FALSE(session.nextOfRest([](std::size_t stage) { return stage == kLight; }));
    EXPECT_FALSE(session.goesOn());
    session.measureRest();
    EXPECT_EQ(session.nextOfRest(), kLight);
    EXPECT_FALSE(session.nextOfRest()) << "a stage has one turn, or an old recording would be solved for ever";
    session.measureRest();
    EXPECT_EQ(session.nextOfRest(), kLight);
    session.cancel();
    EXPECT_FALSE(session.nextOfRest());
}

} // namespace
} // namespace lumorph
