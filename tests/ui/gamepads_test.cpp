#include "app/studio/devices/gamepads.h"

#include <atomic>
#include <csignal>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#define SDL_MAIN_HANDLED
#include <SDL.h>
#include <gtest/gtest.h>

#include "tests/ui/event_loop.h"
#include "tests/ui/studio_window.h"

// Gamepads: what a reading says, and SDL's own virtual controllers, plugged in and out.

namespace lumorph::studio {
namespace {

using namespace std::chrono_literals;
using test::eventually;

using Inputs = std::vector<ShowInput>;

TEST(PadInputs, AStickThatRestsSaysNothingAndOneThatIsAsideSaysTheWhole) {
    PadInputs pad;
    EXPECT_EQ(pad.take({}), Inputs());
    EXPECT_EQ(pad.take({{0.1, -0.1}}), Inputs()) << "0.14 from the middle";
    EXPECT_EQ(pad.take({{0.55, 0.0}}), (Inputs{{"pad.x", 0.5}})) << "half of 0.15 to 0.95";
    EXPECT_EQ(pad.take({{0.551, 0.0}}), Inputs()) << "it trembles";
    EXPECT_EQ(pad.take({{1.0, 0.0}}), (Inputs{{"pad.x", 1.0}}));
    EXPECT_EQ(pad.take({{0.0, -1.0}}), (Inputs{{"pad.x", 0.0}, {"pad.y", -1.0}}));
    EXPECT_EQ(pad.take({{NAN, 0.0}}), (Inputs{{"pad.y", 0.0}}));
    EXPECT_EQ(pad.take({{INFINITY, 0.0}}), Inputs());
}

TEST(PadInputs, ButtonsArePressedOnceAndLetGoOnce) {
    PadInputs pad;
    EXPECT_EQ(pad.take({{}, true, false, false}), (Inputs{{"key.restart", 1.0}}));
    EXPECT_EQ(pad.take({{}, true, false, false}), Inputs());
    EXPECT_EQ(pad.take({{}, false, true, true}),
              (Inputs{{"key.restart", 0.0}, {"key.next", 1.0}, {"key.attract", 1.0}}));
    EXPECT_EQ(pad.take({}), (Inputs{{"key.next", 0.0}, {"key.attract", 0.0}})) << "unplugged: nothing stays pressed";
}

/// What a pad told, from its thread.
class Told {
public:
    void operator()(const ShowInput& input) {
        const std::scoped_lock lock(mutex_);
        newest_[input.name] = input.value;
        ++count_;
    }
    [[nodiscard]] double newest(const std::string& name) {
        const std::scoped_lock lock(mutex_);
        const auto found = newest_.find(name);
        return found == newest_.end() ? -9.0 : found->second;
    }
    [[nodiscard]] int count() {
        const std::scoped_lock lock(mutex_);
        return count_;
    }

private:
    std::mutex mutex_;
    std::map<std::string, double> newest_;
    int count_ = 0;
};

/// A controller that SDL itself pretends to have. SDL is up as long as it is there.
class VirtualPad {
public:
    VirtualPad() {
        SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");
        SDL_SetHint(SDL_HINT_JOYSTICK_ALLOW_BACKGROUND_EVENTS, "1");
        EXPECT_EQ(SDL_InitSubSystem(SDL_INIT_GAMECONTROLLER), 0);
        plug();
    }
    ~VirtualPad() {
        unplug();
        SDL_QuitSubSystem(SDL_INIT_GAMECONTROLLER);
    }
    void plug() {
        index_ = SDL_JoystickAttachVirtual(SDL_JOYSTICK_TYPE_GAMECONTROLLER, SDL_CONTROLLER_AXIS_MAX,
                                           SDL_CONTROLLER_BUTTON_MAX, 0);
        ASSERT_GE(index_, 0) << SDL_GetError();
        joystick_ = SDL_JoystickOpen(index_);
        ASSERT_NE(joystick_, nullptr) << SDL_GetError();
    }
    void unplug() {
        if (!joystick_) return;
        SDL_JoystickClose(joystick_);
        joystick_ = nullptr;
        EXPECT_EQ(SDL_JoystickDetachVirtual(index_), 0) << SDL_GetError();
    }
    void push(SDL_GameControllerAxis axis, double share) {
        SDL_JoystickSetVirtualAxis(joystick_, axis, static_cast<Sint16>(share * 32767.0));
    }
    void press(SDL_GameControllerButton button, bool down) {
        SDL_JoystickSetVirtualButton(joystick_, button, down ? 1 : 0);
    }

private:
    int index_ = -1;
    SDL_Joystick* joystick_ = nullptr;
};

TEST(Gamepads, AStickAndItsButtonsAreToldAndAPadMayComeAndGo) {
    VirtualPad pad;
    Told told;
    Gamepads pads([&told](const ShowInput& input) { told(input); });
    pad.push(SDL_CONTROLLER_AXIS_LEFTX, 1.0);
    test::pass(100ms);
    EXPECT_EQ(told.count(), 0) << "nobody wants to know";
    pads.setPolling(true);
    EXPECT_TRUE(eventually([&] { return told.newest("pad.x") == 1.0; }));
    pad.push(SDL_CONTROLLER_AXIS_LEFTX, 0.0);
    pad.push(SDL_CONTROLLER_AXIS_LEFTY, 1.0);
    EXPECT_TRUE(eventually([&] { return told.newest("pad.x") == 0.0 && told.newest("pad.y") == 1.0; }))
        << "towards the player";
    pad.push(SDL_CONTROLLER_AXIS_LEFTY, 0.0);
    pad.press(SDL_CONTROLLER_BUTTON_DPAD_LEFT, true);
    EXPECT_TRUE(eventually([&] { return told.newest("pad.x") == -1.0; })) << "its cross";
    pad.press(SDL_CONTROLLER_BUTTON_DPAD_LEFT, false);
    const std::pair<SDL_GameControllerButton, const char*> buttons[] = {{SDL_CONTROLLER_BUTTON_A, "key.restart"},
                                                                        {SDL_CONTROLLER_BUTTON_START, "key.restart"},
                                                                        {SDL_CONTROLLER_BUTTON_B, "key.next"},
                                                                        {SDL_CONTROLLER_BUTTON_BACK, "key.attract"}};
    for (const auto& [button, name] : buttons) {
        pad.press(button, true);
        EXPECT_TRUE(eventually([&] { return told.newest(name) == 1.0; })) << name;
        pad.press(button, false);
        EXPECT_TRUE(eventually([&] { return told.newest(name) == 0.0; })) << name;
    }
    pad.push(SDL_CONTROLLER_AXIS_LEFTX, 1.0);
    EXPECT_TRUE(eventually([&] { return told.newest("pad.x") == 1.0; }));
    pad.unplug();
    EXPECT_TRUE(eventually([&] { return told.newest("pad.x") == 0.0; })) << "it is gone, and leans no more";
    pad.plug();
    pad.push(SDL_CONTROLLER_AXIS_LEFTX, -1.0);
    EXPECT_TRUE(eventually([&] { return told.newest("pad.x") == -1.0; })) << "plugged in again";
    pads.setPolling(false);
    EXPECT_TRUE(eventually([&] { return told.newest("pad.x") == 0.0; })) << "nothing stays held";
}

TEST(Gamepads, WithoutAnyNothingHappensAndSignalsStayTheProgramsOwn) {
    struct sigaction before {};
    ASSERT_EQ(::sigaction(SIGINT, nullptr, &before), 0);
    Told told;
    {
        Gamepads pads([&told](const ShowInput& input) { told(input); });
        pads.setPolling(true);
        test::pass(300ms);
    }
    struct sigaction after {};
    ASSERT_EQ(::sigaction(SIGINT, nullptr, &after), 0);
    EXPECT_EQ(after.sa_handler, before.sa_handler);
    EXPECT_EQ(told.count(), 0);
}

/// Remembers what it was given.
class Given : public ShowProgram {
public:
    ShowContent frame(const ShowMoment& moment) override {
        for (const ShowInput& input : moment.inputs)
            if (input.name == "pad.x") x = input.value;
        return {};
    }
    std::atomic<double> x = 0.0;
};

TEST(Gamepads, ReachTheApplicationThatShows) {
    const TemporaryFolder folder;
    test::StudioWindow window{folder.path(), "scene"};
    VirtualPad pad;
    window.studio().gamepads.open();
    const auto program = std::make_shared<Given>();
    window.studio().loop.setProgram(program);
    pad.push(SDL_CONTROLLER_AXIS_LEFTX, 1.0);
    EXPECT_TRUE(eventually([&] { return program->x == 1.0; }));
    pad.push(SDL_CONTROLLER_AXIS_LEFTX, 0.0);
    EXPECT_TRUE(eventually([&] { return program->x == 0.0; }));
    window.studio().loop.setProgram(nullptr);
}

} // namespace
} // namespace lumorph::studio
