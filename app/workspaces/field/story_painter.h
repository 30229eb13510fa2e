#pragma once

#include <optional>
#include <vector>

#include <QImage>
#include <QPainter>

#include "app/studio/look/palette.h"
#include "app/workspaces/field/story.h"

namespace lumorph::studio {

/// Where the parts of a picture of the story lie; pixels. `unit` is what one pixel of a usual window is here, so that a
/// large picture looks like a small one.
struct StoryLayout {
    QRectF section; ///< the plane of voxels, whole pixels a voxel
    QRectF second;  ///< the same plane again, for comparing; empty where nothing is compared
    double voxel = 1.0;
    std::vector<QRectF> states; ///< of the first step: the plane at some levels
    std::vector<int> stateLevels;
    std::vector<QRectF> charts; ///< one an actuator, where they are shown
    QRectF legend;

    /// Where a place of the plane, in voxels from its lower left corner, is drawn in `section`.
    [[nodiscard]] QPointF pixel(const glm::dvec2& place) const {
        return {section.left() + voxel * place.x, section.bottom() - voxel * place.y};
    }
};
[[nodiscard]] StoryLayout layoutOf(const StoryPicture& picture, const QRectF& area, double unit);

/// Paints what the plane of the picture's view cuts: voxels crisp, outlines of what they stand for over them, charts
/// and a legend below.
void paintSection(QPainter& painter, const StoryPicture& picture, const QRectF& area, double unit,
                  const Palette& colors);

/// A page to hang on the wall: title, sentences, the plane, and `view` (the three-dimensional one) beside it.
void paintPage(QPainter& painter, const StoryPicture& picture, const QImage& view, const QSize& size,
               const Palette& colors);
/// Where `view` goes on a page of this size.
[[nodiscard]] QRect viewOnPage(const QSize& size);

/// What is known of a voxel of the plane, for a tool tip.
[[nodiscard]] QString voxelText(const StoryPicture& picture, const glm::ivec2& at);

} // namespace lumorph::studio
