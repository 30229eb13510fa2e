#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "calibration/registration/hand_eye.h"
#include "calibration/registration/pose_file.h"
#include "tests/calibration/tracked_motion.h"
#include "tests/support/long_tests.h"

// Recordings of two joined bodies as people bring them, made wrong by name in one way each, against the known truth:
// what can be read is read and said, what cannot is refused by its cause.

namespace lumorph {
namespace {

constexpr double kPerRadian = 180.0 / 3.14159265358979;

struct Row {
    double time = 0.0;
    Pose pose;
};
using Rows = std::vector<Row>;

/// Both recordings as numbers, and how they are written.
struct Files {
    Rows a, b;
    bool wFirstA = false, wFirstB = false;
    double lengthA = 1.0, lengthB = 1.0;
};

std::string written(const Rows& rows, bool wFirst, double length) {
    std::string text;
    for (const Row& row : rows) {
        const glm::dvec3 p = length * row.pose.position;
        const glm::dquat& q = row.pose.rotation;
        const std::array<double, 4> turn = wFirst ? std::array{q.w, q.x, q.y, q.z} : std::array{q.x, q.y, q.z, q.w};
        std::array<char, 240> line{};
        std::snprintf(line.data(), line.size(), "%.6f,%.6f,%.6f,%.6f,%.6f,%.6f,%.6f,%.6f\n", row.time, p.x, p.y, p.z,
                      turn[0], turn[1], turn[2], turn[3]);
        text += line.data();
    }
    return text;
}

/// The truth of one seed.
struct JoinedBodies {
    Pose bFromA, worldBFromWorldA;
    double offset = 0.0;
    std::function<Pose(double)> motion; ///< worldAFromA at A's time

    explicit JoinedBodies(unsigned seed) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> one(-1.0, 1.0);
        const auto vector = [&] { return glm::dvec3(one(random), one(random), one(random)); };
        bFromA = {0.1 * vector() + glm::dvec3(0.08, 0.0, 0.05), rotationOfTurn(1.7 * vector())};
        worldBFromWorldA = {2.0 * vector() + glm::dvec3(1.5, 0.0, 0.0), rotationOfTurn(1.7 * vector())};
        offset = 0.4 * one(random);
        const test::HandMotion hand(seed + 40'000);
        motion = [hand](double t) { return hand.at(t); };
    }
    [[nodiscard]] Files files(unsigned seed, double seconds = 30.0) const {
        Files files;
        for (const TimedPose& at : test::trackOf(motion, seconds, 100.0, seed).poses)
            files.a.push_back({at.seconds, at.pose});
        const auto other = [this](double t) { return worldBFromWorldA * motion(t - offset) * inverseOf(bFromA); };
        for (const TimedPose& at : test::trackOf(other, seconds, 40.0, seed + 1).poses)
            files.b.push_back({at.seconds, at.pose});
        return files;
    }
};

using Motion = std::function<Pose(double)>;

/// Moves for half of the time (or a fifth of it), rests for the other.
Motion stopAndGo(const Motion& motion, double moving) {
    return [motion, moving](double t) {
        constexpr double kCycle = 4.0, kWholeTurn = 6.283185307179586;
        const double cycle = std::floor(t / kCycle), share = std::min(1.0, (t - kCycle * cycle) / (moving * kCycle));
        return motion(2.0 * (cycle + share - std::sin(kWholeTurn * share) / kWholeTurn));
    };
}

Motion inPlace(const Motion& motion, const glm::dvec3& pivot) {
    return [motion, pivot](double t) {
        const glm::dquat turn = motion(t).rotation;
        return Pose{glm::dvec3(0.3, 1.2, 0.4) - turn * pivot, turn};
    };
}

void invert(Rows& rows) {
    for (Row& row : rows) row.pose = inverseOf(row.pose);
}
void scaleTimes(Rows& rows, double factor) {
    for (Row& row : rows) row.time *= factor;
}
void countFrames(Rows& rows) {
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i].time = double(i + 17);
}
/// Each seventh row is written three rows late.
void writeLate(Rows& rows) {
    for (std::size_t i = 0; i + 3 < rows.size(); i += 7)
        std::rotate(rows.begin() + std::ptrdiff_t(i), rows.begin() + std::ptrdiff_t(i) + 1,
                    rows.begin() + std::ptrdiff_t(i) + 4);
}
/// Two programs write turn by turn what they gathered for half a second.
void writeInBlocks(Rows& rows) {
    Rows blocks;
    for (std::size_t from = 0; from < rows.size(); from += 50)
        for (const std::size_t odd : {0U, 1U})
            for (std::size_t i = from + odd; i < std::min(from + 50, rows.size()); i += 2) blocks.push_back(rows[i]);
    rows = blocks;
}
void writeTwice(Rows& rows, std::size_t later) {
    Rows twice;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        twice.push_back(rows[i]);
        if (i >= later) twice.push_back(rows[i - later]);
    }
    rows = twice;
}

