#include <cstdio>
#include <exception>
#include <filesystem>

#include "core/base/atomic_file.h"
#include "resources/targets/generator/targets.h"

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fputs("usage: lumorph_targets FOLDER\n", stderr);
        return 2;
    }
    try {
        const std::filesystem::path folder = argv[1];
        lumorph::writeFileAtomically(folder / "dunes.glb", lumorph::writeGlb(lumorph::dunesModel()));
        lumorph::writeFileAtomically(folder / "bloom.glb", lumorph::writeGlb(lumorph::bloomModel()));
        lumorph::writeFileAtomically(folder / "swell.glb", lumorph::writeGlb(lumorph::swellModel()));
        for (const auto& [name, model] : lumorph::shapeModels())
            lumorph::writeFileAtomically(folder / (name + ".glb"), lumorph::writeGlb(model));
    } catch (const std::exception& error) {
        std::fprintf(stderr, "lumorph_targets: %s\n", error.what());
        return 1;
    }
    return 0;
}
