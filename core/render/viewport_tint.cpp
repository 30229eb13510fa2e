#include "core/render/viewport_tint.h"

#include <algorithm>
#include <string>

#include <glm/gtc/matrix_transform.hpp>

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

} // namespace

void ViewportTintVolume::update(const std::optional<ViewportTint>& tint) {
    if (!tint || !fits(*tint)) {
        // A texture of one voxel, so that the program always has one to sample.
        const std::uint8_t none = 0;
        if (classes_ || dimensions_ == glm::ivec3(0)) store(texture_.name(), glm::ivec3(1), &none);
        classes_.reset();
        dimensions_ = glm::ivec3(1);
        return;
    }
    if (classes_ == tint->classes && dimensions_ == tint->frame.dimensions) return;
    classes_ = tint->classes;
    dimensions_ = tint->frame.dimensions;
    store(texture_.name(), dimensions_, classes_->data());
}

void ViewportTintVolume::apply(Program& program, const ViewportFrame& frame, int textureUnit) const {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(textureUnit));
    glBindTexture(GL_TEXTURE_3D, texture_.name());
    program.set("tintClasses", textureUnit);
    if (!classes_) return;
    const ViewportTint& tint = *frame.scene.tint;
    const auto voxel = static_cast<float>(tint.frame.voxelSize);
    program.set("tintFromWorld", glm::scale(glm::mat4(1.0F), glm::vec3(1.0F / voxel)) *
                                     glm::translate(glm::mat4(1.0F), -tint.frame.origin));
    program.set("tintNudge", static_cast<float>(kNudge * tint.frame.voxelSize));
    for (std::size_t i = 0; i < tint.colors.size(); ++i)
        program.set("tintColors[" + std::to_string(i) + "]",
                    glm::vec4(linearFromSrgb(glm::vec3(tint.colors[i])), tint.colors[i].a));
}

void ViewportTintVolume::setTinted(Program& program, const ViewportFrame& frame, bool tinted) const {
    const int taps = frame.quality == ViewportQuality::still ? 8 : 1;
    program.set("tintTaps", tinted && classes_ ? taps : 0);
}

} // namespace lumorph
