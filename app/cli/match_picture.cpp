#include "app/cli/match_picture.h"

#include <cstdio>
#include <vector>

#include "core/render/figure/figure.h"
#include "core/render/gl/headless_context.h"

namespace lumorph::cli {

void drawMatch(const Rig& rig, const TriangleMesh& target, std::span<const double> strokes, double iou,
               double milliseconds, const std::string& file) {
    constexpr float kVeil = 0.35F;
    const std::vector<double> rest(rig.actuatorCount(), 0.0);
    const FigureItem atRest{deformed(rig, rest)};
    const FigureItem fitted{deformed(rig, strokes)};
    Figure figure;
    figure.panels.push_back({"Rest", {atRest}});
    figure.panels.push_back({"Target", {atRest, {target, kAccentColor}}});
    figure.panels.push_back({"Fit", {fitted, {target, kAccentColor, kVeil}}});
    char footer[128];
    std::snprintf(footer, sizeof footer, "%s \u00b7 IoU %.3f \u00b7 matched in %.3f ms", rig.name().c_str(), iou,
                  milliseconds);
    figure.footer = footer;
    const HeadlessContext context;
    writePng(renderFigure(figure, {1920, 640}), file);
}

} // namespace lumorph::cli
