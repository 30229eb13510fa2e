#include <algorithm>
#include <map>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/base/error.h"
#include "core/geometry/model.h"
#include "core/rig/rig_extras.h"
#include "core/rig/rig_file.h"

namespace lumorph {
namespace {

using nlohmann::json;

/// A name of its own for the morph target of every key, so that a viewer shows each.
std::string keyName(const Actuator& actuator, std::size_t key, std::size_t keys,
                    const std::vector<std::string>& taken) {
    std::string name = keys == 1 ? actuator.name : actuator.name + " " + std::to_string(key + 1);
    while (std::ranges::find(taken, name) != taken.end()) name += '\'';
    return name;
}

/// Added to a place it makes -0 to 0, as which a transform would give it back.
constexpr glm::vec3 kZero{0.0F};
constexpr float kLeastArrow = 0.01F; ///< metres

/// True when reading back the displacements alone finds the same influences.
bool influencesFollow(const Actuator& actuator, const MorphTarget& morph) {
    for (std::size_t i = 0; i < actuator.influences.size(); ++i) {
        bool moves = false;
        for (const auto& displacements : morph.displacements) moves = moves || displacements[i] != glm::vec3(0.0F);
        if (!moves || actuator.influences[i].weight != 1.0F) return false;
    }
    return !actuator.influences.empty();
}

class Writer {
public:
    explicit Writer(const Rig& rig) : rig_(rig) {}

    std::vector<std::byte> write() {
        model_.name = rig_.name();
        model_.extras["lumorph"] = {{"pathInside", rig_.pathInside()}, {"uniqueVertices", true}};
        if (const std::string& drawing = rig_.parts().drawing; !drawing.empty())
            model_.extras["lumorph"]["drawing"] = drawing;
        model_.meshes.emplace_back();
        model_.meshes.front().name = rig_.name();
        model_.meshes.front().primitives.emplace_back();
        primitive().positions = rig_.restMesh().positions;
        primitive().triangles = rig_.restMesh().triangles;
        Model::Node meshNode;
        meshNode.name = rig_.name();
        meshNode.mesh = 0;
        addNode(std::move(meshNode));
        if (rig_.skeleton()) addSkeleton(*rig_.skeleton());
        if (rig_.parts().sheet) addSheet(*rig_.parts().sheet);
        for (std::size_t a = 0; a < rig_.actuatorCount(); ++a) addActuator(rig_.actuators()[a], a);
        nameJoints();
        addInfluences();
        return writeGlb(model_);
    }

private:
    Model::Primitive& primitive() { return model_.meshes.front().primitives.front(); }

    int addNode(Model::Node node) {
        const int index = static_cast<int>(model_.nodes.size());
        if (node.parent < 0)
            model_.roots.push_back(index);
        else
            model_.nodes[node.parent].children.push_back(index);
        model_.nodes.push_back(std::move(node));
        return index;
    }

    void addSkeleton(const Skeleton& skeleton) {
        Model::Skin skin;
        skin.name = rig_.name();
        std::vector<glm::dmat4> rest;
        for (const Skeleton::Joint& joint : skeleton.joints) {
            Model::Node node;
            node.name = "joint " + std::to_string(rest.size());
            node.parent = joint.parent < 0 ? -1 : jointNodes_[joint.parent];
            node.matrix = joint.localRest;
            jointNodes_.push_back(addNode(std::move(node)));
            const glm::dmat4 local(joint.localRest);
            rest.push_back(joint.parent < 0 ? local : rest[joint.parent] * local);
            skin.joints.push_back(jointNodes_.back());
            skin.inverseBindMatrices.emplace_back(glm::inverse(rest.back()));
        }
        primitive().joints = skeleton.vertexJoints;
        primitive().weights = skeleton.vertexWeights;
        model_.skins.push_back(std::move(skin));
        model_.nodes.front().skin = 0;
    }

    /// A morph target a mode, so that any viewer shows them. A skirt's vertices have their row's whole modes.
    void addSheet(const SheetMotion& sheet) {
        Model::Mesh& mesh = model_.meshes.front();
        const std::size_t count = sheet.modes.modeCount;
        Model::CustomAttribute rows{1, {}};
        Model::CustomAttribute shares{1, {}};
        std::vector<std::vector<glm::vec3>> targets(count);
        for (const auto& [row, share] : sheet.followers) {
            const bool follows = row != SheetMotion::kNoRow;
            rows.values.push_back(follows ? static_cast<float>(row) : -1.0F);
            shares.values.push_back(share);
            for (std::size_t k = 0; k < count; ++k)
                targets[k].push_back(follows ? sheet.modes.modes[row * count + k] : glm::vec3(0.0F));
        }
        for (std::size_t k = 0; k < count; ++k) {
            primitive().morphTargets.push_back(std::move(targets[k]));
            mesh.targetNames.push_back(sheetModeName(k));
            mesh.weights.push_back(0.0F);
        }
        primitive().custom[kSheetRow] = std::move(rows);
        primitive().custom[kSheetShare] = std::move(shares);
        mesh.extras[kSheetMember] = sheetExtras(sheet.modes);
    }

