#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace lumorph {

/// One bit a voxel, stored as runs along y: the voxels above one another are neighbouring bits, so
/// that a solid, a union or a count goes a whole column at a time. Bits beyond the grid are zero.
class BitColumns {
public:
    BitColumns() = default;
    explicit BitColumns(glm::ivec3 dimensions);

    [[nodiscard]] glm::ivec3 dimensions() const noexcept { return dimensions_; }
    [[nodiscard]] int wordsPerColumn() const noexcept { return wordsPerColumn_; }
    [[nodiscard]] std::size_t columnCount() const noexcept {
        return static_cast<std::size_t>(dimensions_.x) * static_cast<std::size_t>(dimensions_.z);
    }
    /// Columns run along x first, then z.
    [[nodiscard]] std::size_t columnIndex(int x, int z) const noexcept {
        return static_cast<std::size_t>(z) * static_cast<std::size_t>(dimensions_.x) + static_cast<std::size_t>(x);
    }
    [[nodiscard]] std::span<const std::uint64_t> words() const noexcept { return words_; }
    [[nodiscard]] std::span<std::uint64_t> words() noexcept { return words_; }

    [[nodiscard]] bool test(int x, int y, int z) const noexcept {
        return (words_[wordIndex(x, y, z)] >> (static_cast<unsigned>(y) & 63U)) & 1U;
    }
    void set(int x, int y, int z) noexcept { words_[wordIndex(x, y, z)] |= bit(y); }
    void reset(int x, int y, int z) noexcept { words_[wordIndex(x, y, z)] &= ~bit(y); }
    void clear() noexcept;

    [[nodiscard]] std::size_t count() const noexcept;
    [[nodiscard]] std::size_t countAnd(const BitColumns& other) const noexcept;
    BitColumns& operator|=(const BitColumns& other) noexcept;
    BitColumns& operator&=(const BitColumns& other) noexcept;
    /// Removes the other's bits.
    BitColumns& operator-=(const BitColumns& other) noexcept;
    bool operator==(const BitColumns&) const = default;

private:
    [[nodiscard]] static constexpr std::uint64_t bit(int y) noexcept {
        return std::uint64_t{1} << (static_cast<unsigned>(y) & 63U);
    }
    [[nodiscard]] std::size_t wordIndex(int x, int y, int z) const noexcept {
        return columnIndex(x, z) * static_cast<std::size_t>(wordsPerColumn_) + (static_cast<std::size_t>(y) >> 6U);
    }

    glm::ivec3 dimensions_{0};
    int wordsPerColumn_ = 0;
    std::vector<std::uint64_t> words_;
};

/// Number of set bits in a run of words, and in what two runs of equal length share.
[[nodiscard]] std::size_t countBits(std::span<const std::uint64_t> words) noexcept;
[[nodiscard]] std::size_t countBitsAnd(std::span<const std::uint64_t> a, std::span<const std::uint64_t> b) noexcept;

/// Intersection over union of two grids of equal shape; 1 when both are empty.
[[nodiscard]] double intersectionOverUnion(const BitColumns& a, const BitColumns& b) noexcept;

} // namespace lumorph
