#include "core/rig/sheet_modes.h"

#include <algorithm>
#include <array>

namespace lumorph {
namespace {

using Basis = std::array<float, SheetModes::kMostLevels>;

/// The Lagrange polynomials of an axis' nodes at a stroke. Exactly 0 or 1 at the nodes.
Basis lagrangeAt(const std::vector<float>& nodes, double stroke) noexcept {
    Basis basis;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        double value = 1.0;
        for (std::size_t j = 0; j < nodes.size(); ++j)
            if (j != i)
                value *= (stroke - static_cast<double>(nodes[j])) /
                         (static_cast<double>(nodes[i]) - static_cast<double>(nodes[j]));
        basis[i] = static_cast<float>(value);
    }
    return basis;
}

/// out[i] = sum over the nodes of basis x tensor[node * size + i], nodes of no weight left out: a stroke at rest or at
/// another node takes one slice.
void contract(const Basis& basis, std::size_t nodes, const float* tensor, std::size_t size,
              float* __restrict out) noexcept {
    std::array<std::size_t, SheetModes::kMostLevels> used;
    std::size_t count = 0;
    for (std::size_t node = 0; node < nodes; ++node)
        if (basis[node] != 0.0F) used[count++] = node;
    const auto slice = [&](std::size_t k) { return tensor + used[k] * size; };
    if (count == 3) { // the usual grid: one pass instead of three
        const float *const a = slice(0), *const b = slice(1), *const c = slice(2);
        const float u = basis[used[0]], v = basis[used[1]], w = basis[used[2]];
        for (std::size_t i = 0; i < size; ++i) out[i] = u * a[i] + v * b[i] + w * c[i];
        return;
    }
    std::fill_n(out, size, 0.0F);
    for (std::size_t k = 0; k < count; ++k) {
        const float weight = basis[used[k]];
        const float* const from = slice(k);
        for (std::size_t i = 0; i < size; ++i) out[i] += weight * from[i];
    }
}

} // namespace

std::size_t SheetModes::stateCount() const noexcept {
    std::size_t count = 1;
    for (const std::vector<float>& nodes : strokes) count *= nodes.size();
    return count;
}

void modeCoefficients(const SheetModes& modes, std::span<const double> strokes, std::span<float> out) noexcept {
    // What is left of the tensor is at most half of it after the first axis, a quarter after the second.
    std::array<float, SheetModes::kMostCoefficients / 2> odd;
    std::array<float, SheetModes::kMostCoefficients / 4> even;
    const float* tensor = modes.coefficients.data();
    std::size_t size = modes.coefficients.size();
    for (std::size_t axis = 0; axis < modes.strokes.size(); ++axis) {
        const std::vector<float>& nodes = modes.strokes[axis];
        float* const left = axis % 2 == 0 ? odd.data() : even.data();
        size /= nodes.size();
        contract(lagrangeAt(nodes, strokes[axis]), nodes.size(), tensor, size, left);
        tensor = left;
    }
    std::copy_n(tensor, modes.modeCount, out.data());
}

glm::vec3 rowDisplacement(const SheetModes& modes, std::size_t row, std::span<const double> strokes) noexcept {
    std::array<float, SheetModes::kMostModes> coefficients;
    modeCoefficients(modes, strokes, coefficients);
    glm::vec3 sum(0.0F);
    for (std::size_t k = 0; k < modes.modeCount; ++k) sum += coefficients[k] * modes.modes[row * modes.modeCount + k];
    return sum;
}

} // namespace lumorph
