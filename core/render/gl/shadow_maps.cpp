#include "core/render/gl/shadow_maps.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

namespace lumorph {

ShadowMaps::ShadowMaps(int side, int layers)
    : side_(side), program_(shaderFiles({"depth.vert"}, {"depth.frag"})),
      mapFromWorld_(static_cast<std::size_t>(layers), glm::mat4(1.0F)) {
    glBindTexture(GL_TEXTURE_2D_ARRAY, depth_.name());
    glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_DEPTH_COMPONENT24, side, side, layers, 0, GL_DEPTH_COMPONENT, GL_FLOAT,
                 nullptr);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_BORDER);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_BORDER);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
    // Outside a map there is nothing between a point and the light.
    const float lit[] = {1.0F, 1.0F, 1.0F, 1.0F};
    glTexParameterfv(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_BORDER_COLOR, lit);
    glBindTexture(GL_TEXTURE_2D_ARRAY, 0);
}

void ShadowMaps::draw(std::span<const glm::vec3> directions, const Box& scene,
                      const std::function<void(Program&)>& drawCasters) {
    const float radius = 0.502F * glm::length(scene.size());
    texel_ = 2.0F * radius / static_cast<float>(side_);
    const glm::mat4 mapFromClip = glm::scale(glm::translate(glm::mat4(1.0F), glm::vec3(0.5F)), glm::vec3(0.5F));

    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    glDrawBuffer(GL_NONE);
    glReadBuffer(GL_NONE);
    glViewport(0, 0, side_, side_);
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_CULL_FACE);
    glDisable(GL_BLEND);
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_TRUE);
    program_.use();
    for (std::size_t i = 0; i < mapFromWorld_.size() && i < directions.size(); ++i) {
        const glm::vec3 light = glm::normalize(directions[i]);
        const glm::vec3 up = std::abs(light.y) > 0.9F ? glm::vec3(0.0F, 0.0F, 1.0F) : glm::vec3(0.0F, 1.0F, 0.0F);
        const glm::mat4 clipFromScene = glm::ortho(-radius, radius, -radius, radius, 0.0F, 2.0F * radius) *
                                        glm::lookAt(scene.centre() + radius * light, scene.centre(), up);
        mapFromWorld_[i] = mapFromClip * clipFromScene;
        glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, depth_.name(), 0, static_cast<GLint>(i));
        glClear(GL_DEPTH_BUFFER_BIT);
        program_.set("clipFromWorld", clipFromScene);
        drawCasters(program_);
    }
}

void ShadowMaps::bind(int textureUnit) const {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(textureUnit));
    glBindTexture(GL_TEXTURE_2D_ARRAY, depth_.name());
}

} // namespace lumorph
