#include "calibration/lab/lab.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <embree3/rtcore.h>
#include <glm/geometric.hpp>
#include <tbb/parallel_for.h>

#include "calibration/lab/lab_lens.h"
#include "calibration/lab/lab_light.h"
#include "core/base/error.h"

namespace lumorph {
namespace {

constexpr int kMaxSamples = 16;

struct ReleaseDevice {
    void operator()(RTCDevice device) const noexcept { rtcReleaseDevice(device); }
};
struct ReleaseScene {
    void operator()(RTCScene scene) const noexcept { rtcReleaseScene(scene); }
};
using Device = std::unique_ptr<RTCDeviceTy, ReleaseDevice>;
using EmbreeScene = std::unique_ptr<RTCSceneTy, ReleaseScene>;

void checkMesh(const TriangleMesh& mesh, const std::string& what) {
    for (const glm::vec3& point : mesh.positions)
        if (!std::isfinite(point.x + point.y + point.z))
            throw InvalidInput(what, "a vertex has a number that is not finite", "repair the mesh");
    for (const glm::uvec3& triangle : mesh.triangles)
        if (std::max({triangle.x, triangle.y, triangle.z}) >= mesh.positions.size())
            throw InvalidInput(what, "a triangle names a vertex that is not there", "repair the mesh");
}

/// Hands a mesh to Embree, which keeps a copy of it. Its number is the next one, empty or not.
void addMesh(RTCDevice device, RTCScene scene, const TriangleMesh& mesh, unsigned number) {
    if (mesh.empty()) return;
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* positions = static_cast<glm::vec3*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), mesh.positions.size()));
    auto* triangles = static_cast<glm::uvec3*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(glm::uvec3), mesh.triangles.size()));
    if (positions == nullptr || triangles == nullptr) {
        rtcReleaseGeometry(geometry);
        throw InvalidInput("surface of the lab", "there is no memory for it", "use a coarser mesh");
    }
    std::copy(mesh.positions.begin(), mesh.positions.end(), positions);
    std::copy(mesh.triangles.begin(), mesh.triangles.end(), triangles);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, number);
    rtcReleaseGeometry(geometry);
}

RTCRay embreeRay(const glm::dvec3& origin, const glm::dvec3& direction, double length) {
    RTCRay ray{};
    ray.org_x = static_cast<float>(origin.x);
    ray.org_y = static_cast<float>(origin.y);
    ray.org_z = static_cast<float>(origin.z);
    ray.dir_x = static_cast<float>(direction.x);
    ray.dir_y = static_cast<float>(direction.y);
    ray.dir_z = static_cast<float>(direction.z);
    ray.tfar = static_cast<float>(length);
    ray.mask = ~0U;
    return ray;
}

/// A projector as the lab computes with it.
struct Lamp {
    LabLens lens;
    LabPicture picture;
    double strength = 0.0; ///< peak x reference distance^2; 0: it is off
};

} // namespace

struct Lab::Data {
    LabWorld world;
    Device device;
    EmbreeScene scene;
    std::vector<Lamp> lamps;

    [[nodiscard]] const TriangleMesh& mesh(unsigned geometry) const {
        return geometry < world.surfaces.size() ? world.surfaces[geometry].mesh
                                                : world.blockers[geometry - world.surfaces.size()];
    }
    [[nodiscard]] std::optional<Hit> trace(const glm::dvec3& origin, const glm::dvec3& direction) const;
    [[nodiscard]] bool sees(const glm::dvec3& point, const glm::dvec3& normal, const glm::dvec3& place) const;
    [[nodiscard]] LabSight::Gleam gleam(const Lamp& lamp, const Hit& hit) const;
    /// Rows [first, last) of what a lens sees; `sight` holds these rows alone.
    void look(const LabLens& lens, int samples, int first, int last, LabSight& sight) const;
    void lookAt(const LabLens& lens, const glm::dvec2& at, std::size_t ray, LabSight& sight) const;
    [[nodiscard]] bool isSmoothAt(const LabSight& once, int x, int y) const;
    [[nodiscard]] glm::vec3 pixel(const LabSight& sight, std::size_t index) const;
};

