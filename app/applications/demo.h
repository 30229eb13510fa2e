#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/loop/show_program.h"
#include "core/show/project_contents.h"

namespace lumorph {

/// A scene that a demonstration shows at the press of a number key.
struct DemoStep {
    int key = 0; ///< the number key
    std::string name;
    std::string sentence; ///< what is to be seen
    Scene scene;
};

/// What an application may be told before it begins, by name, as text: `weather` a file (or an
/// address, with what came from there as `forecast`), `place` "LAT,LON", `begin` a
/// time, `day` seconds, `anticipation` seconds. Those it does not know it refuses.
using DemoSettings = std::map<std::string, std::string>;

/// A demonstration, as those who offer it know it: the window, the command line, tests. What it is made of stays in its
/// own folder.
struct Demo {
    std::string name;      ///< on the command line
    std::string title;     ///< for visitors
    std::string sentence;  ///< what is to be seen, for visitors
    std::string thumbnail; ///< a picture among the resources, 320 x 200
    std::string workspace; ///< in which it is seen best
    /// What it shows, ready but for the field of its rig, which takes its time. Throws DataError where a resource is
    /// missing, Cancelled.
    ProjectContents (*open)(const Progress& progress) = nullptr;
    /// All have the same items with the same ids; empty for one that shows one thing.
    std::vector<DemoStep> (*steps)() = nullptr;
    /// An application that answers what happens, in place of the scene of `open`; none: it goes by time alone. The same
    /// seed and inputs give the same show. Throws DataError where a resource is missing.
    std::unique_ptr<ShowProgram> (*program)(std::uint64_t seed) = nullptr;
    /// The same with settings; none: it takes none. Throws InvalidInput for a setting that is wrong or not known, and
    /// DataError for a file that is.
    std::unique_ptr<ShowProgram> (*configured)(std::uint64_t seed, const DemoSettings& settings) = nullptr;
};

/// A demonstration whose scene is a bundled project: `projects/NAME.lumorph`.
[[nodiscard]] ProjectContents bundledProject(const std::string& name, const Progress& progress);

} // namespace lumorph
