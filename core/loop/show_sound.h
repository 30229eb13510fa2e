#pragma once

#include <string>

#include <glm/vec3.hpp>

namespace lumorph {

/// Something that a show program lets be heard in one frame, for whoever plays sound.
struct ShowSound {
    std::string name;      ///< "labyrinth.bump"
    double strength = 1.0; ///< in the program's own terms, 0 or more
    glm::vec3 place{0.0F}; ///< device frame, metres
    bool operator==(const ShowSound&) const = default;
};

} // namespace lumorph
