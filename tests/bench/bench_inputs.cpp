#include "tests/bench/bench_inputs.h"

#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>
#include <random>

#include "core/base/resources.h"
#include "core/geometry/mesh_file.h"
#include "core/mdf/placement.h"
#include "core/rig/rig_file.h"
#include "core/voxels/solid.h"

namespace lumorph::bench {

namespace {

/// A height in [0, 1] over a place in [0, 1] x [0, 1].
using HeightField = std::function<double(double u, double w)>;

BitColumns under(const Field& field, const BitColumns& domain, const HeightField& height) {
    BitColumns bits(field.frame.dimensions);
    const glm::ivec3 size = field.frame.dimensions;
    const double rest = static_cast<double>(field.restSurface);
    const double room = static_cast<double>(field.frame.box().max.y) - rest;
    for (int z = 0; z < size.z; ++z)
        for (int x = 0; x < size.x; ++x) {
            const double top = rest + room * height((x + 0.5) / size.x, (z + 0.5) / size.z);
            for (int y = 0; y < size.y; ++y) {
                const double centre = field.frame.centre(x, y, z).y;
                if (centre > rest && centre <= top && domain.test(x, y, z)) bits.set(x, y, z);
            }
        }
    return bits;
}

double wave(double phase) { return 0.5 + 0.5 * std::sin(2.0 * std::numbers::pi * phase); }

double bump(double u, double w, double centreU, double centreW, double radius) {
    const double du = (u - centreU) / radius;
    const double dw = (w - centreW) / radius;
    return std::exp(-(du * du + dw * dw));
}

} // namespace

Device::Device(Rig rig, const BuildOptions& options)
    : field(buildField(rig, options)), coverage(std::move(rig), field.frame, options.levels), voting(field) {}

std::unique_ptr<Device> makeDevice(const std::string& model, int levels) {
    BuildOptions options;
    options.levels = levels;
    return std::make_unique<Device>(readRig(resourceFile("models/" + model)), options);
}

std::optional<TriangleMesh> sharedMesh(const std::string& fileName) {
    const std::filesystem::path file = std::filesystem::path(LUMORPH_SHARED_DIR) / "data" / "meshes" / fileName;
    if (!std::filesystem::exists(file)) return std::nullopt;
    return readMesh(file);
}

TriangleMesh bumpyEllipsoid() {
    constexpr std::uint32_t kAround = 250;
    constexpr std::uint32_t kRings = 140; // 2 x 250 x 140 = 70,000
    TriangleMesh mesh;
    const auto point = [](double polar, double around) {
        const double radius = 1.0 + 0.08 * std::sin(7.0 * around) * std::sin(polar) * std::sin(6.0 * polar);
        return glm::vec3(radius * std::sin(polar) * std::cos(around), 0.8 * radius * std::cos(polar),
                         0.7 * radius * std::sin(polar) * std::sin(around));
    };
    mesh.positions.push_back(point(0.0, 0.0));
    for (std::uint32_t ring = 1; ring <= kRings; ++ring)
        for (std::uint32_t k = 0; k < kAround; ++k)
            mesh.positions.push_back(
                point(std::numbers::pi * ring / (kRings + 1), 2.0 * std::numbers::pi * k / kAround));
    mesh.positions.push_back(point(std::numbers::pi, 0.0));
    const auto last = static_cast<std::uint32_t>(mesh.positions.size() - 1);
    const auto at = [&](std::uint32_t ring, std::uint32_t k) { return 1 + ring * kAround + k % kAround; };
    for (std::uint32_t k = 0; k < kAround; ++k) {
        mesh.triangles.emplace_back(0, at(0, k + 1), at(0, k));
        for (std::uint32_t ring = 0; ring + 1 < kRings; ++ring) {
            mesh.triangles.emplace_back(at(ring, k), at(ring, k + 1), at(ring + 1, k));
            mesh.triangles.emplace_back(at(ring, k + 1), at(ring + 1, k + 1), at(ring + 1, k));
        }
        mesh.triangles.emplace_back(at(kRings - 1, k), at(kRings - 1, k + 1), last);
    }
    return mesh;
}

TriangleMesh dividedTo(TriangleMesh mesh, std::size_t count) {
    for (std::size_t k = 0; mesh.triangles.size() < count; ++k) {
        const glm::uvec3 t = mesh.triangles[k];
        const auto centre = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.push_back((mesh.positions[t.x] + mesh.positions[t.y] + mesh.positions[t.z]) / 3.0F);
        mesh.triangles[k] = {t.x, t.y, centre};
        mesh.triangles.emplace_back(t.y, t.z, centre);
        mesh.triangles.emplace_back(t.z, t.x, centre);
    }
    return mesh;
}

TriangleMesh fitted(const Field& field, const TriangleMesh& mesh) {
    return placed(mesh, fitPlacement(field, boundingBox(mesh.positions)));
}

std::vector<TargetVolume> hiddenStates(const Coverage& coverage, int count, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::uniform_int_distribution<int> level(0, coverage.levels() - 1);
    CoverageScratch scratch;
    std::vector<TargetVolume> targets;
    for (int k = 0; k < count; ++k) {
        State state(coverage.rig().actuatorCount());
        for (Level& of : state) of.index = level(random);
        TargetVolume& target =
            targets.emplace_back(TargetVolume{"hidden " + std::to_string(k), TargetVolume::Kind::hidden, {}});
        coverage.covered(state, target.voxels, scratch);
    }
    return targets;
}

std::vector<TargetVolume> wavesAndReliefs(const Field& field, const BitColumns& domain) {
    const HeightField waves[] = {
        [](double u, double) { return 0.8 * wave(u); },
        [](double u, double) { return 0.9 * wave(1.5 * u + 0.25); },
        [](double, double w) { return 0.8 * wave(w + 0.1); },
        [](double u, double w) { return 0.7 * wave(u + w); },
        [](double u, double w) { return 0.9 * wave(u) * wave(w + 0.2); },
        [](double u, double w) { return 0.6 * wave(2.0 * std::hypot(u - 0.5, 0.7 * (w - 0.5)) + 0.3); },
    };
    const HeightField reliefs[] = {
        [](double u, double w) { return 0.9 * bump(u, w, 0.15, 0.2, 0.3); },
        [](double u, double w) { return 0.8 * bump(u, w, 0.1, 0.9, 0.35) + 0.6 * bump(u, w, 0.9, 0.1, 0.3); },
        [](double u, double w) { return 0.9 * bump(u, w, 0.5, 0.0, 0.4); },
        [](double u, double) { return 0.9 * std::abs(2.0 * u - 1.0); },
        [](double u, double w) { return 0.8 * u * w; },
        [](double u, double w) { return 0.6 * (1.0 - bump(u, w, 0.5, 0.5, 0.4)); },
    };
    std::vector<TargetVolume> targets;
    for (const HeightField& height : waves)
        targets.push_back(
            {"wave " + std::to_string(targets.size()), TargetVolume::Kind::wave, under(field, domain, height)});
    for (const HeightField& height : reliefs)
        targets.push_back({"relief " + std::to_string(targets.size() - std::size(waves)), TargetVolume::Kind::relief,
                           under(field, domain, height)});
    return targets;
}

std::vector<TargetVolume> meshTargets(const Field& field, const BitColumns& domain) {
    std::vector<TargetVolume> targets;
    SolidVoxelizer voxelizer;
    for (const char* name : kSharedMeshes) {
        const std::optional<TriangleMesh> mesh = sharedMesh(name);
        if (!mesh) continue;
        TargetVolume& target = targets.emplace_back(TargetVolume{name, TargetVolume::Kind::mesh, {}});
        voxelizeTarget(field.frame, makeTarget(fitted(field, *mesh)), voxelizer, target.voxels);
        target.voxels &= domain;
    }
    return targets;
}

std::vector<TargetVolume> allTargets(const Device& device) {
    std::vector<TargetVolume> targets = meshTargets(device.field, device.coverage.domain());
    for (TargetVolume& target : wavesAndReliefs(device.field, device.coverage.domain())) targets.push_back(target);
    for (TargetVolume& target : hiddenStates(device.coverage, 20, 7)) targets.push_back(target);
    return targets;
}

} // namespace lumorph::bench
