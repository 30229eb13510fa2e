#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/progress.h"
#include "core/rig/rig.h"
#include "core/rig/templates/sheet_device.h"

namespace lumorph {

/// What can be chosen of a template.
struct TemplateParameter {
    enum class Unit { centimetres, degrees, count, word };
    std::string_view name;
    std::string_view meaning;
    Unit unit = Unit::centimetres;
    double value = 0.0; ///< as it is without a choice
    double min = 0.0;
    double max = 0.0;
    std::vector<std::string_view> words{}; ///< of which the value is the place, where the unit is a word
    int onlyWith = -1; ///< means something only while the template's word has this value; -1: always
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

/// "width=21cm", "width=210mm", "angle=80deg", "top=cut" or a number in the parameter's unit. Throws InvalidInput.
[[nodiscard]] TemplateChoice parseChoice(const RigTemplate& kind, std::string_view text);

/// Whether a parameter means something with these choices.
[[nodiscard]] bool applies(const RigTemplate& kind, const TemplateParameter& parameter,
                           std::span<const TemplateChoice> choices);

/// A rig of the template, with what has been chosen; the last choice of a parameter counts. A continuous top takes up
/// to half a minute, but the tablet without choices is read from the bundled file. Throws InvalidInput naming a
/// parameter that is not there or out of range, or with which a part would vanish.
[[nodiscard]] Rig rigOf(const RigTemplate& kind, std::span<const TemplateChoice> choices, const Progress& progress = {},
                        SheetQuality quality = SheetQuality::full);

} // namespace lumorph
