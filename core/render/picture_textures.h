#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <tuple>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/render/gl_objects.h"
#include "core/render/image.h"

namespace lumorph {

/// Pictures of a scene as repeating textures with mipmaps, by their identity. One context.
class PictureTextures {
public:
    /// `color` is decoded from sRGB where it is sampled; `data` (normal maps, masks) is taken as it is.
    enum class Use { color, data };
    struct Picture {
        GLuint texture = 0;
        glm::ivec2 size{1};     ///< of the texture
        bool hasAlpha = false; ///< some of it is not opaque
        glm::vec3 mean{1.0F};  ///< linear, of a colour picture
    };

    /// A whole picture, or one of the `columns` x `rows` of a flip-book counted along the rows from the top left.
    /// Larger pictures than the driver holds are halved.
    [[nodiscard]] Picture picture(const std::shared_ptr<const Image>& image, Use use, glm::ivec2 grid = glm::ivec2(1),
                                  int cell = 0);
    /// Forgets the pictures that were not asked for since the last call but one.
    void sweep();
    [[nodiscard]] std::size_t objectCount() const noexcept { return entries_.size(); }

private:
    struct Entry {
        std::shared_ptr<const Image> image; ///< held, so that its address stays its own
        gl::Texture texture;
        Picture picture;
        std::uint64_t lastUse = 0;
    };
    using Key = std::tuple<const Image*, Use, int, int, int>;

    std::map<Key, Entry> entries_;
    std::uint64_t round_ = 1;
};

} // namespace lumorph
