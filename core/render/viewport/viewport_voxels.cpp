#include "core/render/viewport/viewport_voxels.h"

#include <algorithm>
#include <cstddef>

#include <glm/gtc/matrix_transform.hpp>

namespace lumorph {
namespace {

// Which voxels of a frame there are.
class Occupancy {
public:
    explicit Occupancy(const ViewportVoxels& cloud)
        : size_(cloud.frame.dimensions), filled_(cloud.frame.voxelCount(), false) {
        for (const ViewportVoxel& voxel : *cloud.voxels)
            if (inside({voxel.x, voxel.y, voxel.z})) filled_[index({voxel.x, voxel.y, voxel.z})] = true;
    }
    [[nodiscard]] bool at(const glm::ivec3& p) const { return inside(p) && filled_[index(p)]; }
    // True the first time for each voxel.
    [[nodiscard]] bool take(const glm::ivec3& p, std::vector<bool>& taken) const {
        if (!inside(p) || taken[index(p)]) return false;
        taken[index(p)] = true;
        return true;
    }

private:
    [[nodiscard]] bool inside(const glm::ivec3& p) const {
        return p.x >= 0 && p.y >= 0 && p.z >= 0 && p.x < size_.x && p.y < size_.y && p.z < size_.z;
    }
    [[nodiscard]] std::size_t index(const glm::ivec3& p) const {
        return (static_cast<std::size_t>(p.z) * static_cast<std::size_t>(size_.y) + static_cast<std::size_t>(p.y)) *
                   static_cast<std::size_t>(size_.x) +
               static_cast<std::size_t>(p.x);
    }

    glm::ivec3 size_;
    std::vector<bool> filled_;
};

glm::ivec3 along(int axis, int length) {
    glm::ivec3 step(0);
    step[axis % 3] = length;
    return step;
}

unsigned sidesOf(const Occupancy& occupancy, const glm::ivec3& at, int axis, const glm::ivec3& outwards) {
    unsigned sides = 0;
    for (unsigned side = 0; side < 4; ++side) {
        const glm::ivec3 next = at + along(axis + 1 + static_cast<int>(side / 2), side % 2 == 0 ? -1 : 1);
        if (!occupancy.at(next)) continue;
        sides |= (occupancy.at(next + outwards) ? 2U : 1U) << (2 * side);
    }
    return sides;
}

} // namespace

std::array<std::vector<VoxelCorner>, 6> exposedFaces(const ViewportVoxels& cloud) {
    std::array<std::vector<VoxelCorner>, 6> faces;
    const Occupancy occupancy(cloud);
    std::vector<bool> taken(cloud.frame.voxelCount(), false);
    for (auto voxel = cloud.voxels->rbegin(); voxel != cloud.voxels->rend(); ++voxel) {
        const glm::ivec3 at(voxel->x, voxel->y, voxel->z);
        if (!occupancy.take(at, taken)) continue;
        for (unsigned face = 0; face < 6; ++face) {
            const int axis = static_cast<int>(face / 2);
            const glm::ivec3 outwards = along(axis, face % 2 == 0 ? -1 : 1);
            if (occupancy.at(at + outwards)) continue;
            const unsigned sides = sidesOf(occupancy, at, axis, outwards);
            for (unsigned place = 0; place < 4; ++place)
                faces[face].push_back({voxel->x, voxel->y, voxel->z,
                                       static_cast<std::uint16_t>(face | place << 3 | sides << 5), voxel->color});
        }
    }
    return faces;
}

void ViewportVoxelClouds::upload(Entry& entry, const ViewportVoxels& cloud) {
    entry.voxels = cloud.voxels;
    entry.frame = cloud.frame;
    std::vector<VoxelCorner> corners;
    const auto faces = exposedFaces(cloud);
    for (std::size_t i = 0; i < 6; ++i) {
        corners.insert(corners.end(), faces[i].begin(), faces[i].end());
        entry.begin[i + 1] = 6 * corners.size() / 4;
    }
    std::vector<std::uint32_t> indices;
    indices.reserve(entry.begin[6]);
    for (std::uint32_t i = 0; i < corners.size(); i += 4)
        indices.insert(indices.end(), {i, i + 1, i + 3, i, i + 3, i + 2});

    glBindVertexArray(entry.array.name());
    glBindBuffer(GL_ARRAY_BUFFER, entry.corners.name());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(corners.size() * sizeof(VoxelCorner)), corners.data(),
                 GL_STATIC_DRAW);
    glEnableVertexAttribArray(0);
    glVertexAttribIPointer(0, 4, GL_UNSIGNED_SHORT, sizeof(VoxelCorner), nullptr);
    glEnableVertexAttribArray(1);
    glVertexAttribPointer(1, 4, GL_UNSIGNED_BYTE, GL_TRUE, sizeof(VoxelCorner),
                          reinterpret_cast<const void*>(offsetof(VoxelCorner, tone)));
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, entry.indices.name());
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(indices.size() * sizeof(std::uint32_t)),
                 indices.data(), GL_STATIC_DRAW);
    glBindVertexArray(0);
}

