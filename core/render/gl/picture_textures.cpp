#include "core/render/gl/picture_textures.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <epoxy/gl.h>
#include <glm/common.hpp>

#include "core/render/gl/gl_driver.h"

namespace lumorph {
namespace {

constexpr std::uint64_t kRoundsKept = 240; // what is hidden is often shown again
constexpr float kAnisotropy = 8.0F;

Image cutOut(const Image& image, glm::ivec2 grid, int cell) {
    const glm::ivec2 size = glm::max(image.size() / grid, glm::ivec2(1));
    const glm::ivec2 corner = size * glm::ivec2(cell % grid.x, cell / grid.x);
    Image piece(size);
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x)
            piece.at(x, y) =
                image.at(std::min(corner.x + x, image.size().x - 1), std::min(corner.y + y, image.size().y - 1));
    return piece;
}

void upload(GLuint texture, const Image& image, PictureTextures::Use use) {
    const GLint format = use == PictureTextures::Use::color ? GL_SRGB8_ALPHA8 : GL_RGBA8;
    glBindTexture(GL_TEXTURE_2D, texture);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, format, image.size().x, image.size().y, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                 image.pixels().data());
    glGenerateMipmap(GL_TEXTURE_2D);
    // A processor that draws pays for every texel: a quarter of the frame between the finest filter and a plain one.
    const bool slow = currentDriver().software;
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, slow ? GL_LINEAR_MIPMAP_NEAREST : GL_LINEAR_MIPMAP_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    if (!slow && epoxy_has_gl_extension("GL_EXT_texture_filter_anisotropic"))
        glTexParameterf(GL_TEXTURE_2D, GL_TEXTURE_MAX_ANISOTROPY_EXT, kAnisotropy);
    glBindTexture(GL_TEXTURE_2D, 0);
}

bool anyClear(const Image& image) {
    return std::any_of(image.pixels().begin(), image.pixels().end(), [](const auto& pixel) { return pixel[3] < 255; });
}

// Some thousand pixels tell it well enough.
glm::vec3 meanOf(const Image& image) {
    const auto& pixels = image.pixels();
    const std::size_t step = std::max<std::size_t>(pixels.size() / 4093, 1);
    glm::dvec3 sum(0.0);
    double count = 0.0;
    for (std::size_t i = 0; i < pixels.size(); i += step, count += 1.0)
        for (int c = 0; c < 3; ++c) sum[c] += std::pow(pixels[i][static_cast<std::size_t>(c)] / 255.0, 2.2);
    return glm::vec3(sum / count);
}

PictureTextures::Picture uploaded(const gl::Texture& texture, const Image& image, PictureTextures::Use use,
                                  glm::ivec2 grid, int cell) {
    GLint largest = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
    Image shown = grid == glm::ivec2(1) ? image : cutOut(image, grid, cell);
    while (std::max(shown.size().x, shown.size().y) > largest) shown = halved(shown);
    upload(texture.name(), shown, use);
    return {texture.name(), shown.size(), anyClear(image), meanOf(shown)};
}

} // namespace

PictureTextures::Picture PictureTextures::picture(const std::shared_ptr<const Image>& image, Use use, glm::ivec2 grid,
                                                  int cell) {
    if (!image || image->size().x < 1 || image->size().y < 1) return {};
    grid = glm::max(grid, glm::ivec2(1));
    if (grid == glm::ivec2(1)) cell = 0;
    Sheet& sheet = sheets_[{image.get(), use, grid.x, grid.y}];
    sheet.image = image;
    sheet.lastUse = round_;
    if (!sheet.cells.contains(cell) && sheet.cells.size() >= kMostCells)
        sheet.cells.erase(std::min_element(sheet.cells.begin(), sheet.cells.end(), [](const auto& a, const auto& b) {
            return a.second.lastUse < b.second.lastUse;
        }));
    const auto [found, added] = sheet.cells.try_emplace(cell);
    Cell& shown = found->second;
    shown.lastUse = round_;
    if (added) shown.picture = uploaded(shown.texture, *image, use, grid, cell);
    return shown.picture;
}

void PictureTextures::sweep() {
    std::erase_if(sheets_, [&](const auto& entry) { return entry.second.lastUse + kRoundsKept < round_; });
    ++round_;
}

void PictureTextures::keepOnly(const std::set<const Image*>& images) {
    std::erase_if(sheets_, [&](const auto& entry) { return !images.contains(entry.second.image.get()); });
}

std::size_t PictureTextures::objectCount() const noexcept {
    std::size_t count = 0;
    for (const auto& [key, sheet] : sheets_) count += sheet.cells.size();
    return count;
}

} // namespace lumorph
