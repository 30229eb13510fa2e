#include "core/rig/deform_program.h"

#include <algorithm>
#include <array>
#include <tuple>

#include <glm/geometric.hpp>

namespace lumorph {

RigCore::RigCore(RigParts rigParts) : parts(std::move(rigParts)) {
    const std::size_t vertexCount = parts.restMesh.positions.size();
    for (std::size_t a = 0; a < parts.actuators.size(); ++a) {
        actuators.push_back(compileActuator(parts.actuators[a]));
        if (actuators.back().kind == CompiledActuator::Kind::skin)
            skinActuators.push_back(static_cast<std::uint16_t>(a));
    }
    stepStart.assign(vertexCount + 1, 0);
    const auto forEachStep = [&](auto&& visit) {
        for (const bool morphs : {true, false})
            for (std::size_t a = 0; a < actuators.size(); ++a) {
                if ((actuators[a].kind == CompiledActuator::Kind::morph) != morphs) continue;
                if (actuators[a].kind == CompiledActuator::Kind::skin ||
                    actuators[a].kind == CompiledActuator::Kind::lever)
                    continue;
                const auto& influences = parts.actuators[a].influences;
                for (std::size_t i = 0; i < influences.size(); ++i)
                    if (influences[i].weight != 0.0F)
                        visit(influences[i].vertex, MotionStep{static_cast<std::uint16_t>(a), influences[i].weight,
                                                               static_cast<std::uint32_t>(i)});
            }
    };
    forEachStep([&](std::uint32_t vertex, const MotionStep&) { ++stepStart[vertex + 1]; });
    for (std::size_t v = 0; v < vertexCount; ++v) stepStart[v + 1] += stepStart[v];
    steps.resize(stepStart.back());
    std::vector<std::uint32_t> next(stepStart.begin(), stepStart.end() - 1);
    forEachStep([&](std::uint32_t vertex, const MotionStep& step) { steps[next[vertex]++] = step; });
    if (parts.sheet) sheet.emplace(*parts.sheet, parts.actuators);
    if (skinActuators.empty()) return;

    // A joint moves when it or one of its ancestors is an actuator's.
    std::vector<bool> moves(parts.skeleton->joints.size(), false);
    for (const std::uint16_t a : skinActuators) moves[std::get<SkinJoint>(parts.actuators[a].deformer).joint] = true;
    for (std::size_t j = 0; j < moves.size(); ++j) {
        const int parent = parts.skeleton->joints[j].parent;
        if (parent >= 0 && moves[parent]) moves[j] = true;
    }
    skinMoves.assign(vertexCount, false);
    for (std::size_t v = 0; v < vertexCount; ++v)
        for (int k = 0; k < 4; ++k)
            if (parts.skeleton->vertexWeights[v][k] != 0.0F && moves[parts.skeleton->vertexJoints[v][k]])
                skinMoves[v] = true;
}

struct DeformProgram::Entry {
    std::uint16_t actuator;
    float weight;
    Zone zone;
    std::uint32_t slot;
    std::uint32_t influence;
    [[nodiscard]] auto key() const { return std::tuple(actuator, weight, zone); }
};

DeformProgram::DeformProgram(std::shared_ptr<const RigCore> core, std::span<const std::uint32_t> vertices)
    : core_(std::move(core)) {
    std::vector<Entry> morphs;
    std::vector<Entry> space;
    for (std::uint32_t slot = 0; slot < vertices.size(); ++slot) {
        const std::uint32_t vertex = vertices[slot];
        rest_.push_back(core_->parts.restMesh.positions[vertex]);
        if (core_->sheet && core_->sheet->pathOf(vertex) != CompiledSheet::kNoPath)
            sheet_.push_back({core_->sheet->pathOf(vertex), slot, core_->parts.sheet->followers[vertex].row});
        bool fromRest = true;
        if (!core_->skinMoves.empty() && core_->skinMoves[vertex]) {
            skinned_.push_back({slot, vertex});
            fromRest = false;
        }
        for (const MotionStep& step : core_->stepsOf(vertex)) {
            const CompiledActuator& actuator = core_->actuators[step.actuator];
            Entry entry{step.actuator, step.weight, Zone::whole, slot, step.influence};
            const bool first = std::exchange(fromRest, false);
            if (actuator.kind == CompiledActuator::Kind::morph) {
                morphs.push_back(entry);
                continue;
            }
            if (first && actuator.kind == CompiledActuator::Kind::bend) {
                const float u = glm::dot(rest_.back() - actuator.origin, actuator.direction);
                if (u <= 0.0F) {
                    fromRest = true; // this side of the bend line nothing moves
                    continue;
                }
                entry.zone = u <= static_cast<float>(actuator.length) ? Zone::arc : Zone::straight;
            }
            space.push_back(entry);
        }
    }
    std::ranges::stable_sort(sheet_, {}, &SheetSlot::path);
    addRuns(morphs, morphRuns_);
    addRuns(space, spaceRuns_);
}

void DeformProgram::addRuns(std::vector<Entry>& entries, std::vector<Run>& runs) {
    std::stable_sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.key() < b.key(); });
    for (std::size_t i = 0; i < entries.size(); ++i) {
        const Entry& entry = entries[i];
        if (i == 0 || entries[i - 1].key() != entry.key())
            runs.push_back({entry.actuator, entry.zone, entry.weight, static_cast<std::uint32_t>(slots_.size()), 0,
                            static_cast<std::uint32_t>(bendU_.size())});
        ++runs.back().count;
        slots_.push_back(entry.slot);
        influences_.push_back(entry.influence);
        if (entry.zone == Zone::whole) continue;
        const CompiledActuator& bend = core_->actuators[entry.actuator];
        const glm::vec3 rest = rest_[entry.slot];
        const float u = glm::dot(rest - bend.origin, bend.direction);
        const float h = glm::dot(rest - bend.origin, bend.normal);
        bendU_.push_back(u);
        bendH_.push_back(h);
        bendBase_.push_back(rest - u * bend.direction - h * bend.normal);
    }
}

