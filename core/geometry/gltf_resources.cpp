#include "core/geometry/gltf_source.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <system_error>

#include "core/base/confined_path.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/geometry/mesh_file.h"

namespace lumorph::gltf {

using nlohmann::json;

namespace {

constexpr const char* kKeepBeside = "put the file beside the model, or export as .glb with everything inside";

int hexDigit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

int base64Digit(char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    if (c == '+') return 62;
    return c == '/' ? 63 : -1;
}

std::vector<std::byte> base64Decoded(std::string_view text, const std::string& place, const std::string& file) {
    while (!text.empty() && text.back() == '=') text.remove_suffix(1);
    std::vector<std::byte> bytes;
    bytes.reserve(text.size() / 4 * 3 + 2);
    std::uint32_t bits = 0;
    int count = 0;
    for (const char c : text) {
        const int digit = base64Digit(c);
        if (digit < 0) refuse(file, place + ": its data URI is not base64");
        bits = (bits << 6) | static_cast<std::uint32_t>(digit);
        count += 6;
        if (count < 8) continue;
        count -= 8;
        bytes.push_back(static_cast<std::byte>((bits >> count) & 0xFFU));
    }
    return bytes;
}

struct DataUri {
    std::string mimeType;
    std::string_view payload;
};

DataUri splitDataUri(std::string_view uri, const std::string& place, const std::string& file) {
    const std::size_t comma = uri.find(',');
    const std::string_view head = uri.substr(5, comma == std::string_view::npos ? 0 : comma - 5);
    if (comma == std::string_view::npos || !head.ends_with(";base64"))
        refuse(file, place + ": its data URI is not base64");
    return {std::string(head.substr(0, head.find(';'))), uri.substr(comma + 1)};
}

std::vector<std::byte> uriBytes(const std::string& uri, std::size_t maxBytes, const Folder& folder,
                                const std::string& place, const std::string& file) {
    if (!isData(uri)) return folder.read(uri, maxBytes, place, file);
    const std::string_view payload = splitDataUri(uri, place, file).payload;
    if (payload.size() / 4 * 3 > maxBytes) refuse(file, place + ": is too large");
    return base64Decoded(payload, place, file);
}

template <std::size_t size>
bool beginsWith(std::span<const std::byte> bytes, const std::array<unsigned char, size>& magic) {
    return bytes.size() >= size && std::memcmp(bytes.data(), magic.data(), size) == 0;
}

std::string sniffedMimeType(std::span<const std::byte> bytes) {
    if (beginsWith(bytes, std::array<unsigned char, 4>{0x89, 'P', 'N', 'G'})) return "image/png";
    if (beginsWith(bytes, std::array<unsigned char, 3>{0xFF, 0xD8, 0xFF})) return "image/jpeg";
    return {};
}

std::span<const std::byte> bufferBytes(const json& buffer, std::size_t index, const Container& container,
                                       const Folder& folder, std::size_t maxBytes, Buffers& buffers,
                                       const std::string& file) {
    const std::string place = "buffer " + std::to_string(index);
    if (buffer.contains("uri")) {
        const std::string uri = stringMember(buffer, "uri");
        buffers.owned.push_back(uriBytes(uri, maxBytes, folder, place, file));
        return buffers.owned.back();
    }
    if (index > 0 || !container.binary) {
        // A buffer that is there to be unpacked into.
        const auto extensions = buffer.find("extensions");
        const bool packed = extensions != buffer.end() && extensions->is_object() && !extensions->empty();
        if (packed)
            refuse(file, place + ": is compressed (" + extensions->begin().key().substr(0, 80) + ")",
                   "export the model without compression");
        refuse(file, place + ": has no data");
    }
    return *container.binary;
}

} // namespace

std::vector<std::byte> readFile(const std::filesystem::path& path, std::size_t maxBytes, const std::string& subject) {
    std::error_code failed;
    // Reading a device or a pipe might never end.
    if (!std::filesystem::is_regular_file(path, failed))
        refuse(subject, path.filename().string() + " is not there or not a file", "check the path and the permissions");
    const std::uintmax_t size = std::filesystem::file_size(path, failed);
    if (failed) refuse(subject, path.filename().string() + " cannot be read", "check the permissions of the file");
    if (size > maxBytes)
        refuse(subject, path.filename().string() + " is larger than " + std::to_string(maxBytes >> 20) + " MiB",
               "split the model, or shrink its pictures");
    std::vector<std::byte> bytes(static_cast<std::size_t>(size));
    std::ifstream stream(path, std::ios::binary);
    stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    if (!stream || static_cast<std::size_t>(stream.gcount()) != bytes.size())
        refuse(subject, path.filename().string() + " cannot be read", "check the permissions of the file");
    return bytes;
}

std::string percentDecoded(std::string_view uri) {
    std::string decoded;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const int high = i + 2 < uri.size() && uri[i] == '%' ? hexDigit(uri[i + 1]) : -1;
        const int low = high >= 0 ? hexDigit(uri[i + 2]) : -1;
        decoded += low >= 0 ? static_cast<char>(high * 16 + low) : uri[i];
        if (low >= 0) i += 2;
    }
    return decoded;
}

