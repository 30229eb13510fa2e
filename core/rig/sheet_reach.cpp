#include "core/rig/sheet_reach.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <queue>

#include <glm/geometric.hpp>

namespace lumorph {
namespace {

constexpr float kLooseness = 0.02F;  ///< of the extent, on either side
constexpr float kFineEnough = 2e-6F; ///< metres: of rows that hardly move
constexpr std::size_t kMostPieces = 128;

using Matrix = std::array<std::array<double, SheetModes::kMostLevels>, SheetModes::kMostLevels>;

/// Inverse of a small regular matrix by Gauss-Jordan elimination with row pivots.
Matrix inverseOf(Matrix m, std::size_t size) {
    Matrix inverse{};
    for (std::size_t i = 0; i < size; ++i) inverse[i][i] = 1.0;
    for (std::size_t column = 0; column < size; ++column) {
        std::size_t pivot = column;
        for (std::size_t row = column; row < size; ++row)
            if (std::abs(m[row][column]) > std::abs(m[pivot][column])) pivot = row;
        std::swap(m[pivot], m[column]);
        std::swap(inverse[pivot], inverse[column]);
        for (std::size_t row = 0; row < size; ++row) {
            if (row == column) continue;
            const double factor = m[row][column] / m[column][column];
            for (std::size_t k = 0; k < size; ++k) {
                m[row][k] -= factor * m[column][k];
                inverse[row][k] -= factor * inverse[column][k];
            }
        }
    }
    for (std::size_t row = 0; row < size; ++row)
        for (std::size_t k = 0; k < size; ++k) inverse[row][k] /= m[row][row];
    return inverse;
}

/// Values of the Bernstein polynomials of degree size - 1 at t.
std::array<double, SheetModes::kMostLevels> bernsteinAt(double t, std::size_t size) {
    std::array<double, SheetModes::kMostLevels> values{1.0};
    for (std::size_t degree = 1; degree < size; ++degree)
        for (std::size_t i = degree + 1; i-- > 0;)
            values[i] = (i < degree ? (1.0 - t) * values[i] : 0.0) + (i > 0 ? t * values[i - 1] : 0.0);
    return values;
}

/// From values at an axis' nodes to the Bernstein coefficients of their polynomial over [low, high].
Matrix bernsteinFromNodes(const std::vector<float>& nodes, double low, double high) {
    Matrix collocation{};
    for (std::size_t i = 0; i < nodes.size(); ++i)
        collocation[i] = bernsteinAt((static_cast<double>(nodes[i]) - low) / (high - low), nodes.size());
    return inverseOf(collocation, nodes.size());
}

/// The value at node 0.
constexpr Matrix kAtRest{{{1.0}}};

/// Applies a matrix of `to` x `from` along the middle one of three indices, of which the first varies slowest.
std::vector<double> applied(const Matrix& matrix, const std::vector<double>& tensor, std::size_t to, std::size_t from,
                            std::size_t inner) {
    const std::size_t outer = tensor.size() / (from * inner);
    std::vector<double> result(outer * to * inner, 0.0);
    for (std::size_t o = 0; o < outer; ++o)
        for (std::size_t i = 0; i < to; ++i)
            for (std::size_t j = 0; j < from; ++j)
                for (std::size_t k = 0; k < inner; ++k)
                    result[(o * to + i) * inner + k] += matrix[i][j] * tensor[(o * from + j) * inner + k];
    return result;
}

/// Some part of the domain with the Bernstein coefficients over it.
struct Piece {
    std::array<std::size_t, SheetModes::kMostActuators> sizes{};
    std::size_t axes = 0;
    std::vector<float> b;
    float upper = 0.0F;

