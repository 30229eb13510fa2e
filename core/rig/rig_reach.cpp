#include "core/rig/rig_reach.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/rig/sheet_reach.h"

namespace lumorph {
namespace {

/// Follows a vertex along its steps and bounds the first and second derivative of its position by
/// each stroke. `way` bounds how far it can have moved from rest so far.
class Bounds {
public:
    Bounds(const RigCore& core, std::uint32_t vertex)
        : core_(core), vertex_(vertex), rest_(core.parts.restMesh.positions[vertex]) {
        bool skinDue = !core.skinMoves.empty() && core.skinMoves[vertex];
        for (const MotionStep& step : core.stepsOf(vertex)) {
            const CompiledActuator& actuator = core.actuators[step.actuator];
            if (actuator.kind != CompiledActuator::Kind::morph && skinDue) {
                skin();
                skinDue = false;
            }
            add(step, actuator);
        }
        if (skinDue) skin();
    }

    [[nodiscard]] std::vector<StrokeBound>& parts() noexcept { return parts_; }

private:
    void add(const MotionStep& step, const CompiledActuator& actuator) {
        const double amount = actuator.range * static_cast<double>(step.weight);
        switch (actuator.kind) {
        case CompiledActuator::Kind::morph:
            morph(step);
            break;
        case CompiledActuator::Kind::slide:
            push({step.actuator, amount, 0.0, 0.0});
            break;
        case CompiledActuator::Kind::hinge: {
            const double radius =
                glm::length(glm::cross(rest_ - glm::dvec3(actuator.origin), glm::dvec3(actuator.axis))) + way_;
            push({step.actuator, amount * radius, amount * amount * radius, 0.0});
            break;
        }
        case CompiledActuator::Kind::bend:
            bend(step.actuator, actuator, amount);
            break;
        case CompiledActuator::Kind::skin:
        case CompiledActuator::Kind::lever:
            break;
        }
    }

    void morph(const MotionStep& step) {
        const auto& target = std::get<MorphTarget>(core_.parts.actuators[step.actuator].deformer);
        double speed = 0.0;
        double key = 0.0;
        glm::dvec3 at(0.0);
        for (std::size_t k = 0; k < target.keys.size(); ++k) {
            const glm::dvec3 next(target.displacements[k][step.influence]);
            speed = std::max(speed, glm::distance(at, next) / (static_cast<double>(target.keys[k]) - key));
            key = target.keys[k];
            at = next;
        }
        const bool kinked = target.keys.size() > 1 || target.keys.back() < step.weight;
        const double first = speed * static_cast<double>(step.weight);
        push({step.actuator, first, 0.0, kinked ? 2.0 * first : 0.0});
    }

    // A bend changes what earlier strokes do: its first derivative by place is at most 1 + h * curvature,
    // its second at most curvature * (2 + h * curvature), and off the neutral surface the first one
    // jumps by h * curvature at either end of the arc.
    void bend(std::uint16_t index, const CompiledActuator& bend, double amount) {
        const double u = glm::dot(rest_ - glm::dvec3(bend.origin), glm::dvec3(bend.direction)) + way_;
        if (u <= 0.0) return;
        const double h = std::abs(glm::dot(rest_ - glm::dvec3(bend.origin), glm::dvec3(bend.normal))) + way_;
        const double curvature = amount / bend.length;
        const double stretch = 1.0 + h * curvature;
        for (StrokeBound& part : parts_) {
            part.kink = stretch * part.kink + 2.0 * h * curvature * part.first;
            part.second = stretch * part.second + curvature * (1.0 + stretch) * part.first * part.first;
            part.first *= stretch;
        }
        const double arc = std::min(u, bend.length);
        const double share = arc / bend.length;
        const double beyond = u - arc;
        push({index, amount * (0.5 * arc * share + beyond + h * share),
              amount * amount * (arc * share * share / 3.0 + beyond + h * share * share), 0.0});
    }

