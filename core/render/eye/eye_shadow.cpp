#include "core/render/eye/eye_shadow.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

namespace lumorph {
namespace {

constexpr int kShadowSide = 1024;
constexpr int kTiles = 128; // of 8 pixels, as in eye_tiles.frag
constexpr float kRadiusStep = 1.15F;
constexpr float kSmallestRadius = 0.02F; // metres
constexpr float kWidestLamp = 1.3F;      // radians from its middle to its rim
constexpr float kWidestSearch = 0.06F;   // map units
constexpr float kSteepest = 6.0F;        // metres of depth a metre across
constexpr float kPixelsOfBias = 0.75F;

void store(const gl::Texture& texture, GLint format, int side, GLenum pixels) {
    glBindTexture(GL_TEXTURE_2D, texture.name());
    glTexImage2D(GL_TEXTURE_2D, 0, format, side, side, 0, pixels, GL_FLOAT, nullptr);
    const float lit[] = {1.0F, 1.0F, 1.0F, 1.0F}; // outside the map nothing is between a place and the light
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_BORDER);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_BORDER);
    glTexParameterfv(GL_TEXTURE_2D, GL_TEXTURE_BORDER_COLOR, lit);
    glBindTexture(GL_TEXTURE_2D, 0);
}

ShaderFiles tileFiles(const std::vector<std::string>& defines) {
    ShaderFiles files = shaderFiles({"full_frame.vert"}, {"version.glsl", "eye_tiles.frag"});
    files.defines = defines;
    return files;
}

glm::vec3 acrossFrom(const glm::vec3& direction) {
    return std::abs(direction.y) > 0.9F ? glm::vec3(0.0F, 0.0F, -1.0F) : glm::vec3(0.0F, 1.0F, 0.0F);
}

} // namespace

EyeShadow::EyeShadow() : gather_(tileFiles({"GATHER"})), spread_(tileFiles({})) {
    store(depth_, GL_DEPTH_COMPONENT32F, kShadowSide, GL_DEPTH_COMPONENT);
    for (const gl::Texture& tiles : tiles_) store(tiles, GL_RG32F, kTiles, GL_RG);
}

void EyeShadow::aim(const PosedLight& light, const Box& casters) {
    light_ = light;
    float radius = std::max(0.5F * glm::length(casters.size()), kSmallestRadius);
    radius =
        kSmallestRadius * std::pow(kRadiusStep, std::ceil(std::log(radius / kSmallestRadius) / std::log(kRadiusStep)));
    if (light.parallel)
        aimParallel(casters.centre(), radius);
    else
        aimLamp(casters.centre(), radius);
}

bool EyeShadow::changed(std::vector<CasterState> casters, const DeviceSkin& skin) {
    const bool same = drawnClip_ == clipFromWorld_ && drawnSoftness_ == light_.softness && drawn_ == casters &&
                      drawnHoles_ == skin.holes && drawnShrink_ == skin.shrink;
    drawnClip_ = clipFromWorld_;
    drawnSoftness_ = light_.softness;
    drawn_ = std::move(casters);
    drawnHoles_ = skin.holes;
    drawnShrink_ = skin.shrink;
    return !same;
}

void EyeShadow::aimParallel(const glm::vec3& centre, float radius) {
    const glm::vec3 towards = glm::normalize(light_.position);
    const glm::mat4 turn = glm::lookAt(towards, glm::vec3(0.0F), acrossFrom(towards));
    texel_ = 2.0F * radius / static_cast<float>(kShadowSide);
    glm::vec3 at(turn * glm::vec4(centre, 1.0F));
    at = texel_ * glm::round(at / texel_);
    const float depth = 1.05F * radius;
    clipFromWorld_ =
        glm::ortho(at.x - radius, at.x + radius, at.y - radius, at.y + radius, -at.z - depth, -at.z + depth) * turn;
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
    texel_ = 2.0F * std::tan(half) / static_cast<float>(kShadowSide);
    perMetre_ = 0.5F / (std::tan(half) * distance_);
    depthRange_ = (far - near) * distance_ * distance_ / (far * near);
}

