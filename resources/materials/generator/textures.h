#pragma once

#include <string>
#include <vector>

#include "core/base/image.h"

/// The pictures of the ready materials, made from numbers alone.
namespace lumorph {

struct NamedPicture {
    std::string name; ///< of the file, without ending
    Image image;
};

[[nodiscard]] std::vector<NamedPicture> woodPictures();
[[nodiscard]] std::vector<NamedPicture> brickPictures();
[[nodiscard]] std::vector<NamedPicture> mapPictures();
[[nodiscard]] std::vector<NamedPicture> icePictures();
[[nodiscard]] std::vector<NamedPicture> waterPictures();
/// Paper, stone and metal.
[[nodiscard]] std::vector<NamedPicture> plainPictures();

} // namespace lumorph
