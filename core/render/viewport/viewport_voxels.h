#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/render/gl/gl_objects.h"
#include "core/render/gl/program.h"
#include "core/render/viewport/viewport_frame.h"

namespace lumorph {

/// A corner of an exposed face of a voxel. `packed` holds the face (3 bits: twice the axis, plus 1 where it looks
/// along it), the corner's place (2 bits: right, upper) and the state of the sides left, right, lower, upper (2 bits
/// each: 0 free, 1 the body goes on, 2 a concave edge). Right is along the axis after the face's, upper along the one
/// after that.
struct VoxelCorner {
    std::uint16_t x, y, z, packed;
    std::array<std::uint8_t, 4> tone;
};
/// Corners of the faces that no other voxel covers, four a face, one list for each of the six faces. Voxels outside
/// the frame are left out, of several at one place the last counts.
[[nodiscard]] std::array<std::vector<VoxelCorner>, 6> exposedFaces(const ViewportVoxels& cloud);

/// The voxel clouds of a viewport in the memory of the current context; kept until they are not shown any more.
class ViewportVoxelClouds {
public:
    void update(const std::vector<ViewportVoxels>& clouds);

    /// Sets what all clouds of a frame share and makes its program current.
    void begin(const ViewportFrame& frame);
    /// Draws the faces that can look at the eye. A translucent cloud is drawn as one body: its nearest faces only.
    void draw(const ViewportFrame& frame, std::size_t cloud);

    [[nodiscard]] std::size_t objectCount() const noexcept { return 3 * entries_.size() + program_.objectCount(); }

private:
    struct Entry {
        std::shared_ptr<const std::vector<ViewportVoxel>> voxels;
        VoxelFrame frame;
        gl::VertexArray array;
        gl::Buffer corners, indices;
        std::array<std::size_t, 7> begin{}; // of each face's indices
        std::uint64_t lastFrame = 0;
    };
    static void upload(Entry& entry, const ViewportVoxels& cloud);
    static void drawFaces(const Entry& entry, const ViewportFrame& frame);

    Program program_{
        shaderFiles({"version.glsl", "light_colors.glsl", "tone.glsl", "voxel.vert"}, {"version.glsl", "voxel.frag"})};
    std::vector<std::unique_ptr<Entry>> entries_;
    std::vector<const Entry*> shown_;
    std::uint64_t frame_ = 0;
};

} // namespace lumorph
