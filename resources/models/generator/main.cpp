#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>

#include "core/base/error.h"
#include "core/rig/rig_file.h"
#include "core/rig/templates/bundled_rigs.h"

namespace {

void write(const lumorph::Rig& rig, const std::filesystem::path& file) {
    const std::vector<std::byte> bytes = lumorph::writeRigGlb(rig);
    std::ofstream stream(file, std::ios::binary);
    stream.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    stream.close();
    if (!stream) throw lumorph::DeviceError(file.string(), "it could not be written", "check the folder and the disk");
}

} // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fputs("usage: lumorph_models FOLDER\n", stderr);
        return 2;
    }
    try {
        const std::filesystem::path folder = argv[1];
        write(lumorph::sheetRig(lumorph::tabletDrawing()), folder / "tablet.glb");
        write(lumorph::pinDisplayRig(), folder / "pin_display.glb");
        write(lumorph::ribbonRig(), folder / "ribbon.glb");
        write(lumorph::hillsRig(), folder / "hills.glb");
    } catch (const std::exception& error) {
        std::fprintf(stderr, "lumorph_models: %s\n", error.what());
        return 1;
    }
    return 0;
}
