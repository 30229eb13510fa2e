#include "core/mdf/field_view.h"

#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>

#include <glm/common.hpp>

#include "core/base/error.h"

namespace lumorph {

namespace {

void requireActuator(const Field& field, std::optional<std::size_t> actuator) {
    if (!actuator || *actuator < field.actuators.size()) return;
    throw InvalidInput("actuator " + std::to_string(*actuator),
                       "the field has " + std::to_string(field.actuators.size()) + " actuators",
                       "give the number of one of them, from 0");
}

/// Calls ramp(voxel index, ramp) for every voxel that the actuator changes (that any of them does, in turn).
template <typename Visit> void eachRamp(const Field& field, std::optional<std::size_t> actuator, Visit&& visit) {
    const auto height = static_cast<std::size_t>(field.frame.dimensions.y);
    const std::span<const ActuatorField> all = field.actuators;
    for (const ActuatorField& from : actuator ? all.subspan(*actuator, 1) : all)
        for (const ActuatorField::Run& run : from.runs) {
            const std::size_t voxel = run.column * height + run.firstY;
            const std::span<const Ramp> ramps = std::span(from.ramps).subspan(run.firstRamp, run.count);
            for (std::size_t i = 0; i < ramps.size(); ++i)
                if (ramps[i].v0 != kUnchanged) visit(voxel + i, ramps[i]);
        }
}

/// Inclusive bounds of a slice within the frame; empty when any `to` lies below its `from`.
struct Slice {
    glm::ivec3 from;
    glm::ivec3 to;
};

Slice sliceOf(const Field& field, const FieldViewOptions& options) {
    return {glm::max(options.sliceFrom, glm::ivec3(0)), glm::min(options.sliceTo, field.frame.dimensions - 1)};
}

BitColumns shownVoxels(const Field& field, const FieldViewOptions& options, const std::vector<std::uint8_t>& levels) {
    BitColumns shown(field.frame.dimensions);
    const Slice slice = sliceOf(field, options);
    for (int z = slice.from.z; z <= slice.to.z; ++z)
        for (int x = slice.from.x; x <= slice.to.x; ++x) {
            const std::uint8_t* column = &levels[field.voxelIndex(x, 0, z)];
            for (int y = slice.from.y; y <= slice.to.y; ++y)
                if (column[y] != kUnchanged && column[y] >= options.lowestLevel && column[y] <= options.highestLevel)
                    shown.set(x, y, z);
        }
    if (options.touchedBy) shown &= *options.touchedBy;
    return shown;
}

/// Expected coverage at voxel centres, zero beyond the frame.
struct CoverageGrid {
    glm::ivec3 size;
    std::vector<float> values; ///< Field::voxelIndex order

    [[nodiscard]] float at(const glm::ivec3& v) const {
        if (v.x < 0 || v.y < 0 || v.z < 0 || v.x >= size.x || v.y >= size.y || v.z >= size.z) return 0.0F;
        const auto column =
            static_cast<std::size_t>(v.z) * static_cast<std::size_t>(size.x) + static_cast<std::size_t>(v.x);
        return values[column * static_cast<std::size_t>(size.y) + static_cast<std::size_t>(v.y)];
    }
};

/// Marching tetrahedra: every cube of eight voxel centres is cut into six tetrahedra around its diagonal. Neighbouring
/// cubes cut their common face alike, so the surface is closed and every edge has two triangles, whatever the values.
class TetrahedraMarch {
public:
    TetrahedraMarch(const VoxelFrame& frame, const CoverageGrid& grid) : frame_(frame), grid_(grid) {}

    TriangleMesh run() {
        const glm::ivec3 size = grid_.size;
        for (int z = -1; z < size.z; ++z)
            for (int x = -1; x < size.x; ++x)
                for (int y = -1; y < size.y; ++y) marchCube({x, y, z});
        return std::move(mesh_);
    }

private:
    static constexpr float kHalf = 0.5F;

    struct Corner {
        glm::ivec3 voxel;
        float value = 0.0F;
        [[nodiscard]] bool inside() const { return value >= kHalf; }
    };

