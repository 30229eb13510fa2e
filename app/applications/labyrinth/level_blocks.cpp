#include "app/applications/labyrinth/level_blocks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace lumorph::labyrinth {
namespace {

constexpr double kRailWidth = 0.0008;  ///< metres
constexpr double kRailHeight = 0.0015; ///< over the deck
constexpr int kHoleSides = 16;         ///< a multiple of eight: the cell's corners and middles of sides are among them
constexpr double kTread = 0.00075;     ///< rise of one stair, at most

struct Rectangle {
    glm::dvec2 min, max;
};

class Blocks {
public:
    explicit Blocks(const Level& level) : level_(level), taken_(level.cells.size(), false) {}

    std::vector<Block> build() {
        for (int row = 0; row < level_.rows; ++row)
            for (int column = 0; column < level_.columns; ++column) addCell({column, row});
        return std::move(blocks_);
    }

private:
    /// What makes cells one block: their kind and the height of their top.
    struct Flat {
        Block::Kind kind;
        double top;
        bool operator==(const Flat&) const = default;
    };

    std::optional<Flat> flatOf(glm::ivec2 cell) const {
        const LevelCell& here = level_.at(cell);
        if (here.tile == Tile::floor) return Flat{Block::Kind::floor, here.height * level_.step};
        if (here.tile == Tile::wall) return Flat{Block::Kind::wall, wallTop(level_, cell)};
        return std::nullopt;
    }

    void addCell(glm::ivec2 cell) {
        if (taken(cell)) return;
        if (const std::optional<Flat> flat = flatOf(cell)) return addFlat(cell, *flat);
        switch (level_.at(cell).tile) {
        case Tile::hole:
            return addHole(cell);
        case Tile::ramp:
            return addRamp(cell);
        case Tile::stairs:
            return addStairs(cell);
        default:
            return addBridge(cell);
        }
    }

    std::vector<bool>::reference taken(glm::ivec2 cell) {
        return taken_[static_cast<std::size_t>(cell.y) * static_cast<std::size_t>(level_.columns) +
                      static_cast<std::size_t>(cell.x)];
    }

    bool joins(glm::ivec2 cell, const Flat& flat) { return level_.holds(cell) && !taken(cell) && flatOf(cell) == flat; }

    /// The largest rectangle along the row, then as many rows as are alike.
    void addFlat(glm::ivec2 cell, const Flat& flat) {
        int width = 1;
        while (joins(cell + glm::ivec2(width, 0), flat)) ++width;
        int depth = 1;
        const auto rowJoins = [&](int row) {
            for (int k = 0; k < width; ++k)
                if (!joins(cell + glm::ivec2(k, row), flat)) return false;
            return true;
        };
        while (rowJoins(depth)) ++depth;
        for (int row = 0; row < depth; ++row)
            for (int k = 0; k < width; ++k) taken(cell + glm::ivec2(k, row)) = true;
        addBox(flat.kind, {corner(cell), corner(cell + glm::ivec2(width, depth))}, kGround, flat.top);
    }

    glm::dvec2 corner(glm::ivec2 cell) const { return centreOf(level_, cell) - 0.5 * level_.cell; }
    Rectangle areaOf(glm::ivec2 cell) const { return {corner(cell), corner(cell + 1)}; }

    void addBox(Block::Kind kind, const Rectangle& area, double bottom, double top) {
        addQuad(kind, {area.min, {area.max.x, area.min.y}, area.max, {area.min.x, area.max.y}}, bottom,
                {top, top, top, top});
    }
    void addQuad(Block::Kind kind, const std::array<glm::dvec2, 4>& outline, double bottom,
                 const std::array<double, 4>& tops) {
        blocks_.push_back({kind, outline, bottom, tops});
    }

