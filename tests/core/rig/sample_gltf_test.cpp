#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/matrix.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/geometry/mesh_file.h"
#include "core/rig/rig_file.h"
#include "tests/support/gltf_builder.h"

// Models as the sample collections of glTF have them, each written here byte by byte, opened as rigs. What they have to
// look like is worked out beside them from glTF's own formulas.

namespace lumorph {
namespace {

using nlohmann::json;
using support::GltfBuilder;
using testing::HasSubstr;
using Corners = std::vector<glm::dvec3>; ///< three a triangle

Rig rigOf(const GltfBuilder& builder) { return readRigGlb(builder.glb(), "sample.glb"); }

Corners cornersOf(const Rig& rig, const std::vector<double>& strokes) {
    const TriangleMesh mesh = deformed(rig, strokes);
    Corners corners;
    for (const glm::uvec3& t : mesh.triangles)
        for (int k = 0; k < 3; ++k) corners.emplace_back(mesh.positions[t[k]]);
    return corners;
}

void expectNear(const Corners& is, const Corners& expected, double tolerance = 2e-6) {
    ASSERT_EQ(is.size(), expected.size());
    for (std::size_t k = 0; k < is.size(); ++k)
        EXPECT_LT(glm::distance(is[k], expected[k]), tolerance)
            << k << ": " << is[k].x << " " << is[k].y << " " << is[k].z << " instead of " << expected[k].x << " "
            << expected[k].y << " " << expected[k].z;
}

double volumeOf(const Corners& corners) {
    double volume = 0.0;
    for (std::size_t k = 0; k + 2 < corners.size(); k += 3)
        volume += glm::dot(corners[k], glm::cross(corners[k + 1], corners[k + 2])) / 6.0;
    return volume;
}

void expectRefused(const GltfBuilder& builder, const std::vector<std::string>& parts) {
    try {
        (void)rigOf(builder);
        FAIL() << "opened";
    } catch (const DataError& error) {
        EXPECT_THAT(error.what(), HasSubstr("sample.glb"));
        EXPECT_FALSE(error.remedy().empty());
        for (const std::string& part : parts) EXPECT_THAT(error.what(), HasSubstr(part));
    }
}

std::vector<float> listOf(const glm::dmat4& matrix) {
    const glm::mat4 floats(matrix);
    return {glm::value_ptr(floats), glm::value_ptr(floats) + 16};
}
json listOf(const glm::dquat& turn) { return {turn.x, turn.y, turn.z, turn.w}; }

/// A square column of `rings` rings, one a decimetre, along z; closed at both ends.
struct Column {
    std::vector<glm::dvec3> points;
    std::vector<std::uint16_t> indices;

    explicit Column(int rings = 5) {
        for (int r = 0; r < rings; ++r)
            for (const auto& [x, y] : {std::pair{-0.05, -0.05}, {0.05, -0.05}, {0.05, 0.05}, {-0.05, 0.05}})
                points.emplace_back(x, y, 0.1 * r);
        const auto quad = [&](int a, int b, int c, int d) {
            for (const int k : {a, b, c, a, c, d}) indices.push_back(static_cast<std::uint16_t>(k));
        };
        for (int r = 0; r + 1 < rings; ++r)
            for (int k = 0; k < 4; ++k) quad(4 * r + k, 4 * r + (k + 1) % 4, 4 * r + 4 + (k + 1) % 4, 4 * r + 4 + k);
        quad(3, 2, 1, 0);
        const int top = 4 * (rings - 1);
        quad(top, top + 1, top + 2, top + 3);
    }
    [[nodiscard]] std::vector<float> floats() const {
        std::vector<float> all;
        for (const glm::dvec3& p : points)
            for (int k = 0; k < 3; ++k) all.push_back(static_cast<float>(p[k]));
        return all;
    }
    [[nodiscard]] Corners corners(const std::function<glm::dvec3(std::size_t)>& place) const {
        Corners all;
        for (const std::uint16_t k : indices) all.push_back(place(k));
        return all;
    }
};

/// How much of a point follows the upper bone: as smooth as RiggedSimple's.
double upperShare(const glm::dvec3& p) { return std::clamp((p.z - 0.1) / 0.2, 0.0, 1.0); }

constexpr double kBone = 0.2; ///< from the lower bone to the upper one
constexpr double kTurn = 1.2; ///< radians, of the upper bone's animation

/// RiggedSimple: a column bent by the upper of two bones, lying in a scene whose up is z.
struct RiggedSimple {
    Column column;
    GltfBuilder builder;
    glm::dmat4 root = glm::mat4_cast(glm::angleAxis(-0.5 * std::numbers::pi, glm::dvec3(1, 0, 0)));