std::optional<Lab::Hit> Lab::Data::trace(const glm::dvec3& origin, const glm::dvec3& direction) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit found{};
    found.ray = embreeRay(origin, direction, std::numeric_limits<double>::infinity());
    found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene.get(), &context, &found);
    if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    const TriangleMesh& met = mesh(found.hit.geomID);
    const glm::uvec3& corners = met.triangles[found.hit.primID];
    const glm::dvec3 a = met.positions[corners.x];
    glm::dvec3 normal = glm::cross(glm::dvec3(met.positions[corners.y]) - a, glm::dvec3(met.positions[corners.z]) - a);
    const double length = glm::length(normal);
    if (!(length > 0.0)) return std::nullopt;
    normal /= glm::dot(normal, direction) > 0.0 ? -length : length;
    // Embree computes in single precision: where the ray meets the triangle's plane is worked out anew.
    const double towards = glm::dot(normal, direction);
    const double rough = static_cast<double>(found.ray.tfar);
    const double distance = towards < -1e-4 ? glm::dot(normal, a - origin) / towards : rough;
    const bool surface = found.hit.geomID < world.surfaces.size();
    return Hit{surface ? static_cast<int>(found.hit.geomID) : -1, found.hit.primID, origin + distance * direction,
               normal, distance};
}

bool Lab::Data::sees(const glm::dvec3& point, const glm::dvec3& normal, const glm::dvec3& place) const {
    const glm::dvec3 way = place - point;
    if (!(glm::dot(way, normal) > 0.0)) return false;
    // Ten times what single precision can tell at this distance, so that a surface does not shadow itself.
    const double lift = 1e-5 * std::max(1.0, glm::length(place));
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay ray = embreeRay(point + lift * normal, way - lift * normal, 1.0);
    rtcOccluded1(scene.get(), &context, &ray);
    return ray.tfar >= 0.0F;
}

LabSight::Gleam Lab::Data::gleam(const Lamp& lamp, const Hit& hit) const {
    if (!(lamp.strength > 0.0)) return {};
    const std::optional<glm::dvec2> pixel = imageOf(lamp.lens, hit.point);
    if (!pixel || !inImage(lamp.lens, *pixel) || !sees(hit.point, hit.normal, lamp.lens.position)) return {};
    const glm::dvec3 way = lamp.lens.position - hit.point;
    const double distance = glm::length(way);
    const double cosine = glm::dot(way, hit.normal) / distance;
    return {glm::vec2(*pixel), static_cast<float>(lamp.strength * cosine / (distance * distance))};
}

void Lab::Data::look(const LabLens& lens, int samples, int first, int last, LabSight& sight) const {
    std::size_t ray = 0;
    for (int y = first; y < last; ++y)
        for (int x = 0; x < lens.size.x; ++x)
            for (int sample = 0; sample < samples * samples; ++sample, ++ray) {
                const glm::dvec2 within((sample % samples + 0.5) / samples - 0.5,
                                        (sample / samples + 0.5) / samples - 0.5);
                lookAt(lens, glm::dvec2(x, y) + within, ray, sight);
            }
}

void Lab::Data::lookAt(const LabLens& lens, const glm::dvec2& at, std::size_t ray, LabSight& sight) const {
    const auto direction = rayThrough(lens, at);
    const auto hit = direction ? trace(lens.position, *direction) : std::nullopt;
    sight.surfaces[ray] = hit ? hit->surface : -1;
    sight.triangles[ray] = hit ? hit->triangle : 0;
    for (std::size_t lamp = 0; lamp < lamps.size(); ++lamp)
        sight.gleams[ray * lamps.size() + lamp] =
            hit && hit->surface >= 0 ? gleam(lamps[lamp], *hit) : LabSight::Gleam{};
}

/// A straight edge that passes between a pixel's middle and one of its rays also passes between the middle and a
/// neighbour's.
bool Lab::Data::isSmoothAt(const LabSight& once, int x, int y) const {
    constexpr float kBent = 0.1F; // projector pixels, between a pixel and the middle of its neighbours
    if (x == 0 || y == 0 || x + 1 == once.size.x || y + 1 == once.size.y) return false;
    const std::size_t row = static_cast<std::size_t>(once.size.x);
    const std::size_t ray = static_cast<std::size_t>(y) * row + static_cast<std::size_t>(x);
    for (const std::size_t step : {std::size_t{1}, row}) {
        if (once.surfaces[ray - step] != once.surfaces[ray] || once.surfaces[ray + step] != once.surfaces[ray])
            return false;
        for (std::size_t lamp = 0; lamp < lamps.size(); ++lamp) {
            const LabSight::Gleam& before = once.gleams[(ray - step) * lamps.size() + lamp];
            const LabSight::Gleam& here = once.gleams[ray * lamps.size() + lamp];
            const LabSight::Gleam& after = once.gleams[(ray + step) * lamps.size() + lamp];
            const bool isLit = here.share > 0.0F;
            if ((before.share > 0.0F) != isLit || (after.share > 0.0F) != isLit) return false;
            const glm::vec2 bent = before.pixel + after.pixel - 2.0F * here.pixel;
            if (isLit && glm::dot(bent, bent) > kBent * kBent) return false;
        }
    }
    return true;
}

