#include <cstdio>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/geometry/calibrated_camera.h"
#include "tests/app/process.h"
#include "tests/app/workspace.h"
#include "tests/core/temporary_folder.h"

namespace lumorph::test {
namespace {

using ::testing::HasSubstr;

/// A table of exact crosshairs on the points that the program itself proposes.
std::string exactCrosshairs(const CalibratedCamera& projector, std::size_t most) {
    const Outcome proposal = lumorph({"calibrate", "points", cutTabletFile(), "--from", "0.1,1.9,0.4", "--json"});
    EXPECT_EQ(proposal.exitCode, 0) << proposal.err;
    std::ostringstream table;
    table.precision(9);
    table << "x,y,z,u,v,name\n";
    std::size_t count = 0;
    for (const auto& at : proposal.json()["points"]) {
        const glm::dvec3 point(at["point"][0], at["point"][1], at["point"][2]);
        const auto pixel = pixelOf(projector, point);
        if (count++ < most)
            table << point.x << ", " << point.y << ", " << point.z << ", " << pixel->x << ", " << pixel->y << ", "
                  << std::string(at["name"]) << "\n";
    }
    return table.str();
}

TEST(CrosshairCommand, PrintsTheProjectorThatTheCrosshairsCameFrom) {
    const TemporaryFolder folder;
    const CalibratedCamera projector = cameraLookingAt({0.1, 1.9, 0.4}, {0.0, 0.02, 0.0}, {1024, 768}, 2400.0);
    const auto table = folder / "points.csv";
    writeFile(table, exactCrosshairs(projector, 8));
    const Outcome outcome =
        lumorph({"calibrate", "crosshairs", table.string(), "--projector", "1024x768", "--aiming", "0.01", "--json"});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const nlohmann::json result = outcome.json();
    EXPECT_NEAR(result["projector"]["K"][0][0], 2400.0, 3.0);
    EXPECT_EQ(result["projector"]["size"], nlohmann::json({1024, 768}));
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(result["T"][i], projector.cameraFromWorld[3][i], 0.005);
        EXPECT_NEAR(result["R"][i][0], projector.cameraFromWorld[0][i], 0.002);
    }
    EXPECT_LT(result["rms"], 0.01);
    EXPECT_LT(result["error95"], 0.001);
    ASSERT_EQ(result["points"].size(), 8U);
    EXPECT_EQ(result["points"][0]["suspicious"], false);
    const Outcome text =
        lumorph({"calibrate", "crosshairs", "-", "--projector", "1024x768"}, exactCrosshairs(projector, 8));
    EXPECT_EQ(text.exitCode, 0) << text.err;
    EXPECT_THAT(text.out, HasSubstr("focal length"));
}

TEST(CrosshairCommand, RefusesWhatTellsTooLittleAndWhatIsNoTable) {
    const TemporaryFolder folder;
    const CalibratedCamera projector = cameraLookingAt({0.1, 1.9, 0.4}, {0.0, 0.02, 0.0}, {1024, 768}, 2400.0);
    const auto table = folder / "points.csv";
    writeFile(table, exactCrosshairs(projector, 5));
    const Outcome few = lumorph({"calibrate", "crosshairs", table.string(), "--projector", "1024x768", "--json"});
    EXPECT_EQ(few.exitCode, 1);
    EXPECT_EQ(few.json()["refused"]["cause"], "too_few_points");
    writeFile(table, "x,y,z,u,v\n0,0,0,1\n");
    const Outcome broken = lumorph({"calibrate", "crosshairs", table.string(), "--projector", "1024x768"});
    EXPECT_EQ(broken.exitCode, 1);
    EXPECT_THAT(broken.err, HasSubstr("line 2"));
    writeFile(table, "0,0,0,1,nan\n0,0,0,1,2\n0,0,inf,1,2\n");
    EXPECT_THAT(lumorph({"calibrate", "crosshairs", table.string(), "--projector", "1024x768"}).err,
                HasSubstr("line 3"));
    EXPECT_EQ(lumorph({"calibrate", "crosshairs", table.string(), "--projector", "1024"}).exitCode, 2);
}

} // namespace
} // namespace lumorph::test
