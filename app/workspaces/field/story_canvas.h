#pragma once

#include <optional>

#include <QPixmap>
#include <QWidget>

#include "app/workspaces/field/story_painter.h"

namespace lumorph::studio {

/// The plane of the story's picture with its charts. A click on a chart chooses its actuator, one on a small state its
/// level; the wheel moves the plane; what is known of a voxel stands in its tool tip.
class StoryCanvas : public QWidget {
    Q_OBJECT
public:
    explicit StoryCanvas(QWidget* parent = nullptr);

    void setPicture(const StoryPicture& picture);
    void setColors(const Palette& colors);
    /// As it is painted now; for tests. Needs a picture.
    [[nodiscard]] StoryLayout layoutNow() const;

    [[nodiscard]] QSize sizeHint() const override { return {720, 480}; }
    [[nodiscard]] QSize minimumSizeHint() const override { return {360, 240}; }

signals:
    void actuatorChosen(int actuator);
    void levelChosen(int level);
    void planeMoved(int by);

protected:
    bool event(QEvent* event) override;
    void paintEvent(QPaintEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void wheelEvent(QWheelEvent* event) override;

private:
    [[nodiscard]] QRectF area() const;
    [[nodiscard]] std::optional<glm::ivec2> voxelAt(const QPointF& place) const;

    std::optional<StoryPicture> picture_;
    Palette colors_;
    QPixmap painted_; ///< of `picture_`; null when it has to be painted anew
    int wheel_ = 0;   ///< eighths of a degree that are not a notch yet
};

} // namespace lumorph::studio
