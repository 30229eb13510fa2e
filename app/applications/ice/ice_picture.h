#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "app/applications/ice/floe_field.h"
#include "core/base/image.h"

namespace lumorph::ice {

/// The sheet of ice from above, in home coordinates: snow, what is frozen in it, blue where it is thin towards rims, a
/// bright line along them and a wet edge. Floes lie apart in home coordinates, so that one picture serves all of them.
class IcePicture {
public:
    explicit IcePicture(std::uint64_t seed);

    /// Paints a floe; only where it differs from what it was before, if that is given.
    void paint(const FloeField& field, const FloeField* before = nullptr);
    /// As it is now: another object after it has changed.
    [[nodiscard]] const std::shared_ptr<const Image>& image();

    /// Metres of a pixel.
    static constexpr double kPixel = 0.0005;
    [[nodiscard]] static glm::dvec2 placeOf(int x, int y) noexcept;

private:
    /// What is frozen in, the same for the whole winter.
    struct Detail {
        std::uint8_t snow = 0, veins = 0, bubbles = 0, clear = 0, grain = 0;
    };
    /// Of a floe at a place, as FloeField.
    struct Ice {
        float shape = 1.0F, inland = 1.0F, thickness = 1.0F;
    };
    [[nodiscard]] static Image::Pixel colorOf(const Detail& detail, const Ice& ice);
    void paintRow(const FloeField& field, int y, int first, int end);

    Image now_;
    std::vector<Detail> details_;
    std::vector<Image::Pixel> usual_; ///< of whole ice far from all rims
    std::shared_ptr<const Image> shared_;
};

/// Of rims: from the bright edge at the top over the water's line to the foot.
[[nodiscard]] Image rimPicture();

} // namespace lumorph::ice
