#include "app/applications/demo.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/base/resources.h"

namespace lumorph {

ProjectContents bundledProject(const std::string& name, const Progress& progress) {
    return readContents(resourceFile("projects/" + name + ".lumorph"), progress);
}

std::unique_ptr<ShowProgram> startProgram(const Demo& demo, std::uint64_t seed, const DemoTold& told,
                                          const Progress& progress) {
    for (const auto& [name, text] : told)
        if (std::ranges::find(demo.options, name, &DemoOption::name) == demo.options.end())
            throw InvalidInput("--" + name, "the demo '" + demo.name + "' has no such option", "leave it out");
    if (demo.programTold) return demo.programTold(seed, told, progress);
    return demo.program ? demo.program(seed) : nullptr;
}

} // namespace lumorph
