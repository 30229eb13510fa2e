#include "tests/support/small_rigs.h"

#include <cmath>
#include <map>
#include <span>
#include <tuple>
#include <utility>

namespace lumorph::test {

namespace {

/// Merges vertices at equal positions while faces are added one by one.
class Builder {
public:
    std::uint32_t vertex(const glm::vec3& p) {
        const auto [it, isNew] =
            known_.try_emplace({p.x, p.y, p.z}, static_cast<std::uint32_t>(mesh_.positions.size()));
        if (isNew) mesh_.positions.push_back(p);
        return it->second;
    }
    void quad(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d) {
        mesh_.triangles.emplace_back(vertex(a), vertex(b), vertex(c));
        mesh_.triangles.emplace_back(vertex(a), vertex(c), vertex(d));
    }
    TriangleMesh take() { return std::move(mesh_); }

private:
    std::map<std::tuple<float, float, float>, std::uint32_t> known_;
    TriangleMesh mesh_;
};

Influence influence(std::size_t vertex, float weight) { return {static_cast<std::uint32_t>(vertex), weight}; }

Actuator slide(const std::string& name, float length) {
    Actuator actuator;
    actuator.name = name;
    actuator.deformer = Slide{{0.0F, 1.0F, 0.0F}, 0.0, static_cast<double>(length)};
    return actuator;
}

} // namespace

TriangleMesh boxMesh(const glm::vec3& min, const glm::vec3& max, int cells) {
    Builder b;
    const auto at = [&](int i, int j, float y) {
        const auto share = [&](int k) { return static_cast<float>(k) / static_cast<float>(cells); };
        return glm::vec3(min.x + share(i) * (max.x - min.x), y, min.z + share(j) * (max.z - min.z));
    };
    for (int j = 0; j < cells; ++j)
        for (int i = 0; i < cells; ++i) {
            b.quad(at(i, j, max.y), at(i, j + 1, max.y), at(i + 1, j + 1, max.y), at(i + 1, j, max.y));
            b.quad(at(i, j, min.y), at(i + 1, j, min.y), at(i + 1, j + 1, min.y), at(i, j + 1, min.y));
        }
    for (int i = 0; i < cells; ++i) {
        b.quad(at(i, 0, min.y), at(i, 0, max.y), at(i + 1, 0, max.y), at(i + 1, 0, min.y));
        b.quad(at(i + 1, cells, min.y), at(i + 1, cells, max.y), at(i, cells, max.y), at(i, cells, min.y));
        b.quad(at(0, i + 1, min.y), at(0, i + 1, max.y), at(0, i, max.y), at(0, i, min.y));
        b.quad(at(cells, i, min.y), at(cells, i, max.y), at(cells, i + 1, max.y), at(cells, i + 1, min.y));
    }
    return b.take();
}

Rig cushionRig() {
    RigParts parts;
    parts.name = "cushion";
    parts.restMesh = boxMesh({0.0F, 0.0F, 0.0F}, {0.1013F, 0.0207F, 0.0811F}, 8);
    parts.pathInside = true;
    const glm::vec2 centres[] = {{0.02F, 0.02F}, {0.08F, 0.03F}, {0.05F, 0.07F}};
    for (int k = 0; k < 3; ++k) {
        Actuator actuator = slide("lift " + std::to_string(k), 0.0209F + 0.0053F * static_cast<float>(k));
        for (std::size_t v = 0; v < parts.restMesh.positions.size(); ++v) {
            const glm::vec3& p = parts.restMesh.positions[v];
            if (p.y <= 0.0F) continue;
            const float dx = p.x - centres[k].x;
            const float dz = p.z - centres[k].y;
            actuator.influences.push_back(influence(v, std::exp(-(dx * dx + dz * dz) / 0.0018F)));
        }
        parts.actuators.push_back(std::move(actuator));
    }
    return Rig(std::move(parts));
}

Rig armRig() {
    RigParts parts;
    parts.name = "arm";
    parts.restMesh = boxMesh({0.0F, 0.0F, 0.0F}, {0.0911F, 0.0152F, 0.0217F}, 1);
    // Three cross-sections along the beam to bend at.
    Builder b;
    const float xs[] = {0.0F, 0.0301F, 0.0603F, 0.0911F};
    const float h = 0.0152F;
    const float d = 0.0217F;
    for (int i = 0; i < 3; ++i) {
        const float x0 = xs[i];
        const float x1 = xs[i + 1];
        b.quad({x0, h, 0}, {x0, h, d}, {x1, h, d}, {x1, h, 0});
        b.quad({x0, 0, 0}, {x1, 0, 0}, {x1, 0, d}, {x0, 0, d});
        b.quad({x0, 0, 0}, {x0, h, 0}, {x1, h, 0}, {x1, 0, 0});
        b.quad({x1, 0, d}, {x1, h, d}, {x0, h, d}, {x0, 0, d});
    }
    b.quad({0, 0, d}, {0, h, d}, {0, h, 0}, {0, 0, 0});
    b.quad({xs[3], 0, 0}, {xs[3], h, 0}, {xs[3], h, d}, {xs[3], 0, d});
    parts.restMesh = b.take();
    for (int k = 0; k < 3; ++k) {
        Actuator actuator;
        actuator.name = "joint " + std::to_string(k);
        // Turning about -z lowers; about +z the free end of the beam rises.
        actuator.deformer = Hinge{{xs[k], 0.0F, 0.0F}, {0.0F, 0.0F, 1.0F}, Angle{}, Angle::degrees(35.0)};
        for (std::size_t v = 0; v < parts.restMesh.positions.size(); ++v)
            if (parts.restMesh.positions[v].x > xs[k] + 1e-4F || (k == 0))
                actuator.influences.push_back(influence(v, 1.0F));
        parts.actuators.push_back(std::move(actuator));
    }
    return Rig(std::move(parts));
}

namespace {

/// Boxes that slide up out of a base, an actuator each.
Rig boxesOutOf(const char* name, TriangleMesh base, std::span<const glm::vec3> low, std::span<const glm::vec3> high) {
    RigParts parts;
    parts.name = name;
    parts.pathInside = true;
    parts.restMesh = std::move(base);
    for (std::size_t k = 0; k < low.size(); ++k) {
        Actuator actuator = slide("box " + std::to_string(k), 0.025F + 0.006F * static_cast<float>(k));
        const TriangleMesh box = boxMesh(low[k], high[k]);
        for (std::size_t v = 0; v < box.positions.size(); ++v)
            if (box.positions[v].y > 0.01F)
                actuator.influences.push_back(influence(parts.restMesh.positions.size() + v, 1.0F));
        append(parts.restMesh, box);
        parts.actuators.push_back(std::move(actuator));
    }
    return Rig(std::move(parts));
}

} // namespace

Rig lifterRig() {
    const glm::vec3 low[] = {{0.0051F, 0.001F, 0.0052F}, {0.0303F, 0.0013F, 0.0154F}, {0.0707F, 0.0011F, 0.0103F}};
    const glm::vec3 high[] = {{0.0459F, 0.0201F, 0.0501F}, {0.0655F, 0.0203F, 0.0403F}, {0.0908F, 0.0202F, 0.0606F}};
    return boxesOutOf("lifter", boxMesh({-0.01F, 0.0F, -0.01F}, {0.1003F, 0.0211F, 0.0702F}), low, high);
}

Rig cornersRig() {
    const glm::vec3 low[] = {{-0.0951F, 0.001F, -0.0952F}, {0.0603F, 0.0013F, 0.0554F}};
    const glm::vec3 high[] = {{-0.0609F, 0.0201F, -0.0551F}, {0.0955F, 0.0203F, 0.0903F}};
    return boxesOutOf("corners", boxMesh({-0.1F, 0.0F, -0.1F}, {0.1003F, 0.0211F, 0.1002F}), low, high);
}

} // namespace lumorph::test
