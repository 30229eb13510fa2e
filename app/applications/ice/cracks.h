#pragma once

#include <random>
#include <vector>

#include "app/applications/ice/sheet.h"

namespace lumorph::ice {

/// Cracks on their way through a sheet: each tip runs along the edges of cells, as straight on as they let it, forks
/// now and then, and ends in open water, at the bank, or when its energy is spent.
class Cracks {
public:
    static constexpr double kSpeed = 0.16; ///< metres a second: slow enough to be watched

    explicit Cracks(std::uint64_t seed) : random_(seed) {}

    /// A crack from a place (home coordinates) this way, for at most so many metres.
    void start(const glm::dvec2& home, const glm::dvec2& direction, double length);
    /// Lets them run for a while; true when something broke.
    bool advance(Sheet& sheet, const Polygon& shore, double seconds);
    void clear() { tips_.clear(); }
    [[nodiscard]] bool running() const noexcept { return !tips_.empty(); }

private:
    struct Tip {
        glm::dvec2 at{0.0};
        glm::dvec2 direction{1.0, 0.0};
        double left = 0.0;  ///< metres
        double waits = 0.0; ///< seconds until the next bond gives way
    };
    [[nodiscard]] bool run(Tip& tip, Sheet& sheet, std::vector<Tip>& forks);

    std::mt19937_64 random_;
    std::vector<Tip> tips_;
};

} // namespace lumorph::ice