    RiggedSimple() {
        json& document = builder.document;
        const glm::dvec3 down(0.0, 0.0, -kBone);
        std::vector<float> bind = listOf(glm::dmat4(1.0));
        for (const float value : listOf(glm::translate(glm::dmat4(1.0), down))) bind.push_back(value);
        document["skins"] = {
            {{"joints", {3, 4}}, {"skeleton", 3}, {"inverseBindMatrices", builder.floats(bind, "MAT4")}}};
        document["nodes"] = {{{"name", "Z_UP"}, {"children", {1}}, {"matrix", listOf(root)}},
                             {{"name", "Armature"}, {"children", {3, 2}}},
                             // Where a skinned mesh's node stands is of no account.
                             {{"name", "Cylinder"}, {"mesh", 0}, {"skin", 0}, {"translation", {7, 8, 9}}},
                             {{"name", "Bone"}, {"children", {4}}},
                             {{"name", "Bone.001"}, {"translation", {0, 0, kBone}}}};
        document["meshes"] = {{{"primitives",
                                {{{"attributes", {{"POSITION", builder.floats(column.floats(), "VEC3")}}},
                                  {"indices", builder.accessor(column.indices, "SCALAR", 5123)}}}}}};
        std::vector<float> turns;
        for (const double angle : {0.0, kTurn}) {
            const glm::dquat q = glm::angleAxis(angle, glm::dvec3(1, 0, 0));
            for (const double v : {q.x, q.y, q.z, q.w}) turns.push_back(static_cast<float>(v));
        }
        document["animations"] = {
            {{"channels", {{{"sampler", 0}, {"target", {{"node", 4}, {"path", "rotation"}}}}}},
             {"samplers", {{{"input", builder.floats({0, 2}, "SCALAR")}, {"output", builder.floats(turns, "VEC4")}}}}}};
    }
    json& attributes() { return builder.primitive()["attributes"]; }

    RiggedSimple& withFloatWeights() {
        std::vector<std::uint16_t> joints;
        std::vector<float> weights;
        for (const glm::dvec3& p : column.points) {
            const auto share = static_cast<float>(upperShare(p));
            joints.insert(joints.end(), {0, 1, 0, 0});
            weights.insert(weights.end(), {1.0F - share, share, 0.0F, 0.0F});
        }
        attributes()["JOINTS_0"] = builder.accessor(joints, "VEC4", 5123);
        attributes()["WEIGHTS_0"] = builder.floats(weights, "VEC4");
        return *this;
    }

    /// SUM of weight x joint x inverse bind x p, as the specification has it.
    [[nodiscard]] glm::dvec3 at(const glm::dvec3& p, double angle, double share) const {
        const glm::dmat4 bone = glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, 0.0, kBone)) *
                                glm::mat4_cast(glm::angleAxis(angle, glm::dvec3(1, 0, 0)));
        const glm::dmat4 unbound = glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, 0.0, -kBone));
        return glm::dvec3(root * ((1.0 - share) * glm::dvec4(p, 1.0) + share * (bone * unbound * glm::dvec4(p, 1.0))));
    }
    [[nodiscard]] Corners at(double angle) const {
        return column.corners([&](std::size_t k) { return at(column.points[k], angle, upperShare(column.points[k])); });
    }
};

void expectBendsLike(const RiggedSimple& sample, double tolerance = 2e-6) {
    const Rig rig = rigOf(sample.builder);
    ASSERT_EQ(rig.actuatorCount(), 1U);
    EXPECT_EQ(rig.actuators()[0].name, "Bone.001");
    for (const double stroke : {0.0, 0.3, 1.0})
        expectNear(cornersOf(rig, {stroke}), sample.at(stroke * kTurn), tolerance);
    EXPECT_GT(volumeOf(cornersOf(rig, {0.5})), 0.003); // outside is outside
}

TEST(SampleGltf, RiggedSimpleBendsAsItsBonesSay) { expectBendsLike(RiggedSimple().withFloatWeights()); }

