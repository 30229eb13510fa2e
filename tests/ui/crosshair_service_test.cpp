#include "app/studio/calibration/crosshair_service.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "app/studio/calibration/capture_bench.h"
#include "app/studio/document/scene_edit.h"
#include "calibration/lab/board_lab.h"
#include "calibration/lab/true_room.h"
#include "tests/support/cut_tablet.h"
#include "tests/ui/event_loop.h"

// A projector without a camera: crosshairs laid onto points of the device, without a window.

namespace lumorph::studio {
namespace {

struct CrosshairServiceTest : testing::Test {
    std::shared_ptr<const Rig> rig = std::make_shared<const Rig>(test::cutTablet());
    StudioDocument document;
    QImage onProjector;
    std::size_t lit = 0; ///< number of the projector that was asked last
    std::vector<InstallationVersion> versions;
    CrosshairService service{
        document, [this](std::size_t projector, const QImage& picture) { lit = projector, onProjector = picture; },
        [this](const InstallationVersion& version) {
            versions.push_back(version);
            editInstallation(document, "Calibrate", [&](Installation& room) { room = version.installation; });
            return true;
        }};

    CrosshairServiceTest() { test::needApplication(); }

    void openTablet() {
        document.change("Open", [&](StudioState& state) {
            state.rig.rig = rig;
            Installation& room = installationToEdit(state);
            room.projectors.front().camera = withSize(room.projectors.front().camera, {1920, 1200});
            room.worldFromDevice[3] = glm::vec4(0.03F, 0.0F, -0.02F, 1.0F);
        });
    }
    [[nodiscard]] const Installation& room() const { return *document.state().installation; }
    [[nodiscard]] CalibratedCamera truth() const { return labTruth(room()).projectors.front().camera; }
    [[nodiscard]] glm::dvec3 inWorld(const glm::dvec3& device) const {
        return glm::dvec3(glm::dmat4(room().worldFromDevice) * glm::dvec4(device, 1.0));
    }
    /// As a user whose eye is good to half a pixel, with an error at one point, pixels.
    void aimAll(std::size_t wrong = 99, double error = 0.0) {
        for (std::size_t i = 0; i < service.state().session->crosshairs().size(); ++i) {
            const std::size_t at = service.state().current;
            const cv::Point3d& point = service.state().session->crosshairs()[at].point;
            const auto pixel = pixelOf(truth(), inWorld({point.x, point.y, point.z}));
            ASSERT_TRUE(pixel);
            service.moveTo({std::round(pixel->x) + (at == wrong ? error : 0.0), std::round(pixel->y)});
            if (nextOf(service.state()).what == CrosshairNext::Do::confirm) service.doNext();
        }
    }
    /// The farthest that the true projector's light lands beside on the device, millimetres, when the room's projector
    /// is believed.
    [[nodiscard]] double worstLight() const {
        double worst = 0.0;
        const CalibratedCamera really = truth();
        for (const double stroke : {0.0, 1.0}) {
            const TriangleMesh mesh = deformed(*rig, std::vector<double>(rig->actuatorCount(), stroke));
            for (std::size_t i = 0; i < mesh.positions.size(); i += 5) {
                const glm::dvec3 place = inWorld(glm::dvec3(mesh.positions[i]));
                const auto pixel = pixelOf(room().projectors.front().camera, place);
                if (!pixel) return 1e9;
                const glm::dvec3 way = directionOf(really, *pixel);
                worst = std::max(worst, 1000.0 * glm::length(glm::cross(way, place - positionOf(really))));
            }
        }
        return worst;
    }
};

TEST_F(CrosshairServiceTest, RoundedAimsLightTheDeviceWithinThreeMillimetres) {
    service.setActive(true);
    EXPECT_FALSE(service.state().session);
    EXPECT_TRUE(service.state().trouble.contains("none is open")) << service.state().trouble.toStdString();
    openTablet(); // which it follows
    ASSERT_TRUE(service.state().session) << service.state().trouble.toStdString();
    const std::size_t count = service.state().session->crosshairs().size();
    ASSERT_GE(count, 6U);
    EXPECT_GT(worstLight(), 10.0); // the room has it wrong
    EXPECT_EQ(nextOf(service.state()).button, "This is it, next point");
    EXPECT_EQ(wordsOfPoint(service.state(), 0), "now");
    EXPECT_FALSE(service.sight().isNull());
    for (std::size_t i = 0; i < count; ++i) service.doNext(); // nothing was moved
    EXPECT_NE(nextOf(service.state()).what, CrosshairNext::Do::use);
    service.begin();
    aimAll();
    const CrosshairNext next = nextOf(service.state());
    ASSERT_EQ(next.what, CrosshairNext::Do::use) << next.title.toStdString() << next.text.toStdString();
    ASSERT_TRUE(service.state().millimetres);
    const double told = *service.state().millimetres;
    EXPECT_LT(told, 10.0);
    const Installation before = room();
    service.doNext();
    const InstalledProjector& projector = room().projectors.front();
    EXPECT_EQ(projector.pose.way, Origin::Way::measured);
    EXPECT_EQ(projector.lens.method, "crosshairs, " + std::to_string(count) + " points");
    ASSERT_EQ(versions.size(), 1U);
    EXPECT_LT(worstLight(), 3.0);
    std::printf("  told: within %.2f mm, truly: within %.2f mm\n", told, worstLight());
    EXPECT_EQ(nextOf(service.state()).what, CrosshairNext::Do::nothing);
    document.undoStack().undo();
    EXPECT_EQ(room(), before);
    EXPECT_EQ(nextOf(service.state()).what, CrosshairNext::Do::use);
}

TEST_F(CrosshairServiceTest, APointAimedAtTheWrongCornerIsNamed) {
    openTablet();
    service.setActive(true);
    aimAll(2, 60.0);
    const auto& fits = service.state().session->result()->points;
    EXPECT_TRUE(fits[2].suspicious);
    EXPECT_TRUE(wordsOfPoint(service.state(), 2).startsWith("suspicious"))
        << wordsOfPoint(service.state(), 2).toStdString();
    EXPECT_NE(nextOf(service.state()).tone, CrosshairNext::Tone::good);
    service.setLeftOut(2, true);
    EXPECT_EQ(wordsOfPoint(service.state(), 2), "left out");
    EXPECT_EQ(nextOf(service.state()).what, CrosshairNext::Do::use) << nextOf(service.state()).text.toStdString();
}

TEST_F(CrosshairServiceTest, TheProjectorShowsTheCrosshairWhereItIs) {
    openTablet();
    service.setActive(true);
    EXPECT_TRUE(onProjector.isNull()); // the lab needs none
    service.setLab(false);
    service.moveTo({100.0, 200.0});
    service.moveBy({10.0, -1.0});
    ASSERT_EQ(onProjector.size(), QSize(1920, 1200));
    EXPECT_EQ(onProjector.pixelColor(110, 199), QColor(Qt::white));
    EXPECT_EQ(onProjector.pixelColor(111, 200), QColor(Qt::black));
    EXPECT_EQ(onProjector.pixelColor(0, 199), onProjector.pixelColor(110, 0));
    service.moveTo({-50.0, 4000.0});
    EXPECT_EQ(onProjector.pixelColor(0, 1199), QColor(Qt::white)); // within the picture
    service.setActive(false);
    EXPECT_TRUE(onProjector.isNull()); // the scene is back
}

TEST_F(CrosshairServiceTest, AnotherProjectorShowsItAndGetsTheResult) {
    openTablet();
    editInstallation(document, "Add", [](Installation& room) {
        room.projectors.push_back(room.projectors.front());
        room.projectors.back().camera = withSize(room.projectors.back().camera, {1024, 768});
    });
    const CalibratedCamera aside = labTruth(room(), 1).projectors.front().camera;
    EXPECT_GT(glm::length(positionOf(aside) - positionOf(truth())), 0.3); // another one, at the table's other side
    service.setActive(true);
    service.setLab(false);
    EXPECT_EQ(lit, 0U);
    service.setProjector(1);
    EXPECT_EQ(service.state().aimed(), 0U);
    EXPECT_EQ(lit, 1U);
    EXPECT_EQ(onProjector.size(), QSize(1024, 768));
    service.setLab(true);
    const InstalledProjector first = room().projectors.front();
    for (std::size_t i = 0; i < service.state().session->crosshairs().size(); ++i) {
        const cv::Point3d& point = service.state().session->crosshairs()[service.state().current].point;
        const auto pixel = pixelOf(aside, inWorld({point.x, point.y, point.z}));
        ASSERT_TRUE(pixel);
        service.moveTo({pixel->x, pixel->y});
        if (nextOf(service.state()).what == CrosshairNext::Do::confirm) service.doNext();
    }
    ASSERT_EQ(nextOf(service.state()).what, CrosshairNext::Do::use);
    service.doNext();
    EXPECT_EQ(room().projectors.front(), first);
    EXPECT_LT(glm::length(positionOf(room().projectors.back().camera) - positionOf(aside)), 0.1); // of 2 m
}

} // namespace
} // namespace lumorph::studio
