#include "core/geometry/gltf_files.h"

#include <set>

#include "core/geometry/gltf_source.h"
#include "core/geometry/mesh_file.h"

namespace lumorph {

std::vector<ReferredFile> filesReferredBy(const std::filesystem::path& gltf) {
    const std::string subject = gltf.string();
    const std::vector<std::byte> bytes = gltf::readFile(gltf, kMaxFileBytes, subject);
    const nlohmann::json document = gltf::parseBounded(gltf::splitFile(bytes, gltf).json, subject);
    const gltf::Folder folder(gltf.parent_path());
    std::vector<ReferredFile> files;
    std::set<std::filesystem::path> names{gltf.filename()}; // one that names itself is there already
    for (const auto& [list, element] : {std::pair{"buffers", "buffer"}, std::pair{"images", "image"}}) {
        std::size_t index = 0;
        for (const nlohmann::json& source : gltf::listOf(document, list, subject)) {
            const std::string place = std::string(element) + " " + std::to_string(index++);
            if (!source.is_object()) gltf::refuse(subject, place + ": is not an object");
            const std::string uri = gltf::stringMember(source, "uri");
            if (uri.empty() || gltf::isData(uri)) continue;
            ReferredFile file{gltf::percentDecoded(uri), folder.find(uri, place, subject)};
            file.name = file.name.lexically_normal();
            if (names.insert(file.name).second) files.push_back(std::move(file));
        }
    }
    return files;
}

} // namespace lumorph
