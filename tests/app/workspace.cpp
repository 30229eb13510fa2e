#include "tests/app/workspace.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "core/geometry/mesh_writers.h"
#include "core/rig/rig_file.h"
#include "tests/app/process.h"
#include "tests/support/cut_tablet.h"
#include "tests/support/small_rigs.h"

namespace lumorph::test {

std::string textOfFile(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw std::runtime_error("cannot read " + file.string());
    return {std::istreambuf_iterator<char>(stream), {}};
}

std::vector<std::byte> bytesOfFile(const std::filesystem::path& file) {
    const std::string text = textOfFile(file);
    const auto bytes = std::as_bytes(std::span<const char>(text));
    return {bytes.begin(), bytes.end()};
}

void writeFile(const std::filesystem::path& file, std::span<const std::byte> bytes) {
    std::ofstream stream(file, std::ios::binary);
    stream.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    if (!stream.flush()) throw std::runtime_error("cannot write " + file.string());
}

void writeFile(const std::filesystem::path& file, const std::string& text) {
    writeFile(file, std::as_bytes(std::span<const char>(text)));
}

std::vector<std::string> filesIn(const std::filesystem::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        names.push_back(entry.path().filename().string());
    std::ranges::sort(names);
    return names;
}

std::string resource(const std::string& name) { return LUMORPH_SOURCE_DIR "/resources/" + name; }

namespace {

void buildField(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"mdf", "build"});
    const Outcome built = lumorph(arguments);
    if (built.exitCode != 0) throw std::runtime_error("the field could not be built: " + built.err);
}

} // namespace

SmallWorkspace::SmallWorkspace() {
    writeFile(folder_ / "rig.glb", writeRigGlb(cushionRig()));
    writeFile(folder_ / "target.obj", writeObj(boxMesh({0.01F, 0.0205F, 0.01F}, {0.06F, 0.034F, 0.07F})));
    buildField({(*this)["rig.glb"], "-o", (*this)["field.mdf"], "--resolution", "17", "--levels", "5"});
}

std::string cutTabletFile() {
    static const TemporaryFolder folder;
    static const std::string file = writeCutTablet(folder.path()).string();
    return file;
}

TabletWorkspace::TabletWorkspace() { buildField({cutTabletFile(), "-o", field()}); }

} // namespace lumorph::test
