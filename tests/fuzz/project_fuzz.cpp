#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "core/base/error.h"
#include "core/scene/project.h"
#include "core/scene/scene_assets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace lumorph;
    constexpr std::size_t kMaxInput = 1 << 16;
    if (size > kMaxInput) return 0;
    try {
        const Project project = parseProject({reinterpret_cast<const char*>(data), size}, "fuzz.lumorph");
        // What was accepted names nothing outside, and comes back as it was written.
        for (const std::string* asset : {&project.rig, &project.field, &project.target})
            if (!asset->empty() && !isAssetName(*asset)) std::abort();
        for (const std::string& asset : assetNames(project.scene))
            if (!isAssetName(asset)) std::abort();
        checkScene(project.scene);
        checkInstallation(project.installation);
        const std::string text = projectText(project);
        if (projectText(parseProject(text, "again.lumorph")) != text) std::abort();
    } catch (const DataError&) {
        // A refusal is what a broken file is meant to get. That a project once read is refused when written is none.
    }
    return 0;
}
