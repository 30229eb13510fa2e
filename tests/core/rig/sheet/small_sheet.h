#pragma once

#include <cmath>

#include "core/rig/sheet/elastic_sheet.h"

namespace lumorph {

/// 12 x 8 cm, its pad across the middle, a lever near the middle of each short edge that lifts 2 cm.
inline ElasticSheet smallSheet() {
    const auto rectangle = [](double x, double z) {
        return std::vector<glm::dvec2>{{-x, -z}, {x, -z}, {x, z}, {-x, z}};
    };
    const Angle end = Angle::radians(std::asin(0.02 / (2.0 * 0.026)));
    const Angle rest = Angle::radians(-end.inRadians());
    ElasticSheet sheet;
    sheet.outline = rectangle(0.06, 0.04);
    sheet.pad = rectangle(0.015, 0.03);
    sheet.layers = {{sheetMaterial("NinjaFlex"), 1e-3}};
    sheet.levers = {{"left", {-0.052, -0.01}, {-0.052, 0.01}, 0.026, rest, end},
                    {"right", {0.052, -0.01}, {0.052, 0.01}, 0.026, rest, end}};
    return sheet;
}

} // namespace lumorph
