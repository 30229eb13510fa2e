#include "core/geometry/gltf_parts.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/type_ptr.hpp>

#include "core/geometry/mesh_file.h"

namespace lumorph::gltf {

using nlohmann::json;

namespace {

std::string nodePlace(std::size_t node) { return "node " + std::to_string(node); }

/// Parent of every node, -1 for none. Refuses children that do not exist or have two parents.
std::vector<int> parentsOf(const Source& source) {
    const auto& nodes = source.structure.nodes;
    std::vector<int> parents(nodes.size(), -1);
    for (std::size_t i = 0; i < nodes.size(); ++i)
        for (const int child : nodes[i].children) {
            int& parent = parents[static_cast<std::size_t>(source.checked(child, nodes.size(), nodePlace(i), "child"))];
            if (parent >= 0) source.refuse("node " + std::to_string(child) + ": is the child of two nodes");
            parent = static_cast<int>(i);
        }
    return parents;
}

/// Nodes in an order with every parent before its children; unchanged where the file has one already.
std::vector<std::size_t> parentsFirst(const Source& source, const std::vector<int>& parents) {
    std::vector<std::size_t> order;
    std::vector<bool> placed(parents.size(), false);
    std::vector<std::size_t> chain;
    for (std::size_t i = 0; i < parents.size(); ++i) {
        chain.clear();
        for (int at = static_cast<int>(i); at >= 0 && !placed[static_cast<std::size_t>(at)];
             at = parents[static_cast<std::size_t>(at)]) {
            chain.push_back(static_cast<std::size_t>(at));
            if (chain.size() > parents.size()) source.refuse(nodePlace(i) + ": is its own ancestor");
        }
        for (auto node = chain.rbegin(); node != chain.rend(); ++node) {
            order.push_back(*node);
            placed[*node] = true;
        }
    }
    return order;
}

class SceneReader {
public:
    SceneReader(const Source& source, Model& model)
        : source_(source), structure_(source.structure), model_(model), parents_(parentsOf(source)),
          order_(parentsFirst(source, parents_)), place_(order_.size()) {
        for (std::size_t i = 0; i < order_.size(); ++i) place_[order_[i]] = static_cast<int>(i);
    }

    void read() {
        for (std::size_t i = 0; i < structure_.skins.size(); ++i) model_.skins.push_back(skin(i));
        findHidden();
        for (const std::size_t index : order_) model_.nodes.push_back(node(index));
        readRoots();
        for (std::size_t i = 0; i < structure_.animations.size(); ++i) model_.animations.push_back(animation(i));
        warnOfChannels();
        for (const std::size_t index : order_) makeCopies(index);
        checkInstances();
    }

private:
    int moved(int node, const std::string& place) const {
        const int checked = source_.checked(node, place_.size(), place, "node");
        return checked < 0 ? -1 : place_[static_cast<std::size_t>(checked)];
    }

    std::vector<float> numbers(const std::vector<double>& values, std::size_t count, const std::string& place) const {
        if (values.size() != count)
            source_.refuse(place + ": has " + std::to_string(values.size()) + " numbers, not " + std::to_string(count));
        return source_.numbers(values, place);
    }

    glm::quat rotation(const std::vector<double>& values, const std::string& place) const {
        const std::vector<float> q = numbers(values, 4, place + " rotation");
        const double length = std::hypot(std::hypot(static_cast<double>(q[0]), static_cast<double>(q[1])),
                                         std::hypot(static_cast<double>(q[2]), static_cast<double>(q[3])));
        if (length < 1e-6) source_.refuse(place + " rotation: is zero");
        // A unit quaternion stays as it is, so that writing and reading give the same model.
        const auto scale = std::abs(length - 1.0) > 1e-4 ? 1.0 / length : 1.0;
        const auto part = [&](std::size_t i) { return static_cast<float>(static_cast<double>(q[i]) * scale); };
        return {part(3), part(0), part(1), part(2)};
    }

