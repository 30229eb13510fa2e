#include "core/render/eye_shadow.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "core/render/eye_materials.h"

namespace lumorph {
namespace {

constexpr int kSide = 1024;
constexpr float kRadiusStep = 1.15F;
constexpr float kSmallestRadius = 0.02F;   // metres
constexpr float kWidestLamp = 1.3F;        // radians from its middle to its rim
constexpr float kWidestSearch = 0.06F;     // map units
constexpr float kSteepest = 6.0F;          // metres of depth a metre across
constexpr float kPixelsOfBias = 0.75F;

void store(const gl::Texture& depth) {
    glBindTexture(GL_TEXTURE_2D, depth.name());
    glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT32F, kSide, kSide, 0, GL_DEPTH_COMPONENT, GL_FLOAT, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glBindTexture(GL_TEXTURE_2D, 0);
}

void setSampler(const gl::Sampler& sampler, GLint filter) {
    // Outside the map there is nothing between a place and the light.
    const float lit[] = {1.0F, 1.0F, 1.0F, 1.0F};
    glSamplerParameteri(sampler.name(), GL_TEXTURE_MIN_FILTER, filter);
    glSamplerParameteri(sampler.name(), GL_TEXTURE_MAG_FILTER, filter);
    glSamplerParameteri(sampler.name(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_BORDER);
    glSamplerParameteri(sampler.name(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_BORDER);
    glSamplerParameterfv(sampler.name(), GL_TEXTURE_BORDER_COLOR, lit);
}

glm::vec3 acrossFrom(const glm::vec3& direction) {
    return std::abs(direction.y) > 0.9F ? glm::vec3(0.0F, 0.0F, -1.0F) : glm::vec3(0.0F, 1.0F, 0.0F);
}

} // namespace

EyeShadow::EyeShadow() {
    store(depth_);
    setSampler(compared_, GL_LINEAR);
    glSamplerParameteri(compared_.name(), GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    glSamplerParameteri(compared_.name(), GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
    setSampler(plain_, GL_NEAREST);
}

bool EyeShadow::aim(const PosedLight& light, const Box& casters) {
    const glm::mat4 before = clipFromWorld_;
    light_ = light;
    float radius = std::max(0.5F * glm::length(casters.size()), kSmallestRadius);
    radius = kSmallestRadius * std::pow(kRadiusStep, std::ceil(std::log(radius / kSmallestRadius) / std::log(kRadiusStep)));
    if (light.parallel)
        aimParallel(casters.centre(), radius);
    else
        aimLamp(casters.centre(), radius);
    return clipFromWorld_ != before;
}

void EyeShadow::aimParallel(const glm::vec3& centre, float radius) {
    const glm::vec3 towards = glm::normalize(light_.position);
    const glm::mat4 turn = glm::lookAt(towards, glm::vec3(0.0F), acrossFrom(towards));
    texel_ = 2.0F * radius / static_cast<float>(kSide);
    glm::vec3 at(turn * glm::vec4(centre, 1.0F));
    at = texel_ * glm::round(at / texel_);
    const float depth = 1.05F * radius;
    clipFromWorld_ = glm::ortho(at.x - radius, at.x + radius, at.y - radius, at.y + radius, -at.z - depth, -at.z + depth) *
                     turn;
    perMetre_ = 0.5F / radius;
    depthRange_ = 2.0F * depth;
    distance_ = 1.0F;
}

void EyeShadow::aimLamp(const glm::vec3& centre, float radius) {
    distance_ = std::max(glm::distance(light_.position, centre), 0.02F);
    const glm::vec3 away = distance_ > 0.021F ? (centre - light_.position) / distance_ : glm::vec3(0.0F, -1.0F, 0.0F);
    const float half = radius < distance_ * std::sin(kWidestLamp) ? std::asin(radius / distance_) : kWidestLamp;
    const float near = std::max(distance_ - radius, 0.03F * distance_);
    const float far = distance_ + 1.05F * radius;
    clipFromWorld_ = glm::perspective(2.0F * half, 1.0F, near, far) *
                     glm::lookAt(light_.position, light_.position + away, acrossFrom(away));
    texel_ = 2.0F * std::tan(half) / static_cast<float>(kSide);
    perMetre_ = 0.5F / (std::tan(half) * distance_);
    depthRange_ = (far - near) * distance_ * distance_ / (far * near);
}

void EyeShadow::draw(const std::function<void(const glm::mat4& clipFromWorld)>& drawCasters) {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth_.name(), 0);
    glDrawBuffer(GL_NONE);
    glReadBuffer(GL_NONE);
    glViewport(0, 0, kSide, kSide);
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_CULL_FACE);
    glDisable(GL_BLEND);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glDepthMask(GL_TRUE);
    glEnable(GL_DEPTH_CLAMP);
    glClearDepth(1.0);
    glClear(GL_DEPTH_BUFFER_BIT);
    drawCasters(clipFromWorld_);
    glDisable(GL_DEPTH_CLAMP);
}

void EyeShadow::apply(Program& program) const {
    const float metresOfBias = kPixelsOfBias * texel_ * distance_;
    const glm::mat4 mapFromClip =
        glm::scale(glm::translate(glm::mat4(1.0F), glm::vec3(0.5F, 0.5F, 0.5F - metresOfBias / depthRange_)),
                   glm::vec3(0.5F));
    const glm::mat4 mapFromWorld = mapFromClip * clipFromWorld_;
    program.set("shadowFromWorld", mapFromWorld);
    program.set("shadowPlaneFromWorld", glm::transpose(glm::inverse(mapFromWorld)));
    program.set("shadowLight", light_.parallel ? glm::normalize(light_.position) : light_.position);
    program.set("shadowTexel", texel_);
    program.set("shadowSteepest", kSteepest / (perMetre_ * depthRange_));
    const float pixel = 1.0F / static_cast<float>(kSide);
    const float spread = 0.5F * std::max(light_.softness, 0.0F) * depthRange_ * perMetre_;
    // As far as an edge can spread: blocker and surface are at most a third of the map's depth apart.
    program.set("shadowReach", glm::vec2(std::clamp(0.33F * spread, 1.5F * pixel, kWidestSearch), 0.75F * pixel));
    program.set("shadowSpread", spread);
    program.set("shadowMap", static_cast<int>(eye_unit::shadowMap));
    program.set("shadowDepth", static_cast<int>(eye_unit::shadowDepth));
    for (const auto& [unit, sampler] : {std::pair(eye_unit::shadowMap, compared_.name()),
                                        std::pair(eye_unit::shadowDepth, plain_.name())}) {
        glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
        glBindTexture(GL_TEXTURE_2D, depth_.name());
        glBindSampler(static_cast<GLuint>(unit), sampler);
    }
}

} // namespace lumorph