TEST(SampleGltf, WeightsInNormalizedBytesAreShares) {
    RiggedSimple sample;
    std::vector<std::uint8_t> joints;
    std::vector<std::uint8_t> weights;
    for (const glm::dvec3& p : sample.column.points) {
        const auto share = static_cast<std::uint8_t>(std::lround(255.0 * upperShare(p)));
        joints.insert(joints.end(), {0, 1, 0, 0});
        weights.insert(weights.end(), {static_cast<std::uint8_t>(255 - share), share, 0, 0});
    }
    sample.attributes()["JOINTS_0"] = sample.builder.accessor(joints, "VEC4", 5121);
    sample.attributes()["WEIGHTS_0"] = sample.builder.accessor(weights, "VEC4", 5121);
    sample.builder.document["accessors"].back()["normalized"] = true;
    expectBendsLike(sample, 1e-3); // half of 1/255 of what is moved by 0.3 m
}

TEST(SampleGltf, InterleavedVerticesAreTakenApart) {
    RiggedSimple sample;
    std::vector<std::byte> vertices;
    const auto put = [&](const auto& value) {
        const auto bytes = std::as_bytes(std::span(&value, 1));
        vertices.insert(vertices.end(), bytes.begin(), bytes.end());
    };
    for (const glm::dvec3& p : sample.column.points) { // 12 + 4 + 16 bytes
        put(glm::vec3(p));
        put(std::array<std::uint8_t, 4>{0, 1, 0, 0});
        const auto share = static_cast<float>(upperShare(p));
        put(glm::vec4(1.0F - share, share, 0.0F, 0.0F));
    }
    const int view = sample.builder.view(vertices.data(), vertices.size());
    json& document = sample.builder.document;
    document["bufferViews"][static_cast<std::size_t>(view)]["byteStride"] = 32;
    const auto part = [&](const char* name, int offset, int component, const char* type) {
        sample.attributes()[name] = document["accessors"].size();
        document["accessors"].push_back({{"bufferView", view},
                                         {"byteOffset", offset},
                                         {"componentType", component},
                                         {"count", sample.column.points.size()},
                                         {"type", type}});
    };
    part("POSITION", 0, 5126, "VEC3");
    part("JOINTS_0", 12, 5121, "VEC4");
    part("WEIGHTS_0", 16, 5126, "VEC4");
    expectBendsLike(sample);
}

TEST(SampleGltf, SkinWithoutInverseBindMatricesIsDrawnInItsJoints) {
    RiggedSimple sample;
    std::vector<std::uint8_t> joints;
    std::vector<float> weights;
    const auto isUpper = [](const glm::dvec3& p) { return p.z > 0.15; };
    for (const glm::dvec3& p : sample.column.points) {
        joints.insert(joints.end(), {static_cast<std::uint8_t>(isUpper(p)), 0, 0, 0});
        weights.insert(weights.end(), {1, 0, 0, 0});
    }
    sample.attributes()["JOINTS_0"] = sample.builder.accessor(joints, "VEC4", 5121);
    sample.attributes()["WEIGHTS_0"] = sample.builder.floats(weights, "VEC4");
    sample.builder.document["skins"][0].erase("inverseBindMatrices");
    const Rig rig = rigOf(sample.builder);
    for (const double stroke : {0.0, 0.5, 1.0})
        expectNear(cornersOf(rig, {stroke}), sample.column.corners([&](std::size_t k) {
            // As `RiggedSimple::at`, with points that are drawn from the bone on.
            const glm::dvec3& p = sample.column.points[k];
            return isUpper(p) ? sample.at(p + glm::dvec3(0, 0, kBone), stroke * kTurn, 1.0) : sample.at(p, 0.0, 0.0);
        }));
}

// The whole armature mirrored, as a modelling tool leaves it behind.
TEST(SampleGltf, NegativeScaleOfASkeletonKeepsTheOutsideOutside) {
    for (const glm::dvec3 scale : {glm::dvec3(-1.0), glm::dvec3(-1, 1, 1), glm::dvec3(1, -1, 1)}) {
        RiggedSimple sample;
        sample.withFloatWeights();
        sample.root = glm::scale(sample.root, scale);
        sample.builder.document["nodes"][0]["matrix"] = listOf(sample.root);
        const Rig rig = rigOf(sample.builder);
        for (const double stroke : {0.0, 0.4, 1.0}) {
            Corners expected = sample.at(stroke * kTurn);
            for (std::size_t k = 0; k < expected.size(); k += 3) std::swap(expected[k + 1], expected[k + 2]);
            expectNear(cornersOf(rig, {stroke}), expected);
        }
        EXPECT_GT(volumeOf(cornersOf(rig, {0.5})), 0.003);
    }
}

