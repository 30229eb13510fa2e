#include "core/mdf/field_export.h"

#include <string>
#include <system_error>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/voxels/nrrd.h"

namespace lumorph {

namespace {

/// Reorders from Field::voxelIndex (y fastest) to NRRD's order (x fastest).
template <typename Value> ByteGrid gridOf(const Field& field, Value&& value) {
    const glm::ivec3& d = field.frame.dimensions;
    ByteGrid grid{field.frame, {}};
    grid.values.reserve(field.frame.voxelCount());
    for (int z = 0; z < d.z; ++z)
        for (int y = 0; y < d.y; ++y)
            for (int x = 0; x < d.x; ++x) grid.values.push_back(value(field.voxelIndex(x, y, z)));
    return grid;
}

} // namespace

void exportField(const Field& field, const std::filesystem::path& folder, const Progress& progress) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error)
        throw DeviceError(folder.string(), "the folder cannot be made (" + error.message() + ")",
                          "choose another place");
    const auto save = [&](const ByteGrid& grid, const std::string& name) {
        writeFileAtomically(folder / (name + ".nrrd"), writeNrrd(grid, name));
    };
    for (std::size_t i = 0; i < field.actuators.size(); ++i) {
        progress.throwIfCancelled();
        progress.report(static_cast<double>(i) / static_cast<double>(field.actuators.size() + 1), "writing the grids");
        const std::vector<Ramp> ramps = denseRamps(field, i);
        const std::string prefix = "actuator-" + std::to_string(i) + "-";
        save(gridOf(field, [&](std::size_t v) { return ramps[v].v0; }), prefix + "v0");
        save(gridOf(field, [&](std::size_t v) { return ramps[v].v1; }), prefix + "v1");
        save(gridOf(field, [&](std::size_t v) { return ramps[v].base; }), prefix + "base");
        save(gridOf(field, [&](std::size_t v) { return ramps[v].top; }), prefix + "top");
    }
    save(gridOf(field, [&](std::size_t v) { return field.background[v]; }), "background");
    save(bytesOf(field.frame, field.body), "body");
}

} // namespace lumorph