    // Linear blending takes the mean of rigid motions; turning a joint moves the vertex about its
    // pivot at a distance no longer than the chain of links between them.
    void skin() {
        const Skeleton& skeleton = *core_.parts.skeleton;
        std::vector<glm::dmat4> rest;
        for (const Skeleton::Joint& joint : skeleton.joints)
            rest.push_back(joint.parent < 0 ? glm::dmat4(joint.localRest)
                                            : rest[joint.parent] * glm::dmat4(joint.localRest));
        std::map<std::uint16_t, StrokeBound> sums;
        for (int k = 0; k < 4; ++k) {
            const double weight = skeleton.vertexWeights[vertex_][k];
            if (weight == 0.0) continue;
            glm::dvec3 end = rest_;
            double chain = way_;
            for (int j = skeleton.vertexJoints[vertex_][k]; j >= 0; j = skeleton.joints[j].parent) {
                const glm::dvec3 pivot(rest[j][3]);
                chain += glm::distance(end, pivot);
                end = pivot;
                double slid = 0.0;
                for (const std::uint16_t a : core_.skinActuators) {
                    const auto& joint = std::get<SkinJoint>(core_.parts.actuators[a].deformer);
                    if (joint.joint != j) continue;
                    const double range = joint.max - joint.min;
                    StrokeBound& sum = sums[a];
                    sum.actuator = a;
                    if (joint.motion == SkinJoint::Motion::rotate) {
                        sum.first += weight * range * chain;
                        sum.second += weight * range * range * chain;
                    } else {
                        slid += range * glm::length(glm::dvec3(rest[j][0]));
                        sum.first += weight * range * glm::length(glm::dvec3(rest[j][0]));
                    }
                }
                chain += slid;
            }
        }
        for (const auto& [index, sum] : sums) push(sum);
    }

    void push(const StrokeBound& part) {
        parts_.push_back(part);
        way_ += part.first;
    }

