#include "core/rig/motion_box.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <glm/common.hpp>

#include "core/rig/rig_reach.h"

namespace lumorph {
namespace {

constexpr std::size_t kMostGridded = 4; ///< axes of which the corners of a box are taken
/// Relative to the coordinates: covers the rounding of the deformation itself.
constexpr float kRounding = 1e-6F;

/// Polynomial coefficients of the Lagrange polynomials of an axis: [power][node].
using NodeMatrix = std::array<std::array<float, SheetModes::kMostLevels>, SheetModes::kMostLevels>;

/// Those of the polynomials at stroke centre + half x, in powers of x.
NodeMatrix powersFromNodes(const std::vector<float>& nodes, double centre, double half) {
    NodeMatrix matrix{};
    for (std::size_t j = 0; j < nodes.size(); ++j) {
        std::array<double, SheetModes::kMostLevels> powers{1.0};
        std::size_t degree = 0;
        for (std::size_t k = 0; k < nodes.size(); ++k) {
            if (k == j) continue;
            const double scale = 1.0 / (static_cast<double>(nodes[j]) - static_cast<double>(nodes[k]));
            const double offset = (centre - static_cast<double>(nodes[k])) * scale;
            ++degree;
            for (std::size_t i = degree + 1; i-- > 0;)
                powers[i] = (i < degree ? offset * powers[i] : 0.0) + (i > 0 ? half * scale * powers[i - 1] : 0.0);
        }
        for (std::size_t i = 0; i < nodes.size(); ++i) matrix[i][j] = static_cast<float>(powers[i]);
    }
    return matrix;
}

/// A bound of the sum of |Lagrange polynomial| over an axis: samples, and how much it can rise between them.
double lebesgueBound(const std::vector<float>& nodes) {
    constexpr int kSamples = 512;
    std::vector<double> scales;
    double slope = 0.0;
    for (std::size_t j = 0; j < nodes.size(); ++j) {
        double scale = 1.0;
        for (std::size_t k = 0; k < nodes.size(); ++k)
            if (k != j) scale /= std::abs(static_cast<double>(nodes[j]) - static_cast<double>(nodes[k]));
        scales.push_back(scale);
        slope += scale * static_cast<double>(nodes.size() - 1);
    }
    double most = 1.0;
    for (int i = 0; i <= kSamples; ++i) {
        double sum = 0.0;
        for (std::size_t j = 0; j < nodes.size(); ++j) {
            double value = scales[j];
            for (std::size_t k = 0; k < nodes.size(); ++k)
                if (k != j) value *= std::abs(static_cast<double>(i) / kSamples - static_cast<double>(nodes[k]));
            sum += value;
        }
        most = std::max(most, sum);
    }
    return most + 0.5 * slope / kSamples;
}

/// Vertices that the same actuators move, no sheet among them.
struct FreeVertices {
    std::vector<std::size_t> axes;
    std::vector<std::size_t> slots;
    std::optional<Rig::Subset> subset;
    std::vector<StrokeBound> bounds; ///< [vertex * axes.size() + k], beside `axes`
};

/// Vertices of a sheet at one share of its path.
struct SheetVertices {
    struct Slot {
        std::size_t slot;
        std::uint32_t row;
        float leftOut; ///< metres that levers left out of its motion could move it by
    };
    float share = 1.0F;
    std::vector<Slot> slots;
};

} // namespace

struct MotionBounds::Data {
    Rig rig;
    std::vector<std::uint16_t> actuators;
    std::vector<glm::vec3> restPositions;
    std::vector<int> axisOfLever; ///< of each axis of the sheet's grid the axis of the box, or -1
    std::vector<FreeVertices> free;
    std::vector<SheetVertices> sheet;

