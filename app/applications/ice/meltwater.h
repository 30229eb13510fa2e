#pragma once

#include <cstdint>
#include <functional>
#include <random>
#include <span>
#include <vector>

#include "app/applications/ice/floe_field.h"
#include "app/applications/ice/ice_cover.h"

namespace lumorph::ice {

/// Water of a floe that has just been ice: a head that runs, and the wet way behind it.
struct Rivulet {
    struct Point {
        glm::dvec2 home{0.0};
        double age = 0.0; ///< seconds
    };
    int floe = 0;             ///< its number
    double volume = 1.0;      ///< of a drop
    glm::dvec2 home{0.0};     ///< of the head
    glm::dvec2 velocity{0.0}; ///< home coordinates, metres a second
    std::vector<Point> way;   ///< oldest first
    double age = 0.0;         ///< seconds
    double wander = 0.0;      ///< phase of its bends, radians
    bool runs = true;         ///< false once it has dripped or run into another
};

/// What gathers under warmth before it runs.
struct Puddle {
    int floe = 0;
    glm::dvec2 home{0.0};
    double volume = 0.0; ///< of a drop
};

/// Where a drop fell into the pond.
struct Drip {
    glm::dvec2 place{0.0}; ///< x and z of the device
    double volume = 1.0;
    double age = 0.0; ///< seconds
};

struct MeltingWeather {
    std::span<const Warmth> warmths;
    glm::dvec2 lean{0.0}; ///< of the device, radians, as Visitor::lean
    double thaw = 0.0;    ///< as Surroundings
};

/// Meltwater on floes: puddles gather under warmth, and drops run from there down the lean and towards the rim, join
/// where they meet, and drip into the pond. For the eye alone: it takes no ice. The same calls give the same water.
class Meltwater {
public:
    /// The field of a floe by its number; null where none is known.
    using Fields = std::function<const FloeField*(int)>;
    static constexpr double kWayLasts = 3.6;   ///< seconds until a wet way has dried
    static constexpr double kDripLasts = 1.2;  ///< seconds that a ring is seen
    static constexpr double kMostPuddle = 9.0; ///< volume
    static constexpr std::size_t kMostRivulets = 48, kMostDrips = 14, kMostPuddles = 8;

    explicit Meltwater(std::uint64_t seed) : random_(seed) {}

    void advance(const IceCover& ice, const Fields& fields, const MeltingWeather& weather, double seconds);

    [[nodiscard]] const std::vector<Rivulet>& rivulets() const noexcept { return rivulets_; }
    [[nodiscard]] const std::vector<Puddle>& puddles() const noexcept { return puddles_; }
    [[nodiscard]] const std::vector<Drip>& drips() const noexcept { return drips_; }

    /// Metres across half of a puddle.
    [[nodiscard]] static double radiusOf(const Puddle& puddle) noexcept;

private:
    void step(const IceCover& ice, const Fields& fields, const MeltingWeather& weather);
    void gather(const Floe& floe, const FloeField& field, const Warmth& warmth);
    void weep(const Floe& floe, const FloeField& field, const glm::dvec2& home, const Warmth& warmth);
    void drain(const Floe& floe, const FloeField& field);
    void thaw(const IceCover& ice, const MeltingWeather& weather);
    void begin(const Floe& floe, const glm::dvec2& home, double volume);
    void run(Rivulet& rivulet, const Floe& floe, const FloeField& field, const glm::dvec2& lean);
    void join(Rivulet& rivulet);
    void dry(const IceCover& ice);
    void drip(const glm::dvec2& place, double volume);

    std::mt19937_64 random_;
    std::vector<Rivulet> rivulets_;
    std::vector<Puddle> puddles_;
    std::vector<Drip> drips_;
    double left_ = 0.0, due_ = 0.0; ///< seconds that no step has taken yet; drops of a thaw that are due
};

} // namespace lumorph::ice
