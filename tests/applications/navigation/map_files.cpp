#include "tests/applications/navigation/map_files.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <utility>

namespace lumorph::navigation {
namespace {

struct TiffTag {
    std::uint16_t tag, type;
    std::uint32_t count;
    std::string value;
};

template <typename T> TiffTag tagOf(std::uint16_t tag, std::uint16_t type, const std::vector<T>& values) {
    TiffTag made{tag, type, static_cast<std::uint32_t>(values.size()), {}};
    for (const T value : values) put(made.value, value);
    return made;
}

TiffTag shorts(std::uint16_t tag, const std::vector<std::uint16_t>& values) { return tagOf(tag, 3, values); }
TiffTag longs(std::uint16_t tag, std::uint32_t value) { return tagOf(tag, 4, std::vector{value}); }
TiffTag doubles(std::uint16_t tag, const std::vector<double>& values) { return tagOf(tag, 12, values); }
TiffTag ascii(std::uint16_t tag, std::string text) {
    text.push_back('\0');
    return {tag, 2, static_cast<std::uint32_t>(text.size()), text};
}

std::uint32_t crcOf(const std::string& bytes) {
    std::uint32_t crc = 0xFFFFFFFFU;
    for (const char c : bytes) {
        crc ^= static_cast<std::uint8_t>(c);
        for (int k = 0; k < 8; ++k) crc = (crc >> 1U) ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
    }
    return ~crc;
}

void putBig(std::string& bytes, std::uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8)
        bytes.push_back(static_cast<char>(value >> static_cast<unsigned>(shift)));
}

} // namespace

std::filesystem::path MapFiles::write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
}

std::string Tiff::bytes() const {
    std::string data;
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x)
            for (int band = 0; band < bands; ++band) {
                const double v = value(x, y, band);
                if (sample == Sample::byte) put(data, static_cast<std::uint8_t>(std::lround(v)));
                if (sample == Sample::int16) put(data, static_cast<std::int16_t>(std::lround(v)));
                if (sample == Sample::uint16) put(data, static_cast<std::uint16_t>(std::lround(v)));
                if (sample == Sample::float32) put(data, static_cast<float>(v));
            }
    const auto bits = static_cast<std::uint16_t>(sample == Sample::byte ? 8 : sample == Sample::float32 ? 32 : 16);
    const auto format = static_cast<std::uint16_t>(sample == Sample::int16 ? 2 : sample == Sample::float32 ? 3 : 1);
    const auto many = static_cast<std::size_t>(bands);
    std::vector<TiffTag> tags{longs(256, static_cast<std::uint32_t>(columns)),
                              longs(257, static_cast<std::uint32_t>(rows)),
                              shorts(258, std::vector(many, bits)),
                              shorts(259, {1}),
                              shorts(262, {static_cast<std::uint16_t>(bands == 3 ? 2 : 1)}),
                              longs(273, 0), // below
                              shorts(277, {static_cast<std::uint16_t>(bands)}),
                              longs(278, static_cast<std::uint32_t>(rows)),
                              longs(279, static_cast<std::uint32_t>(data.size())),
                              shorts(339, std::vector(many, format))};
    if (turn == 0.0) {
        tags.push_back(doubles(33550, {step, step, 0.0}));
        tags.push_back(doubles(33922, {0.0, 0.0, 0.0, west, north, 0.0}));
    } else {
        const double c = step * std::cos(turn), s = step * std::sin(turn);
        tags.push_back(doubles(34264, {c, s, 0, west, s, -c, 0, north, 0, 0, 0, 0, 0, 0, 0, 1}));
    }
    const bool degrees = epsg == 4326;
    std::vector<std::uint16_t> keys{1024, 0, 1, static_cast<std::uint16_t>(degrees ? 2 : 1), 1025, 0, 1, 1};
    keys.insert(keys.end(),
                {static_cast<std::uint16_t>(degrees ? 2048 : 3072), 0, 1, static_cast<std::uint16_t>(epsg)});
    if (vertical > 0) keys.insert(keys.end(), {4096, 0, 1, static_cast<std::uint16_t>(vertical)});
    if (verticalUnit > 0) keys.insert(keys.end(), {4099, 0, 1, static_cast<std::uint16_t>(verticalUnit)});
    if (epsg > 0) {
        std::vector<std::uint16_t> directory{1, 1, 0, static_cast<std::uint16_t>(keys.size() / 4)};
        directory.insert(directory.end(), keys.begin(), keys.end());
        tags.push_back(shorts(34735, directory));
    }
    if (!metadata.empty()) tags.push_back(ascii(42112, "<GDALMetadata>" + metadata + "</GDALMetadata>"));
    if (!missing.empty()) tags.push_back(ascii(42113, missing));

    const auto after = static_cast<std::uint32_t>(8 + 2 + 12 * tags.size() + 4);
    std::string beside;
    for (const TiffTag& tag : tags)
        if (tag.value.size() > 4) beside += tag.value + std::string(tag.value.size() % 2, '\0');
    for (TiffTag& tag : tags)
        if (tag.tag == 273) tag = longs(273, after + static_cast<std::uint32_t>(beside.size()));
    std::string all("II*\0", 4);
    put(all, std::uint32_t{8});
    put(all, static_cast<std::uint16_t>(tags.size()));
    std::uint32_t at = after;
    for (const TiffTag& tag : tags) {
        put(all, tag.tag);
        put(all, tag.type);
        put(all, tag.count);
        if (tag.value.size() > 4) {
            put(all, at);
            at += static_cast<std::uint32_t>(tag.value.size() + tag.value.size() % 2);
        } else {
            all += tag.value + std::string(4 - tag.value.size(), '\0');
        }
    }
    put(all, std::uint32_t{0});
    return all + beside + data;
}