    explicit Data(const Rig& of) : rig(of) {}
    [[nodiscard]] std::size_t axes() const noexcept { return actuators.size(); }
    void listSheet(std::span<const std::uint32_t> vertices);
    void listFree(std::span<const std::uint32_t> vertices);
    void boundFree(const FreeVertices& of, std::span<const double> low, std::span<const double> high,
                   MotionBox& out) const;
    void boundSheet(const SheetVertices& of, std::span<const double> low, std::span<const double> high,
                    MotionBox& out) const;
};

void MotionBounds::Data::listSheet(std::span<const std::uint32_t> vertices) {
    const SheetMotion& motion = *rig.parts().sheet;
    axisOfLever.assign(motion.modes.strokes.size(), -1);
    for (std::size_t a = 0; a < actuators.size(); ++a)
        if (const auto* lift = std::get_if<SheetLift>(&rig.actuators()[actuators[a]].deformer))
            axisOfLever[static_cast<std::size_t>(lift->axis)] = static_cast<int>(a);
    double lebesgue = 1.0;
    for (const std::vector<float>& nodes : motion.modes.strokes) lebesgue *= lebesgueBound(nodes);
    std::map<float, std::size_t> known;
    for (std::size_t slot = 0; slot < vertices.size(); ++slot) {
        const SheetMotion::Follower& follower = motion.followers[vertices[slot]];
        const std::size_t moving = rig.actuatorsOf(vertices[slot]).size();
        if (follower.row == SheetMotion::kNoRow || moving == 0) continue;
        const auto [at, isNew] = known.try_emplace(follower.share, sheet.size());
        if (isNew) sheet.push_back({follower.share, {}});
        // Each lever left out moves it by kSheetStill at most in the grid's states.
        const double leftOut =
            lebesgue * static_cast<double>(kSheetStill) * static_cast<double>(motion.modes.strokes.size() - moving);
        sheet[at->second].slots.push_back({slot, follower.row, static_cast<float>(leftOut)});
    }
}

void MotionBounds::Data::listFree(std::span<const std::uint32_t> vertices) {
    RigParts parts = rig.parts();
    const bool hasSheet = parts.sheet.has_value();
    const auto followsSheet = [&](std::uint32_t vertex) {
        return hasSheet && rig.parts().sheet->followers[vertex].row != SheetMotion::kNoRow;
    };
    parts.sheet.reset(); // its vertices follow nothing else
    const RigCore core(std::move(parts));
    std::map<std::vector<std::uint16_t>, std::vector<std::size_t>> sorted;
    for (std::size_t slot = 0; slot < vertices.size(); ++slot) {
        const auto of = rig.actuatorsOf(vertices[slot]);
        if (!of.empty() && !followsSheet(vertices[slot])) sorted[{of.begin(), of.end()}].push_back(slot);
    }
    for (auto& [moving, slots] : sorted) {
        FreeVertices made;
        for (const std::uint16_t actuator : moving)
            made.axes.push_back(static_cast<std::size_t>(std::ranges::find(actuators, actuator) - actuators.begin()));
        std::vector<std::uint32_t> listed;
        for (const std::size_t slot : slots) {
            listed.push_back(vertices[slot]);
            const std::vector<StrokeBound> bounds = strokeBounds(core, vertices[slot]);
            for (const std::uint16_t actuator : moving) {
                StrokeBound sum{actuator};
                for (const StrokeBound& one : bounds) {
                    if (one.actuator != actuator) continue;
                    sum.first += std::abs(one.first);
                    sum.second += std::abs(one.second);
                    sum.kink += std::abs(one.kink);
                }
                made.bounds.push_back(sum);
            }
        }
        made.slots = std::move(slots);
        made.subset = rig.subset(listed);
        free.push_back(std::move(made));
    }
}

void MotionBounds::Data::boundFree(const FreeVertices& of, std::span<const double> low, std::span<const double> high,
                                   MotionBox& out) const {
    const std::size_t count = of.slots.size();
    const std::size_t moving = of.axes.size();
    const auto half = [&](std::size_t k) { return 0.5 * (high[of.axes[k]] - low[of.axes[k]]); };
    // Corners are taken of the axes that move the vertices most within the box; of the others only the way.
    std::vector<std::pair<double, std::size_t>> ways;
    for (std::size_t k = 0; k < moving; ++k) {
        double most = 0.0;
        for (std::size_t v = 0; v < count; ++v) most = std::max(most, of.bounds[v * moving + k].first * half(k));
        if (most > 0.0) ways.emplace_back(most, k);
    }
    std::ranges::sort(ways, std::greater<>());
    const std::size_t gridded = std::min(ways.size(), kMostGridded);
    const std::size_t corners = std::size_t{1} << gridded;
    std::vector<double> strokes(rig.actuatorCount(), 0.0);
    for (std::size_t k = 0; k < moving; ++k)
        strokes[actuators[of.axes[k]]] = 0.5 * (low[of.axes[k]] + high[of.axes[k]]);
    std::vector<glm::vec3> positions(count * corners);
    for (std::size_t corner = 0; corner < corners; ++corner) {
        for (std::size_t g = 0; g < gridded; ++g) {
            const std::size_t axis = of.axes[ways[g].second];
            strokes[actuators[axis]] = (corner >> g & 1U) != 0 ? high[axis] : low[axis];
        }
        of.subset->deform(strokes, {positions.data() + corner * count, count});
    }
    const float share = 1.0F / static_cast<float>(corners);
    for (std::size_t v = 0; v < count; ++v) {
        const std::size_t slot = of.slots[v];
        glm::vec3 mean(0.0F);
        std::array<glm::vec3, kMostGridded> slopes{};
        for (std::size_t corner = 0; corner < corners; ++corner) {
            const glm::vec3 p = share * positions[corner * count + v];
            mean += p;
            for (std::size_t g = 0; g < gridded; ++g) slopes[g] += (corner >> g & 1U) != 0 ? p : -p;
        }
        glm::vec3 rest(0.0F);
        for (std::size_t corner = 0; corner < corners; ++corner) {
            glm::vec3 linear = mean;
            for (std::size_t g = 0; g < gridded; ++g) linear += (corner >> g & 1U) != 0 ? slopes[g] : -slopes[g];
            rest = glm::max(rest, glm::abs(positions[corner * count + v] - linear));
        }
        double around = 0.0;
        for (std::size_t w = 0; w < ways.size(); ++w) {
            const std::size_t k = ways[w].second;
            const StrokeBound& bound = of.bounds[v * moving + k];
            around += w < gridded ? 0.5 * half(k) * (bound.second * half(k) + bound.kink) : bound.first * half(k);
        }
        const glm::vec3 extent = glm::abs(mean) + rest;
        out.at[slot] = mean;
        out.rest[slot] = rest + glm::vec3(static_cast<float>(around) + kRounding * (extent.x + extent.y + extent.z));
        out.tail[slot] = out.rest[slot];
        for (std::size_t g = 0; g < gridded; ++g) out.slopes[slot * axes() + of.axes[ways[g].second]] = slopes[g];
    }
}

namespace {

/// A sheet's mode coefficients in powers of a box' own coordinates: of each mode the constant, the linear and the
/// quadratic coefficients, and a bound of what the higher powers add.
struct ModePowers {
    std::size_t axes = 0;
    std::size_t width = 0;                ///< 1 + axes + axes (axes + 1) / 2
    std::vector<float> values;            ///< [mode * width + which]
    std::vector<float> quadratic, higher; ///< one a mode: sums of absolute coefficients

