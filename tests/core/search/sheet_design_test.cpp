#include "core/search/sheet_design.h"

#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/mdf/library_fit.h"
#include "core/rig/templates/bundled_rigs.h"
#include "core/rig/templates/rig_templates.h"
#include "core/rig/templates/sheet_outline.h"
#include "core/search/sheet_fit.h"

namespace lumorph {
namespace {

SheetDevice page() {
    SheetDevice device;
    device.outline = rectangleOutline(0.21, 0.15);
    return device;
}

std::vector<double> randomPoint(const SheetDesigns& designs, std::mt19937& random) {
    std::uniform_real_distribution<double> share(0.0, 1.0);
    std::vector<double> point(designs.dimension());
    for (double& gene : point) gene = share(random);
    return point;
}

TEST(SheetDesign, IsReadFromTheTablet) {
    const SheetDevice sheet = sheetDeviceOf(cutTabletRig());
    EXPECT_NEAR(sheet.thickness, 0.002, 1e-6);
    EXPECT_NEAR(sheet.housing, 0.016, 1e-6);
    EXPECT_NEAR(sheet.arc, 0.02, 1e-9);
    EXPECT_EQ(sheet.bends.size(), 6U);
    EXPECT_EQ(sheet.bends[4].name, "edge front");
    // The edge flap bends to the front: its line runs along x, the flap on its left seen from above.
    EXPECT_NEAR(sheet.bends[4].from.y, sheet.bends[4].to.y, 1e-5);
    EXPECT_LT(sheet.bends[4].to.x, sheet.bends[4].from.x);
}

TEST(SheetDesign, OfAContinuousTopHasItsLinesCut) {
    const SheetDevice sheet = sheetDeviceOf(bakedTablet());
    EXPECT_EQ(sheet.top, SheetTop::cut);
    EXPECT_EQ(sheet.bends.size(), 6U);
    EXPECT_EQ(sheet.outline.size(), 4U);
}

TEST(SheetDesign, OfABlankSheetHasItsOutline) {
    const SheetDevice sheet = sheetDeviceOf(rigOf(rigTemplate("sheet"), {}));
    ASSERT_EQ(sheet.outline.size(), 4U);
    for (const glm::dvec2& p : sheet.outline) {
        EXPECT_NEAR(std::abs(p.x), 0.105, 1e-6);
        EXPECT_NEAR(std::abs(p.y), 0.075, 1e-6);
    }
    EXPECT_TRUE(sheet.bends.empty());
}

TEST(SheetDesign, RefusesWhatIsNoSheet) {
    EXPECT_THROW((void)sheetDeviceOf(pinDisplayRig()), InvalidInput);
    EXPECT_THROW((void)sheetDeviceOf(cushionRig()), InvalidInput);
    EXPECT_THROW((void)sheetDeviceOf(rigOf(rigTemplate("flower"), {})), InvalidInput);
    RigParts peak; // nothing of it is level
    peak.name = "peak";
    peak.restMesh.positions = {{0, 0, 0}, {0.1F, 0, 0}, {0, 0, 0.1F}, {0.03F, 0.1F, 0.03F}};
    peak.restMesh.triangles = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
    EXPECT_THROW((void)sheetDeviceOf(Rig(std::move(peak))), InvalidInput);
    EXPECT_THROW(SheetDesigns(page(), 0), InvalidInput);
    EXPECT_THROW(SheetDesigns(page(), 65), InvalidInput);
}

TEST(SheetDesign, OfARigGivesItsFlapsBack) {
    SheetDevice device = page();
    device.bends = {{"corner", {-0.105, -0.02}, {-0.04, -0.075}},
                    {"tongue", {0.0, 0.02}, {0.06, 0.02}, BendLine::Ends::free, BendLine::Side::left}};
    const Rig rig = sheetRig(device);
    const SheetDevice again = sheetDeviceOf(rig);
    const SheetDesigns designs(again, 4);
    const std::vector<Flap> flaps = designs.flapsOf(designs.pointOf(again));
    std::vector<glm::dvec2> page;
    for (const glm::dvec2& p : device.outline) page.push_back(pageOf(p));
    const std::vector<Flap> drawn = layOutFlaps(page, device.bends, flapClearance(device));
    ASSERT_EQ(flaps.size(), 2U);
    for (std::size_t f = 0; f < 2; ++f) {
        const auto area = [](const Flap& flap) {
            double sum = 0.0;
            for (std::size_t k = 0; k + 1 < flap.rim.size(); ++k)
                sum += 0.5 * (flap.rim[k].y + flap.rim[k + 1].y) * (flap.rim[k + 1].x - flap.rim[k].x);
            return sum;
        };
        EXPECT_NEAR(area(flaps[f]), area(drawn[f]), 0.02 * area(drawn[f]));
        EXPECT_LT(glm::distance(flaps[f].frame.across, drawn[f].frame.across), 1e-3);
    }
}

TEST(SheetDesign, LeavesOutLinesWithoutRoom) {
    const SheetDesigns designs(page(), 6);
    std::mt19937 random(3);
    std::size_t most = 0;
    for (int k = 0; k < 200; ++k) {
        const std::vector<double> point = randomPoint(designs, random);
        const std::vector<Flap> flaps = designs.flapsOf(point);
        const SheetDevice device = designs.deviceOf(point);
        ASSERT_EQ(device.bends.size(), flaps.size());
        most = std::max(most, flaps.size());
    }
    EXPECT_GE(most, 3U);
}

/// The fit of the true solid, matched in voxels.
TEST(SheetFit, IsThatOfTheTrueVolume) {
    const SheetDesigns designs(page(), 4);
    std::vector<LibraryTarget> library;
    std::vector<Target> targets;
    std::mt19937 random(5);
    for (int t = 0; t < 3; ++t) { // poses of other designs
        const Rig rig = sheetRig(designs.deviceOf(randomPoint(designs, random)));
        std::vector<double> strokes(rig.actuatorCount(), 0.7);
        Target target = makeTarget(deformed(rig, strokes));
        library.push_back({"pose", target, boundingBox(target.mesh.positions)});
        targets.push_back(std::move(target));
    }
    const SheetFit fit(designs.sheet(), designs.angle(), targets, {});
    int compared = 0;
    while (compared < 4) {
        const std::vector<double> point = randomPoint(designs, random);
        const std::vector<Flap> flaps = designs.flapsOf(point);
        if (flaps.size() < 2) continue;
        ++compared;
        LibraryFitOptions options;
        options.placing = TargetPlacing::asIs;
        const Rig rig = sheetRig(designs.deviceOf(point));
        options.space = rig.reach();
        for (const LibraryTarget& target : library) options.space.include(target.box);
        const LibraryFit truth = LibraryMatcher(rig, library, options).fit();
        const std::vector<double> quick = fit.each(flaps);
        for (std::size_t t = 0; t < 3; ++t) EXPECT_NEAR(quick[t], truth.targets[t].iou, 0.03) << compared << " " << t;
        EXPECT_NEAR(fit.of(flaps).fit, truth.mean, 0.02);
    }
}

TEST(SheetFit, RefusesTargetsBelowTheSheet) {
    const SheetDesigns designs(page(), 4);
    EXPECT_THROW(SheetFit(designs.sheet(), designs.angle(), {}, {}), InvalidInput);
}

} // namespace
} // namespace lumorph
