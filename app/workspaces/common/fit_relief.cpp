#include "app/workspaces/common/fit_relief.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "core/base/units.h"

namespace lumorph::studio {
namespace {

/// How many voxels lie from the bottom to the top of a column.
float topOf(const BitColumns& bits, int x, int z) {
    const int words = bits.wordsPerColumn();
    const auto first = bits.columnIndex(x, z) * static_cast<std::size_t>(words);
    for (int w = words - 1; w >= 0; --w)
        if (const std::uint64_t word = bits.words()[first + static_cast<std::size_t>(w)])
            return static_cast<float>(64 * w) + static_cast<float>(std::bit_width(word));
    return 0.0F;
}

/// The view of the pictures: from where, and how large.
struct Sight {
    glm::vec2 right, away; ///< unit steps on the ground, to the right and away from the eye
    float sine, cosine;    ///< of the angle that one looks down by
    float scale;           ///< pixels a voxel
    glm::vec2 middle;      ///< pixel of the middle of the ground
    float reach;           ///< voxels from the middle to the farthest corner, along `away`
};

Sight sightOf(const FitRelief& relief, const QSize& pixels) {
    const double yaw = Angle::degrees(24.0).inRadians();
    const double pitch = Angle::degrees(40.0).inRadians();
    const auto c = static_cast<float>(std::cos(yaw)), s = static_cast<float>(std::sin(yaw));
    Sight sight{{c, -s}, {-s, -c}, static_cast<float>(std::sin(pitch)), static_cast<float>(std::cos(pitch)), 1.0F,
                {},      0.0F};
    const glm::vec3 size(relief.dimensions);
    sight.reach = 0.5F * (size.x * s + size.z * c);
    const float wide = size.x * c + size.z * s;
    const float high = 2.0F * sight.reach * sight.sine + size.y * sight.cosine;
    const auto w = static_cast<float>(pixels.width()), h = static_cast<float>(pixels.height());
    sight.scale = std::min((w - 2.0F) / wide, (h - 2.0F) / high);
    sight.middle = {0.5F * w, 0.5F * (h + size.y * sight.cosine * sight.scale)};
    return sight;
}

/// Heights between the middles of columns, straight on beyond the last.
class Ground {
public:
    explicit Ground(const FitRelief& relief) : relief_(relief) {}

