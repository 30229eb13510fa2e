#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>

#include "app/applications/navigation/map.h"
#include "app/applications/navigation/map_view.h"
#include "core/base/image.h"

namespace lumorph::navigation {

/// A square of the map that a picture covers.
struct PictureWindow {
    glm::dvec2 corner{0.0}; ///< the north-western, metres
    double side = 1.0;      ///< metres
    bool operator==(const PictureWindow&) const = default;

    /// Whether all that a view shows lies in it.
    [[nodiscard]] bool covers(const MapView& view) const noexcept;
};

/// The window that shows a view sharply, with some ground around to pan over.
[[nodiscard]] PictureWindow windowFor(const MapView& view) noexcept;
/// The window of all of a map.
[[nodiscard]] PictureWindow wholeWindow(const Map& map) noexcept;

/// What the ground looks like from above, and how its small slopes bend light, painted bit by bit: a whole picture
/// takes longer than a frame may.
class GroundPicture {
public:
    static constexpr int kSide = 1024; ///< pixels
    static constexpr int kCoarse = 129;
    static constexpr int kFramePixels = 20 * kSide; ///< to paint in a frame

    GroundPicture(const Map& map, const PictureWindow& window);

    /// Paints about so many pixels more. Whether all is done.
    bool paint(int pixels);
    [[nodiscard]] bool done() const noexcept { return done_; }
    [[nodiscard]] const PictureWindow& window() const noexcept { return window_; }
    [[nodiscard]] const std::shared_ptr<Image>& color() const noexcept { return color_; }
    [[nodiscard]] const std::shared_ptr<Image>& relief() const noexcept { return relief_; } ///< a normal map

private:
    void measureCoarse();
    /// How much higher the ground is than the surface that is drawn, at the pixels of a row.
    void measureRow(int row, std::vector<float>& over) const;
    void paintRow(int row);
    [[nodiscard]] glm::vec3 coverAt(const glm::dvec2& place) const noexcept;
    int paintParcel(const Parcel& parcel);
    int paintFoot(const Building& building);
    int paintRoad(const Road& road, std::size_t piece);
    [[nodiscard]] double metresAPixel() const noexcept { return window_.side / kSide; }
    [[nodiscard]] glm::dvec2 pixelOf(const glm::dvec2& place) const noexcept {
        return (place - window_.corner) / metresAPixel() - 0.5;
    }

    const Map* map_;
    PictureWindow window_;
    std::shared_ptr<Image> color_, relief_;
    std::vector<float> coarse_;              ///< heights as the drawn surface has them, kCoarse a side
    std::vector<float> before_, at_, after_; ///< of the rows around `row_`
    int row_ = 0;
    std::size_t parcel_ = 0, road_ = 0, piece_ = 0, foot_ = 0;
    bool done_ = false;
};

} // namespace lumorph::navigation
