#include "app/studio/document/session_memory.h"

#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/scene/project.h"

namespace lumorph::studio {

namespace {

std::string memoryText(const nlohmann::json& object, const char* key) {
    const auto found = object.find(key);
    return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

std::string fileNameIn(const nlohmann::json& object, const char* key) {
    return std::filesystem::path(memoryText(object, key)).filename().string();
}

} // namespace

SessionMemory readSessionMemory(const std::filesystem::path& place) {
    SessionMemory memory;
    memory.name = place.filename().string();
    memory.modified = true;
    try {
        const Project project = readProject(place / kSessionFile);
        const auto found = project.view.is_object() ? project.view.find(kSessionKey) : project.view.end();
        if (found == project.view.end() || !found->is_object()) return memory;
        std::string name = fileNameIn(*found, "file");
        if (name.empty()) name = fileNameIn(*found, "rig");
        if (name.empty()) name = std::filesystem::path(project.rig).filename().string();
        if (!name.empty()) memory.name = name;
        memory.demo = memoryText(*found, "demo");
        memory.lastEdit = memoryText(*found, "lastEdit");
        if (const auto edits = found->find("edits"); edits != found->end() && edits->is_number_integer())
            memory.edits = edits->get<int>();
        if (const auto modified = found->find("modified"); modified != found->end() && modified->is_boolean())
            memory.modified = modified->get<bool>();
        memory.replacedAs = memoryText(*found, "replacedAs");
    } catch (const Error&) {
    }
    return memory;
}

} // namespace lumorph::studio
