#pragma once

#include <functional>
#include <string>

#include "devices/controllers/servo_link.h"

namespace lumorph {

/// Makes words of what a controller's state tells, each once for each occasion. Pure.
class LinkWatch {
public:
    using Tell = std::function<void(LinkEvent::Kind, std::string text, std::string remedy)>;
    explicit LinkWatch(Tell tell) : tell_(std::move(tell)) {}

    /// The link has just been opened.
    void opened(const ControllerState& state);
    void look(const ControllerState& state, Microseconds now);

private:
    void lookAtPhase(const ControllerState& state);
    void lookAtBattery(const ControllerState& state);
    void lookAtNoise(const ControllerState& state, Microseconds now);
    void lookAtWords(const ControllerState& state);

    Tell tell_;
    ControllerPhase phase_ = ControllerPhase::handshake;
    bool low_ = false;   ///< the battery, as it was told
    bool noisy_ = false; ///< the link, as it was told
    std::uint64_t errors_ = 0;
    Microseconds window_{0}; ///< when errors_ was taken
    std::string words_;
};

} // namespace lumorph
