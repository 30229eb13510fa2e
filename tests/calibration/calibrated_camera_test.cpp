#include "core/geometry/calibrated_camera.h"

#include <array>
#include <cmath>
#include <fstream>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <opencv2/calib3d.hpp>

#include "core/base/error.h"
#include "core/geometry/triangle_mesh.h"
#include "core/render/gl/camera_uniforms.h"
#include "core/render/gl/headless_context.h"
#include "tests/core/temporary_folder.h"

namespace lumorph {
namespace {

struct LensCase {
    const char* name;
    glm::ivec2 size;
    glm::dvec2 focal;
    glm::dvec2 principal;
    std::array<double, 5> distortion;
};

// A plain camera; a projector whose lens shift puts the principal point below its image; wide and bent lenses.
const std::array<LensCase, 5> kLenses{{
    {"plain", {640, 480}, {800.0, 800.0}, {319.5, 239.5}, {}},
    {"lens shift", {640, 400}, {1100.0, 1095.0}, {310.0, 560.0}, {}},
    {"barrel", {640, 480}, {500.0, 510.0}, {300.0, 250.0}, {-0.21, 0.07, 0.0011, -0.0007, -0.012}},
    {"pincushion", {640, 480}, {700.0, 700.0}, {330.0, 230.0}, {0.15, 0.02, -0.002, 0.003, 0.01}},
    {"shifted and bent", {800, 500}, {900.0, 905.0}, {390.0, 640.0}, {-0.08, 0.03, 0.001, 0.002, 0.0}},
}};

CalibratedCamera cameraOf(const LensCase& lens) {
    CalibratedCamera camera = cameraLookingAt({0.4, 1.1, 0.7}, {0.02, 0.0, -0.03}, lens.size, 1.0);
    camera.focal = lens.focal;
    camera.principal = lens.principal;
    camera.distortion = lens.distortion;
    return camera;
}

std::vector<glm::dvec2> projectedByOpenCv(const CalibratedCamera& camera, const std::vector<glm::dvec3>& points) {
    cv::Matx33d rotation;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) rotation(row, column) = camera.cameraFromWorld[column][row];
    cv::Vec3d turn;
    cv::Rodrigues(rotation, turn);
    const cv::Vec3d shift(camera.cameraFromWorld[3][0], camera.cameraFromWorld[3][1], camera.cameraFromWorld[3][2]);
    const cv::Matx33d intrinsics(camera.focal.x, 0.0, camera.principal.x, 0.0, camera.focal.y, camera.principal.y, 0.0,
                                 0.0, 1.0);
    std::vector<cv::Point3d> world;
    for (const glm::dvec3& point : points) world.emplace_back(point.x, point.y, point.z);
    std::vector<cv::Point2d> pixels;
    cv::projectPoints(world, turn, shift, intrinsics,
                      std::vector<double>(camera.distortion.begin(), camera.distortion.end()), pixels);
    std::vector<glm::dvec2> result;
    for (const cv::Point2d& pixel : pixels) result.emplace_back(pixel.x, pixel.y);
    return result;
}

// Points a camera can see, up to a little outside its image.
std::vector<glm::dvec3> visiblePoints(const CalibratedCamera& camera, int count) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> share(-0.05, 1.05);
    std::uniform_real_distribution<double> distance(0.3, 3.0);
    std::vector<glm::dvec3> points;
    for (int i = 0; i < count; ++i) {
        const glm::dvec2 pixel = glm::dvec2(share(random), share(random)) * glm::dvec2(camera.size);
        points.push_back(positionOf(camera) + distance(random) * directionOf(camera, pixel));
    }
    return points;
}

