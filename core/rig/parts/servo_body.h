#pragma once

#include <span>
#include <string_view>

namespace lumorph {

/// A servo's body as its published drawing states it, millimetres. Y runs along the shaft from the bottom of the case,
/// X along the case from the shaft away to its far end.
struct ServoBody {
    std::string_view name;
    std::string_view source;
    double length = 0.0;        ///< of the case, along X
    double width = 0.0;         ///< of the case, across
    double height = 0.0;        ///< of the case, along Y, without what stands on it
    double shaft = 0.0;         ///< from the near end of the case to the shaft
    double boss = 0.0;          ///< height of what stands on the case around the shaft
    double tabs = 0.0;          ///< from end to end of the mounting tabs
    double tabBottom = 0.0;     ///< from the bottom of the case to the tabs
    double tabThickness = 0.0;  ///< of the tabs
    double hornTop = 0.0;       ///< from the bottom of the case to the outer face of the horn's arm
    double hornHub = 0.0;       ///< diameter of the horn around the shaft
    double hornTip = 0.0;       ///< width of the horn's arm at its end
    double hornReach = 0.0;     ///< from the shaft to the end of the arm
    double degreesPerPulse = 0; ///< by which it turns, a microsecond
};

/// Those there are drawings of; the first is what is taken without a choice.
[[nodiscard]] std::span<const ServoBody> servoBodies();
/// By name, capitals or not. Throws InvalidInput naming those there are.
[[nodiscard]] const ServoBody& servoBody(std::string_view name);

} // namespace lumorph