struct Kind {
    const char* name;
    /// Of the warning by which it is solved, or of the refusal; "" where nothing is to be said.
    const char* key;
    bool solved;
    std::function<void(Files&)> spoil;
    std::function<void(JoinedBodies&)> move = {};
};

std::vector<Kind> allKinds() {
    const auto rests = [](double moving) {
        return [moving](JoinedBodies& bodies) { bodies.motion = stopAndGo(bodies.motion, moving); };
    };
    const auto aInPlace = [](JoinedBodies& bodies) { bodies.motion = inPlace(bodies.motion, glm::dvec3(0.0)); };
    const auto bInPlace = [](JoinedBodies& bodies) {
        bodies.motion = inPlace(bodies.motion, inverseOf(bodies.bFromA).position);
    };
    const auto nothing = [](Files&) {};
    return {
        {"clean", "", true, nothing},
        {"stop and go", "", true, nothing, rests(0.5)},
        {"mostly rests", "", true, nothing, rests(0.2)},
        {"rows late in A", "rows_out_of_order", true, [](Files& f) { writeLate(f.a); }},
        {"rows late in B", "rows_out_of_order", true, [](Files& f) { writeLate(f.b); }},
        {"blocks of two writers", "rows_out_of_order", true, [](Files& f) { writeInBlocks(f.a); }},
        {"a second writer is 30 ms behind", "rows_out_of_order", true,
         [](Files& f) {
             for (std::size_t i = 1; i < f.a.size(); i += 2) f.a[i].time -= 0.03;
         }},
        {"rows twice", "doubled_rows", true, [](Files& f) { writeTwice(f.a, 0); }},
        {"rows twice, the second later", "doubled_rows", true, [](Files& f) { writeTwice(f.b, 2); }},
        {"A in ms", "time_unit", true, [](Files& f) { scaleTimes(f.a, 1e3); }},
        {"B in ms", "time_unit", true, [](Files& f) { scaleTimes(f.b, 1e3); }},
        {"both in ms", "time_unit", true, [](Files& f) { scaleTimes(f.a, 1e3), scaleTimes(f.b, 1e3); }},
        {"A in us", "time_unit", true, [](Files& f) { scaleTimes(f.a, 1e6); }},
        {"both in us", "time_unit", true, [](Files& f) { scaleTimes(f.a, 1e6), scaleTimes(f.b, 1e6); }},
        {"B in ns", "time_unit", true, [](Files& f) { scaleTimes(f.b, 1e9); }},
        {"ms, rows late", "rows_out_of_order", true, [](Files& f) { writeLate(f.a), scaleTimes(f.a, 1e3); }},
        {"A in frames", "time_unit", true, [](Files& f) { countFrames(f.a); }},
        {"B in frames", "time_unit", true, [](Files& f) { countFrames(f.b); }},
        {"both in frames", "time_unit", false, [](Files& f) { countFrames(f.a), countFrames(f.b); }},
        {"A w first", "quaternion_order", true, [](Files& f) { f.wFirstA = true; }},
        {"B w first", "quaternion_order", true, [](Files& f) { f.wFirstB = true; }},
        {"both w first", "quaternion_order", true, [](Files& f) { f.wFirstA = f.wFirstB = true; }},
        {"A w first, in ms", "quaternion_order", true, [](Files& f) { f.wFirstA = true, scaleTimes(f.a, 1e3); }},
        {"A inverted", "inverted", false, [](Files& f) { invert(f.a); }},
        {"B inverted", "inverted", false, [](Files& f) { invert(f.b); }},
        {"A inverted, w first", "inverted", false, [](Files& f) { invert(f.a), f.wFirstA = true; }},
        {"B inverted, A w first", "inverted", false, [](Files& f) { invert(f.b), f.wFirstA = true; }},
        {"A turns in place", "turns_in_place", true, nothing, aInPlace},
        {"B turns in place", "turns_in_place", true, nothing, bInPlace},
        {"B in feet", "wrong_units", false, [](Files& f) { f.lengthB = 1.0 / 0.3048; }},
        {"A in feet", "wrong_units", false, [](Files& f) { f.lengthA = 1.0 / 0.3048; }},
        {"A in inches", "wrong_units", false, [](Files& f) { f.lengthA = 1.0 / 0.0254; }},
        {"B in cm", "wrong_units", false, [](Files& f) { f.lengthB = 100.0; }},
        {"A in mm", "wrong_units", false, [](Files& f) { f.lengthA = 1000.0; }},
        {"A in km", "wrong_units", false, [](Files& f) { f.lengthA = 0.001; }},
        {"B by other squares", "model_does_not_fit", false, [](Files& f) { f.lengthB = 1.3; }},
    };
}

