#include "calibration/registration/nearest_surface.h"

#include <algorithm>
#include <utility>

#include <embree3/rtcore.h>
#include <glm/geometric.hpp>

#include "core/base/error.h"

namespace lumorph {

namespace {

struct ReleaseNearestDevice {
    void operator()(RTCDevice device) const noexcept { rtcReleaseDevice(device); }
};
struct ReleaseNearestScene {
    void operator()(RTCScene scene) const noexcept { rtcReleaseScene(scene); }
};

struct Corners {
    glm::dvec3 a, b, c;
};

/// Shares of the corners at the nearest point of a triangle (Ericson, "Real-Time Collision Detection", 5.1.5): the
/// regions of its corners, of its edges, and of its inside, one after the other.
glm::dvec3 nearestShares(const Corners& t, const glm::dvec3& p) {
    const glm::dvec3 ab = t.b - t.a, ac = t.c - t.a;
    const glm::dvec3 ap = p - t.a, bp = p - t.b, cp = p - t.c;
    const double d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
    if (d1 <= 0.0 && d2 <= 0.0) return {1.0, 0.0, 0.0};
    const double d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
    if (d3 >= 0.0 && d4 <= d3) return {0.0, 1.0, 0.0};
    const double d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
    if (d6 >= 0.0 && d5 <= d6) return {0.0, 0.0, 1.0};
    const double c = d1 * d4 - d3 * d2;
    if (c <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return {1.0 - d1 / (d1 - d3), d1 / (d1 - d3), 0.0};
    const double b = d5 * d2 - d1 * d6;
    if (b <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return {1.0 - d2 / (d2 - d6), 0.0, d2 / (d2 - d6)};
    const double a = d3 * d6 - d5 * d4;
    if (a <= 0.0 && d4 >= d3 && d5 >= d6) {
        const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return {0.0, 1.0 - w, w};
    }
    return glm::dvec3(a, b, c) / (a + b + c);
}

} // namespace

struct NearestSurface::Data {
    TriangleMesh mesh;
    std::unique_ptr<RTCDeviceTy, ReleaseNearestDevice> device;
    std::unique_ptr<RTCSceneTy, ReleaseNearestScene> scene;
    RTCGeometry geometry = nullptr; ///< the scene holds it
    glm::vec3* corners = nullptr;   ///< Embree's copy of the vertices

    [[nodiscard]] Corners triangle(unsigned number) const {
        const glm::uvec3& t = mesh.triangles[number];
        return {mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]};
    }
};

namespace {

struct Search {
    const TriangleMesh* mesh = nullptr;
    glm::dvec3 point{0.0};
    bool found = false;
    NearestSurface::Place best{};
};

bool look(RTCPointQueryFunctionArguments* arguments) {
    auto& search = *static_cast<Search*>(arguments->userPtr);
    const glm::uvec3& t = search.mesh->triangles[arguments->primID];
    const auto& at = search.mesh->positions;
    const Corners corners{at[t.x], at[t.y], at[t.z]};
    const glm::dvec3 shares = nearestShares(corners, search.point);
    const glm::dvec3 place = shares.x * corners.a + shares.y * corners.b + shares.z * corners.c;
    const double distance = glm::distance(place, search.point);
    if (distance >= static_cast<double>(arguments->query->radius) || (search.found && distance >= search.best.distance))
        return false;
    search.found = true;
    search.best = {place, arguments->primID, shares, glm::dvec3(0.0), distance};
    arguments->query->radius = static_cast<float>(distance);
    return true;
}

} // namespace

NearestSurface::NearestSurface(const TriangleMesh& mesh) : data_(std::make_unique<Data>()) {
    const bool whole = std::ranges::all_of(mesh.triangles, [&](const glm::uvec3& t) {
        return std::max({t.x, t.y, t.z}) < mesh.positions.size();
    });
    if (mesh.triangles.empty() || !whole)
        throw InvalidInput("surface", "it has no triangles, or broken ones", "give a whole mesh");
    data_->mesh = mesh;
    data_->device.reset(rtcNewDevice("threads=1"));
    data_->scene.reset(rtcNewScene(data_->device.get()));
    rtcSetSceneFlags(data_->scene.get(), RTC_SCENE_FLAG_DYNAMIC);
    rtcSetSceneBuildQuality(data_->scene.get(), RTC_BUILD_QUALITY_LOW);
    data_->geometry = rtcNewGeometry(data_->device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    data_->corners = static_cast<glm::vec3*>(rtcSetNewGeometryBuffer(
        data_->geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), mesh.positions.size()));
    auto* triangles = static_cast<glm::uvec3*>(rtcSetNewGeometryBuffer(
        data_->geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(glm::uvec3), mesh.triangles.size()));
    if (data_->corners == nullptr || triangles == nullptr) {
        rtcReleaseGeometry(data_->geometry);
        throw InvalidInput("surface of the device", "there is no memory for it", "use a coarser mesh");
    }
    std::ranges::copy(mesh.triangles, triangles);
    rtcAttachGeometry(data_->scene.get(), data_->geometry);
    rtcReleaseGeometry(data_->geometry);
    move(mesh.positions);
}

NearestSurface::~NearestSurface() = default;
NearestSurface::NearestSurface(NearestSurface&&) noexcept = default;
NearestSurface& NearestSurface::operator=(NearestSurface&&) noexcept = default;

void NearestSurface::move(std::span<const glm::vec3> positions) {
    std::ranges::copy(positions, data_->mesh.positions.begin());
    std::ranges::copy(positions, data_->corners);
    rtcUpdateGeometryBuffer(data_->geometry, RTC_BUFFER_TYPE_VERTEX, 0);
    rtcCommitGeometry(data_->geometry);
    rtcCommitScene(data_->scene.get());
}

std::optional<NearestSurface::Place> NearestSurface::of(const glm::dvec3& point, double within) const {
    Search search{.mesh = &data_->mesh, .point = point};
    RTCPointQuery query{};
    query.x = static_cast<float>(point.x);
    query.y = static_cast<float>(point.y);
    query.z = static_cast<float>(point.z);
    query.radius = static_cast<float>(within);
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(data_->scene.get(), &query, &context, look, &search);
    if (!search.found) return std::nullopt;
    const Corners corners = data_->triangle(search.best.triangle);
    const glm::dvec3 across = glm::cross(corners.b - corners.a, corners.c - corners.a);
    const double length = glm::length(across);
    if (!(length > 0.0)) return std::nullopt;
    search.best.normal = across / length;
    return search.best;
}

} // namespace lumorph
