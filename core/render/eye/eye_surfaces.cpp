#include "core/render/eye/eye_surfaces.h"

#include <algorithm>
#include <cmath>

namespace lumorph {
namespace {

constexpr double kSoftFold = 0.015; // metres over which blurred folds are round

template <class Values> void fill(GLenum target, const gl::Buffer& buffer, const Values& values, GLenum usage) {
    glBindBuffer(target, buffer.name());
    glBufferData(target, static_cast<GLsizeiptr>(values.size() * sizeof(*values.data())), values.data(), usage);
}

void attribute(GLuint index, const gl::Buffer& buffer, GLint components) {
    glBindBuffer(GL_ARRAY_BUFFER, buffer.name());
    glEnableVertexAttribArray(index);
    glVertexAttribPointer(index, components, GL_FLOAT, GL_FALSE, 0, nullptr);
}

bool finite(const std::vector<glm::vec3>& points) {
    return std::all_of(points.begin(), points.end(), [](const glm::vec3& p) {
        return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
    });
}

bool soundTopology(const SurfaceTopology& topology) {
    const std::size_t count = topology.coordinates.size();
    return !topology.triangles.empty() &&
           std::all_of(topology.triangles.begin(), topology.triangles.end(),
                       [&](const glm::uvec3& t) { return t.x < count && t.y < count && t.z < count; });
}

bool finite(const glm::mat4& matrix) {
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            if (!std::isfinite(matrix[column][row])) return false;
    return true;
}

} // namespace

Box movedBox(const Box& box, const glm::mat4& world) {
    return box.empty() ? Box() : boundingBox(cornersOf(box, world));
}

void EyeMesh::setTopology(const std::vector<glm::uvec3>& triangles, const std::vector<glm::vec2>& coordinates,
                          const std::vector<glm::vec3>* restPositions) {
    glBindVertexArray(array_.name());
    attribute(0, positions_, 3);
    attribute(1, normals_, 3);
    attribute(2, coordinates_, 2);
    fill(GL_ARRAY_BUFFER, coordinates_, coordinates, GL_STATIC_DRAW);
    if (restPositions != nullptr) {
        attribute(3, restPositions_, 3);
        fill(GL_ARRAY_BUFFER, restPositions_, *restPositions, GL_STATIC_DRAW);
    }
    fill(GL_ELEMENT_ARRAY_BUFFER, indices_, triangles, GL_STATIC_DRAW);
    glBindVertexArray(0);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    count_ = static_cast<GLsizei>(3 * triangles.size());
}

void EyeMesh::setShape(const std::vector<glm::vec3>& positions, const std::vector<glm::vec3>& normals) {
    fill(GL_ARRAY_BUFFER, positions_, positions, GL_STREAM_DRAW);
    fill(GL_ARRAY_BUFFER, normals_, normals, GL_STREAM_DRAW);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
}

void EyeMesh::draw() const {
    glBindVertexArray(array_.name());
    glDrawElements(GL_TRIANGLES, count_, GL_UNSIGNED_INT, nullptr);
    glBindVertexArray(0);
}

// A surface keeps its buffers from frame to frame; several of one item are told apart by their topology.
EyeSurfaces::Entry& EyeSurfaces::entryOf(const PosedSurface& surface) {
    const auto fits = [&](bool exact) {
        return std::find_if(entries_.begin(), entries_.end(), [&](const auto& entry) {
            return entry->topology == surface.topology && entry->item == surface.item && entry->lastFrame != frame_ &&
                   (!exact || entry->positions == surface.positions);
        });
    };
    auto found = fits(true);
    if (found == entries_.end()) found = fits(false);
    if (found == entries_.end()) {
        entries_.push_back(std::make_unique<Entry>());
        found = entries_.end() - 1;
        (*found)->topology = surface.topology;
        (*found)->item = surface.item;
        (*found)->sound = soundTopology(*surface.topology);
        if ((*found)->sound) (*found)->mesh.setTopology(surface.topology->triangles, surface.topology->coordinates);
    }
    (*found)->lastFrame = frame_;
    return **found;
}

void EyeSurfaces::upload(Entry& entry, const PosedSurface& surface) {
    if (entry.positions == surface.positions && entry.normals == surface.normals) return;
    entry.positions = surface.positions;
    entry.normals = surface.normals;
    entry.version = ++versions_;
    entry.box = Box();
    const std::size_t count = surface.topology->coordinates.size();
    if (surface.positions->size() != count || surface.normals->size() != count || !finite(*surface.positions) ||
        !finite(*surface.normals))
        return;
    entry.box = boundingBox(*surface.positions);
    entry.mesh.setShape(*surface.positions, *surface.normals);
}

// Whether there is a device, and its shape or what is done to its folds is another than before.
bool EyeSurfaces::takeRig(const ShowFrame& frame) {
    if (!frame.rig || !frame.devicePositions) {
        skinBoxAtDevice_ = Box();
        devicePositions_.reset();
        return false;
    }
    if (frame.rig != rig_) {
        rig_ = frame.rig;
        devicePositions_.reset();
        creaseFinder_.reset();
        skinSource_ = std::make_unique<SkinMesh>(rig_->restMesh());
        skinBoxAtRest_ = boundingBox(rig_->restMesh().positions);
        skinMesh_ = std::make_unique<EyeMesh>();
        skinMesh_->setTopology(skinSource_->triangles(), skinSource_->coordinates(), &skinSource_->restPositions());
    }
    const DeviceSkin::Creases& creases = frame.scene->device.creases;
    if (frame.devicePositions == devicePositions_ && creases == creases_) return false;
    devicePositions_ = frame.devicePositions;
    creases_ = creases;
    return true;
}

void EyeSurfaces::updateSkin(const ShowFrame& frame) {
    if (!takeRig(frame)) return;
    skinVersion_ = ++versions_;
    skinBoxAtDevice_ = Box();
    creaseMesh_.reset();
    if (devicePositions_->size() != skinSource_->meshVertexCount() || !finite(*devicePositions_)) return;
    const std::vector<glm::vec3> positions = skinSource_->cutPositions(*devicePositions_);
    if (creases_.emphasis != 0.0 && !creaseFinder_)
        creaseFinder_ = std::make_unique<CreaseFinder>(skinSource_->cutMesh());
    std::vector<glm::vec3> soft;
    if (creases_.emphasis < 0.0) soft = creaseFinder_->softNormals(positions, kSoftFold);
    skinSource_->shade(positions, soft, static_cast<float>(-creases_.emphasis), skinPositions_, skinNormals_);
    skinMesh_->setShape(skinPositions_, skinNormals_);
    skinBoxAtDevice_ = boundingBox(skinPositions_);
    if (creases_.emphasis > 0.0) updateCreases(positions);
}

void EyeSurfaces::updateCreases(const std::vector<glm::vec3>& positions) {
    const TriangleMesh& rest = skinSource_->cutMesh();
    const std::vector<Crease> creases = creaseFinder_->find(positions, creases_.threshold);
    const CreaseStrips strips = creaseStrips(creases, creases_.width, creases_.threshold);
    if (strips.triangles.empty()) return;
    std::vector<glm::vec3> restPositions;
    for (const std::uint32_t vertex : strips.vertices) restPositions.push_back(rest.positions[vertex]);
    creaseMesh_ = std::make_unique<EyeMesh>();
    creaseMesh_->setTopology(strips.triangles, strips.across, &restPositions);
    creaseMesh_->setShape(strips.positions, strips.normals);
}

void EyeSurfaces::update(const ShowFrame& frame) {
    ++frame_;
    updateSkin(frame);
    shown_.clear();
    for (std::size_t i = 0; i < frame.posed.surfaces.size(); ++i) {
        const PosedSurface& surface = frame.posed.surfaces[i];
        if (!surface.topology || !surface.positions || !surface.normals) continue;
        Entry& entry = entryOf(surface);
        if (entry.sound) upload(entry, surface);
        if (entry.box.empty() || !finite(surface.worldFromSurface) || !(surface.opacity > 0.0F)) continue;
        shown_.push_back({i, &entry.mesh, movedBox(entry.box, surface.worldFromSurface), entry.version});
    }
    std::erase_if(entries_, [&](const auto& entry) { return entry->lastFrame + 1 < frame_; });
}

std::size_t EyeSurfaces::objectCount() const noexcept {
    return EyeMesh::kObjects * (entries_.size() + (skinMesh_ ? 1 : 0) + (creaseMesh_ ? 1 : 0));
}

} // namespace lumorph