TEST(SampleGltf, UnevenScaleOfABoneIsRefusedByName) {
    RiggedSimple sample;
    sample.withFloatWeights();
    sample.builder.document["nodes"][4]["scale"] = {1, 2, 1};
    expectRefused(sample.builder, {"scaled unevenly", "apply the scale"});
}

TEST(SampleGltf, SkinThatNothingAnimatesSaysWhatIsMissing) {
    RiggedSimple sample;
    sample.withFloatWeights();
    sample.builder.document.erase("animations");
    expectRefused(sample.builder, {"nothing in it moves", "animated skin"});
}

/// SimpleMorph: a triangle whose top goes two ways.
struct SimpleMorph {
    GltfBuilder builder = GltfBuilder::triangle();
    Corners rest{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    std::array<Corners, 2> moved{Corners{{0, 0, 0}, {0, 0, 0}, {-1, 1, 0}}, Corners{{0, 0, 0}, {0, 0, 0}, {1, 1, 0.5}}};

    SimpleMorph() {
        json targets = json::array();
        for (const Corners& target : moved) {
            std::vector<float> floats;
            for (const glm::dvec3& d : target)
                for (int k = 0; k < 3; ++k) floats.push_back(static_cast<float>(d[k]));
            targets.push_back({{"POSITION", builder.floats(floats, "VEC3")}});
        }
        builder.primitive()["targets"] = targets;
        builder.document["meshes"][0]["weights"] = {0.5, 0.5};
    }
    [[nodiscard]] Corners at(double a, double b) const {
        Corners corners = rest;
        for (std::size_t k = 0; k < 3; ++k) corners[k] += a * moved[0][k] + b * moved[1][k];
        return corners;
    }
};

TEST(SampleGltf, SimpleMorphHasAnActuatorForEachTarget) {
    const SimpleMorph sample;
    const Rig rig = rigOf(sample.builder);
    ASSERT_EQ(rig.actuatorCount(), 2U);
    EXPECT_NE(rig.actuators()[0].name, rig.actuators()[1].name);
    for (const auto& [a, b] : {std::pair{0.0, 0.0}, {0.5, 0.5}, {1.0, 0.0}, {0.25, 1.0}})
        expectNear(cornersOf(rig, {a, b}), sample.at(a, b));
}

TEST(SampleGltf, SparseMorphTargetMovesOnlyWhatItNames) {
    SimpleMorph sample;
    const std::vector<std::uint8_t> which{2};
    const std::vector<float> values{-1, 1, 0};
    json& document = sample.builder.document;
    document["accessors"].push_back(
        {{"componentType", 5126},
         {"count", 3},
         {"type", "VEC3"},
         {"sparse",
          {{"count", 1},
           {"indices", {{"bufferView", sample.builder.view(which.data(), 1)}, {"componentType", 5121}}},
           {"values", {{"bufferView", sample.builder.view(values.data(), 12)}}}}}});
    sample.builder.primitive()["targets"][0]["POSITION"] = document["accessors"].size() - 1;
    const Rig rig = rigOf(sample.builder);
    for (const auto& [a, b] : {std::pair{0.0, 0.0}, {1.0, 0.0}, {0.25, 1.0}})
        expectNear(cornersOf(rig, {a, b}), sample.at(a, b));
    EXPECT_EQ(rig.verticesOf(0).size(), 1U);
}

/// SimpleSparseAccessor: a strip of 14 points, three of which are moved by a sparse accessor.
TEST(SampleGltf, SimpleSparseAccessorHasItsPointsReplaced) {
    GltfBuilder builder;
    std::vector<float> points;
    for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 7; ++x) points.insert(points.end(), {static_cast<float>(x), static_cast<float>(y), 0});
    std::vector<std::uint16_t> indices;
    for (std::uint16_t k = 0; k < 6; ++k)
        for (const int c : {0, 8, 7, 0, 1, 8}) indices.push_back(static_cast<std::uint16_t>(k + c));
    const std::vector<std::uint16_t> which{8, 10, 12};
    const std::vector<float> values{1, 2, 0, 3, 3, 0, 5, 4, 0};
    const int positions = builder.floats(points, "VEC3");
    builder.document["accessors"][static_cast<std::size_t>(positions)]["sparse"] = {
        {"count", 3},
        {"indices", {{"bufferView", builder.view(which.data(), 6)}, {"componentType", 5123}}},
        {"values", {{"bufferView", builder.view(values.data(), 36)}}}};
    builder.document["meshes"] = {
        {{"primitives",
          {{{"attributes", {{"POSITION", positions}}}, {"indices", builder.accessor(indices, "SCALAR", 5123)}}}}}};
    builder.document["nodes"] = {{{"name", "strip"}, {"mesh", 0}}};
    expectRefused(builder, {"nothing in it moves", "\"lumorph\""});
    builder.document["nodes"][0]["extras"]["lumorph"] = {
        {"actuator", "lift"}, {"deformer", "slide"}, {"direction", {0, 0, 1}}, {"range", {0, 0.5}}};
    for (int k = 0; k < 3; ++k)
        for (int c = 0; c < 3; ++c) points[3 * which[k] + c] = values[3 * k + c];
    Corners expected;
    for (const std::uint16_t k : indices)
        expected.emplace_back(points[3 * k], points[3 * k + 1], points[3 * k + 2] + 0.5);
    expectNear(cornersOf(rigOf(builder), {1.0}), expected);
}

