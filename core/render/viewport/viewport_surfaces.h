#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/render/gl/gl_objects.h"
#include "core/render/viewport/viewport_scene.h"

namespace lumorph {

/// The surfaces of a viewport in the memory of the current context. What is shown again with other positions
/// keeps its buffers; what is not shown any more is dropped after a frame.
class ViewportSurfaces {
public:
    /// Uploads what is new. Surfaces without shading or positions, or with a wrong number of them, draw nothing.
    void update(const std::vector<ViewportSurface>& surfaces, SurfaceShading::Detail detail);

    /// Of the surfaces of the last update, by their place in it.
    [[nodiscard]] bool drawable(std::size_t surface) const noexcept { return shown_[surface] != nullptr; }
    /// In the detail of the last update.
    void draw(std::size_t surface) const;
    /// Box in the world.
    [[nodiscard]] const Box& box(std::size_t surface) const noexcept { return boxes_[surface]; }
    /// Another number for other positions.
    [[nodiscard]] std::uint64_t version(std::size_t surface) const noexcept { return shown_[surface]->version; }
    [[nodiscard]] bool closed(std::size_t surface) const noexcept { return shown_[surface]->shading->closed(); }

    [[nodiscard]] std::size_t objectCount() const noexcept { return 4 * entries_.size(); }

private:
    struct Entry {
        std::shared_ptr<const SurfaceShading> shading;
        SurfaceShading::Detail detail;
        std::shared_ptr<const std::vector<glm::vec3>> positions;
        std::shared_ptr<const std::vector<glm::u8vec4>> colors; // null: none
        gl::VertexArray array;
        gl::Buffer vertices, indices, tints;
        Box box; // of the positions
        std::uint64_t version = 0;
        std::uint64_t lastFrame = 0;
    };
    [[nodiscard]] SurfaceShading::Detail detailOf(const ViewportSurface& surface) const;
    [[nodiscard]] Entry* reuse(const ViewportSurface& surface, bool exact);
    Entry& add(const ViewportSurface& surface);
    void upload(Entry& entry, const ViewportSurface& surface);
    void uploadColors(Entry& entry, const ViewportSurface& surface);

    std::vector<std::unique_ptr<Entry>> entries_;
    std::vector<const Entry*> shown_;
    std::vector<Box> boxes_;
    SurfaceShading::Detail detail_ = SurfaceShading::Detail::fine;
    std::vector<ShadedMesh::Vertex> shaded_;
    std::vector<glm::u8vec4> tinted_;
    std::uint64_t frame_ = 0;
    std::uint64_t versions_ = 0;
};

} // namespace lumorph
