#include "core/render/viewport/viewport_light.h"

#include <glm/geometric.hpp>

namespace lumorph {
namespace {

constexpr int kKeyUnit = 0;
constexpr int kSkyUnit = 1;

bool same(const ShadowCasters& a, const ShadowCasters& b) {
    return a.bounds.min == b.bounds.min && a.bounds.max == b.bounds.max && a.casters == b.casters;
}

} // namespace

bool ViewportLight::redraw(Maps& maps, std::span<const glm::vec3> directions, const ShadowCasters& casters,
                           const std::function<void(Program&)>& drawCasters, const std::function<bool()>& pieceDone) {
    if (same(maps.drawn, casters)) return true;
    bool going = true;
    maps.maps.draw(directions, casters.bounds, [&](Program& program) {
        if (!going) return;
        drawCasters(program);
        going = pieceDone();
    });
    maps.drawn = going ? casters : ShadowCasters();
    return going;
}

bool ViewportLight::update(ViewportQuality quality, const ShadowCasters& casters,
                           const std::function<void(Program&)>& drawCasters, const std::function<bool()>& pieceDone) {
    const glm::vec3 key = keyLightDirection();
    if (quality == ViewportQuality::moving) return redraw(moving_, {&key, 1}, casters, drawCasters, pieceDone);
    return redraw(still_, {&key, 1}, casters, drawCasters, pieceDone) &&
           redraw(sky_, skyDirections_, casters, drawCasters, pieceDone);
}

void ViewportLight::apply(Program& program, const ViewportFrame& frame) const {
    const bool still = frame.quality == ViewportQuality::still;
    const ShadowMaps& key = still ? still_.maps : moving_.maps;
    key.bind(kKeyUnit);
    program.set("keyDirection", keyLightDirection());
    program.set("keyMapFromWorld", key.mapFromWorld()[0]);
    program.set("keyShadow", kKeyUnit);
    program.set("keySoftness", kKeySoftness);
    // Along the normal by more than what the soft edge spans in depth on a sloping surface.
    const float keyBias = 2.0F * key.texel() + 0.6F * kKeySoftness * key.texel() * static_cast<float>(key.side());
    program.set("shadowBias", glm::vec2(keyBias, 1.8F * sky_.maps.texel()));
    if (!still) return;
    sky_.maps.bind(kSkyUnit);
    program.set("skyShadow", kSkyUnit);
    program.set("skyDirections", std::span<const glm::vec3>(skyDirections_));
    program.set("skyMapFromWorld", sky_.maps.mapFromWorld());
    program.set("sceneSphere", glm::vec4(frame.bounds.centre(), 0.5F * glm::length(frame.bounds.size())));
    program.set("keyShadowOn", 1);
    program.set("skyOcclusionOn", 1);
}

std::size_t ViewportLight::objectCount() const noexcept {
    return moving_.maps.objectCount() + still_.maps.objectCount() + sky_.maps.objectCount();
}

} // namespace lumorph
