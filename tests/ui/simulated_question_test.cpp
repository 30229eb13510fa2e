#include "app/studio/calibration/simulated_question.h"

#include <gtest/gtest.h>

#include "app/workspaces/scene/scene_words.h"
#include "core/scene/installation.h"

namespace lumorph::studio {
namespace {

TEST(SimulatedQuestion, IsAskedOnceForWhatTheRoomHolds) {
    SimulatedQuestion question;
    Installation room = defaultInstallation();
    room.origins.delays.way = Origin::Way::simulated;
    EXPECT_FALSE(question.asks(room)) << "nothing real is there";
    room.origins.tracker.way = Origin::Way::measured;
    EXPECT_TRUE(question.asks(room));
    question.withdraw();
    EXPECT_TRUE(question.asks(room)) << "no answer was given";
    ASSERT_EQ(question.asked().size(), 1U);
    EXPECT_TRUE(wordsOfQuestion(question.asked()).text.contains("tracker"));
    EXPECT_FALSE(question.asks(room)) << "that was a yes";
    EXPECT_TRUE(question.asked().empty());
    EXPECT_FALSE(question.asks(room)) << "which holds";
    room.origins.table.way = Origin::Way::entered;
    EXPECT_TRUE(question.asks(room)) << "it holds more now";
    room.origins.pointer.way = Origin::Way::measured;
    EXPECT_TRUE(question.asks(room)) << "it was asked about less";
}

TEST(OriginWords, WhatTheLabMadeIsNowhereCalledMeasured) {
    const Origin made{Origin::Way::simulated, "flat light, 40 photographs", "2026-11-28T10:00:00Z"};
    const QString words = originWords(made);
    EXPECT_TRUE(words.startsWith("simulated in the virtual lab (flat light, 40 photographs) on "))
        << words.toStdString();
    EXPECT_FALSE(words.contains("measured"));
    EXPECT_EQ(originWords({Origin::Way::simulated, {}, {}}), "simulated in the virtual lab");
}

} // namespace
} // namespace lumorph::studio
