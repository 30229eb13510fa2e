#include "viewport_fixture.h"

#include <array>
#include <cmath>
#include <numbers>

#include <QTest>

namespace lumorph::studio {
namespace {

std::shared_ptr<ViewportScene> sceneOf(const TriangleMesh& mesh, const glm::vec3& color, std::uint32_t id) {
    auto scene = std::make_shared<ViewportScene>();
    ViewportSurface surface;
    surface.id = id;
    surface.shading = std::make_shared<SurfaceShading>(mesh, Angle::degrees(35.0));
    surface.positions = std::make_shared<std::vector<glm::vec3>>(mesh.positions);
    surface.color = color;
    scene->surfaces.push_back(surface);
    scene->bounds = boundingBox(mesh.positions);
    scene->groundHeight = scene->bounds.min.y - 0.02F;
    scene->grid = false;
    return scene;
}

} // namespace

std::shared_ptr<ViewportScene> cubeScene(const glm::vec3& centre, float side, const glm::vec3& color,
                                         std::uint32_t id) {
    TriangleMesh mesh;
    for (unsigned i = 0; i < 8; ++i)
        mesh.positions.push_back(centre + 0.5F * side * glm::vec3(i & 1U ? 1 : -1, i & 2U ? 1 : -1, i & 4U ? 1 : -1));
    mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return sceneOf(mesh, color, id);
}

std::shared_ptr<ViewportScene> sphereScene(int triangles, float radius) {
    const auto rows = static_cast<unsigned>(std::ceil(std::sqrt(0.25 * triangles))) + 1;
    const unsigned columns = 2 * rows;
    TriangleMesh mesh;
    for (unsigned row = 0; row <= rows; ++row)
        for (unsigned column = 0; column < columns; ++column) {
            const double polar = std::numbers::pi * row / rows;
            const double around = 2.0 * std::numbers::pi * column / columns;
            mesh.positions.emplace_back(static_cast<double>(radius) * glm::dvec3(std::sin(polar) * std::sin(around),
                                                                                 std::cos(polar),
                                                                                 std::sin(polar) * std::cos(around)));
        }
    for (unsigned row = 0; row < rows; ++row)
        for (unsigned column = 0; column < columns; ++column) {
            const unsigned next = (column + 1) % columns;
            const unsigned a = row * columns + column, b = row * columns + next;
            const unsigned c = a + columns, d = b + columns;
            mesh.triangles.push_back({a, c, d});
            mesh.triangles.push_back({a, d, b});
        }
    return sceneOf(mesh, {0.9F, 0.9F, 0.87F}, 3);
}

QRect redPart(const QImage& image) {
    QRect found;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            const QRgb pixel = image.pixel(x, y);
            if (qRed(pixel) > 2 * qGreen(pixel) + 10 && qRed(pixel) > 2 * qBlue(pixel) + 10) found |= QRect(x, y, 1, 1);
        }
    return found;
}

QRectF cubePart(const ViewCamera& camera, const glm::vec3& centre, float side, glm::vec2 size) {
    glm::vec2 low(1e9F);
    glm::vec2 high(-1e9F);
    for (unsigned i = 0; i < 8; ++i) {
        const glm::vec3 corner = centre + 0.5F * side * glm::vec3(i & 1U ? 1 : -1, i & 2U ? 1 : -1, i & 4U ? 1 : -1);
        const glm::vec2 seen = pixelOf(camera, corner, size).value();
        low = glm::min(low, seen);
        high = glm::max(high, seen);
    }
    return {QPointF(low.x, low.y), QPointF(high.x, high.y)};
}

bool waitFor(const std::function<bool()>& isSo, int milliseconds) { return QTest::qWaitFor(isSo, milliseconds); }

} // namespace lumorph::studio