    [[nodiscard]] std::size_t square(std::size_t i, std::size_t j) const noexcept { // i <= j
        return 1 + axes + i * axes - i * (i + 1) / 2 + j;
    }
};

class PowerExpansion {
public:
    PowerExpansion(const SheetModes& modes, float share, std::span<const double> low, std::span<const double> high)
        : modes_(modes), count_(modes.modeCount), powers_(modes.strokes.size()) {
        out_.axes = modes.strokes.size();
        out_.width = 1 + out_.axes + out_.axes * (out_.axes + 1) / 2;
        out_.values.assign(count_ * out_.width, 0.0F);
        out_.quadratic.assign(count_, 0.0F);
        out_.higher.assign(count_, 0.0F);
        std::size_t size = modes.coefficients.size();
        for (std::size_t axis = 0; axis < out_.axes; ++axis) {
            const double scale = static_cast<double>(share);
            matrices_.push_back(powersFromNodes(modes.strokes[axis], 0.5 * scale * (low[axis] + high[axis]),
                                                0.5 * scale * (high[axis] - low[axis])));
            moves_.push_back(high[axis] > low[axis]);
            size /= modes.strokes[axis].size();
            buffers_.emplace_back(size);
        }
        expand(0, modes.coefficients.data(), modes.coefficients.size(), 0);
    }
    [[nodiscard]] const ModePowers& result() const noexcept { return out_; }

private:
    void expand(std::size_t axis, const float* tensor, std::size_t size, std::size_t degree) {
        if (axis == out_.axes) {
            take(tensor, degree);
            return;
        }
        const std::size_t nodes = modes_.strokes[axis].size();
        const std::size_t inner = size / nodes;
        float* __restrict const into = buffers_[axis].data();
        for (std::size_t power = 0; power < (moves_[axis] ? nodes : 1); ++power) {
            const auto& weights = matrices_[axis][power];
            if (nodes == 3) { // the usual grid in one pass
                const float *const a = tensor, *const b = a + inner, *const c = b + inner;
                for (std::size_t i = 0; i < inner; ++i)
                    into[i] = weights[0] * a[i] + weights[1] * b[i] + weights[2] * c[i];
            } else {
                for (std::size_t i = 0; i < inner; ++i) into[i] = weights[0] * tensor[i];
                for (std::size_t node = 1; node < nodes; ++node)
                    for (std::size_t i = 0; i < inner; ++i) into[i] += weights[node] * tensor[node * inner + i];
            }
            powers_[axis] = power;
            expand(axis + 1, into, inner, degree + power);
        }
    }