struct Verdict {
    std::string refusal; ///< its key
    std::string words;
    HandEye found;
    [[nodiscard]] std::vector<std::string> warnings() const {
        std::vector<std::string> keys;
        for (const Finding& finding : found.warnings) keys.emplace_back(keyOf(finding.cause));
        return keys;
    }
};

Verdict verdictOf(const std::string& a, const std::string& b) {
    Verdict verdict;
    try {
        verdict.found = solveHandEye(parsePoseTrack(a, "a.csv"), parsePoseTrack(b, "b.csv"));
    } catch (const CaptureRefused& refused) {
        verdict.refusal = keyOf(refused.finding().cause);
        verdict.words = refused.what();
    } catch (const DataError& error) {
        verdict.refusal = "data error";
        verdict.words = error.what();
    }
    return verdict;
}

double turnBeside(const Pose& a, const Pose& b) {
    return kPerRadian * angleOf(glm::conjugate(a.rotation) * b.rotation);
}
double millimetresBeside(const Pose& a, const Pose& b) { return 1000.0 * glm::distance(a.position, b.position); }

void check(const Kind& kind, unsigned seed) {
    JoinedBodies truth(seed);
    if (kind.move) kind.move(truth);
    Files files = truth.files(seed);
    kind.spoil(files);
    const Verdict verdict =
        verdictOf(written(files.a, files.wFirstA, files.lengthA), written(files.b, files.wFirstB, files.lengthB));
    const std::string what = std::string(kind.name) + ", seed " + std::to_string(seed) + ": " + verdict.words;
    if (!kind.solved) {
        EXPECT_EQ(verdict.refusal, kind.key) << what;
        return;
    }
    ASSERT_EQ(verdict.refusal, "") << what;
    const std::vector<std::string> said = verdict.warnings();
    if (*kind.key == 0) {
        EXPECT_TRUE(said.empty()) << what << said.front();
    } else {
        EXPECT_NE(std::ranges::find(said, kind.key), said.end()) << what;
    }
    EXPECT_LT(turnBeside(verdict.found.bFromA, truth.bFromA), 0.3) << what;
    EXPECT_LT(millimetresBeside(verdict.found.bFromA, truth.bFromA), 1.5) << what;
    EXPECT_LT(turnBeside(verdict.found.worldBFromWorldA, truth.worldBFromWorldA), 0.3) << what;
}

// With LUMORPH_POSE_SEEDS=FROM:TO over many seeds. In the suite every third kind.
TEST(PoseReadings, EachKindOfFaultIsReadOrRefusedByItsCause) {
    unsigned from = 9101, to = 9102;
    if (const char* seeds = std::getenv("LUMORPH_POSE_SEEDS")) std::sscanf(seeds, "%u:%u", &from, &to);
    const std::vector<Kind> kinds = allKinds();
    for (unsigned seed = from; seed < to; ++seed)
        for (std::size_t i = 0; i < kinds.size(); i += test::longTests() ? 1 : 3) check(kinds[i], seed);
}

TEST(PoseReadings, TheTimeOffsetIsThatOfTheClocksInSeconds) {
    const JoinedBodies truth(9010);
    Files files = truth.files(9010);
    scaleTimes(files.a, 1e3);
    scaleTimes(files.b, 1e6);
    const Verdict verdict = verdictOf(written(files.a, false, 1.0), written(files.b, false, 1.0));
    ASSERT_EQ(verdict.refusal, "") << verdict.words;
    EXPECT_NEAR(verdict.found.timeOffset, truth.offset, 0.002);
    EXPECT_EQ(verdict.warnings().size(), 2U);
}

TEST(PoseReadings, TheRateOfFramesIsFound) {
    const JoinedBodies truth(9011);
    Files files = truth.files(9011);
    countFrames(files.b); // 40 a second
    const Verdict verdict = verdictOf(written(files.a, false, 1.0), written(files.b, false, 1.0));
    ASSERT_EQ(verdict.found.warnings.size(), 1U) << verdict.words;
    double rate = 0.0;
    const std::string& why = verdict.found.warnings[0].why;
    ASSERT_EQ(std::sscanf(why.c_str() + why.find("frames,"), "frames, %lf", &rate), 1) << why;
    EXPECT_NEAR(rate, 40.0, 0.02);
}

