#pragma once

#include <cstdint>
#include <map>
#include <memory>
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
    std::string name; ///< on the command line: `--NAME TEXT`
    std::string help;
};
using DemoTold = std::map<std::string, std::string>; ///< texts by the names of options

/// A demonstration, as those who offer it know it: the window, the command line, tests. What it is made of stays in its
/// own folder.
struct Demo {
    std::string name;      ///< on the command line
    Words title;           ///< for visitors
    Words sentence;        ///< what is to be seen or done, for visitors
    std::string thumbnail; ///< a picture among the resources, 320 x 200
    std::string workspace; ///< in which it is seen best
    /// What it shows, ready but for the field of its rig, which takes its time. Throws DataError where a resource is
    /// missing, Cancelled.
    ProjectContents (*open)(const Progress& progress) = nullptr;
    /// All have the same items with the same ids; empty for one that shows one thing. A host chooses among them, and
    /// may change what he sees; visitors get `program`.
    std::vector<DemoStep> (*steps)() = nullptr;
    /// An application that answers what happens, in place of the scene of `open`; none: it goes by time alone. The same
    /// seed and inputs give the same show. Throws DataError where a resource is missing.
    std::unique_ptr<ShowProgram> (*program)(std::uint64_t seed) = nullptr;
    /// The same, with what it wanted kept the last time (ShowContent::keepsake), which `file` held; none: it keeps
    /// nothing. Throws DataError naming the file where that is damaged.
    std::unique_ptr<ShowProgram> (*remembering)(std::uint64_t seed, std::string_view kept,
                                                const std::string& file) = nullptr;
    std::vector<DemoOption> options = {}; ///< of an application; `programTold` is there where there are some
    /// As `program`, told something. Throws InvalidInput and DataError naming what cannot be, Cancelled.
    std::unique_ptr<ShowProgram> (*programTold)(std::uint64_t seed, const DemoTold& told,
                                                const Progress& progress) = nullptr;
};

/// The application of a demonstration; null for one that goes by time alone. Throws InvalidInput where it is told
/// something that it has no option for.
[[nodiscard]] std::unique_ptr<ShowProgram> startProgram(const Demo& demo, std::uint64_t seed, const DemoTold& told = {},
                                                        const Progress& progress = {});

/// A demonstration whose scene is a bundled project: `projects/NAME.lumorph`.
[[nodiscard]] ProjectContents bundledProject(const std::string& name, const Progress& progress);

} // namespace lumorph
