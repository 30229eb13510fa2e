#include "app/applications/ice/floe_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <glm/common.hpp>

namespace lumorph::ice {
namespace {

constexpr int kFieldMargin = 4;         ///< samples around a floe
constexpr std::size_t kInlandReach = 4; ///< samples, of each of two means
constexpr double kCloses = 0.55;        ///< growth at which young cells meet
constexpr double kYoungDeep = 0.0030;   ///< metres that ice lies lower when it begins: just under the water
constexpr std::array kLines{-0.375, -0.125, 0.125, 0.375}; ///< heights within a row at which cells are cut

/// Young ice closes under the surface, as a skin, and then comes up as it gets thicker: cells that met only when they
/// are done would be framed by dark water until then.
Polygon youngOutline(const Polygon& whole, double growth) {
    const double share = std::min(1.0, growth / kCloses);
    if (share <= 0.0 || whole.empty()) return {};
    const glm::dvec2 centre = centreOf(whole);
    Polygon outline = whole;
    for (glm::dvec2& corner : outline) corner = centre + share * (corner - centre);
    return outline;
}

/// Where a convex outline meets the line of this height, from left to right; nothing is empty.
std::pair<double, double> spanAt(const Polygon& outline, double height) {
    double left = 1e9, right = -1e9;
    for (std::size_t k = 0; k < outline.size(); ++k) {
        const glm::dvec2 &a = outline[k], &b = outline[(k + 1) % outline.size()];
        if ((a.y <= height) == (b.y <= height)) continue;
        const double x = a.x + (b.x - a.x) * (height - a.y) / (b.y - a.y);
        left = std::min(left, x);
        right = std::max(right, x);
    }
    return {left, right};
}

/// Sums over the boxes of a row: of cover, and of cover times thickness and depth.
struct RowSums {
    float *cover, *thickness, *lower;

