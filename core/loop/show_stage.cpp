#include "core/loop/show_stage.h"

#include <utility>

#include "core/base/error.h"

namespace lumorph {

ShowFrame ShowStage::frame(const MatchFrame& match) {
    return frame(match, {match.worldFromDevice, match.eye, match.hands, match.ms.latency});
}

ShowFrame ShowStage::frame(const MatchFrame& match, NewestView newest) {
    if (!match.scene || !match.installation || !match.assets)
        throw InvalidInput("show frame", "the loop's frame has no scene", "give the loop a scene with its assets");
    PoseInput input;
    input.seconds = match.sceneSeconds;
    input.worldFromDevice = newest.worldFromDevice;
    if (match.target) {
        // Triangles are the same at every time of an animation.
        input.targetMesh = {match.target, &match.target->solid.mesh};
        input.targetPositions = match.targetPositions;
        input.deviceFromTarget = match.deviceFromTarget;
    }
    ShowFrame frame;
    frame.posed = poser_.pose(*match.scene, *match.assets, input);
    frame.scene = shown(match.scene);
    frame.installation = match.installation;
    frame.assets = match.assets;
    frame.rig = match.rig;
    frame.devicePositions = match.devicePositions;
    frame.worldFromDevice = newest.worldFromDevice;
    frame.eye = newest.eye;
    frame.hands = std::move(newest.hands);
    return frame;
}

/// Holes, shrinking and drawn creases are light's doing, and so is a device that is a mere screen.
std::shared_ptr<const Scene> ShowStage::shown(const std::shared_ptr<const Scene>& scene) {
    if (scene->showing != Showing::physical) return scene;
    if (physicalOf_ != scene) { // the same object while nothing changes: who draws it compares
        Scene alone = *scene;
        Material material = std::move(alone.device.material);
        alone.device = {};
        alone.device.material = std::move(material);
        physical_ = std::make_shared<const Scene>(std::move(alone));
        physicalOf_ = scene;
    }
    return physical_;
}

} // namespace lumorph
