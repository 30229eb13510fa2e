#include <algorithm>
#include <array>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/matrix.hpp>

#include "core/base/error.h"
#include "core/geometry/model.h"

namespace lumorph {

namespace {

/// The model's moving parts at one time.
struct Pose {
    std::vector<glm::mat4> worldFromNode;
    std::vector<std::vector<float>> weights; ///< morph weights by node, from the animation; empty where it has none
};

struct Local {
    glm::vec3 translation;
    glm::quat rotation;
    glm::vec3 scale;
    std::optional<glm::mat4> matrix;

    [[nodiscard]] glm::mat4 parentFromNode() const {
        if (matrix) return *matrix;
        return glm::scale(glm::translate(glm::mat4(1.0F), translation) * glm::mat4_cast(rotation), scale);
    }
};

std::vector<glm::mat4> chained(const Model& model, const std::vector<Local>& locals) {
    std::vector<glm::mat4> world;
    world.reserve(locals.size());
    for (std::size_t i = 0; i < locals.size(); ++i) {
        const glm::mat4 local = locals[i].parentFromNode();
        const int parent = model.nodes[i].parent;
        world.push_back(parent < 0 ? local : world[static_cast<std::size_t>(parent)] * local);
    }
    return world;
}

std::vector<Local> restLocals(const Model& model) {
    std::vector<Local> locals;
    locals.reserve(model.nodes.size());
    for (const Model::Node& node : model.nodes)
        locals.push_back({node.translation, node.rotation, node.scale, node.matrix});
    return locals;
}

Pose restPose(const Model& model) {
    return {nodeTransforms(model), std::vector<std::vector<float>>(model.nodes.size())};
}

/// Where a time lies between two keys.
struct Span {
    std::size_t key = 0;   ///< the one before
    float fraction = 0.0F; ///< 0 at `key`, towards 1 at the next
    float seconds = 0.0F;  ///< from key to key
};

Span locate(const std::vector<float>& times, double seconds) {
    const auto after = std::upper_bound(times.begin(), times.end(), seconds,
                                        [](double t, float key) { return t < static_cast<double>(key); });
    if (after == times.begin()) return {};
    const auto key = static_cast<std::size_t>(after - times.begin()) - 1;
    if (after == times.end()) return {key, 0.0F, 0.0F};
    const double length = static_cast<double>(*after) - static_cast<double>(times[key]);
    return {key, static_cast<float>((seconds - static_cast<double>(times[key])) / length), static_cast<float>(length)};
}

/// One key's numbers; `part` is 0, 1, 2 for the in-tangent, value and out-tangent of a cubic spline.
std::span<const float> keyValues(const Model::Channel& channel, std::size_t key, std::size_t part, std::size_t width) {
    const bool cubic = channel.interpolation == Model::Interpolation::cubicSpline;
    const std::size_t first = cubic ? (3 * key + part) * width : key * width;
    return std::span(channel.values).subspan(first, width);
}

/// Hermite spline between two keys, glTF 2.0 appendix C.
std::vector<float> cubic(const Model::Channel& channel, const Span& at, std::size_t width) {
    const float t = at.fraction;
    const float t2 = t * t;
    const float t3 = t2 * t;
    const auto value = keyValues(channel, at.key, 1, width);
    const auto out = keyValues(channel, at.key, 2, width);
    const auto in = keyValues(channel, at.key + 1, 0, width);
    const auto next = keyValues(channel, at.key + 1, 1, width);
    std::vector<float> result(width);
    for (std::size_t i = 0; i < width; ++i)
        result[i] = (2.0F * t3 - 3.0F * t2 + 1.0F) * value[i] + at.seconds * (t3 - 2.0F * t2 + t) * out[i] +
                    (3.0F * t2 - 2.0F * t3) * next[i] + at.seconds * (t3 - t2) * in[i];
    return result;
}

glm::quat quaternion(std::span<const float> xyzw) {
    const glm::quat q(xyzw[3], xyzw[0], xyzw[1], xyzw[2]);
    const float length = glm::length(q);
    return length > 0.0F && std::isfinite(length) ? q / length : glm::quat(1.0F, 0.0F, 0.0F, 0.0F);
}

std::vector<float> linear(const Model::Channel& channel, const Span& at, std::size_t width) {
    const auto from = keyValues(channel, at.key, 1, width);
    const auto to = keyValues(channel, at.key + 1, 1, width);
    if (channel.path == Model::Path::rotation) {
        const glm::quat q = glm::slerp(quaternion(from), quaternion(to), at.fraction);
        return {q.x, q.y, q.z, q.w};
    }
    std::vector<float> result(width);
    for (std::size_t i = 0; i < width; ++i) result[i] = from[i] + at.fraction * (to[i] - from[i]);
    return result;
}

std::vector<float> sampled(const Model::Channel& channel, double seconds) {
    const std::size_t perKey = channel.values.size() / channel.times.size();
    const std::size_t width = channel.interpolation == Model::Interpolation::cubicSpline ? perKey / 3 : perKey;
    const Span at = locate(channel.times, seconds);
    if (at.fraction > 0.0F && channel.interpolation == Model::Interpolation::cubicSpline)
        return cubic(channel, at, width);
    if (at.fraction > 0.0F && channel.interpolation == Model::Interpolation::linear) return linear(channel, at, width);
    const auto held = keyValues(channel, at.key, 1, width);
    return {held.begin(), held.end()};
}

Pose posed(const Model& model, const Model::Animation& animation, double seconds) {
    std::vector<Local> locals = restLocals(model);
    Pose pose;
    pose.weights.resize(model.nodes.size());
    for (const Model::Channel& channel : animation.channels) {
        if (channel.node < 0 || channel.times.empty()) continue;
        const auto index = static_cast<std::size_t>(channel.node);
        Local& local = locals[index];
        std::vector<float> value = sampled(channel, seconds);
        switch (channel.path) {
        case Model::Path::translation:
            local.translation = glm::make_vec3(value.data());
            break;
        case Model::Path::rotation:
            local.rotation = quaternion(value);
            break;
        case Model::Path::scale:
            local.scale = glm::make_vec3(value.data());
            break;
        case Model::Path::weights:
            pose.weights[index] = std::move(value);
            break;
        }
        if (channel.path != Model::Path::weights) local.matrix.reset();
    }
    pose.worldFromNode = chained(model, locals);
    return pose;
}

/// worldFromBind for every joint of a skin.
std::vector<glm::mat4> jointMatrices(const Model::Skin& skin, const std::vector<glm::mat4>& worldFromNode) {
    std::vector<glm::mat4> matrices;
    matrices.reserve(skin.joints.size());
    for (std::size_t i = 0; i < skin.joints.size(); ++i)
        matrices.push_back(worldFromNode[static_cast<std::size_t>(skin.joints[i])] * skin.inverseBindMatrices[i]);
    return matrices;
}

bool mirrors(const glm::mat4& matrix) { return glm::determinant(glm::dmat3(matrix)) < 0.0; }

class Flattener {
public:
    Flattener(const Model& model, const Pose& rest, const Pose& pose) : model_(model), rest_(rest), pose_(pose) {}