    void take(const float* coefficients, std::size_t degree) {
        if (degree > 2) {
            for (std::size_t k = 0; k < count_; ++k) out_.higher[k] += std::abs(coefficients[k]);
            return;
        }
        std::size_t which = 0;
        if (degree > 0) {
            std::size_t first = 0;
            while (powers_[first] == 0) ++first;
            std::size_t second = first;
            if (degree == 2 && powers_[first] == 1) do
                    ++second;
                while (powers_[second] == 0);
            which = degree == 1 ? 1 + first : out_.square(first, second);
        }
        for (std::size_t k = 0; k < count_; ++k) {
            out_.values[k * out_.width + which] = coefficients[k];
            if (degree == 2) out_.quadratic[k] += std::abs(coefficients[k]);
        }
    }

    const SheetModes& modes_;
    std::size_t count_;
    std::vector<NodeMatrix> matrices_;
    std::vector<bool> moves_;
    std::vector<std::vector<float>> buffers_;
    std::vector<std::size_t> powers_;
    ModePowers out_;
};

} // namespace

void MotionBounds::Data::boundSheet(const SheetVertices& of, std::span<const double> low, std::span<const double> high,
                                    MotionBox& out) const {
    const SheetModes& modes = rig.parts().sheet->modes;
    const std::size_t levers = modes.strokes.size();
    std::vector<double> lowOfLever(levers, 0.0);
    std::vector<double> highOfLever(levers, 0.0);
    for (std::size_t lever = 0; lever < levers; ++lever)
        if (axisOfLever[lever] >= 0) {
            lowOfLever[lever] = low[static_cast<std::size_t>(axisOfLever[lever])];
            highOfLever[lever] = high[static_cast<std::size_t>(axisOfLever[lever])];
        }
    const PowerExpansion expansion(modes, of.share, lowOfLever, highOfLever);
    const ModePowers& powers = expansion.result();
    std::vector<float> x(powers.width), y(powers.width), z(powers.width);
    for (const SheetVertices::Slot& slot : of.slots) {
        const glm::vec3* const row = modes.modes.data() + slot.row * modes.modeCount;
        for (std::vector<float>* sums : {&x, &y, &z}) std::fill(sums->begin(), sums->end(), 0.0F);
        glm::vec3 tail(slot.leftOut);
        float extent = 0.0F;
        for (std::size_t k = 0; k < modes.modeCount; ++k) {
            const float* const ofMode = powers.values.data() + k * powers.width;
            const glm::vec3 mode = row[k];
            for (std::size_t i = 0; i < powers.width; ++i) {
                x[i] += mode.x * ofMode[i];
                y[i] += mode.y * ofMode[i];
                z[i] += mode.z * ofMode[i];
            }
            const glm::vec3 size = glm::abs(mode);
            tail += size * powers.higher[k];
            extent += (size.x + size.y + size.z) * (std::abs(ofMode[0]) + powers.quadratic[k] + powers.higher[k]);
        }
        const glm::vec3 place = glm::abs(restPositions[slot.slot]);
        tail += glm::vec3(kRounding * (extent + place.x + place.y + place.z));
        glm::vec3 at = restPositions[slot.slot] + glm::vec3(x[0], y[0], z[0]);
        glm::vec3 rest = tail;
        for (std::size_t i = 0; i < levers; ++i)
            for (std::size_t j = i; j < levers; ++j) {
                const std::size_t which = powers.square(i, j);
                glm::vec3 value(x[which], y[which], z[which]);
                if (i == j) { // x_i^2 lies in [0, 1]
                    value *= 0.5F;
                    at += value;
                }
                rest += glm::abs(value);
                out.curvatures[slot.slot * out.pairs + which - 1 - levers] = value;
            }
        out.at[slot.slot] = at;
        out.rest[slot.slot] = rest;
        out.tail[slot.slot] = tail;
        for (std::size_t lever = 0; lever < levers; ++lever)
            if (axisOfLever[lever] >= 0)
                out.slopes[slot.slot * axes() + static_cast<std::size_t>(axisOfLever[lever])] = {
                    x[1 + lever], y[1 + lever], z[1 + lever]};
    }
}

MotionBounds::MotionBounds(const Rig& rig, std::span<const std::uint32_t> vertices,
                           std::span<const std::uint16_t> actuators) {
    auto data = std::make_unique<Data>(rig);
    data->actuators.assign(actuators.begin(), actuators.end());
    for (const std::uint32_t vertex : vertices) data->restPositions.push_back(rig.restMesh().positions[vertex]);
    if (rig.parts().sheet) data->listSheet(vertices);
    data->listFree(vertices);
    data_ = std::move(data);
}
MotionBounds::~MotionBounds() = default;
MotionBounds::MotionBounds(MotionBounds&&) noexcept = default;
MotionBounds& MotionBounds::operator=(MotionBounds&&) noexcept = default;

void MotionBounds::over(std::span<const double> low, std::span<const double> high, MotionBox& out) const {
    out.at = data_->restPositions;
    out.rest.assign(out.at.size(), glm::vec3(0.0F));
    out.slopes.assign(out.at.size() * data_->axes(), glm::vec3(0.0F));
    const std::size_t levers = data_->axisOfLever.size();
    out.pairs = levers * (levers + 1) / 2;
    out.curvatures.assign(out.at.size() * out.pairs, glm::vec3(0.0F));
    out.tail.assign(out.at.size(), glm::vec3(0.0F));
    for (const FreeVertices& of : data_->free) data_->boundFree(of, low, high, out);
    for (const SheetVertices& of : data_->sheet) data_->boundSheet(of, low, high, out);
}

} // namespace lumorph
