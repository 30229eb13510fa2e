#pragma once

#include <cstdint>
#include <random>
#include <span>
#include <vector>

#include "app/applications/ice/polygon.h"

namespace lumorph::ice {

/// A convex piece of ice that nothing has broken yet.
struct Cell {
    Polygon outline;           ///< home coordinates; empty once it has melted
    double thickness = 1.0;    ///< share of the sheet's
    bool ashore = false;       ///< frozen to the bank
    int plate = 0;             ///< whose it is
    std::uint32_t version = 0; ///< another one after each change of its outline or of what holds it
};

/// Two cells that are still one piece of ice.
struct Bond {
    int a = 0;
    int b = 0;
    Segment edge;          ///< along which; home coordinates
    double strength = 1.0; ///< by chance, about 1
    double damage = 0.0;   ///< by stress so far; it gives way at its strength
};

/// The ice of the pond: a sheet that is divided into Voronoi cells, which break apart and melt. Cells never overlap in
/// home coordinates, and what leaves them is counted as melted.
class Sheet {
public:
    static constexpr double kGap = 0.0002;    ///< by which each side of a crack draws back, metres
    static constexpr std::size_t kMost = 260; ///< cells: what would make more is not divided further

    /// Frozen over from shore to shore, one plate.
    Sheet(const Polygon& shore, std::uint64_t seed);

    [[nodiscard]] const std::vector<Cell>& cells() const noexcept { return cells_; }
    [[nodiscard]] const std::vector<Bond>& bonds() const noexcept { return bonds_; }
    [[nodiscard]] double area() const noexcept { return area_; }     ///< when it was frozen over, square metres
    [[nodiscard]] double melted() const noexcept { return melted_; } ///< square metres
    [[nodiscard]] std::size_t alive() const noexcept;
    /// The cell of this plate over a place in home coordinates; -1 where there is none.
    [[nodiscard]] int cellAt(int plate, const glm::dvec2& home) const noexcept;
    /// Whether an edge of a cell is one with a neighbour.
    [[nodiscard]] bool isJoined(int cell, std::size_t edge) const noexcept;
    /// Whether a place on a cell's rim is in ice on both sides.
    [[nodiscard]] bool isInside(int cell, const glm::dvec2& home) const noexcept;

    /// Divides the cells of a plate nearer than `reach` to a place by these sites; they stay one piece.
    void divide(int plate, const glm::dvec2& home, double reach, std::span<const glm::dvec2> sites);
    /// A bond gives way; both cells draw back from it.
    void breakBond(std::size_t bond);
    void breakFromShore(int cell);
    void addDamage(std::size_t bond, double damage) noexcept { bonds_[bond].damage += damage; }
    /// What of a cell lies beyond a line melts.
    void cut(int cell, const HalfPlane& half);
    void thin(int cell, double share);
    void remove(int cell);

    /// Which cells hang together, as lists in order of their first cells; each cell is told its list's number.
    [[nodiscard]] std::vector<std::vector<int>> gatherPlates();
    /// Whether what hangs together may have changed since plates were gathered.
    [[nodiscard]] bool isDirty() const noexcept { return dirty_; }

private:
    [[nodiscard]] std::vector<Polygon> divided(const Polygon& outline, std::span<const glm::dvec2> sites) const;
    void drawBack(int cell, const Segment& edge);
    void take(int cell, Polygon outline);
    void simplify(int cell, Polygon& outline) const;
    void join(int a, int b);
    void dropLostBonds(int cell);

    Polygon shore_;
    std::mt19937_64 random_;
    std::vector<Cell> cells_;
    std::vector<Bond> bonds_;
    double area_ = 0.0, melted_ = 0.0;
    bool dirty_ = true;
};

} // namespace lumorph::ice