    [[nodiscard]] bool holds(glm::vec2 at) const {
        const int x = static_cast<int>(std::floor(at.x)), z = static_cast<int>(std::floor(at.y));
        if (x < 0 || z < 0 || x >= relief_.dimensions.x || z >= relief_.dimensions.z) return false;
        const std::size_t i = index(x, z);
        return relief_.wanted[i] > 0.0F || relief_.taken[i] > 0.0F;
    }
    /// Of what stands higher there, target or device.
    [[nodiscard]] float height(glm::vec2 at) const {
        return std::max(between(relief_.wanted, at), between(relief_.taken, at));
    }
    [[nodiscard]] float between(const std::vector<float>& heights, glm::vec2 at) const {
        const glm::vec2 p = at - 0.5F;
        const int x = static_cast<int>(std::floor(p.x)), z = static_cast<int>(std::floor(p.y));
        const float fx = p.x - static_cast<float>(x), fz = p.y - static_cast<float>(z);
        const auto one = [&](int dx, int dz) { return heights[index(x + dx, z + dz)]; };
        return std::lerp(std::lerp(one(0, 0), one(1, 0), fx), std::lerp(one(0, 1), one(1, 1), fx), fz);
    }

private:
    [[nodiscard]] std::size_t index(int x, int z) const {
        x = std::clamp(x, 0, relief_.dimensions.x - 1);
        z = std::clamp(z, 0, relief_.dimensions.z - 1);
        return static_cast<std::size_t>(z) * static_cast<std::size_t>(relief_.dimensions.x) +
               static_cast<std::size_t>(x);
    }
    const FitRelief& relief_;
};

QRgb colorAt(const FitRelief& relief, const Ground& ground, glm::vec2 at, const Palette& palette) {
    const float wanted = ground.between(relief.wanted, at), taken = ground.between(relief.taken, at);
    const float missing = wanted - taken;
    // A voxel more or less is no difference that one can rely on.
    const float full = std::max(2.0F, 0.08F * static_cast<float>(relief.dimensions.y));
    const float share = std::clamp((std::abs(missing) - 0.5F) / full, 0.0F, 1.0F);
    const bool moved = std::min(wanted, taken) > ground.between(relief.rest, at) + 0.5F;
    const QColor plain = blend(palette.panel, palette.text, moved ? 0.75 : 0.4);
    const QColor color = blend(plain, missing > 0.0F ? palette.unmatched : palette.overfilled, share);
    const float slopeX = 0.5F * (ground.height(at + glm::vec2(1, 0)) - ground.height(at - glm::vec2(1, 0)));
    const float slopeZ = 0.5F * (ground.height(at + glm::vec2(0, 1)) - ground.height(at - glm::vec2(0, 1)));
    const glm::vec3 normal = glm::normalize(glm::vec3(-slopeX, 1.0F, -slopeZ));
    const float light = std::max(0.0F, glm::dot(normal, glm::normalize(glm::vec3(-0.6F, 1.0F, 0.35F))));
    const float bright = 0.4F + 0.6F * light;
    const auto channel = [bright](int value) {
        return static_cast<int>(std::lround(bright * static_cast<float>(value)));
    };
    return qRgb(channel(color.red()), channel(color.green()), channel(color.blue()));
}

} // namespace

FitRelief reliefOf(const BitColumns& body, const BitColumns& wanted, const BitColumns& covered, int most) {
    const glm::ivec3 from = body.dimensions();
    const int step = (std::max(from.x, from.z) + most - 1) / most;
    FitRelief relief;
    relief.dimensions = {(from.x + step - 1) / step, (from.y + step - 1) / step, (from.z + step - 1) / step};
    const float unit = 1.0F / static_cast<float>(step);
    for (int z = 0; z < from.z; z += step)
        for (int x = 0; x < from.x; x += step) {
            const float rest = topOf(body, x, z);
            relief.rest.push_back(unit * rest);
            relief.wanted.push_back(unit * std::max(rest, topOf(wanted, x, z)));
            relief.taken.push_back(unit * std::max(rest, topOf(covered, x, z)));
        }
    return relief;
}

QImage pictureOf(const FitRelief& relief, const QSize& pixels, const Palette& palette) {
    QImage image(pixels, QImage::Format_ARGB32_Premultiplied);
    image.fill(Qt::transparent);
    if (relief.rest.empty() || pixels.width() < 4 || pixels.height() < 4) return image;
    const Sight sight = sightOf(relief, pixels);
    const Ground ground(relief);
    const glm::vec2 centre = 0.5F * glm::vec2(relief.dimensions.x, relief.dimensions.z);
    // Each column of pixels from front to back: what comes up over all before it is seen.
    const float stride = std::min(0.5F, 0.5F / sight.scale);
    for (int px = 0; px < pixels.width(); ++px) {
        const float aside = (static_cast<float>(px) + 0.5F - sight.middle.x) / sight.scale;
        int horizon = pixels.height();
        bool inside = false;
        for (float away = -sight.reach; away <= sight.reach; away += stride) {
            const glm::vec2 at = centre + aside * sight.right + away * sight.away;
            const bool was = std::exchange(inside, ground.holds(at));
            if (!inside) continue;
            const float foot = sight.middle.y - away * sight.sine * sight.scale;
            if (!was) horizon = std::min(horizon, static_cast<int>(std::ceil(foot)));
            const int top =
                std::max(0, static_cast<int>(std::ceil(foot - ground.height(at) * sight.cosine * sight.scale)));
            if (top >= horizon) continue;
            const QRgb color = colorAt(relief, ground, at, palette);
            for (int py = top; py < horizon; ++py) image.setPixel(px, py, color);
            horizon = top;
        }
    }
    return image;
}

} // namespace lumorph::studio
