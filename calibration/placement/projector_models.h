#pragma once

#include <optional>
#include <span>
#include <string_view>

#include <glm/vec2.hpp>

#include "calibration/placement/light_plan.h"

namespace lumorph {

/// A projector that is sold, as far as its lens matters.
struct ProjectorModel {
    /// How far the picture's middle can lie above the lens' axis, in picture heights; both the same: it is fixed.
    struct Shift {
        double least = 0.0;
        double most = 0.0;
    };

    std::string_view name;
    glm::ivec2 size{0};      ///< pixels of its panel, whatever it takes in
    double throwLeast = 0.0; ///< as in ProjectorLens
    double throwMost = 0.0;
    std::optional<Shift> shift; ///< empty: its maker does not say
};

/// Common ones, by throw ratio, the shortest first.
[[nodiscard]] std::span<const ProjectorModel> projectorModels();
/// By its name in any case; none where the table has no such.
[[nodiscard]] const ProjectorModel* findProjectorModel(std::string_view name);
/// The lens with its picture shifted as wished, as far as it goes; as wished where nobody knows how far it goes.
[[nodiscard]] ProjectorLens lensOf(const ProjectorModel& model, double wishedShift = 0.0);

} // namespace lumorph