    /// With what hangs from them.
    void findHidden() {
        hidden_.assign(order_.size(), false);
        std::size_t meshes = 0;
        for (const std::size_t index : order_) {
            const int parent = parents_[index];
            hidden_[index] = isHidden(source_, index) || (parent >= 0 && hidden_[static_cast<std::size_t>(parent)]);
            if (hidden_[index] && structure_.nodes[index].mesh >= 0) ++meshes;
        }
        if (meshes > 0)
            source_.warnings.push_back(meshes == 1 ? "1 mesh is hidden in the file and left out (KHR_node_visibility)."
                                                   : std::to_string(meshes) + " meshes are hidden in the file and left "
                                                                              "out (KHR_node_visibility).");
    }

    /// A node of its own for each copy of a mesh that is drawn many times.
    void makeCopies(std::size_t index) {
        std::vector<Model::Node> copies = instancesOf(source_, index);
        const auto at = static_cast<std::size_t>(place_[index]);
        if (copies.empty() || model_.nodes[at].mesh < 0) return;
        if (copies.size() > kMaxElements - std::min(kMaxElements, model_.nodes.size()))
            source_.refuse(nodePlace(index) + ": shows its mesh " + std::to_string(copies.size()) + " times",
                           "show fewer copies");
        if (model_.nodes[at].skin >= 0 || movesWeights(place_[index])) {
            source_.warnings.push_back("The copies of " + nodePlace(index) +
                                       " change their shape; only one of them is read (EXT_mesh_gpu_instancing).");
            copies.resize(1);
        }
        const Model::Node& shown = model_.nodes[at];
        source_.accessors.budget().charge(
            copies.size(), sizeof(Model::Node) + shown.name.size() + shown.weights.size() * sizeof(shown.weights[0]),
            nodePlace(index));
        const int first = static_cast<int>(model_.nodes.size());
        for (Model::Node& copy : copies) {
            copy.name = model_.nodes[at].name;
            copy.parent = place_[index];
            copy.mesh = model_.nodes[at].mesh;
            copy.skin = model_.nodes[at].skin;
            copy.weights = model_.nodes[at].weights;
            model_.nodes[at].children.push_back(static_cast<int>(model_.nodes.size()));
            model_.nodes.push_back(std::move(copy));
        }
        model_.nodes[at].mesh = model_.nodes[at].skin = -1;
        model_.nodes[at].weights.clear();
        for (Model::Animation& animation : model_.animations)
            for (Model::Channel& channel : animation.channels)
                if (channel.node == place_[index] && channel.path == Model::Path::weights) channel.node = first;
    }

    bool movesWeights(int node) const {
        return std::ranges::any_of(model_.animations, [node](const Model::Animation& animation) {
            return std::ranges::any_of(animation.channels, [node](const Model::Channel& channel) {
                return channel.node == node && channel.path == Model::Path::weights;
            });
        });
    }

    Model::Node node(std::size_t index) const {
        const tinygltf::Node& from = structure_.nodes[index];
        const std::string place = nodePlace(index);
        Model::Node node;
        node.name = from.name;
        node.parent = parents_[index] < 0 ? -1 : place_[static_cast<std::size_t>(parents_[index])];
        for (const int child : from.children) node.children.push_back(moved(child, place));
        if (!from.matrix.empty()) node.matrix = glm::make_mat4(numbers(from.matrix, 16, place + " matrix").data());
        if (!from.translation.empty())
            node.translation = glm::make_vec3(numbers(from.translation, 3, place + " translation").data());
        if (!from.scale.empty()) node.scale = glm::make_vec3(numbers(from.scale, 3, place + " scale").data());
        if (!from.rotation.empty()) node.rotation = rotation(from.rotation, place);
        node.mesh = source_.checked(from.mesh, model_.meshes.size(), place, "mesh");
        node.skin = source_.checked(from.skin, model_.skins.size(), place, "skin");
        if (hidden_[index]) node.mesh = node.skin = -1;
        if (node.mesh >= 0 && !mesh(node).primitives.empty()) {
            if (!from.weights.empty()) node.weights = numbers(from.weights, targets(node), place + " weights");
            if (node.skin >= 0) checkJoints(node, place);
        }
        node.extras = source_.extras("nodes", index);
        return node;
    }

