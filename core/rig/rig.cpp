#include "core/rig/rig.h"

#include <algorithm>
#include <numeric>
#include <string>

#include "core/base/error.h"
#include "core/rig/deform_program.h"
#include "core/rig/rig_reach.h"
#include "core/rig/rig_validation.h"

namespace lumorph {
namespace {

RigParts validated(RigParts parts) {
    validate(parts);
    return parts;
}

std::vector<std::uint32_t> allVertices(const RigCore& core) {
    std::vector<std::uint32_t> all(core.parts.restMesh.positions.size());
    std::iota(all.begin(), all.end(), 0U);
    return all;
}

bool jointMoves(const RigCore& core, std::uint16_t actuator, std::uint32_t vertex) {
    const Skeleton& skeleton = *core.parts.skeleton;
    const int moved = std::get<SkinJoint>(core.parts.actuators[actuator].deformer).joint;
    for (int k = 0; k < 4; ++k) {
        if (skeleton.vertexWeights[vertex][k] == 0.0F) continue;
        for (int j = skeleton.vertexJoints[vertex][k]; j >= 0; j = skeleton.joints[j].parent)
            if (j == moved) return true;
    }
    return false;
}

} // namespace

bool deformAlike(const RigParts& a, const RigParts& b) {
    if (&a == &b) return true;
    const auto alike = [](const Actuator& one, const Actuator& other) {
        const auto *lever = std::get_if<SheetLift>(&one.deformer),
                   *otherLever = std::get_if<SheetLift>(&other.deformer);
        const bool same = lever && otherLever ? lever->axis == otherLever->axis : one.deformer == other.deformer;
        return same && one.influences == other.influences;
    };
    return a.pathInside == b.pathInside && std::ranges::equal(a.actuators, b.actuators, alike) &&
           a.skeleton == b.skeleton && a.sheet == b.sheet && a.restMesh == b.restMesh;
}

struct Rig::Compiled {
    explicit Compiled(RigParts rigParts)
        : core(std::make_shared<const RigCore>(validated(std::move(rigParts)))), whole(core, allVertices(*core)),
          reach(reachBoxes(core)) {
        for (const Box& box : reach) totalReach.include(box);
        listDependencies();
    }

    void listDependencies() {
        verticesOf.resize(core->actuators.size());
        dependencyStart.push_back(0);
        for (std::uint32_t vertex = 0; vertex < whole.size(); ++vertex) {
            const auto first = dependencies.size();
            for (const MotionStep& step : core->stepsOf(vertex)) dependencies.push_back(step.actuator);
            if (!core->skinMoves.empty() && core->skinMoves[vertex])
                for (const std::uint16_t a : core->skinActuators)
                    if (jointMoves(*core, a, vertex)) dependencies.push_back(a);
            if (core->sheet) addLevers(vertex);
            std::sort(dependencies.begin() + static_cast<std::ptrdiff_t>(first), dependencies.end());
            dependencyStart.push_back(static_cast<std::uint32_t>(dependencies.size()));
            for (std::size_t k = first; k < dependencies.size(); ++k) verticesOf[dependencies[k]].push_back(vertex);
        }
    }

    void addLevers(std::uint32_t vertex) {
        const std::uint16_t path = core->sheet->pathOf(vertex);
        if (path == CompiledSheet::kNoPath) return;
        const std::uint32_t axes = core->sheet->paths()[path].axes;
        for (std::size_t axis = 0; axis < core->parts.sheet->modes.strokes.size(); ++axis)
            if ((axes >> axis & 1U) != 0) dependencies.push_back(core->sheet->actuatorOf(axis));
    }

    std::shared_ptr<const RigCore> core;
    DeformProgram whole;
    std::vector<Box> reach;
    Box totalReach;
    std::vector<std::uint32_t> dependencyStart;
    std::vector<std::uint16_t> dependencies;
    std::vector<std::vector<std::uint32_t>> verticesOf;
};

Rig::Rig(RigParts parts) : compiled_(std::make_shared<const Compiled>(std::move(parts))) {}

const RigParts& Rig::parts() const noexcept { return compiled_->core->parts; }

std::span<const std::uint16_t> Rig::actuatorsOf(std::uint32_t vertex) const noexcept {
    const auto& start = compiled_->dependencyStart;
    const std::uint16_t* const all = compiled_->dependencies.data();
    return {all + start[vertex], all + start[vertex + 1]};
}

std::span<const std::uint32_t> Rig::verticesOf(std::size_t actuator) const noexcept {
    return compiled_->verticesOf[actuator];
}

void Rig::deform(std::span<const double> strokes, std::span<glm::vec3> out) const noexcept {
    compiled_->whole.run(strokes, out);
}

void Rig::deform(std::span<const double> strokes, std::span<const std::uint32_t> vertices,
                 std::span<glm::vec3> out) const noexcept {
    deformListed(*compiled_->core, strokes, vertices, out);
}

std::size_t Rig::Subset::size() const noexcept { return program_->size(); }

void Rig::Subset::deform(std::span<const double> strokes, std::span<glm::vec3> out) const noexcept {
    program_->run(strokes, out);
}

Rig::Subset Rig::subset(std::span<const std::uint32_t> vertices) const {
    for (const std::uint32_t vertex : vertices)
        if (vertex >= restMesh().positions.size())
            throw InvalidInput("vertex " + std::to_string(vertex), "the rig has no such vertex",
                               "list vertices of its rest mesh");
    return Subset(std::make_shared<const DeformProgram>(compiled_->core, vertices));
}

std::span<const Box> Rig::reaches() const noexcept { return compiled_->reach; }
const Box& Rig::reach() const noexcept { return compiled_->totalReach; }

TriangleMesh deformed(const Rig& rig, std::span<const double> strokes) {
    TriangleMesh mesh = rig.restMesh();
    rig.deform(strokes, mesh.positions);
    return mesh;
}

std::vector<double> strokesOf(const Rig& rig, const State& state, int levels) {
    if (levels < 2 || levels > kMaxLevels)
        throw InvalidInput(std::to_string(levels) + " levels", "the level count is out of range",
                           "use 2 to 200 levels");
    if (state.size() != rig.actuatorCount())
        throw InvalidInput(
            "state", std::to_string(state.size()) + " levels for " + std::to_string(rig.actuatorCount()) + " actuators",
            "give one level an actuator");
    std::vector<double> strokes;
    for (std::size_t a = 0; a < state.size(); ++a) {
        if (state[a].index < 0 || state[a].index >= levels)
            throw InvalidInput("level " + std::to_string(state[a].index) + " of \"" + rig.actuators()[a].name + "\"",
                               "it is out of range", "use 0 to " + std::to_string(levels - 1));
        strokes.push_back(strokeOf(state[a], levels));
    }
    return strokes;
}

} // namespace lumorph
