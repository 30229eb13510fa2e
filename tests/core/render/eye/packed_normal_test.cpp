#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/render/gl/color_target.h"
#include "core/render/gl/headless_context.h"
#include "core/render/gl/program.h"
#include "tests/core/temporary_folder.h"

namespace lumorph {
namespace {

// Odd, and one more than a multiple of four: the poles, the equator and all seams of the octahedron are among them.
constexpr glm::ivec2 kDirections{1025, 513};

glm::dvec3 direction(int x, int y) {
    const double around = 2.0 * std::numbers::pi * x / (kDirections.x - 1);
    const double down = std::numbers::pi * y / (kDirections.y - 1);
    return {std::sin(down) * std::cos(around), std::sin(down) * std::sin(around), std::cos(down)};
}

/// What comes back of each direction, and the number it was meanwhile.
std::vector<glm::vec4> thereAndBack() {
    const TemporaryFolder folder;
    const auto fragment = folder.path() / "there_and_back.frag";
    std::ofstream(fragment) << R"(uniform sampler2D directions;
out vec4 color;
void main() {
    float whole = packedNormal(texelFetch(directions, ivec2(gl_FragCoord.xy), 0).xyz);
    color = vec4(unpackedNormal(whole), whole);
}
)";
    std::vector<glm::vec3> sent;
    for (int y = 0; y < kDirections.y; ++y)
        for (int x = 0; x < kDirections.x; ++x) sent.emplace_back(direction(x, y));
    const gl::Texture directions;
    glBindTexture(GL_TEXTURE_2D, directions.name());
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB32F, kDirections.x, kDirections.y, 0, GL_RGB, GL_FLOAT, sent.data());
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);

    ShaderFiles files = shaderFiles({"full_frame.vert"}, {"version.glsl", "packed_normal.glsl"});
    files.fragment.push_back(fragment);
    const ColorTarget target(kDirections, GL_RGBA32F);
    glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer());
    glViewport(0, 0, kDirections.x, kDirections.y);
    glDisable(GL_DEPTH_TEST);
    Program program(files);
    program.use();
    program.set("directions", 0);
    glBindTexture(GL_TEXTURE_2D, directions.name());
    const gl::VertexArray array;
    glBindVertexArray(array.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    std::vector<glm::vec4> back(sent.size());
    glReadPixels(0, 0, kDirections.x, kDirections.y, GL_RGBA, GL_FLOAT, back.data());
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    return back;
}

TEST(PackedNormal, ComesBackWithinAFewHundredthsOfADegree) {
    const HeadlessContext context;
    const std::vector<glm::vec4> back = thereAndBack();
    double worst = 0.0;
    int notWhole = 0;
    for (int y = 0; y < kDirections.y; ++y)
        for (int x = 0; x < kDirections.x; ++x) {
            const glm::vec4& one = back[static_cast<std::size_t>(y * kDirections.x + x)];
            worst = std::max(worst, std::asin(glm::length(glm::cross(glm::dvec3(one), direction(x, y)))));
            EXPECT_GT(glm::dot(glm::dvec3(one), direction(x, y)), 0.0) << x << ", " << y;
            EXPECT_NEAR(glm::length(glm::dvec3(one)), 1.0, 1e-5) << x << ", " << y;
            notWhole += one.w >= 1.0F && one.w <= 16777216.0F && one.w == std::floor(one.w) ? 0 : 1;
        }
    const double degrees = worst * 180.0 / std::numbers::pi;
    // Half a step of 2/4095 each way, in the middle of a face, at 1/sqrt(3) from the octahedron's centre.
    EXPECT_LE(degrees, 0.06);
    EXPECT_GE(degrees, 0.03) << "finer than twelve bits a side can be";
    EXPECT_EQ(notWhole, 0);
}

} // namespace
} // namespace lumorph
