#include <cstdio>
#include <exception>
#include <filesystem>

#include "app/applications/techniques/techniques.h"
#include "app/applications/water/water.h"
#include "core/scene/project.h"

namespace {

lumorph::Project projectOf(lumorph::Scene scene) {
    lumorph::Project project;
    project.rig = "resource:models/tablet.glb";
    project.matching.driver = lumorph::driverOf(scene);
    project.scene = std::move(scene);
    return project;
}

} // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fputs("usage: lumorph_projects FOLDER\n", stderr);
        return 2;
    }
    try {
        const std::filesystem::path folder = argv[1];
        lumorph::writeProject(projectOf(lumorph::waterScene()), folder / "water.lumorph");
        lumorph::writeProject(projectOf(lumorph::techniqueScene(1)), folder / "techniques.lumorph");
    } catch (const std::exception& error) {
        std::fprintf(stderr, "lumorph_projects: %s\n", error.what());
        return 1;
    }
    return 0;
}
