#include "app/applications/demo.h"

#include "core/base/resources.h"

namespace lumorph {

ProjectContents bundledProject(const std::string& name, const Progress& progress) {
    return readContents(resourceFile("projects/" + name + ".lumorph"), progress);
}

} // namespace lumorph
