#include "app/studio/viewport/view_cube.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <QFont>
#include <QPolygonF>
#include <QTransform>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>

namespace lumorph::studio {
namespace {

constexpr double kBoxSide = 104.0;
constexpr double kCubeMargin = 12.0;
constexpr float kHalfEdge = 30.0F;
// From here to the rim a face belongs to its edges and corners.
constexpr float kRim = 0.7F;

// A face: where it looks and the directions of its lettering, seen from outside.
struct Face {
    glm::vec3 normal, right, up;
    const char* name;
};
constexpr std::array<Face, 6> kFaces{{{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}, "Front"},
                                      {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}, "Right"},
                                      {{0, 0, -1}, {-1, 0, 0}, {0, 1, 0}, "Back"},
                                      {{-1, 0, 0}, {0, 0, 1}, {0, 1, 0}, "Left"},
                                      {{0, 1, 0}, {1, 0, 0}, {0, 0, -1}, "Top"},
                                      {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}, "Bottom"}}};

// The cube's corner at (1, 1, 1) is half an edge of `kHalfEdge` pixels from the middle of the box along each axis.
class View {
public:
    View(const QRectF& box, const ViewCamera& camera) : middle_(box.center()), turn_(viewFromWorld(camera)) {}

    glm::vec3 seen(const glm::vec3& v) const { return turn_ * v; }
    QPointF at(const glm::vec3& p) const {
        const glm::vec3 s = kHalfEdge * seen(p);
        return middle_ + QPointF(static_cast<double>(s.x), -static_cast<double>(s.y));
    }
    QPolygonF patch(const Face& face, float u0, float v0, float u1, float v1) const {
        const auto corner = [&](float u, float v) { return at(face.normal + u * face.right + v * face.up); };
        return QPolygonF({corner(u0, v1), corner(u1, v1), corner(u1, v0), corner(u0, v0)});
    }
    bool shows(const Face& face) const { return seen(face.normal).z > 0.02F; }

private:
    QPointF middle_;
    glm::mat3 turn_;
};

QColor mixed(const QColor& a, const QColor& b, double t) {
    const auto channel = [t](int x, int y) { return static_cast<int>(std::lround(x + t * (y - x))); };
    return {channel(a.red(), b.red()), channel(a.green(), b.green()), channel(a.blue(), b.blue())};
}

// Lit from above the viewer's left shoulder.
QColor faceColor(const glm::vec3& seenNormal, const Palette& palette) {
    const glm::vec3 light = glm::normalize(glm::vec3(-0.35F, 0.75F, 0.6F));
    const double lit = static_cast<double>(std::max(0.0F, glm::dot(seenNormal, light)));
    const bool dark = palette.window.lightness() < 128;
    return dark ? mixed(palette.raised, palette.text, 0.04 + 0.30 * lit)
                : mixed(palette.border, palette.panel, 0.45 + 0.55 * lit);
}

void paintFaceName(QPainter& painter, const QPolygonF& face, const char* name, const QColor& color) {
    // Letters as if painted on the face: on a square of 100 units, laid onto it.
    QTransform onto;
    const QPolygonF square({{0, 0}, {100, 0}, {100, 100}, {0, 100}});
    if (!QTransform::quadToQuad(square, face, onto)) return;
    painter.save();
    painter.setTransform(onto, true);
    QFont font = painter.font();
    font.setPixelSize(24);
    font.setWeight(QFont::DemiBold);
    painter.setFont(font);
    painter.setPen(color);
    painter.drawText(QRectF(0, 0, 100, 100), Qt::AlignCenter, QString::fromLatin1(name));
    painter.restore();
}

// The part of a face that belongs to a side: its middle, a strip along an edge, a corner.
QPolygonF hotPatch(const View& view, const Face& face, const CubeSide& side) {
    const auto along = [&](const glm::vec3& axis) { return glm::dot(axis, glm::vec3(side)); };
    const auto range = [](float place) {
        return place > 0.5F    ? std::array{kRim, 1.0F}
               : place < -0.5F ? std::array{-1.0F, -kRim}
                               : std::array{-kRim, kRim};
    };
    const auto u = range(along(face.right));
    const auto v = range(along(face.up));
    return view.patch(face, u[0], v[0], u[1], v[1]);
}

} // namespace

QRectF viewCubeBox(const QSize& view) {
    return {view.width() - kCubeMargin - kBoxSide, kCubeMargin, kBoxSide, kBoxSide};
}

std::optional<CubeSide> viewCubeAt(const QRectF& box, const ViewCamera& camera, const QPointF& pointer) {
    const View view(box, camera);
    for (const Face& face : kFaces) {
        if (!view.shows(face)) continue;
        QTransform toFace;
        const QPolygonF square({{-1, 1}, {1, 1}, {1, -1}, {-1, -1}});
        if (!QTransform::quadToQuad(view.patch(face, -1, -1, 1, 1), square, toFace)) continue;
        const QPointF p = toFace.map(pointer);
        if (std::abs(p.x()) > 1.0 || std::abs(p.y()) > 1.0) continue;
        const auto rim = [](double place) {
            return place > static_cast<double>(kRim) ? 1.0F : place < -static_cast<double>(kRim) ? -1.0F : 0.0F;
        };
        return CubeSide(glm::round(face.normal + rim(p.x()) * face.right + rim(p.y()) * face.up));
    }
    return std::nullopt;
}

void paintViewCube(QPainter& painter, const QRectF& box, const ViewCamera& camera, std::optional<CubeSide> hot,
                   const Palette& palette) {
    const View view(box, camera);
    painter.save();
    painter.setRenderHint(QPainter::Antialiasing);
    for (const Face& face : kFaces) {
        if (!view.shows(face)) continue;
        const glm::vec3 normal = view.seen(face.normal);
        const QPolygonF outline = view.patch(face, -1, -1, 1, 1);
        const QColor color = faceColor(normal, palette);
        painter.setPen(QPen(palette.window, 1.5, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
        painter.setBrush(color);
        painter.drawPolygon(outline);
        const bool lit = hot && glm::dot(face.normal, glm::vec3(*hot)) > 0.5F;
        if (lit) {
            painter.setPen(Qt::NoPen);
            painter.setBrush(palette.accent);
            painter.drawPolygon(hotPatch(view, face, *hot));
        }
        const bool onAccent = lit && CubeSide(face.normal) == *hot;
        // Letters that lie almost flat cannot be read and only flicker.
        if (normal.z > 0.25F) paintFaceName(painter, outline, face.name, onAccent ? palette.onAccent : palette.text);
    }
    painter.restore();
}

} // namespace lumorph::studio
