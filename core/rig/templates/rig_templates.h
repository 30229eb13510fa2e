#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/progress.h"
#include "core/rig/rig.h"

namespace lumorph {

/// What can be chosen of a template.
struct TemplateParameter {
    enum class Unit { centimetres, degrees, count };
    std::string_view name;
    std::string_view meaning;
    Unit unit = Unit::centimetres;
    double value = 0.0; ///< as it is without a choice
    double min = 0.0;
    double max = 0.0;
};

/// A kind of device to begin with.
struct RigTemplate {
    std::string_view name;
    std::string_view meaning;
    std::vector<TemplateParameter> parameters;
};

/// tablet, phone, pins, flower, book, cushion, sheet.
[[nodiscard]] std::span<const RigTemplate> rigTemplates();
/// Throws InvalidInput naming those there are.
[[nodiscard]] const RigTemplate& rigTemplate(std::string_view name);

/// A parameter's value, in its unit, by its name.
using TemplateChoice = std::pair<std::string, double>;

/// "width=21cm", "width=210mm", "angle=80deg" or a number in the parameter's unit. Throws InvalidInput.
[[nodiscard]] TemplateChoice parseChoice(const RigTemplate& kind, std::string_view text);

/// A rig of the template, with what has been chosen; the last choice of a parameter counts.
/// Throws InvalidInput naming a parameter that is not there or out of range, or with which a part would vanish.
[[nodiscard]] Rig rigOf(const RigTemplate& kind, std::span<const TemplateChoice> choices,
                        const Progress& progress = {});

} // namespace lumorph