    /// A ring between a circle and the cell's square, along rays from the middle.
    void addHole(glm::ivec2 cell) {
        const glm::dvec2 centre = centreOf(level_, cell);
        const double top = level_.at(cell).height * level_.step;
        const auto ray = [](int k) {
            const double angle = 2.0 * std::numbers::pi * k / kHoleSides;
            return glm::dvec2(std::cos(angle), std::sin(angle));
        };
        const auto onSquare = [&](const glm::dvec2& way) {
            return centre + 0.5 * level_.cell * way / std::max(std::abs(way.x), std::abs(way.y));
        };
        for (int k = 0; k < kHoleSides; ++k) {
            const glm::dvec2 one = ray(k), next = ray(k + 1);
            const double radius = kHoleRadius * level_.cell;
            addQuad(Block::Kind::floor, {onSquare(one), onSquare(next), centre + radius * next, centre + radius * one},
                    kGround, {top, top, top, top});
        }
    }

    void addRamp(glm::ivec2 cell) {
        const Way way = level_.at(cell).way;
        const double low = groundAt(level_, cell, opposite(way)).value_or(0.0);
        const double high = groundAt(level_, cell, way).value_or(low);
        const Rectangle area = areaOf(cell);
        const std::array<glm::dvec2, 4> outline{area.min, glm::dvec2(area.max.x, area.min.y), area.max,
                                                glm::dvec2(area.min.x, area.max.y)};
        std::array<double, 4> tops{};
        for (std::size_t k = 0; k < 4; ++k) {
            const glm::dvec2 from = outline[k] - centreOf(level_, cell);
            tops[k] = from.x * stepOf(way).x + from.y * stepOf(way).y > 0.0 ? high : low;
        }
        addQuad(Block::Kind::slope, outline, kGround, tops);
    }

    void addStairs(glm::ivec2 cell) {
        const Way way = level_.at(cell).way;
        const double low = groundAt(level_, cell, opposite(way)).value_or(0.0);
        const double high = groundAt(level_, cell, way).value_or(low);
        const int treads = std::max(2, static_cast<int>(std::ceil((high - low) / kTread - 1e-6)));
        for (int k = 0; k < treads; ++k) {
            Rectangle area = areaOf(cell);
            const double from = static_cast<double>(k) / treads, to = static_cast<double>(k + 1) / treads;
            const int axis = isAcross(way) ? 0 : 1;
            const double start = area.min[axis], end = area.max[axis];
            const bool positive = stepOf(way)[axis] > 0;
            area.min[axis] = std::lerp(start, end, positive ? from : 1.0 - to);
            area.max[axis] = std::lerp(start, end, positive ? to : 1.0 - from);
            addBox(Block::Kind::slope, area, kGround, std::lerp(low, high, to));
        }
    }

    void addBridge(glm::ivec2 cell) {
        const LevelCell& bridge = level_.at(cell);
        const Rectangle area = areaOf(cell);
        const double deck = deckOf(level_, cell).value_or(0.0);
        addBox(Block::Kind::floor, area, kGround, bridge.height * level_.step);
        addBox(Block::Kind::deck, area, deck - kDeckThickness, deck);
        const int across = isAcross(bridge.way) ? 1 : 0;
        for (const bool far : {false, true}) {
            Rectangle rail = area;
            (far ? rail.min : rail.max)[across] = far ? area.max[across] - kRailWidth : area.min[across] + kRailWidth;
            addBox(Block::Kind::rail, rail, deck, deck + kRailHeight);
        }
    }

    const Level& level_;
    std::vector<bool> taken_;
    std::vector<Block> blocks_;
};

} // namespace

std::vector<Block> blocksOf(const Level& level) { return Blocks(level).build(); }

double topAt(const Block& block, const glm::dvec2& place) noexcept {
    for (std::size_t k = 0; k < 4; ++k) {
        const glm::dvec2 side = block.outline[(k + 1) % 4] - block.outline[k];
        const glm::dvec2 from = place - block.outline[k];
        if (side.x * from.y - side.y * from.x < -1e-15) return std::numeric_limits<double>::quiet_NaN();
    }
    // The plane through the first corner, spanned by the sides that meet there.
    const glm::dvec2 u = block.outline[1] - block.outline[0], v = block.outline[3] - block.outline[0];
    const glm::dvec2 p = place - block.outline[0];
    const double area = u.x * v.y - u.y * v.x;
    const double s = (p.x * v.y - p.y * v.x) / area, t = (u.x * p.y - u.y * p.x) / area;
    return block.tops[0] + s * (block.tops[1] - block.tops[0]) + t * (block.tops[3] - block.tops[0]);
}

} // namespace lumorph::labyrinth
