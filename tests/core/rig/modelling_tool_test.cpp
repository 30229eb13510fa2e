// What a modelling tool sees of a rig's file, by a reading of the glTF of our own, and what it may give back.
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <functional>
#include <span>
#include <tuple>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/geometry/model.h"
#include "core/rig/rig_file.h"
#include "core/rig/templates/bundled_rigs.h"
#include "core/rig/templates/rig_templates.h"
#include "tests/core/temporary_folder.h"
#include "tests/support/small_rigs.h"

namespace lumorph {
namespace {

using nlohmann::json;

/// The JSON chunk, which stands first in a GLB: magic, version, length; its length, "JSON", its text.
json literalJson(const std::vector<std::byte>& glb) {
    std::uint32_t words[5];
    std::memcpy(words, glb.data(), sizeof words);
    EXPECT_EQ(words[0], 0x46546C67U);
    EXPECT_EQ(words[1], 2U);
    EXPECT_EQ(words[2], glb.size());
    EXPECT_EQ(words[4], 0x4E4F534AU);
    const auto* text = reinterpret_cast<const char*>(glb.data()) + 20;
    return json::parse(text, text + words[3]);
}

glm::vec3 vectorOf(const json& list) { return {list.at(0), list.at(1), list.at(2)}; }
glm::vec3 placeOf(const json& node) {
    return node.contains("translation") ? vectorOf(node["translation"]) : glm::vec3(0.0F);
}

/// The node that states an actuator, and that an empty of this name stands for.
const json* nodeOf(const json& gltf, const std::string& name) {
    for (const json& node : gltf.at("nodes"))
        if (node.value("name", "") == name && node.contains("extras")) return &node;
    return nullptr;
}

/// The arrow from an actuator's node to its child of this name, without a mesh.
glm::vec3 arrowOf(const json& gltf, const json& node, const std::string& what) {
    for (const json& index : node.value("children", json::array())) {
        const json& child = gltf.at("nodes").at(index.get<std::size_t>());
        if (child.value("name", "") != node.value("name", "") + " " + what) continue;
        EXPECT_FALSE(child.contains("mesh") || child.contains("extras"));
        return placeOf(child);
    }
    ADD_FAILURE() << node.value("name", "") << " has no arrow " << what;
    return glm::vec3(1.0F);
}

void expectArrow(const json& gltf, const json& node, const std::string& what, const glm::vec3& along) {
    const glm::vec3 arrow = arrowOf(gltf, node, what);
    EXPECT_GE(glm::length(arrow), 0.0099F) << "too short to be seen";
    EXPECT_NEAR(glm::dot(glm::normalize(arrow), glm::normalize(along)), 1.0, 1e-5) << what;
}

struct SeenActuator {
    const json& gltf;
    const Rig& rig;
    const Actuator& actuator;

