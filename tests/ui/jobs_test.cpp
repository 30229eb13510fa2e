#include <atomic>
#include <thread>

#include <gtest/gtest.h>
#include <sys/resource.h>

#include "app/studio/base/jobs.h"
#include "core/base/error.h"
#include "tests/ui/event_loop.h"

namespace lumorph::studio {
namespace {

using test::eventually;

struct JobsTest : testing::Test {
    JobsTest() { test::needApplication(); }

    /// Runs until it is asked to stop.
    static int untilStopped(const Progress& progress) {
        while (!progress.cancelled()) std::this_thread::yield();
        throw Cancelled();
    }
    std::function<void(int)> give = [this](int value) { got.push_back(value); };
    std::function<void(const std::exception&)> tell = [this](const std::exception& error) {
        errors.emplace_back(error.what());
    };
    std::vector<int> got;
    std::vector<std::string> errors;
};

TEST_F(JobsTest, WorkRunsBesideTheWindowAndItsResultIsHandedOverInIt) {
    Jobs jobs;
    const std::thread::id window = std::this_thread::get_id();
    std::thread::id worked, handed;
    jobs.run<int>(
        "field", "Counting",
        [&](const Progress&) {
            worked = std::this_thread::get_id();
            return 42;
        },
        [&](int value) {
            handed = std::this_thread::get_id();
            got.push_back(value);
        },
        tell);
    ASSERT_TRUE(eventually([&] { return !got.empty(); }));
    EXPECT_EQ(got, std::vector{42});
    EXPECT_NE(worked, window);
    EXPECT_EQ(handed, window);
    EXPECT_TRUE(jobs.running().empty());
}

TEST_F(JobsTest, WorkGivesWayToTheWindow) {
    Jobs jobs;
    jobs.run<int>(
        "field", "Counting", [](const Progress&) { return ::getpriority(PRIO_PROCESS, 0); }, give, tell);
    ASSERT_TRUE(eventually([&] { return !got.empty(); }));
    EXPECT_GT(got.front(), ::getpriority(PRIO_PROCESS, 0));
}

TEST_F(JobsTest, WhatWasThrownIsHandedOver) {
    Jobs jobs;
    jobs.run<int>(
        "field", "Failing", [](const Progress&) -> int { throw DataError("a.mdf", "is broken", "choose another"); },
        give, tell);
    ASSERT_TRUE(eventually([&] { return jobs.running().empty(); }));
    EXPECT_EQ(errors, std::vector<std::string>{"a.mdf: is broken; choose another"});
    EXPECT_TRUE(got.empty());
}

TEST_F(JobsTest, AfterACancelNothingIsHandedOverEvenWhenTheWorkWasDone) {
    Jobs jobs;
    std::atomic<bool> done = false;
    const Jobs::Id id = jobs.run<int>(
        "field", "Quick",
        [&](const Progress&) {
            done = true;
            return 1;
        },
        give, tell);
    while (!done) std::this_thread::yield();
    int finished = 0;
    QObject::connect(&jobs, &Jobs::finished, [&] { ++finished; });
    jobs.cancel(id);
    jobs.cancel(id);
    EXPECT_TRUE(jobs.running().empty());
    test::pass(std::chrono::milliseconds(50));
    EXPECT_TRUE(got.empty());
    EXPECT_TRUE(errors.empty());
    EXPECT_EQ(finished, 1);
}

TEST_F(JobsTest, TheSameJobAgainTakesThePlaceOfTheOneThatRuns) {
    Jobs jobs;
    jobs.run<int>("field", "Building", untilStopped, give, tell);
    jobs.run<int>("target", "Building", untilStopped, give, tell);
    jobs.run<int>(
        "field", "Building", [](const Progress&) { return 2; }, give, tell);
    EXPECT_EQ(jobs.running().size(), 2U) << "the target's job is another one";
    ASSERT_TRUE(eventually([&] { return !got.empty(); }));
    EXPECT_EQ(got, std::vector{2});
    EXPECT_TRUE(errors.empty());
}

TEST_F(JobsTest, AJobMayCancelItselfAndStartOthersWhenItIsHandedOver) {
    Jobs jobs;
    Jobs::Id id = 0;
    id = jobs.run<int>(
        "field", "First", [](const Progress&) { return 1; },
        [&](int value) {
            got.push_back(value);
            jobs.cancel(id);
            jobs.run<int>(
                "field", "First", [](const Progress&) { return 2; }, give, tell);
        },
        tell);
    ASSERT_TRUE(eventually([&] { return got.size() == 2; }));
    EXPECT_EQ(got, (std::vector{1, 2}));
}

TEST_F(JobsTest, ProgressIsToldNotTooOftenAndTheNewestWordCounts) {
    Jobs jobs;
    std::atomic<bool> end = false;
    const Jobs::Id id = jobs.run<int>(
        "field", "Building",
        [&](const Progress& progress) {
            for (int i = 0; i < 10'000; ++i) progress.report(i / 20'000.0, "early");
            progress.report(0.5, "late");
            while (!end && !progress.cancelled()) std::this_thread::yield();
            return 1;
        },
        give, tell);
    int told = 0;
    QObject::connect(&jobs, &Jobs::progressed, [&](int which) { told += which == id; });
    const auto status = [&] { return jobs.running().front(); };
    ASSERT_TRUE(eventually([&] { return status().fraction == 0.5; }));
    EXPECT_EQ(status().stage, "late");
    EXPECT_EQ(status().title, "Building");
    EXPECT_EQ(status().place, "field");
    EXPECT_LT(told, 100);
    end = true;
    ASSERT_TRUE(eventually([&] { return !got.empty(); }));
}

TEST_F(JobsTest, TheEndCancelsAndWaits) {
    std::atomic<int> ended = 0;
    {
        Jobs jobs;
        for (int i = 0; i < 4; ++i)
            jobs.run<int>(
                "field", QString::number(i),
                [&](const Progress& progress) {
                    while (!progress.cancelled()) std::this_thread::yield();
                    ++ended;
                    return 1;
                },
                give, tell);
    }
    EXPECT_EQ(ended, 4);
    test::pass(std::chrono::milliseconds(20));
    EXPECT_TRUE(got.empty());
}

} // namespace
} // namespace lumorph::studio
