#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <unordered_map>

#include <glm/gtc/matrix_inverse.hpp>
#include <glm/matrix.hpp>
#include <glm/vector_relational.hpp>

#include "core/base/error.h"
#include "core/rig/rig_document.h"

namespace lumorph {
namespace {

/// Everything that must agree before two vertices count as one.
struct Vertex {
    glm::vec3 position{0.0F};
    glm::u16vec4 joints{0};
    glm::vec4 weights{0.0F};
    std::vector<std::pair<std::uint32_t, float>> influences; ///< actuator, weight
    std::vector<glm::vec3> displacements;                    ///< morph actuators' keys, one after the other
    SheetMotion::Follower follower;
    std::vector<glm::vec3> modes; ///< of the sheet; empty where it follows no row

    [[nodiscard]] std::string key(std::size_t node) const {
        std::string bytes;
        const auto add = [&](const void* from, std::size_t size) {
            bytes.append(static_cast<const char*>(from), size);
        };
        const glm::vec3 place = position + glm::vec3(0.0F); // -0 and 0 are the same place
        add(&node, sizeof node);
        add(&place, sizeof place);
        add(&joints, sizeof joints);
        add(&weights, sizeof weights);
        for (const auto& [actuator, weight] : influences) {
            add(&actuator, sizeof actuator);
            add(&weight, sizeof weight);
        }
        for (const glm::vec3& d : displacements) add(&d, sizeof d);
        add(&follower.row, sizeof follower.row);
        add(&follower.share, sizeof follower.share);
        return bytes;
    }
};

bool nearlyIdentity(const glm::mat4& m) {
    for (int column = 0; column < 4; ++column)
        if (glm::any(glm::greaterThan(glm::abs(m[column] - glm::mat4(1.0F)[column]), glm::vec4(2e-6F)))) return false;
    return true;
}

glm::vec3 transformed(const glm::mat4& m, const glm::vec3& p) { return glm::vec3(m * glm::vec4(p, 1.0F)); }

class Gatherer {
public:
    Gatherer(const Model& model, const std::string& file, std::vector<ActuatorEntry> entries, const JointTable& table)
        : model_(model), file_(file), entries_(std::move(entries)), table_(table), world_(nodeTransforms(model)) {
        const auto extras = model.extras.is_object() ? model.extras.find("lumorph") : model.extras.end();
        if (model.extras.is_object() && extras != model.extras.end() && extras->is_object()) {
            parts_.pathInside = extras->value("pathInside", nlohmann::json(false)) == true;
            unique_ = extras->value("uniqueVertices", nlohmann::json(false)) == true;
            if (const auto drawing = extras->find("drawing"); drawing != extras->end() && drawing->is_string())
                parts_.drawing = drawing->get<std::string>();
        }
        for (const Model::Mesh& mesh : model.meshes)
            for (const Model::Primitive& primitive : mesh.primitives)
                listed_ = listed_ || primitive.custom.contains("_ACTUATORS_0");
        for (const Model::Mesh& mesh : model.meshes) {
            if (!holdsSheet(mesh)) continue;
            const EntryPlace place{file, "mesh \"" + mesh.name + "\""};
            if (parts_.sheet) place.fail("it is the second mesh with a sheet", "keep one of them");
            parts_.sheet.emplace().modes = readSheetExtras(mesh.extras[kSheetMember], place);
        }
    }

    RigParts gather() {
        parts_.name = model_.name;
        if (!table_.empty()) parts_.skeleton.emplace().joints = table_.joints;
        for (std::size_t e = 0; e < entries_.size(); ++e) {
            parts_.actuators.push_back(entries_[e].actuator);
            if (auto* morph = std::get_if<MorphTarget>(&parts_.actuators.back().deformer))
                morph->displacements.resize(morph->keys.size());
        }
        for (const int root : model_.roots) visit(root);
        if (parts_.sheet) collectModes();
        return std::move(parts_);
    }

private:
    void collectModes() {
        std::uint32_t next = 0;
        for (const auto& [row, modes] : rowModes_) {
            if (row != next++)
                EntryPlace{file_, "sheet"}.fail("no vertex follows row " + std::to_string(next - 1),
                                                "number the rows from 0 without a gap");
            parts_.sheet->modes.modes.insert(parts_.sheet->modes.modes.end(), modes.begin(), modes.end());
        }
    }

    static bool holdsSheet(const Model::Mesh& mesh) {
        return mesh.extras.is_object() && mesh.extras.contains(kSheetMember);
    }

