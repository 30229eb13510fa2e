#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <epoxy/gl.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_inverse.hpp>

#include "core/render/eye/eye_pass.h"
#include "core/render/gl/color_target.h"
#include "core/render/gl/headless_context.h"
#include "core/render/projector/projector_target.h"
#include "core/scene/posed_scene.h"
#include "tests/core/render/ray_oracle.h"
#include "tests/support/cut_tablet.h"
#include "tests/support/scene_in_room.h"

namespace lumorph {

/// What the eye pass drew, linear; row 0 is the top.
struct LinearPicture {
    glm::ivec2 size{0};
    std::vector<glm::vec4> pixels;
    [[nodiscard]] const glm::vec4& at(int x, int y) const {
        return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(size.x) + static_cast<std::size_t>(x)];
    }
};

/// The tablet on a table before an eye pass, and what a ray caster knows of it.
class EyeStage {
public:
    enum Thing { nothing, device, table, firstItem };

    HeadlessContext context;
    EyePass pass;
    std::shared_ptr<Rig> rig = std::make_shared<Rig>(test::cutTablet());
    std::shared_ptr<SceneAssets> assets = std::make_shared<SceneAssets>();
    SceneInRoom scene;
    std::vector<double> strokes = std::vector<double>(6, 0.0);
    double seconds = 0.0;
    glm::ivec2 size{640, 400};

    /// White, dull things under one hard sun without sky; no tone mapping.
    EyeStage() {
        scene.sky = glm::vec3(0.0F);
        scene.toneMapping = false;
        scene.device.material = plain({1.0F, 1.0F, 1.0F});
        scene.table.material = plain({1.0F, 1.0F, 1.0F});
        scene.eye = {0.04F, 0.42F, 0.48F};
        addSun({-0.45F, 0.8F, -0.3F});
    }