    void marchCube(const glm::ivec3& low) {
        std::array<Corner, 8> corners;
        int inside = 0;
        for (int c = 0; c < 8; ++c) {
            const glm::ivec3 voxel = low + glm::ivec3(c & 1, (c >> 1) & 1, c >> 2);
            corners[static_cast<std::size_t>(c)] = {voxel, grid_.at(voxel)};
            inside += corners[static_cast<std::size_t>(c)].inside();
        }
        if (inside == 0 || inside == 8) return;
        // The paths from corner 0 to corner 7 along the axes in each order; the even orders are right-handed.
        constexpr int kMiddles[6][2] = {{1, 3}, {2, 6}, {4, 5}, {2, 3}, {1, 5}, {4, 6}};
        for (std::size_t k = 0; k < 6; ++k)
            marchTetrahedron({&corners[0], &corners[static_cast<std::size_t>(kMiddles[k][0])],
                              &corners[static_cast<std::size_t>(kMiddles[k][1])], &corners[7]},
                             k < 3);
    }

    void marchTetrahedron(std::array<const Corner*, 4> t, bool rightHanded) {
        // Inner corners to the front; each exchange turns the tetrahedron over.
        std::size_t inner = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            if (!t[i]->inside()) continue;
            if (i != inner) {
                std::swap(t[i], t[inner]);
                rightHanded = !rightHanded;
            }
            ++inner;
        }
        const auto cut = [&](std::size_t in, std::size_t out) { return vertexBetween(*t[in], *t[out]); };
        if (inner == 1) addTriangle(cut(0, 1), cut(0, 2), cut(0, 3), rightHanded);
        if (inner == 3) addTriangle(cut(0, 3), cut(1, 3), cut(2, 3), rightHanded);
        if (inner == 2) {
            addTriangle(cut(0, 2), cut(0, 3), cut(1, 3), rightHanded);
            addTriangle(cut(0, 2), cut(1, 3), cut(1, 2), rightHanded);
        }
    }

    void addTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c, bool rightHanded) {
        mesh_.triangles.push_back(rightHanded ? glm::uvec3(a, b, c) : glm::uvec3(a, c, b));
    }

    std::uint32_t vertexBetween(const Corner& in, const Corner& out) {
        const std::uint64_t first = numberOf(in.voxel);
        const std::uint64_t second = numberOf(out.voxel);
        const glm::ivec3 step = glm::abs(in.voxel - out.voxel);
        const int way = step.x + 2 * step.y + 4 * step.z;
        const auto direction = static_cast<std::uint64_t>(way);
        const auto [known, isNew] = vertices_.try_emplace(8 * std::min(first, second) + direction,
                                                          static_cast<std::uint32_t>(mesh_.positions.size()));
        if (isNew) {
            // Away from the corners, so that no triangle shrinks to a point.
            const double share =
                glm::clamp(static_cast<double>((in.value - kHalf) / (in.value - out.value)), 0.05, 0.95);
            mesh_.positions.emplace_back(glm::mix(centre(in.voxel), centre(out.voxel), share));
        }
        return known->second;
    }

    [[nodiscard]] glm::dvec3 centre(const glm::ivec3& v) const { return frame_.centre(v.x, v.y, v.z); }

    /// Of a voxel of the frame or the layer around it.
    [[nodiscard]] std::uint64_t numberOf(const glm::ivec3& v) const {
        const glm::u64vec3 at(v + 1);
        const glm::u64vec3 size(grid_.size + 2);
        return (at.z * size.x + at.x) * size.y + at.y;
    }

    const VoxelFrame& frame_;
    const CoverageGrid& grid_;
    TriangleMesh mesh_;
    std::unordered_map<std::uint64_t, std::uint32_t> vertices_; ///< by grid edge
};

} // namespace

std::vector<std::uint8_t> firstLevels(const Field& field, std::optional<std::size_t> actuator) {
    requireActuator(field, actuator);
    std::vector<std::uint8_t> levels(field.frame.voxelCount(), kUnchanged);
    eachRamp(field, actuator, [&](std::size_t v, const Ramp& ramp) { levels[v] = std::min(levels[v], ramp.v0); });
    return levels;
}