    void visit(int start) {
        std::vector<int> stack{start};
        while (!stack.empty()) {
            const int node = stack.back();
            stack.pop_back();
            if (model_.nodes[node].mesh >= 0) addMesh(node);
            const auto& children = model_.nodes[node].children;
            stack.insert(stack.end(), children.rbegin(), children.rend());
        }
    }

    [[nodiscard]] bool below(int node, int ancestor) const {
        for (; node >= 0; node = model_.nodes[node].parent)
            if (node == ancestor) return true;
        return false;
    }

    void addMesh(int node) {
        const Model::Mesh& mesh = model_.meshes[model_.nodes[node].mesh];
        std::vector<std::uint32_t> whole; // actuators that move all of this node
        for (std::size_t e = 0; e < entries_.size(); ++e) {
            const auto& deformer = entries_[e].actuator.deformer;
            if (std::holds_alternative<MorphTarget>(deformer) || std::holds_alternative<SkinJoint>(deformer) ||
                std::holds_alternative<SheetLift>(deformer))
                continue;
            if (!listed_ && below(node, entries_[e].node)) whole.push_back(static_cast<std::uint32_t>(e));
        }
        std::unordered_map<std::string, std::uint32_t> known;
        for (const Model::Primitive& primitive : mesh.primitives) addPrimitive(node, mesh, primitive, whole, known);
    }

    void addPrimitive(int node, const Model::Mesh& mesh, const Model::Primitive& primitive,
                      const std::vector<std::uint32_t>& whole, std::unordered_map<std::string, std::uint32_t>& known) {
        const EntryPlace place{file_, "mesh \"" + mesh.name + "\""};
        std::vector<std::uint32_t> index;
        for (std::size_t v = 0; v < primitive.positions.size(); ++v) {
            Vertex vertex;
            vertex.position = primitive.positions[v];
            addListed(primitive, v, vertex, place);
            for (const std::uint32_t actuator : whole) vertex.influences.push_back({actuator, 1.0F});
            const glm::mat4 deviceFromMesh = skin(node, primitive, v, vertex);
            addMorphs(node, mesh, primitive, v, deviceFromMesh, vertex);
            if (holdsSheet(mesh)) addSheet(mesh, primitive, v, deviceFromMesh, vertex, place);
            if (deviceFromMesh != glm::mat4(1.0F)) vertex.position = transformed(deviceFromMesh, vertex.position);
            const auto next = static_cast<std::uint32_t>(parts_.restMesh.positions.size());
            const std::uint32_t at =
                unique_ ? next : known.try_emplace(vertex.key(static_cast<std::size_t>(node)), next).first->second;
            if (at == next) append(vertex, next);
            index.push_back(at);
        }
        const bool mirrored = isMirrored(node, primitive);
        for (const glm::uvec3& t : primitive.triangles) {
            glm::uvec3 triangle(index[t.x], index[t.y], index[t.z]);
            if (mirrored) std::swap(triangle.y, triangle.z);
            const bool collapsed = triangle.x == triangle.y || triangle.y == triangle.z || triangle.z == triangle.x;
            if (!collapsed || unique_) parts_.restMesh.triangles.push_back(triangle);
        }
    }

    /// Whether the mesh is placed inside out: a skinned one where most of its joints do so, whatever its node.
    [[nodiscard]] bool isMirrored(int node, const Model::Primitive& primitive) const {
        const int skin = model_.nodes[node].skin;
        if (table_.empty() || skin < 0 || primitive.joints.empty())
            return glm::determinant(glm::mat3(world_[node])) < 0.0F;
        const Model::Skin& of = model_.skins[skin];
        std::size_t turned = 0;
        for (std::size_t k = 0; k < of.joints.size(); ++k)
            if (glm::determinant(
                    glm::mat3(table_.placed[table_.jointOfNode[of.joints[k]]] * of.inverseBindMatrices[k])) < 0.0F)
                ++turned;
        return 2 * turned > of.joints.size();
    }