std::string Png::bytes() const {
    std::string raw;
    for (int y = 0; y < rows; ++y) {
        raw.push_back('\0');
        for (int x = 0; x < columns; ++x)
            for (int channel = 0; channel < channels; ++channel) {
                const int v = value(x, y, channel);
                if (bits == 16) raw.push_back(static_cast<char>(v >> 8));
                raw.push_back(static_cast<char>(v & 255));
            }
    }
    std::uint32_t a = 1, b = 0;
    for (const char c : raw) {
        a = (a + static_cast<std::uint8_t>(c)) % 65521;
        b = (b + a) % 65521;
    }
    constexpr std::size_t kMost = 65535; // of a stored block
    std::string stream("\x78\x01", 2);
    for (std::size_t from = 0; from < raw.size(); from += kMost) {
        const std::string block = raw.substr(from, kMost);
        stream.push_back(from + kMost >= raw.size() ? '\1' : '\0');
        put(stream, static_cast<std::uint16_t>(block.size()));
        put(stream, static_cast<std::uint16_t>(~block.size()));
        stream += block;
    }
    putBig(stream, b << 16U | a);
    std::string bytes("\x89PNG\r\n\x1a\n", 8);
    const auto chunk = [&](const std::string& name, const std::string& data) {
        putBig(bytes, static_cast<std::uint32_t>(data.size()));
        bytes += name + data;
        putBig(bytes, crcOf(name + data));
    };
    std::string head;
    putBig(head, static_cast<std::uint32_t>(columns));
    putBig(head, static_cast<std::uint32_t>(rows));
    head.push_back(static_cast<char>(bits));
    head.push_back(static_cast<char>(channels == 1 ? 0 : channels == 3 ? 2 : 6));
    head += std::string(3, '\0');
    chunk("IHDR", head);
    chunk("IDAT", stream);
    chunk("IEND", "");
    return bytes;
}

bool tells(const MapReport& report, const std::string& words) {
    return std::ranges::any_of(report.notes,
                               [&](const Words& note) { return note.english.find(words) != std::string::npos; });
}

bool isInGermanToo(const MapReport& report) {
    return std::ranges::none_of(report.notes,
                                [](const Words& note) { return note.german.empty() || note.german == note.english; });
}

std::string all(const MapReport& report) {
    std::string text;
    for (const Words& note : report.notes) text += note.english + "\n";
    return text;
}

Measured measured(const ImportedMap& imported) {
    Measured sum;
    for (const Building& building : imported.map.buildings) {
        const auto& ring = building.outline;
        double area = 0.0;
        for (std::size_t k = 0; k < ring.size(); ++k) {
            const glm::dvec2 &a = ring[k], &b = ring[(k + 1) % ring.size()];
            area += 0.5 * (a.x * b.y - b.x * a.y);
        }
        sum.area += std::abs(area);
        sum.height = std::max(sum.height, building.ridge - building.base);
    }
    return sum;
}

std::optional<std::filesystem::path> mapCase(const std::string& name) {
    const std::filesystem::path file = std::filesystem::path(LUMORPH_SHARED_DIR "/data/cases/maps") / name;
    return std::filesystem::exists(file) ? std::optional(file) : std::nullopt;
}

} // namespace lumorph::navigation
