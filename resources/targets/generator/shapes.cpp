#include <array>

#include "resources/targets/generator/lifted_relief.h"
#include "resources/targets/generator/relief.h"
#include "resources/targets/generator/targets.h"

namespace lumorph {

namespace {

/// How far each of the tablet's levers would be lifted: four corners, then the long edges in front and behind.
struct Form {
    const char* name;
    std::array<double, 6> lifts;
};

constexpr Form kForms[] = {
    {"ramp", {0.0, 0.0, 1.0, 1.0, 0.0, 1.0}},     {"valley", {0.7, 0.7, 0.7, 0.7, 1.0, 1.0}},
    {"bowl", {1.0, 1.0, 1.0, 1.0, 0.6, 0.6}},     {"cove", {0.2, 0.2, 0.7, 0.7, 0.0, 1.0}},
    {"corners", {1.0, 1.0, 1.0, 1.0, 0.0, 0.0}},  {"saddle", {0.0, 0.0, 0.0, 0.0, 1.0, 1.0}},
    {"twist", {1.0, 0.0, 0.0, 1.0, 0.0, 0.0}},    {"peak", {0.0, 0.0, 0.0, 1.0, 0.0, 0.0}},
    {"ridge", {0.0, 0.0, 0.0, 0.0, 0.0, 1.0}},    {"crater", {0.5, 0.5, 0.5, 0.5, 0.5, 0.5}},
    {"stairs", {0.25, 0.5, 1.0, 0.75, 0.0, 0.0}}, {"wave", {1.0, 0.3, 0.0, 0.4, 0.0, 0.8}},
};

} // namespace

std::vector<std::pair<std::string, Model>> shapeModels() {
    Model::Material clay;
    clay.name = "clay";
    clay.baseColor = {0.72F, 0.50F, 0.40F, 1.0F};
    clay.metallic = 0.0F;
    clay.roughness = 0.9F;
    std::vector<std::pair<std::string, Model>> models;
    for (const Form& form : kForms) {
        const Height height = [&](double x, double z) { return 0.0002 + liftedHeight(form.lifts, x, z); };
        Model model = modelOf(reliefMesh({0.21F, 0.15F, 28, 20}, height), form.name);
        model.materials.push_back(clay);
        model.meshes.front().primitives.front().material = 0;
        models.emplace_back(form.name, std::move(model));
    }
    return models;
}

} // namespace lumorph
