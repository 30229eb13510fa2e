#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/triangle_mesh.h"
#include "core/mdf/builder.h"
#include "core/mdf/coverage.h"
#include "core/mdf/voting.h"
#include "core/rig/rig.h"

namespace lumorph::bench {

/// A volume to be matched; voxels of a field's frame outside the body.
struct TargetVolume {
    enum class Kind { mesh, wave, relief, hidden };
    std::string name;
    Kind kind = Kind::hidden;
    BitColumns voxels;
};

/// A rig with its field and what matching needs of it.
struct Device {
    Device(Rig rig, const BuildOptions& options);
    Field field;
    Coverage coverage;
    Voting voting;
};

/// A rig of resources/models at 33 voxels, with 64 samples.
[[nodiscard]] std::unique_ptr<Device> makeDevice(const std::string& model, int levels);

/// A mesh of the shared folder beside the tree; none when it is not there.
[[nodiscard]] std::optional<TriangleMesh> sharedMesh(const std::string& fileName);
inline constexpr const char* kSharedMeshes[] = {"spot.obj", "rocker-arm.obj"};

/// A closed, bumpy ellipsoid of exactly 70,000 triangles around the origin, about 2 units wide.
[[nodiscard]] TriangleMesh bumpyEllipsoid();
/// The mesh with triangles divided at their centres until there are `count` or one more; it stays closed.
[[nodiscard]] TriangleMesh dividedTo(TriangleMesh mesh, std::size_t count);
/// Placed as `--fit` does.
[[nodiscard]] TriangleMesh fitted(const Field& field, const TriangleMesh& mesh);

/// Volumes of random joint states (seeded).
[[nodiscard]] std::vector<TargetVolume> hiddenStates(const Coverage& coverage, int count, std::uint64_t seed);
/// Six waves and six reliefs: solids under a height field that stands on the rest surface.
[[nodiscard]] std::vector<TargetVolume> wavesAndReliefs(const Field& field, const BitColumns& domain);
/// The shared meshes that are there, fitted.
[[nodiscard]] std::vector<TargetVolume> meshTargets(const Field& field, const BitColumns& domain);
/// All of these, with 20 hidden states.
[[nodiscard]] std::vector<TargetVolume> allTargets(const Device& device);
/// By how much the best IoU must exceed that of the device at rest, or a target says nothing about a search.
inline constexpr double kWorthwhile = 0.15;

} // namespace lumorph::bench
