#include "core/render/eye/eye_fog.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/render/eye/eye_materials.h"
#include "core/render/eye/eye_programs.h"

namespace lumorph {
namespace {

constexpr std::size_t kMost = 2; // as in eye_fog.glsl
constexpr int kGrainSide = 64;   // of the grain's picture, which repeats
constexpr float kGrainsAcross = 4.0F;

// Random values on a lattice of `cells` a side, smoothly between.
std::vector<float> valueNoise(int cells, std::mt19937& random) {
    std::uniform_real_distribution<float> uniform(0.0F, 1.0F);
    std::vector<float> lattice(static_cast<std::size_t>(cells * cells));
    for (float& value : lattice) value = uniform(random);
    std::vector<float> noise;
    noise.reserve(static_cast<std::size_t>(kGrainSide) * kGrainSide);
    for (int i = 0; i < kGrainSide * kGrainSide; ++i) {
        const glm::vec2 at =
            glm::vec2(i % kGrainSide, i / kGrainSide) * (static_cast<float>(cells) / static_cast<float>(kGrainSide));
        const glm::vec2 cell = glm::floor(at);
        const glm::vec2 share = glm::smoothstep(glm::vec2(0.0F), glm::vec2(1.0F), at - cell);
        const auto value = [&](int right, int down) {
            const glm::ivec2 place = (glm::ivec2(cell) + glm::ivec2(right, down)) % cells;
            return lattice[static_cast<std::size_t>(place.y * cells + place.x)];
        };
        noise.push_back(glm::mix(glm::mix(value(0, 0), value(1, 0), share.x),
                                 glm::mix(value(0, 1), value(1, 1), share.x), share.y));
    }
    return noise;
}

bool visible(const PosedFog& fog) {
    const float size = glm::determinant(glm::mat3(fog.worldFromBox));
    return fog.density > 0.0F && std::isfinite(fog.density) && std::isfinite(size) && size != 0.0F;
}

} // namespace

void EyeFog::makeGrain() {
    std::mt19937 random(7);
    const std::array octaves{valueNoise(4, random), valueNoise(8, random), valueNoise(16, random)};
    std::vector<std::uint8_t> bytes;
    for (std::size_t i = 0; i < octaves[0].size(); ++i)
        bytes.push_back(static_cast<std::uint8_t>(
            std::lround(255.0F * (0.55F * octaves[0][i] + 0.3F * octaves[1][i] + 0.15F * octaves[2][i]))));
    grain_.emplace();
    glBindTexture(GL_TEXTURE_2D, grain_->name());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_R8, kGrainSide, kGrainSide, 0, GL_RED, GL_UNSIGNED_BYTE, bytes.data());
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glBindTexture(GL_TEXTURE_2D, 0);
}

void EyeFog::update(std::span<const PosedFog> fogs, const glm::vec3& light) {
    fogs_.clear();
    light_ = light;
    std::copy_if(fogs.begin(), fogs.end(), std::back_inserter(fogs_), visible);
    fogs_.resize(std::min(fogs_.size(), kMost));
    if (!fogs_.empty() && !grain_) makeGrain();
}

std::uint32_t EyeFog::features() const noexcept {
    return fogs_.empty() ? 0U : eye_feature::fog | (fogs_.size() > 1 ? eye_feature::secondFog : 0U);
}

void EyeFog::apply(Program& program) const {
    std::vector<glm::mat4> fromWorld;
    std::vector<glm::vec4> colors;
    std::vector<glm::vec3> grains;
    std::vector<glm::vec2> drifts;
    for (const PosedFog& fog : fogs_) {
        const glm::mat4& box = fog.worldFromBox;
        const float repeat = kGrainsAcross * std::max(fog.grain, 1e-3F);
        const glm::vec2 gone = fog.offset / repeat;
        fromWorld.push_back(glm::inverse(box));
        colors.emplace_back(light_ * fog.color, fog.density);
        grains.push_back(glm::vec3(glm::length(box[0]), glm::length(box[1]), glm::length(box[2])) / repeat);
        drifts.push_back(gone - glm::floor(gone));
    }
    program.set("fogFromWorld", std::span<const glm::mat4>(fromWorld));
    program.set("fogColors", std::span<const glm::vec4>(colors));
    program.set("fogGrains", std::span<const glm::vec3>(grains));
    program.set("fogDrifts", std::span<const glm::vec2>(drifts));
    program.set("fogGrain", static_cast<int>(eye_unit::fog));
    glActiveTexture(GL_TEXTURE0 + eye_unit::fog);
    glBindTexture(GL_TEXTURE_2D, grain_->name());
}

} // namespace lumorph
