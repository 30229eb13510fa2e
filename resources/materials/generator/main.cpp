#include <cstdio>
#include <exception>
#include <filesystem>

#include "resources/materials/generator/picture_file.h"
#include "resources/materials/generator/textures.h"

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fputs("usage: lumorph_materials FOLDER\n", stderr);
        return 2;
    }
    try {
        using namespace lumorph;
        const std::filesystem::path folder = argv[1];
        for (const auto make : {woodPictures, brickPictures, mapPictures, icePictures, waterPictures, plainPictures})
            for (const NamedPicture& picture : make()) writeOpaquePng(picture.image, folder / (picture.name + ".png"));
    } catch (const std::exception& error) {
        std::fprintf(stderr, "lumorph_materials: %s\n", error.what());
        return 1;
    }
    return 0;
}
