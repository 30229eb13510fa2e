#include "devices/trackers/natnet_client.h"

#include <algorithm>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "devices/protocol/natnet_writer.h"
#include "tests/support/natnet_frames.h"

namespace lumorph {
namespace {

using natnet::Message;
using natnet::Version;
using ::testing::ElementsAre;
using Outcome = NatNetClient::Outcome;

constexpr std::uint64_t kHertz = 10'000'000;

Microseconds at(double seconds) { return Microseconds(std::llround(1e6 * seconds)); }

/// A client whose words are gathered, and a server that answers when it is told to.
class Conversation {
public:
    explicit Conversation(Version version, bool unicast = true, std::optional<Version> given = {})
        : version_(version), writer_(version), client(unicast, given, [this](std::span<const std::byte> bytes) {
              said_.push_back({natnet::readPacket(bytes).message, {bytes.begin(), bytes.end()}});
          }) {}

    /// What the client says at that time.
    std::vector<Message> tick(double seconds) {
        said_.clear();
        client.tick(at(seconds));
        std::vector<Message> messages;
        for (const Said& said : said_) messages.push_back(said.message);
        return messages;
    }
    void introduce(double seconds) {
        natnet::ServerInfo info{"Motive", {2, 1, 0, 0}, version_, {}};
        if (version_.major >= 3) info.connection = natnet::Connection{kHertz, 1511, false, {0, 0, 0, 0}};
        EXPECT_EQ(client.take(writer_.serverInfo(info), at(seconds)), Outcome::answer);
    }
    void name(std::vector<std::pair<std::int32_t, std::string>> names, double seconds) {
        std::vector<natnet::Model> models;
        for (const auto& [id, text] : names)
            models.push_back({natnet::Model::Kind::rigidBody, text, id, {{text, id, -1, {}}}, {}});
        EXPECT_EQ(client.take(writer_.models(models), at(seconds)), Outcome::answer);
    }
    /// Answers the last echo as a server whose clock shows so many ticks.
    void answerEcho(std::uint64_t ticks, double seconds) {
        const auto echo = std::ranges::find(said_, Message::echoRequest, &Said::message);
        ASSERT_NE(echo, said_.end());
        std::uint64_t number = 0;
        std::memcpy(&number, echo->bytes.data() + 4, sizeof number);
        client.take(writer_.echo(number, ticks), at(seconds));
    }
    Outcome frame(const natnet::Frame& frame, double seconds) { return client.take(writer_.frame(frame), at(seconds)); }
    natnet::Frame frameOf(std::vector<natnet::RigidBody> bodies) const {
        natnet::Frame frame;
        frame.number = 42;
        frame.bodies = std::move(bodies);
        if (version_.major < 3) frame.latency = 0.0F;
        frame.timestamp = 100.0;
        if (version_.major >= 3) frame.ticks.emplace();
        return frame;
    }

private:
    struct Said {
        Message message;
        std::vector<std::byte> bytes;
    };
    Version version_;
    NatNetWriter writer_;
    std::vector<Said> said_;

public:
    NatNetClient client;
};

TEST(NatNetClient, SaysWhoItIsUntilItIsHeardAndThatItListensFromThenOn) {
    Conversation talk({2, 10});
    EXPECT_THAT(talk.tick(0.0), ElementsAre(Message::connect));
    EXPECT_THAT(talk.tick(0.5), ElementsAre());
    EXPECT_THAT(talk.tick(1.0), ElementsAre(Message::connect));
    talk.introduce(1.1);
    EXPECT_THAT(talk.tick(1.2), ElementsAre(Message::requestModels));
    EXPECT_THAT(talk.tick(1.3), ElementsAre()) << "it is still on its way";
    talk.name({}, 1.4);
    int alive = 0;
    for (int step = 15; step <= 95; ++step) {
        if (step % 10 == 0) talk.frame(talk.frameOf({}), 0.1 * step);
        for (const Message message : talk.tick(0.1 * step)) {
            EXPECT_EQ(message, Message::keepAlive);
            ++alive;
        }
    }
    EXPECT_EQ(alive, 4) << "every two seconds of eight";
    // Silence: the server may have been started again.
    EXPECT_THAT(talk.tick(20.0), ElementsAre(Message::connect));
}

TEST(NatNetClient, InMulticastNobodyHasToBeKeptAlive) {
    Conversation talk({2, 10}, false);
    (void)talk.tick(0.0);
    talk.introduce(0.1);
    talk.name({}, 0.2);
    for (int step = 3; step < 80; ++step) {
        talk.frame(talk.frameOf({}), 0.1 * step);
        EXPECT_THAT(talk.tick(0.1 * step), ElementsAre());
    }
}

TEST(NatNetClient, BodiesHaveTheirNamesAndUnknownOnesAreAskedForOnce) {
    Conversation talk({2, 10});
    (void)talk.tick(0.0);
    talk.introduce(0.1);
    talk.name({{7, "glasses"}}, 0.2);
    EXPECT_EQ(talk.frame(talk.frameOf({{7}, {8}}), 0.3), Outcome::frame);
    ASSERT_EQ(talk.client.frame().bodies.size(), 2U);
    EXPECT_EQ(talk.client.frame().bodies[0].name, "glasses");
    EXPECT_EQ(talk.client.frame().bodies[1].name, "body 8");
    EXPECT_EQ(talk.client.frame().number, 42U);
    EXPECT_THAT(talk.tick(1.5), ::testing::Contains(Message::requestModels));
    talk.name({{7, "glasses"}, {8, "tablet"}}, 1.6);
    talk.frame(talk.frameOf({{7}, {8}, {9}}), 1.7);
    EXPECT_EQ(talk.client.frame().bodies[1].name, "tablet");
    EXPECT_THAT(talk.tick(2.8), ::testing::Contains(Message::requestModels));
    talk.name({{7, "glasses"}, {8, "tablet"}}, 2.9);
    talk.frame(talk.frameOf({{7}, {8}, {9}}), 3.0);
    EXPECT_THAT(talk.tick(4.0), ::testing::Not(::testing::Contains(Message::requestModels))) << "9 has no name";
    natnet::Frame changed = talk.frameOf({{9}});
    changed.params = 2;
    talk.frame(changed, 5.0);
    EXPECT_THAT(talk.tick(5.1), ::testing::Contains(Message::requestModels)) << "the server says that names changed";
}

TEST(NatNetClient, ALostBodyKeepsItsStalePoseAndIsNotValid) {
    Conversation talk({3, 0}, true, Version{3, 0});
    natnet::RigidBody lost{7, {1, 2, 3}, {1, 0, 0, 0}, 0.0F, false};
    natnet::RigidBody seen{8, {4, 5, 6}, {0, 0, 2, 0}, 0.0F, true};
    talk.frame(talk.frameOf({lost, seen}), 0.1);
    const auto& bodies = talk.client.frame().bodies;
    EXPECT_FALSE(bodies[0].valid);
    EXPECT_EQ(bodies[0].pose.position, glm::dvec3(1, 2, 3));
    EXPECT_TRUE(bodies[1].valid);
    EXPECT_EQ(bodies[1].pose.rotation, glm::dquat(0, 0, 1, 0)) << "of unit length";
}

TEST(NatNetClient, APoseThatIsNoNumberIsNotValidWhateverItsFlagSays) {
    Conversation talk({3, 0}, true, Version{3, 0});
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    std::vector<natnet::RigidBody> bodies(4);
    bodies[0].position.y = kNan;
    bodies[1].rotation.z = kNan;
    bodies[2].rotation = {0, 0, 0, 0};
    bodies[3].position.x = 1e20F;
    talk.frame(talk.frameOf(bodies), 0.1);
    for (const TrackedBody& body : talk.client.frame().bodies) {
        EXPECT_FALSE(body.valid);
        EXPECT_FALSE(body.isNumber) << "so it can be told";
        EXPECT_EQ(body.pose, Pose{});
    }
    for (natnet::RigidBody& body : bodies) body.valid = false;
    talk.frame(talk.frameOf(bodies), 0.2);
    for (const TrackedBody& body : talk.client.frame().bodies) EXPECT_TRUE(body.isNumber) << "nobody sees it";
}

TEST(NatNetClient, ClocksAreMatchedByEchoes) {
    Conversation talk({3, 1});
    (void)talk.tick(10.0);
    talk.introduce(10.0);
    EXPECT_THAT(talk.tick(10.1), ElementsAre(Message::requestModels, Message::echoRequest));
    natnet::Frame frame = talk.frameOf({{7}});
    // The server's clock shows 1000 s when ours shows 10.102 s, in the middle of question and answer.
    frame.ticks->exposure = 1'000 * kHertz + kHertz / 5;
    talk.frame(frame, 10.35);
    EXPECT_EQ(talk.client.frame().measured, at(10.35)) << "nothing is known yet: when it arrived";
    EXPECT_FALSE(talk.client.latencyMilliseconds());
    talk.answerEcho(1'000 * kHertz, 10.104);
    talk.frame(frame, 10.35);
    EXPECT_EQ(talk.client.frame().measured, at(10.302));
    EXPECT_EQ(talk.client.frame().arrived, at(10.35));
    EXPECT_NEAR(talk.client.latencyMilliseconds().value(), 48.0, 1e-9);
}

TEST(NatNetClient, TimesThatCannotBeAreNotBelieved) {
    Conversation talk({3, 1});
    talk.introduce(10.0);
    (void)talk.tick(10.1);
    talk.answerEcho(1'000 * kHertz, 10.104);
    for (const std::uint64_t ticks : {std::uint64_t{0}, 900 * kHertz, 1'100 * kHertz, ~std::uint64_t{0}}) {
        natnet::Frame frame = talk.frameOf({{7}});
        frame.ticks->exposure = ticks;
        talk.frame(frame, 10.5);
        EXPECT_EQ(talk.client.frame().measured, at(10.5)) << ticks;
    }
}

TEST(NatNetClient, AnswersThatNobodyAskedForDoNotSetTheClock) {
    Conversation talk({3, 1});
    talk.introduce(10.0);
    NatNetWriter writer({3, 1});
    (void)talk.client.take(writer.echo(10'000'000, 1'000 * kHertz), at(10.0));
    natnet::Frame frame = talk.frameOf({{7}});
    frame.ticks->exposure = 1'000 * kHertz;
    talk.frame(frame, 10.1);
    EXPECT_EQ(talk.client.frame().measured, at(10.1));
}

TEST(NatNetClient, BeforeVersion3TheLatencyOfTheFrameCountsWhereItIsOne) {
    Conversation talk({2, 10}, true, Version{2, 10});
    natnet::Frame frame = talk.frameOf({{7}});
    frame.latency = 0.0625F;
    talk.frame(frame, 1.0);
    EXPECT_EQ(talk.client.frame().measured, at(0.9375));
    EXPECT_NEAR(talk.client.latencyMilliseconds().value(), 62.5, 1e-9);
    for (const float time : {100.0F, 0.0F, -1.0F, std::numeric_limits<float>::quiet_NaN()}) {
        frame.latency = time; // real servers write the time of the frame there
        talk.frame(frame, 2.0);
        EXPECT_EQ(talk.client.frame().measured, at(2.0));
        EXPECT_FALSE(talk.client.latencyMilliseconds());
    }
    frame.timestamp = 0.125; // just started: the time of the frame looks like a latency
    frame.latency = 0.125F;
    talk.frame(frame, 3.0);
    EXPECT_EQ(talk.client.frame().measured, at(3.0));
}

TEST(NatNetClient, FramesWaitForTheirVersion) {
    Conversation talk({2, 9});
    EXPECT_EQ(talk.frame(talk.frameOf({{7}}), 0.1), Outcome::waiting);
    EXPECT_TRUE(talk.client.frame().bodies.empty());
    talk.introduce(0.2);
    EXPECT_EQ(talk.frame(talk.frameOf({{7}}), 0.3), Outcome::frame);
    EXPECT_EQ(talk.client.frame().bodies.size(), 1U);
}

TEST(NatNetClient, OnlyVersionsThatWereSeenFromRealSoftwareAreVerified) {
    for (const Version version : test::kNatNetVersions) {
        Conversation talk(version);
        talk.introduce(0.1);
        EXPECT_EQ(talk.client.isVerified(), version.major == 2 && version.minor != 6)
            << version.major << "." << version.minor;
    }
}

TEST(NatNetClient, WrongPacketsChangeNothing) {
    Conversation talk({2, 10});
    talk.introduce(0.1);
    talk.name({{7, "glasses"}}, 0.2);
    talk.frame(talk.frameOf({{7}}), 0.3);
    std::vector<std::byte> wrong = NatNetWriter({2, 10}).frame(talk.frameOf({{8}}));
    wrong.resize(wrong.size() - 1);
    EXPECT_THROW((void)talk.client.take(wrong, at(0.4)), DataError);
    EXPECT_EQ(talk.client.frame().bodies.at(0).name, "glasses");
    EXPECT_EQ(talk.client.frame().arrived, at(0.3));
}

} // namespace
} // namespace lumorph
