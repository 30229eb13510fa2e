#pragma once

#include <memory>

#include "app/studio/rendering/show_request.h"
#include "core/scene/scene_assets.h"
#include "tests/support/cut_tablet.h"

namespace lumorph::studio {

/// The cut tablet in the default scene with one red box above it, as a frame of the loop. `shift` moves the box
/// along x, metres.
[[nodiscard]] inline std::shared_ptr<MatchFrame> showFrame(float shift = 0.0F, std::uint64_t number = 1) {
    static const auto rig = std::make_shared<const Rig>(test::cutTablet());
    static const auto rest = std::make_shared<const std::vector<glm::vec3>>(rig->restMesh().positions);
    auto scene = std::make_shared<Scene>(defaultScene());
    static const auto installation = std::make_shared<const Installation>(defaultInstallation());
    SceneItem box;
    box.id = 900;
    box.name = "Box";
    box.position = {shift, rig->reach().max.y + 0.02F, 0.0F};
    box.material.color = {0.9F, 0.02F, 0.02F};
    box.kind = ShapeItem{ShapeItem::Form::box, glm::vec3(0.03F)};
    scene->items.push_back(box);
    auto frame = std::make_shared<MatchFrame>();
    frame->number = number;
    frame->time = SteadyClock().now();
    frame->rig = rig;
    frame->devicePositions = rest;
    frame->estimatedStrokes.assign(rig->actuatorCount(), 0.0);
    frame->installation = installation;
    frame->worldFromDevice = installation->worldFromDevice;
    frame->eye = installation->eye;
    // Read once, as a document reads them: pictures that are other objects are uploaded again.
    static const auto assets = loadSceneAssets(*scene, {});
    frame->assets = assets;
    frame->scene = std::move(scene);
    return frame;
}

[[nodiscard]] inline WantedView wantedView(int id, ShowView::Kind kind, QSize pixels) {
    WantedView wanted;
    wanted.id = id;
    wanted.view.kind = kind;
    wanted.pixels = pixels;
    return wanted;
}

} // namespace lumorph::studio
