#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "app/applications/navigation/height_map.h"
#include "core/base/words.h"

namespace lumorph::navigation {

/// Somewhere to fly to.
struct Place {
    Words name;
    glm::dvec2 at{0.0};   ///< metres
    double width = 800.0; ///< of the ground that is seen when one is there, metres
    int rank = 1;         ///< 0 is named first when there is no room for all
};

/// Colours of things, cells of the palette picture.
enum class Paint : std::uint8_t {
    white,
    cream,
    sand,
    rose,
    wood,
    stone,
    tile,
    brick,
    rust,
    slate,
    ochre,
    copper,
    leaf,
    moss,
    fir,
    spruce,
    deepWater,
    earth,
    clay,
    rock,
    sail,
    grey,
    straw,
    dove,
    sage
};
inline constexpr int kPaints = static_cast<int>(Paint::sage) + 1;

inline constexpr int kShades = 16; ///< of each paint: no two roofs are quite alike

/// A solid with upright walls on the ground: a house, a tower, a bridge.
struct Building {
    enum class Roof : std::uint8_t { flat, gable, pyramid, hip };
    std::vector<glm::dvec2> outline; ///< convex, clockwise seen from above (x to the east, y to the south), metres
    double base = 0.0;               ///< heights over the sea, metres: from here
    double eaves = 6.0;              ///< to the roof
    double ridge = 9.0;              ///< and to its top; of a flat roof: as eaves
    Roof roof = Roof::flat;          ///< the ridge of a gable or hip runs along the outline's first side of four
    Paint walls = Paint::cream, top = Paint::tile;
    std::uint8_t shade = 0; ///< which shade of its paints, of kShades
    bool windows = false;   ///< in its walls, storey over storey
    bool landmark = false;  ///< never left out from afar
    bool grounded = true;   ///< stands on the ground as it is drawn; false: at its height, on water or in the air
    double over = 0.0;      ///< metres of air below it, over that ground: an upper part of something
    /// Middle of the building of which this is a convex piece: all of them stand and grow as one.
    std::optional<glm::dvec2> whole;
};

struct Road {
    std::vector<glm::dvec2> line; ///< metres
    double width = 6.0;           ///< metres
    glm::vec3 color{0.88F, 0.84F, 0.74F};
};

/// A piece of ground in one colour: a meadow, a square.
struct Parcel {
    std::vector<glm::dvec2> outline; ///< convex, clockwise seen from above, metres
    glm::vec3 color{0.6F};           ///< sRGB
    float furrows = 0.0F;            ///< how strongly it is striped along its first side, 0 to 1
    double hedge = 0.0;              ///< width of the hedge along its rim, metres
};

/// A tree that stands by itself, in a garden or beside a road.
struct Tree {
    glm::dvec2 at{0.0};  ///< metres
    double height = 9.0; ///< metres
};

/// A map of some land, as a plain value. Places as of HeightMap.
struct Map {
    std::string title;
    HeightMap heights;
    std::vector<float> water;     ///< height of the water's surface at each sample; NaN on dry land; empty: none
    std::vector<glm::vec3> cover; ///< sRGB colour of the ground at each sample
    std::vector<float> woods;     ///< share of each sample under trees, 0 to 1; empty: none
    std::vector<Parcel> parcels;
    std::vector<Road> roads;
    std::vector<Building> buildings;
    std::vector<Tree> trees; ///< beside those of the woods
    std::vector<Place> places;

    [[nodiscard]] std::size_t index(glm::ivec2 sample) const noexcept {
        return static_cast<std::size_t>(sample.y) * static_cast<std::size_t>(heights.samples().x) +
               static_cast<std::size_t>(sample.x);
    }
    /// Whether a place is on it; beyond it there is the bare board on which it lies.
    [[nodiscard]] bool holds(const glm::dvec2& place) const noexcept;
    /// The sample nearest to a place.
    [[nodiscard]] glm::ivec2 sampleAt(const glm::dvec2& place) const noexcept;
    [[nodiscard]] bool isWater(glm::ivec2 sample) const noexcept;
    /// The water's surface near a place; NaN where none is near.
    [[nodiscard]] double waterAt(const glm::dvec2& place) const noexcept;
    [[nodiscard]] double woodsAt(const glm::dvec2& place) const noexcept;
};

} // namespace lumorph::navigation
