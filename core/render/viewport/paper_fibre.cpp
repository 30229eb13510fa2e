#include "core/render/viewport/paper_fibre.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace lumorph {

std::vector<std::uint8_t> paperFibre(int side) {
    std::vector<float> light(static_cast<std::size_t>(side) * static_cast<std::size_t>(side), 0.0F);
    std::mt19937 random(1); // the same paper every time
    const auto share = [&] { return static_cast<float>(random()) / 4294967296.0F; };
    const auto at = [&](float x, float y) -> float& {
        const auto wrapped = [&](float v) { return (static_cast<int>(std::floor(v)) % side + side) % side; };
        const int index = wrapped(y) * side + wrapped(x);
        return light[static_cast<std::size_t>(index)];
    };
    const auto size = static_cast<float>(side);
    for (int fibre = 0; fibre < side * side / 28; ++fibre) {
        float x = size * share();
        float y = size * share();
        float turn = 6.2831853F * share();
        const float bend = 0.16F * (share() - 0.5F);
        const float tone = share() - 0.5F;
        const int length = 8 + static_cast<int>(26.0F * share());
        for (int i = 0; i < length; ++i) {
            at(x, y) += tone * std::sin(3.1415927F * (static_cast<float>(i) + 0.5F) / static_cast<float>(length));
            x += std::cos(turn);
            y += std::sin(turn);
            turn += bend;
        }
    }
    std::vector<std::uint8_t> grey(light.size());
    std::transform(light.begin(), light.end(), grey.begin(), [](float value) {
        return static_cast<std::uint8_t>(std::clamp(128.0F + 130.0F * value, 0.0F, 255.0F));
    });
    return grey;
}

} // namespace lumorph
