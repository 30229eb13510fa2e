#include "core/render/viewport/viewport_tint.h"

#include <algorithm>
#include <string>

#include <glm/gtc/matrix_transform.hpp>

#include "core/base/srgb.h"

namespace lumorph {
namespace {

constexpr double kNudge = 0.5; // voxels against the normal, so that a surface meets the voxels inside it

void store(GLuint texture, const glm::ivec3& size, const std::uint8_t* classes) {
    glBindTexture(GL_TEXTURE_3D, texture);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage3D(GL_TEXTURE_3D, 0, GL_R8UI, size.x, size.y, size.z, 0, GL_RED_INTEGER, GL_UNSIGNED_BYTE, classes);
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glBindTexture(GL_TEXTURE_3D, 0);
}

bool fits(const ViewportTint& tint) {
    GLint largest = 0;
    glGetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &largest);
    const glm::ivec3& size = tint.frame.dimensions;
    return tint.classes && std::min({size.x, size.y, size.z}) > 0 && std::max({size.x, size.y, size.z}) <= largest &&
           tint.classes->size() == tint.frame.voxelCount() && tint.frame.voxelSize > 0.0;
}

// A surface cuts its outermost voxels, so that some of its points lie in voxels that do not count as inside:
// each coloured class reaches one voxel into class 0.
std::vector<std::uint8_t> widened(const std::vector<std::uint8_t>& classes, const glm::ivec3& size) {
    std::vector<std::uint8_t> wide = classes;
    const auto reach = [&](std::size_t from, int place, int length, std::ptrdiff_t stride) {
        for (const int step : {-1, 1}) {
            if (place + step < 0 || place + step >= length) continue;
            std::uint8_t& next = wide[static_cast<std::size_t>(static_cast<std::ptrdiff_t>(from) + step * stride)];
            if (next == 0) next = classes[from];
        }
    };
    std::size_t i = 0;
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x, ++i) {
                if (classes[i] == 0) continue;
                reach(i, x, size.x, 1);
                reach(i, y, size.y, size.x);
                reach(i, z, size.z, static_cast<std::ptrdiff_t>(size.x) * size.y);
            }
    return wide;
}

} // namespace

void ViewportTintVolume::update(const std::optional<ViewportTint>& tint) {
    if (!tint || !fits(*tint)) {
        volume_.reset();
        return;
    }
    if (!volume_) volume_ = std::make_unique<Volume>();
    if (volume_->classes == tint->classes && volume_->dimensions == tint->frame.dimensions) return;
    volume_->classes = tint->classes;
    volume_->dimensions = tint->frame.dimensions;
    store(volume_->texture.name(), volume_->dimensions, widened(*volume_->classes, volume_->dimensions).data());
}

void ViewportTintVolume::apply(Program& program, const ViewportFrame& frame, std::uint8_t classes,
                               int textureUnit) const {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(textureUnit));
    glBindTexture(GL_TEXTURE_3D, volume_->texture.name());
    program.set("tintClasses", textureUnit);
    const ViewportTint& tint = *frame.scene.tint;
    const auto voxel = static_cast<float>(tint.frame.voxelSize);
    program.set("tintFromWorld", glm::scale(glm::mat4(1.0F), glm::vec3(1.0F / voxel)) *
                                     glm::translate(glm::mat4(1.0F), -tint.frame.origin));
    program.set("tintNudge", static_cast<float>(kNudge * tint.frame.voxelSize));
    for (std::size_t i = 0; i < tint.colors.size(); ++i)
        program.set(
            "tintColors[" + std::to_string(i) + "]",
            glm::vec4(linearFromSrgb(glm::vec3(tint.colors[i])), (classes >> i & 1) != 0 ? tint.colors[i].a : 0.0F));
}

} // namespace lumorph
