#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "core/base/error.h"
#include "core/geometry/model.h"
#include "tests/fuzz/glb_input.h"

using namespace lumorph;

namespace {

constexpr std::size_t kMaxInput = 1 << 16;

/// What was read must write, and read back the same.
void checkRoundTrip(const Model& model) {
    const auto written = writeGlb(model);
    if (!(readGlb(written, "again.glb") == model)) std::abort();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size > kMaxInput) return 0;
    try {
        const Model model = readGlb(fuzz::glbOf(std::as_bytes(std::span(data, size))), "fuzz.glb");
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
