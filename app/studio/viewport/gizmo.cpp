#include "app/studio/viewport/gizmo.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/studio/viewport/gizmo_shape.h"

namespace lumorph::studio {
namespace {

constexpr glm::vec3 kRed{0.90F, 0.33F, 0.31F};
constexpr glm::vec3 kGreen{0.45F, 0.75F, 0.33F};
constexpr glm::vec3 kBlue{0.33F, 0.58F, 0.95F};
constexpr glm::vec3 kNeutral{0.92F, 0.92F, 0.92F};
constexpr glm::vec3 kYellow{0.94F, 0.78F, 0.35F};
constexpr int kRingSegments = 72;
constexpr float kHeadPixels = 17.0F;
constexpr int kHeadLines = 16;

glm::vec3 colorOf(GizmoHandle handle) {
    switch (handle) {
    case GizmoHandle::moveX:
        return kRed;
    case GizmoHandle::moveY:
        return kGreen;
    case GizmoHandle::moveZ:
        return kBlue;
    case GizmoHandle::turn:
        return kYellow;
    default:
        return kNeutral;
    }
}

glm::vec3 cubeCorner(unsigned corner) {
    return {corner & 1U ? 1.0F : -1.0F, corner & 2U ? 1.0F : -1.0F, corner & 4U ? 1.0F : -1.0F};
}

// Collects the lines of the handles; `pixel` is the length of a pixel of 100 % at the centre.
class Drawing {
public:
    Drawing(const Gizmo& gizmo, const ViewCamera& camera, float length, std::optional<GizmoHandle> hot,
            const glm::vec3& accent)
        : gizmo_(gizmo), camera_(camera), length_(length), pixel_(length / static_cast<float>(kGizmoReach)), hot_(hot),
          accent_(accent) {}

    std::vector<ViewportLine> lines() && {
        if (offers(gizmo_, GizmoHandle::turn)) drawRing();
        if (offers(gizmo_, GizmoHandle::moveGround)) drawSquare();
        for (const auto arrow : {GizmoHandle::moveX, GizmoHandle::moveZ, GizmoHandle::moveY})
            if (offers(gizmo_, arrow)) drawArrow(arrow);
        if (offers(gizmo_, GizmoHandle::size)) drawSize();
        return std::move(lines_);
    }

private:
    void add(GizmoHandle handle, const glm::vec3& from, const glm::vec3& to, float width) {
        lines_.push_back({from, to, handle == hot_ ? accent_ : colorOf(handle), width, true});
    }
    float widthOf(GizmoHandle handle) const { return handle == hot_ ? 4.0F : 2.5F; }

    void drawRing() {
        const std::vector<glm::vec3> ring = turnRing(gizmo_, length_);
        for (std::size_t i = 0; i + 1 < ring.size(); ++i)
            add(GizmoHandle::turn, ring[i], ring[i + 1], widthOf(GizmoHandle::turn));
    }
    void drawSquare() {
        const auto square = groundSquare(gizmo_, length_);
        for (std::size_t i = 0; i < 4; ++i)
            add(GizmoHandle::moveGround, square[i], square[(i + 1) % 4], widthOf(GizmoHandle::moveGround));
    }
    // The head is a cone of lines from its rim to its tip.
    void drawArrow(GizmoHandle arrow) {
        const glm::vec3 axis = axisOf(arrow);
        if (pointsAtCamera(axis, gizmo_.centre, camera_)) return;
        const glm::vec3 tip = gizmo_.centre + length_ * axis;
        const glm::vec3 base = tip - kHeadPixels * pixel_ * axis;
        add(arrow, gizmo_.centre + kArrowStart * length_ * axis, base, widthOf(arrow));
        const glm::vec3 u(axis.y, axis.z, axis.x);
        const glm::vec3 v = glm::cross(axis, u);
        const float radius = (arrow == hot_ ? 6.5F : 5.5F) * pixel_;
        const auto rim = [&](int i) {
            const float angle = 2.0F * std::numbers::pi_v<float> * static_cast<float>(i) / kHeadLines;
            return base + radius * (std::cos(angle) * u + std::sin(angle) * v);
        };
        for (int i = 0; i < kHeadLines; ++i) {
            add(arrow, rim(i), tip, 2.0F);
            add(arrow, rim(i), rim(i + 1), 2.0F);
            add(arrow, rim(i), base, 2.0F);
        }
    }
    void drawSize() {
        const glm::vec3 middle = sizeCube(gizmo_, camera_, length_);
        const float half = (hot_ == GizmoHandle::size ? 7.5F : 6.5F) * pixel_;
        const glm::vec3 inwards = glm::normalize(gizmo_.centre - middle);
        add(GizmoHandle::size, gizmo_.centre - kArrowStart * length_ * inwards, middle + 1.5F * half * inwards, 1.5F);
        for (unsigned corner = 0; corner < 8; ++corner)
            for (unsigned bit = 1; bit < 8; bit *= 2)
                if (!(corner & bit))
                    add(GizmoHandle::size, middle + half * cubeCorner(corner), middle + half * cubeCorner(corner | bit),
                        2.0F);
    }