bool isData(std::string_view uri) noexcept { return uri.starts_with("data:"); }

const json& listOf(const json& document, const char* name, const std::string& file) {
    static const json none = json::array();
    const auto list = document.find(name);
    if (list == document.end()) return none;
    if (!list->is_array() || list->size() > kMaxElements)
        refuse(file,
               std::string("\"") + name + "\" is not a list of at most " + std::to_string(kMaxElements) + " elements");
    return *list;
}

std::string stringMember(const json& object, const char* key) {
    const auto member = object.find(key);
    return member != object.end() && member->is_string() ? member->get<std::string>() : std::string();
}

std::filesystem::path Folder::place(const std::string& uri, const std::string& place, const std::string& file) const {
    if (!path_)
        refuse(file, place + ": refers to " + inQuotes(uri) + " outside the file",
               "export as .glb with everything inside");
    const auto target = confinedPath(*path_, percentDecoded(uri));
    if (!target) refuse(file, place + ": " + inQuotes(uri) + " leads out of the folder of the model", kKeepBeside);
    std::error_code failed;
    if (std::filesystem::exists(*target, failed) || percentDecoded(uri) == uri) return *target;
    // A name with a percent sign that was not encoded.
    const auto asWritten = confinedPath(*path_, uri);
    return asWritten && std::filesystem::exists(*asWritten, failed) ? *asWritten : *target;
}

std::filesystem::path Folder::find(const std::string& uri, const std::string& place, const std::string& file) const {
    std::filesystem::path target = Folder::place(uri, place, file);
    std::error_code failed;
    if (std::filesystem::is_regular_file(target, failed)) return target;
    const auto near = sameNameIn(*path_, percentDecoded(uri));
    const bool other = near && std::filesystem::is_regular_file(*path_ / *near, failed);
    refuse(file,
           place + ": " + inQuotes(uri) + " is not there" +
               (other ? ", but " + inQuotes(near->string()) + " lies beside the model" : std::string()),
           other ? "move that file to where the model looks for it, or export as .glb with everything inside"
                 : kKeepBeside);
}

std::vector<std::byte> Folder::read(const std::string& uri, std::size_t maxBytes, const std::string& place,
                                    const std::string& file) const {
    return readFile(find(uri, place, file), maxBytes, file);
}

Buffers readBuffers(const json& document, const Container& container, const Folder& folder, const std::string& file) {
    Buffers buffers;
    const json& list = listOf(document, "buffers", file);
    buffers.owned.reserve(list.size());
    std::size_t left = kMaxFileBytes;
    for (std::size_t i = 0; i < list.size(); ++i) {
        const std::string place = "buffer " + std::to_string(i);
        const auto length = list[i].is_object() ? list[i].find("byteLength") : list[i].end();
        if (length == list[i].end() || !length->is_number_unsigned()) refuse(file, place + ": has no byteLength");
        const auto bytes = bufferBytes(list[i], i, container, folder, left, buffers, file);
        const auto size = length->get<std::uint64_t>();
        if (size > bytes.size())
            refuse(file, place + ": is " + std::to_string(bytes.size()) + " bytes long, not " + std::to_string(size));
        left -= std::min(left, bytes.size());
        buffers.bytes.push_back(bytes.first(static_cast<std::size_t>(size)));
    }
    return buffers;
}