void DeformProgram::run(std::span<const double> strokes, std::span<glm::vec3> out) const noexcept {
    std::copy(rest_.begin(), rest_.end(), out.begin());
    runMorphs(strokes, out);
    if (!skinned_.empty()) runSkin(strokes, out);
    if (!sheet_.empty()) runSheet(strokes, out);
    for (const Run& run : spaceRuns_) {
        const double stroke = strokes[run.actuator];
        if (stroke == 0.0) continue;
        const MotionSetup setup =
            setUp(core_->parts.actuators[run.actuator], core_->actuators[run.actuator], stroke, run.weight);
        if (setup.still) continue;
        if (run.zone == Zone::whole)
            runSpace(run, setup, out);
        else
            runBend(run, setup, out);
    }
}

void DeformProgram::runMorphs(std::span<const double> strokes, std::span<glm::vec3> out) const noexcept {
    for (const Run& run : morphRuns_) {
        if (strokes[run.actuator] == 0.0) continue;
        const Actuator& actuator = core_->parts.actuators[run.actuator];
        const MotionSetup setup = setUp(actuator, core_->actuators[run.actuator], strokes[run.actuator], run.weight);
        const auto& morph = std::get<MorphTarget>(actuator.deformer);
        for (std::uint32_t k = run.first; k < run.first + run.count; ++k)
            out[slots_[k]] += morphDisplacement(morph, setup.keys, influences_[k]);
    }
}

void DeformProgram::runSkin(std::span<const double> strokes, std::span<glm::vec3> out) const noexcept {
    const Skeleton& skeleton = *core_->parts.skeleton;
    SkinPose pose;
    poseSkin(skeleton, core_->parts.actuators, core_->skinActuators, strokes, pose);
    if (pose.still) return;
    for (const auto [slot, vertex] : skinned_)
        out[slot] = skinned(pose, skeleton.vertexJoints[vertex], skeleton.vertexWeights[vertex], out[slot]);
}

void DeformProgram::runSheet(std::span<const double> strokes, std::span<glm::vec3> out) const noexcept {
    PathCoefficients coefficients;
    int evaluated = -1;
    for (const auto [path, slot, row] : sheet_) {
        if (path != evaluated) core_->sheet->evaluate(path, strokes, coefficients);
        evaluated = path;
        if (!coefficients.still) out[slot] += core_->sheet->displacement(row, coefficients.values.data());
    }
}

