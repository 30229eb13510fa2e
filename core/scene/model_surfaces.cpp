#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/base/error.h"
#include "core/scene/item_surfaces.h"

namespace lumorph {
namespace {

/// Nodes of the default scene that have a mesh, in the order in which `flatten` takes them.
std::vector<std::size_t> shownNodes(const Model& model) {
    std::vector<bool> inScene(model.nodes.size(), false);
    for (const int root : model.roots) inScene[static_cast<std::size_t>(root)] = true;
    std::vector<std::size_t> shown;
    for (std::size_t i = 0; i < model.nodes.size(); ++i) {
        const int parent = model.nodes[i].parent;
        if (parent >= 0 && inScene[static_cast<std::size_t>(parent)]) inScene[i] = true;
        if (inScene[i] && model.nodes[i].mesh >= 0) shown.push_back(i);
    }
    return shown;
}

bool hasUsableNormals(const Model::Primitive& primitive) {
    return !primitive.normals.empty() && std::ranges::all_of(primitive.normals, [](const glm::vec3& n) {
        const float square = glm::dot(n, n);
        return square > 0.25F && square < 4.0F;
    });
}

/// The primitive as it is in the file, its own normals and all.
ItemSurface surfaceOf(const Model::Primitive& primitive, const std::vector<glm::uvec3>& triangles) {
    SurfaceTopology topology;
    topology.triangles = triangles;
    topology.coordinates = primitive.texcoords;
    topology.coordinates.resize(primitive.positions.size(), glm::vec2(0.0F));
    auto normals = std::make_shared<std::vector<glm::vec3>>();
    normals->reserve(primitive.normals.size());
    for (const glm::vec3& normal : primitive.normals) normals->push_back(glm::normalize(normal));
    return {std::make_shared<const SurfaceTopology>(std::move(topology)),
            std::make_shared<const std::vector<glm::vec3>>(primitive.positions), std::move(normals)};
}

} // namespace

ModelSurfaces::ModelSurfaces(std::shared_ptr<const SceneModel> model, int animation)
    : model_(std::move(model)), animation_(animation) {
    const Model& source = model_->model;
    const TriangleMesh rest = flatten(source);
    std::size_t first = 0;
    std::size_t firstTriangle = 0;
    for (const std::size_t node : shownNodes(source)) {
        for (const Model::Primitive& primitive :
             source.meshes[static_cast<std::size_t>(source.nodes[node].mesh)].primitives) {
            if (!primitive.triangles.empty()) addPart(node, primitive, rest, first, firstTriangle);
            first += primitive.positions.size();
            firstTriangle += primitive.triangles.size();
        }
    }
}

const Model::Animation* ModelSurfaces::motion() const noexcept {
    return animation_ < 0 ? nullptr : &model_->model.animations[static_cast<std::size_t>(animation_)];
}

void ModelSurfaces::addPart(std::size_t node, const Model::Primitive& primitive, const TriangleMesh& rest,
                            std::size_t first, std::size_t firstTriangle) {
    const Model& source = model_->model;
    const bool skinned = source.nodes[node].skin >= 0 && !primitive.joints.empty();
    const bool morphed = !primitive.morphTargets.empty();
    const Model::Animation* moves = motion();
    Part part{node, first, primitive.positions.size(), !skinned && !morphed, false, {}};
    part.deforms = moves && !part.follows && !moves->channels.empty();
    anyDeforms_ = anyDeforms_ || part.deforms;

    // As flattened: turned where the rest pose mirrors it.
    std::vector<glm::uvec3> triangles(rest.triangles.begin() + static_cast<std::ptrdiff_t>(firstTriangle),
                                      rest.triangles.begin() +
                                          static_cast<std::ptrdiff_t>(firstTriangle + primitive.triangles.size()));
    for (glm::uvec3& t : triangles) t -= glm::uvec3(static_cast<std::uint32_t>(first));
    ModelSurface surface{{}, glm::mat4(1.0F), primitive.material};
    if (part.follows && hasUsableNormals(primitive)) {
        surface.surface = surfaceOf(primitive, triangles);
    } else {
        const std::span<const glm::vec3> posed = std::span(rest.positions).subspan(first, part.count);
        TriangleMesh mesh{part.follows ? primitive.positions : std::vector<glm::vec3>(posed.begin(), posed.end()),
                          std::move(triangles)};
        part.shaded.emplace(mesh, primitive.texcoords);
        surface.surface = part.shaded->at(mesh.positions);
    }
    parts_.push_back(std::move(part));
    surfaces_.push_back(std::move(surface));
}

const std::vector<ModelSurface>& ModelSurfaces::at(double seconds) {
    const Model& source = model_->model;
    const Model::Animation* moves = motion();
    double time = 0.0;
    if (moves && moves->duration() > 0.0) {
        time = std::fmod(seconds, moves->duration());
        if (time < 0.0) time += moves->duration();
    }
    const std::vector<glm::mat4> nodes = moves ? nodeTransforms(source, *moves, time) : nodeTransforms(source);
    for (std::size_t i = 0; i < parts_.size(); ++i)
        if (parts_[i].follows) surfaces_[i].itemFromSurface = nodes[parts_[i].node];
    if (!anyDeforms_) return surfaces_;
    try {
        deform(flatten(source, *moves, time));
    } catch (const InvalidInput&) {
        // The animation leads beyond all numbers for a while: it stays where it was.
    }
    return surfaces_;
}

void ModelSurfaces::deform(const TriangleMesh& posed) {
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        const Part& part = parts_[i];
        if (part.deforms)
            surfaces_[i].surface = part.shaded->at(std::span(posed.positions).subspan(part.first, part.count));
    }
}

} // namespace lumorph