// A wavy sheet around the origin, `half` metres to each side, seen as the world positions it shows in every pixel.
class PositionPicture {
public:
    PositionPicture(const CalibratedCamera& camera, float half, int cells) : size_(camera.size) {
        writeShaders();
        const gl::Texture color;
        glBindTexture(GL_TEXTURE_2D, color.name());
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, size_.x, size_.y, 0, GL_RGBA, GL_FLOAT, nullptr);
        const gl::Framebuffer framebuffer;
        glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, color.name(), 0);
        EXPECT_EQ(glCheckFramebufferStatus(GL_FRAMEBUFFER), unsigned{GL_FRAMEBUFFER_COMPLETE});
        glViewport(0, 0, size_.x, size_.y);
        glClearColor(0.0F, 0.0F, 0.0F, 0.0F);
        glClear(GL_COLOR_BUFFER_BIT);
        drawSheet(camera, half, cells);
        pixels_.resize(static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y));
        glReadPixels(0, 0, size_.x, size_.y, GL_RGBA, GL_FLOAT, pixels_.data());
        glBindFramebuffer(GL_FRAMEBUFFER, 0);
    }

    // Row 0 is the top; alpha 0 where nothing is.
    [[nodiscard]] glm::vec4 at(int x, int y) const {
        return pixels_[static_cast<std::size_t>(size_.y - 1 - y) * static_cast<std::size_t>(size_.x) +
                       static_cast<std::size_t>(x)];
    }

private:
    void writeShaders() const {
        std::ofstream(folder_.path() / "main.vert")
            << "layout(location = 0) in vec3 position;\nout vec3 world;\n"
               "void main() { world = position; gl_Position = clipOf(position); }";
        std::ofstream(folder_.path() / "world.frag") << "#version 410 core\nin vec3 world;\nout vec4 color;\n"
                                                        "void main() { color = vec4(world, 1.0); }";
    }

    void drawSheet(const CalibratedCamera& camera, float half, int cells) const {
        std::vector<glm::vec3> vertices;
        const auto at = [&](int i, int j) {
            const glm::vec2 place = half * (2.0F * glm::vec2(i, j) / static_cast<float>(cells) - 1.0F);
            return glm::vec3(place.x, 0.05F * std::sin(9.0F * place.x) * std::cos(7.0F * place.y), place.y);
        };
        for (int i = 0; i < cells; ++i)
            for (int j = 0; j < cells; ++j)
                vertices.insert(vertices.end(),
                                {at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
        const gl::VertexArray array;
        const gl::Buffer buffer;
        glBindVertexArray(array.name());
        glBindBuffer(GL_ARRAY_BUFFER, buffer.name());
        glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(glm::vec3)), vertices.data(),
                     GL_STATIC_DRAW);
        glEnableVertexAttribArray(0);
        glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(glm::vec3), nullptr);
        ShaderFiles files = shaderFiles({"version.glsl", "camera.glsl"}, {});
        files.vertex.push_back(folder_.path() / "main.vert");
        files.fragment.push_back(folder_.path() / "world.frag");
        Program program(files);
        program.use();
        const Box box{glm::vec3(-half, -0.1F, -half), glm::vec3(half, 0.1F, half)};
        const DepthRange depth = depthRange(camera, box);
        setCamera(program, camera, depth.near, depth.far);
        glDisable(GL_DEPTH_TEST);
        glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(vertices.size()));
        glBindVertexArray(0);
    }

    TemporaryFolder folder_;
    glm::ivec2 size_;
    std::vector<glm::vec4> pixels_;
};

TEST(CalibratedCamera, ProjectsAsOpenCvDoes) {
    for (const LensCase& lens : kLenses) {
        SCOPED_TRACE(lens.name);
        const CalibratedCamera camera = cameraOf(lens);
        const std::vector<glm::dvec3> points = visiblePoints(camera, 200);
        const std::vector<glm::dvec2> expected = projectedByOpenCv(camera, points);
        for (std::size_t i = 0; i < points.size(); ++i) {
            const auto pixel = pixelOf(camera, points[i]);
            ASSERT_TRUE(pixel) << i;
            EXPECT_LT(glm::distance(*pixel, expected[i]), 1e-7) << i;
        }
    }
}

TEST(CalibratedCamera, DirectionInvertsPixelToNineDigits) {
    for (const LensCase& lens : kLenses) {
        SCOPED_TRACE(lens.name);
        const CalibratedCamera camera = cameraOf(lens);
        std::mt19937 random(3);
        std::uniform_real_distribution<double> share(-0.02, 1.02);
        for (int i = 0; i < 400; ++i) {
            const glm::dvec2 pixel = glm::dvec2(share(random), share(random)) * glm::dvec2(camera.size);
            const glm::dvec3 direction = directionOf(camera, pixel);
            EXPECT_NEAR(glm::length(direction), 1.0, 1e-12);
            const auto back = pixelOf(camera, positionOf(camera) + 1.7 * direction);
            ASSERT_TRUE(back);
            EXPECT_LT(glm::distance(*back, pixel) / camera.focal.x, 1e-9);
        }
    }
}

