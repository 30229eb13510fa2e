#include "calibration/lab/lab_photograph.h"

#include <algorithm>

#include "core/base/error.h"

namespace lumorph {

namespace {

constexpr double kBrightestShare = 0.99; // of the pixels: what shines back more may be overexposed

} // namespace

Image pictureOf(const cv::Mat& grey) {
    Image picture(glm::ivec2(grey.cols, grey.rows));
    std::transform(grey.begin<std::uint8_t>(), grey.end<std::uint8_t>(), picture.pixels().begin(),
                   [](std::uint8_t value) {
                       return Image::Pixel{value, value, value, 255};
                   });
    return picture;
}

cv::Mat1f lightIn(const Lab& lab, const LabSight& sight) {
    const std::vector<glm::vec3> radiance = lab.radiance(sight);
    cv::Mat1f light(sight.size.y, sight.size.x);
    std::ranges::transform(radiance, light.begin(),
                           [](const glm::vec3& one) { return (one.r + one.g + one.b) / 3.0F; });
    return light;
}

double exposureOf(Lab& lab, const LabSight& sight, double white, const char* what) {
    for (std::size_t i = 0; i < lab.projectors(); ++i)
        lab.show(i, Image(lab.projector(i).camera.size, {255, 255, 255, 255}));
    cv::Mat1f light = lightIn(lab, sight).reshape(1, 1);
    const auto at = light.begin() + static_cast<std::ptrdiff_t>(kBrightestShare * static_cast<double>(light.total()));
    std::nth_element(light.begin(), at, light.end());
    if (!(*at > 0.0F))
        throw InvalidInput(what, "its camera sees nothing that the projector lights",
                           "place camera and projector so that both see the device");
    return white / static_cast<double>(*at);
}

} // namespace lumorph
