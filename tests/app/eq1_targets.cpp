#include "tests/app/eq1_targets.h"

#include <cmath>
#include <functional>
#include <random>
#include <stdexcept>

#include "core/geometry/mesh_writers.h"
#include "resources/targets/generator/relief.h"
#include "tests/app/process.h"

namespace lumorph::test {

namespace {

/// Height as a share of the frame, over a place in [0, 1] x [0, 1].
using Shape = std::function<double(double x, double z)>;

MatchTarget reliefFile(const TabletWorkspace& w, const std::string& name, const Shape& shape) {
    const Relief relief{0.21F, 0.15F, 60, 40};
    const TriangleMesh mesh =
        reliefMesh(relief, [&](double x, double z) { return 0.002 + 0.06 * shape(x / 0.21 + 0.5, z / 0.15 + 0.5); });
    writeFile(w[name + ".obj"], writeObj(mesh));
    return {name, w[name + ".obj"], true};
}

MatchTarget waveGrid(const TabletWorkspace& w, const LiteralGrid& body, const std::string& name, const Shape& shape) {
    std::string grid = body.header;
    for (int z = 0; z < body.size[2]; ++z)
        for (int y = 0; y < body.size[1]; ++y)
            for (int x = 0; x < body.size[0]; ++x) {
                const double height = 0.25 + 0.75 * shape((x + 0.5) / body.size[0], (z + 0.5) / body.size[2]);
                grid += (y + 0.5) / body.size[1] < height ? '\1' : '\0';
            }
    writeFile(w[name + ".nrrd"], grid);
    return {name, w[name + ".nrrd"], false};
}

MatchTarget hiddenState(const TabletWorkspace& w, int number, std::mt19937& random) {
    std::string state;
    for (int i = 0; i < 6; ++i) state += (i == 0 ? "" : ",") + std::to_string(random() % 33U);
    const std::string name = "hidden-" + std::to_string(number);
    const Outcome outcome = lumorph({"rig", "deform", cutTabletFile(), "--state", state, "-o", w[name + ".obj"]});
    if (outcome.exitCode != 0) throw std::runtime_error(outcome.err);
    return {name + " (" + state + ")", w[name + ".obj"], false};
}

} // namespace

std::vector<MatchTarget> tabletTargets(const TabletWorkspace& w, const LiteralGrid& body) {
    std::vector<MatchTarget> targets{{"dunes", resource("targets/dunes.glb"), true}};
    for (const char* name : {"spot.obj", "rocker-arm.obj"}) {
        const std::string path = std::string(LUMORPH_SHARED_DIR "/data/meshes/") + name;
        if (std::filesystem::exists(path)) targets.push_back({name, path, true});
    }
    targets.push_back(reliefFile(w, "bowl", [](double x, double z) {
        return std::min(1.0, 2.0 * ((x - 0.5) * (x - 0.5) + (z - 0.5) * (z - 0.5)));
    }));
    targets.push_back(reliefFile(w, "ramp", [](double x, double z) { return 0.8 * x * z; }));
    targets.push_back(reliefFile(
        w, "saddle", [](double x, double z) { return 0.5 + 2.0 * ((z - 0.5) * (z - 0.5) - (x - 0.5) * (x - 0.5)); }));
    targets.push_back(
        waveGrid(w, body, "wave-x", [](double x, double) { return 0.3 + 0.3 * std::sin(9.0 * x + 0.4); }));
    targets.push_back(
        waveGrid(w, body, "wave-z", [](double, double z) { return 0.2 + 0.2 * std::sin(6.0 * z + 1.1); }));
    targets.push_back(waveGrid(w, body, "wave-xz",
                               [](double x, double z) { return 0.35 + 0.3 * std::sin(7.0 * x) * std::cos(5.0 * z); }));
    std::mt19937 random(20160507);
    for (int k = 0; k < 10; ++k) targets.push_back(hiddenState(w, k, random));
    return targets;
}

} // namespace lumorph::test