    [[nodiscard]] std::size_t strideOf(std::size_t axis) const {
        return std::accumulate(sizes.begin() + static_cast<std::ptrdiff_t>(axis) + 1,
                               sizes.begin() + static_cast<std::ptrdiff_t>(axes), std::size_t{1}, std::multiplies<>());
    }
    bool operator<(const Piece& other) const { return upper < other.upper; }
};

/// Calls line(first, stride) for each line of coefficients along an axis.
template <typename Line> void eachLine(const Piece& piece, std::size_t axis, Line&& line) {
    const std::size_t stride = piece.strideOf(axis);
    const std::size_t block = stride * piece.sizes[axis];
    for (std::size_t outer = 0; outer < piece.b.size(); outer += block)
        for (std::size_t inner = 0; inner < stride; ++inner) line(outer + inner, stride);
}

/// Where a polynomial only rises, or only falls, along an axis, its maximum lies on that axis' end.
void reduceMonotone(Piece& piece) {
    for (std::size_t axis = 0; axis < piece.axes; ++axis) {
        const std::size_t size = piece.sizes[axis];
        if (size == 1) continue;
        bool rises = true, falls = true;
        eachLine(piece, axis, [&](std::size_t first, std::size_t stride) {
            for (std::size_t i = 1; i < size; ++i) {
                const float step = piece.b[first + i * stride] - piece.b[first + (i - 1) * stride];
                rises = rises && step >= 0.0F;
                falls = falls && step <= 0.0F;
            }
        });
        if (!rises && !falls) continue;
        std::vector<float> end;
        end.reserve(piece.b.size() / size);
        eachLine(piece, axis, [&](std::size_t first, std::size_t stride) {
            end.push_back(piece.b[first + (rises ? size - 1 : 0) * stride]);
        });
        piece.b = std::move(end);
        piece.sizes[axis] = 1;
    }
}

/// The largest coefficient at a corner of the domain: a value of the polynomial.
float cornerValue(const Piece& piece) {
    std::vector<std::size_t> corners{0};
    for (std::size_t axis = 0; axis < piece.axes; ++axis) {
        if (piece.sizes[axis] == 1) continue;
        const std::size_t far = (piece.sizes[axis] - 1) * piece.strideOf(axis);
        for (std::size_t k = corners.size(); k-- > 0;) corners.push_back(corners[k] + far);
    }
    float most = -std::numeric_limits<float>::infinity();
    for (const std::size_t corner : corners) most = std::max(most, piece.b[corner]);
    return most;
}

/// The axis along which the polynomial is least linear.
std::size_t mostCurvedAxis(const Piece& piece) {
    std::size_t axis = 0;
    float most = -1.0F;
    for (std::size_t a = 0; a < piece.axes; ++a) {
        float curved = piece.sizes[a] > 1 ? 0.0F : -1.0F;
        eachLine(piece, a, [&](std::size_t first, std::size_t stride) {
            for (std::size_t i = 2; i < piece.sizes[a]; ++i)
                curved =
                    std::max(curved, std::abs(piece.b[first + i * stride] - 2.0F * piece.b[first + (i - 1) * stride] +
                                              piece.b[first + (i - 2) * stride]));
        });
        if (curved > most) most = curved, axis = a;
    }
    return axis;
}

/// The half of a piece nearer to 0; `piece` becomes the other one (de Casteljau).
Piece halved(Piece& piece, std::size_t axis) {
    Piece near = piece;
    const std::size_t last = piece.sizes[axis] - 1;
    eachLine(piece, axis, [&](std::size_t first, std::size_t stride) {
        float* const b = piece.b.data() + first;
        for (std::size_t i = 0; i <= last; ++i) {
            near.b[first + i * stride] = b[0];
            for (std::size_t j = 0; j + i < last; ++j) b[j * stride] = 0.5F * (b[j * stride] + b[(j + 1) * stride]);
        }
    });
    return near;
}

/// An upper bound of a polynomial's maximum, at most `tolerance` above it (branch and bound). Where that takes too many
/// pieces, it is as tight as it got.
float maximumOf(Piece whole, float tolerance) {
    std::priority_queue<Piece> open;
    float reached = -std::numeric_limits<float>::infinity();
    const auto add = [&](Piece piece) {
        reduceMonotone(piece);
        piece.upper = *std::ranges::max_element(piece.b);
        reached = std::max(reached, cornerValue(piece));
        open.push(std::move(piece));
    };
    add(std::move(whole));
    for (std::size_t pieces = 1; pieces < kMostPieces && open.top().upper > reached + tolerance; ++pieces) {
        Piece far = open.top();
        open.pop();
        Piece near = halved(far, mostCurvedAxis(far));
        add(std::move(near));
        add(std::move(far));
    }
    return open.top().upper;
}

/// A bound of the sum of |Lagrange polynomial| over an axis. Between two nodes their signs stay the same, so that the
/// sum is a polynomial there: the one whose values at the nodes are the signs.
double lebesgueBound(const std::vector<float>& nodes) {
    constexpr int kParts = 4; // of an interval: the shorter, the tighter
    double most = 1.0;
    for (std::size_t interval = 0; interval + 1 < nodes.size(); ++interval)
        for (int part = 0; part < kParts; ++part) {
            const auto at = [&](int i) {
                return std::lerp(static_cast<double>(nodes[interval]), static_cast<double>(nodes[interval + 1]),
                                 static_cast<double>(i) / kParts);
            };
            const Matrix matrix = bernsteinFromNodes(nodes, at(part), at(part + 1));
            for (std::size_t i = 0; i < nodes.size(); ++i) {
                double coefficient = 0.0;
                for (std::size_t k = 0; k < nodes.size(); ++k) {
                    // Each node between changes the sign once.
                    const std::size_t between = k <= interval ? interval - k : k - interval - 1;
                    coefficient += between % 2 == 0 ? matrix[i][k] : -matrix[i][k];
                }
                most = std::max(most, coefficient);
            }
        }
    return most;
}

} // namespace

SheetReach::SheetReach(const CompiledSheet& sheet) : sheet_(sheet) {
    for (const SheetPath& path : sheet.paths()) forms_.push_back(formOf(sheet.motion().modes, path));
}

SheetReach::Form SheetReach::formOf(const SheetModes& modes, const SheetPath& path) {
    Form form;
    std::vector<double> tensor(modes.coefficients.begin(), modes.coefficients.end());
    std::size_t inner = modes.modeCount;
    for (std::size_t axis = modes.strokes.size(); axis-- > 0;) {
        const std::vector<float>& nodes = modes.strokes[axis];
        const bool moves = (path.axes >> axis & 1U) != 0;
        const std::size_t size = moves ? nodes.size() : 1;
        tensor = applied(moves ? bernsteinFromNodes(nodes, 0.0, static_cast<double>(path.share)) : kAtRest, tensor,
                         size, nodes.size(), inner);
        inner *= size;
        if (moves) form.sizes.insert(form.sizes.begin(), size);
    }
    form.coefficients.assign(tensor.begin(), tensor.end());
    form.rounding = roundingOf(modes, form.coefficients);
    return form;
}

/// First order bounds of float arithmetic: of the contraction along the axes, relative to the nodes' coefficients, and
/// of the sum over the modes here and in deformation and of halving, relative to the Bernstein coefficients.
std::vector<double> SheetReach::roundingOf(const SheetModes& modes, const std::vector<float>& bernstein) {
    constexpr double unit = 0.5 * static_cast<double>(std::numeric_limits<float>::epsilon());
    double lebesgue = 1.0;
    std::size_t operations = 0;
    for (const std::vector<float>& nodes : modes.strokes) {
        lebesgue *= lebesgueBound(nodes);
        operations += nodes.size() + 2;
    }
    const double atNodes = unit * static_cast<double>(operations) * lebesgue;
    const double ofSums = unit * static_cast<double>(2 * modes.modeCount + 2 * kMostPieces);
    const auto largest = [&](const std::vector<float>& coefficients, std::size_t mode) {
        float most = 0.0F;
        for (std::size_t i = mode; i < coefficients.size(); i += modes.modeCount)
            most = std::max(most, std::abs(coefficients[i]));
        return static_cast<double>(most);
    };
    std::vector<double> rounding;
    for (std::size_t k = 0; k < modes.modeCount; ++k)
        rounding.push_back(atNodes * largest(modes.coefficients, k) + ofSums * largest(bernstein, k));
    return rounding;
}

Box SheetReach::of(std::uint16_t path, std::uint32_t row) const {
    const SheetModes& modes = sheet_.motion().modes;
    const Form& form = forms_[path];
    const std::size_t states = form.coefficients.size() / modes.modeCount;
    std::vector<glm::vec3> b(states);
    std::array<float, SheetModes::kMostModes> coefficients{};
    for (std::size_t state = 0; state < states; ++state) {
        std::copy_n(form.coefficients.data() + state * modes.modeCount, modes.modeCount, coefficients.data());
        b[state] = sheet_.displacement(row, coefficients.data());
    }
    const glm::vec3 extent = boundingBox(b).size();
    double rounding = 0.0;
    for (std::size_t k = 0; k < modes.modeCount; ++k)
        rounding += form.rounding[k] * static_cast<double>(glm::length(modes.modes[row * modes.modeCount + k]));
    Box box{glm::vec3(0.0F), glm::vec3(0.0F)};
    for (int axis = 0; axis < 3; ++axis)
        for (const float sign : {-1.0F, 1.0F}) {
            Piece whole;
            whole.axes = form.sizes.size();
            std::ranges::copy(form.sizes, whole.sizes.begin());
            for (const glm::vec3& one : b) whole.b.push_back(sign * one[axis]);
            const float most = maximumOf(std::move(whole), std::max(kLooseness * extent[axis], kFineEnough));
            (sign < 0.0F ? box.min : box.max)[axis] = sign * (most + static_cast<float>(rounding));
        }
    return box;
}

} // namespace lumorph