    void addActuator(const Actuator& actuator, std::size_t order) {
        json extras = actuatorExtras(actuator, order);
        if (const auto* morph = std::get_if<MorphTarget>(&actuator.deformer)) {
            addMorph(actuator, *morph, order, std::move(extras));
            return;
        }
        if (const auto* joint = std::get_if<SkinJoint>(&actuator.deformer)) {
            json& at = model_.nodes[jointNodes_[joint->joint]].extras["lumorph"];
            at.push_back(std::move(extras));
            return;
        }
        if (std::holds_alternative<SheetLift>(actuator.deformer)) {
            model_.meshes.front().extras["lumorph"].push_back(std::move(extras));
            return;
        }
        const Box moved = boxOf(actuator);
        const float arrow = arrowLength(moved);
        Model::Node node;
        node.name = actuator.name;
        node.extras["lumorph"] = std::move(extras);
        if (const auto* hinge = std::get_if<Hinge>(&actuator.deformer)) {
            node.translation = hinge->origin + kZero;
            addArrow(addNode(std::move(node)), "axis", arrow * glm::normalize(hinge->axis));
        } else if (const auto* bend = std::get_if<Bend>(&actuator.deformer)) {
            node.translation = bend->origin + kZero;
            const int at = addNode(std::move(node));
            addArrow(at, "axis", arrow * glm::normalize(bend->axis));
            addArrow(at, "direction", arrow * glm::normalize(bend->direction));
        } else if (const auto* slide = std::get_if<Slide>(&actuator.deformer)) {
            // A slide has no origin: it stands where one sees what it moves.
            if (!moved.empty()) node.translation = moved.centre();
            addArrow(addNode(std::move(node)), "direction", arrow * glm::normalize(slide->direction));
        }
        listInfluences(actuator, order);
    }

    [[nodiscard]] Box boxOf(const Actuator& actuator) const {
        Box box;
        for (const Influence& influence : actuator.influences) box.include(rig_.restMesh().positions[influence.vertex]);
        return box;
    }

    static float arrowLength(const Box& moved) {
        if (moved.empty()) return kLeastArrow;
        const glm::vec3 size = moved.size();
        return std::max(kLeastArrow, 0.5F * std::max({size.x, size.y, size.z}));
    }

    /// A node without a mesh at the tip of an arrow. Modelling tools show it with a line to its parent; a reader of
    /// rigs passes over it.
    void addArrow(int parent, const char* what, const glm::vec3& tip) {
        Model::Node node;
        node.name = model_.nodes[parent].name + " " + what;
        node.parent = parent;
        node.translation = tip;
        addNode(std::move(node));
    }

    /// A joint is found by the name of what moves it.
    void nameJoints() {
        for (const Actuator& actuator : rig_.actuators())
            if (const auto* joint = std::get_if<SkinJoint>(&actuator.deformer))
                model_.nodes[jointNodes_[joint->joint]].name = actuator.name;
    }

    void addMorph(const Actuator& actuator, const MorphTarget& morph, std::size_t order, json extras) {
        Model::Mesh& mesh = model_.meshes.front();
        json names = json::array();
        json keys = json::array();
        for (std::size_t k = 0; k < morph.keys.size(); ++k) {
            std::vector<glm::vec3> deltas(rig_.restMesh().positions.size(), glm::vec3(0.0F));
            for (std::size_t i = 0; i < actuator.influences.size(); ++i)
                deltas[actuator.influences[i].vertex] = morph.displacements[k][i];
            primitive().morphTargets.push_back(std::move(deltas));
            mesh.targetNames.push_back(keyName(actuator, k, morph.keys.size(), mesh.targetNames));
            mesh.weights.push_back(0.0F);
            names.push_back(mesh.targetNames.back());
            keys.push_back(morph.keys[k]);
        }
        extras["target"] = morph.target;
        extras["targets"] = std::move(names);
        extras["keys"] = std::move(keys);
        mesh.extras["lumorph"].push_back(std::move(extras));
        if (!influencesFollow(actuator, morph)) listInfluences(actuator, order);
    }

    void listInfluences(const Actuator& actuator, std::size_t order) {
        for (const Influence& influence : actuator.influences)
            influences_[influence.vertex].push_back({static_cast<float>(order), influence.weight});
    }

    void addInfluences() {
        const std::size_t vertices = rig_.restMesh().positions.size();
        std::size_t sets = 0;
        bool spatial = false;
        for (const auto& [vertex, list] : influences_) sets = std::max(sets, (list.size() + 3) / 4);
        for (const Actuator& actuator : rig_.actuators())
            spatial = spatial || !(std::holds_alternative<MorphTarget>(actuator.deformer) ||
                                   std::holds_alternative<SkinJoint>(actuator.deformer) ||
                                   std::holds_alternative<SheetLift>(actuator.deformer));
        if (spatial) sets = std::max<std::size_t>(sets, 1); // else the reader would take whole nodes
        for (std::size_t set = 0; set < sets; ++set) {
            Model::CustomAttribute actuators{4, std::vector<float>(4 * vertices, -1.0F)};
            Model::CustomAttribute weights{4, std::vector<float>(4 * vertices, 0.0F)};
            for (const auto& [vertex, list] : influences_)
                for (std::size_t k = 4 * set; k < std::min(list.size(), 4 * set + 4); ++k) {
                    actuators.values[4 * vertex + k % 4] = list[k].first;
                    weights.values[4 * vertex + k % 4] = list[k].second;
                }
            primitive().custom["_ACTUATORS_" + std::to_string(set)] = std::move(actuators);
            primitive().custom["_INFLUENCES_" + std::to_string(set)] = std::move(weights);
        }
    }

    const Rig& rig_;
    Model model_;
    std::vector<int> jointNodes_;
    std::map<std::uint32_t, std::vector<std::pair<float, float>>> influences_; ///< by vertex
};

} // namespace

std::vector<std::byte> writeRigGlb(const Rig& rig) { return Writer(rig).write(); }

} // namespace lumorph
