#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "app/sound/sound_mixer.h"
#include "core/show/project_contents.h"
#include "core/show/show_player.h"
#include "tests/ui/studio_window.h"

// What applications let be heard, as numbers: no sound card is needed, and none is opened.

namespace lumorph::test {
namespace {

using namespace std::chrono_literals;

std::shared_ptr<const SoundBoard> board() {
    static const auto made = std::make_shared<const SoundBoard>(SoundBoard::synthesised());
    return made;
}

/// A stretch of what is heard.
struct Stretch {
    std::vector<std::int16_t> samples; ///< left and right by turns

    [[nodiscard]] double power(int side) const { ///< root of the mean square, of the largest sample
        double sum = 0.0;
        for (std::size_t k = static_cast<std::size_t>(side); k < samples.size(); k += 2)
            sum += static_cast<double>(samples[k]) * static_cast<double>(samples[k]);
        return std::sqrt(sum / (0.5 * static_cast<double>(samples.size()))) / 32767.0;
    }
    [[nodiscard]] double power() const { return std::hypot(power(0), power(1)); }
    [[nodiscard]] double peak() const {
        int most = 0;
        for (const std::int16_t sample : samples) most = std::max(most, std::abs(static_cast<int>(sample)));
        return most / 32767.0;
    }
    /// The largest step from one sample to the next of a side.
    [[nodiscard]] double step() const {
        int most = 0;
        for (std::size_t k = 2; k < samples.size(); ++k) most = std::max(most, std::abs(samples[k] - samples[k - 2]));
        return most / 32767.0;
    }
};

class Mixer : public ::testing::Test {
protected:
    Mixer() { mixer.setBoard(board()); }
    Stretch hear(double seconds) {
        Stretch stretch;
        stretch.samples.resize(2 * static_cast<std::size_t>(std::lround(seconds * kSoundRate)));
        mixer.mix(stretch.samples);
        return stretch;
    }
    /// As long as a frame of a sixtieth of a second names these.
    Stretch hear(double seconds, const std::vector<ShowSound>& sounds) {
        Stretch all;
        for (int k = 0; k < std::lround(60.0 * seconds); ++k) {
            mixer.play(sounds);
            const Stretch one = hear(1.0 / 60.0);
            all.samples.insert(all.samples.end(), one.samples.begin(), one.samples.end());
        }
        return all;
    }
    SoundMixer mixer;
};

TEST(SoundBoard, HasEverySoundOfTheApplicationsAndEachIsHeardAndDoesNotClip) {
    for (const char* name :
         {"labyrinth.roll", "labyrinth.bump", "labyrinth.pickup", "labyrinth.fall", "labyrinth.goal", "ambient.rain",
          "ambient.wind", "ambient.wave", "ambient.thunder", "ice.crack", "ice.bump", "ice.drip", "ice.splash",
          "water.drop", "water.splash", "water.harbour", "navigation.fly", "studio.hands_off"}) {
        const SoundVoice* voice = board()->find(name);
        ASSERT_NE(voice, nullptr) << name;
        double sum = 0.0, loudest = 0.0;
        for (const float sample : voice->samples) {
            ASSERT_TRUE(std::isfinite(sample)) << name;
            sum += static_cast<double>(sample) * static_cast<double>(sample);
            loudest = std::max(loudest, static_cast<double>(std::abs(sample)));
        }
        EXPECT_LE(loudest, 0.95) << name;
        EXPECT_GT(std::sqrt(sum / static_cast<double>(voice->samples.size())), 0.02) << name;
        if (voice->continuous) {
            continue;
        }
        EXPECT_LT(std::abs(voice->samples.back()), 1e-3F) << name << " ends in silence";
        EXPECT_LT(std::abs(voice->samples.front()), 0.2F) << name;
    }
    EXPECT_EQ(board()->find("labyrinth"), nullptr);
}

TEST(SoundBoard, LoopsGoOnWithoutASeam) {
    for (const SoundVoice& voice : board()->voices()) {
        if (!voice.continuous) continue;
        double step = 0.0;
        for (std::size_t k = 1; k < voice.samples.size(); ++k)
            step = std::max(step, static_cast<double>(std::abs(voice.samples[k] - voice.samples[k - 1])));
        EXPECT_LE(static_cast<double>(std::abs(voice.samples.front() - voice.samples.back())), step) << voice.name;
        EXPECT_GE(voice.samples.size(), 2U * kSoundRate) << voice.name;
    }
}

TEST(SoundBoard, PickUpsClimbAScale) {
    const SoundVoice& voice = *board()->find("labyrinth.pickup");
    EXPECT_DOUBLE_EQ(voice.speed(1.0), 1.0);
    for (int count = 2; count <= 9; ++count) EXPECT_GT(voice.speed(count), voice.speed(count - 1)) << count;
    EXPECT_DOUBLE_EQ(voice.speed(30.0), voice.speed(9.0));
    EXPECT_DOUBLE_EQ(voice.loudness(1.0), voice.loudness(8.0));
}

TEST_F(Mixer, IsSilentWhileNothingSounds) {
    EXPECT_EQ(hear(0.5).peak(), 0.0);
    mixer.play(std::vector<ShowSound>{{"labyrinth.unknown", 1.0, {}}, {"labyrinth.bump", -1.0, {}}});
    EXPECT_EQ(hear(0.5).peak(), 0.0) << "nor by what nobody knows, or has no strength";
    EXPECT_TRUE(mixer.silent());
}

TEST_F(Mixer, ABumpSoundsOnceAtItsPlaceAndDecays) {
    mixer.play(std::vector<ShowSound>{{"labyrinth.bump", 0.3, {0.1F, 0.0F, 0.0F}}});
    EXPECT_FALSE(mixer.silent());
    const Stretch first = hear(0.05), second = hear(0.05), third = hear(0.1), rest = hear(0.5);
    EXPECT_GT(first.power(1), 4.0 * first.power(0)) << "to the right";
    EXPECT_GT(first.power(0), 0.0) << "and a little to the left";
    EXPECT_LT(second.power(), 0.6 * first.power());
    EXPECT_LT(third.power(), 0.4 * second.power());
    EXPECT_EQ(hear(0.1).peak(), 0.0) << "once";
    EXPECT_TRUE(mixer.silent());
    mixer.play(std::vector<ShowSound>{{"labyrinth.bump", 0.3, {-0.1F, 0.0F, 0.0F}}});
    const Stretch left = hear(0.05);
    EXPECT_NEAR(left.power(0), first.power(1), 1e-3);
    EXPECT_NEAR(left.power(1), first.power(0), 1e-3);
    (void)hear(0.5);
    mixer.play(std::vector<ShowSound>{{"labyrinth.bump", 0.3, {}}});
    const Stretch middle = hear(0.05);
    EXPECT_NEAR(middle.power(0), middle.power(1), 1e-3);
    EXPECT_NEAR(middle.power(), first.power(), 0.02 * first.power()) << "as loud wherever it is";
}

TEST_F(Mixer, AHardBumpIsLouderThanASoftOne) {
    double before = 0.0;
    for (const double strength : {0.03, 0.08, 0.15, 0.3}) {
        mixer.play(std::vector<ShowSound>{{"labyrinth.bump", strength, {}}});
        const double power = hear(0.1).power();
        EXPECT_GT(power, 1.2 * before) << strength;
        before = power;
        (void)hear(0.5);
    }
}

TEST_F(Mixer, RollingFollowsItsSpeedAndFadesWhenTheBallRests) {
    (void)hear(0.5, {{"labyrinth.roll", 0.05, {}}});
    const double slow = hear(0.5, {{"labyrinth.roll", 0.05, {}}}).power();
    (void)hear(0.5, {{"labyrinth.roll", 0.2, {}}});
    const double fast = hear(0.5, {{"labyrinth.roll", 0.2, {}}}).power();
    // (0.2 - 0.008) / (0.05 - 0.008) of the loudness.
    EXPECT_NEAR(fast / slow, 4.57, 1.0);
    const double fading = hear(0.1, {}).power();
    EXPECT_GT(fading, 0.0) << "not cut off";
    (void)hear(0.2, {});
    EXPECT_EQ(hear(0.1, {}).peak(), 0.0);
    EXPECT_TRUE(mixer.silent());
}

TEST_F(Mixer, WhatGoesOnFadesWhenNoFrameComesAnyMore) {
    (void)hear(0.5, {{"labyrinth.roll", 0.2, {}}});
    EXPECT_GT(hear(0.2).power(), 0.01) << "a slow machine's frames are late";
    (void)hear(0.5);
    EXPECT_EQ(hear(0.1).peak(), 0.0);
    EXPECT_GT(hear(0.3, {{"labyrinth.roll", 0.2, {}}}).power(), 0.01) << "and comes back";
}

TEST_F(Mixer, SixtyFourHardSoundsAtOnceDoNotClipNorClick) {
    std::vector<ShowSound> sounds;
    for (int k = 0; k < 64; ++k)
        sounds.push_back({"labyrinth.bump", 1.0, {0.002F * static_cast<float>(k - 32), 0.0F, 0.0F}});
    mixer.play(sounds);
    const Stretch all = hear(0.5);
    EXPECT_LE(all.peak(), SoundMixer::kCeiling + 1e-3);
    EXPECT_GT(all.peak(), 0.5);
    mixer.play(std::vector<ShowSound>(500, {"labyrinth.goal", 1.0, {0.1F, 0.0F, 0.0F}}));
    EXPECT_LE(hear(2.0).peak(), SoundMixer::kCeiling + 1e-3);
}

TEST_F(Mixer, NoneIsLostOrDoubledWhereFramesAreFasterThanBlocks) {
    SoundMixer other;
    other.setBoard(board());
    const ShowSound bump{"labyrinth.bump", 0.1, {}};
    // Three in three frames before a block, or in one frame.
    for (int k = 0; k < 3; ++k) mixer.play(std::vector<ShowSound>{bump});
    mixer.play({});
    other.play(std::vector<ShowSound>{bump, bump, bump});
    Stretch one = hear(0.3), same;
    same.samples.resize(one.samples.size());
    other.mix(same.samples);
    EXPECT_EQ(one.samples, same.samples);
}

TEST_F(Mixer, OffIsSilenceAndNothingOfItIsHeardLater) {
    (void)hear(0.3, {{"labyrinth.roll", 0.2, {}}, {"labyrinth.bump", 0.3, {}}});
    mixer.setOn(false);
    const Stretch going = hear(0.06, {{"labyrinth.roll", 0.2, {}}, {"labyrinth.goal", 1.0, {}}});
    EXPECT_LT(going.step(), 0.1) << "without a click";
    EXPECT_EQ(hear(0.5, {{"labyrinth.roll", 0.2, {}}, {"labyrinth.goal", 1.0, {}}}).peak(), 0.0);
    mixer.setOn(true);
    EXPECT_EQ(hear(0.5).peak(), 0.0);
    EXPECT_GT(hear(0.3, {{"labyrinth.roll", 0.2, {}}}).power(), 0.01);
}

TEST_F(Mixer, ASignalIsHeardOnceBesideWhatFramesLetBeHeard) {
    const std::vector<ShowSound> rolling{{"labyrinth.roll", 0.1, {}}};
    const double roll = hear(0.5, rolling).power();
    mixer.signal({kHandsOffSound, 1.0, {}});
    EXPECT_GT(hear(0.8, rolling).power(), 1.5 * roll);
    (void)hear(0.4, rolling);
    EXPECT_NEAR(hear(0.5, rolling).power(), roll, 0.3 * roll);
    // An output that is opened late begins with it; one that never comes forgets it.
    (void)hear(1.0);
    mixer.play(std::vector<ShowSound>{{"labyrinth.bump", 0.3, {}}});
    mixer.signal({kHandsOffSound, 1.0, {}});
    mixer.forgetFrames();
    EXPECT_FALSE(mixer.silent());
    mixer.forget();
    EXPECT_TRUE(mixer.silent());
    mixer.setOn(false);
    mixer.signal({kHandsOffSound, 1.0, {}});
    EXPECT_TRUE(mixer.silent());
}

TEST_F(Mixer, HalfTheLoudnessIsAQuarterOfTheAmplitude) {
    mixer.play(std::vector<ShowSound>{{"labyrinth.bump", 0.3, {}}});
    const double full = hear(0.3).power();
    mixer.setLoudness(0.5);
    (void)hear(0.3);
    mixer.play(std::vector<ShowSound>{{"labyrinth.bump", 0.3, {}}});
    EXPECT_NEAR(hear(0.3).power() / full, 0.25, 0.01);
}

TEST_F(Mixer, AnotherRateKeepsThePitch) {
    const auto crossings = [](const Stretch& stretch) {
        int count = 0;
        for (std::size_t k = 2; k < stretch.samples.size(); k += 2)
            count += (stretch.samples[k] < 0) != (stretch.samples[k - 2] < 0) ? 1 : 0;
        return count;
    };
    mixer.play(std::vector<ShowSound>{{"labyrinth.goal", 1.0, {}}});
    const int usual = crossings(hear(1.0));
    (void)hear(1.5);
    mixer.setRate(44'100);
    mixer.play(std::vector<ShowSound>{{"labyrinth.goal", 1.0, {}}});
    EXPECT_NEAR(crossings(hear(0.91875)), usual, 0.02 * usual) << "a second of 44,100 samples";
}

double cpuSeconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

TEST_F(Mixer, SixtyFourVoicesTakeASmallPartOfABlock) {
    mixer.play(std::vector<ShowSound>(64, {"ambient.thunder", 1.0, {}}));
    std::vector<double> milliseconds;
    for (int k = 0; k < 200; ++k) {
        const double begun = cpuSeconds();
        (void)hear(0.01);
        milliseconds.push_back(1e3 * (cpuSeconds() - begun));
    }
    std::ranges::sort(milliseconds);
    RecordProperty("medianMilliseconds", std::to_string(milliseconds[100]));
    EXPECT_LT(milliseconds[100], 2.0) << "of 10";
}

/// Bumps once in each of its frames, so that they can be counted.
class Bumping : public ShowProgram {
public:
    ShowContent frame(const ShowMoment& moment) override {
        ShowContent content;
        content.sounds = {{"labyrinth.bump", 0.1, {}}, {"labyrinth.roll", 0.1, {}}};
        frames = std::lround(60.0 * moment.seconds);
        return content;
    }
    std::atomic<long> frames = 0;
};

TEST(SoundOfTheStudio, HearsEachFrameOnceAlsoWhileTheWindowIsStuck) {
    const TemporaryFolder folder;
    StudioWindow window{folder.path(), "scene"};
    std::atomic<int> bumps = 0, asked = 0;
    const int tap = window.studio().loop.addTap([&](const MatchFrame& frame) {
        if (!frame.program) return;
        ++asked;
        for (const ShowSound& sound : frame.sounds) bumps += sound.name == "labyrinth.bump" ? 1 : 0;
    });
    window.studio().sound.mixer().setBoard(board());
    window.studio().loop.setProgram(std::make_shared<Bumping>());
    ASSERT_TRUE(eventually([&] { return asked > 3; }));
    std::this_thread::sleep_for(300ms); // the window is stuck
    EXPECT_GT(asked, 8);
    EXPECT_EQ(bumps, asked);
    EXPECT_FALSE(window.studio().sound.mixer().silent()) << "they have reached the mixer";
    window.studio().loop.setProgram(nullptr);
    window.studio().loop.removeTap(tap);
}

TEST(SoundOfTheStudio, IsSwitchedAndTurnedByTheViewMenuAndKept) {
    const TemporaryFolder folder;
    StudioWindow window{folder.path(), "scene"};
    studio::Settings& settings = window.studio().settings;
    const bool sound = settings.sound();
    const double loudness = settings.loudness();
    settings.setSound(true);
    settings.setLoudness(0.7);
    QAction* on = window.studio().commands.find("view.sound.on");
    ASSERT_NE(on, nullptr);
    EXPECT_TRUE(on->isChecked());
    window.command("Louder");
    EXPECT_TRUE(eventually([&] { return settings.loudness() == 0.8; }));
    window.command("Quieter");
    window.command("Quieter");
    EXPECT_TRUE(eventually([&] { return settings.loudness() == 0.6; }));
    window.command("mute");
    EXPECT_TRUE(eventually([&] { return !settings.sound(); }));
    EXPECT_FALSE(on->isChecked());
    EXPECT_FALSE(studio::Settings().sound()) << "it is kept";
    window.command("Louder");
    EXPECT_TRUE(eventually([&] { return settings.sound() && on->isChecked(); })) << "whoever turns it up wants to hear";
    settings.setSound(sound);
    settings.setLoudness(loudness);
}

} // namespace
} // namespace lumorph::test
