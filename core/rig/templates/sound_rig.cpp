#include "core/rig/templates/sound_rig.h"

#include <random>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/geometry/mesh_check.h"

namespace lumorph {
namespace {

bool soundAt(const Rig& rig, const std::vector<double>& strokes) {
    const TriangleMesh mesh = deformed(rig, strokes);
    const MeshReport report = checkMesh(mesh);
    return report.solid() && report.degenerateTriangles == 0 && report.volume > 0.0;
}

} // namespace

void requireSound(const Rig& rig, const Progress& progress) {
    const std::size_t count = rig.actuatorCount();
    const std::string why = "the solid would not be closed, or would cross itself";
    std::vector<std::vector<double>> states;
    for (const double stroke : {0.0, 1.0, 0.5}) states.emplace_back(count, stroke);
    std::mt19937 random(1);
    for (int k = 0; k < 2; ++k) {
        states.emplace_back();
        for (std::size_t a = 0; a < count; ++a)
            states.back().push_back(static_cast<double>(random()) / static_cast<double>(std::mt19937::max()));
    }
    if (count == 0) states.resize(1);
    for (std::size_t s = 0; s < states.size(); ++s) {
        progress.throwIfCancelled();
        progress.report(static_cast<double>(s) / static_cast<double>(states.size()), "looking the solid over");
        if (soundAt(rig, states[s])) continue;
        if (s == 0) throw InvalidInput(rig.name(), why, "simplify the outline where it is narrow, or move a bend line");
        for (std::size_t a = 0; a < count; ++a) {
            progress.throwIfCancelled();
            std::vector<double> alone(count, 0.0);
            alone[a] = states[s][a];
            if (!soundAt(rig, alone))
                throw InvalidInput(rig.name() + ": " + inQuotes(rig.actuators()[a].name), why + " as it moves",
                                   "move its bend line, make its arc shorter, or choose other measures");
        }
        throw InvalidInput(rig.name(), why + " when several parts move",
                           "move bend lines that are close to one another");
    }
}

} // namespace lumorph