    void add(int i, double share, const glm::vec2& values) const {
        const auto part = static_cast<float>(share);
        cover[i] += part;
        thickness[i] += part * values.x;
        lower[i] += part * values.y;
    }
    /// Of a stretch from `a` to `b`, in samples; boxes reach half a sample to both sides.
    void addSpan(double a, double b, double weight, const glm::vec2& values) const {
        const auto first = static_cast<int>(std::floor(a + 0.5)), last = static_cast<int>(std::floor(b + 0.5));
        if (first == last) return add(first, weight * (b - a), values);
        add(first, weight * (first + 0.5 - a), values);
        for (int i = first + 1; i < last; ++i) add(i, weight, values);
        add(last, weight * (b - last + 0.5), values);
    }
};

/// Outlines in samples from the field's first one.
void addCell(FloeField& field, Polygon outline, const glm::vec2& values) {
    double low = 1e9, high = -1e9;
    for (glm::dvec2& corner : outline) {
        corner = corner / FloeField::kStep - glm::dvec2(field.min);
        low = std::min(low, corner.y);
        high = std::max(high, corner.y);
    }
    for (int j = static_cast<int>(std::floor(low)); j <= static_cast<int>(std::ceil(high)); ++j) {
        const std::size_t row = field.at(0, j);
        const RowSums sums{&field.shape[row], &field.thickness[row], &field.lower[row]};
        for (const double line : kLines) {
            const auto [left, right] = spanAt(outline, j + line);
            if (right > left) sums.addSpan(left, right, 1.0 / kLines.size(), values);
        }
    }
}

/// Weights 1 4 6 4 1 along x (`stride` 1) or z; ends count as 0, where fields have their margins.
void smooth(const FloeField& field, std::vector<float>& values, std::size_t stride) {
    const std::vector<float> from = values;
    const std::size_t reach = 2 * stride;
    if (from.size() <= 2 * reach) return;
    for (std::size_t k = reach; k + reach < field.shape.size(); ++k)
        values[k] =
            (from[k - reach] + from[k + reach] + 4.0F * (from[k - stride] + from[k + stride]) + 6.0F * from[k]) / 16.0F;
}

/// The mean over `kInlandReach` samples to both sides along a line of `count`, `stride` apart.
void mean(float* values, std::size_t count, std::size_t stride, std::vector<float>& line) {
    constexpr float kShare = 1.0F / (2 * kInlandReach + 1);
    line.assign(count + 2 * kInlandReach + 1, 0.0F);
    for (std::size_t i = 0; i < count; ++i) line[i + kInlandReach] = values[stride * i];
    float sum = 0.0F;
    for (std::size_t i = 0; i < 2 * kInlandReach; ++i) sum += line[i];
    for (std::size_t i = 0; i < count; ++i) {
        sum += line[i + 2 * kInlandReach];
        values[stride * i] = kShare * sum;
        sum -= line[i];
    }
}

void smoothFar(const FloeField& field, std::vector<float>& values) {
    std::vector<float> line;
    const auto width = static_cast<std::size_t>(field.size.x), height = static_cast<std::size_t>(field.size.y);
    for (int pass = 0; pass < 2; ++pass) {
        for (int j = 0; j < field.size.y; ++j) mean(&values[field.at(0, j)], width, 1, line);
        for (int i = 0; i < field.size.x; ++i) mean(&values[field.at(i, 0)], height, width, line);
    }
}

} // namespace

float FloeField::between(const std::vector<float>& values, const glm::dvec2& home) const noexcept {
    const glm::dvec2 from = home / kStep - glm::dvec2(min);
    const glm::dvec2 floor = glm::floor(from);
    const auto i = static_cast<int>(floor.x), j = static_cast<int>(floor.y);
    if (i < 0 || j < 0 || i + 1 >= size.x || j + 1 >= size.y) return 0.0F;
    const auto x = static_cast<float>(from.x - floor.x), y = static_cast<float>(from.y - floor.y);
    const float near = (1.0F - x) * values[at(i, j)] + x * values[at(i + 1, j)];
    const float far = (1.0F - x) * values[at(i, j + 1)] + x * values[at(i + 1, j + 1)];
    return (1.0F - y) * near + y * far;
}

glm::dvec2 FloeField::slope(const std::vector<float>& values, const glm::dvec2& home) const noexcept {
    const auto along = [&](const glm::dvec2& step) {
        return static_cast<double>(between(values, home + step) - between(values, home - step)) / (2.0 * kStep);
    };
    return {along({kStep, 0.0}), along({0.0, kStep})};
}

FloeField fieldOf(const IceCover& ice, const Floe& floe) {
    struct Piece {
        Polygon outline;
        glm::vec2 values;
    };
    std::vector<Piece> pieces;
    glm::dvec2 low(1e9), high(-1e9);
    for (const int k : floe.cells) {
        const Cell& cell = ice.sheet().cells()[static_cast<std::size_t>(k)];
        const double growth = ice.growth(k);
        Polygon outline = growth < 1.0 ? youngOutline(cell.outline, growth) : cell.outline;
        if (outline.empty()) continue;
        for (const glm::dvec2& corner : outline) low = glm::min(low, corner), high = glm::max(high, corner);
        pieces.push_back({std::move(outline), glm::vec2(glm::dvec2(cell.thickness, (1.0 - growth) * kYoungDeep))});
    }
    FloeField field;
    if (pieces.empty()) return field;
    field.min = glm::ivec2(glm::floor(low / FloeField::kStep)) - kFieldMargin;
    field.size = glm::ivec2(glm::ceil(high / FloeField::kStep)) + kFieldMargin + 1 - field.min;
    const std::size_t count = static_cast<std::size_t>(field.size.x) * static_cast<std::size_t>(field.size.y);
    for (std::vector<float>* values : {&field.shape, &field.thickness, &field.lower}) values->assign(count, 0.0F);
    for (Piece& piece : pieces) addCell(field, std::move(piece.outline), piece.values);
    for (std::vector<float>* values : {&field.shape, &field.lower})
        for (const std::size_t stride : {std::size_t{1}, static_cast<std::size_t>(field.size.x)})
            smooth(field, *values, stride);
    field.inland = field.shape;
    // What melts is cells at a time: a hollow is as wide as a warm place and shows none of their edges.
    for (std::vector<float>* values : {&field.inland, &field.thickness}) smoothFar(field, *values);
    for (std::size_t k = 0; k < count; ++k) {
        field.thickness[k] = std::min(1.0F, field.thickness[k] / std::max(field.inland[k], 1e-3F));
        field.lower[k] /= std::max(field.shape[k], 1e-4F);
    }
    return field;
}

} // namespace lumorph::ice
