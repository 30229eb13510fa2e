#pragma once

#include "app/studio/base/settings.h"

namespace lumorph::studio {

/// The number by which the operator opens a kiosk. The settings keep it salted and hashed (PBKDF2 with SHA-256), and
/// how many wrong tries there were: after five, each further one makes the pause before the next twice as long. It
/// keeps visitors out, not who can read this user's files: a number of a few digits is soon found by trying.
class OperatorPin {
public:
    static constexpr int kFewestDigits = 4, kMostDigits = 8;

    /// Both outlive it. A pause that was running when the program ended begins anew.
    OperatorPin(Settings& settings, const Clock& clock);

    /// As the settings' file says now: another process may have forgotten it.
    [[nodiscard]] bool isSet() const;
    /// False: it is not of 4 to 8 digits, and nothing changes.
    bool choose(const QString& pin);
    enum class Answer { right, wrong, paused }; ///< paused: it was not even looked at
    Answer attempt(const QString& pin);
    [[nodiscard]] int wrongAttempts() const;
    /// Whole seconds until an attempt counts again; 0: now.
    [[nodiscard]] int secondsToWait() const;

    /// The way out for who forgot it: the next kiosk asks for a new one.
    static void forget(Settings& settings);

private:
    void pause();

    Settings& settings_;
    const Clock& clock_;
    Microseconds pausedUntil_{0};
};

} // namespace lumorph::studio