/// Each scene has a flap of its own; `scene` names the one that is meant.
TEST(SampleGltf, OfSeveralScenesTheDefaultOneIsTheRig) {
    SimpleMorph sample;
    json& document = sample.builder.document;
    document["nodes"] = {{{"name", "first"}, {"mesh", 0}},
                         {{"name", "second"}, {"mesh", 0}, {"translation", {0, 0, 4}}}};
    document["scenes"] = {{{"nodes", {0}}}, {{"name", "other"}, {"nodes", {1}}}};
    const auto expectAt = [&](double z) {
        Corners expected = sample.at(1.0, 0.0);
        for (glm::dvec3& p : expected) p.z += z;
        const Rig rig = rigOf(sample.builder);
        ASSERT_EQ(rig.actuatorCount(), 2U);
        expectNear(cornersOf(rig, {1.0, 0.0}), expected);
    };
    document["scene"] = 1;
    expectAt(4.0);
    document["scene"] = 0;
    expectAt(0.0);
    document.erase("scene"); // then the first
    expectAt(0.0);
    document["scene"] = 2;
    expectRefused(sample.builder, {"there is no scene 2"});
}

TEST(SampleGltf, SkinOfAnotherSceneIsNoActuator) {
    RiggedSimple sample;
    sample.withFloatWeights();
    json& document = sample.builder.document;
    const int flat = sample.builder.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    const int up = sample.builder.floats({0, 0, 0, 0, 0, 0, 0, 0, 1}, "VEC3");
    document["meshes"].push_back(
        {{"primitives", {{{"attributes", {{"POSITION", flat}}}, {"targets", {{{"POSITION", up}}}}}}}});
    document["nodes"].push_back({{"name", "flag"}, {"mesh", 1}});
    document["scenes"] = {{{"nodes", {5}}}, {{"nodes", {0}}}};
    const Rig rig = rigOf(sample.builder);
    ASSERT_EQ(rig.actuatorCount(), 1U);
    expectNear(cornersOf(rig, {1.0}), {{0, 0, 0}, {1, 0, 0}, {0, 1, 1}});
    document["scene"] = 1;
    expectBendsLike(sample);
}

/// A box of eight corners in the way of NegativeScaleTest, with one target that lifts its top.
struct LiftedBox {
    GltfBuilder builder;
    Column box{2};

    LiftedBox() {
        std::vector<float> lift;
        for (const glm::dvec3& p : box.points) lift.insert(lift.end(), {0.0F, 0.0F, p.z > 0.05 ? 0.04F : 0.0F});
        builder.document["meshes"] = {{{"primitives",
                                        {{{"attributes", {{"POSITION", builder.floats(box.floats(), "VEC3")}}},
                                          {"indices", builder.accessor(box.indices, "SCALAR", 5123)},
                                          {"targets", {{{"POSITION", builder.floats(lift, "VEC3")}}}}}}}}};
        builder.document["nodes"] = {{{"name", "box"}, {"mesh", 0}}};
    }
    [[nodiscard]] glm::dvec3 at(std::size_t k, double stroke) const {
        return box.points[k] + glm::dvec3(0.0, 0.0, box.points[k].z > 0.05 ? 0.04 * stroke : 0.0);
    }
};

