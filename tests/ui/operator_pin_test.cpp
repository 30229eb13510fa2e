#include "app/studio/base/operator_pin.h"

#include <chrono>

#include <QFile>
#include <gtest/gtest.h>

namespace lumorph::studio {
namespace {

using Answer = OperatorPin::Answer;

class OperatorPinTest : public ::testing::Test {
protected:
    void SetUp() override { OperatorPin::forget(settings); }
    void TearDown() override { OperatorPin::forget(settings); }
    void advance(int seconds) { clock.advance(std::chrono::seconds(seconds)); }
    [[nodiscard]] static QByteArray fileBytes() {
        const QSettings store(QSettings::IniFormat, QSettings::UserScope, "lumorph", "studio");
        QFile file(store.fileName());
        return file.open(QIODevice::ReadOnly) ? file.readAll() : QByteArray();
    }

    Settings settings;
    ManualClock clock;
    OperatorPin pin{settings, clock};
};

TEST_F(OperatorPinTest, IsFourToEightDigits) {
    for (const char* wrong : {"", "123", "123456789", "12a4", "1234 ", "-123"}) {
        EXPECT_FALSE(pin.choose(wrong)) << wrong;
        EXPECT_FALSE(pin.isSet());
        EXPECT_EQ(pin.attempt(wrong), Answer::wrong) << "what is not set is never right";
    }
    for (const char* one : {"0000", "12345678"}) {
        ASSERT_TRUE(pin.choose(one));
        EXPECT_TRUE(pin.isSet());
        EXPECT_EQ(pin.attempt(one), Answer::right);
    }
}

TEST_F(OperatorPinTest, IsNotReadableInTheFileAndSaltedAnew) {
    QList<QByteArray> hashes;
    for (int time = 0; time < 2; ++time) {
        ASSERT_TRUE(pin.choose("27182818"));
        settings.reload();
        const QByteArray bytes = fileBytes();
        EXPECT_TRUE(bytes.contains("[kiosk]"));
        EXPECT_FALSE(bytes.contains("27182818"));
        hashes << settings.value("kiosk/hash").toByteArray();
        EXPECT_EQ(hashes.back().size(), 64) << "32 bytes";
    }
    EXPECT_NE(hashes[0], hashes[1]) << "the same digits twice look different";
    EXPECT_EQ(pin.attempt("27182819"), Answer::wrong);
    EXPECT_EQ(pin.attempt("27182818"), Answer::right);
}

TEST_F(OperatorPinTest, AfterFiveWrongAttemptsEachPauseIsTwiceAsLong) {
    ASSERT_TRUE(pin.choose("2718"));
    for (int attempt = 1; attempt < 5; ++attempt) {
        EXPECT_EQ(pin.attempt("0000"), Answer::wrong);
        EXPECT_EQ(pin.secondsToWait(), 0) << attempt;
    }
    for (const int pause : {30, 60, 120, 240, 480, 900, 900}) {
        EXPECT_EQ(pin.attempt("0000"), Answer::wrong);
        EXPECT_EQ(pin.secondsToWait(), pause);
        EXPECT_EQ(pin.attempt("2718"), Answer::paused) << "the right one is not even looked at";
        advance(pause - 1);
        EXPECT_EQ(pin.attempt("2718"), Answer::paused);
        advance(1);
        EXPECT_EQ(pin.secondsToWait(), 0);
    }
    EXPECT_EQ(pin.attempt("2718"), Answer::right);
    EXPECT_EQ(pin.wrongAttempts(), 0);
    EXPECT_EQ(pin.attempt("0000"), Answer::wrong);
    EXPECT_EQ(pin.secondsToWait(), 0) << "counted from the beginning";
}

TEST_F(OperatorPinTest, ARestartDoesNotShortenThePause) {
    ASSERT_TRUE(pin.choose("2718"));
    for (int attempt = 0; attempt < 6; ++attempt) {
        (void)pin.attempt("0000");
        advance(pin.secondsToWait());
    }
    OperatorPin again(settings, clock);
    EXPECT_EQ(again.secondsToWait(), 60);
    EXPECT_EQ(again.attempt("2718"), Answer::paused);
    advance(60);
    EXPECT_EQ(again.attempt("2718"), Answer::right);
}

TEST_F(OperatorPinTest, ForgottenByAnotherProcessItIsNotSet) {
    ASSERT_TRUE(pin.choose("2718"));
    for (int attempt = 0; attempt < 5; ++attempt) (void)pin.attempt("0000");
    settings.reload();
    {
        Settings other;
        OperatorPin::forget(other);
    }
    EXPECT_FALSE(pin.isSet());
    EXPECT_FALSE(fileBytes().contains("hash="));
}

} // namespace
} // namespace lumorph::studio