    const Model::Mesh& mesh(const Model::Node& node) const {
        return model_.meshes[static_cast<std::size_t>(node.mesh)];
    }

    std::size_t targets(const Model::Node& node) const {
        if (node.mesh < 0 || mesh(node).primitives.empty()) return 0;
        return mesh(node).primitives.front().morphTargets.size();
    }

    void checkJoints(const Model::Node& node, const std::string& place) const {
        const std::size_t joints = model_.skins[static_cast<std::size_t>(node.skin)].joints.size();
        const auto beyond = [&](const glm::u16vec4& j) { return std::max({j.x, j.y, j.z, j.w}) >= joints; };
        for (const Model::Primitive& primitive : mesh(node).primitives)
            if (std::any_of(primitive.joints.begin(), primitive.joints.end(), beyond))
                source_.refuse(place + ": its mesh names a joint beyond the " + std::to_string(joints) + " of skin " +
                               std::to_string(node.skin));
    }

    void readRoots() {
        if (structure_.nodes.empty()) source_.refuse("its scene is empty", "export a scene with at least one object");
        if (structure_.scenes.empty()) {
            for (std::size_t i = 0; i < model_.nodes.size(); ++i)
                if (model_.nodes[i].parent < 0) model_.roots.push_back(static_cast<int>(i));
            return;
        }
        const int index =
            source_.checked(std::max(structure_.defaultScene, 0), structure_.scenes.size(), "default scene", "scene");
        const std::string place = "scene " + std::to_string(index);
        const tinygltf::Scene& scene = structure_.scenes[static_cast<std::size_t>(index)];
        model_.name = scene.name;
        std::vector<bool> listed(model_.nodes.size(), false);
        for (const int root : scene.nodes) {
            const int node = moved(root, place);
            if (node < 0 || model_.nodes[static_cast<std::size_t>(node)].parent >= 0 ||
                listed[static_cast<std::size_t>(node)])
                source_.refuse(place + ": node " + std::to_string(root) + " is not a root, or listed twice");
            listed[static_cast<std::size_t>(node)] = true;
            model_.roots.push_back(node);
        }
        if (model_.roots.empty()) source_.refuse("its scene is empty", "export a scene with at least one object");
    }

    Model::Skin skin(std::size_t index) const {
        const tinygltf::Skin& from = structure_.skins[index];
        const std::string place = "skin " + std::to_string(index);
        Model::Skin skin;
        skin.name = from.name;
        for (const int joint : from.joints) skin.joints.push_back(moved(joint, place));
        if (skin.joints.empty()) source_.refuse(place + ": has no joints");
        if (from.inverseBindMatrices >= 0)
            skin.inverseBindMatrices = source_.accessors.vectors<glm::mat4>(from.inverseBindMatrices, place);
        else
            skin.inverseBindMatrices.assign(skin.joints.size(), glm::mat4(1.0F));
        if (skin.inverseBindMatrices.size() < skin.joints.size())
            source_.refuse(place + ": has fewer matrices than joints");
        skin.inverseBindMatrices.resize(skin.joints.size());
        return skin;
    }

    Model::Animation animation(std::size_t index) {
        const tinygltf::Animation& from = structure_.animations[index];
        Model::Animation animation;
        animation.name = from.name;
        std::size_t aimedAtNodes = 0;
        for (std::size_t i = 0; i < from.channels.size(); ++i) {
            const std::string place = "animation " + std::to_string(index) + " channel " + std::to_string(i);
            const tinygltf::AnimationChannel& target = from.channels[i];
            // A channel without a node moves something that an extension brought in.
            if (target.target_node < 0) continue;
            // The weights of a mesh that is hidden move nothing.
            const int aimed = source_.checked(target.target_node, place_.size(), place, "node");
            ++aimedAtNodes;
            if (target.target_path == "weights" && hidden_[static_cast<std::size_t>(aimed)]) continue;
            animation.channels.push_back(channel(from, target, place));
        }
        // Those that could not be read at all are missing among the others.
        const json& all = source_.document["animations"][index];
        const auto channels = all.find("channels");
        if (channels != all.end() && channels->size() > aimedAtNodes) passedOver_ += channels->size() - aimedAtNodes;
        return animation;
    }