    TriangleMesh run() {
        const std::vector<bool> shown = nodesShown();
        reserve(shown);
        for (std::size_t i = 0; i < model_.nodes.size(); ++i)
            if (shown[i]) addNode(i);
        const auto finite = [](const glm::vec3& p) {
            return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
        };
        if (!std::all_of(mesh_.positions.begin(), mesh_.positions.end(), finite))
            throw InvalidInput(model_.name.empty() ? "model" : model_.name, "a vertex lies beyond the range of numbers",
                               "look for nodes with a huge scale or translation");
        return std::move(mesh_);
    }

private:
    std::vector<bool> nodesShown() const {
        std::vector<bool> shown(model_.nodes.size(), false);
        for (const int root : model_.roots) shown[static_cast<std::size_t>(root)] = true;
        for (std::size_t i = 0; i < shown.size(); ++i) {
            const int parent = model_.nodes[i].parent;
            if (parent >= 0 && shown[static_cast<std::size_t>(parent)]) shown[i] = true;
        }
        for (std::size_t i = 0; i < shown.size(); ++i) shown[i] = shown[i] && model_.nodes[i].mesh >= 0;
        return shown;
    }

    const Model::Mesh& meshOf(std::size_t node) const {
        return model_.meshes[static_cast<std::size_t>(model_.nodes[node].mesh)];
    }

    void reserve(const std::vector<bool>& shown) {
        std::size_t vertices = 0;
        std::size_t triangles = 0;
        for (std::size_t i = 0; i < shown.size(); ++i) {
            if (!shown[i]) continue;
            for (const Model::Primitive& primitive : meshOf(i).primitives) {
                vertices += primitive.positions.size();
                triangles += primitive.triangles.size();
            }
        }
        mesh_.positions.reserve(vertices);
        mesh_.triangles.reserve(triangles);
    }

