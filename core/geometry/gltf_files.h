#pragma once

#include <filesystem>
#include <vector>

namespace lumorph {

/// A file that a glTF needs beside itself.
struct ReferredFile {
    std::filesystem::path name; ///< as the glTF names it: relative to its folder, never leaving it
    std::filesystem::path file; ///< where it lies, links followed
    bool missing = false;       ///< a picture that is not there; the model can be read without
};

/// The buffers and images beside a .gltf or .glb, each once, in the order in which the file names them. Throws
/// DataError: the file or a buffer cannot be read, or one of these leads out of the folder.
[[nodiscard]] std::vector<ReferredFile> filesReferredBy(const std::filesystem::path& gltf);

} // namespace lumorph