    const RigCore& core_;
    std::uint32_t vertex_;
    glm::dvec3 rest_;
    double way_ = 0.0;
    std::vector<StrokeBound> parts_;
};

bool movesAdditively(const RigCore& core, std::uint32_t vertex) {
    if (!core.skinMoves.empty() && core.skinMoves[vertex]) return false;
    return std::ranges::all_of(core.stepsOf(vertex), [&](const MotionStep& step) {
        const auto kind = core.actuators[step.actuator].kind;
        return kind == CompiledActuator::Kind::slide || kind == CompiledActuator::Kind::morph;
    });
}

Box additiveBox(const RigCore& core, std::uint32_t vertex) {
    const glm::vec3 rest = core.parts.restMesh.positions[vertex];
    const auto steps = core.stepsOf(vertex);
    if (steps.empty()) return {rest, rest};
    glm::vec3 low = rest;
    glm::vec3 high = rest;
    glm::vec3 rounding(0.0F);
    for (const MotionStep& step : steps) {
        const Actuator& actuator = core.parts.actuators[step.actuator];
        const CompiledActuator& compiled = core.actuators[step.actuator];
        Box extent{glm::vec3(0.0F), glm::vec3(0.0F)};
        const MotionSetup full = setUp(actuator, compiled, 1.0, step.weight);
        if (const auto* morph = std::get_if<MorphTarget>(&actuator.deformer)) {
            extent.include(morphDisplacement(*morph, full.keys, step.influence));
            for (int k = 0; k <= full.keys.lower; ++k) extent.include(morph->displacements[k][step.influence]);
        } else {
            extent.include(full.shift);
        }
        low += extent.min;
        high += extent.max;
        rounding += glm::abs(extent.min) + glm::abs(extent.max);
    }
    if (steps.size() == 1 && std::holds_alternative<Slide>(core.parts.actuators[steps.front().actuator].deformer))
        return {low, high}; // the same two roundings as in deformation: nothing to allow for
    const glm::vec3 slack =
        1e-6F * (rounding + glm::abs(rest) * glm::vec3(glm::greaterThan(rounding, glm::vec3(0.0F))));
    return {low - slack, high + slack};
}

/// Vertices whose reach is searched over the same actuators.
struct Group {
    std::vector<std::uint32_t> vertices;
    std::vector<double> slack; ///< beside `vertices`, metres
};

constexpr std::array<int, 4> kIntervals{0, 128, 32, 12}; // by the number of gridded actuators

void searchGrid(const std::shared_ptr<const RigCore>& core, const std::vector<std::uint16_t>& actuators,
                const Group& group, std::vector<Box>& boxes) {
    const DeformProgram program(core, group.vertices);
    std::vector<glm::vec3> positions(group.vertices.size());
    std::vector<double> strokes(core->actuators.size(), 0.0);
    const int intervals = kIntervals[actuators.size()];
    std::vector<int> at(actuators.size(), 0);
    while (true) {
        for (std::size_t k = 0; k < actuators.size(); ++k)
            strokes[actuators[k]] = static_cast<double>(at[k]) / intervals;
        program.run(strokes, positions);
        for (std::size_t v = 0; v < positions.size(); ++v) boxes[group.vertices[v]].include(positions[v]);
        std::size_t digit = 0;
        while (digit < at.size() && at[digit] == intervals) at[digit++] = 0;
        if (digit == at.size()) break;
        ++at[digit];
    }
    for (std::size_t v = 0; v < group.vertices.size(); ++v) {
        Box& box = boxes[group.vertices[v]];
        const glm::vec3 extent = glm::max(glm::abs(box.min), glm::abs(box.max));
        // A millionth of the coordinates covers the rounding of the deformation itself.
        const glm::vec3 slack(static_cast<float>(group.slack[v]) + 1e-6F * std::max({extent.x, extent.y, extent.z}));
        box.min -= slack;
        box.max += slack;
    }
}

/// Boxes of the vertices that follow a sheet. Those of one row and path share the work.
void includeSheet(const RigCore& core, std::vector<Box>& boxes) {
    const CompiledSheet& sheet = *core.sheet;
    const SheetReach reach(sheet);
    std::map<std::pair<std::uint32_t, std::uint16_t>, Box> known;
    for (std::uint32_t vertex = 0; vertex < boxes.size(); ++vertex) {
        const std::uint16_t path = sheet.pathOf(vertex);
        if (path == CompiledSheet::kNoPath) continue;
        const std::uint32_t row = sheet.motion().followers[vertex].row;
        const auto [at, isNew] = known.try_emplace({row, path});
        if (isNew) at->second = reach.of(path, row);
        const glm::vec3 rest = core.parts.restMesh.positions[vertex];
        // A millionth covers the rounding of the sum.
        const glm::vec3 slack = 1e-6F * (glm::abs(rest) + glm::max(glm::abs(at->second.min), glm::abs(at->second.max)));
        boxes[vertex] = {rest + at->second.min - slack, rest + at->second.max + slack};
    }
}

} // namespace

std::vector<StrokeBound> strokeBounds(const RigCore& core, std::uint32_t vertex) {
    return std::move(Bounds(core, vertex).parts());
}

std::vector<Box> reachBoxes(const std::shared_ptr<const RigCore>& core) {
    const std::size_t vertexCount = core->parts.restMesh.positions.size();
    std::vector<Box> boxes(vertexCount);
    std::map<std::vector<std::uint16_t>, Group> groups;
    for (std::uint32_t vertex = 0; vertex < vertexCount; ++vertex) {
        if (movesAdditively(*core, vertex)) {
            boxes[vertex] = additiveBox(*core, vertex);
            continue;
        }
        Bounds bounds(*core, vertex);
        auto& parts = bounds.parts();
        const glm::vec3 rest = core->parts.restMesh.positions[vertex];
        std::erase_if(parts, [](const StrokeBound& part) { return part.first == 0.0; });
        if (parts.empty()) {
            boxes[vertex] = {rest, rest};
            continue;
        }
        std::stable_sort(parts.begin(), parts.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
        const std::size_t gridded = std::min<std::size_t>(parts.size(), 3);
        const double step = 1.0 / kIntervals[gridded];
        std::vector<std::uint16_t> actuators;
        double slack = 0.0;
        for (std::size_t k = 0; k < parts.size(); ++k) {
            if (k >= gridded) {
                slack += parts[k].first;
                continue;
            }
            actuators.push_back(parts[k].actuator);
            // Multilinear interpolation between the grid's states errs by h^2/8 * |second derivative|,
            // and at a kink by a quarter of a step's jump.
            slack += step * step / 8.0 * parts[k].second + 0.25 * step * parts[k].kink;
        }
        std::ranges::sort(actuators);
        Group& group = groups[actuators];
        group.vertices.push_back(vertex);
        group.slack.push_back(slack);
    }
    for (const auto& [actuators, group] : groups) searchGrid(core, actuators, group, boxes);
    if (core->sheet) includeSheet(*core, boxes);
    return boxes;
}

} // namespace lumorph
