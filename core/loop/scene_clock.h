#pragma once

#include <memory>
#include <optional>

#include "core/loop/match_wish.h"

namespace lumorph {

/// The time of a scene: it runs while it plays, and goes where it is sent.
class SceneClock {
public:
    /// `sinceLast` seconds later.
    void step(const MatchWish& wish, double sinceLast);
    [[nodiscard]] double seconds() const noexcept { return seconds_; }
    /// Whether the scene will look otherwise in the next frame with the same wish.
    [[nodiscard]] bool moves() const noexcept { return moves_; }

private:
    double seconds_ = 0.0;
    std::optional<double> sought_;
    std::shared_ptr<const Scene> scene_;
    std::shared_ptr<const SceneAssets> assets_;
    bool animated_ = false;
    bool moves_ = false;
};

/// Whether something visible in a scene changes with its time: motions, waves, drifting fog, moving pictures, animated
/// models. The match target has a time of its own.
[[nodiscard]] bool isAnimated(const Scene& scene, const SceneAssets* assets);

} // namespace lumorph
