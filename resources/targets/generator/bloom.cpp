#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "resources/targets/generator/lifted_relief.h"
#include "resources/targets/generator/relief.h"
#include "resources/targets/generator/targets.h"

namespace lumorph {

namespace {

constexpr float kWidth = 0.202F; ///< a little inside the tablet, whose sheet draws inwards as it rises; metres
constexpr float kDepth = 0.142F;
constexpr double kSeconds = 6.0;
constexpr int kHarmonics = 3; ///< of the loop; what lies above them is too quick to be seen
constexpr double kCalm = 0.0002;

/// When the wave lifts each of the tablet's levers most, as a share of the loop: corners and long edges in the order in
/// which it passes them.
constexpr std::array<double, 6> kTurns{0.0 / 6.0, 2.0 / 6.0, 5.0 / 6.0, 3.0 / 6.0, 1.0 / 6.0, 4.0 / 6.0};

double bloomAt(double x, double z, double turn) {
    std::array<double, 6> lifts{};
    for (std::size_t k = 0; k < lifts.size(); ++k)
        lifts[k] = 0.02 + 0.98 * std::pow(0.5 + 0.5 * std::cos(2.0 * std::numbers::pi * (turn - kTurns[k])), 2.0);
    return kCalm + liftedHeight(lifts, x, z);
}

/// The share of cos(2 pi harmonic turn), or of the sine, in the height of a place over the loop.
double harmonicAt(double x, double z, int harmonic, bool sine) {
    constexpr int kSamples = 24;
    double sum = 0.0;
    for (int k = 0; k < kSamples; ++k) {
        const double turn = static_cast<double>(k) / kSamples;
        const double angle = 2.0 * std::numbers::pi * harmonic * turn;
        sum += bloomAt(x, z, turn) * (sine ? std::sin(angle) : std::cos(angle));
    }
    return (harmonic == 0 ? 1.0 : 2.0) * sum / kSamples;
}

float rounded(double weight) { return static_cast<float>(std::round(weight * 1e5) / 1e5); }

/// The harmonics' shares over the loop, as cubic splines that end as they begin.
Model::Channel shares(int node) {
    constexpr int kKeys = 25;
    Model::Channel channel;
    channel.node = node;
    channel.path = Model::Path::weights;
    channel.interpolation = Model::Interpolation::cubicSpline;
    for (int key = 0; key < kKeys; ++key) {
        const double seconds = kSeconds * key / (kKeys - 1);
        std::vector<float> values, slopes;
        for (int harmonic = 1; harmonic <= kHarmonics; ++harmonic) {
            const double omega = 2.0 * std::numbers::pi * harmonic / kSeconds;
            const double angle = 2.0 * std::numbers::pi * (harmonic * key % (kKeys - 1)) / (kKeys - 1);
            values.insert(values.end(), {rounded(std::cos(angle)), rounded(std::sin(angle))});
            slopes.insert(slopes.end(), {rounded(-omega * std::sin(angle)), rounded(omega * std::cos(angle))});
        }
        channel.times.push_back(static_cast<float>(seconds));
        for (const auto* part : {&slopes, &values, &slopes})
            channel.values.insert(channel.values.end(), part->begin(), part->end());
    }
    return channel;
}

Model::Material petals() {
    Model::Material material;
    material.name = "petals";
    material.baseColor = {0.86F, 0.42F, 0.46F, 1.0F};
    material.metallic = 0.0F;
    material.roughness = 0.7F;
    return material;
}

} // namespace

Model bloomModel() {
    const Relief relief{kWidth, kDepth, 64, 46};
    const TriangleMesh mean = reliefMesh(relief, [](double x, double z) { return harmonicAt(x, z, 0, false); });
    Model model = modelOf(mean, "bloom");
    model.materials.push_back(petals());
    Model::Mesh& mesh = model.meshes.front();
    Model::Primitive& surface = mesh.primitives.front();
    surface.material = 0;
    for (int harmonic = 1; harmonic <= kHarmonics; ++harmonic)
        for (const bool sine : {false, true}) {
            surface.morphTargets.push_back(
                reliefDisplacement(relief, mean, [&](double x, double z) { return harmonicAt(x, z, harmonic, sine); }));
            mesh.targetNames.push_back((sine ? "sine " : "cosine ") + std::to_string(harmonic));
            mesh.weights.push_back(sine ? 0.0F : 1.0F);
        }
    int node = 0;
    while (model.nodes[static_cast<std::size_t>(node)].mesh != 0) ++node;
    model.animations.push_back({"bloom", {shares(node)}});
    return model;
}

} // namespace lumorph
