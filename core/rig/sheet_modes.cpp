#include "core/rig/sheet_modes.h"

#include <algorithm>
#include <array>
#include <utility>

#include "core/base/error.h"

namespace lumorph {
namespace {

using Weights = std::array<std::array<float, SheetModes::kMostLevels>, SheetModes::kMostActuators>;

/// Values at a stroke of the Lagrange polynomials of equally spaced levels.
std::array<float, SheetModes::kMostLevels> lagrange(int levels, double stroke) noexcept {
    std::array<float, SheetModes::kMostLevels> weights{};
    const double at = stroke * (levels - 1);
    for (int i = 0; i < levels; ++i) {
        double weight = 1.0;
        for (int j = 0; j < levels; ++j)
            if (j != i) weight *= (at - j) / (i - j);
        weights[static_cast<std::size_t>(i)] = static_cast<float>(weight);
    }
    return weights;
}

/// Contracts the grid's last actuator, then the one before, and so on.
struct Contraction {
    const std::vector<int>& levels;
    const Weights& weights;
    std::size_t modeCount;
    const float* next; ///< coefficients of the next grid point

    void run(std::size_t actuator, float* sum) noexcept {
        std::fill_n(sum, modeCount, 0.0F);
        std::array<float, SheetModes::kMostModes> inner;
        for (std::size_t level = 0; level < static_cast<std::size_t>(levels[actuator]); ++level) {
            const float weight = weights[actuator][level];
            const bool last = actuator + 1 == levels.size();
            if (!last) run(actuator + 1, inner.data());
            const float* values = last ? next : inner.data();
            for (std::size_t k = 0; k < modeCount; ++k) sum[k] += weight * values[k];
            if (last) next += modeCount;
        }
    }
};

} // namespace

SheetModes::SheetModes(Parts parts) : parts_(std::move(parts)) {
    std::size_t points = 1;
    bool good = !parts_.levels.empty() && parts_.levels.size() <= kMostActuators && !parts_.rest.empty();
    for (const int levels : parts_.levels) {
        good = good && levels >= 2 && levels <= static_cast<int>(kMostLevels);
        points *= static_cast<std::size_t>(std::max(levels, 1));
    }
    if (good) {
        modeCount_ = parts_.modes.size() / parts_.rest.size();
        good = modeCount_ <= kMostModes && parts_.modes.size() == modeCount_ * parts_.rest.size() &&
               parts_.coefficients.size() == modeCount_ * points;
    }
    if (!good)
        throw InvalidInput("sheet modes", "levels, vertices, modes and coefficients do not fit together",
                           "bake the sheet again");
}

void SheetModes::coefficientsAt(std::span<const double> strokes, std::span<float> out) const noexcept {
    Weights weights;
    for (std::size_t a = 0; a < parts_.levels.size(); ++a) weights[a] = lagrange(parts_.levels[a], strokes[a]);
    Contraction{parts_.levels, weights, modeCount_, parts_.coefficients.data()}.run(0, out.data());
}

void SheetModes::deform(std::span<const double> strokes, std::span<glm::vec3> out) const noexcept {
    std::array<float, kMostModes> coefficients;
    coefficientsAt(strokes, coefficients);
    std::ranges::copy(parts_.rest, out.begin());
    const glm::vec3* mode = parts_.modes.data();
    for (std::size_t k = 0; k < modeCount_; ++k, mode += vertexCount())
        for (std::size_t v = 0; v < vertexCount(); ++v) out[v] += coefficients[k] * mode[v];
}

void SheetModes::deform(std::span<const double> strokes, std::span<const std::uint32_t> vertices,
                        std::span<glm::vec3> out) const noexcept {
    std::array<float, kMostModes> coefficients;
    coefficientsAt(strokes, coefficients);
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        glm::vec3 sum = parts_.rest[vertices[i]];
        for (std::size_t k = 0; k < modeCount_; ++k)
            sum += coefficients[k] * parts_.modes[k * vertexCount() + vertices[i]];
        out[i] = sum;
    }
}

} // namespace lumorph
