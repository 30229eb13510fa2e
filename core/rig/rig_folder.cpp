#include "core/rig/rig_folder.h"

#include <algorithm>
#include <charconv>
#include <map>

#include "core/base/error.h"
#include "core/geometry/mesh_file.h"

namespace lumorph {
namespace {

struct StateFiles {
    std::filesystem::path rest;
    std::map<std::string, std::map<int, std::filesystem::path>> actuators; ///< by name, by key
};

void addState(const std::filesystem::path& file, StateFiles& files) {
    const std::string stem = file.stem().string();
    if (stem == "rest") {
        if (!files.rest.empty())
            throw DataError(file.string(), "the folder has two rest meshes", "keep one file named rest");
        files.rest = file;
        return;
    }
    const std::size_t split = stem.rfind('_');
    int key = 0;
    const char* const end = stem.data() + stem.size();
    const bool named = split != std::string::npos && split > 0;
    if (!named || std::from_chars(stem.data() + split + 1, end, key).ptr != end || key < 1 || split + 1 == stem.size())
        throw DataError(file.string(), "the name is not ACTUATOR_KEY", "name it for example left_1.obj, or remove it");
    if (!files.actuators[stem.substr(0, split)].emplace(key, file).second)
        throw DataError(file.string(), "this state is there twice", "keep one mesh a state");
}

StateFiles listStates(const std::filesystem::path& folder) {
    StateFiles files;
    std::error_code error;
    std::vector<std::filesystem::path> found;
    std::filesystem::directory_iterator at(folder, error);
    for (; !error && at != std::filesystem::directory_iterator(); at.increment(error))
        if (isMeshFile(at->path())) found.push_back(at->path());
    if (error) throw DataError(folder.string(), "the folder cannot be read: " + error.message(), "check the path");
    std::ranges::sort(found);
    for (const auto& file : found) addState(file, files);
    if (files.rest.empty())
        throw DataError(folder.string(), "there is no rest mesh", "save the undeformed mesh as rest.obj");
    if (files.actuators.empty())
        throw DataError(folder.string(), "there are no states but rest", "save each state as ACTUATOR_KEY.obj");
    return files;
}

Actuator readStates(const std::string& name, const std::map<int, std::filesystem::path>& states,
                    const TriangleMesh& rest) {
    std::vector<std::vector<glm::vec3>> moved;
    for (const auto& [key, file] : states) {
        if (key != static_cast<int>(moved.size()) + 1)
            throw DataError(file.string(),
                            "state " + std::to_string(moved.size() + 1) + " of \"" + name + "\" is missing",
                            "number the states 1, 2, ... without gaps");
        const TriangleMesh mesh = readMesh(file);
        if (mesh.positions.size() != rest.positions.size() || mesh.triangles != rest.triangles)
            throw DataError(file.string(), "its triangles are not those of the rest mesh",
                            "export all states from the same mesh with the same settings");
        moved.push_back(mesh.positions);
        for (std::size_t v = 0; v < rest.positions.size(); ++v) moved.back()[v] -= rest.positions[v];
    }
    Actuator actuator;
    actuator.name = name;
    MorphTarget morph;
    morph.target = name;
    morph.displacements.resize(moved.size());
    for (std::size_t k = 0; k < moved.size(); ++k)
        morph.keys.push_back(static_cast<float>(k + 1) / static_cast<float>(moved.size()));
    for (std::uint32_t v = 0; v < rest.positions.size(); ++v) {
        if (std::ranges::all_of(moved, [&](const auto& state) { return state[v] == glm::vec3(0.0F); })) continue;
        actuator.influences.push_back({v, 1.0F});
        for (std::size_t k = 0; k < moved.size(); ++k) morph.displacements[k].push_back(moved[k][v]);
    }
    actuator.deformer = std::move(morph);
    return actuator;
}

} // namespace

RigParts readRigFolder(const std::filesystem::path& folder) {
    const StateFiles files = listStates(folder);
    RigParts parts;
    parts.name = folder.filename().empty() ? folder.parent_path().filename().string() : folder.filename().string();
    parts.restMesh = readMesh(files.rest);
    for (const auto& [name, states] : files.actuators)
        parts.actuators.push_back(readStates(name, states, parts.restMesh));
    return parts;
}

} // namespace lumorph
