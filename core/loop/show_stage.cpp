#include "core/loop/show_stage.h"

#include "core/base/error.h"

namespace lumorph {

ShowFrame ShowStage::frame(const MatchFrame& match) {
    if (!match.scene || !match.installation || !match.assets)
        throw InvalidInput("show frame", "the loop's frame has no scene", "give the loop a scene with its assets");
    PoseInput input;
    input.seconds = match.sceneSeconds;
    input.worldFromDevice = match.worldFromDevice;
    if (match.target) {
        // Triangles are the same at every time of an animation.
        input.targetMesh = {match.target, &match.target->solid.mesh};
        input.targetPositions = match.targetPositions;
        input.deviceFromTarget = match.deviceFromTarget;
    }
    ShowFrame frame;
    frame.posed = poser_.pose(*match.scene, *match.assets, input);
    frame.scene = match.scene;
    frame.installation = match.installation;
    frame.assets = match.assets;
    frame.rig = match.rig;
    frame.devicePositions = match.devicePositions;
    frame.worldFromDevice = match.worldFromDevice;
    frame.eye = match.eye;
    return frame;
}

} // namespace lumorph