TEST(CalibratedCamera, DrawsEverythingWhereOpenCvProjectsIt) {
    const HeadlessContext context;
    for (const LensCase& lens : kLenses) {
        SCOPED_TRACE(lens.name);
        const CalibratedCamera camera = cameraOf(lens);
        const PositionPicture picture(camera, 0.9F, 220);
        std::mt19937 random(11);
        std::uniform_int_distribution<int> column(0, camera.size.x - 1);
        std::uniform_int_distribution<int> row(0, camera.size.y - 1);
        std::vector<glm::dvec2> pixels;
        std::vector<glm::dvec3> points;
        for (int i = 0; i < 20'000 && points.size() < 200; ++i) {
            const glm::ivec2 pixel(column(random), row(random));
            const glm::vec4 world = picture.at(pixel.x, pixel.y);
            if (world.w == 0.0F) continue;
            pixels.emplace_back(pixel);
            points.emplace_back(world);
        }
        ASSERT_EQ(points.size(), 200U);
        const std::vector<glm::dvec2> expected = projectedByOpenCv(camera, points);
        for (std::size_t i = 0; i < points.size(); ++i) EXPECT_LT(glm::distance(pixels[i], expected[i]), 0.05) << i;
    }
}

TEST(CalibratedCamera, ClipsWhereTheLensFoldsBack) {
    const HeadlessContext context;
    CalibratedCamera camera = cameraLookingAt({0.0, 0.4, 0.0}, glm::dvec3(0.0), {400, 300}, 150.0);
    camera.distortion = {-0.25, 0.0, 0.0, 0.0, 0.0};
    const double limit = distortionLimit(camera);
    EXPECT_NEAR(limit, 1.0 / 0.75, 1e-9);
    EXPECT_TRUE(pixelOf(camera, {0.4 * 0.99 * std::sqrt(limit), 0.0, 0.0}));
    EXPECT_FALSE(pixelOf(camera, {0.4 * 1.01 * std::sqrt(limit), 0.0, 0.0}));
    EXPECT_FALSE(pixelOf(camera, {0.0, 1.0, 0.0})) << "behind";

    const PositionPicture picture(camera, 2.0F, 400);
    int seen = 0;
    for (int y = 0; y < camera.size.y; ++y)
        for (int x = 0; x < camera.size.x; ++x) {
            const glm::vec4 world = picture.at(x, y);
            if (world.w == 0.0F) continue;
            ++seen;
            const double distance = 0.4 - double(world.y);
            const double radius = std::hypot(double(world.x), double(world.z)) / distance;
            ASSERT_LT(radius, std::sqrt(limit) * 1.06) << x << ", " << y;
            // Near the fold a straight edge between two vertices is not a straight line of the lens.
            if (radius > 0.85 * std::sqrt(limit)) continue;
            const auto pixel = pixelOf(camera, glm::dvec3(world));
            ASSERT_TRUE(pixel);
            EXPECT_LT(glm::distance(*pixel, glm::dvec2(x, y)), 0.6);
        }
    // The image of the disc within the limit: radius f r (1 + k1 r^2).
    const double radius = 150.0 * std::sqrt(limit) * (1.0 - 0.25 * limit);
    EXPECT_NEAR(seen, 3.14159 * radius * radius, 0.03 * 3.14159 * radius * radius);
}

