#include "core/render/viewport/viewport_surfaces.h"

#include <algorithm>
#include <cstddef>

namespace lumorph {
namespace {

using Vertex = ShadedMesh::Vertex;

constexpr GLuint kTintAttribute = 2;

template <class Values> void fill(GLenum target, const Values& values, GLenum usage) {
    glBufferData(target, static_cast<GLsizeiptr>(values.size() * sizeof(*values.data())), values.data(), usage);
}

void surfaceAttribute(GLuint index, std::size_t stride, std::size_t offset) {
    glEnableVertexAttribArray(index);
    glVertexAttribPointer(index, 3, GL_FLOAT, GL_FALSE, static_cast<GLsizei>(stride),
                          reinterpret_cast<const void*>(offset));
}

bool sound(const ViewportSurface& surface) {
    if (surface.vertexColors && surface.positions && surface.vertexColors->size() != surface.positions->size())
        return false;
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

SurfaceShading::Detail ViewportSurfaces::detailOf(const ViewportSurface& surface) const {
    return surface.shading->hasCoarse() ? detail_ : SurfaceShading::Detail::fine;
}

// An entry of this frame is taken; exact ones may be shown several times.
ViewportSurfaces::Entry* ViewportSurfaces::reuse(const ViewportSurface& surface, bool exact) {
    const auto found = std::find_if(entries_.begin(), entries_.end(), [&](const auto& entry) {
        if (entry->shading != surface.shading || entry->detail != detailOf(surface)) return false;
        return exact ? entry->positions == surface.positions && entry->colors == surface.vertexColors
                     : entry->lastFrame != frame_;
    });
    return found == entries_.end() ? nullptr : found->get();
}

ViewportSurfaces::Entry& ViewportSurfaces::add(const ViewportSurface& surface) {
    Entry& entry = *entries_.emplace_back(std::make_unique<Entry>());
    entry.shading = surface.shading;
    entry.detail = detailOf(surface);
    glBindVertexArray(entry.array.name());
    glBindBuffer(GL_ARRAY_BUFFER, entry.vertices.name());
    surfaceAttribute(0, sizeof(Vertex), offsetof(Vertex, position));
    surfaceAttribute(1, sizeof(Vertex), offsetof(Vertex, normal));
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, entry.indices.name());
    fill(GL_ELEMENT_ARRAY_BUFFER, surface.shading->triangles(entry.detail), GL_STATIC_DRAW);
    glBindVertexArray(0);
    return entry;
}

void ViewportSurfaces::uploadColors(Entry& entry, const ViewportSurface& surface) {
    entry.colors = surface.vertexColors;
    glBindVertexArray(entry.array.name());
    glBindBuffer(GL_ARRAY_BUFFER, entry.tints.name());
    if (entry.colors) {
        const auto sources = surface.shading->sources(entry.detail);
        tinted_.resize(sources.size());
        for (std::size_t v = 0; v < sources.size(); ++v) tinted_[v] = (*entry.colors)[sources[v]];
        fill(GL_ARRAY_BUFFER, tinted_, GL_STREAM_DRAW);
        glEnableVertexAttribArray(kTintAttribute);
        glVertexAttribPointer(kTintAttribute, 4, GL_UNSIGNED_BYTE, GL_TRUE, sizeof(glm::u8vec4), nullptr);
    } else {
        glDisableVertexAttribArray(kTintAttribute);
    }
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    glBindVertexArray(0);
}

void ViewportSurfaces::upload(Entry& entry, const ViewportSurface& surface) {
    if (entry.colors != surface.vertexColors) uploadColors(entry, surface);
    if (entry.positions == surface.positions) return;
    entry.positions = surface.positions;
    entry.box = boundingBox(*surface.positions);
    entry.version = ++versions_;
    shaded_.resize(surface.shading->sources(entry.detail).size());
    surface.shading->shade(*surface.positions, shaded_, entry.detail);
    glBindBuffer(GL_ARRAY_BUFFER, entry.vertices.name());
    fill(GL_ARRAY_BUFFER, shaded_, GL_STREAM_DRAW);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
}

void ViewportSurfaces::update(const std::vector<ViewportSurface>& surfaces, SurfaceShading::Detail detail) {
    detail_ = detail;
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
    if (entries_.empty()) shaded_ = {}, tinted_ = {};
}

void ViewportSurfaces::draw(std::size_t surface) const {
    const Entry& entry = *shown_[surface];
    glBindVertexArray(entry.array.name());
    glVertexAttrib4f(kTintAttribute, 0.0F, 0.0F, 0.0F, 0.0F); // of a surface without colours of its own
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * entry.shading->triangles(entry.detail).size()),
                   GL_UNSIGNED_INT, nullptr);
    glBindVertexArray(0);
}

} // namespace lumorph