    const Gizmo& gizmo_;
    const ViewCamera& camera_;
    float length_;
    float pixel_;
    std::optional<GizmoHandle> hot_;
    glm::vec3 accent_;
    std::vector<ViewportLine> lines_;
};

double distanceToSegment(glm::dvec2 p, glm::dvec2 a, glm::dvec2 b) {
    const glm::dvec2 along = b - a;
    const double square = glm::dot(along, along);
    const double t = square > 0.0 ? std::clamp(glm::dot(p - a, along) / square, 0.0, 1.0) : 0.0;
    return glm::distance(p, a + t * along);
}

bool insideQuad(glm::dvec2 p, const std::vector<glm::dvec2>& quad) {
    int left = 0;
    for (std::size_t i = 0; i < quad.size(); ++i) {
        const glm::dvec2 a = quad[i];
        const glm::dvec2 edge = quad[(i + 1) % quad.size()] - a;
        left += edge.x * (p.y - a.y) - edge.y * (p.x - a.x) > 0.0 ? 1 : 0;
    }
    return left == 0 || left == static_cast<int>(quad.size());
}

// Distances in pixels from the pointer to the handles as they are seen.
class Finder {
public:
    Finder(const ViewCamera& camera, glm::vec2 pixel, glm::vec2 size) : camera_(camera), pixel_(pixel), size_(size) {}

    double toPath(const std::vector<glm::vec3>& path) const {
        double nearest = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i + 1 < path.size(); ++i) {
            const auto a = pixelOf(camera_, path[i], size_);
            const auto b = pixelOf(camera_, path[i + 1], size_);
            if (a && b) nearest = std::min(nearest, distanceToSegment(pixel_, *a, *b));
        }
        return nearest;
    }
    double toArea(const std::array<glm::vec3, 4>& corners) const {
        std::vector<glm::dvec2> seen;
        for (const glm::vec3& corner : corners)
            if (const auto p = pixelOf(camera_, corner, size_)) seen.emplace_back(*p);
        if (seen.size() == 4 && insideQuad(pixel_, seen)) return 0.0;
        return toPath({corners[0], corners[1], corners[2], corners[3], corners[0]});
    }

private:
    const ViewCamera& camera_;
    glm::dvec2 pixel_;
    glm::vec2 size_;
};

} // namespace

bool pointsAtCamera(const glm::vec3& axis, const glm::vec3& at, const ViewCamera& camera) {
    const PictureAxes axes = pictureAxes(camera);
    const glm::vec3 towards = camera.orthographic ? axes.back : glm::normalize(eyeOf(camera) - at);
    return glm::length(glm::cross(axis, towards)) < 0.1F;
}

std::vector<glm::vec3> turnRing(const Gizmo& gizmo, float length) {
    std::vector<glm::vec3> ring;
    ring.reserve(kRingSegments + 1);
    for (int i = 0; i <= kRingSegments; ++i) {
        const float angle = 2.0F * std::numbers::pi_v<float> * static_cast<float>(i) / kRingSegments;
        ring.push_back(gizmo.centre + kRingRadius * length * glm::vec3(std::sin(angle), 0.0F, std::cos(angle)));
    }
    return ring;
}

std::vector<ViewportLine> gizmoLines(const Gizmo& gizmo, const ViewCamera& camera, glm::vec2 size, double scale,
                                     std::optional<GizmoHandle> hot, const glm::vec3& accent) {
    const float length = gizmoLength(gizmo, camera, size, scale);
    if (!(length > 0.0F)) return {};
    return Drawing(gizmo, camera, length, hot, accent).lines();
}

std::optional<GizmoHandle> gizmoAt(const Gizmo& gizmo, const ViewCamera& camera, glm::vec2 pixel, glm::vec2 size,
                                   double scale) {
    const float length = gizmoLength(gizmo, camera, size, scale);
    if (!(length > 0.0F)) return std::nullopt;
    const Finder finder(camera, pixel, size);
    const glm::vec3 cube = sizeCube(gizmo, camera, length);
    if (offers(gizmo, GizmoHandle::size) && finder.toPath({cube, cube}) <= 11.0 * scale) return GizmoHandle::size;
    std::optional<GizmoHandle> nearest;
    double least = 8.0 * scale;
    const auto offer = [&](GizmoHandle handle, double distance) {
        if (distance > least || !offers(gizmo, handle)) return;
        least = distance;
        nearest = handle;
    };
    offer(GizmoHandle::turn, finder.toPath(turnRing(gizmo, length)));
    for (const auto arrow : {GizmoHandle::moveX, GizmoHandle::moveY, GizmoHandle::moveZ}) {
        const glm::vec3 axis = axisOf(arrow);
        if (pointsAtCamera(axis, gizmo.centre, camera)) continue;
        offer(arrow, finder.toPath({gizmo.centre + kArrowStart * length * axis, gizmo.centre + length * axis}));
    }
    offer(GizmoHandle::moveGround, finder.toArea(groundSquare(gizmo, length)));
    return nearest;
}

} // namespace lumorph::studio
