#pragma once

#include <filesystem>
#include <string>

namespace lumorph::studio {

/// The project in the folder of a session, or of kept work.
inline constexpr const char* kSessionFile = "session.lumorph";
/// What a session holds beside the project, in the project's view under this key.
inline constexpr const char* kSessionKey = "session";

/// What is to be known of a session without opening it.
struct SessionMemory {
    std::string name; ///< of the project's file, else of the rig
    std::string demo;
    std::string lastEdit;
    int edits = 0;
    bool modified = false;
    std::string replacedAs; ///< its id as kept work, which it is as soon as the next session is there; else empty
};
/// Of a session's folder. One that cannot be read is named after its folder and taken for edited.
[[nodiscard]] SessionMemory readSessionMemory(const std::filesystem::path& place);

} // namespace lumorph::studio
