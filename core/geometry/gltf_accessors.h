#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <glm/gtc/type_ptr.hpp>

#include "core/geometry/gltf_source.h"

namespace lumorph::gltf {

/// Reads typed values out of buffers, trusting nothing: every index, range and number is checked before it is used.
/// `place` says in errors who asks. `some` are the elements that are wanted, each of them below count(); none: all. The
/// references outlive the reader.
class Accessors {
public:
    Accessors(const tinygltf::Model& structure, const Buffers& buffers, MemoryBudget& budget, const std::string& file)
        : structure_(structure), buffers_(buffers), budget_(budget), file_(file) {}

    /// Numbers an element: 1 to 4, or 16 for a 4x4 matrix.
    [[nodiscard]] int components(int accessor, const std::string& place) const;

    /// How many elements it has, at least one.
    [[nodiscard]] std::size_t count(int accessor, const std::string& place) const;

    using Some = std::span<const std::uint32_t>;
    /// The values in file order, finite; integers of a normalised accessor become 0..1 or -1..1.
    [[nodiscard]] std::vector<float> floats(int accessor, int components, const std::string& place,
                                            Some some = {}) const;
    [[nodiscard]] std::vector<std::uint32_t> integers(int accessor, int components, const std::string& place,
                                                      Some some = {}) const;

    /// The same as glm vectors or matrices.
    template <typename Vector>
    [[nodiscard]] std::vector<Vector> vectors(int accessor, const std::string& place, Some some = {}) const {
        constexpr int size = sizeof(Vector) / sizeof(float);
        std::vector<Vector> out(open(accessor, size, place, some));
        fill(accessor, size, glm::value_ptr(out.front()), place, some);
        return out;
    }

    [[nodiscard]] MemoryBudget& budget() const noexcept { return budget_; }
    [[nodiscard]] const std::string& file() const noexcept { return file_; }

private:
    /// Number of elements that are wanted, at least one; charges the budget for them.
    [[nodiscard]] std::size_t open(int accessor, int components, const std::string& place, Some some) const;
    void fill(int accessor, int components, float* out, const std::string& place, Some some) const;
    template <typename Out>
    void copyWanted(int accessor, int components, Out* out, const std::string& place, Some some) const;
    template <typename Out> void copySparse(int accessor, int components, Out* out, const std::string& place) const;

    const tinygltf::Model& structure_;
    const Buffers& buffers_;
    MemoryBudget& budget_;
    const std::string& file_;
};

} // namespace lumorph::gltf
