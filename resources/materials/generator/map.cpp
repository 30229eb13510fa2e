#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "resources/materials/generator/landscape.h"
#include "resources/materials/generator/textures.h"

namespace lumorph {
namespace {

constexpr int kSide = kTextureSide;

/// Tints of land by height above the sea, as school atlases have them.
glm::vec3 landTint(float height) {
    constexpr std::array<float, 6> kAt = {0.0F, 0.12F, 0.30F, 0.52F, 0.75F, 1.0F};
    const std::array<glm::vec3, 6> colors = {glm::vec3(0.60F, 0.76F, 0.54F), {0.73F, 0.83F, 0.60F},
                                             {0.93F, 0.90F, 0.70F},          {0.89F, 0.76F, 0.55F},
                                             {0.76F, 0.60F, 0.46F},          {0.97F, 0.96F, 0.95F}};
    std::size_t i = 0;
    while (i + 2 < kAt.size() && height > kAt[i + 1]) ++i;
    return glm::mix(colors[i], colors[i + 1], std::clamp((height - kAt[i]) / (kAt[i + 1] - kAt[i]), 0.0F, 1.0F));
}

glm::vec3 seaTint(float depth) {
    const float step = std::floor(std::min(depth, 0.999F) * 5.0F) / 5.0F;
    return glm::mix(glm::vec3(0.74F, 0.88F, 0.93F), glm::vec3(0.34F, 0.58F, 0.76F), step);
}

class Painter {
public:
    explicit Painter(const Landscape& land) : land_(land), river_(thick(land.river)) { thickRoads(); }

    glm::vec3 operator()(int x, int y) const {
        const float level = land_.ground.at(x, y);
        const float above = (level - kSeaLevel) / (1.0F - kSeaLevel);
        glm::vec3 color = landTint(above) * shade(x, y);
        color = glm::mix(color, glm::vec3(0.55F, 0.36F, 0.22F), contours(x, y, above));
        color = glm::mix(color, glm::vec3(0.27F, 0.52F, 0.76F), river_.at(x, y));
        const float toCoast = (level - kSeaLevel) / std::max(steepness(x, y), 1e-4F); // pixels
        color = glm::mix(seaTint((kSeaLevel - level) / kSeaLevel), color, smooth(-0.6F, 0.6F, toCoast));
        color = glm::mix(color, glm::vec3(0.12F, 0.33F, 0.54F), 0.9F * (1.0F - smooth(0.5F, 1.5F, std::abs(toCoast))));
        return roads(x, y, color);
    }

private:
    float steepness(int x, int y) const {
        const Heights& g = land_.ground;
        return 0.5F * glm::length(glm::vec2(g.at(x + 1, y) - g.at(x - 1, y), g.at(x, y + 1) - g.at(x, y - 1)));
    }
    /// Light from the upper left.
    float shade(int x, int y) const {
        const Heights& g = land_.ground;
        const glm::vec3 normal =
            glm::normalize(glm::vec3(g.at(x - 1, y) - g.at(x + 1, y), g.at(x, y - 1) - g.at(x, y + 1), 0.055F));
        return 0.66F + 0.46F * glm::dot(normal, glm::normalize(glm::vec3(-0.55F, -0.55F, 0.63F)));
    }
    /// Lines of one height, every fifth bold; as wide everywhere, however steep.
    float contours(int x, int y, float above) const {
        if (above <= 0.0F) return 0.0F;
        const float lines = above * 22.0F;
        const float number = std::round(lines);
        if (number < 1.0F) return 0.0F;
        const float pixels = std::abs(lines - number) / std::max(22.0F * steepness(x, y) / (1.0F - kSeaLevel), 1e-4F);
        const bool bold = static_cast<int>(number) % 5 == 0;
        return (bold ? 0.75F : 0.42F) * (1.0F - smooth(bold ? 0.5F : 0.2F, bold ? 1.4F : 1.05F, pixels));
    }

    /// Discs of the given widths around all marked places, with soft edges.
    static Heights thick(const Heights& widths) {
        Heights covered(kSide);
        for (int y = 0; y < kSide; ++y) {
            for (int x = 0; x < kSide; ++x) {
                const float radius = 0.5F * widths.at(x, y);
                if (radius <= 0.0F) continue;
                for (int dy = -4; dy <= 4; ++dy)
                    for (int dx = -4; dx <= 4; ++dx) {
                        const float outside = glm::length(glm::vec2(dx, dy)) - radius;
                        float& value = covered.at(x + dx, y + dy);
                        value = std::max(value, 1.0F - smooth(-0.2F, 0.9F, outside));
                    }
            }
        }
        return covered;
    }
    void thickRoads() {
        Heights main(kSide);
        Heights mainCase(kSide);
        Heights lane(kSide);
        Heights laneCase(kSide);
        for (int y = 0; y < kSide; ++y) {
            for (int x = 0; x < kSide; ++x) {
                const float kind = land_.road.at(x, y);
                if (kind > 1.5F) {
                    main.at(x, y) = 2.6F;
                    mainCase.at(x, y) = 4.8F;
                } else if (kind > 0.5F) {
                    lane.at(x, y) = 1.3F;
                    laneCase.at(x, y) = 3.2F;
                }
            }
        }
        main_ = thick(main);
        mainCase_ = thick(mainCase);
        lane_ = thick(lane);
        laneCase_ = thick(laneCase);
    }
    glm::vec3 roads(int x, int y, glm::vec3 color) const {
        const glm::vec3 ink(0.36F, 0.29F, 0.24F);
        color = glm::mix(color, ink, 0.75F * laneCase_.at(x, y));
        color = glm::mix(color, ink, 0.90F * mainCase_.at(x, y));
        color = glm::mix(color, glm::vec3(0.99F, 0.98F, 0.93F), lane_.at(x, y));
        color = glm::mix(color, glm::vec3(0.97F, 0.70F, 0.24F), main_.at(x, y));
        for (const glm::ivec2& town : land_.towns) {
            glm::ivec2 d = glm::abs(glm::ivec2(x, y) - town);
            d = glm::min(d, kSide - d);
            const float distance = glm::length(glm::vec2(d));
            color = glm::mix(color, glm::vec3(0.20F, 0.12F, 0.12F), 1.0F - smooth(5.0F, 6.2F, distance));
            color = glm::mix(color, glm::vec3(0.86F, 0.24F, 0.20F), 1.0F - smooth(3.4F, 4.6F, distance));
        }
        return color;
    }

    const Landscape& land_;
    Heights river_, main_, mainCase_, lane_, laneCase_;
};

} // namespace

std::vector<NamedPicture> mapPictures() {
    const Landscape land = makeLandscape();
    const Painter painter(land);
    Heights relief = land.ground;
    for (float& value : relief.values()) value = std::max(value - kSeaLevel, 0.0F) / (1.0F - kSeaLevel);
    return {{"map", painted([&](int x, int y) { return painter(x, y); })},
            {"map_normal", normalsOf(relief, 0.05F)},
            {"map_height", painted([&](int x, int y) { return glm::vec3(relief.at(x, y)); })}};
}

} // namespace lumorph