    const json& empty() const {
        const json* node = nodeOf(gltf, actuator.name);
        if (node == nullptr) throw std::runtime_error("there is no node " + actuator.name);
        EXPECT_EQ(node->at("extras").at("lumorph").at("actuator"), actuator.name);
        EXPECT_FALSE(node->contains("mesh"));
        return *node;
    }
    void operator()(const Hinge& hinge) const {
        EXPECT_EQ(placeOf(empty()), hinge.origin);
        expectArrow(gltf, empty(), "axis", hinge.axis);
    }
    void operator()(const Bend& bend) const {
        EXPECT_EQ(placeOf(empty()), bend.origin);
        expectArrow(gltf, empty(), "axis", bend.axis);
        expectArrow(gltf, empty(), "direction", bend.direction);
    }
    void operator()(const Slide& slide) const {
        expectArrow(gltf, empty(), "direction", slide.direction);
        Box box;
        for (const Influence& influence : actuator.influences) box.include(rig.restMesh().positions[influence.vertex]);
        const glm::vec3 place = placeOf(empty());
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_GE(place[axis], box.min[axis]) << actuator.name << " stands beside what it moves";
            EXPECT_LE(place[axis], box.max[axis]);
        }
    }
    void operator()(const MorphTarget& morph) const {
        const json& mesh = gltf.at("meshes").at(0);
        const json& names = mesh.at("extras").at("targetNames");
        EXPECT_EQ(names.size(), mesh.at("primitives").at(0).at("targets").size());
        const std::string key = morph.keys.size() == 1 ? actuator.name : actuator.name + " 1";
        EXPECT_THAT(names, testing::Contains(key)) << "a shape key of its name";
    }
    void operator()(const SkinJoint&) const {
        const json* node = nodeOf(gltf, actuator.name);
        ASSERT_NE(node, nullptr) << "a bone of its name";
        const auto index = static_cast<std::size_t>(node - &gltf.at("nodes").at(0));
        EXPECT_THAT(gltf.at("skins").at(0).at("joints"), testing::Contains(index));
    }
    void operator()(const SheetLift&) const {
        EXPECT_THAT(gltf.at("meshes").at(0).at("extras").at("targetNames"), testing::Contains("sheet mode 1"));
    }
};

struct Device {
    std::string name;
    std::function<Rig()> make;
};

std::vector<Device> devices() {
    std::vector<Device> all{{"ribbon", ribbonRig},
                            {"hills", hillsRig},
                            {"arm", test::armRig},
                            {"pushed", test::cushionRig},
                            {"lifter", test::lifterRig}};
    for (const RigTemplate& kind : rigTemplates())
        all.push_back({std::string(kind.name), [&kind] { return rigOf(kind, {}); }});
    return all;
}

class ModellingTool : public testing::TestWithParam<Device> {};

TEST_P(ModellingTool, SeesEachActuatorByItsName) {
    const Rig rig = GetParam().make();
    const json gltf = literalJson(writeRigGlb(rig));
    EXPECT_EQ(gltf.at("asset").at("version"), "2.0");
    std::size_t drawn = 0;
    for (const json& node : gltf.at("nodes")) drawn += node.contains("mesh") ? 1 : 0;
    EXPECT_EQ(drawn, 1U) << "arrows are no part of the device";
    for (const Actuator& actuator : rig.actuators()) {
        SCOPED_TRACE(actuator.name);
        std::visit(SeenActuator{gltf, rig, actuator}, actuator.deformer);
    }
}

TEST_P(ModellingTool, GivesBackTheSameBytes) {
    const std::vector<std::byte> bytes = writeRigGlb(GetParam().make());
    EXPECT_EQ(writeRigGlb(readRigGlb(bytes, "first")), bytes);
}

INSTANTIATE_TEST_SUITE_P(Rigs, ModellingTool, testing::ValuesIn(devices()),
                         [](const auto& device) { return device.param.name; });

/// A cube from -5 to 5 cm whose upper side is raised by one target and pushed by another, hung on two joints.
Model mannequin() {
    Model model;
    model.name = "mannequin";
    const TriangleMesh box = test::boxMesh({-0.05F, 0.0F, -0.05F}, {0.05F, 0.1F, 0.05F});
    Model::Primitive primitive;
    primitive.positions = box.positions;
    primitive.triangles = box.triangles;
    std::vector<glm::vec3> raised(box.positions.size(), glm::vec3(0.0F));
    std::vector<glm::vec3> pushed = raised;
    for (std::size_t v = 0; v < raised.size(); ++v) {
        const bool upper = box.positions[v].y > 0.05F;
        if (upper) raised[v] = {0.0F, 0.03F, 0.0F};
        if (upper) pushed[v] = {0.02F, 0.0F, 0.0F};
        primitive.joints.emplace_back(upper ? 1 : 0, 0, 0, 0);
        primitive.weights.emplace_back(1.0F, 0.0F, 0.0F, 0.0F);
    }
    primitive.morphTargets = {raised, pushed};
    model.meshes.push_back({"body", {primitive}, {"raised", "neck"}, {0.0F, 0.0F}, nullptr});
    model.skins.push_back({"bones", {1, 2}, {glm::mat4(1.0F), glm::mat4(1.0F)}});
    Model::Node body;
    body.name = "body";
    body.mesh = 0;
    body.skin = 0;
    Model::Node hip;
    hip.name = "hip";
    hip.children = {2};
    Model::Node neck;
    neck.name = "neck";
    neck.parent = 1;
    model.nodes = {body, hip, neck};
    model.roots = {0, 1};
    Model::Channel turn;
    turn.node = 2;
    turn.path = Model::Path::rotation;
    turn.times = {0.0F, 1.0F};
    const glm::quat from = glm::angleAxis(glm::radians(-20.0F), glm::vec3(0, 0, 1));
    const glm::quat to = glm::angleAxis(glm::radians(40.0F), glm::vec3(0, 0, 1));
    turn.values = {from.x, from.y, from.z, from.w, to.x, to.y, to.z, to.w};
    model.animations = {{"nod", {turn}}};
    return model;
}

std::filesystem::path save(const Model& model, const std::filesystem::path& file) {
    const std::vector<std::byte> bytes = writeGlb(model);
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    return file;
}

// R4
TEST(ActuatorOffers, AreMorphTargetsAndJointsOfAModelThatStatesNone) {
    const TemporaryFolder folder;
    const auto file = save(mannequin(), folder / "mannequin.glb");
    using Kind = ActuatorOffer::Kind;
    const std::vector<ActuatorOffer> offers = offeredActuators(file);
    EXPECT_THAT(offers, testing::ElementsAre(ActuatorOffer{"raised", Kind::morphTarget},
                                             ActuatorOffer{"neck", Kind::morphTarget},
                                             ActuatorOffer{"neck (joint)", Kind::animatedJoint},
                                             ActuatorOffer{"hip", Kind::jointAtRest}));
    EXPECT_THAT(usualOffers(offers), testing::ElementsAre(0, 1, 2));
    EXPECT_EQ(readRig(file).actuatorCount(), 3U) << "what is taken without being told";
}

TEST(ActuatorOffers, ThoseThatAreTakenAreTheActuators) {
    const TemporaryFolder folder;
    const auto file = save(mannequin(), folder / "mannequin.glb");
    const Rig raised = readRig(file, std::vector<std::size_t>{0});
    ASSERT_EQ(raised.actuatorCount(), 1U);
    EXPECT_EQ(raised.actuators()[0].name, "raised");
    // The joint that was not taken stays as drawn, not where its animation begins.
    EXPECT_NEAR(boundingBox(raised.restMesh().positions).max.x, 0.05, 1e-6);
    EXPECT_NEAR(boundingBox(deformed(raised, std::vector<double>{1.0}).positions).max.y, 0.13, 1e-6);

    // A joint at rest turns by 45 degrees about its X axis: y becomes -z... of the whole body, by hand.
    const Rig hip = readRig(file, std::vector<std::size_t>{3});
    ASSERT_EQ(hip.actuatorCount(), 1U);
    const auto& rest = hip.restMesh().positions;
    const auto turned = deformed(hip, std::vector<double>{1.0}).positions;
    const float half = std::sqrt(0.5F);
    for (std::size_t v = 0; v < rest.size(); ++v) {
        const glm::vec3 p = rest[v];
        const glm::vec3 wanted(p.x, half * (p.y - p.z), half * (p.y + p.z));
        EXPECT_NEAR(glm::distance(turned[v], wanted), 0.0, 1e-6);
    }
    EXPECT_THROW((void)readRig(file, std::vector<std::size_t>{4}), DataError);
    EXPECT_THROW((void)readRig(file, std::vector<std::size_t>{}), DataError);
}

TEST(ActuatorOffers, AreNoneWhereTheFileStatesActuatorsOrIsAFolder) {
    const TemporaryFolder folder;
    Model stated = mannequin();
    stated.nodes[2].extras["lumorph"] = {
        {"actuator", "nod"}, {"deformer", "joint"}, {"axis", {0, 0, 1}}, {"range", {0, 30}}};
    EXPECT_TRUE(offeredActuators(save(stated, folder / "stated.glb")).empty());
    EXPECT_TRUE(offeredActuators(folder.path()).empty());
}

TEST(ActuatorOffers, AMeshInOneStateSaysWhatWouldBeARig) {
    const TemporaryFolder folder;
    std::ofstream(folder / "lamp.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    try {
        (void)offeredActuators(folder / "lamp.obj");
        FAIL();
    } catch (const DataError& error) {
        EXPECT_THAT(error.subject(), testing::HasSubstr("lamp.obj"));
        EXPECT_THAT(error.why(), testing::HasSubstr("one state"));
        EXPECT_THAT(error.remedy(), testing::HasSubstr("folder of one mesh a state"));
    }
}

/// The line of the guide's recipe that holds the property.
std::string propertyOfTheGuide() {
    std::ifstream guide(LUMORPH_SOURCE_DIR "/resources/guide/blender.md");
    for (std::string line; std::getline(guide, line);)
        if (const auto at = line.find(R"({"actuator": "lid")"); at != std::string::npos) return line.substr(at);
    return {};
}

// What the guide says to do in ten steps, as the tool would export it.
TEST(CustomProperty, OfTheGuideMakesALidThatOpens) {
    Model model;
    model.name = "Scene";
    for (const auto& [name, low, high] :
         {std::tuple("Body", glm::vec3(-0.05F, -0.02F, -0.05F), glm::vec3(0.05F, 0, 0.05F)),
          std::tuple("Lid", glm::vec3(0, -0.0025F, -0.05F), glm::vec3(0.1F, 0.0025F, 0.05F))}) {
        const TriangleMesh box = test::boxMesh(low, high);
        Model::Primitive primitive;
        primitive.positions = box.positions;
        primitive.triangles = box.triangles;
        model.meshes.push_back({name, {primitive}, {}, {}, nullptr});
    }
    Model::Node body;
    body.name = "Body";
    body.mesh = 0;
    Model::Node empty;
    empty.name = "Empty";
    empty.translation = {-0.05F, 0.0035F, 0.0F};
    empty.extras["lumorph"] = propertyOfTheGuide();
    empty.children = {2};
    Model::Node lid;
    lid.name = "Lid";
    lid.parent = 1;
    lid.mesh = 1;
    model.nodes = {body, empty, lid};
    model.roots = {0, 1};
    const Rig rig = readRigGlb(writeGlb(model), "lid.glb");
    ASSERT_EQ(rig.actuatorCount(), 1U);
    EXPECT_EQ(rig.actuators()[0].name, "lid");
    EXPECT_EQ(rig.actuators()[0].influences.size(), 8U) << "the lid, not the body";
    const Box open = boundingBox(deformed(rig, std::vector<double>{1.0}).positions);
    const double turn = 80.0 * std::acos(-1.0) / 180.0;
    EXPECT_NEAR(open.max.y, 0.0035 + 0.1 * std::sin(turn) + 0.0025 * std::cos(turn), 1e-6);
    EXPECT_NEAR(open.min.y, -0.02, 1e-7);
}

// The panels of modelling tools take plain texts.
TEST(CustomProperty, MayBeATextInJson) {
    Model model = mannequin();
    model.nodes[2].extras["lumorph"] =
        R"({"actuator": "nod", "deformer": "joint", "axis": [0, 0, 1], "range": [0, 30], "channel": 4})";
    const Rig rig = readRigGlb(writeGlb(model), "text.glb");
    ASSERT_EQ(rig.actuatorCount(), 1U);
    EXPECT_EQ(rig.actuators()[0].name, "nod");
    EXPECT_EQ(rig.actuators()[0].drive.channel, 4);
    model.nodes[2].extras["lumorph"] =
        R"([{"actuator": "nod", "deformer": "joint", "axis": [0, 0, 1], "range": [0, 30]},
        {"actuator": "shake", "deformer": "joint", "axis": [0, 1, 0], "range": [0, 30]}])";
    EXPECT_EQ(readRigGlb(writeGlb(model), "text.glb").actuatorCount(), 2U);
    for (const char* broken : {"{\"actuator\": ", "yes", "", "17"}) {
        model.nodes[2].extras["lumorph"] = broken;
        try {
            (void)readRigGlb(writeGlb(model), "text.glb");
            ADD_FAILURE() << broken;
        } catch (const DataError& error) {
            EXPECT_THAT(error.subject(), testing::HasSubstr("node \"neck\""));
        }
    }
}

} // namespace
} // namespace lumorph
