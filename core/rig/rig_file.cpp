#include "core/rig/rig_file.h"

#include <algorithm>
#include <optional>

#include "core/base/error.h"
#include "core/base/json_check.h"
#include "core/geometry/mesh_file.h"
#include "core/rig/rig_document.h"
#include "core/rig/rig_folder.h"
#include "core/rig/rig_validation.h"

namespace lumorph {
namespace {

using nlohmann::json;

constexpr JsonLimits kTextLimits{std::size_t{1} << 20, 8, 100'000}; ///< of an entry that is written as a text

/// The entries under `extras.lumorph`: one object or a list of them, also as a text in JSON.
std::vector<json> entriesOf(const json& extras) {
    if (!extras.is_object() || !extras.contains("lumorph")) return {};
    json stated = extras["lumorph"];
    // A modelling tool whose panel takes nothing but plain texts gives the object as one.
    if (stated.is_string()) {
        const auto& text = stated.get_ref<const std::string&>();
        json parsed = jsonProblem(text, kTextLimits).empty() ? json::parse(text, nullptr, false) : json();
        if (parsed.is_structured()) stated = std::move(parsed);
    }
    if (stated.is_null()) return {};
    if (stated.is_array()) return {stated.begin(), stated.end()};
    return {stated};
}

/// Nodes of the scene, an inner one before those around it: a hinge on a hinge turns first, in the
/// frame in which both were drawn.
std::vector<int> innerFirst(const Model& model) {
    std::vector<int> order;
    std::vector<std::pair<int, bool>> stack;
    for (auto root = model.roots.rbegin(); root != model.roots.rend(); ++root) stack.push_back({*root, false});
    while (!stack.empty()) {
        const auto [node, childrenDone] = stack.back();
        stack.pop_back();
        if (childrenDone) {
            order.push_back(node);
            continue;
        }
        stack.push_back({node, true});
        const auto& children = model.nodes[node].children;
        for (auto child = children.rbegin(); child != children.rend(); ++child) stack.push_back({*child, false});
    }
    return order;
}

void requireTargets(const ActuatorEntry& entry, const Model::Mesh& mesh) {
    for (const std::string& target : entry.targets)
        if (std::ranges::find(mesh.targetNames, target) == mesh.targetNames.end())
            entry.place.fail("the mesh has no morph target \"" + target + "\"", "name one of its shape keys");
}

std::vector<ActuatorEntry> statedActuators(const Model& model, const std::string& file, const JointTable& table) {
    const std::vector<glm::mat4> world = nodeTransforms(model);
    std::vector<ActuatorEntry> entries;
    for (const int n : innerFirst(model)) {
        const Model::Node& node = model.nodes[n];
        const EntryPlace place{file, "node \"" + node.name + "\""};
        for (const json& extras : entriesOf(node.extras)) {
            entries.push_back(readActuatorEntry(extras, place, world[n], table.jointOfNode[n]));
            entries.back().node = n;
            if (!entries.back().targets.empty()) {
                if (node.mesh < 0) place.fail("it states a morph target but has no mesh", "put the entry on the mesh");
                requireTargets(entries.back(), model.meshes[node.mesh]);
            }
        }
        if (node.mesh < 0) continue;
        const Model::Mesh& mesh = model.meshes[node.mesh];
        const EntryPlace meshPlace{file, "mesh \"" + mesh.name + "\""};
        for (const json& extras : entriesOf(mesh.extras)) {
            entries.push_back(readActuatorEntry(extras, meshPlace, world[n], -1));
            entries.back().node = n;
            if (entries.back().targets.empty() && !std::holds_alternative<SheetLift>(entries.back().actuator.deformer))
                entries.back().place.fail("only morph targets and levers of a sheet can be stated on a mesh",
                                          "put the entry on a node");
            requireTargets(entries.back(), mesh);
        }
    }
    // Entries without an order come after those with one, as the scene lists them.
    std::ranges::stable_sort(entries, [](const ActuatorEntry& a, const ActuatorEntry& b) {
        return static_cast<unsigned>(a.order) < static_cast<unsigned>(b.order);
    });
    return entries;
}

std::vector<ActuatorEntry> morphsOfMeshes(const Model& model, const std::string& file) {
    std::vector<ActuatorEntry> entries;
    for (const int n : innerFirst(model)) {
        if (model.nodes[n].mesh < 0) continue;
        const Model::Mesh& mesh = model.meshes[model.nodes[n].mesh];
        for (const std::string& name : mesh.targetNames) {
            ActuatorEntry entry;
            entry.node = n;
            entry.targets = {name};
            entry.actuator.name = name;
            const auto taken = [&](const ActuatorEntry& other) { return other.actuator.name == entry.actuator.name; };
            while (std::ranges::any_of(entries, taken)) entry.actuator.name += " of " + model.nodes[n].name;
            entry.place = {file, "mesh \"" + mesh.name + "\""};
            entry.actuator.deformer = MorphTarget{name, {1.0F}, {}};
            entries.push_back(std::move(entry));
        }
    }
    return entries;
}

/// Without names exporters leave morph targets anonymous; a number will do.
void nameTargets(Model& model) {
    for (Model::Mesh& mesh : model.meshes) {
        const std::size_t targets = mesh.primitives.empty() ? 0 : mesh.primitives.front().morphTargets.size();
        for (std::size_t t = mesh.targetNames.size(); t < targets; ++t)
            mesh.targetNames.push_back("target " + std::to_string(t + 1));
    }
}

/// A mesh of another kind than glTF has one state.
Model modelAt(const std::filesystem::path& path) {
    if (isMeshFile(path) && !isGltfFile(path))
        throw DataError(path.string(), "nothing in it moves: it is a mesh in one state",
                        "open a folder of one mesh a state, or a glTF with morph targets or a skin");
    return readModel(path);
}

Rig checkedRig(RigParts parts, const std::string& file) {
    try {
        return Rig(std::move(parts));
    } catch (const InvalidInput& error) {
        throw DataError(file + ", " + error.subject(), error.why(), error.remedy());
    }
}

using OfferKind = ActuatorOffer::Kind;

/// What moves in a model that states no actuators: usual ones first.
struct Offers {
    std::vector<ActuatorOffer> offers;
    std::vector<ActuatorEntry> entries; ///< one an offer

    void add(std::vector<ActuatorEntry> more, OfferKind kind) {
        for (ActuatorEntry& entry : more) {
            const auto taken = [&](const ActuatorOffer& other) { return other.name == entry.actuator.name; };
            while (std::ranges::any_of(offers, taken)) entry.actuator.name += " (joint)";
            offers.push_back({entry.actuator.name, kind});
            entries.push_back(std::move(entry));
        }
    }
    /// Those that are taken, in their order. Throws DataError.
    [[nodiscard]] std::vector<ActuatorEntry> chosen(std::span<const std::size_t> taken, const std::string& file) const {
        std::vector<ActuatorEntry> some;
        for (const std::size_t k : taken) {
            if (k >= entries.size()) throw DataError(file, "it is another than was looked at", "open it again");
            some.push_back(entries[k]);
        }
        return some;
    }
};

Offers offersOf(const Model& model, const std::string& file, const JointTable& table) {
    Offers offers;
    offers.add(morphsOfMeshes(model, file), OfferKind::morphTarget);
    const std::vector<ActuatorEntry> animated = jointsOfAnimations(model, file, table);
    offers.add(animated, OfferKind::animatedJoint);
    offers.add(jointsAtRest(model, file, table, animated), OfferKind::jointAtRest);
    return offers;
}

/// `taken`: of the offers; none: the usual ones.
Rig rigOf(Model model, const std::string& file, const std::optional<std::vector<std::size_t>>& taken = {}) {
    nameTargets(model);
    JointTable table = tableOfJoints(model, file);
    std::vector<ActuatorEntry> entries = statedActuators(model, file, table);
    if (entries.empty()) {
        const Offers offers = offersOf(model, file, table);
        entries = offers.chosen(taken ? *taken : usualOffers(offers.offers), file);
        restAtLowerEnds(entries, table);
    }
    // A blank sheet that was made here moves nothing yet.
    const bool madeHere = model.extras.is_object() && model.extras.contains("lumorph");
    if (entries.empty() && !madeHere)
        throw DataError(file, "nothing in it moves",
                        "give a node the property \"lumorph\", or the mesh morph targets or an animated skin");
    if (entries.size() > kMaxActuators)
        throw DataError(file, "there are more than 65,000 actuators", "join actuators that move together");
    RigParts parts = gatherParts(model, file, std::move(entries), table);
    if (parts.restMesh.triangles.empty())
        throw DataError(file, "the scene has no triangles", "give the device a closed mesh");
    return checkedRig(std::move(parts), file);
}

} // namespace

std::vector<std::size_t> usualOffers(std::span<const ActuatorOffer> offers) {
    std::vector<std::size_t> usual;
    for (std::size_t k = 0; k < offers.size(); ++k)
        if (offers[k].kind != OfferKind::jointAtRest) usual.push_back(k);
    return usual;
}

std::vector<ActuatorOffer> offeredActuators(const std::filesystem::path& path) {
    std::error_code error;
    if (std::filesystem::is_directory(path, error)) return {};
    Model model = modelAt(path);
    nameTargets(model);
    const JointTable table = tableOfJoints(model, path.string());
    if (!statedActuators(model, path.string(), table).empty()) return {};
    return offersOf(model, path.string(), table).offers;
}

Rig readRig(const std::filesystem::path& path) {
    std::error_code error;
    if (std::filesystem::is_directory(path, error)) return checkedRig(readRigFolder(path), path.string());
    return rigOf(modelAt(path), path.string());
}

Rig readRig(const std::filesystem::path& path, std::span<const std::size_t> taken) {
    return rigOf(modelAt(path), path.string(), std::vector<std::size_t>(taken.begin(), taken.end()));
}

Rig readRigGlb(std::span<const std::byte> bytes, const std::string& name) { return rigOf(readGlb(bytes, name), name); }

} // namespace lumorph