glm::vec3 Lab::Data::pixel(const LabSight& sight, std::size_t index) const {
    const auto rays = static_cast<std::size_t>(sight.samples * sight.samples);
    glm::vec3 sum(0.0F);
    for (std::size_t ray = index * rays; ray < (index + 1) * rays; ++ray) {
        if (sight.surfaces[ray] < 0) continue;
        glm::vec3 light = world.ambient;
        for (std::size_t lamp = 0; lamp < lamps.size(); ++lamp) {
            const LabSight::Gleam& gleam = sight.gleams[ray * lamps.size() + lamp];
            if (gleam.share > 0.0F && !lamps[lamp].picture.light.empty())
                light += gleam.share * lightAt(lamps[lamp].picture, gleam.pixel);
        }
        sum += world.surfaces[static_cast<std::size_t>(sight.surfaces[ray])].albedo * light;
    }
    return sum / static_cast<float>(rays);
}

namespace {

LabSight emptySight(glm::ivec2 size, int samples, std::size_t lamps) {
    const std::size_t rays = static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) *
                             static_cast<std::size_t>(samples * samples);
    return {size, samples, std::vector<std::int32_t>(rays, -1), std::vector<std::uint32_t>(rays),
            std::vector<LabSight::Gleam>(rays * lamps)};
}

void checkSamples(int samples) {
    if (samples < 1 || samples > kMaxSamples)
        throw InvalidInput("samples of the lab", std::to_string(samples) + " is not in [1, 16]", "use 2");
}

} // namespace

Lab::Lab(LabWorld world) : data_(std::make_unique<Data>()) {
    if (std::all_of(world.surfaces.begin(), world.surfaces.end(), [](const auto& s) { return s.mesh.empty(); }))
        throw InvalidInput("virtual lab", "it has no surface to look at", "add the device or the table");
    for (const LabSurface& surface : world.surfaces) checkMesh(surface.mesh, "surface of the lab");
    for (const TriangleMesh& blocker : world.blockers) checkMesh(blocker, "blocker of the lab");
    data_->world = std::move(world);
    data_->device.reset(rtcNewDevice(nullptr));
    if (!data_->device)
        throw DeviceError("virtual lab", "Embree does not start", "look whether libembree3-3 is installed");
    data_->scene.reset(rtcNewScene(data_->device.get()));
    rtcSetSceneFlags(data_->scene.get(), RTC_SCENE_FLAG_ROBUST);
    unsigned number = 0;
    for (const LabSurface& surface : data_->world.surfaces)
        addMesh(data_->device.get(), data_->scene.get(), surface.mesh, number++);
    for (const TriangleMesh& blocker : data_->world.blockers)
        addMesh(data_->device.get(), data_->scene.get(), blocker, number++);
    rtcCommitScene(data_->scene.get());
    for (const LabProjector& lamp : data_->world.projectors) {
        const double strength =
            lamp.projector.peak * lamp.projector.referenceDistance * lamp.projector.referenceDistance;
        data_->lamps.push_back(
            {lensOf(lamp.projector.camera, "projector of the lab"), {}, lamp.projector.enabled ? strength : 0.0});
        show(data_->lamps.size() - 1, lamp.image);
    }
}

Lab::~Lab() = default;
Lab::Lab(Lab&&) noexcept = default;
Lab& Lab::operator=(Lab&&) noexcept = default;

std::size_t Lab::projectors() const noexcept { return data_->lamps.size(); }

const InstalledProjector& Lab::projector(std::size_t number) const {
    if (number >= data_->lamps.size())
        throw InvalidInput("projector " + std::to_string(number), "the lab has no such projector",
                           "count from 0 to the last one");
    return data_->world.projectors[number].projector;
}

void Lab::show(std::size_t projector, const Image& image) {
    const InstalledProjector& owner = this->projector(projector);
    if (image.pixels().empty()) {
        data_->lamps[projector].picture = {};
        return;
    }
    if (image.size() != owner.camera.size)
        throw InvalidInput("picture of projector " + owner.name,
                           "it is " + std::to_string(image.size().x) + " x " + std::to_string(image.size().y) +
                               " pixels, the projector " + std::to_string(owner.camera.size.x) + " x " +
                               std::to_string(owner.camera.size.y),
                           "give it a picture of its own size");
    data_->lamps[projector].picture = labPicture(image, owner);
}

std::vector<glm::vec3> Lab::radiance(const CalibratedCamera& observer, int samples) const {
    checkSamples(samples);
    const LabLens lens = lensOf(observer, "observer of the lab");
    const auto width = static_cast<std::size_t>(lens.size.x);
    std::vector<glm::vec3> picture(width * static_cast<std::size_t>(lens.size.y));
    tbb::parallel_for(0, lens.size.y, [&](int y) {
        LabSight row = emptySight({lens.size.x, 1}, samples, data_->lamps.size());
        data_->look(lens, samples, y, y + 1, row);
        for (std::size_t x = 0; x < width; ++x) picture[static_cast<std::size_t>(y) * width + x] = data_->pixel(row, x);
    });
    return picture;
}