    void addListed(const Model::Primitive& primitive, std::size_t v, Vertex& vertex, const EntryPlace& place) const {
        for (int set = 0;; ++set) {
            const auto actuators = primitive.custom.find("_ACTUATORS_" + std::to_string(set));
            if (actuators == primitive.custom.end()) break;
            const auto weights = primitive.custom.find("_INFLUENCES_" + std::to_string(set));
            const int width = actuators->second.components;
            if (weights == primitive.custom.end() || weights->second.components != width)
                place.fail("\"_ACTUATORS_" + std::to_string(set) + "\" has no \"_INFLUENCES_" + std::to_string(set) +
                               "\" of its shape",
                           "give every listed actuator its weight");
            for (int k = 0; k < width; ++k) {
                const float actuator = actuators->second.values[v * width + k];
                const float weight = weights->second.values[v * width + k];
                if (actuator == -1.0F) continue;
                if (!(actuator >= 0.0F && actuator < static_cast<float>(entries_.size())) ||
                    actuator != std::floor(actuator))
                    place.fail("vertex " + std::to_string(v) + " names an actuator that does not exist",
                               "use 0 to " + std::to_string(entries_.size() - 1) + ", or -1 for none");
                if (!(weight >= 0.0F && weight <= 1.0F))
                    place.fail("vertex " + std::to_string(v) + " follows an actuator with a weight outside 0 to 1",
                               "use weights from 0 to 1");
                vertex.influences.push_back({static_cast<std::uint32_t>(actuator), weight});
            }
        }
        std::ranges::sort(vertex.influences);
        const auto same = [](const auto& a, const auto& b) { return a.first == b.first; };
        if (std::ranges::adjacent_find(vertex.influences, same) != vertex.influences.end())
            place.fail("vertex " + std::to_string(v) + " names an actuator twice", "name each actuator once a vertex");
    }

    /// Sets the vertex' joints and returns where the mesh is placed for it.
    glm::mat4 skin(int node, const Model::Primitive& primitive, std::size_t v, Vertex& vertex) const {
        const int skinIndex = model_.nodes[node].skin;
        if (table_.empty()) return world_[node];
        if (skinIndex < 0 || primitive.joints.empty()) {
            const int joint = table_.above(model_, node);
            vertex.joints = glm::u16vec4(static_cast<std::uint16_t>(std::max(joint, 0)), 0, 0, 0);
            vertex.weights = glm::vec4(1.0F, 0.0F, 0.0F, 0.0F);
            return world_[node];
        }
        const Model::Skin& skin = model_.skins[skinIndex];
        glm::mat4 blend(0.0F);
        for (int k = 0; k < 4; ++k) {
            const float weight = primitive.weights[v][k];
            if (weight == 0.0F) continue;
            const int joint = table_.jointOfNode[skin.joints[primitive.joints[v][k]]];
            vertex.joints[k] = static_cast<std::uint16_t>(joint);
            vertex.weights[k] = weight;
            blend += weight * (table_.placed[joint] * skin.inverseBindMatrices[primitive.joints[v][k]]);
        }
        // A model drawn in its bind pose must not be moved by the rounding of an inverse.
        return nearlyIdentity(blend) ? glm::mat4(1.0F) : blend;
    }

    void addMorphs(int node, const Model::Mesh& mesh, const Model::Primitive& primitive, std::size_t v,
                   const glm::mat4& deviceFromMesh, Vertex& vertex) const {
        const glm::mat3 linear(deviceFromMesh);
        const auto placed = [&](const glm::vec3& d) { return linear == glm::mat3(1.0F) ? d : linear * d; };
        std::vector<bool> driven(primitive.morphTargets.size(), false);
        for (std::size_t e = 0; e < entries_.size(); ++e) {
            const ActuatorEntry& entry = entries_[e];
            if (!std::holds_alternative<MorphTarget>(entry.actuator.deformer)) continue;
            const auto range = static_cast<float>(entry.weightMax - entry.weightMin);
            bool moves = false;
            for (const std::string& name : entry.targets) {
                const int target = entry.node == node ? targetNamed(mesh, name) : -1;
                const glm::vec3 delta = target < 0 ? glm::vec3(0.0F) : primitive.morphTargets[target][v];
                if (target >= 0) driven[target] = true;
                vertex.displacements.push_back(range == 1.0F ? placed(delta) : placed(range * delta));
                if (entry.weightMin != 0.0) vertex.position += static_cast<float>(entry.weightMin) * delta;
                moves = moves || delta != glm::vec3(0.0F);
            }
            const auto number = static_cast<std::uint32_t>(e);
            const bool stated = std::ranges::any_of(vertex.influences, [&](auto& i) { return i.first == number; });
            if (moves && !stated) vertex.influences.push_back({number, 1.0F});
        }
        if (holdsSheet(mesh))
            for (std::size_t k = 0; k < parts_.sheet->modes.modeCount; ++k)
                if (const int target = targetNamed(mesh, sheetModeName(k)); target >= 0) driven[target] = true;
        // Targets that no actuator drives stay at the weight the file gives them.
        const auto& weights = model_.nodes[node].weights.empty() ? mesh.weights : model_.nodes[node].weights;
        for (std::size_t t = 0; t < driven.size() && t < weights.size(); ++t)
            if (!driven[t] && weights[t] != 0.0F) vertex.position += weights[t] * primitive.morphTargets[t][v];
    }