TEST(SampleGltf, NegativeScaleTurnsTrianglesSoThatTheOutsideStaysOutside) {
    struct Scale {
        glm::dvec3 scale;
        bool mirrors;
    };
    for (const Scale& s : {Scale{{-1, 1, 1}, true}, Scale{{1, -2, 1}, true}, Scale{{-1, -1, 1}, false},
                           Scale{{-0.5, -0.5, -0.5}, true}, Scale{{1, 3, 1}, false}}) {
        LiftedBox sample;
        sample.builder.document["nodes"] = {
            {{"name", "turned"},
             {"children", {1}},
             {"rotation", listOf(glm::angleAxis(0.7, glm::dvec3(0.6, 0.0, 0.8)))}},
            {{"name", "box"}, {"mesh", 0}, {"scale", {s.scale.x, s.scale.y, s.scale.z}}, {"translation", {0.3, 0, 0}}}};
        const Rig rig = rigOf(sample.builder);
        for (const double stroke : {0.0, 0.5, 1.0}) {
            Corners expected = sample.box.corners([&](std::size_t k) {
                return glm::angleAxis(0.7, glm::dvec3(0.6, 0.0, 0.8)) *
                       (s.scale * sample.at(k, stroke) + glm::dvec3(0.3, 0.0, 0.0));
            });
            if (s.mirrors)
                for (std::size_t k = 0; k < expected.size(); k += 3) std::swap(expected[k + 1], expected[k + 2]);
            expectNear(cornersOf(rig, {stroke}), expected);
            const double size = std::abs(s.scale.x * s.scale.y * s.scale.z);
            EXPECT_NEAR(volumeOf(cornersOf(rig, {stroke})), size * 0.01 * (0.1 + 0.04 * stroke), 1e-8);
        }
    }
}

TEST(SampleGltf, MeshWithoutIndicesClosesAgain) {
    LiftedBox sample;
    std::vector<float> points;
    std::vector<float> lift;
    for (const std::uint16_t k : sample.box.indices) {
        const glm::dvec3& p = sample.box.points[k];
        for (int c = 0; c < 3; ++c) points.push_back(static_cast<float>(p[c]));
        lift.insert(lift.end(), {0.0F, 0.0F, p.z > 0.05 ? 0.04F : 0.0F});
    }
    json& primitive = sample.builder.primitive();
    primitive.erase("indices");
    primitive["attributes"]["POSITION"] = sample.builder.floats(points, "VEC3");
    primitive["targets"][0]["POSITION"] = sample.builder.floats(lift, "VEC3");
    const Rig rig = rigOf(sample.builder);
    EXPECT_EQ(rig.restMesh().positions.size(), 8U);
    expectNear(cornersOf(rig, {1.0}), sample.box.corners([&](std::size_t k) { return sample.at(k, 1.0); }));
}

TEST(SampleGltf, StripsAndFansAreTheirTriangles) {
    struct Mode {
        int mode;
        std::vector<std::uint8_t> indices;
        std::vector<std::array<std::size_t, 3>> triangles;
    };
    // The column's first ring and second ring are corners 0 to 3 and 4 to 7.
    for (const Mode& mode :
         {Mode{5, {0, 1, 4, 5}, {{0, 1, 4}, {1, 5, 4}}}, Mode{6, {0, 1, 5, 4}, {{1, 5, 0}, {5, 4, 0}}},
          Mode{5, {0, 1, 4, 4, 5, 6, 7}, {{0, 1, 4}, {4, 6, 5}, {5, 6, 7}}}}) {
        LiftedBox sample;
        sample.builder.primitive()["mode"] = mode.mode;
        sample.builder.primitive()["indices"] = sample.builder.accessor(mode.indices, "SCALAR", 5121);
        Corners expected;
        for (const auto& t : mode.triangles)
            for (const std::size_t k : t) expected.push_back(sample.at(k, 1.0));
        expectNear(cornersOf(rigOf(sample.builder), {1.0}), expected);
    }
}

