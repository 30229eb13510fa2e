#include "app/studio/devices/gamepads.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <map>
#include <mutex>
#include <stop_token>
#include <thread>

#include <glm/geometric.hpp>

#define SDL_MAIN_HANDLED // the program has a `main` of its own
#include <SDL.h>

namespace lumorph::studio {
namespace {

constexpr std::chrono::milliseconds kPoll{16};

double axisOf(SDL_GameController* pad, SDL_GameControllerAxis axis) {
    return static_cast<double>(SDL_GameControllerGetAxis(pad, axis)) / 32767.0;
}

double pressed(SDL_GameController* pad, SDL_GameControllerButton button) {
    return SDL_GameControllerGetButton(pad, button) != 0 ? 1.0 : 0.0;
}

/// SDL's joysticks for as long as it lives. Of one thread.
class OpenPads {
public:
    OpenPads() {
        SDL_SetMainReady();
        SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");
        SDL_SetHint(SDL_HINT_JOYSTICK_ALLOW_BACKGROUND_EVENTS, "1"); // it knows of no window
        SDL_SetHint(SDL_HINT_JOYSTICK_HIDAPI, "0");                  // boards of servos are HID devices, too
        ready_ = SDL_InitSubSystem(SDL_INIT_GAMECONTROLLER) == 0;
        if (!ready_) return;
        SDL_JoystickEventState(SDL_IGNORE);
        SDL_GameControllerEventState(SDL_IGNORE);
    }
    ~OpenPads() {
        for (const auto& [id, pad] : pads_) SDL_GameControllerClose(pad);
        if (ready_) SDL_QuitSubSystem(SDL_INIT_GAMECONTROLLER);
    }
    OpenPads(const OpenPads&) = delete;
    OpenPads& operator=(const OpenPads&) = delete;

    [[nodiscard]] PadReading read() {
        if (!ready_) return {};
        SDL_GameControllerUpdate();
        SDL_FlushEvents(SDL_FIRSTEVENT, SDL_LASTEVENT); // nobody takes them
        followPlugs();
        PadReading all;
        for (const auto& [id, pad] : pads_) join(all, readingOf(pad));
        return all;
    }

private:
    void followPlugs() {
        std::erase_if(pads_, [](const auto& entry) {
            if (SDL_GameControllerGetAttached(entry.second)) return false;
            SDL_GameControllerClose(entry.second);
            return true;
        });
        for (int index = 0; index < SDL_NumJoysticks(); ++index) {
            const SDL_JoystickID id = SDL_JoystickGetDeviceInstanceID(index);
            if (id < 0 || pads_.contains(id) || !SDL_IsGameController(index)) continue;
            if (SDL_GameController* pad = SDL_GameControllerOpen(index)) pads_.emplace(id, pad);
        }
    }
    static PadReading readingOf(SDL_GameController* pad) {
        PadReading reading;
        const glm::dvec2 cross(
            pressed(pad, SDL_CONTROLLER_BUTTON_DPAD_RIGHT) - pressed(pad, SDL_CONTROLLER_BUTTON_DPAD_LEFT),
            pressed(pad, SDL_CONTROLLER_BUTTON_DPAD_DOWN) - pressed(pad, SDL_CONTROLLER_BUTTON_DPAD_UP));
        const glm::dvec2 stick(axisOf(pad, SDL_CONTROLLER_AXIS_LEFTX), axisOf(pad, SDL_CONTROLLER_AXIS_LEFTY));
        reading.stick = glm::length(cross) > 0.0 ? cross : stick;
        reading.restart =
            pressed(pad, SDL_CONTROLLER_BUTTON_A) > 0.0 || pressed(pad, SDL_CONTROLLER_BUTTON_START) > 0.0;
        reading.next = pressed(pad, SDL_CONTROLLER_BUTTON_B) > 0.0;
        reading.attract = pressed(pad, SDL_CONTROLLER_BUTTON_BACK) > 0.0;
        return reading;
    }
    /// Of several pads the stick that is farthest out counts.
    static void join(PadReading& all, const PadReading& one) {
        if (glm::length(one.stick) > glm::length(all.stick)) all.stick = one.stick;
        all.restart |= one.restart;
        all.next |= one.next;
        all.attract |= one.attract;
    }

    bool ready_ = false;
    std::map<SDL_JoystickID, SDL_GameController*> pads_;
};

} // namespace

struct Gamepads::Data {
    explicit Data(std::function<void(const ShowInput&)> whom) : told(std::move(whom)) {}

    void run(const std::stop_token& stop);
    /// Waits until somebody wants to know; false when the thread is to end.
    [[nodiscard]] bool wanted(const std::stop_token& stop);
    void tell(const PadReading& reading) {
        for (const ShowInput& input : inputs.take(reading)) told(input);
    }

    const std::function<void(const ShowInput&)> told;
    PadInputs inputs;
    std::mutex mutex;
    std::condition_variable_any changed;
    bool polls = false;
    std::jthread thread; ///< last, so that it ends before what it uses
};

bool Gamepads::Data::wanted(const std::stop_token& stop) {
    std::unique_lock lock(mutex);
    if (!polls) {
        lock.unlock();
        tell({});
        lock.lock();
    }
    return changed.wait(lock, stop, [this] { return polls; });
}

void Gamepads::Data::run(const std::stop_token& stop) {
    if (!wanted(stop)) return;
    OpenPads pads;
    while (wanted(stop)) {
        tell(pads.read());
        std::unique_lock lock(mutex);
        changed.wait_for(lock, stop, kPoll, [this] { return !polls; });
        if (stop.stop_requested()) return;
    }
}

Gamepads::Gamepads(std::function<void(const ShowInput&)> told) : data_(std::make_unique<Data>(std::move(told))) {
    data_->thread = std::jthread([data = data_.get()](const std::stop_token& stop) { data->run(stop); });
}

Gamepads::~Gamepads() = default;

void Gamepads::setPolling(bool polls) {
    {
        const std::scoped_lock lock(data_->mutex);
        data_->polls = polls;
    }
    data_->changed.notify_all();
}

} // namespace lumorph::studio
