#include <algorithm>
#include <cmath>
#include <numbers>

#include "resources/targets/generator/relief.h"
#include "resources/targets/generator/targets.h"

namespace lumorph {

namespace {

/// Height in [0, 1] over x and z in [-1, 1].
using Form = double (*)(double x, double z);

double smoothStep(double t) {
    t = std::clamp(t, 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

struct NamedForm {
    const char* name;
    double height; ///< metres
    Form form;
};

constexpr NamedForm kForms[] = {
    {"ramp", 0.060, [](double, double z) { return 0.5 - 0.5 * z; }},
    {"valley", 0.060, [](double, double z) { return std::abs(z); }},
    {"bowl", 0.050, [](double x, double z) { return std::pow(std::max(std::abs(x), std::abs(z)), 3.0); }},
    {"cove", 0.065, [](double, double z) { return std::pow(std::max(0.0, 0.5 - 0.5 * z), 4.0); }},
    {"corners", 0.055, [](double x, double z) { return std::pow(std::abs(x * z), 1.5); }},
    {"saddle", 0.050, [](double x, double z) { return 0.5 + 0.5 * (x * x - z * z); }},
    {"dome", 0.050, [](double x, double z) { return std::sqrt(std::max(0.0, 1.0 - x * x - z * z)); }},
    {"peak", 0.060, [](double x, double z) { return std::max(0.0, 1.0 - std::hypot(x, z)); }},
    {"ridge", 0.050, [](double x, double z) { return std::max(0.0, 1.0 - 1.6 * std::abs(z - 0.3 * x)); }},
    {"crater", 0.045, [](double x, double z) { return std::exp(-30.0 * std::pow(std::hypot(x, z) - 0.72, 2.0)); }},
    {"stairs", 0.055, [](double x, double) { return std::round(2.0 * smoothStep(0.5 + 0.5 * x)) / 2.0; }},
    {"ripples", 0.030,
     [](double x, double z) { return 0.5 + 0.5 * std::cos(2.0 * std::numbers::pi * (1.5 * x + 0.5 * z)); }},
};

} // namespace

std::vector<std::pair<std::string, Model>> shapeModels() {
    constexpr double kWidth = 0.21;
    constexpr double kDepth = 0.15;
    Model::Material clay;
    clay.name = "clay";
    clay.baseColor = {0.72F, 0.50F, 0.40F, 1.0F};
    clay.metallic = 0.0F;
    clay.roughness = 0.9F;
    std::vector<std::pair<std::string, Model>> models;
    for (const NamedForm& form : kForms) {
        const Height height = [&](double x, double z) {
            return 0.001 + form.height * form.form(2.0 * x / kWidth, 2.0 * z / kDepth);
        };
        Model model = modelOf(reliefMesh({0.21F, 0.15F, 24, 18}, height), form.name);
        model.materials.push_back(clay);
        model.meshes.front().primitives.front().material = 0;
        models.emplace_back(form.name, std::move(model));
    }
    return models;
}

} // namespace lumorph
