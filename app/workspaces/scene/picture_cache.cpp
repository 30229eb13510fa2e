#include "app/workspaces/scene/picture_cache.h"

#include <algorithm>

namespace lumorph::studio {

namespace {

/// The middle square of a picture, one pixel of it for each that is shown: a large one must not take the window's time.
QImage smallCopy(const Image& image, int side) {
    QImage copy(side, side, QImage::Format_RGBA8888);
    const int square = std::min(image.size().x, image.size().y);
    const glm::ivec2 corner = (image.size() - square) / 2;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const auto& pixel =
                image.at(corner.x + (2 * x + 1) * square / (2 * side), corner.y + (2 * y + 1) * square / (2 * side));
            copy.setPixelColor(x, y, QColor(pixel[0], pixel[1], pixel[2], pixel[3]));
        }
    return copy;
}

} // namespace

QPixmap PictureCache::of(const SceneAssets* assets, const std::string& asset, int side) {
    const auto found =
        assets ? assets->images.find(asset) : std::map<std::string, std::shared_ptr<const Image>>::const_iterator();
    if (!assets || found == assets->images.end() || !found->second || found->second->size().x < 1) return {};
    if (found->second != shown_.lock()) {
        shown_ = found->second;
        small_ = QPixmap::fromImage(smallCopy(*found->second, side));
    }
    return small_;
}

} // namespace lumorph::studio
