// Writes the headers of one of the variants that the sketch is tested in: channels.h, and poses.h where it has poses,
// else a copy of the sketch's own.

#include <filesystem>
#include <fstream>
#include <string>

#include "devices/firmware/pin_header.h"
#include "tests/firmware/twelve.h"

int main(int count, char** arguments) {
    if (count != 4) return 2;
    const std::string variant = arguments[1];
    const std::filesystem::path folder = arguments[3];
    const auto write = [&](const char* name, const std::string& text) {
        std::ofstream file(folder / name);
        file << text;
        return static_cast<bool>(file.flush());
    };
    const auto [profile, poses] = lumorph::firmware_test::variantOf(variant);
    if (!write("channels.h", lumorph::channelsHeader(profile))) return 1;
    if (poses) return write("poses.h", lumorph::posesHeader(profile, *poses)) ? 0 : 1;
    std::filesystem::copy_file(arguments[2], folder / "poses.h", std::filesystem::copy_options::overwrite_existing);
    return 0;
}