std::vector<glm::ivec3> surfaceVoxels(const BitColumns& voxels, const glm::ivec3& from, const glm::ivec3& to) {
    const glm::ivec3 first = glm::max(from, glm::ivec3(0));
    const glm::ivec3 last = glm::min(to, voxels.dimensions() - 1);
    const auto outside = [&](int x, int y, int z) {
        return x < first.x || y < first.y || z < first.z || x > last.x || y > last.y || z > last.z ||
               !voxels.test(x, y, z);
    };
    std::vector<glm::ivec3> surface;
    for (int z = first.z; z <= last.z; ++z)
        for (int x = first.x; x <= last.x; ++x)
            for (int y = first.y; y <= last.y; ++y)
                if (voxels.test(x, y, z) && (outside(x - 1, y, z) || outside(x + 1, y, z) || outside(x, y - 1, z) ||
                                             outside(x, y + 1, z) || outside(x, y, z - 1) || outside(x, y, z + 1)))
                    surface.emplace_back(x, y, z);
    return surface;
}

std::vector<FieldVoxel> fieldVoxels(const Field& field, const FieldViewOptions& options) {
    if (options.touchedBy && options.touchedBy->dimensions() != field.frame.dimensions)
        throw InvalidInput("target", "its voxel grid has another shape than the field's",
                           "voxelise it into the field's own frame");
    const std::vector<std::uint8_t> levels = firstLevels(field, options.actuator);
    const BitColumns shown = shownVoxels(field, options, levels);
    std::vector<FieldVoxel> voxels;
    const auto add = [&](const glm::ivec3& v) { voxels.push_back({v, levels[field.voxelIndex(v.x, v.y, v.z)]}); };
    if (options.surfaceOnly) {
        for (const glm::ivec3& v : surfaceVoxels(shown)) add(v);
        return voxels;
    }
    const Slice slice = sliceOf(field, options);
    for (int z = slice.from.z; z <= slice.to.z; ++z)
        for (int x = slice.from.x; x <= slice.to.x; ++x)
            for (int y = slice.from.y; y <= slice.to.y; ++y)
                if (shown.test(x, y, z)) add({x, y, z});
    return voxels;
}

TriangleMesh levelSurface(const Field& field, std::optional<std::size_t> actuator, int level) {
    requireActuator(field, actuator);
    if (level < 0 || level >= field.levels)
        throw InvalidInput("level " + std::to_string(level), "levels run from 0 to " + std::to_string(field.levels - 1),
                           "give a level in that range");
    CoverageGrid grid{field.frame.dimensions, std::vector<float>(field.frame.voxelCount(), 0.0F)};
    eachRamp(field, actuator, [&](std::size_t v, const Ramp& ramp) {
        grid.values[v] = std::max(grid.values[v], static_cast<float>(expectationAt(ramp, level)));
    });
    return TetrahedraMarch(field.frame, grid).run();
}

std::vector<std::vector<double>> rampsAt(const Field& field, const glm::ivec3& voxel) {
    const glm::ivec3 size = field.frame.dimensions;
    if (voxel.x < 0 || voxel.y < 0 || voxel.z < 0 || voxel.x >= size.x || voxel.y >= size.y || voxel.z >= size.z)
        throw InvalidInput("voxel", "it lies outside the field's frame", "give one within it");
    const double background = field.background[field.voxelIndex(voxel.x, voxel.y, voxel.z)] / 255.0;
    const auto column = static_cast<std::uint32_t>(field.body.columnIndex(voxel.x, voxel.z));
    std::vector<std::vector<double>> ramps;
    for (const ActuatorField& actuator : field.actuators) {
        std::vector<double>& values = ramps.emplace_back(static_cast<std::size_t>(field.levels), background);
        const auto run = std::lower_bound(actuator.runs.begin(), actuator.runs.end(), column,
                                          [](const ActuatorField::Run& r, std::uint32_t c) { return r.column < c; });
        if (run == actuator.runs.end() || run->column != column) continue;
        const int above = voxel.y - run->firstY;
        if (above < 0 || above >= run->count) continue;
        const Ramp& ramp = actuator.ramps[run->firstRamp + static_cast<std::size_t>(above)];
        if (ramp.v0 == kUnchanged) continue;
        for (int level = 0; level < field.levels; ++level)
            values[static_cast<std::size_t>(level)] = expectationAt(ramp, level);
    }
    return ramps;
}

} // namespace lumorph