std::span<const std::byte> viewBytes(const tinygltf::Model& structure, const Buffers& buffers, int view,
                                     const std::string& place, const std::string& file) {
    if (view < 0 || static_cast<std::size_t>(view) >= structure.bufferViews.size())
        refuse(file, place + ": there is no buffer view " + std::to_string(view));
    const tinygltf::BufferView& range = structure.bufferViews[static_cast<std::size_t>(view)];
    if (range.buffer < 0 || static_cast<std::size_t>(range.buffer) >= buffers.bytes.size())
        refuse(file, place + ": there is no buffer " + std::to_string(range.buffer));
    const std::span<const std::byte> buffer = buffers.bytes[static_cast<std::size_t>(range.buffer)];
    if (range.byteOffset > buffer.size() || range.byteLength > buffer.size() - range.byteOffset)
        refuse(file, place + ": buffer view " + std::to_string(view) + " reaches beyond its buffer");
    return buffer.subspan(range.byteOffset, range.byteLength);
}

namespace {

/// The bytes that a uri of a picture leads to; none, and a warning, where there is nothing to be read.
std::vector<std::byte> pictureBytes(const std::string& uri, const Folder& folder, const std::string& place,
                                    const std::string& file, std::vector<std::string>& warnings) {
    const auto passOver = [&](const std::string& why) -> std::vector<std::byte> {
        warnings.push_back("A picture is not read, " + why + "; the model is read without it.");
        return {};
    };
    if (isData(uri)) {
        std::vector<std::byte> bytes = uriBytes(uri, kMaxImageBytes, folder, place, file);
        return bytes.empty() ? passOver(place + ": it is empty") : bytes;
    }
    try {
        std::vector<std::byte> bytes = folder.read(uri, kMaxImageBytes, place, file);
        return bytes.empty() ? passOver(place + ": " + inQuotes(uri) + " is empty") : bytes;
    } catch (const DataError& error) {
        return passOver(error.why());
    }
}

} // namespace

std::vector<Model::Image> readImages(const json& document, const tinygltf::Model& structure, const Buffers& buffers,
                                     const Folder& folder, MemoryBudget& budget, const std::string& file,
                                     std::vector<std::string>& warnings) {
    std::vector<Model::Image> images;
    for (const json& source : listOf(document, "images", file)) {
        const std::string place = "image " + std::to_string(images.size());
        if (!source.is_object() || source.contains("uri") == source.contains("bufferView"))
            refuse(file, place + ": needs either a uri or a buffer view");
        Model::Image image{stringMember(source, "name"), stringMember(source, "mimeType"), {}};
        if (source.contains("uri")) {
            const std::string uri = stringMember(source, "uri");
            image.bytes = pictureBytes(uri, folder, place, file, warnings);
            budget.charge(image.bytes.size(), 1, place);
            if (image.mimeType.empty() && isData(uri)) image.mimeType = splitDataUri(uri, place, file).mimeType;
        } else {
            const json& view = source["bufferView"];
            const bool whole = view.is_number_unsigned() && view.get<std::uint64_t>() < kMaxElements;
            const auto bytes = viewBytes(structure, buffers, whole ? view.get<int>() : -1, place, file);
            if (bytes.size() > kMaxImageBytes) refuse(file, place + ": is too large", "shrink the picture");
            budget.charge(bytes.size(), 1, place);
            image.bytes.assign(bytes.begin(), bytes.end());
            if (image.bytes.empty()) refuse(file, place + ": is empty");
        }
        if (image.mimeType.empty()) image.mimeType = sniffedMimeType(image.bytes);
        images.push_back(std::move(image));
    }
    return images;
}

} // namespace lumorph::gltf