    void addSheet(const Model::Mesh& mesh, const Model::Primitive& primitive, std::size_t v,
                  const glm::mat4& deviceFromMesh, Vertex& vertex, const EntryPlace& place) const {
        const float row = sheetValue(primitive, kSheetRow, v, -1.0F, place);
        vertex.follower.share = sheetValue(primitive, kSheetShare, v, 1.0F, place);
        if (row == -1.0F) return;
        if (!(row >= 0.0F && row < static_cast<float>(primitive.positions.size())) || row != std::floor(row))
            place.fail("vertex " + std::to_string(v) + " follows a row of the sheet that does not exist",
                       "use whole numbers from 0, or -1 for none");
        vertex.follower.row = static_cast<std::uint32_t>(row);
        const glm::mat3 linear(deviceFromMesh);
        for (std::size_t k = 0; k < parts_.sheet->modes.modeCount; ++k) {
            const int target = targetNamed(mesh, sheetModeName(k));
            if (target < 0)
                place.fail("the sheet has no morph target \"" + sheetModeName(k) + "\"", "keep its shape keys");
            const glm::vec3 mode = primitive.morphTargets[target][v];
            vertex.modes.push_back(linear == glm::mat3(1.0F) ? mode : linear * mode);
        }
        const auto known = rowModes_.find(vertex.follower.row);
        if (known != rowModes_.end() && known->second != vertex.modes)
            place.fail("vertices of row " + std::to_string(vertex.follower.row) + " of the sheet differ in their modes",
                       "give the vertices of a row the same place in every shape key of the sheet");
    }

    static float sheetValue(const Model::Primitive& primitive, const char* name, std::size_t v, float otherwise,
                            const EntryPlace& place) {
        const auto found = primitive.custom.find(name);
        if (found == primitive.custom.end()) return otherwise;
        if (found->second.components != 1)
            place.fail(std::string("\"") + name + "\" is not one number a vertex", "export it as a float");
        return found->second.values[v];
    }

    static int targetNamed(const Model::Mesh& mesh, const std::string& name) {
        const auto found = std::ranges::find(mesh.targetNames, name);
        return found == mesh.targetNames.end() ? -1 : static_cast<int>(found - mesh.targetNames.begin());
    }

    void append(const Vertex& vertex, std::uint32_t number) {
        parts_.restMesh.positions.push_back(vertex.position);
        if (parts_.sheet) parts_.sheet->followers.push_back(vertex.follower);
        if (!vertex.modes.empty()) rowModes_.try_emplace(vertex.follower.row, vertex.modes);
        if (parts_.skeleton) {
            parts_.skeleton->vertexJoints.push_back(vertex.joints);
            parts_.skeleton->vertexWeights.push_back(vertex.weights);
        }
        for (const auto& [a, weight] : vertex.influences) {
            Actuator& actuator = parts_.actuators[a];
            actuator.influences.push_back({number, weight});
            auto* morph = std::get_if<MorphTarget>(&actuator.deformer);
            if (morph == nullptr) continue;
            std::size_t first = 0;
            for (std::uint32_t e = 0; e < a; ++e) first += entries_[e].targets.size();
            for (std::size_t k = 0; k < morph->keys.size(); ++k)
                morph->displacements[k].push_back(vertex.displacements[first + k]);
        }
    }

    const Model& model_;
    const std::string& file_;
    std::vector<ActuatorEntry> entries_;
    const JointTable& table_;
    std::vector<glm::mat4> world_;
    bool listed_ = false; ///< the file lists influences a vertex
    bool unique_ = false; ///< the file says that its vertices are to stay as they are
    std::map<std::uint32_t, std::vector<glm::vec3>> rowModes_; ///< of the sheet
    RigParts parts_;
};

} // namespace

RigParts gatherParts(const Model& model, const std::string& file, std::vector<ActuatorEntry> entries,
                     const JointTable& table) {
    return Gatherer(model, file, std::move(entries), table).gather();
}

} // namespace lumorph
