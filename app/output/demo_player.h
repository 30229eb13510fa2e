#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "app/applications/demo.h"

namespace lumorph {

/// How a show is drawn without a display.
struct ShowPictures {
    double seconds = 4.0;
    glm::ivec2 video{960, 600};     ///< pixels of the video, both even
    glm::ivec2 picture{1600, 1000}; ///< pixels of the pictures of eye and lab
};

/// What came of it.
struct ShowRates {
    int frames = 0;                    ///< of the video
    double framesPerSecond = 0.0;      ///< that could have been drawn live: both passes and the lab, median
    double loopMilliseconds = 0.0;     ///< of one frame of the loop, median
    double passMilliseconds = 0.0;     ///< of shadow, eye and projector passes, median
    std::vector<std::string> warnings; ///< plain sentences
};

/// Plays a show for a while and records what a viewer sees of the lit device (the lab) as a video, by the same loop and
/// renderer as in the window; the viewer walks slowly around the device. `name` begins the names of pictures.
/// `pictures` may be empty: else the moment in the middle is written there as NAME-eye.png, NAME-projector.png and
/// NAME-lab.png. `video` may be empty. Throws DeviceError where nothing can be drawn or written, InvalidInput for a
/// time outside (0, 600].
ShowRates playShow(const ProjectContents& contents, const std::string& name, const ShowPictures& show,
                   const std::filesystem::path& pictures, const std::filesystem::path& video);

/// Plays a demonstration and tells its rates on `out`, as JSON if wanted. Throws as `Demo::open` and `playShow` do.
void playDemo(const Demo& demo, double seconds, const std::filesystem::path& video, bool json, std::ostream& out);

} // namespace lumorph
