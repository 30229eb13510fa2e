#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <iosfwd>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>

#include "app/applications/demo.h"
#include "core/base/progress.h"
#include "core/show/input_script.h"

namespace lumorph {

/// How a show is drawn without a display.
struct ShowPictures {
    double seconds = 4.0;
    glm::ivec2 video{960, 600};     ///< pixels of the video, both even
    glm::ivec2 picture{1600, 1000}; ///< pixels of the pictures of eye and lab
    std::filesystem::path last;     ///< the video's last picture as a PNG file; empty: none
};

/// An application that takes the place of a project's scene, and what is done to it.
struct ShowScript {
    std::shared_ptr<ShowProgram> program; ///< empty: the project's own scene
    InputScript inputs;
    Language language = Language::english; ///< in which it writes
    std::vector<std::string> notes;        ///< of the application about what it was told, plain sentences
    std::vector<std::pair<std::string, std::string>> figures; ///< the same for programs: names and JSON values
};

/// What came of it.
struct ShowRates {
    int frames = 0;                        ///< of the video
    double framesPerSecond = 0.0;          ///< that could have been drawn live: both passes and the lab, median
    double loopMilliseconds = 0.0;         ///< of one frame of the loop, median
    double passMilliseconds = 0.0;         ///< of shadow, eye and projector passes, median
    std::vector<std::string> warnings;     ///< plain sentences
    std::function<std::string()> keepsake; ///< the newest that the program wants kept; empty: none
};

/// Plays a show for a while and records what a viewer sees of the lit device (the lab) as a video, by the same loop and
/// renderer as in the window; the viewer walks slowly around the device. What compares the device without and with view
/// dependence is seen so, in two halves. `name` begins the names of pictures.
/// `pictures` may be empty: else the moment in the middle is written there as NAME-eye.png, NAME-projector.png and
/// NAME-lab.png. `video` may be empty. Throws DeviceError where nothing can be drawn or written, InvalidInput for a
/// time outside (0, 600], Cancelled; then no video is left. The error that ends a program is a warning.
ShowRates playShow(const ProjectContents& contents, const std::string& name, const ShowPictures& show,
                   const std::filesystem::path& pictures, const std::filesystem::path& video,
                   const ShowScript& script = {}, const Progress& progress = {});

/// How a demonstration is played without a window.
struct DemoPlay {
    double seconds = 6.0;
    glm::ivec2 size{960, 600};    ///< pixels, both even
    std::filesystem::path video;  ///< .mp4; empty: none
    std::filesystem::path last;   ///< its last picture, .png; empty: none
    std::filesystem::path inputs; ///< as `readInputScript` reads them; empty: none
    std::filesystem::path kept;   ///< what an application wants kept is read from here and written back; empty: not
    std::uint64_t seed = 1;       ///< of an application
    Language language = Language::english; ///< of what it writes into its picture
    DemoTold told;                         ///< to an application, by the names of its options
    bool json = false;                     ///< its rates as JSON
};

/// Plays a demonstration and tells its rates on `out`. Throws InvalidInput for inputs or settings of one that takes
/// none, and as `Demo::open`, `Demo::program`, `readInputScript` and `playShow` do.
void playDemo(const Demo& demo, const DemoPlay& play, std::ostream& out, const Progress& progress = {});

} // namespace lumorph
