#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <tuple>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/base/image.h"
#include "core/render/gl/gl_objects.h"

namespace lumorph {

/// Pictures of a scene as repeating textures with mipmaps, by their identity. One context.
class PictureTextures {
public:
    /// `color` is decoded from sRGB where it is sampled; `data` (normal maps, masks) is taken as it is.
    enum class Use { color, data };
    struct Picture {
        GLuint texture = 0;
        glm::ivec2 size{1};    ///< of the texture
        bool hasAlpha = false; ///< some of it is not opaque
        glm::vec3 mean{1.0F};  ///< linear, of a colour picture
    };

    /// A whole picture, or one of the `columns` x `rows` of a flip-book counted along the rows from the top left.
    /// Larger pictures than the driver holds are halved.
    [[nodiscard]] Picture picture(const std::shared_ptr<const Image>& image, Use use, glm::ivec2 grid = glm::ivec2(1),
                                  int cell = 0);
    /// Begins a round; forgets the pictures that nobody asked for in the last 240.
    void sweep();
    /// Forgets all pictures but these.
    void keepOnly(const std::set<const Image*>& images);
    [[nodiscard]] std::size_t objectCount() const noexcept;

    /// Of one flip-book; of a longer one the cells shown last are kept.
    static constexpr std::size_t kMostCells = 256;

private:
    struct Cell {
        gl::Texture texture;
        Picture picture;
        std::uint64_t lastUse = 0;
    };
    /// A flip-book comes round again, so its cells are kept as long as it is in use.
    struct Sheet {
        std::shared_ptr<const Image> image; ///< held, so that its address stays its own
        std::map<int, Cell> cells;
        std::uint64_t lastUse = 0;
    };
    using Key = std::tuple<const Image*, Use, int, int>;

    std::map<Key, Sheet> sheets_;
    std::uint64_t round_ = 1;
};

} // namespace lumorph
