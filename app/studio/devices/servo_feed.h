#pragma once

#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "app/studio/devices/held_servos.h"
#include "devices/controllers/servo_link.h"

namespace lumorph::studio {

/// Why servos are slow.
enum class SlowCause {
    user,
    hand, ///< one that is tracked is near
    held  ///< some servo does not follow
};

/// What the servos are told: the strokes of the show, except those that are held for a test. Any thread.
class ServoFeed {
public:
    /// Strokes a second at which a servo goes to where a test wants it, and back.
    static constexpr double kTestVelocity = 0.25;

    /// Tells this link from now on, at once what was told last; null: none. The one before is still stopped, and
    /// slowed, for as long as somebody holds it: it may be on its way to rest.
    void attach(std::shared_ptr<ServoLink> link, std::size_t servos);
    /// STOP: the servos of all links are detached, whatever the window does.
    void stop();
    /// The same, and waits until the boards should know: at most so long. False where they may not.
    bool letGo(std::chrono::milliseconds atMost);
    /// Whether servos were driven when STOP came; forgotten by asking.
    [[nodiscard]] bool takeStoppedLive();
    /// Where the show has the device now. Told on where it fits the servos. `anew`: it is another show than the servos
    /// followed until now, so they go to it slowly from where they were told to be.
    void follow(std::span<const double> strokes, bool anew = false);
    /// What `follow` was told last; empty before.
    [[nodiscard]] std::vector<double> shown() const;

    /// All servos move slowly as long as there is any cause for it.
    void setSlow(SlowCause cause, bool on);
    /// Looks whether servos follow, and makes all slow where one does not; ten times a second or more often.
    void checkHands(Microseconds now);
    /// Servos that do not follow.
    [[nodiscard]] std::vector<std::size_t> stuck() const;

    /// Moves one servo slowly from where it was told to be, and keeps it there.
    void hold(std::size_t servo, double stroke);
    /// Lets all go back to the show, slowly.
    void release();
    /// Forgets all tests at once; for when servos stand without pulses anyway.
    void drop();
    [[nodiscard]] std::optional<double> held(std::size_t servo) const;
    /// Some servo is held, or on its way back.
    [[nodiscard]] bool testing() const;
    /// Some servo is on its way to a test or back.
    [[nodiscard]] bool moving() const;
    /// Time passes for the tests.
    void advance(double seconds);

private:
    struct Hold {
        double now = 0.0;
        std::optional<double> aim; ///< nothing: back to the show
    };
    void tell();
    void slow(SlowCause cause, bool on);
    template <class Order> void eachLeaving(Order order);

    mutable std::mutex mutex_;
    std::shared_ptr<ServoLink> link_;
    std::vector<std::weak_ptr<ServoLink>> leaving_;
    std::vector<double> show_;
    std::vector<std::optional<Hold>> holds_; ///< one a servo
    std::vector<double> told_;
    bool stoppedLive_ = false;
    unsigned causes_ = 0; ///< to be slow, a bit each
    HeldServos heldServos_;
};

} // namespace lumorph::studio