void DeformProgram::runSpace(const Run& run, const MotionSetup& setup, std::span<glm::vec3> out) const noexcept {
    const CompiledActuator& actuator = core_->actuators[run.actuator];
    for (std::uint32_t k = run.first; k < run.first + run.count; ++k)
        out[slots_[k]] = applySpace(actuator, setup, out[slots_[k]]);
}

void DeformProgram::runBend(const Run& run, const MotionSetup& setup, std::span<glm::vec3> out) const noexcept {
    const CompiledActuator& bend = core_->actuators[run.actuator];
    constexpr std::uint32_t kChunk = 64; // the arithmetic runs in vector registers, the scatter cannot
    std::array<glm::vec2, kChunk> bent;
    for (std::uint32_t done = 0; done < run.count; done += kChunk) {
        const std::uint32_t count = std::min(kChunk, run.count - done);
        const float* const u = bendU_.data() + run.firstLocal + done;
        const float* const h = bendH_.data() + run.firstLocal + done;
        if (run.zone == Zone::arc)
            for (std::uint32_t k = 0; k < count; ++k) bent[k] = bendArc(setup, u[k], h[k]);
        else
            for (std::uint32_t k = 0; k < count; ++k) bent[k] = bendStraight(setup, u[k], h[k]);
        const glm::vec3* const base = bendBase_.data() + run.firstLocal + done;
        const std::uint32_t* const slots = slots_.data() + run.first + done;
        for (std::uint32_t k = 0; k < count; ++k)
            out[slots[k]] = base[k] + bent[k].x * bend.direction + bent[k].y * bend.normal;
    }
}

void deformListed(const RigCore& core, std::span<const double> strokes, std::span<const std::uint32_t> vertices,
                  std::span<glm::vec3> out) noexcept {
    // Neighbours in a list mostly share actuator and weight, so the last few set-ups are kept.
    struct Kept {
        int actuator = -1;
        float weight = 0.0F;
        MotionSetup setup;
    };
    std::array<Kept, 4> kept;
    struct KeptPath {
        int path = -1;
        PathCoefficients coefficients;
    };
    std::array<KeptPath, 4> keptPaths;
    SkinPose pose;
    if (!core.skinMoves.empty())
        poseSkin(*core.parts.skeleton, core.parts.actuators, core.skinActuators, strokes, pose);
    for (std::size_t k = 0; k < vertices.size(); ++k) {
        const std::uint32_t vertex = vertices[k];
        glm::vec3 point = core.parts.restMesh.positions[vertex];
        if (core.sheet && core.sheet->pathOf(vertex) != CompiledSheet::kNoPath) {
            const std::uint16_t path = core.sheet->pathOf(vertex);
            KeptPath& entry = keptPaths[path % keptPaths.size()];
            if (entry.path != path) core.sheet->evaluate(path, strokes, entry.coefficients);
            entry.path = path;
            if (!entry.coefficients.still)
                point +=
                    core.sheet->displacement(core.parts.sheet->followers[vertex].row, entry.coefficients.values.data());
        }
        bool skinDue = !pose.still && core.skinMoves[vertex];
        const auto applySkin = [&] {
            const Skeleton& skeleton = *core.parts.skeleton;
            point = skinned(pose, skeleton.vertexJoints[vertex], skeleton.vertexWeights[vertex], point);
            skinDue = false;
        };
        for (const MotionStep& step : core.stepsOf(vertex)) {
            const Actuator& actuator = core.parts.actuators[step.actuator];
            const CompiledActuator& compiled = core.actuators[step.actuator];
            const bool morphs = compiled.kind == CompiledActuator::Kind::morph;
            if (!morphs && skinDue) applySkin();
            if (strokes[step.actuator] == 0.0) continue;
            Kept& entry = kept[step.actuator % kept.size()];
            if (entry.actuator != step.actuator || entry.weight != step.weight)
                entry = {step.actuator, step.weight, setUp(actuator, compiled, strokes[step.actuator], step.weight)};
            if (entry.setup.still) continue;
            if (morphs)
                point += morphDisplacement(std::get<MorphTarget>(actuator.deformer), entry.setup.keys, step.influence);
            else
                point = applySpace(compiled, entry.setup, point);
        }
        if (skinDue) applySkin();
        out[k] = point;
    }
}

} // namespace lumorph
