#include "core/rig/rig_file.h"

#include <fstream>
#include <functional>
#include <random>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/geometry/mesh_check.h"
#include "core/geometry/mesh_file.h"
#include "core/geometry/model.h"
#include "core/rig/templates/bundled_rigs.h"
#include "tests/core/rig/point_rig.h"
#include "tests/core/temporary_folder.h"
#include "tests/support/cut_tablet.h"
#include "tests/support/small_rigs.h"

namespace lumorph {
namespace {

using nlohmann::json;

Rig crowdedRig() {
    std::vector<Deformer> deformers;
    for (int k = 0; k < 6; ++k) // more influences a vertex than one attribute holds
        deformers.push_back(
            Hinge{{0.01F * k, 0, 0}, {0.1F, 1, 0.3F * k}, Angle::degrees(-7.3 * k), Angle::degrees(33.3)});
    deformers.push_back(MorphTarget{"shape", {0.5F, 1.0F}, {{{}, {0, 0.1F, 0}, {}, {}}, {{}, {0, 0, 0.1F}, {}, {}}}});
    RigParts parts = test::pointParts({{0.1F, 0, 0}, {0, 0.2F, 0}, {0, 0, 0.3F}, {0.1F, 0, 0}}, std::move(deformers));
    parts.actuators[2].influences = {{0, 0.1F}, {3, 0.7F}};
    parts.actuators[3].levels = 12;
    parts.actuators[3].maxVelocity = 0.77;
    parts.actuators[3].dampingRatio = 1.2;
    parts.actuators[4].drive = {9, 544.0, 2400.0};
    return Rig(std::move(parts));
}

struct Kind {
    const char* name;
    std::function<Rig()> make;
};

class RigFileRoundTrips : public testing::TestWithParam<Kind> {};

// R13: a field's file holds its rig; what is read back must be the same device.
TEST_P(RigFileRoundTrips, GiveTheSameRig) {
    const Rig rig = GetParam().make();
    const std::vector<std::byte> bytes = writeRigGlb(rig);
    const Rig read = readRigGlb(bytes, "test");
    EXPECT_EQ(read.name(), rig.name());
    EXPECT_EQ(read.pathInside(), rig.pathInside());
    EXPECT_EQ(read.restMesh().positions, rig.restMesh().positions);
    EXPECT_EQ(read.restMesh().triangles, rig.restMesh().triangles);
    ASSERT_EQ(read.actuatorCount(), rig.actuatorCount());
    for (std::size_t a = 0; a < rig.actuatorCount(); ++a) {
        const Actuator& was = rig.actuators()[a];
        const Actuator& is = read.actuators()[a];
        EXPECT_EQ(is.name, was.name);
        EXPECT_EQ(is.levels, was.levels);
        EXPECT_DOUBLE_EQ(is.maxVelocity, was.maxVelocity);
        EXPECT_EQ(is.dampingRatio, was.dampingRatio);
        EXPECT_EQ(is.drive.channel, was.drive.channel);
        EXPECT_EQ(is.drive.pulseMin, was.drive.pulseMin);
        EXPECT_EQ(is.drive.pulseMax, was.drive.pulseMax);
        EXPECT_EQ(is.deformer.index(), was.deformer.index());
        ASSERT_EQ(is.influences.size(), was.influences.size());
        for (std::size_t i = 0; i < is.influences.size(); ++i) {
            EXPECT_EQ(is.influences[i].vertex, was.influences[i].vertex);
            EXPECT_EQ(is.influences[i].weight, was.influences[i].weight);
        }
        if (const auto* hinge = std::get_if<Hinge>(&was.deformer)) {
            EXPECT_EQ(std::get<Hinge>(is.deformer).origin, hinge->origin);
            EXPECT_EQ(std::get<Hinge>(is.deformer).min, hinge->min);
            EXPECT_EQ(std::get<Hinge>(is.deformer).max, hinge->max);
        }
        if (const auto* morph = std::get_if<MorphTarget>(&was.deformer)) {
            EXPECT_EQ(std::get<MorphTarget>(is.deformer).target, morph->target);
        }
    }
    std::mt19937 random(1);
    for (int state = 0; state < 20; ++state) {
        std::vector<double> strokes(rig.actuatorCount());
        for (double& stroke : strokes) stroke = static_cast<double>(random() % 1001) / 1000.0;
        EXPECT_EQ(deformed(read, strokes).positions, deformed(rig, strokes).positions);
    }
    EXPECT_EQ(writeRigGlb(read), bytes);
}

INSTANTIATE_TEST_SUITE_P(Rigs, RigFileRoundTrips,
                         testing::Values(Kind{"Tablet", [] { return test::cutTablet(); }},
                                         Kind{"PinDisplay", [] { return pinDisplayRig(); }}, Kind{"Ribbon", ribbonRig},
                                         Kind{"Hills", hillsRig}, Kind{"Cushion", test::cushionRig},
                                         Kind{"Arm", test::armRig}, Kind{"Crowded", crowdedRig}),
                         [](const auto& kind) { return std::string(kind.param.name); });

/// As a modelling tool exports it: a cube whose corners are split for normals, a hinge on its node.
Model importedCube() {
    Model model;
    model.name = "cube";
    const TriangleMesh box = test::boxMesh({-0.05F, 0, -0.05F}, {0.05F, 0.1F, 0.05F});
    Model::Primitive primitive;
    for (const glm::uvec3& t : box.triangles) {
        const auto first = static_cast<std::uint32_t>(primitive.positions.size());
        for (int k = 0; k < 3; ++k) primitive.positions.push_back(box.positions[t[k]]);
        primitive.triangles.emplace_back(first, first + 1, first + 2);
    }
    model.meshes.emplace_back();
    model.meshes[0].name = "Cube";
    model.meshes[0].primitives = {primitive};
    Model::Node node;
    node.name = "Flap";
    node.mesh = 0;
    node.translation = {0.2F, 0.0F, 0.0F};
    node.extras["lumorph"] = {{"actuator", "flap"}, {"deformer", "hinge"}, {"axis", {0, 0, 1}},    {"range", {0, 90}},
                              {"maxVelocity", 180}, {"channel", 3},        {"pulse", {600, 2300}}, {"levels", 17}};
    model.nodes = {node};
    model.roots = {0};
    return model;
}

Rig rigOf(const Model& model) { return readRigGlb(writeGlb(model), "model.glb"); }

TEST(RigFile, KeepsTheKindOfServoAndOneThatTheTableLacks) {
    for (const char* servo : {"MG92B", "a servo of tomorrow", ""}) {
        RigParts parts = test::cutTablet().parts();
        parts.actuators[1].drive.servo = servo;
        const auto bytes = writeRigGlb(Rig(parts));
        const Rig read = readRigGlb(bytes, "test");
        EXPECT_EQ(read.actuators()[1].drive, parts.actuators[1].drive);
        EXPECT_EQ(read.actuators()[0].drive.servo, "");
        EXPECT_EQ(writeRigGlb(read), bytes);
    }
    Model model = importedCube();
    model.nodes[0].extras["lumorph"]["servo"] = 90;
    EXPECT_THROW((void)rigOf(model), DataError);
}

// Where a file does not say, the whole range takes a second, whatever its unit and wherever it begins.
TEST(RigFile, WithoutAVelocityTheWholeRangeTakesASecond) {
    struct Case {
        const char* deformer;
        json range;
        double given; ///< velocity in the unit of the range, for half a stroke a second
    };
    for (const Case& one : {Case{"hinge", {0, 90}, 45.0}, Case{"hinge", {-20, 40}, 30.0},
                            Case{"slide", {0.01, 0.05}, 0.02}, Case{"slide", {-0.02, 0.0}, 0.01}}) {
        Model model = importedCube();
        json& extras = model.nodes[0].extras["lumorph"];
        extras.erase("maxVelocity");
        extras["deformer"] = one.deformer;
        extras["direction"] = {0, 1, 0};
        extras["range"] = one.range;
        EXPECT_DOUBLE_EQ(rigOf(model).actuators()[0].maxVelocity, 1.0) << one.deformer << one.range;
        extras["maxVelocity"] = one.given;
        EXPECT_DOUBLE_EQ(rigOf(model).actuators()[0].maxVelocity, 0.5) << one.deformer << one.range;
    }
}

// R4
TEST(RigFile, ReadsAModelAsAModellingToolExportsIt) {
    const Rig rig = rigOf(importedCube());
    EXPECT_EQ(rig.restMesh().positions.size(), 8U); // the split corners are one again
    EXPECT_TRUE(checkMesh(rig.restMesh()).solid());
    ASSERT_EQ(rig.actuatorCount(), 1U);
    const Actuator& flap = rig.actuators()[0];
    EXPECT_EQ(flap.name, "flap");
    EXPECT_EQ(flap.levels, 17);
    EXPECT_DOUBLE_EQ(flap.maxVelocity, 2.0);
    EXPECT_EQ(flap.drive.channel, 3);
    EXPECT_EQ(flap.drive.pulseMax, 2300.0);
    EXPECT_EQ(flap.influences.size(), 8U);
    EXPECT_FALSE(rig.pathInside());
    EXPECT_EQ(std::get<Hinge>(flap.deformer).origin, glm::vec3(0.2F, 0.0F, 0.0F));
    const Box box = boundingBox(deformed(rig, std::vector<double>{1.0}).positions);
    EXPECT_NEAR(box.min.x, 0.1, 1e-6); // the cube's height now points to -x
    EXPECT_NEAR(box.max.x, 0.2, 1e-6);
}

TEST(RigFile, AnInnerHingeTurnsBeforeTheOneAroundIt) {
    Model model = importedCube();
    model.nodes[0].translation = {};
    Model::Node inner = model.nodes[0];
    inner.name = "Inner";
    inner.parent = 0;
    inner.translation = {0.1F, 0.0F, 0.0F};
    inner.extras["lumorph"]["actuator"] = "inner";
    inner.extras["lumorph"]["axis"] = {0, 1, 0};
    model.nodes[0].children = {1};
    model.nodes.push_back(inner);
    const Rig rig = rigOf(model);
    ASSERT_EQ(rig.actuatorCount(), 2U);
    EXPECT_EQ(rig.actuators()[0].name, "inner");
    EXPECT_EQ(rig.actuators()[0].influences.size(), 8U);
    EXPECT_EQ(rig.actuators()[1].influences.size(), 16U);
    const auto moved = deformed(rig, std::vector<double>{1.0, 1.0}).positions;
    for (const Influence& influence : rig.actuators()[0].influences) {
        const glm::vec3 p = rig.restMesh().positions[influence.vertex];
        const glm::vec3 inDevice(0.1F + p.z, p.y, -(p.x - 0.1F)); // about y through (0.1, 0, 0)
        EXPECT_NEAR(glm::distance(moved[influence.vertex], glm::vec3(-inDevice.y, inDevice.x, inDevice.z)), 0.0, 1e-6);
    }
}

TEST(RigFile, MorphTargetsAloneAreActuators) {
    Model model = importedCube();
    model.nodes[0].extras = nullptr;
    Model::Mesh& mesh = model.meshes[0];
    std::vector<glm::vec3> up(mesh.primitives[0].positions.size(), glm::vec3(0.0F));
    for (std::size_t v = 0; v < up.size(); ++v)
        if (mesh.primitives[0].positions[v].y > 0.05F) up[v] = {0.0F, 0.04F, 0.0F};
    mesh.primitives[0].morphTargets = {up};
    mesh.targetNames = {"rise"};
    mesh.weights = {0.0F};
    const Rig rig = rigOf(model);
    ASSERT_EQ(rig.actuatorCount(), 1U);
    EXPECT_EQ(rig.actuators()[0].name, "rise");
    EXPECT_EQ(rig.actuators()[0].influences.size(), 4U);
    EXPECT_NEAR(boundingBox(deformed(rig, std::vector<double>{0.5}).positions).max.y, 0.12, 1e-6);

    // Stated with a range of weights: rest is the lower one.
    mesh.extras["lumorph"] = {
        {{"actuator", "height"}, {"deformer", "morph"}, {"target", "rise"}, {"range", {0.5, 2.0}}}};
    const Rig stated = rigOf(model);
    EXPECT_EQ(stated.actuators()[0].name, "height");
    EXPECT_NEAR(boundingBox(stated.restMesh().positions).max.y, 0.12, 1e-6);
    EXPECT_NEAR(boundingBox(deformed(stated, std::vector<double>{1.0}).positions).max.y, 0.18, 1e-6);
}

/// The ribbon with an animation in place of stated actuators.
Model animatedRibbon(double fromDegrees, double toDegrees) {
    Model model = readGlb(writeRigGlb(ribbonRig()), "ribbon.glb");
    int turned = -1;
    for (std::size_t n = 0; n < model.nodes.size(); ++n)
        if (!std::exchange(model.nodes[n].extras, nullptr).is_null() && turned < 0) turned = static_cast<int>(n);
    // an animated node needs its parts, not a matrix
    model.nodes[turned].translation = glm::vec3((*model.nodes[turned].matrix)[3]);
    model.nodes[turned].matrix.reset();
    Model::Channel channel;
    channel.node = turned;
    channel.path = Model::Path::rotation;
    for (const double degrees : {0.0, toDegrees, fromDegrees}) {
        channel.times.push_back(static_cast<float>(channel.times.size()));
        const glm::quat q = glm::angleAxis(static_cast<float>(glm::radians(degrees)), glm::vec3(0, 0, 1));
        for (const float v : {q.x, q.y, q.z, q.w}) channel.values.push_back(v);
    }
    model.animations = {{"curl", {channel}}};
    return model;
}

// R4: a third kind of device, a glTF's own skin.
TEST(RigFile, AnAnimatedSkinIsARig) {
    const Rig rig = rigOf(animatedRibbon(0.0, 50.0));
    ASSERT_EQ(rig.actuatorCount(), 1U);
    const auto& joint = std::get<SkinJoint>(rig.actuators()[0].deformer);
    EXPECT_NEAR(joint.max - joint.min, glm::radians(50.0), 1e-5);
    EXPECT_EQ(rig.restMesh().positions.size(), ribbonRig().restMesh().positions.size());
    const auto moved = deformed(rig, std::vector<double>{1.0}).positions;
    const auto expected = deformed(ribbonRig(), std::vector<double>{1.0, 0.0, 0.0}).positions;
    for (std::size_t v = 0; v < moved.size(); ++v) EXPECT_NEAR(glm::distance(moved[v], expected[v]), 0.0, 1e-6);
}

TEST(RigFile, RestIsTheLowerEndOfWhatAnAnimationUses) {
    const Rig rig = rigOf(animatedRibbon(-30.0, 40.0));
    ASSERT_EQ(rig.actuatorCount(), 1U);
    const auto& joint = std::get<SkinJoint>(rig.actuators()[0].deformer);
    EXPECT_NEAR(joint.max - joint.min, glm::radians(70.0), 1e-5);
    const Box rest = boundingBox(rig.restMesh().positions);
    const Box full = boundingBox(deformed(rig, std::vector<double>{1.0}).positions);
    EXPECT_LT(rest.min.y, -0.05F); // drooping by 30 degrees at rest, curled up by 40 at the end
    EXPECT_GT(full.max.y, 0.07F);
}

// R4: one mesh per deformation state.
TEST(RigFolder, ReadsOneMeshPerState) {
    const TemporaryFolder folder;
    TriangleMesh mesh = test::boxMesh({0, 0, 0}, {0.1F, 0.02F, 0.1F}, 2);
    writeMesh(mesh, folder / "rest.obj");
    const auto lifted = [&](float height, float from) {
        TriangleMesh state = mesh;
        for (glm::vec3& p : state.positions)
            if (p.y > 0.01F && p.x > from) p.y += height;
        return state;
    };
    writeMesh(lifted(0.01F, 0.06F), folder / "right_side_1.obj");
    writeMesh(lifted(0.05F, 0.06F), folder / "right_side_2.obj");
    writeMesh(lifted(0.03F, -1.0F), folder / "all_1.obj");
    const Rig rig = readRig(folder.path());
    ASSERT_EQ(rig.actuatorCount(), 2U);
    EXPECT_EQ(rig.actuators()[0].name, "all");
    EXPECT_EQ(rig.actuators()[1].name, "right_side");
    EXPECT_NEAR(boundingBox(deformed(rig, std::vector<double>{0.0, 0.5}).positions).max.y, 0.03, 1e-6);
    EXPECT_NEAR(boundingBox(deformed(rig, std::vector<double>{0.0, 0.75}).positions).max.y, 0.05, 1e-6);
    EXPECT_NEAR(boundingBox(deformed(rig, std::vector<double>{1.0, 1.0}).positions).max.y, 0.10, 1e-6);
}

} // namespace
} // namespace lumorph
