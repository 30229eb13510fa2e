#pragma once

#include <memory>
#include <optional>

#include <QImage>
#include <QWidget>

#include "calibration/placement/light_plan.h"
#include "core/geometry/triangle_mesh.h"

namespace lumorph::studio {

/// A device from above, coloured by how light reaches it: red is bad, green is good. Pointing at a place tells its
/// figures.
class LightMapView : public QWidget {
    Q_OBJECT
public:
    enum class Shown { pixels, incidence, lit, blur };

    explicit LightMapView(QWidget* parent = nullptr);
    /// `device`: at rest, world metres.
    void show(std::shared_ptr<const LightMap> map, std::shared_ptr<const TriangleMesh> device, const LightWish& wish);
    void setShown(Shown shown);
    /// The place nearest to a point of the widget; null beside the device.
    [[nodiscard]] const LightAt* at(const QPointF& point) const;
    /// How good the light at a place is by what is shown: 0 bad, 1 as wished.
    [[nodiscard]] double goodness(const LightAt& at) const;
    [[nodiscard]] QSize sizeHint() const override { return {280, 200}; }
    [[nodiscard]] QSize minimumSizeHint() const override { return {160, 140}; }

protected:
    void paintEvent(QPaintEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void resizeEvent(QResizeEvent* event) override;

private:
    [[nodiscard]] QRectF mapArea() const; ///< pixels that the device's box from above takes
    [[nodiscard]] QPointF pixelOf(const glm::vec3& place) const;
    [[nodiscard]] QImage makePicture() const;
    void paintScale(QPainter& painter) const;

    std::shared_ptr<const LightMap> map_;
    std::shared_ptr<const TriangleMesh> device_;
    Box box_; ///< of the device
    LightWish wish_;
    Shown shown_ = Shown::pixels;
    QImage picture_; ///< of the map, made when it is first painted: each pixel looks for its place; null: not yet
};

} // namespace lumorph::studio
