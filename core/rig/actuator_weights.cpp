#include "core/rig/actuator_weights.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/geometry/position_index.h"
#include "core/geometry/surface_distance.h"

namespace lumorph {
namespace {

constexpr float kSteps = 1000.0F;
constexpr double kDabsInRadius = 4.0;
// A stroke that jumps across the device dabs at most so often.
constexpr int kMostDabs = 200;

float rounded(float weight) { return std::round(weight * kSteps) / kSteps; }

void setJointWeight(Skeleton& skeleton, std::size_t vertex, int joint, float weight) {
    glm::u16vec4& joints = skeleton.vertexJoints[vertex];
    glm::vec4& weights = skeleton.vertexWeights[vertex];
    int slot = -1;
    int least = 0;
    for (int k = 0; k < 4; ++k) {
        if (weights[k] != 0.0F && joints[k] == joint) slot = k;
        if (weights[k] < weights[least]) least = k;
    }
    const float before = slot < 0 ? 0.0F : weights[slot];
    if (before == weight) return;
    if (slot < 0) {
        slot = least;
        joints[slot] = static_cast<std::uint16_t>(joint);
    }
    weights[slot] = 0.0F;
    float others = weights.x + weights.y + weights.z + weights.w;
    if (others <= 0.0F) {
        const int parent = skeleton.joints[static_cast<std::size_t>(joint)].parent;
        const int free = slot == 0 ? 1 : 0;
        if (parent < 0) {
            weights[slot] = 1.0F;
            return;
        }
        joints[free] = static_cast<std::uint16_t>(parent);
        weights[free] = others = 1.0F;
    }
    for (int k = 0; k < 4; ++k) weights[k] *= (1.0F - weight) / others;
    weights[slot] = weight;
}

/// While a rig is edited its lever may speak of an axis that the sheet lacks.
bool hasLever(const RigParts& parts, const SheetLift& lift) {
    return parts.sheet && lift.axis >= 0 && static_cast<std::size_t>(lift.axis) < parts.sheet->modes.strokes.size();
}

bool followsSheet(const RigParts& parts, std::size_t vertex) {
    return parts.sheet && parts.sheet->followers[vertex].row != SheetMotion::kNoRow;
}

/// Shares of the largest displacement, with this lever alone at full stroke.
std::vector<float> leverWeights(const SheetMotion& sheet, const SheetLift& lift) {
    std::vector<double> strokes(sheet.modes.strokes.size(), 0.0);
    std::vector<float> weights;
    float most = 0.0F;
    for (const SheetMotion::Follower& follower : sheet.followers) {
        strokes.at(static_cast<std::size_t>(lift.axis)) = static_cast<double>(follower.share);
        const bool follows = follower.row != SheetMotion::kNoRow;
        weights.push_back(follows ? glm::length(rowDisplacement(sheet.modes, follower.row, strokes)) : 0.0F);
        most = std::max(most, weights.back());
    }
    if (most > 0.0F)
        for (float& weight : weights) weight = rounded(weight / most);
    return weights;
}

void setMorphWeights(Actuator& actuator, std::span<const float> weights) {
    // None is taken out: its displacement would be lost for ever.
    for (Influence& influence : actuator.influences) influence.weight = rounded(weights[influence.vertex]);
}

} // namespace

std::vector<float> actuatorWeights(const RigParts& parts, std::size_t index) {
    const Actuator& actuator = parts.actuators.at(index);
    std::vector<float> weights(parts.restMesh.positions.size(), 0.0F);
    const auto* joint = std::get_if<SkinJoint>(&actuator.deformer);
    if (const auto* lift = std::get_if<SheetLift>(&actuator.deformer); lift && hasLever(parts, *lift))
        return leverWeights(*parts.sheet, *lift);
    if (!joint) {
        for (const Influence& influence : actuator.influences) weights[influence.vertex] = influence.weight;
        return weights;
    }
    for (std::size_t v = 0; v < weights.size(); ++v)
        for (int k = 0; k < 4; ++k)
            if (parts.skeleton->vertexJoints[v][k] == joint->joint)
                weights[v] = std::max(weights[v], parts.skeleton->vertexWeights[v][k]);
    return weights;
}

std::vector<bool> canFollow(const RigParts& parts, std::size_t index) {
    const Actuator& actuator = parts.actuators.at(index);
    const bool morphs = std::holds_alternative<MorphTarget>(actuator.deformer);
    const bool any = !morphs && !std::holds_alternative<SheetLift>(actuator.deformer);
    std::vector<bool> follows(parts.restMesh.positions.size(), any);
    if (any)
        for (std::size_t v = 0; v < follows.size(); ++v) follows[v] = !followsSheet(parts, v);
    if (morphs)
        for (const Influence& influence : actuator.influences) follows[influence.vertex] = true;
    return follows;
}

void setActuatorWeights(RigParts& parts, std::size_t index, std::span<const float> weights) {
    Actuator& actuator = parts.actuators.at(index);
    const std::string subject = "weights of actuator " + inQuotes(actuator.name);
    if (weights.size() != parts.restMesh.positions.size())
        throw InvalidInput(subject, "there is not one a vertex", "give every vertex of the rest mesh a weight");
    for (const float weight : weights)
        if (!(weight >= 0.0F && weight <= 1.0F))
            throw InvalidInput(subject, "one is not within 0 and 1", "use weights from 0 to 1");
    if (const auto* joint = std::get_if<SkinJoint>(&actuator.deformer)) {
        const std::vector<float> before = actuatorWeights(parts, index);
        for (std::size_t v = 0; v < weights.size(); ++v)
            if (weights[v] != before[v]) setJointWeight(*parts.skeleton, v, joint->joint, rounded(weights[v]));
        return;
    }
    if (std::holds_alternative<MorphTarget>(actuator.deformer)) return setMorphWeights(actuator, weights);
    if (std::holds_alternative<SheetLift>(actuator.deformer))
        throw InvalidInput(subject, "what follows a lever is computed from the sheet's mechanics",
                           "choose an actuator of another kind");
    actuator.influences.clear();
    for (std::size_t v = 0; v < weights.size(); ++v)
        if (const float weight = rounded(weights[v]); weight > 0.0F && !followsSheet(parts, v))
            actuator.influences.push_back({static_cast<std::uint32_t>(v), weight});
}

std::vector<float> weightsByDistance(std::span<const float> metres, const WeightFalloff& falloff) {
    const auto good = [](double length) { return std::isfinite(length) && length >= 0.0; };
    if (!good(falloff.full) || !good(falloff.range))
        throw InvalidInput("falloff", "a length is negative or not finite", "give lengths of 0 or more");
    std::vector<float> weights;
    weights.reserve(metres.size());
    for (const float far : metres) {
        const double beyond = static_cast<double>(far) - falloff.full;
        const double t = beyond <= 0.0 ? 0.0 : beyond < falloff.range ? beyond / falloff.range : 1.0;
        weights.push_back(static_cast<float>(1.0 - t * t * (3.0 - 2.0 * t)));
    }
    return weights;
}

std::vector<float> weightsAround(const TriangleMesh& mesh, const glm::vec3& place, const WeightFalloff& falloff,
                                 const Progress& progress) {
    const auto places = placesOnBothSides(mesh, std::span(&place, 1), kSheetThickness);
    return weightsByDistance(surfaceDistances(mesh, places, progress).metres, falloff);
}

std::vector<float> weightsBeside(const TriangleMesh& mesh, const std::array<glm::vec3, 2>& ends, const glm::vec3& side,
                                 const WeightFalloff& falloff, const Progress& progress) {
    constexpr int kPlaces = 64;
    std::vector<glm::vec3> line;
    for (int i = 0; i <= kPlaces; ++i)
        line.push_back(ends[0] + static_cast<float>(i) / static_cast<float>(kPlaces) * (ends[1] - ends[0]));
    const auto places = placesOnBothSides(mesh, line, kSheetThickness);
    auto weights = weightsByDistance(surfaceDistances(mesh, places, progress).metres, falloff);
    constexpr float kOnLine = 1e-5F; // metres
    for (std::size_t v = 0; v < weights.size(); ++v)
        if (glm::dot(mesh.positions[v] - ends[0], side) < -kOnLine) weights[v] = 0.0F;
    return weights;
}

WeightStroke::WeightStroke(const RigParts& parts, std::size_t actuator)
    : mesh_(parts.restMesh), normals_(mesh_.positions.size(), glm::vec3(0.0F)),
      weights_(actuatorWeights(parts, actuator)), follows_(canFollow(parts, actuator)) {
    const auto& at = mesh_.positions;
    for (const glm::uvec3& t : mesh_.triangles) {
        const glm::vec3 across = glm::cross(at[t.y] - at[t.x], at[t.z] - at[t.x]);
        for (int k = 0; k < 3; ++k) normals_[t[k]] += across;
    }
}

void WeightStroke::moveTo(const glm::vec3& place, const glm::vec3& normal, const WeightBrush& brush) {
    if (!std::exchange(begun_, true)) {
        last_ = place;
        return dab(place, normal, brush);
    }
    const double far = glm::distance(glm::dvec3(place), glm::dvec3(last_));
    const double gap = std::max({brush.radius / kDabsInRadius, far / kMostDabs, 1e-6});
    const int dabs = static_cast<int>(far / gap + 1e-3);
    if (dabs == 0) return; // the next move is farther
    const glm::vec3 from = last_;
    const glm::vec3 step = static_cast<float>(gap / far) * (place - from);
    for (int i = 1; i <= dabs; ++i) dab(last_ = from + static_cast<float>(i) * step, normal, brush);
}

void WeightStroke::dab(const glm::vec3& place, const glm::vec3& normal, const WeightBrush& brush) {
    if (brush.tool == WeightBrush::Tool::smooth && places_.empty()) findNeighbours();
    const auto radius = static_cast<float>(brush.radius);
    changed_.clear();
    for (std::uint32_t v = 0; v < weights_.size(); ++v) {
        const glm::vec3 from = mesh_.positions[v] - place;
        const float far2 = glm::dot(from, from) / (radius * radius);
        if (!(far2 < 1.0F) || !follows_[v]) continue;
        if (glm::dot(normals_[v], normal) < 0.0F && -glm::dot(from, normal) > static_cast<float>(kSheetThickness))
            continue;
        const float share = static_cast<float>(brush.strength) * (1.0F - far2) * (1.0F - far2);
        const float now = weights_[v];
        const float then = brush.tool == WeightBrush::Tool::paint   ? now + share
                           : brush.tool == WeightBrush::Tool::erase ? now - share
                                                                    : now + share * (meanAround(v) - now);
        changed_.emplace_back(v, std::clamp(then, 0.0F, 1.0F));
    }
    for (const auto& [vertex, weight] : changed_) weights_[vertex] = weight; // all at once: the mean is of before
}

/// Those on the other sides of the triangles around each place, each as often as it stands in one.
void WeightStroke::findNeighbours() {
    places_ = placesOf(mesh_.positions);
    start_.assign(mesh_.positions.size() + 1, 0);
    for (const glm::uvec3& t : mesh_.triangles)
        for (int k = 0; k < 3; ++k) start_[places_[t[k]] + 1] += 2;
    for (std::size_t p = 0; p + 1 < start_.size(); ++p) start_[p + 1] += start_[p];
    neighbours_.resize(start_.back());
    std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
    for (const glm::uvec3& t : mesh_.triangles)
        for (int k = 0; k < 3; ++k) {
            neighbours_[next[places_[t[k]]]++] = t[(k + 1) % 3];
            neighbours_[next[places_[t[k]]]++] = t[(k + 2) % 3];
        }
}

float WeightStroke::meanAround(std::uint32_t vertex) const {
    const std::uint32_t place = places_[vertex];
    if (start_[place] == start_[place + 1]) return weights_[vertex];
    double sum = 0.0;
    for (std::uint32_t k = start_[place]; k < start_[place + 1]; ++k) sum += weights_[neighbours_[k]];
    return static_cast<float>(sum / (start_[place + 1] - start_[place]));
}

} // namespace lumorph