TEST(SampleGltf, QuantizedMeshThatRequiresItIsReadInItsNodesMeasures) {
    LiftedBox sample;
    json& document = sample.builder.document;
    document["extensionsUsed"] = {"KHR_mesh_quantization"};
    document["extensionsRequired"] = {"KHR_mesh_quantization"};
    std::vector<std::int16_t> points; // stands in 8 bytes each, as its alignment asks
    std::vector<std::int8_t> lift;
    const auto whole = [](double metres) { return static_cast<std::int16_t>(std::lround(32767.0 * metres / 0.2)); };
    for (const glm::dvec3& p : sample.box.points) {
        points.insert(points.end(), {whole(p.x), whole(p.y), whole(p.z), 0});
        lift.insert(lift.end(), {0, 0, static_cast<std::int8_t>(p.z > 0.05 ? 127 : 0), 0});
    }
    const auto accessor = [&](const auto& values, int stride, int component) {
        const int view = sample.builder.view(values.data(), values.size() * sizeof values[0]);
        document["bufferViews"][static_cast<std::size_t>(view)]["byteStride"] = stride;
        document["accessors"].push_back({{"bufferView", view},
                                         {"componentType", component},
                                         {"count", sample.box.points.size()},
                                         {"type", "VEC3"},
                                         {"normalized", true}});
        return document["accessors"].size() - 1;
    };
    sample.builder.primitive()["attributes"]["POSITION"] = accessor(points, 8, 5122);
    sample.builder.primitive()["targets"][0]["POSITION"] = accessor(lift, 4, 5120);
    document["nodes"][0]["scale"] = {0.2, 0.2, 0.2};
    const Rig rig = rigOf(sample.builder);
    for (const double stroke : {0.0, 1.0})
        expectNear(cornersOf(rig, {stroke}), sample.box.corners([&](std::size_t k) {
            const glm::dvec3& p = sample.box.points[k];
            return p + glm::dvec3(0.0, 0.0, p.z > 0.05 ? 0.2 * stroke : 0.0);
        }),
                   1e-5);
}

TEST(SampleGltf, CompressionThatIsNotReadIsRefusedByName) {
    for (const char* extension : {"KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_gaussian_splatting"}) {
        LiftedBox sample;
        sample.builder.document["extensionsRequired"] = {extension};
        expectRefused(sample.builder, {extension, "export it without"});
    }
}

// Both at once: the targets first, then the skin.
TEST(SampleGltf, MorphTargetsMoveBeforeTheSkin) {
    RiggedSimple sample;
    sample.withFloatWeights();
    std::vector<float> wide;
    for (const glm::dvec3& p : sample.column.points) wide.insert(wide.end(), {static_cast<float>(p.x), 0.0F, 0.0F});
    sample.builder.primitive()["targets"] = {{{"POSITION", sample.builder.floats(wide, "VEC3")}}};
    sample.builder.document["meshes"][0]["extras"] = {{"targetNames", {"wide"}}};
    const Rig rig = rigOf(sample.builder);
    ASSERT_EQ(rig.actuatorCount(), 2U);
    EXPECT_EQ(rig.actuators()[0].name, "wide");
    for (const auto& [morph, bend] : {std::pair{0.0, 1.0}, {1.0, 0.0}, {0.7, 0.6}})
        expectNear(cornersOf(rig, {morph, bend}), sample.column.corners([&](std::size_t k) {
            const glm::dvec3& p = sample.column.points[k];
            return sample.at({p.x * (1.0 + morph), p.y, p.z}, bend * kTurn, upperShare(p));
        }));
}

// One mesh shown twice, once mirrored: each has targets of its own.
TEST(SampleGltf, InstancesOfAMeshMoveEachByItself) {
    LiftedBox sample;
    sample.builder.document["nodes"] = {
        {{"name", "left"}, {"mesh", 0}, {"translation", {-0.2, 0, 0}}},
        {{"name", "right"}, {"mesh", 0}, {"translation", {0.2, 0, 0}}, {"scale", {-1, 1, 1}}}};
    sample.builder.document["scenes"][0]["nodes"] = {0, 1};
    const Rig rig = rigOf(sample.builder);
    ASSERT_EQ(rig.actuatorCount(), 2U);
    Corners expected =
        sample.box.corners([&](std::size_t k) { return sample.at(k, 0.25) + glm::dvec3(-0.2, 0.0, 0.0); });
    Corners right = sample.box.corners(
        [&](std::size_t k) { return glm::dvec3(-1, 1, 1) * sample.at(k, 1.0) + glm::dvec3(0.2, 0.0, 0.0); });
    for (std::size_t k = 0; k < right.size(); k += 3) std::swap(right[k + 1], right[k + 2]);
    expected.insert(expected.end(), right.begin(), right.end());
    expectNear(cornersOf(rig, {0.25, 1.0}), expected);
}

} // namespace
} // namespace lumorph
