#pragma once

#include <memory>
#include <span>
#include <vector>

#include "app/applications/ice/polygon.h"

namespace lumorph::ice {

/// How a body lies and moves in the plane of the water, metres and seconds.
struct FloeMotion {
    Placement placement;
    glm::dvec2 velocity{0.0}; ///< of its centre of mass
    double spin = 0.0;        ///< radians a second, from x to z
};

/// Two bodies that met in the last step, or one and the bank.
struct FloeBump {
    int a = -1; ///< number of a body; -1: the bank
    int b = -1;
    glm::dvec2 place{0.0};   ///< where
    glm::dvec2 impulse{0.0}; ///< on b, over the density of the ice by area: cubic metres a second
};

/// Floes as rigid bodies (Bullet): prisms of convex pieces that slide in the plane of the water, slowed by its drag,
/// and keep clear of one another and of the bank. One thread, no chance: the same calls give the same numbers, bit for
/// bit.
class FloeWorld {
public:
    static constexpr double kStep = 1.0 / 60.0; ///< seconds

    /// Within a convex bank.
    explicit FloeWorld(const Polygon& shore);
    ~FloeWorld();
    FloeWorld(FloeWorld&&) noexcept;
    FloeWorld& operator=(FloeWorld&&) noexcept;

    /// A body of these pieces, in home coordinates; its number. One that is fixed never moves.
    int add(std::span<const Polygon> pieces, const FloeMotion& motion, bool fixed);
    /// Another shape for a body, which goes on moving as it did.
    void reshape(int body, std::span<const Polygon> pieces);
    void remove(int body);
    void clear();

    /// Metres a second squared, in the next step.
    void push(int body, const glm::dvec2& acceleration);
    void step();

    [[nodiscard]] FloeMotion motion(int body) const;
    /// Velocity of the place of a body that lies there now.
    [[nodiscard]] glm::dvec2 velocityAt(int body, const glm::dvec2& place) const;
    [[nodiscard]] const std::vector<FloeBump>& bumps() const noexcept;

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph::ice
