#include "resources/targets/generator/targets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "resources/targets/generator/lifted_relief.h"
#include "resources/targets/generator/relief.h"

namespace lumorph {

namespace {

constexpr float kWidth = 0.21F; ///< the tablet's sides, metres
constexpr float kDepth = 0.15F;

double dunesAt(double x, double z) { return 0.0002 + liftedHeight({0.35, 0.6, 1.0, 0.45, 0.55, 0.3}, x, z); }

Model::Material sand() {
    Model::Material material;
    material.name = "sand";
    material.baseColor = {0.80F, 0.66F, 0.44F, 1.0F};
    material.metallic = 0.0F;
    material.roughness = 0.9F;
    return material;
}

Model::Material water() {
    Model::Material material;
    material.name = "water";
    material.baseColor = {0.10F, 0.32F, 0.42F, 1.0F};
    material.metallic = 0.0F;
    material.roughness = 0.25F;
    return material;
}

/// The wave: 26 cm long, past every place once in four seconds, and higher towards the long edges, where
/// its crest is 36 mm above the base.
constexpr double kCalm = 0.001;
constexpr double kAmplitude = 0.0175;
constexpr double kWavelength = 0.26;
constexpr double kSeconds = 4.0;

double amplitudeAt(double z) { return kAmplitude * (0.06 + 0.94 * std::abs(z) / (0.5 * static_cast<double>(kDepth))); }

double phaseAt(double x, double z) {
    constexpr double kHeading = 0.35;
    return 2.0 * std::numbers::pi * (x * std::cos(kHeading) + z * std::sin(kHeading)) / kWavelength;
}

float rounded(double weight) { return static_cast<float>(std::round(weight * 1e5) / 1e5); }

/// sin(phase - omega t) = sin(phase) cos(omega t) - cos(phase) sin(omega t), its shares as cubic splines.
Model::Channel travellingWave(int node) {
    constexpr int kKeys = 9;
    constexpr double kOmega = 2.0 * std::numbers::pi / kSeconds;
    Model::Channel channel;
    channel.node = node;
    channel.path = Model::Path::weights;
    channel.interpolation = Model::Interpolation::cubicSpline;
    for (int k = 0; k < kKeys; ++k) {
        const double seconds = kSeconds * k / (kKeys - 1);
        const double angle = kOmega * seconds;
        const float shares[] = {rounded(std::cos(angle)), rounded(-std::sin(angle))};
        const float slopes[] = {rounded(-kOmega * std::sin(angle)), rounded(-kOmega * std::cos(angle))};
        channel.times.push_back(static_cast<float>(seconds));
        for (const float* part : {slopes, shares, slopes}) channel.values.insert(channel.values.end(), part, part + 2);
    }
    return channel;
}

} // namespace

Model dunesModel() {
    Model model = modelOf(reliefMesh({kWidth, kDepth, 84, 60}, dunesAt), "dunes");
    model.materials.push_back(sand());
    model.meshes.front().primitives.front().material = 0;
    return model;
}

Model swellModel() {
    const Relief relief{kWidth, kDepth, 56, 40};
    const TriangleMesh calm = reliefMesh(relief, [](double, double z) { return kCalm + amplitudeAt(z); });
    Model model = modelOf(calm, "swell");
    model.materials.push_back(water());
    Model::Mesh& mesh = model.meshes.front();
    Model::Primitive& surface = mesh.primitives.front();
    surface.material = 0;
    surface.morphTargets = {
        reliefDisplacement(relief, calm, [](double x, double z) { return amplitudeAt(z) * std::sin(phaseAt(x, z)); }),
        reliefDisplacement(relief, calm, [](double x, double z) { return amplitudeAt(z) * std::cos(phaseAt(x, z)); })};
    mesh.targetNames = {"sine", "cosine"};
    mesh.weights = {1.0F, 0.0F};
    int node = 0;
    while (model.nodes[static_cast<std::size_t>(node)].mesh != 0) ++node;
    model.animations.push_back({"swell", {travellingWave(node)}});
    return model;
}

} // namespace lumorph
