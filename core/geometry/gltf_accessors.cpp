#include "core/geometry/gltf_accessors.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

namespace lumorph::gltf {

namespace {

std::size_t componentBytes(int type) {
    switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
        return 4;
    default:
        return 0;
    }
}

/// Where elements lie; `count` of them are known to be there.
struct Elements {
    const std::byte* first = nullptr;
    std::size_t stride = 0;
    std::size_t count = 0;
    int components = 1;
    bool normalized = false;
};

template <typename Stored, typename Out> Out converted(Stored value, bool normalized) {
    if constexpr (std::is_same_v<Out, float> && std::is_integral_v<Stored> && sizeof(Stored) < 4) {
        if (normalized) {
            const float scaled = static_cast<float>(value) / static_cast<float>(std::numeric_limits<Stored>::max());
            return std::max(scaled, -1.0F);
        }
    }
    return static_cast<Out>(value);
}

template <typename Stored, typename Out> void copy(const Elements& from, Out* out) {
    for (std::size_t i = 0; i < from.count; ++i)
        for (int c = 0; c < from.components; ++c) {
            Stored value;
            std::memcpy(&value, from.first + i * from.stride + static_cast<std::size_t>(c) * sizeof(Stored),
                        sizeof(Stored));
            *out++ = converted<Stored, Out>(value, from.normalized);
        }
}

/// Copies in the type the file holds; false where that type cannot become an `Out`.
template <typename Out> bool copyAs(int type, const Elements& from, Out* out) {
    constexpr bool real = std::is_same_v<Out, float>;
    switch (type) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        copy<std::uint8_t>(from, out);
        return true;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        copy<std::uint16_t>(from, out);
        return true;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        copy<std::uint32_t>(from, out);
        return true;
    default:
        break;
    }
    if constexpr (real) {
        switch (type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            copy<std::int8_t>(from, out);
            return true;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            copy<std::int16_t>(from, out);
            return true;
        case TINYGLTF_COMPONENT_TYPE_FLOAT:
            copy<float>(from, out);
            return true;
        default:
            break;
        }
    }
    return false;
}

/// Checks that `count` elements from `offset` lie within `bytes`.
Elements located(std::span<const std::byte> bytes, std::size_t offset, std::size_t stride, std::size_t elementBytes,
                 std::size_t count, const std::string& place, const std::string& file) {
    if (stride == 0) stride = elementBytes;
    if (stride < elementBytes) refuse(file, place + ": its elements overlap");
    const bool fits = offset <= bytes.size() && elementBytes <= bytes.size() - offset &&
                      count - 1 <= (bytes.size() - offset - elementBytes) / stride;
    if (!fits) refuse(file, place + ": reaches beyond its buffer view");
    return {bytes.data() + offset, stride, count, 1, false};
}

std::string named(int accessor, const std::string& place) {
    return place + " (accessor " + std::to_string(accessor) + ")";
}

} // namespace

int Accessors::components(int accessor, const std::string& place) const {
    if (accessor < 0 || static_cast<std::size_t>(accessor) >= structure_.accessors.size())
        refuse(file_, place + ": there is no accessor " + std::to_string(accessor));
    switch (structure_.accessors[static_cast<std::size_t>(accessor)].type) {
    case TINYGLTF_TYPE_SCALAR:
        return 1;
    case TINYGLTF_TYPE_VEC2:
        return 2;
    case TINYGLTF_TYPE_VEC3:
        return 3;
    case TINYGLTF_TYPE_VEC4:
        return 4;
    case TINYGLTF_TYPE_MAT4:
        return 16;
    default:
        refuse(file_, named(accessor, place) + ": is of a matrix type that has no place here");
    }
}

std::size_t Accessors::count(int accessor, const std::string& place) const {
    (void)components(accessor, place);
    const std::size_t count = structure_.accessors[static_cast<std::size_t>(accessor)].count;
    if (count == 0) refuse(file_, named(accessor, place) + ": is empty");
    return count;
}

std::size_t Accessors::open(int accessor, int expected, const std::string& place, Some some) const {
    if (const int found = components(accessor, place); found != expected)
        refuse(file_, named(accessor, place) + ": has " + std::to_string(found) + " components, not " +
                          std::to_string(expected));
    const std::size_t all = count(accessor, place);
    const std::size_t wanted = some.empty() ? all : some.size();
    budget_.charge(wanted, static_cast<std::size_t>(expected) * sizeof(float), named(accessor, place));
    return wanted;
}

