#include "core/voxels/solid.h"

namespace lumorph {

namespace {

// Counting starts at 0b01010101 instead of 0: from there a step up or down carries through two bits
// at most, while 0 - 1 would carry through all of them.
constexpr unsigned kBias = 0b0101'0101;

template <std::size_t N> void addOne(std::array<std::uint64_t, N>& counter, std::uint64_t carry) noexcept {
    for (std::uint64_t& plane : counter) {
        const std::uint64_t next = plane & carry;
        plane ^= carry;
        carry = next;
        if (carry == 0) return;
    }
}

template <std::size_t N> void subtractOne(std::array<std::uint64_t, N>& counter, std::uint64_t borrow) noexcept {
    for (std::uint64_t& plane : counter) {
        const std::uint64_t next = ~plane & borrow;
        plane ^= borrow;
        borrow = next;
        if (borrow == 0) return;
    }
}

} // namespace

void SolidVoxelizer::voxelize(const VoxelFrame& frame, std::span<const glm::vec3> positions,
                              std::span<const glm::uvec3> triangles, BitColumns& out) {
    if (out.dimensions() != frame.dimensions) out = BitColumns(frame.dimensions);
    const int words = out.wordsPerColumn();
    const int height = frame.dimensions.y;

    const GridSnap snap(frame, boundingBox(positions));
    vertices_.resize(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) vertices_[i] = snap(positions[i]);

    Counter zero;
    for (int plane = 0; plane < kPlanes; ++plane)
        zero[static_cast<std::size_t>(plane)] = (kBias >> plane) & 1U ? ~std::uint64_t{0} : 0;
    counters_.assign(out.words().size(), zero);

    const auto count = [&](int x, int z, int level, bool entering) noexcept {
        if (level >= height) return;
        const int first = std::max(level, 0);
        Counter* counter = &counters_[out.columnIndex(x, z) * static_cast<std::size_t>(words)];
        std::uint64_t above = ~std::uint64_t{0} << (static_cast<unsigned>(first) & 63U);
        for (int word = first >> 6; word < words; ++word, above = ~std::uint64_t{0})
            entering ? addOne(counter[word], above) : subtractOne(counter[word], above);
    };
    const ColumnRange all = columnsOf(frame);
    for (const glm::uvec3& t : triangles)
        rasterizeTriangle(vertices_[t.x], vertices_[t.y], vertices_[t.z], snap.shift(), all, count);

    const std::uint64_t lastMask = height % 64 == 0 ? ~std::uint64_t{0} : (std::uint64_t{1} << (height % 64)) - 1;
    std::uint64_t* result = out.words().data();
    for (std::size_t i = 0; i < counters_.size(); ++i) {
        std::uint64_t nonZero = 0;
        for (std::size_t plane = 0; plane < kPlanes; ++plane) nonZero |= counters_[i][plane] ^ zero[plane];
        const bool last = (i + 1) % static_cast<std::size_t>(words) == 0;
        result[i] = last ? nonZero & lastMask : nonZero;
    }
}

BitColumns voxelizeSolid(const VoxelFrame& frame, const TriangleMesh& mesh) {
    BitColumns out;
    SolidVoxelizer().voxelize(frame, mesh.positions, mesh.triangles, out);
    return out;
}

} // namespace lumorph
