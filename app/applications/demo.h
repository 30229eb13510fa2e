#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
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
    /// The same, with what it wanted kept the last time (ShowContent::keepsake), which `file` held; none: it keeps
    /// nothing. Throws DataError naming the file where that is damaged.
    std::unique_ptr<ShowProgram> (*remembering)(std::uint64_t seed, std::string_view kept,
                                                const std::string& file) = nullptr;
};

/// A demonstration whose scene is a bundled project: `projects/NAME.lumorph`.
[[nodiscard]] ProjectContents bundledProject(const std::string& name, const Progress& progress);

} // namespace lumorph
