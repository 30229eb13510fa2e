#include "app/applications/demo.h"

#include <utility>

#include "core/base/resources.h"

namespace lumorph {

std::vector<DemoStep> noSteps() { return {}; }

ProjectContents bundledProject(const std::string& name, const Progress& progress) {
    return readContents(resourceFile("projects/" + name + ".lumorph"), progress);
}

ProjectContents bundledTablet(const Progress& progress) {
    Project project;
    project.rig = "resource:models/tablet.glb";
    return readContents(std::move(project), {}, progress);
}

} // namespace lumorph
