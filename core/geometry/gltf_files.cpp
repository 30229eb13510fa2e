#include "core/geometry/gltf_files.h"

#include <algorithm>
#include <set>
#include <string>
#include <string_view>
#include <system_error>

#include "core/base/confined_path.h"
#include "core/base/plain_text.h"
#include "core/geometry/gltf_source.h"
#include "core/geometry/mesh_file.h"

namespace lumorph {
namespace {

/// The name under which a copy of the model finds the file: as it is written, with the slashes of this system.
std::filesystem::path nameBeside(const std::string& uri, const std::filesystem::path& at) {
    std::string name = gltf::percentDecoded(uri);
    std::string slashed = name;
    std::ranges::replace(slashed, '\\', '/');
    // A link may have a name with backslashes that would lead out of the folder as slashes.
    if (at.filename().native().find('\\') == std::string::npos && staysInside(slashed)) name = slashed;
    return std::filesystem::path(name).lexically_normal();
}

} // namespace

std::vector<ReferredFile> filesReferredBy(const std::filesystem::path& gltf) {
    const std::string subject = gltf.string();
    const std::vector<std::byte> bytes = gltf::readFile(gltf, kMaxFileBytes, subject);
    const PlainText text(bytes);
    const nlohmann::json document = gltf::parseBounded(gltf::splitFile(bytes, text.view(), gltf).json, subject);
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
            const std::filesystem::path at = folder.place(uri, place, subject);
            // A picture may be missing; what lies in its place, and data, have to be files.
            std::error_code failed;
            const bool missing = list == std::string_view("images") && !std::filesystem::exists(at, failed);
            ReferredFile file{nameBeside(uri, at), missing ? at : folder.find(uri, place, subject), missing};
            if (names.insert(file.name).second) files.push_back(std::move(file));
        }
    }
    return files;
}

} // namespace lumorph