void ViewportVoxelClouds::update(const std::vector<ViewportVoxels>& clouds) {
    ++frame_;
    shown_.assign(clouds.size(), nullptr);
    for (std::size_t i = 0; i < clouds.size(); ++i) {
        if (!clouds[i].voxels || clouds[i].voxels->empty() || !(clouds[i].opacity > 0.0F)) continue;
        const auto held = std::find_if(entries_.begin(), entries_.end(), [&](const auto& entry) {
            return entry->voxels == clouds[i].voxels && entry->frame == clouds[i].frame;
        });
        Entry* entry = held == entries_.end() ? nullptr : held->get();
        if (entry == nullptr) {
            entry = entries_.emplace_back(std::make_unique<Entry>()).get();
            upload(*entry, clouds[i]);
        }
        entry->lastFrame = frame_;
        shown_[i] = entry;
    }
    std::erase_if(entries_, [&](const auto& entry) { return entry->lastFrame + 1 < frame_; });
}

void ViewportVoxelClouds::begin(const ViewportFrame& frame) {
    program_.use();
    program_.set("clipFromWorld", frame.clipFromWorld);
    program_.set("keyDirection", keyLightDirection());
    program_.set("exposure", frame.palette.exposure);
}

void ViewportVoxelClouds::drawFaces(const Entry& entry, const ViewportFrame& frame) {
    const Box box = entry.frame.box();
    const glm::vec3 eye(frame.eye);
    for (int face = 0; face < 6; ++face) {
        const int axis = face / 2;
        const bool forwards = face % 2 == 1;
        // Faces look at the eye when it lies beyond the plane of at least one of them.
        const float plane = frame.eye.w == 0.0F ? 0.0F : forwards ? box.min[axis] : box.max[axis];
        if (forwards ? eye[axis] <= plane : eye[axis] >= plane) continue;
        const auto i = static_cast<std::size_t>(face);
        glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(entry.begin[i + 1] - entry.begin[i]), GL_UNSIGNED_INT,
                       reinterpret_cast<const void*>(entry.begin[i] * sizeof(std::uint32_t)));
    }
}

void ViewportVoxelClouds::draw(const ViewportFrame& frame, std::size_t cloud) {
    const ViewportVoxels& item = frame.scene.voxels[cloud];
    if (shown_[cloud] == nullptr) return;
    const Entry& entry = *shown_[cloud];
    const auto voxel = static_cast<float>(item.frame.voxelSize);
    program_.set("worldFromVoxels", glm::scale(glm::translate(glm::mat4(1.0F), item.frame.origin), glm::vec3(voxel)));
    program_.set("inset", 0.5F - 0.5F * std::clamp(item.side, 0.05F, 1.0F));
    program_.set("opacity", item.opacity);
    glBindVertexArray(entry.array.name());
    if (item.opacity < 1.0F) {
        glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
        drawFaces(entry, frame);
        glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    }
    drawFaces(entry, frame);
    glBindVertexArray(0);
}

} // namespace lumorph