TEST(CalibratedCamera, LimitHoldsTheTangentialPartToo) {
    CalibratedCamera camera = cameraOf(kLenses[2]);
    camera.distortion = {0.0, 0.0, 0.03, -0.04, 0.0};
    const double limit = distortionLimit(camera);
    ASSERT_NEAR(limit, 1.0 / (0.3 * 0.3), 1e-9) << "1 / (6 |p|) along the tangential part";
    // Within the limit no two points meet: the distance in the image never shrinks to nothing.
    std::mt19937 random(5);
    std::uniform_real_distribution<double> angle(0.0, 6.2831853);
    for (int i = 0; i < 200; ++i) {
        const double turn = angle(random);
        const auto pixel = [&](double radius) {
            return *pixelOf(camera,
                            positionOf(camera) + glm::transpose(glm::dmat3(camera.cameraFromWorld)) *
                                                     glm::dvec3(radius * std::cos(turn), radius * std::sin(turn), 1.0));
        };
        for (double share = 0.05; share < 0.95; share += 0.05) {
            const double radius = share * std::sqrt(limit);
            EXPECT_GT(glm::distance(pixel(radius), pixel(radius + 1e-3)), 1e-3);
        }
    }
    camera.distortion = {};
    EXPECT_TRUE(std::isinf(distortionLimit(camera)));
    camera.distortion = {0.1, 0.2, 0.0, 0.0, 0.3};
    EXPECT_TRUE(std::isinf(distortionLimit(camera)));
}

TEST(CalibratedCamera, EyeSeesAllPointsTightlyWithSquarePixels) {
    const std::vector<glm::vec3> points{
        {-0.1F, 0.0F, -0.07F}, {0.1F, 0.0F, -0.07F}, {-0.1F, 0.0F, 0.07F}, {0.1F, 0.06F, 0.07F}, {0.1F, 0.06F, -0.07F}};
    for (const glm::dvec3& eye : {glm::dvec3(0.0, 0.45, 0.55), {0.5, 0.02, 0.3}, {0.0, 0.6, 0.0}, {-0.8, 0.3, -0.4}}) {
        const CalibratedCamera camera = eyeCamera(eye, points, {1280, 800}, 0.04);
        checkCamera(camera);
        EXPECT_LT(glm::distance(positionOf(camera), eye), 1e-12);
        EXPECT_EQ(camera.focal.x, camera.focal.y);
        glm::dvec2 low(1e9);
        glm::dvec2 high(-1e9);
        for (const glm::vec3& point : points) {
            const auto pixel = pixelOf(camera, glm::dvec3(point));
            ASSERT_TRUE(pixel);
            low = glm::min(low, *pixel);
            high = glm::max(high, *pixel);
        }
        const glm::dvec2 extent = (high - low) / glm::dvec2(camera.size);
        EXPECT_NEAR(std::max(extent.x, extent.y), 1.0 / 1.08, 1e-9);
        EXPECT_NEAR(low.x + high.x, camera.size.x - 1, 1e-6);
        EXPECT_NEAR(low.y + high.y, camera.size.y - 1, 1e-6);
    }
    EXPECT_THROW((void)eyeCamera({0.0, 0.03, 0.0}, points, {1280, 800}), InvalidInput);
    EXPECT_THROW((void)eyeCamera({0.0, 0.5, 0.5}, {}, {1280, 800}), InvalidInput);
}

TEST(CalibratedCamera, BadCamerasAreNamed) {
    const auto messageOf = [](auto change) -> std::string {
        CalibratedCamera camera = cameraOf(kLenses[0]);
        change(camera);
        try {
            checkCamera(camera);
        } catch (const InvalidInput& error) {
            return error.what();
        }
        return "";
    };
    using testing::HasSubstr;
    EXPECT_EQ(messageOf([](CalibratedCamera&) {}), "");
    EXPECT_THAT(messageOf([](CalibratedCamera& c) { c.size = {0, 5}; }), HasSubstr("0x5 pixels"));
    EXPECT_THAT(messageOf([](CalibratedCamera& c) { c.size = {100'000, 5}; }), HasSubstr("100000x5 pixels"));
    EXPECT_THAT(messageOf([](CalibratedCamera& c) { c.focal.y = -1.0; }), HasSubstr("focal length"));
    EXPECT_THAT(messageOf([](CalibratedCamera& c) { c.principal.x = NAN; }), HasSubstr("not finite"));
    EXPECT_THAT(messageOf([](CalibratedCamera& c) { c.cameraFromWorld[0] *= -1.0; }), HasSubstr("pose"));
    EXPECT_THAT(messageOf([](CalibratedCamera& c) { c.cameraFromWorld *= 2.0; }), HasSubstr("pose"));
}

} // namespace
} // namespace lumorph
