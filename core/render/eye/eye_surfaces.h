#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <glm/mat4x4.hpp>

#include "core/geometry/triangle_mesh.h"
#include "core/render/eye/creases.h"
#include "core/render/eye/skin_mesh.h"
#include "core/render/gl/gl_objects.h"
#include "core/scene/show_frame.h"

namespace lumorph {

/// Vertices in the memory of the current context: attribute 0 the position, 1 the normal, 2 the coordinates, 3 (of the
/// skin) the position at rest.
class EyeMesh {
public:
    void setTopology(const std::vector<glm::uvec3>& triangles, const std::vector<glm::vec2>& coordinates,
                     const std::vector<glm::vec3>* restPositions = nullptr);
    void setShape(const std::vector<glm::vec3>& positions, const std::vector<glm::vec3>& normals);
    void draw() const;
    static constexpr std::size_t kObjects = 6;

private:
    gl::VertexArray array_;
    gl::Buffer positions_, normals_, coordinates_, restPositions_, indices_;
    GLsizei count_ = 0;
};

/// What is drawn of a frame: the device's skin and the items, uploaded where they changed.
class EyeSurfaces {
public:
    struct Shown {
        std::size_t surface = 0; ///< of the frame's posed ones
        const EyeMesh* mesh = nullptr;
        Box box;                   ///< in the world
        std::uint64_t version = 0; ///< another number for another shape
    };
    /// Surfaces that are broken (numbers that are not finite, wrong counts, indices beyond the vertices) show nothing.
    void update(const ShowFrame& frame);

    [[nodiscard]] const std::vector<Shown>& items() const noexcept { return shown_; }
    /// Whether there is a skin to draw.
    [[nodiscard]] bool hasSkin() const noexcept { return skinBoxAtDevice_.max.x >= skinBoxAtDevice_.min.x; }
    [[nodiscard]] const EyeMesh& skin() const noexcept { return *skinMesh_; }
    /// Lines along its folds; null where none are drawn.
    [[nodiscard]] const EyeMesh* creases() const noexcept { return creaseMesh_.get(); }
    [[nodiscard]] const SkinMesh& skinSource() const noexcept { return *skinSource_; }
    [[nodiscard]] const Box& skinBoxAtRest() const noexcept { return skinBoxAtRest_; }
    [[nodiscard]] const Box& skinBoxAtDevice() const noexcept { return skinBoxAtDevice_; }
    [[nodiscard]] std::uint64_t skinVersion() const noexcept { return skinVersion_; }
    [[nodiscard]] std::size_t objectCount() const noexcept;

private:
    struct Entry {
        std::shared_ptr<const SurfaceTopology> topology;
        std::shared_ptr<const std::vector<glm::vec3>> positions, normals;
        int item = 0;
        bool sound = false;
        EyeMesh mesh;
        Box box;
        std::uint64_t version = 0;
        std::uint64_t lastFrame = 0;
    };
    [[nodiscard]] Entry& entryOf(const PosedSurface& surface);
    void upload(Entry& entry, const PosedSurface& surface);
    [[nodiscard]] bool takeRig(const ShowFrame& frame);
    void updateSkin(const ShowFrame& frame);
    void updateCreases(const std::vector<glm::vec3>& positions);

    std::vector<std::unique_ptr<Entry>> entries_;
    std::vector<Shown> shown_;
    std::shared_ptr<const Rig> rig_;
    std::shared_ptr<const std::vector<glm::vec3>> devicePositions_;
    std::unique_ptr<SkinMesh> skinSource_;
    std::unique_ptr<EyeMesh> skinMesh_;
    std::unique_ptr<CreaseFinder> creaseFinder_;
    std::unique_ptr<EyeMesh> creaseMesh_;
    DeviceSkin::Creases creases_;
    std::vector<glm::vec3> skinPositions_, skinNormals_;
    Box skinBoxAtRest_, skinBoxAtDevice_;
    std::uint64_t skinVersion_ = 0;
    std::uint64_t frame_ = 0;
    std::uint64_t versions_ = 0;
};

/// The box of a box in another frame.
[[nodiscard]] Box movedBox(const Box& box, const glm::mat4& world);

} // namespace lumorph
