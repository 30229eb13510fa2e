#include "core/render/eye_fog.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/render/eye_materials.h"

namespace lumorph {
namespace {

constexpr std::size_t kMost = 2; // as in eye_fog.glsl
constexpr int kSide = 32;        // of the grain's cube, which repeats
constexpr float kGrainsAcross = 4.0F;

// Random values on a lattice of `cells` a side, smoothly between.
std::vector<float> valueNoise(int cells, std::mt19937& random) {
    std::uniform_real_distribution<float> uniform(0.0F, 1.0F);
    std::vector<float> lattice(static_cast<std::size_t>(cells * cells * cells));
    for (float& value : lattice) value = uniform(random);
    std::vector<float> noise;
    noise.reserve(static_cast<std::size_t>(kSide) * kSide * kSide);
    for (int i = 0; i < kSide * kSide * kSide; ++i) {
        const glm::vec3 at = glm::vec3(i % kSide, i / kSide % kSide, i / (kSide * kSide)) *
                             (static_cast<float>(cells) / static_cast<float>(kSide));
        const glm::vec3 cell = glm::floor(at);
        const glm::vec3 share = glm::smoothstep(glm::vec3(0.0F), glm::vec3(1.0F), at - cell);
        float sum = 0.0F;
        for (unsigned corner = 0; corner < 8; ++corner) {
            const glm::ivec3 step(corner & 1U, corner >> 1U & 1U, corner >> 2U);
            const glm::ivec3 place = (glm::ivec3(cell) + step) % cells;
            const glm::vec3 weight = glm::mix(1.0F - share, share, glm::vec3(step));
            sum += weight.x * weight.y * weight.z *
                   lattice[static_cast<std::size_t>((place.z * cells + place.y) * cells + place.x)];
        }
        noise.push_back(sum);
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
    glBindTexture(GL_TEXTURE_3D, grain_->name());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage3D(GL_TEXTURE_3D, 0, GL_R8, kSide, kSide, kSide, 0, GL_RED, GL_UNSIGNED_BYTE, bytes.data());
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glBindTexture(GL_TEXTURE_3D, 0);
}

void EyeFog::update(std::span<const PosedFog> fogs, const glm::vec3& light) {
    fogs_.clear();
    light_ = light;
    std::copy_if(fogs.begin(), fogs.end(), std::back_inserter(fogs_), visible);
    fogs_.resize(std::min(fogs_.size(), kMost));
    if (any() && !grain_) makeGrain();
}

void EyeFog::apply(Program& program) const {
    std::array<glm::mat4, kMost> boxFromWorld{glm::mat4(0.0F), glm::mat4(0.0F)};
    std::array<glm::vec4, kMost> colors{glm::vec4(0.0F), glm::vec4(0.0F)};
    std::array<glm::vec4, kMost> grains{glm::vec4(1.0F), glm::vec4(1.0F)};
    for (std::size_t i = 0; i < fogs_.size(); ++i) {
        const PosedFog& fog = fogs_[i];
        boxFromWorld[i] = glm::inverse(fog.worldFromBox);
        colors[i] = glm::vec4(light_ * fog.color, fog.density);
        const float repeat = kGrainsAcross * std::max(fog.grain, 1e-3F);
        const glm::vec2 gone = fog.offset / repeat;
        const glm::vec3 size(glm::length(glm::vec3(fog.worldFromBox[0])), glm::length(glm::vec3(fog.worldFromBox[1])),
                             glm::length(glm::vec3(fog.worldFromBox[2])));
        grains[i] = glm::vec4(size / repeat, 0.0F);
        program.set("fogDrift[" + std::to_string(i) + "]", gone - glm::floor(gone));
    }
    program.set("fogFromWorld", std::span<const glm::mat4>(boxFromWorld));
    program.set("fogColors", std::span<const glm::vec4>(colors));
    program.set("fogGrains", std::span<const glm::vec4>(grains));
    program.set("fogGrain", static_cast<int>(eye_unit::fog));
    glActiveTexture(GL_TEXTURE0 + eye_unit::fog);
    glBindTexture(GL_TEXTURE_3D, grain_->name());
}

} // namespace lumorph
