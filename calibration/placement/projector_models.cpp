#include "calibration/placement/projector_models.h"

#include <algorithm>
#include <array>
#include <string>

#include "core/base/text.h"

namespace lumorph {
namespace {

using Shift = ProjectorModel::Shift;

/// An "offset" of 116 % in a data sheet: the picture's upper edge lies 1.16 picture heights above the lens' axis.
constexpr Shift offset(double percentLeast, double percentMost) {
    return {0.01 * percentLeast - 0.5, 0.01 * percentMost - 0.5};
}

constexpr std::array kModels{
    // Optoma's product page of the GT1080HDR: throw ratio 0.496:1, offset 116 %.
    ProjectorModel{"Optoma GT1080HDR", {1920, 1080}, 0.496, 0.496, offset(116, 116)},
    // BenQ's product page of the TH671ST: 0.69 to 0.83.
    ProjectorModel{"BenQ TH671ST", {1920, 1080}, 0.69, 0.83, std::nullopt},
    // XGIMI's product page of the MoGo 2 Pro: 1.2:1.
    ProjectorModel{"XGIMI MoGo 2 Pro", {1920, 1080}, 1.2, 1.2, std::nullopt},
    // Epson's specifications of the EH-TW7100 (Home Cinema 3800): 1.32 to 2.15, lens shift 60 % up and down.
    ProjectorModel{"Epson EH-TW7100", {1920, 1080}, 1.32, 2.15, Shift{-0.60, 0.60}},
    // Epson's specifications of the EH-TW7400: 1.35 to 2.84, lens shift 96.3 % up and down.
    ProjectorModel{"Epson EH-TW7400", {1920, 1080}, 1.35, 2.84, Shift{-0.963, 0.963}},
    // BenQ's manual of the SX914, "Projection dimensions": 1544 to 2479 mm for a width of 1016 mm, offset 115 to 125 %.
    ProjectorModel{"BenQ SX914", {1024, 768}, 1.52, 2.44, offset(115, 125)},
};

} // namespace

std::span<const ProjectorModel> projectorModels() { return kModels; }

const ProjectorModel* findProjectorModel(std::string_view name) {
    const std::string wanted = lowerCase(name);
    const auto found =
        std::ranges::find_if(kModels, [&](const ProjectorModel& model) { return lowerCase(model.name) == wanted; });
    return found == kModels.end() ? nullptr : &*found;
}

ProjectorLens lensOf(const ProjectorModel& model, double wishedShift) {
    const double shift = model.shift ? std::clamp(wishedShift, model.shift->least, model.shift->most) : wishedShift;
    return {model.size, model.throwLeast, model.throwMost, shift};
}

} // namespace lumorph