void EyeShadow::draw(const std::function<void(const glm::mat4& clipFromWorld)>& drawCasters) {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth_.name(), 0);
    glDrawBuffer(GL_NONE);
    glReadBuffer(GL_NONE);
    glViewport(0, 0, kShadowSide, kShadowSide);
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
    glDisable(GL_CULL_FACE);
    drawTiles();
}

// The border's tiles see a little beyond the map, where nothing is.
void EyeShadow::drawTiles() {
    const auto pass = [&](Program& program, GLuint from, const gl::Texture& to) {
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, to.name(), 0);
        glBindTexture(GL_TEXTURE_2D, from);
        program.set("depth", 0);
        program.set("tiles", 0);
        glDrawArrays(GL_TRIANGLES, 0, 3);
    };
    glBindFramebuffer(GL_FRAMEBUFFER, tileFramebuffer_.name());
    glViewport(0, 0, kTiles, kTiles);
    glDisable(GL_DEPTH_TEST);
    glActiveTexture(GL_TEXTURE0);
    glBindVertexArray(frame_.name());
    gather_.use();
    pass(gather_, depth_.name(), tiles_[0]);
    spread_.use();
    spread_.set("reach", static_cast<int>(std::ceil(reach().x * static_cast<float>(kTiles))));
    spread_.set("axis", glm::vec2(1.0F, 0.0F));
    pass(spread_, tiles_[0].name(), tiles_[1]);
    spread_.set("axis", glm::vec2(0.0F, 1.0F));
    pass(spread_, tiles_[1].name(), tiles_[0]);
    glBindVertexArray(0);
    glEnable(GL_DEPTH_TEST);
}

// Radius of the search, as far as an edge can spread while blocker and surface are at most a third of the map's depth
// apart, and the least radius of an edge.
glm::vec2 EyeShadow::reach() const {
    const float pixel = 1.0F / static_cast<float>(kShadowSide);
    return {std::clamp(0.33F * spread(), 1.5F * pixel, kWidestSearch), 0.75F * pixel};
}

float EyeShadow::spread() const { return 0.5F * std::max(light_.softness, 0.0F) * depthRange_ * perMetre_; }

std::size_t EyeShadow::objectCount() const noexcept { return 6 + gather_.objectCount() + spread_.objectCount(); }

void EyeShadow::apply(Program& program) const {
    const float metresOfBias = kPixelsOfBias * texel_ * distance_;
    const glm::mat4 mapFromClip = glm::scale(
        glm::translate(glm::mat4(1.0F), glm::vec3(0.5F, 0.5F, 0.5F - metresOfBias / depthRange_)), glm::vec3(0.5F));
    const glm::mat4 mapFromWorld = mapFromClip * clipFromWorld_;
    program.set("shadowFromWorld", mapFromWorld);
    program.set("shadowPlaneFromWorld", glm::transpose(glm::inverse(mapFromWorld)));
    program.set("shadowLight", light_.parallel ? glm::normalize(light_.position) : light_.position);
    program.set("shadowTexel", texel_);
    program.set("shadowSteepest", kSteepest / (perMetre_ * depthRange_));
    program.set("shadowReach", reach());
    program.set("shadowSpread", spread());
    program.set("shadowDepth", static_cast<int>(eye_unit::shadowDepth));
    program.set("shadowTiles", static_cast<int>(eye_unit::shadowTiles));
    glActiveTexture(GL_TEXTURE0 + eye_unit::shadowTiles);
    glBindTexture(GL_TEXTURE_2D, tiles_[0].name());
    glActiveTexture(GL_TEXTURE0 + eye_unit::shadowDepth);
    glBindTexture(GL_TEXTURE_2D, depth_.name());
}

} // namespace lumorph
