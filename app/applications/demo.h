#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/words.h"
#include "core/loop/show_program.h"
#include "core/show/project_contents.h"

namespace lumorph {

/// A scene that a demonstration shows at the press of a number key.
struct DemoStep {
    int key = 0; ///< the number key
    Words name;
    Words sentence; ///< what is to be seen
    Scene scene;
    Scene without; ///< the same without what it is to show, to compare
};

/// What an application may be told when it starts, beside its seed.
struct DemoOption {
    std::string name;  ///< on the command line: `--NAME TEXT`
    std::string help;  ///< there
    Words title;       ///< in the studio, for the host
    Words hint;        ///< what is expected there: "48.1,11.6"
    bool file = false; ///< a file or folder, which one may choose
};
using DemoTold = std::map<std::string, std::string>; ///< texts by the names of options

/// What has come anew of an option while its application runs: a later forecast.
struct DemoNews {
    std::string text; ///< empty: none has come, and what the application has is so old
    double age = 0.0; ///< seconds
};
/// What has come anew of an option since this was asked last; never waits.
using DemoFeed = std::function<std::optional<DemoNews>(const std::string& option)>;

/// What an application begins with.
struct ProgramStart {
    std::uint64_t seed = 0;     ///< of its chance: the same seed and inputs give the same show
    DemoTold told = {};         ///< by the names of its options
    std::string_view kept = {}; ///< what it wanted kept the last time (ShowContent::keepsake); empty: nothing
    std::string keptIn = {};    ///< the file that held it, for messages
    /// Takes what there is to say of the start: what of a map could not be shown.
    std::function<void(const std::string&)> note = [](const std::string&) {};
    DemoFeed feed = {}; ///< what comes while it runs; empty: nothing does
    /// Takes figures of its input, for programs: a name, and a JSON value.
    std::function<void(const std::string& name, const std::string& json)> figures = [](const auto&, const auto&) {};
};

/// Of a demonstration that shows one thing.
[[nodiscard]] std::vector<DemoStep> noSteps();

/// A demonstration, as those who offer it know it: the window, the command line, tests. What it is made of stays in its
/// own folder.
struct Demo {
    std::string name;                ///< on the command line
    Words title;                     ///< for visitors
    Words sentence;                  ///< what is to be seen or done, for visitors
    std::string thumbnail;           ///< a picture among the resources, 320 x 200
    std::string workspace = "scene"; ///< in which it is seen best
    /// What it shows, ready but for the field of its rig, which takes its time. Throws DataError where a resource is
    /// missing, Cancelled.
    ProjectContents (*open)(const Progress& progress) = nullptr;
    /// All have the same items with the same ids; empty for one that shows one thing. A host chooses among them, and
    /// may change what he sees; visitors get `program`.
    std::vector<DemoStep> (*steps)() = noSteps;
    /// An application that answers what happens, in place of the scene of `open`; none: it goes by time alone. Call it
    /// by `beginProgram` (program_start.h). Throws DataError where a resource is missing, or what was kept is damaged,
    /// and names it; InvalidInput and DataError for what it is told; Cancelled.
    std::unique_ptr<ShowProgram> (*program)(const ProgramStart& start, const Progress& progress) = nullptr;
    double filmSeconds = 6.0;             ///< default length of a video: all that it shows without input
    bool keeps = false;                   ///< its program wants something kept (ShowContent::keepsake)
    std::vector<DemoOption> options = {}; ///< that its program may be told
    bool hostEdits = false;  ///< a host gets the scene of `open`, as where there are steps; visitors get `program`
    bool forVisitors = true; ///< else on the host's cards alone
    bool compares = false;   ///< its program shows at `key.off` what it does with and without
};

/// What is written under the device without and with view dependence, where both are seen beside each other
/// (ShowContent::comparesBend).
[[nodiscard]] const std::array<Words, 2>& bendCaptions();

/// A demonstration whose scene is a bundled project: `projects/NAME.lumorph`.
[[nodiscard]] ProjectContents bundledProject(const std::string& name, const Progress& progress);
/// A demonstration that makes its scene itself, on the bundled tablet.
[[nodiscard]] ProjectContents bundledTablet(const Progress& progress);

} // namespace lumorph