    static Material plain(const glm::vec3& color) {
        Material material;
        material.color = color;
        material.roughness = 1.0F;
        return material;
    }
    /// Squares of `cell` pixels a side.
    static std::shared_ptr<const Image> checks(glm::ivec2 size, int cell, Image::Pixel a, Image::Pixel b) {
        auto image = std::make_shared<Image>(size);
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) image->at(x, y) = (x / cell + y / cell) % 2 == 0 ? a : b;
        return image;
    }
    static SceneTexture textured(const std::string& image, float tile) {
        SceneTexture texture;
        texture.image = image;
        texture.tile = glm::vec2(tile);
        return texture;
    }
    SceneItem& addSun(const glm::vec3& position) {
        SceneItem sun;
        sun.id = static_cast<int>(scene.items.size()) + 1;
        sun.name = "Sun";
        sun.anchor = Anchor::world;
        sun.position = position;
        sun.kind = LightItem{.intensity = 0.9, .softness = 0.0};
        scene.items.push_back(sun);
        return scene.items.back();
    }
    LightItem& sun() { return std::get<LightItem>(scene.items.front().kind); }
    SceneItem& addBox(const glm::vec3& position, float side) {
        SceneItem box;
        box.id = static_cast<int>(scene.items.size()) + 1;
        box.name = "Box";
        box.position = position;
        box.rotation = glm::angleAxis(0.5F, glm::vec3(0.0F, 1.0F, 0.0F));
        box.kind = ShapeItem{ShapeItem::Form::box, glm::vec3(side)};
        box.material = plain({1.0F, 1.0F, 1.0F});
        scene.items.push_back(box);
        return scene.items.back();
    }

    [[nodiscard]] ShowFrame frame() {
        ShowFrame frame;
        setSceneInRoom(frame, scene);
        frame.assets = assets;
        frame.rig = rig;
        auto positions = std::make_shared<std::vector<glm::vec3>>(rig->restMesh().positions.size());
        rig->deform(strokes, *positions);
        frame.devicePositions = positions;
        frame.worldFromDevice = scene.worldFromDevice;
        frame.eye = scene.eye;
        PoseInput input;
        input.seconds = seconds;
        input.worldFromDevice = frame.worldFromDevice;
        frame.posed = poser_.pose(scene, *assets, input);
        return frame;
    }
    /// The eye over the device, with its axis in the middle of the picture.
    [[nodiscard]] CalibratedCamera camera() const {
        return cameraLookingAt(glm::dvec3(scene.eye), {0.0, 0.03, 0.0}, size, 1.9 * size.x);
    }

    [[nodiscard]] LinearPicture draw(const ShowFrame& frame, const CalibratedCamera& camera) {
        return drawBy(pass, frame, camera);
    }
    [[nodiscard]] LinearPicture drawBy(EyePass& by, const ShowFrame& frame, const CalibratedCamera& camera) {
        if (!target_ || target_->size() != camera.size) target_.emplace(camera.size, GL_RGBA32F);
        by.prepare(frame);
        by.draw(frame, camera, target_->framebuffer());
        return read();
    }
    [[nodiscard]] LinearPicture draw() { return draw(frame(), camera()); }
    /// What a projector in the eye's place would send to where no eye looks, the light itself (`compensation` off);
    /// row 0 is the top.
    [[nodiscard]] Image drawUnseen() {
        scene.compensation = false;
        InstalledProjector projector;
        projector.camera = camera();
        ProjectorTarget target(projector);
        target.region = PixelRegion({glm::ivec2(0), size});
        target.device = {glm::ivec2(0), size};
        glBindFramebuffer(GL_FRAMEBUFFER, target.rest.name());
        glDisable(GL_SCISSOR_TEST);
        glDepthMask(GL_TRUE);
        glClearDepth(1.0);
        glClearColor(0.0F, 0.0F, 0.0F, 0.0F);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        const ShowFrame now = frame();
        pass.prepare(now);
        pass.drawUnseen(now, unseenPlaces(target, *now.installation));
        return target.sent.read();
    }

    /// All that is in a frame, but for skin holes.
    static RayOracle oracle(const ShowFrame& frame) {
        RayOracle rays;
        const auto add = [&](const auto& triangles, const auto& positions, const glm::mat4& world, int thing) {
            const auto at = [&](unsigned i) { return glm::dvec3(world * glm::vec4(positions[i], 1.0F)); };
            for (const glm::uvec3& t : triangles) rays.add(at(t.x), at(t.y), at(t.z), thing);
        };
        add(frame.rig->restMesh().triangles, *frame.devicePositions, frame.worldFromDevice, device);
        const glm::dvec2 half = 0.5 * glm::dvec2(frame.installation->tableSize);
        const glm::dvec3 a(-half.x, 0, -half.y), b(-half.x, 0, half.y), c(half.x, 0, half.y), d(half.x, 0, -half.y);
        rays.add(a, b, c, table);
        rays.add(a, c, d, table);
        int thing = firstItem;
        for (const PosedSurface& surface : frame.posed.surfaces)
            add(surface.topology->triangles, *surface.positions, surface.worldFromSurface, thing++);
        rays.build();
        return rays;
    }
    /// The direction in which a pixel looks, in plain pinhole mathematics.
    static glm::dvec3 ray(const CalibratedCamera& camera, int x, int y) {
        const glm::dvec3 local((x - camera.principal.x) / camera.focal.x, (y - camera.principal.y) / camera.focal.y,
                               1.0);
        return glm::normalize(glm::transpose(glm::dmat3(camera.cameraFromWorld)) * local);
    }
    static glm::dvec3 origin(const CalibratedCamera& camera) {
        return -(glm::transpose(glm::dmat3(camera.cameraFromWorld)) * glm::dvec3(camera.cameraFromWorld[3]));
    }

private:
    [[nodiscard]] LinearPicture read() const {
        LinearPicture picture{target_->size(), {}};
        const glm::ivec2 s = picture.size;
        std::vector<glm::vec4> rows(static_cast<std::size_t>(s.x) * static_cast<std::size_t>(s.y));
        glBindFramebuffer(GL_READ_FRAMEBUFFER, target_->framebuffer());
        glReadPixels(0, 0, s.x, s.y, GL_RGBA, GL_FLOAT, rows.data());
        glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
        for (int y = s.y; y-- > 0;)
            picture.pixels.insert(picture.pixels.end(), rows.begin() + static_cast<long>(y) * s.x,
                                  rows.begin() + static_cast<long>(y + 1) * s.x);
        return picture;
    }

    ScenePoser poser_;
    std::optional<ColorTarget> target_;
};

} // namespace lumorph
