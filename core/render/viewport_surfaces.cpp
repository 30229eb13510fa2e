#include "core/render/viewport_surfaces.h"

#include <algorithm>
#include <cstddef>

namespace lumorph {
namespace {

using Vertex = ShadedMesh::Vertex;

template <class Values> void fill(GLenum target, const Values& values, GLenum usage) {
    glBufferData(target, static_cast<GLsizeiptr>(values.size() * sizeof(*values.data())), values.data(), usage);
}

void attribute(GLuint index, std::size_t stride, std::size_t offset) {
    glEnableVertexAttribArray(index);
    glVertexAttribPointer(index, 3, GL_FLOAT, GL_FALSE, static_cast<GLsizei>(stride),
                          reinterpret_cast<const void*>(offset));
}

std::vector<glm::uvec3> withCoarse(const SurfaceShading& shading) {
    std::vector<glm::uvec3> all(shading.triangles().begin(), shading.triangles().end());
    if (shading.coarseTriangles().data() == shading.triangles().data()) return all;
    all.insert(all.end(), shading.coarseTriangles().begin(), shading.coarseTriangles().end());
    return all;
}

bool sound(const ViewportSurface& surface) {
    return surface.shading && surface.positions && !surface.shading->triangles().empty() && surface.opacity > 0.0F &&
           surface.positions->size() == surface.shading->meshVertexCount();
}

Box moved(const Box& box, const glm::mat4& world) {
    Box result;
    for (unsigned i = 0; i < 8 && !box.empty(); ++i) {
        const glm::vec3 corner(i & 1U ? box.max.x : box.min.x, i & 2U ? box.max.y : box.min.y,
                               i & 4U ? box.max.z : box.min.z);
        result.include(glm::vec3(world * glm::vec4(corner, 1.0F)));
    }
    return result;
}

} // namespace

// An entry of this frame is taken; exact ones may be shown several times.
ViewportSurfaces::Entry* ViewportSurfaces::reuse(const ViewportSurface& surface, bool exact) {
    const auto found = std::find_if(entries_.begin(), entries_.end(), [&](const auto& entry) {
        if (entry->shading != surface.shading) return false;
        return exact ? entry->positions == surface.positions : entry->lastFrame != frame_;
    });
    return found == entries_.end() ? nullptr : found->get();
}

ViewportSurfaces::Entry& ViewportSurfaces::add(const ViewportSurface& surface) {
    Entry& entry = *entries_.emplace_back(std::make_unique<Entry>());
    entry.shading = surface.shading;
    glBindVertexArray(entry.array.name());
    glBindBuffer(GL_ARRAY_BUFFER, entry.vertices.name());
    attribute(0, sizeof(Vertex), offsetof(Vertex, position));
    attribute(1, sizeof(Vertex), offsetof(Vertex, normal));
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, entry.indices.name());
    fill(GL_ELEMENT_ARRAY_BUFFER, withCoarse(*surface.shading), GL_STATIC_DRAW);
    glBindVertexArray(0);
    return entry;
}

void ViewportSurfaces::upload(Entry& entry, const ViewportSurface& surface) {
    entry.positions = surface.positions;
    entry.box = boundingBox(*surface.positions);
    entry.version = ++versions_;
    shaded_.resize(surface.shading->sources().size());
    surface.shading->shade(*surface.positions, shaded_);
    glBindBuffer(GL_ARRAY_BUFFER, entry.vertices.name());
    fill(GL_ARRAY_BUFFER, shaded_, GL_STREAM_DRAW);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
}

void ViewportSurfaces::update(const std::vector<ViewportSurface>& surfaces) {
    ++frame_;
    shown_.assign(surfaces.size(), nullptr);
    boxes_.assign(surfaces.size(), Box());
    // First all that is held already, so that no surface takes the buffers of a later one.
    for (const bool exact : {true, false})
        for (std::size_t i = 0; i < surfaces.size(); ++i) {
            if (shown_[i] != nullptr || !sound(surfaces[i])) continue;
            Entry* entry = reuse(surfaces[i], true);
            if (entry == nullptr && !exact) {
                entry = reuse(surfaces[i], false);
                if (entry == nullptr) entry = &add(surfaces[i]);
                upload(*entry, surfaces[i]);
            }
            if (entry == nullptr) continue;
            entry->lastFrame = frame_;
            shown_[i] = entry;
            boxes_[i] = moved(entry->box, surfaces[i].worldFromSurface);
        }
    std::erase_if(entries_, [&](const auto& entry) { return entry->lastFrame + 1 < frame_; });
    if (entries_.empty()) shaded_ = {};
}

void ViewportSurfaces::draw(std::size_t surface, Form form) const {
    const SurfaceShading& shading = *shown_[surface]->shading;
    const bool fine = form == Form::fine;
    const std::span<const glm::uvec3> triangles = fine ? shading.triangles() : shading.coarseTriangles();
    // The coarse triangles lie behind the fine ones; a surface of few triangles has only those.
    const bool behind = triangles.data() != shading.triangles().data();
    const std::size_t start = behind ? shading.triangles().size_bytes() : 0;
    glBindVertexArray(shown_[surface]->array.name());
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * triangles.size()), GL_UNSIGNED_INT,
                   reinterpret_cast<const void*>(start));
    glBindVertexArray(0);
}

} // namespace lumorph
