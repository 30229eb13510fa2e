#include <cmath>
#include <fstream>
#include <functional>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/geometry/mesh_file.h"
#include "core/geometry/model.h"
#include "core/rig/rig_file.h"
#include "core/rig/templates/bundled_rigs.h"
#include "tests/core/temporary_folder.h"
#include "tests/support/small_rigs.h"

namespace lumorph {
namespace {

using nlohmann::json;

Model validModel() {
    Model model = modelOf(test::boxMesh({0, 0, 0}, {0.1F, 0.1F, 0.1F}), "box");
    model.nodes[0].name = "Flap";
    model.nodes[0].extras["lumorph"] = {
        {"actuator", "flap"}, {"deformer", "hinge"}, {"axis", {0, 0, 1}}, {"range", {0, 90}}};
    return model;
}

struct Broken {
    const char* name;
    const char* message; ///< part of it
    std::function<void(json&)> spoil;
};

class RigFileBrokenEntries : public testing::TestWithParam<Broken> {};

void expectRefused(const std::function<void()>& read, const std::string& subject, const std::string& message) {
    try {
        read();
        FAIL() << "accepted";
    } catch (const DataError& error) {
        EXPECT_NE(error.subject().find(subject), std::string::npos) << error.what();
        EXPECT_NE(error.why().find(message), std::string::npos) << error.what();
        EXPECT_FALSE(error.remedy().empty());
    }
}

TEST_P(RigFileBrokenEntries, NameFileNodeAndRemedy) {
    Model model = validModel();
    ASSERT_NO_THROW((void)readRigGlb(writeGlb(model), "device.glb"));
    GetParam().spoil(model.nodes[0].extras["lumorph"]);
    const auto bytes = writeGlb(model);
    expectRefused([&] { (void)readRigGlb(bytes, "device.glb"); }, "device.glb", GetParam().message);
    expectRefused([&] { (void)readRigGlb(bytes, "device.glb"); }, "node \"Flap\"", GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    RigFile, RigFileBrokenEntries,
    testing::Values(Broken{"NotAnObject", "not an object", [](json& e) { e = "hinge"; }},
                    Broken{"CurveNoList", "\"pulseCurve\"", [](json& e) { e["pulseCurve"] = 3; }},
                    Broken{"CurveFalls", "\"pulseCurve\" does not rise",
                           [](json& e) {
                               e["pulseCurve"] = {0, 0.6, 0.5, 1};
                           }},
                    Broken{"CurveText", "\"pulseCurve\" is not a finite number",
                           [](json& e) {
                               e["pulseCurve"] = {0, "half", 1};
                           }},
                    Broken{"NoName", "\"actuator\" is missing", [](json& e) { e.erase("actuator"); }},
                    Broken{"NameNotText", "not a text", [](json& e) { e["actuator"] = 5; }},
                    Broken{"NoDeformer", "\"deformer\" is missing", [](json& e) { e.erase("deformer"); }},
                    Broken{"UnknownDeformer", "\"twist\" is not known", [](json& e) { e["deformer"] = "twist"; }},
                    Broken{"NoRange", "\"range\" is missing", [](json& e) { e.erase("range"); }},
                    Broken{"RangeBackwards", "backwards",
                           [](json& e) {
                               e["range"] = {90, 0};
                           }},
                    Broken{"RangeEmpty", "empty",
                           [](json& e) {
                               e["range"] = {10, 10};
                           }},
                    Broken{"RangeOfThree", "list of 2",
                           [](json& e) {
                               e["range"] = {0, 1, 2};
                           }},
                    Broken{"NoAxis", "\"axis\" is missing", [](json& e) { e.erase("axis"); }},
                    Broken{"ZeroAxis", "no direction",
                           [](json& e) {
                               e["axis"] = {0, 0, 0};
                           }},
                    Broken{"AxisText", "not a finite number",
                           [](json& e) {
                               e["axis"] = {"x", 0, 0};
                           }},
                    Broken{"HugeAxis", "no direction",
                           [](json& e) {
                               e["axis"] = {1e300, 0, 0};
                           }},
                    Broken{"BendLength", "\"length\" is missing",
                           [](json& e) {
                               e["deformer"] = "bend";
                               e["direction"] = {1, 0, 0};
                           }},
                    Broken{"NotAJoint", "not a joint", [](json& e) { e["deformer"] = "joint"; }},
                    Broken{"NoSuchTarget", "no morph target",
                           [](json& e) {
                               e["deformer"] = "morph";
                               e["target"] = "smile";
                           }},
                    Broken{"FewLevels", "out of range", [](json& e) { e["levels"] = 1; }},
                    Broken{"ManyLevels", "out of range", [](json& e) { e["levels"] = 201; }},
                    Broken{"HalfLevels", "whole number", [](json& e) { e["levels"] = 3.5; }},
                    Broken{"Velocity", "not above zero", [](json& e) { e["maxVelocity"] = 0; }},
                    Broken{"Pulse", "list of 2", [](json& e) { e["pulse"] = 1500; }}),
    [](const auto& kind) { return std::string(kind.param.name); });

TEST(RigFileErrors, WhatOnlyTheWholeRigShows) {
    Model model = validModel();
    model.nodes[0].extras["lumorph"]["damping"] = 0.3;
    expectRefused([&] { (void)readRigGlb(writeGlb(model), "d.glb"); }, "actuator \"flap\"", "oscillate");

    model = validModel();
    const json entry = model.nodes[0].extras["lumorph"];
    model.nodes[0].extras["lumorph"] = json::array({entry, entry});
    expectRefused([&] { (void)readRigGlb(writeGlb(model), "d.glb"); }, "d.glb", "used twice");

    model = validModel();
    model.nodes[0].extras = nullptr;
    expectRefused([&] { (void)readRigGlb(writeGlb(model), "d.glb"); }, "d.glb", "nothing in it moves");
}

TEST(RigFileErrors, InfluencesThatNameNoActuator) {
    for (const float actuator : {1.0F, -2.0F, 0.5F, std::nanf("")}) {
        Model model = validModel();
        auto& primitive = model.meshes[0].primitives[0];
        primitive.custom["_ACTUATORS_0"] = {4, std::vector<float>(4 * primitive.positions.size(), -1.0F)};
        primitive.custom["_INFLUENCES_0"] = {4, std::vector<float>(4 * primitive.positions.size(), 1.0F)};
        ASSERT_NO_THROW((void)readRigGlb(writeGlb(model), "d.glb"));
        primitive.custom["_ACTUATORS_0"].values[5] = actuator;
        EXPECT_THROW((void)readRigGlb(writeGlb(model), "d.glb"), DataError) << actuator;
        primitive.custom["_ACTUATORS_0"].values[5] = 0.0F;
        for (const float weight : {-0.1F, 1.1F, std::nanf("")}) {
            primitive.custom["_INFLUENCES_0"].values[5] = weight;
            EXPECT_THROW((void)readRigGlb(writeGlb(model), "d.glb"), DataError) << weight;
        }
        primitive.custom.erase("_INFLUENCES_0");
        expectRefused([&] { (void)readRigGlb(writeGlb(model), "d.glb"); }, "d.glb", "_INFLUENCES_0");
    }
}

TEST(RigFileErrors, TruncatedFiles) {
    const auto bytes = writeRigGlb(hillsRig());
    for (std::size_t size = 0; size < bytes.size(); size += 997)
        EXPECT_THROW((void)readRigGlb(std::span(bytes).first(size), "cut.glb"), DataError) << size;
}

TEST(RigFolderErrors, NameTheFileAndTheRemedy) {
    const TemporaryFolder folder;
    const TriangleMesh box = test::boxMesh({0, 0, 0}, {0.1F, 0.1F, 0.1F});
    const auto read = [&] { (void)readRig(folder.path()); };
    expectRefused(read, folder.path().string(), "no rest mesh");
    writeMesh(box, folder / "rest.obj");
    expectRefused(read, folder.path().string(), "no states");
    writeMesh(box, folder / "lid_2.obj");
    expectRefused(read, "lid_2.obj", "state 1 of \"lid\" is missing");
    writeMesh(test::boxMesh({0, 0, 0}, {0.1F, 0.1F, 0.1F}, 2), folder / "lid_1.obj");
    expectRefused(read, "lid_1.obj", "not those of the rest mesh");
    writeMesh(box, folder / "lid_1.obj");
    ASSERT_NO_THROW(read());
    writeMesh(box, folder / "lid_1.stl");
    expectRefused(read, "lid_1", "there twice");
    std::filesystem::remove(folder / "lid_1.stl");
    writeMesh(box, folder / "lidx.obj");
    expectRefused(read, "lidx.obj", "not ACTUATOR_KEY");
}

} // namespace
} // namespace lumorph
