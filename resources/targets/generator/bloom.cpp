#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "resources/targets/generator/relief.h"
#include "resources/targets/generator/targets.h"

namespace lumorph {

namespace {

constexpr float kWidth = 0.21F; ///< the tablet's sides, metres
constexpr float kDepth = 0.15F;
constexpr double kSeconds = 6.0;
constexpr int kHarmonics = 3; ///< of the loop; what lies above them is too quick to be seen
constexpr double kCalm = 0.0005;

/// A petal: lies flat, or lifts its free end while its root stays down.
struct Petal {
    double x; ///< of its root's middle, metres
    double z;
    double heading; ///< degrees, from the root to the free end, from +x towards +z
    double reach;   ///< metres from the root to the free end
    double breadth; ///< half of it at the free end, metres
    double turn;    ///< share of the loop at which it stands highest
};

/// Corners and long edges in the order in which the wave passes them.
constexpr double kDiagonal = 43.7; // degrees
constexpr std::array<Petal, 6> kPetals{{{-0.0715, 0.040, 180.0 - kDiagonal, 0.0485, 0.031, 0.0 / 6.0},
                                        {0.0, 0.002, 90.0, 0.0745, 0.072, 1.0 / 6.0},
                                        {0.0715, 0.040, kDiagonal, 0.0485, 0.031, 2.0 / 6.0},
                                        {0.0715, -0.040, -kDiagonal, 0.0485, 0.031, 3.0 / 6.0},
                                        {0.0, -0.002, -90.0, 0.0745, 0.072, 4.0 / 6.0},
                                        {-0.0715, -0.040, 180.0 + kDiagonal, 0.0485, 0.031, 5.0 / 6.0}}};

double radians(double degrees) { return degrees * std::numbers::pi / 180.0; }

/// The value where it is positive and 0 elsewhere, without a corner between.
double softly(double value, double width) { return width * std::log1p(std::exp(value / width)); }

/// How far a petal's slope has risen at a point of the loop, radians.
double liftOf(const Petal& petal, double turn) {
    constexpr double kLow = 6.0, kHigh = 58.0;
    const double share = 0.5 + 0.5 * std::cos(2.0 * std::numbers::pi * (turn - petal.turn));
    return radians(kLow + (kHigh - kLow) * share);
}

/// A slope that begins softly at the root, under the round cap along which its free end came up.
double heightOf(const Petal& petal, double lift, double x, double z) {
    constexpr double kRoot = 0.009; // metres of the root that stay down
    constexpr double kSoft = 0.004;
    const double cosine = std::cos(radians(petal.heading));
    const double sine = std::sin(radians(petal.heading));
    const double along = (x - petal.x) * cosine + (z - petal.z) * sine - kRoot;
    const double across = ((z - petal.z) * cosine - (x - petal.x) * sine) / petal.breadth;
    const double reach = petal.reach - kRoot;
    const double rise = std::tan(lift) * softly(along, kSoft);
    const double inside = softly(1.0 - std::pow(across, 2) - std::pow(std::max(0.0, along) / reach, 2), 0.06);
    const double cap = reach * std::pow(inside, 0.55);
    return std::pow(std::pow(rise, -3.5) + std::pow(cap, -3.5), -1.0 / 3.5);
}

double bloomAt(double x, double z, double turn) {
    constexpr double kSharpness = 4.0; // of the valleys where two petals meet
    double sum = 0.0;
    for (const Petal& petal : kPetals) sum += std::pow(heightOf(petal, liftOf(petal, turn), x, z), kSharpness);
    return kCalm + std::pow(sum, 1.0 / kSharpness);
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
