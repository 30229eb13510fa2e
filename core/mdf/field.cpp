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

BitColumns reachableVoxels(const Field& field) {
    BitColumns reachable(field.frame.dimensions);
    const auto width = static_cast<std::uint32_t>(field.frame.dimensions.x);
    for (const ActuatorField& actuator : field.actuators)
        for (const ActuatorField::Run& run : actuator.runs)
            for (std::uint32_t i = 0; i < run.count; ++i)
                if (actuator.ramps[run.firstRamp + i].v0 != kUnchanged)
                    reachable.set(static_cast<int>(run.column % width), run.firstY + static_cast<int>(i),
                                  static_cast<int>(run.column / width));
    return reachable;
}

} // namespace lumorph
