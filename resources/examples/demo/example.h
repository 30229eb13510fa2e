#pragma once

#include <cstdint>

#include <glm/vec2.hpp>

#include "app/applications/demo.h"
#include "core/loop/show_program.h"
#include "core/voxels/height_grid.h"

/// A ball that goes where the visitor points, on a hill that hands feel.
namespace lumorph::example {

class ExampleProgram final : public ShowProgram {
public:
    static constexpr double kSilence = 45.0; ///< seconds without a visitor until it plays by itself

    [[nodiscard]] ShowContent frame(const ShowMoment& moment) override;

private:
    void listen(const ShowMoment& moment);
    /// How high the device stands at a place, metres above its sheet.
    [[nodiscard]] double heightAt(const glm::dvec2& place) const;
    [[nodiscard]] HeightGrid heights() const;
    [[nodiscard]] Scene scene() const;

    double seconds_ = 0.0;      ///< of the show
    double silence_ = kSilence; ///< seconds since a visitor did something
    glm::dvec2 pointed_{0.0};   ///< where the visitor points: x and z of the device, metres
    glm::dvec2 ball_{0.0};      ///< where the ball is, likewise
};

[[nodiscard]] Demo exampleDemo();

} // namespace lumorph::example
