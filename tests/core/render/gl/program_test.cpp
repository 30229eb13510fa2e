#include "core/render/gl/program.h"

#include <cmath>
#include <fstream>
#include <optional>

#include <glm/geometric.hpp>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/render/figure/camera.h"
#include "core/render/gl/frame_target.h"
#include "core/render/gl/headless_context.h"
#include "tests/core/temporary_folder.h"

namespace lumorph {
namespace {

std::filesystem::path writeText(const std::filesystem::path& file, const std::string& text) {
    std::ofstream(file, std::ios::binary) << text;
    return file;
}

TEST(HeadlessContext, OffersOpenGl41Core) {
    const HeadlessContext context;
    EXPECT_GE(epoxy_gl_version(), 41);
    GLint profile = 0;
    glGetIntegerv(GL_CONTEXT_PROFILE_MASK, &profile);
    EXPECT_EQ(profile, GL_CONTEXT_CORE_PROFILE_BIT);
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
}

TEST(HeadlessContext, SeveralLiveSideBySideAndCanBeMoved) {
    HeadlessContext first;
    std::optional<gl::Buffer> inFirst(std::in_place);
    glBindBuffer(GL_ARRAY_BUFFER, inFirst->name());
    EXPECT_TRUE(glIsBuffer(inFirst->name()));
    {
        const HeadlessContext second;
        EXPECT_FALSE(glIsBuffer(inFirst->name())); // nothing is shared
    }
    const HeadlessContext moved(std::move(first));
    moved.makeCurrent();
    EXPECT_TRUE(glIsBuffer(inFirst->name()));
    inFirst.reset(); // while its context is current
}

TEST(GlObjects, AreReleasedOnceWhateverTheMoves) {
    const HeadlessContext context;
    gl::Buffer a;
    const GLuint name = a.name();
    glBindBuffer(GL_ARRAY_BUFFER, name);
    {
        gl::Buffer b(std::move(a));
        EXPECT_EQ(b.name(), name);
        gl::Buffer c;
        c = std::move(b);
        EXPECT_EQ(c.name(), name);
        EXPECT_TRUE(glIsBuffer(name));
    }
    EXPECT_FALSE(glIsBuffer(name));
}

TEST(Program, AnErrorNamesFileAndLine) {
    const HeadlessContext context;
    const TemporaryFolder folder;
    const auto vertex =
        writeText(folder / "good.vert", "#version 410 core\nvoid main() { gl_Position = vec4(0.0); }\n");
    const auto first = writeText(folder / "first.frag", "#version 410 core\n\nout vec4 color;\n");
    const auto good = writeText(folder / "good.glsl", "float one() { return 1.0; }\n");
    const auto bad = writeText(folder / "bad.glsl", "\n\nvoid main() {\n    color = vec4(nothing);\n}\n");
    Program program({{vertex}, {first, good, bad}});
    try {
        program.use();
        FAIL() << "a broken shader was accepted";
    } catch (const DataError& error) {
        EXPECT_EQ(error.subject(), bad.string() + ":4");
        EXPECT_NE(error.why().find("nothing"), std::string::npos) << error.why();
    }
    const auto absent = folder.path() / "absent.frag";
    EXPECT_THROW(Program({{vertex}, {absent}}).use(), DataError);
}

TEST(Program, UnderstandsTheLogsOfOtherDrivers) {
    const std::vector<ShaderPiece> pieces{{"a.frag", 20}, {"b.glsl", 30}};
    struct Row {
        const char* log;
        const char* place;
        const char* message;
    };
    // clang-format off
    const Row rows[] = {
        {"0:12(3): error: `x' undeclared\n",                            "a.frag:12", "`x' undeclared"},
        {"0:7(10): warning: unused\n0:29(1): error: syntax error\n",    "b.glsl:9",  "syntax error"},
        {"0(34) : error C1008: undefined variable \"x\"\n",             "b.glsl:14", "undefined variable \"x\""},
        {"ERROR: 0:5: 'x' : undeclared identifier\n",                   "a.frag:5",  "'x' : undeclared identifier"},
        {"out of luck",                                                 "a.frag",    "out of luck"}};
    // clang-format on
    for (const Row& row : rows) {
        EXPECT_EQ(firstFault(row.log, pieces).place, row.place);
        EXPECT_EQ(firstFault(row.log, pieces).message, row.message);
    }
}

// Where the ray through a place in the picture meets the plane z = 0, without matrices.
glm::dvec2 onPlane(const Camera& camera, glm::dvec2 pixel, glm::dvec2 size) {
    const glm::dvec3 eye(camera.eye);
    const glm::dvec3 forward = glm::normalize(glm::dvec3(camera.centre) - eye);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(0.0, 1.0, 0.0)));
    const glm::dvec3 down = glm::cross(forward, right);
    const double focal = 0.5 * size.y / std::tan(0.5 * camera.fieldOfView.inRadians());
    const glm::dvec3 ray = focal * forward + (pixel.x - 0.5 * size.x) * right + (pixel.y - 0.5 * size.y) * down;
    const glm::dvec3 hit = eye - ray * (eye.z / ray.z);
    return {hit.x, hit.y};
}

TEST(Program, AQuadCoversThePredictedPixels) {
    const HeadlessContext context;
    const TemporaryFolder folder;
    const auto vertex = writeText(folder / "quad.vert", R"(#version 410 core
uniform mat4 clipFromWorld;
void main() {
    vec2 corner = vec2((gl_VertexID & 1) == 0 ? -0.1 : 0.2, (gl_VertexID & 2) == 0 ? -0.05 : 0.12);
    gl_Position = clipFromWorld * vec4(corner, 0.0, 1.0);
}
)");
    const auto fragment = writeText(folder / "quad.frag", R"(#version 410 core
uniform vec4 tint;
out vec4 color;
void main() { color = tint; }
)");
    const glm::ivec2 size(320, 240);
    Camera camera;
    camera.eye = {0.3F, 0.4F, 1.1F};
    camera.centre = {0.02F, 0.01F, 0.0F};
    camera.aspect = 320.0F / 240.0F;

    const FrameTarget target(size, 4);
    glViewport(0, 0, size.x, size.y);
    glClearColor(0.0F, 0.0F, 0.0F, 1.0F);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    Program program({{vertex}, {fragment}});
    program.use();
    program.set("clipFromWorld", clipFromWorld(camera));
    program.set("tint", glm::vec4(0.2F, 0.4F, 0.8F, 1.0F));
    const gl::VertexArray array;
    glBindVertexArray(array.name());
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    const Image image = target.read();
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));

    const auto inside = [&](double x, double y) {
        const glm::dvec2 p = onPlane(camera, {x, y}, size);
        return p.x > -0.1 && p.x < 0.2 && p.y > -0.05 && p.y < 0.12;
    };
    int wrong = 0;
    int covered = 0;
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            const int corners = inside(x, y) + inside(x + 1, y) + inside(x, y + 1) + inside(x + 1, y + 1);
            if (corners != 0 && corners != 4) continue; // on the edge
            const Image::Pixel expected = corners == 4 ? Image::Pixel{51, 102, 204, 255} : Image::Pixel{0, 0, 0, 255};
            wrong += image.at(x, y) != expected;
            covered += corners == 4;
        }
    EXPECT_EQ(wrong, 0);
    EXPECT_GT(covered, 5000);
}

} // namespace
} // namespace lumorph
