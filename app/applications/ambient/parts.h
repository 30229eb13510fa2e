#pragma once

#include <string>

#include "app/applications/ambient/scenery.h"

/// The parts of the landscape by theme. Each puts its items and models into a scene that stands still, and shows what
/// of them moves. Private to the scenery.
namespace lumorph::ambient {

/// Sun or moon, the colours of sky and night, the lamp of the lighthouse, lightning.
void addDaylight(Scene& scene);
void showDaylight(Scene& scene, const View& view);

/// Land, lighthouse with its dial of hours, house and trees; snow lies on them.
void addShore(Scene& scene, SceneAssets& assets);
void showShore(Scene& scene, const View& view);

/// The sea with its foam, a boat, rings of rain.
void addWater(Scene& scene, SceneAssets& assets);
void showWater(Scene& scene, const View& view);

/// Clouds, fog, falling rain and snow, a bolt.
void addAir(Scene& scene, SceneAssets& assets);
void showAir(Scene& scene, const View& view);

/// Of one known to be there.
[[nodiscard]] SceneItem& itemOf(Scene& scene, int id);
/// A model that is in memory alone, ready to be placed.
SceneItem& addModel(Scene& scene, SceneAssets& assets, int id, const std::string& name,
                    std::shared_ptr<const SceneModel> model, bool ownMaterials = false);
[[nodiscard]] Material plain(const std::string& name, const glm::vec3& color, float roughness = 0.8F);
[[nodiscard]] Material shining(const std::string& name, const glm::vec3& color, float strength);

/// From 0 where `value` is at or below `from` to 1 at `to`, softly.
[[nodiscard]] double rise(double from, double to, double value) noexcept;
/// 1 in full night, 0 by day.
[[nodiscard]] double nightOf(const View& view) noexcept;

} // namespace lumorph::ambient
