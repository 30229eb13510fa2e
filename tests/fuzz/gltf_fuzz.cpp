#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/geometry/model.h"
#include "tests/support/gltf_builder.h"

using namespace lumorph;

namespace {

constexpr std::size_t kMaxInput = 1 << 16;

/// The GLB an input stands for. An input that is not one itself is JSON, a zero byte and binary data: the lengths in a
/// GLB would otherwise undo most changes of the JSON.
std::vector<std::byte> glbOf(std::span<const std::byte> input) {
    const std::string text(reinterpret_cast<const char*>(input.data()), input.size());
    if (text.starts_with("glTF")) return {input.begin(), input.end()};
    const std::size_t end = std::min(text.find('\0'), text.size());
    const auto binary = input.subspan(std::min(end + 1, text.size()));
    return support::packGlb(text.substr(0, end), {binary.begin(), binary.end()});
}

/// What was read must write, and read back the same.
void checkRoundTrip(const Model& model) {
    const auto written = writeGlb(model);
    if (!(readGlb(written, "again.glb") == model)) std::abort();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size > kMaxInput) return 0;
    try {
        const Model model = readGlb(glbOf(std::as_bytes(std::span(data, size))), "fuzz.glb");
        // A few bytes may show a mesh ten million times; posing and writing that only costs time.
        std::size_t triangles = 0;
        for (const Model::Node& node : model.nodes)
            if (node.mesh >= 0)
                for (const Model::Primitive& p : model.meshes[static_cast<std::size_t>(node.mesh)].primitives)
                    triangles += p.triangles.size() + p.positions.size();
        if (triangles > 100'000) return 0;
        checkRoundTrip(model);
        (void)flatten(model);
        for (const Model::Animation& animation : model.animations)
            (void)flatten(model, animation, 0.5 * animation.duration());
    } catch (const Error&) {
        // A refusal is what a broken file is meant to get.
    }
    return 0;
}
