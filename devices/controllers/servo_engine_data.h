#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "devices/controllers/servo_engine.h"
#include "devices/controllers/servo_guard.h"
#include "devices/controllers/servo_link_watch.h"

namespace lumorph {

/// What a ServoEngine holds. Private to servo_engine*.cpp.
struct ServoEngine::Data {
    using Kind = LinkEvent::Kind;

    explicit Data(const DeviceProfile& its);

    DeviceProfile profile;
    DeviceProfile made; ///< what the controller was made for
    std::unique_ptr<ServoController> controller;
    ServoGuard guard;
    LinkWatch watch;
    std::vector<ServoOutput> output;

    // Time: of the inputs, counted from the first one, so that it does not matter when that was; and what has passed,
    // which never runs back, for all that ends by itself.
    std::optional<Microseconds> origin;
    Microseconds outside{0}; ///< of the input, as it was told
    Microseconds now{0};
    Microseconds passed{0};

    // The link.
    bool connected = false; ///< its user wants it to be
    bool wanted = false;    ///< it was asked to open, and will try again by itself
    bool open = false;
    bool everOpen = false;
    bool foreign = false; ///< not the board of the profile, and nobody has said that it will do
    std::string product;
    std::string identity;
    std::optional<LinkTrouble> linkTrouble;
    std::uint64_t unsent = 0;
    std::uint64_t mostUnsent = 0; ///< more means that the link stalls

    bool slow = false;
    bool waitingTold = false;
    bool quitting = false;
    bool done = false;
    std::optional<Microseconds> restUntil; ///< by `passed`, as all that follow
    std::optional<Microseconds> closeAfter;
    std::optional<DeviceProfile> next; ///< for after the closing
    std::optional<Microseconds> stalledSince;
    bool stallTold = false;
    std::optional<Microseconds> silentSince;
    bool silenceTold = false;
    Microseconds busyUntil{0};
    Microseconds movedAt{0};
    std::uint64_t reboots = 0;
    std::uint64_t reconnects = 0;
    std::uint64_t bytesSent = 0;
    std::vector<GuardedPulse> pulses; ///< of the last step
    std::vector<Microseconds> heldAt; ///< by servo, when it last got a pulse
    std::vector<long> written;        ///< the same in the controller's steps, when pulses were last written

    /// Returns how much time has passed since the input before.
    Microseconds see(Microseconds time);
    void noticeHang(Microseconds pause);
    void letGoAfterHang(Microseconds pause);
    void make();
    void tell(Kind kind, std::string text, std::string remedy = "");
    [[nodiscard]] bool armed() const {
        return guard.phase() == ServoGuard::Phase::starting || guard.phase() == ServoGuard::Phase::live;
    }
    [[nodiscard]] bool ready() const {
        return open && !foreign && !silentSince && controller->state().phase == ControllerPhase::ready;
    }

    // Of the user.
    void take(const servo_input::Connect&);
    void take(const servo_input::Disconnect&);
    void take(const servo_input::Confirm&);
    void take(const servo_input::Arm& arm);
    void take(const servo_input::Disarm&);
    void take(const servo_input::Stop&);
    void take(const servo_input::Command& command);
    void take(const servo_input::Wiggle& wiggle);
    void take(const servo_input::Slow& order);
    void take(const servo_input::Profile& order);
    void take(const servo_input::Quit&);
    // Of the link.
    void take(const servo_input::Opened& opened);
    void take(const servo_input::Received& received);
    void take(const servo_input::Lost& lost);
    void take(const servo_input::Released&);
    // What is due.
    void take(const servo_input::Tick& tick);

    void openLink();
    void drive();
    void noticeReboot();
    void readPositions();
    bool stalled();
    bool waitOutSilence();
    void forget();
    void send();
    void flush(bool urgent = false);
    void close();
    void finishRest();
    void finishClosing();
    void tellWaiting();

    [[nodiscard]] LinkPhase phase() const;
    [[nodiscard]] LinkStatus status() const;
};

} // namespace lumorph
