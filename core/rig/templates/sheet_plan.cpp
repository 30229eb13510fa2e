#include "core/rig/templates/sheet_plan.h"

#include <algorithm>
#include <numeric>

#include "core/base/error.h"
#include "core/base/text.h"

namespace lumorph {
namespace {

/// The line that an error of `sheetRig` names, by its place in the list; names there are unique, or that is the error.
std::optional<std::size_t> lineNamed(const InvalidInput& error, const std::vector<BendLine>& bends) {
    for (std::size_t k = bends.size(); k-- > 0;)
        if (error.subject().ends_with(inQuotes(bends[k].name))) return k;
    return std::nullopt;
}

} // namespace

SheetPlan planSheet(const SheetDevice& device, const Progress& progress) {
    SheetPlan plan;
    plan.flaps.resize(device.bends.size());
    plan.actuators.resize(device.bends.size());
    SheetDevice made = device;
    std::vector<std::size_t> lines(device.bends.size()); // of `made`, as places in `device`
    std::iota(lines.begin(), lines.end(), std::size_t{0});
    while (!plan.rig) {
        try {
            const auto flaps = sheetFlaps(made);
            plan.rig = std::make_shared<const Rig>(sheetRig(made, progress, SheetQuality::preview));
            for (std::size_t k = 0; k < lines.size(); ++k) {
                plan.flaps[lines[k]] = flaps[k];
                plan.actuators[lines[k]] = k;
            }
        } catch (const InvalidInput& error) {
            const auto line = lineNamed(error, made.bends);
            plan.refusals.push_back(
                {line ? std::optional(lines[*line]) : std::nullopt, error.subject(), error.why(), error.remedy()});
            if (!line) break;
            made.bends.erase(made.bends.begin() + static_cast<std::ptrdiff_t>(*line));
            lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(*line));
        }
    }
    return plan;
}

} // namespace lumorph
