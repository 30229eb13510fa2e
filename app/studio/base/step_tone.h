#pragma once

namespace lumorph::studio {

/// How things stand where somebody is led through steps: the colour of the card that says what is to be done next.
enum class StepTone {
    quiet, ///< it waits for the user
    live,  ///< something runs, or is to be measured now
    good,
    warning,
    failure
};

} // namespace lumorph::studio
