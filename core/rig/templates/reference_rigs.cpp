#include "core/rig/templates/reference_rigs.h"

#include "core/rig/templates/bundled_rigs.h"
#include "core/rig/templates/rig_templates.h"

namespace lumorph {

std::vector<Rig> referenceRigs(const Progress& progress) {
    std::vector<Rig> rigs{rigOf(rigTemplate("phone"), {}, progress), bakedTablet()};
    RigParts pins = pinDisplayRig().parts();
    pins.name = "pins";
    rigs.emplace_back(std::move(pins));
    return rigs;
}

} // namespace lumorph