Image Lab::view(const CalibratedCamera& observer, int samples) const {
    return labImage(radiance(observer, samples), observer.size);
}

LabSight Lab::look(const CalibratedCamera& observer, int samples) const {
    checkSamples(samples);
    const LabLens lens = lensOf(observer, "observer of the lab");
    LabSight sight = emptySight(lens.size, samples, data_->lamps.size());
    const std::size_t rowRays = sight.surfaces.size() / static_cast<std::size_t>(lens.size.y);
    tbb::parallel_for(0, lens.size.y, [&](int y) {
        LabSight row = emptySight({lens.size.x, 1}, samples, data_->lamps.size());
        data_->look(lens, samples, y, y + 1, row);
        const auto first = static_cast<std::ptrdiff_t>(rowRays * static_cast<std::size_t>(y));
        std::copy(row.surfaces.begin(), row.surfaces.end(), sight.surfaces.begin() + first);
        std::copy(row.triangles.begin(), row.triangles.end(), sight.triangles.begin() + first);
        std::copy(row.gleams.begin(), row.gleams.end(),
                  sight.gleams.begin() + first * static_cast<std::ptrdiff_t>(data_->lamps.size()));
    });
    return sight;
}

LabSight Lab::finer(const CalibratedCamera& observer, const LabSight& once) const {
    const std::size_t count = data_->lamps.size();
    if (once.samples != 1 || once.size != observer.size || once.gleams.size() != once.surfaces.size() * count)
        throw InvalidInput("sight of the lab", "it is another observer's", "look again, with one ray a pixel");
    const LabLens lens = lensOf(observer, "observer of the lab");
    LabSight sight = emptySight(lens.size, 2, count);
    const auto row = static_cast<std::size_t>(lens.size.x);
    tbb::parallel_for(0, lens.size.y, [&](int y) {
        for (int x = 0; x < lens.size.x; ++x) {
            const std::size_t middle = static_cast<std::size_t>(y) * row + static_cast<std::size_t>(x);
            const bool isSmooth = data_->isSmoothAt(once, x, y);
            for (int sample = 0; sample < 4; ++sample) {
                const glm::vec2 within(sample % 2 == 0 ? -0.25F : 0.25F, sample < 2 ? -0.25F : 0.25F);
                const std::size_t ray = 4 * middle + static_cast<std::size_t>(sample);
                if (!isSmooth) {
                    data_->lookAt(lens, glm::dvec2(x, y) + glm::dvec2(within), ray, sight);
                    continue;
                }
                sight.surfaces[ray] = once.surfaces[middle];
                sight.triangles[ray] = once.triangles[middle];
                for (std::size_t lamp = 0; lamp < count; ++lamp) {
                    const auto at = [&](std::size_t pixel) { return once.gleams[pixel * count + lamp].pixel; };
                    LabSight::Gleam& gleam = sight.gleams[ray * count + lamp] = once.gleams[middle * count + lamp];
                    gleam.pixel += 0.5F * within.x * (at(middle + 1) - at(middle - 1)) +
                                   0.5F * within.y * (at(middle + row) - at(middle - row));
                }
            }
        }
    });
    return sight;
}

std::vector<glm::vec3> Lab::radiance(const LabSight& sight) const {
    if (sight.gleams.size() != sight.surfaces.size() * data_->lamps.size())
        throw InvalidInput("sight of the lab", "it was taken with other projectors", "look again");
    const auto width = static_cast<std::size_t>(sight.size.x);
    std::vector<glm::vec3> picture(width * static_cast<std::size_t>(sight.size.y));
    tbb::parallel_for(0, sight.size.y, [&](int y) {
        const std::size_t first = static_cast<std::size_t>(y) * width;
        for (std::size_t index = first; index < first + width; ++index) picture[index] = data_->pixel(sight, index);
    });
    return picture;
}

std::optional<Lab::Hit> Lab::trace(const glm::dvec3& origin, const glm::dvec3& direction) const {
    return data_->trace(origin, direction);
}

bool Lab::lit(std::size_t projector, const glm::dvec3& point, const glm::dvec3& normal) const {
    return data_->gleam(data_->lamps.at(projector), {0, 0, point, normal, 0.0}).share > 0.0F;
}

bool Lab::sees(const glm::dvec3& point, const glm::dvec3& normal, const glm::dvec3& place) const {
    return data_->sees(point, normal, place);
}

} // namespace lumorph
