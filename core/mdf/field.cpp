#include "core/mdf/field.h"

namespace lumorph {

std::vector<Ramp> denseRamps(const Field& field, std::size_t actuator) {
    std::vector<Ramp> dense(field.frame.voxelCount());
    const ActuatorField& from = field.actuators[actuator];
    for (const ActuatorField::Run& run : from.runs) {
        const std::size_t start =
            static_cast<std::size_t>(run.column) * static_cast<std::size_t>(field.frame.dimensions.y) + run.firstY;
        for (std::size_t i = 0; i < run.count; ++i) dense[start + i] = from.ramps[run.firstRamp + i];
    }
    return dense;
}

} // namespace lumorph
