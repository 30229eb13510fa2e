#include "core/render/eye/eye_programs.h"

#include <algorithm>
#include <utility>

#include "core/base/error.h"

namespace lumorph {
namespace {

using namespace eye_feature;
using Stage = EyePrograms::Stage;

constexpr std::pair<std::uint32_t, const char*> kNames[] = {
    {skin, "SKIN"},
    {holes, "HOLES"},
    {holeMask, "HOLE_MASK"},
    {cutout, "CUTOUT"},
    {colorTexture, "COLOR_TEXTURE"},
    {normalA, "NORMAL_A"},
    {normalB, "NORMAL_B"},
    {specular, "SPECULAR"},
    {reflection, "REFLECTION"},
    {refraction, "REFRACTION"},
    {unlit, "UNLIT"},
    {shadow, "SHADOW"},
    {lamp, "LAMP"},
    {fog, "FOG"},
    {blend, "BLEND"},
    {twoSided, "TWO_SIDED"},
    {table, "TABLE"},
    {dither, "DITHER"},
    {holesBelow, "HOLES_BELOW"},
    {secondFog, "SECOND_FOG"},
    {projected, "PROJECTED"},
    {shared, "SHARED"},
    {gamma, "GAMMA"},
    {response, "RESPONSE"},
};

std::vector<std::string> definesOf(std::uint32_t features) {
    std::vector<std::string> defines;
    for (const auto& [bit, name] : kNames)
        if ((features & bit) != 0) defines.emplace_back(name);
    defines.push_back("LIGHTS " + std::to_string((features >> lightShift) & 7U));
    defines.push_back("HOLE_COUNT " + std::to_string(features >> holeShift));
    return defines;
}

ShaderFiles filesOf(Stage stage, std::uint32_t features) {
    const auto has = [&](std::uint32_t bits) { return (features & bits) != 0; };
    ShaderFiles files;
    std::vector<std::string> fragment{"version.glsl", "eye_holes.glsl"};
    if (stage != Stage::depth) fragment.emplace_back("eye_tone.glsl");
    if (has(projected)) {
        fragment.insert(fragment.end(), {"physical_normal.glsl", "projector_light.glsl"});
        if (has(response)) fragment.emplace_back("projector_response.glsl");
        fragment.emplace_back("projector_output.glsl");
    }
    if (stage == Stage::depth) {
        fragment.emplace_back("eye_depth.frag");
        files = shaderFiles({"version.glsl", "eye_depth.vert"}, fragment);
    } else if (stage == Stage::crease) {
        fragment.emplace_back("eye_crease.frag");
        files = shaderFiles({"version.glsl", "camera.glsl", "eye_crease.vert"}, fragment);
    } else {
        if (has(shadow)) fragment.emplace_back("eye_shadow.glsl");
        if (has(reflection | refraction)) fragment.emplace_back("eye_environment.glsl");
        if (has(fog)) fragment.insert(fragment.end(), {"noise.glsl", "eye_fog.glsl"});
        fragment.emplace_back("eye_surface.frag");
        files = shaderFiles({"version.glsl", "camera.glsl", "eye_surface.vert"}, fragment);
    }
    files.defines = definesOf(features);
    return files;
}

ShaderFiles plainFiles(Stage stage) {
    if (stage == Stage::depth) return shaderFiles({"depth.vert"}, {"depth.frag"});
    return shaderFiles({"version.glsl", "camera.glsl", "eye_plain.vert"}, {"version.glsl", "eye_plain.frag"});
}

} // namespace

Program& EyePrograms::use(Stage stage, std::uint32_t features) {
    const auto key = std::pair(stage, features);
    auto found = programs_.find(key);
    if (found == programs_.end()) found = programs_.emplace(key, Entry{Program({}), false}).first;
    Entry& entry = found->second;
    if (!entry.tried) {
        entry.tried = true;
        try {
            entry.program = Program(filesOf(stage, features));
            entry.program.use();
        } catch (const DataError& error) {
            const std::string warning = error.subject() + ": " + error.why() + "; a plain program stands in for it";
            if (std::find(warnings_.begin(), warnings_.end(), warning) == warnings_.end()) warnings_.push_back(warning);
            entry.program = Program(plainFiles(stage));
        }
    }
    entry.program.use();
    return entry.program;
}

std::size_t EyePrograms::objectCount() const noexcept {
    std::size_t count = 0;
    for (const auto& [key, entry] : programs_) count += entry.program.objectCount();
    return count;
}

} // namespace lumorph
