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

/// out[i] = sum over the nodes of basis x tensor[node * size + i]. `out` may be the tensor's own beginning.
void contract(const Basis& basis, std::size_t nodes, const float* tensor, std::size_t size, float* out) noexcept {
    for (std::size_t i = 0; i < size; ++i) out[i] = basis[0] * tensor[i];
    for (std::size_t node = 1; node < nodes; ++node) {
        const float weight = basis[node];
        if (weight == 0.0F) continue; // a stroke at rest or another node takes one slice
        const float* const slice = tensor + node * size;
        for (std::size_t i = 0; i < size; ++i) out[i] += weight * slice[i];
    }
}

} // namespace

std::size_t SheetModes::stateCount() const noexcept {
    std::size_t count = 1;
    for (const std::vector<float>& nodes : strokes) count *= nodes.size();
    return count;
}

void modeCoefficients(const SheetModes& modes, std::span<const double> strokes, std::span<float> out) noexcept {
    // What is left of the tensor after the first axis is at most half of it.
    std::array<float, SheetModes::kMostCoefficients / 2> partial;
    const float* tensor = modes.coefficients.data();
    std::size_t size = modes.coefficients.size();
    for (std::size_t axis = 0; axis < modes.strokes.size(); ++axis) {
        const std::vector<float>& nodes = modes.strokes[axis];
        size /= nodes.size();
        contract(lagrangeAt(nodes, strokes[axis]), nodes.size(), tensor, size, partial.data());
        tensor = partial.data();
    }
    std::copy_n(partial.data(), modes.modeCount, out.data());
}

glm::vec3 rowDisplacement(const SheetModes& modes, std::size_t row, std::span<const double> strokes) noexcept {
    std::array<float, SheetModes::kMostModes> coefficients;
    modeCoefficients(modes, strokes, coefficients);
    glm::vec3 sum(0.0F);
    for (std::size_t k = 0; k < modes.modeCount; ++k) sum += coefficients[k] * modes.modes[row * modes.modeCount + k];
    return sum;
}

} // namespace lumorph
