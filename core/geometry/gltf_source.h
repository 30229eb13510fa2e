#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>
#include <tiny_gltf.h>

#include "core/geometry/model.h"

/// How a glTF file is taken in before its content is looked at: bounded, confined and with every reference resolved.
/// Private to core/geometry.
namespace lumorph::gltf {

inline constexpr std::size_t kMaxElements = 100'000; ///< of one kind: nodes, meshes, accessors and so on
inline constexpr std::size_t kMaxImageBytes = std::size_t{256} << 20;

inline constexpr const char* kExportAgain = "export the model again, or check it with a glTF validator";

[[noreturn]] void refuse(const std::string& file, const std::string& why, const std::string& remedy = kExportAgain);

/// Memory a file may ask for, tied to its size: accessors may share or omit their data, so that a few bytes of JSON
/// could otherwise demand gigabytes.
class MemoryBudget {
public:
    MemoryBudget(std::string file, std::size_t sourceBytes);
    void charge(std::size_t count, std::size_t bytesEach, const std::string& place);

private:
    std::string file_;
    std::size_t left_;
};

/// The two chunks of a GLB.
struct Container {
    std::string_view json;
    std::optional<std::span<const std::byte>> binary;
};
[[nodiscard]] Container splitGlb(std::span<const std::byte> bytes, const std::string& file);

/// The two chunks of a GLB, or the whole of a text file as JSON, told apart by how they begin and by the file's name.
/// `text` is what the bytes are as text.
[[nodiscard]] Container splitFile(std::span<const std::byte> bytes, std::string_view text,
                                  const std::filesystem::path& file);

/// Parses JSON after a pass without recursion has bounded its length, depth and number of values.
[[nodiscard]] nlohmann::json parseBounded(std::string_view text, const std::string& file);

/// The typed structure of `document`: everything but buffers, images, extras and extensions, which tinygltf never sees.
/// Refuses required extensions without which the geometry cannot be read, and indices that are not whole numbers.
[[nodiscard]] tinygltf::Model structureOf(const nlohmann::json& document, const std::string& file);

/// Where relative URIs lead: a folder, or nowhere for a model held in memory.
class Folder {
public:
    Folder() = default;
    explicit Folder(std::filesystem::path path) : path_(std::move(path)) {}

    /// Where the file that `uri` names lies or would lie, links followed; its name may differ in Unicode normal form,
    /// case and kind of slashes. Refuses whatever does not lie inside the folder.
    [[nodiscard]] std::filesystem::path place(const std::string& uri, const std::string& place,
                                              const std::string& file) const;
    /// The same; refuses what is no file.
    [[nodiscard]] std::filesystem::path find(const std::string& uri, const std::string& place,
                                             const std::string& file) const;
    /// Its bytes.
    [[nodiscard]] std::vector<std::byte> read(const std::string& uri, std::size_t maxBytes, const std::string& place,
                                              const std::string& file) const;

private:
    std::optional<std::filesystem::path> path_;
};

/// A URI without its percent signs.
[[nodiscard]] std::string percentDecoded(std::string_view uri);

/// Elements of a top-level list, none where it is missing. Refuses what is no list, and one that is too long.
[[nodiscard]] const nlohmann::json& listOf(const nlohmann::json& document, const char* name, const std::string& file);

/// The string under a key of an object; empty where there is none.
[[nodiscard]] std::string stringMember(const nlohmann::json& object, const char* key);

/// Whether a URI holds its data itself.
[[nodiscard]] bool isData(std::string_view uri) noexcept;

/// Bytes of a whole regular file. Throws DataError when it cannot be read or is longer than `maxBytes`.
[[nodiscard]] std::vector<std::byte> readFile(const std::filesystem::path& path, std::size_t maxBytes,
                                              const std::string& subject);

/// Buffers by index. `owned` holds those that are not part of the file itself.
struct Buffers {
    std::vector<std::vector<std::byte>> owned;
    std::vector<std::span<const std::byte>> bytes;
};
[[nodiscard]] Buffers readBuffers(const nlohmann::json& document, const Container& container, const Folder& folder,
                                  const std::string& file);

/// The bytes of a buffer view. Refuses an index or a range that does not exist.
[[nodiscard]] std::span<const std::byte> viewBytes(const tinygltf::Model& structure, const Buffers& buffers, int view,
                                                   const std::string& place, const std::string& file);

/// A picture that lies in a file beside the model, and is not there or not to be read, is empty and leaves a warning.
[[nodiscard]] std::vector<Model::Image> readImages(const nlohmann::json& document, const tinygltf::Model& structure,
                                                   const Buffers& buffers, const Folder& folder, MemoryBudget& budget,
                                                   const std::string& file, std::vector<std::string>& warnings);

} // namespace lumorph::gltf