template <typename Out>
void Accessors::copySparse(int accessor, int components, Out* out, const std::string& place) const {
    const tinygltf::Accessor& source = structure_.accessors[static_cast<std::size_t>(accessor)];
    const auto& sparse = source.sparse;
    if (sparse.count < 1 || static_cast<std::size_t>(sparse.count) > source.count || sparse.indices.byteOffset < 0 ||
        sparse.values.byteOffset < 0)
        refuse(file_, place + ": its sparse part does not fit");
    const auto count = static_cast<std::size_t>(sparse.count);
    const std::size_t indexBytes = componentBytes(sparse.indices.componentType);
    const std::size_t bytes = componentBytes(source.componentType) * static_cast<std::size_t>(components);
    const std::string indexPlace = place + " sparse indices";
    budget_.charge(count, sizeof(std::uint32_t) + bytes * 4, place);
    if (indexBytes == 0) refuse(file_, indexPlace + ": are of an unknown type");
    const Elements indices =
        located(viewBytes(structure_, buffers_, sparse.indices.bufferView, indexPlace, file_),
                static_cast<std::size_t>(sparse.indices.byteOffset), 0, indexBytes, count, indexPlace, file_);
    std::vector<std::uint32_t> targets(count);
    if (!copyAs(sparse.indices.componentType, indices, targets.data()))
        refuse(file_, indexPlace + ": are not unsigned integers");

    const std::string valuePlace = place + " sparse values";
    Elements values = located(viewBytes(structure_, buffers_, sparse.values.bufferView, valuePlace, file_),
                              static_cast<std::size_t>(sparse.values.byteOffset), 0, bytes, count, valuePlace, file_);
    values.components = components;
    values.normalized = source.normalized;
    const auto width = static_cast<std::size_t>(components);
    std::vector<Out> replaced(count * width);
    copyAs(source.componentType, values, replaced.data());
    for (std::size_t i = 0; i < count; ++i) {
        if (targets[i] >= source.count)
            refuse(file_, indexPlace + ": " + std::to_string(targets[i]) + " is out of range");
        std::copy_n(replaced.data() + i * width, width, out + targets[i] * width);
    }
}

template <typename Out>
void Accessors::copyWanted(int accessor, int components, Out* out, const std::string& place, Some some) const {
    const tinygltf::Accessor& source = structure_.accessors[static_cast<std::size_t>(accessor)];
    const std::size_t bytes = componentBytes(source.componentType) * static_cast<std::size_t>(components);
    // Nothing is copied here; it only asks whether the type can be.
    if (bytes == 0 || !copyAs(source.componentType, Elements{}, out))
        refuse(file_, place + ": component type " + std::to_string(source.componentType) + " has no place here");
    const auto width = static_cast<std::size_t>(components);
    if (!some.empty() && source.sparse.isSparse) {
        budget_.charge(source.count, width * sizeof(Out), place);
        std::vector<Out> all(source.count * width);
        copyWanted(accessor, components, all.data(), place, {});
        for (const std::uint32_t i : some) out = std::copy_n(all.data() + i * width, width, out);
        return;
    }
    // Without a buffer view, all values are zero; the memory was bounded before it was given.
    if (source.bufferView >= 0) {
        const auto view = viewBytes(structure_, buffers_, source.bufferView, place, file_);
        const std::size_t stride = structure_.bufferViews[static_cast<std::size_t>(source.bufferView)].byteStride;
        Elements elements = located(view, source.byteOffset, stride, bytes, source.count, place, file_);
        elements.components = components;
        elements.normalized = source.normalized;
        if (some.empty()) copyAs(source.componentType, elements, out);
        elements.count = 1;
        const std::byte* const first = elements.first;
        for (std::size_t k = 0; k < some.size(); ++k) {
            elements.first = first + some[k] * elements.stride;
            copyAs(source.componentType, elements, out + k * width);
        }
    }
    if (source.sparse.isSparse) copySparse(accessor, components, out, place);
}

void Accessors::fill(int accessor, int components, float* out, const std::string& place, Some some) const {
    const std::string where = named(accessor, place);
    copyWanted(accessor, components, out, where, some);
    const std::size_t wanted =
        some.empty() ? structure_.accessors[static_cast<std::size_t>(accessor)].count : some.size();
    const float* end = out + wanted * static_cast<std::size_t>(components);
    const float* bad =
        std::find_if(static_cast<const float*>(out), end, [](float value) { return !std::isfinite(value); });
    if (bad != end)
        refuse(file_,
               where + ": element " +
                   std::to_string(some.empty() ? (bad - out) / components
                                               : some[static_cast<std::size_t>((bad - out) / components)]) +
                   " is not a finite number",
               "remove the faulty vertices or keys in the modelling program and export again");
}

std::vector<float> Accessors::floats(int accessor, int components, const std::string& place, Some some) const {
    std::vector<float> out(open(accessor, components, place, some) * static_cast<std::size_t>(components));
    fill(accessor, components, out.data(), place, some);
    return out;
}

std::vector<std::uint32_t> Accessors::integers(int accessor, int components, const std::string& place,
                                               Some some) const {
    std::vector<std::uint32_t> out(open(accessor, components, place, some) * static_cast<std::size_t>(components));
    copyWanted(accessor, components, out.data(), named(accessor, place), some);
    return out;
}

} // namespace lumorph::gltf