// Nothing tells it: bodies and worlds take each other's place. Where the bodies were far apart then, that is said.
TEST(PoseReadings, TwoInvertedRecordingsExchangeBodiesAndWorlds) {
    JoinedBodies truth(9012);
    truth.worldBFromWorldA.position = {2.0, 0.4, -1.0};
    Files files = truth.files(9012);
    invert(files.a);
    invert(files.b);
    const Verdict verdict = verdictOf(written(files.a, false, 1.0), written(files.b, false, 1.0));
    ASSERT_EQ(verdict.refusal, "") << verdict.words;
    EXPECT_LT(turnBeside(verdict.found.bFromA, truth.worldBFromWorldA), 0.3);
    EXPECT_LT(turnBeside(verdict.found.worldBFromWorldA, truth.bFromA), 0.3);
    ASSERT_EQ(verdict.warnings().size(), 1U);
    EXPECT_EQ(verdict.warnings()[0], "inverted");
}

TEST(PoseReadings, TheRefusalOfAnInvertedOneTellsBothDistances) {
    const JoinedBodies truth(9013);
    for (const bool first : {true, false}) {
        Files files = truth.files(9013);
        invert(first ? files.a : files.b);
        const Verdict verdict = verdictOf(written(files.a, false, 1.0), written(files.b, false, 1.0));
        EXPECT_EQ(verdict.refusal, "inverted");
        double byFirst = 0.0, bySecond = 0.0;
        const std::size_t at = verdict.words.find("if the first has");
        ASSERT_NE(at, std::string::npos) << verdict.words;
        ASSERT_EQ(std::sscanf(verdict.words.c_str() + at,
                              "if the first has, the bodies are %lf mm apart, if the second has, %lf", &byFirst,
                              &bySecond),
                  2)
            << verdict.words;
        const double joint = 1000.0 * glm::length(truth.bFromA.position);
        EXPECT_NEAR(first ? byFirst : bySecond, joint, 20.0) << verdict.words;
        EXPECT_GT(first ? bySecond : byFirst, 400.0) << verdict.words;
    }
}

TEST(PoseReadings, NoUnitIsClaimedWhereNothingFits) {
    for (unsigned seed = 9020; seed < 9022; ++seed) {
        const JoinedBodies one(seed);
        JoinedBodies other(seed);
        const test::HandMotion elsewhere(seed + 7);
        const Motion turning = one.motion;
        // They turn alike, but are carried about by different hands.
        other.motion = [turning, elsewhere](double t) { return Pose{elsewhere.at(t).position, turning(t).rotation}; };
        const Verdict verdict =
            verdictOf(written(one.files(seed).a, false, 1.0), written(other.files(seed).b, false, 1.0));
        EXPECT_EQ(verdict.refusal, "model_does_not_fit") << verdict.words;
    }
}

TEST(PoseReadings, CasesInSharedAreReadRight) {
    const std::string folder = LUMORPH_SHARED_DIR "/data/cases/poses/";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "without ../shared/data/cases";
    const auto solved = [&](const char* a, const char* b) {
        return verdictOf(test::textOfFile(folder + a), test::textOfFile(folder + b));
    };
    const Verdict clean = solved("header.csv", "b.csv");
    ASSERT_EQ(clean.refusal, "") << clean.words;
    EXPECT_TRUE(clean.found.warnings.empty());
    EXPECT_LT(clean.found.halvesShift, 0.002);
    const struct {
        const char *a, *b, *key;
        double degrees, millimetres;
    } rows[] = {{"bom.csv", "b.csv", "", 1e-9, 1e-9},
                {"wxyz-a.csv", "b.csv", "quaternion_order", 1e-6, 1e-6},
                {"ms-a.csv", "ms-b.csv", "time_unit", 1e-3, 1e-2},
                {"turning-a.csv", "turning-b.csv", "turns_in_place", 0.2, 1.0}};
    for (const auto& row : rows) {
        const Verdict verdict = solved(row.a, row.b);
        ASSERT_EQ(verdict.refusal, "") << row.a << ": " << verdict.words;
        EXPECT_LT(turnBeside(verdict.found.bFromA, clean.found.bFromA), row.degrees) << row.a;
        EXPECT_LT(millimetresBeside(verdict.found.bFromA, clean.found.bFromA), row.millimetres) << row.a;
        const std::vector<std::string> said = verdict.warnings();
        EXPECT_EQ(said, *row.key == 0 ? std::vector<std::string>{} : std::vector<std::string>(said.size(), row.key));
        EXPECT_EQ(said.empty(), *row.key == 0) << row.a;
    }
    EXPECT_EQ(solved("inverse-a.csv", "b.csv").refusal, "inverted");
}

} // namespace
} // namespace lumorph
