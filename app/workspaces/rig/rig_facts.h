#pragma once

#include <string_view>
#include <vector>

#include <QString>
#include <QWidget>

#include "core/rig/shape_report.h"
#include "core/rig/shape_resolution.h"
#include "devices/controllers/device_profile.h"

namespace lumorph::studio {

/// Words of the core as the window shows them.
[[nodiscard]] inline QString shownText(std::string_view words) {
    return QString::fromUtf8(words.data(), static_cast<qsizetype>(words.size()));
}

/// One thing to know about a rig, in plain words.
struct RigFact {
    QString name;
    QString value;
    QString why; ///< what it means, for a tooltip
};

/// How far an actuator goes from rest to full stroke.
struct ActuatorRange {
    enum class Motion { turning, moving, blending } motion = Motion::blending;
    double min = 0.0, max = 1.0; ///< radians, metres or weight
};
[[nodiscard]] ActuatorRange rangeOf(const Actuator& actuator);
/// Another range for an actuator that turns or moves; not for a lever of a sheet, whose shapes were computed for its.
/// Its servo is as fast as before, and turns as far for an angle or a way: velocity limit and pulses, which count
/// strokes, follow the range. Pulses stay where 500 to 2500 microseconds would not reach.
void setRange(Actuator& actuator, double min, double max);

/// "Hinge", "Bend", "Slide", "Morph target", "Joint" or "Lever of the sheet".
[[nodiscard]] QString deformerText(const Actuator& actuator);
/// "0° to 45°", "0 to 20 mm" or "0 to 1".
[[nodiscard]] QString rangeText(const Actuator& actuator);
/// "53.6 mm" of metres.
[[nodiscard]] QString lengthText(double metres);
/// "0.094 N m", in two digits.
[[nodiscard]] QString torqueText(double newtonMetres);
/// Torque, speed, pulses, size and price of a kind of servo, in a line each.
[[nodiscard]] QString servoTypeText(const ServoType& type);
/// What an actuator's servo has to hold and whether it can, in a sentence or two; where it is too weak, which would do.
[[nodiscard]] QString servoLoadText(const ServoLoad& load);
/// The shortest time that a servo takes from rest to full stroke, seconds: as it turns without load.
[[nodiscard]] double fastestStroke(const Actuator& actuator, const ServoType& servo);
/// What a maker and a controller need to know of an actuator beside what they edit. `amplitude` is that of amplitudeOf.
/// The channel is the rig's; its pulse and its place at the board are those of its servo's set-up, the same that the
/// Devices workspace shows; null: as the rig's file says.
[[nodiscard]] std::vector<RigFact> factsOf(const Rig& rig, std::size_t actuator, double amplitude,
                                           const ServoSetup* setup = nullptr);

[[nodiscard]] std::vector<RigFact> meshFacts(const ShapeReport& report);
[[nodiscard]] std::vector<RigFact> shapeFacts(const ShapeReport& report);

/// Rows of a name and a value that can be selected; a value is called `prefix` and its name in small letters.
[[nodiscard]] QWidget* makeFacts(const std::vector<RigFact>& facts, const QString& prefix, QWidget* parent);

} // namespace lumorph::studio