    void warnOfChannels() const {
        if (passedOver_ > 0)
            source_.warnings.push_back(
                std::to_string(passedOver_) +
                (passedOver_ == 1 ? " channel of its animations moves" : " channels of its animations move") +
                " something else than a node and " + (passedOver_ == 1 ? "is" : "are") + " passed over.");
    }

    Model::Channel channel(const tinygltf::Animation& animation, const tinygltf::AnimationChannel& from,
                           const std::string& place) const {
        const int index = source_.checked(from.sampler, animation.samplers.size(), place, "sampler");
        if (index < 0) source_.refuse(place + ": has no sampler");
        const tinygltf::AnimationSampler& sampler = animation.samplers[static_cast<std::size_t>(index)];
        Model::Channel channel;
        channel.node = moved(from.target_node, place);
        channel.path = path(from.target_path, place);
        channel.interpolation = interpolation(sampler.interpolation, place);
        const Model::Node& node = model_.nodes[static_cast<std::size_t>(channel.node)];
        const bool weights = channel.path == Model::Path::weights;
        if (!weights && node.matrix) source_.refuse(place + ": moves a node that has a matrix");
        channel.times = source_.accessors.floats(sampler.input, 1, place + " input");
        if (!std::is_sorted(channel.times.begin(), channel.times.end()))
            source_.refuse(place + " input: its times are not ascending");
        const int components = weights ? 1 : channel.path == Model::Path::rotation ? 4 : 3;
        channel.values = source_.accessors.floats(sampler.output, components, place + " output");
        const std::size_t each = (weights ? targets(node) : static_cast<std::size_t>(components)) *
                                 (channel.interpolation == Model::Interpolation::cubicSpline ? 3 : 1);
        if (channel.values.size() != channel.times.size() * each)
            source_.refuse(place + " output: has " + std::to_string(channel.values.size()) + " numbers for " +
                           std::to_string(channel.times.size()) + " keys of " + std::to_string(each));
        return channel;
    }

    Model::Path path(const std::string& name, const std::string& place) const {
        if (name == "translation") return Model::Path::translation;
        if (name == "rotation") return Model::Path::rotation;
        if (name == "scale") return Model::Path::scale;
        if (name == "weights") return Model::Path::weights;
        source_.refuse(place + ": moves \"" + name.substr(0, 40) + "\", which is not known");
    }

    Model::Interpolation interpolation(const std::string& name, const std::string& place) const {
        if (name == "LINEAR" || name.empty()) return Model::Interpolation::linear;
        if (name == "STEP") return Model::Interpolation::step;
        if (name == "CUBICSPLINE") return Model::Interpolation::cubicSpline;
        source_.refuse(place + ": interpolates by \"" + name.substr(0, 40) + "\", which is not known");
    }

    // Many nodes may show one mesh; the limit holds for what the scene shows.
    void checkInstances() const {
        std::size_t triangles = 0;
        std::size_t vertices = 0;
        for (const Model::Node& node : model_.nodes) {
            if (node.mesh < 0) continue;
            for (const Model::Primitive& primitive : mesh(node).primitives) {
                triangles += primitive.triangles.size();
                vertices += primitive.positions.size();
            }
            if (triangles > kMaxTriangles || vertices > 3 * kMaxTriangles)
                source_.refuse("shows more than " + std::to_string(kMaxTriangles) + " triangles",
                               "reduce the meshes, or the number of nodes that show them");
        }
    }

    const Source& source_;
    const tinygltf::Model& structure_;
    Model& model_;
    std::vector<int> parents_;
    std::vector<std::size_t> order_;
    std::vector<int> place_;     ///< where a node of the file stands in the model
    std::vector<bool> hidden_;   ///< by the file's numbers
    std::size_t passedOver_ = 0; ///< channels of animations
};

} // namespace

void readScene(const Source& source, Model& model) { SceneReader(source, model).read(); }

} // namespace lumorph::gltf
