#include "calibration/registration/nearest_surface.h"

#include <algorithm>
#include <limits>
#include <utility>

#include <embree3/rtcore.h>
#include <glm/geometric.hpp>

#include "core/base/error.h"

namespace lumorph {

namespace {

/// By the region of the triangle's plane in which the point lies (Ericson, "Real-Time Collision Detection", 5.1.5).
glm::dvec3 nearestOfTriangle(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const glm::dvec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
    const double d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap), d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp),
                 d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
    if (d1 <= 0.0 && d2 <= 0.0) return a;
    if (d3 >= 0.0 && d4 <= d3) return b;
    if (d6 >= 0.0 && d5 <= d6) return c;
    const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
    if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return a + d1 / (d1 - d3) * ab;
    if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return a + d2 / (d2 - d6) * ac;
    if (va <= 0.0 && d4 >= d3 && d5 >= d6) return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
    const double sum = va + vb + vc;
    return sum > 0.0 ? a + vb / sum * ab + vc / sum * ac : a;
}

struct ReleaseQueryDevice {
    void operator()(RTCDevice device) const noexcept { rtcReleaseDevice(device); }
};
struct ReleaseQueryScene {
    void operator()(RTCScene scene) const noexcept { rtcReleaseScene(scene); }
};

} // namespace

struct NearestSurface::Data {
    TriangleMesh mesh;
    std::unique_ptr<RTCDeviceTy, ReleaseQueryDevice> device;
    std::unique_ptr<RTCSceneTy, ReleaseQueryScene> scene;

    [[nodiscard]] glm::dvec3 corner(std::uint32_t triangle, int k) const {
        return mesh.positions[mesh.triangles[triangle][k]];
    }
    struct Query {
        const Data* data = nullptr;
        glm::dvec3 point{0.0}, best{0.0};
        double distance = std::numeric_limits<double>::infinity();
        std::uint32_t triangle = 0;
    };
    static bool look(RTCPointQueryFunctionArguments* arguments) {
        Query& query = *static_cast<Query*>(arguments->userPtr);
        const std::uint32_t t = arguments->primID;
        const glm::dvec3 at = nearestOfTriangle(query.point, query.data->corner(t, 0), query.data->corner(t, 1),
                                                query.data->corner(t, 2));
        const double distance = glm::distance(at, query.point);
        if (distance >= query.distance) return false;
        query.best = at;
        query.distance = distance;
        query.triangle = t;
        if (distance >= static_cast<double>(arguments->query->radius)) return false;
        arguments->query->radius = static_cast<float>(distance);
        return true;
    }
};

NearestSurface::NearestSurface(TriangleMesh mesh) : data_(std::make_unique<Data>()) {
    const bool whole = std::ranges::all_of(mesh.triangles, [&](const glm::uvec3& t) {
        return std::max({t.x, t.y, t.z}) < mesh.positions.size();
    });
    if (mesh.triangles.empty() || !whole)
        throw InvalidInput("surface", "it has no triangles, or broken ones", "give a whole mesh");
    data_->mesh = std::move(mesh);
    data_->device.reset(rtcNewDevice(nullptr));
    data_->scene.reset(rtcNewScene(data_->device.get()));
    RTCGeometry geometry = rtcNewGeometry(data_->device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    // The mesh is kept, and Embree reads it where it is.
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, data_->mesh.positions.data(), 0,
                               sizeof(glm::vec3), data_->mesh.positions.size());
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, data_->mesh.triangles.data(), 0,
                               sizeof(glm::uvec3), data_->mesh.triangles.size());
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(data_->scene.get(), geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(data_->scene.get());
}

NearestSurface::~NearestSurface() = default;
NearestSurface::NearestSurface(NearestSurface&&) noexcept = default;
NearestSurface& NearestSurface::operator=(NearestSurface&&) noexcept = default;

std::optional<NearestSurface::Place> NearestSurface::of(const glm::dvec3& point, double within) const {
    Data::Query query{data_.get(), point};
    RTCPointQuery sphere{static_cast<float>(point.x), static_cast<float>(point.y), static_cast<float>(point.z), 0.0F,
                         static_cast<float>(within)};
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(data_->scene.get(), &sphere, &context, Data::look, &query);
    if (!(query.distance <= within)) return std::nullopt;
    const glm::dvec3 a = data_->corner(query.triangle, 0);
    const glm::dvec3 normal = glm::cross(data_->corner(query.triangle, 1) - a, data_->corner(query.triangle, 2) - a);
    const double length = glm::length(normal);
    if (!(length > 0.0)) return std::nullopt;
    return Place{query.best, normal / length};
}

} // namespace lumorph
