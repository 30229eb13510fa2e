#include "app/applications/demo.h"

#include <utility>

#include "core/base/resources.h"

namespace lumorph {

std::vector<DemoStep> noSteps() { return {}; }

const std::array<Words, 2>& bendCaptions() {
    static const std::array<Words, 2> captions{Words("Without bending", "Ohne Biegen"),
                                               Words("Bent towards you", "Zu dir gebogen")};
    return captions;
}

ProjectContents bundledProject(const std::string& name, const Progress& progress) {
    return readContents(resourceFile("projects/" + name + ".lumorph"), progress);
}

ProjectContents bundledTablet(const Progress& progress) {
    Project project;
    project.rig = "resource:models/tablet.glb";
    return readContents(std::move(project), {}, progress);
}

} // namespace lumorph
