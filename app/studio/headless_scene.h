#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "core/base/image.h"

namespace lumorph::studio {

/// How a scene is shown without a display.
struct SceneShow {
    std::filesystem::path project;
    double seconds = 4.0;
    glm::ivec2 video{960, 600};     ///< pixels of the video, both even
    glm::ivec2 picture{1600, 1000}; ///< pixels of the pictures of eye and lab
};

/// What came of it.
struct SceneShowReport {
    int frames = 0;                    ///< of the video
    double framesPerSecond = 0.0;      ///< that could have been drawn live: both passes and the lab, median
    double loopMilliseconds = 0.0;     ///< of one frame of the loop, median
    double passMilliseconds = 0.0;     ///< of shadow, eye and projector passes, median
    std::vector<std::string> warnings; ///< plain sentences
};

/// Plays a project's scene for a while and records what a viewer sees of the lit device (the lab) as a video, by the
/// same loop and renderer as in the window; the viewer walks slowly around the device. `pictures` may be empty: else
/// the moment in the middle is written there as NAME-eye.png, NAME-projector.png and NAME-lab.png. `video` may be
/// empty. Throws DataError for what cannot be read, DeviceError where nothing can be drawn or written, InvalidInput for
/// a time outside (0, 600].
SceneShowReport playScene(const SceneShow& show, const std::filesystem::path& pictures,
                          const std::filesystem::path& video);

/// Plays a bundled demonstration ("water", "techniques") and tells its rates on `out`, as JSON if wanted. Throws
/// InvalidInput for a demonstration that there is not, and as `playScene` does.
void playDemo(const std::string& name, double seconds, const std::filesystem::path& video, bool json,
              std::ostream& out);

} // namespace lumorph::studio