    void addNode(std::size_t index) {
        const Model::Node& node = model_.nodes[index];
        const Model::Mesh& mesh = meshOf(index);
        const std::vector<float>& weights = !pose_.weights[index].empty() ? pose_.weights[index]
                                            : !node.weights.empty()       ? node.weights
                                                                          : mesh.weights;
        const Model::Skin* skin = node.skin < 0 ? nullptr : &model_.skins[static_cast<std::size_t>(node.skin)];
        const auto joints = skin ? jointMatrices(*skin, pose_.worldFromNode) : std::vector<glm::mat4>();
        for (const Model::Primitive& primitive : mesh.primitives) {
            const bool skinned = skin && !primitive.joints.empty();
            const std::size_t first = mesh_.positions.size();
            addMorphed(primitive, weights);
            const std::span<glm::vec3> points = std::span(mesh_.positions).subspan(first);
            if (skinned)
                bend(primitive, joints, points);
            else
                place(pose_.worldFromNode[index], points);
            addTriangles(primitive, first, skinned ? mostlyMirrored(*skin) : mirrors(rest_.worldFromNode[index]));
        }
    }

    void addMorphed(const Model::Primitive& primitive, const std::vector<float>& weights) {
        const std::size_t first = mesh_.positions.size();
        mesh_.positions.insert(mesh_.positions.end(), primitive.positions.begin(), primitive.positions.end());
        glm::vec3* points = mesh_.positions.data() + first;
        for (std::size_t t = 0; t < std::min(weights.size(), primitive.morphTargets.size()); ++t) {
            const float weight = weights[t];
            if (weight == 0.0F) continue;
            const std::vector<glm::vec3>& deltas = primitive.morphTargets[t];
            for (std::size_t i = 0; i < deltas.size(); ++i) points[i] += weight * deltas[i];
        }
    }

    static void place(const glm::mat4& worldFromNode, std::span<glm::vec3> points) noexcept {
        const glm::mat4x3 affine(worldFromNode);
        for (glm::vec3& p : points) p = affine * glm::vec4(p, 1.0F);
    }

    static void bend(const Model::Primitive& primitive, const std::vector<glm::mat4>& joints,
                     std::span<glm::vec3> points) noexcept {
        const std::vector<glm::mat4x3> affine(joints.begin(), joints.end());
        for (std::size_t i = 0; i < points.size(); ++i) {
            const glm::vec4 bound(points[i], 1.0F);
            glm::vec3 moved(0.0F);
            for (int c = 0; c < 4; ++c) {
                const float weight = primitive.weights[i][c];
                if (weight > 0.0F) moved += weight * (affine[primitive.joints[i][c]] * bound);
            }
            points[i] = moved;
        }
    }

    // A skin has no single transform; the side its triangles face is the side most of its joints turn them to.
    bool mostlyMirrored(const Model::Skin& skin) const {
        const std::vector<glm::mat4> joints = jointMatrices(skin, rest_.worldFromNode);
        return 2 * std::count_if(joints.begin(), joints.end(), mirrors) > std::ssize(joints);
    }

    void addTriangles(const Model::Primitive& primitive, std::size_t first, bool turned) {
        const glm::uvec3 offset(static_cast<std::uint32_t>(first));
        for (const glm::uvec3& t : primitive.triangles)
            mesh_.triangles.push_back(offset + (turned ? glm::uvec3(t.x, t.z, t.y) : t));
    }

    const Model& model_;
    const Pose& rest_;
    const Pose& pose_;
    TriangleMesh mesh_;
};

} // namespace

double Model::Animation::duration() const noexcept {
    float last = 0.0F;
    for (const Channel& channel : channels)
        if (!channel.times.empty()) last = std::max(last, channel.times.back());
    return static_cast<double>(last);
}

Model modelOf(const TriangleMesh& mesh, const std::string& name) {
    Model::Primitive primitive;
    primitive.positions = mesh.positions;
    primitive.triangles = mesh.triangles;
    Model model;
    model.name = name;
    model.meshes.resize(1);
    model.meshes.front().name = name;
    model.meshes.front().primitives.push_back(std::move(primitive));
    model.nodes.resize(1);
    model.nodes.front().name = name;
    model.nodes.front().mesh = 0;
    model.roots = {0};
    return model;
}

std::vector<glm::mat4> nodeTransforms(const Model& model) { return chained(model, restLocals(model)); }

std::vector<glm::mat4> nodeTransforms(const Model& model, const Model::Animation& animation, double seconds) {
    return posed(model, animation, seconds).worldFromNode;
}

TriangleMesh flatten(const Model& model) {
    const Pose rest = restPose(model);
    return Flattener(model, rest, rest).run();
}

TriangleMesh flatten(const Model& model, const Model::Animation& animation, double seconds) {
    return Flattener(model, restPose(model), posed(model, animation, seconds)).run();
}

Box boxOverAnimation(const Model& model, const Model::Animation& animation, int frames, double framesPerSecond,
                     const Progress& progress) {
    Box box;
    for (int k = 0; k <= frames; ++k) {
        progress.throwIfCancelled();
        box.include(boundingBox(flatten(model, animation, k / framesPerSecond).positions));
        progress.report((k + 1.0) / (frames + 1), "measuring the animation");
    }
    return box;
}

} // namespace lumorph
