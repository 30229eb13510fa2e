#include "core/voxels/nrrd.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <sstream>
#include <string_view>

#include "core/base/error.h"
#include "core/base/text.h"

namespace lumorph {

namespace {

std::string shortest(double value) {
    std::array<char, 32> text{};
    const auto result = std::to_chars(text.data(), text.data() + text.size(), value);
    return {text.data(), result.ptr};
}

std::string_view trimmed(std::string_view text) {
    const auto isSpace = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
    while (!text.empty() && isSpace(text.front())) text.remove_prefix(1);
    while (!text.empty() && isSpace(text.back())) text.remove_suffix(1);
    return text;
}

/// The header's `key: value` lines and where the data begins.
class Header {
public:
    Header(std::string_view file, const std::string& name) : name_(name) {
        if (!file.starts_with("NRRD000")) fail("line 1", "it does not begin with NRRD000n, so it is no NRRD file");
        std::size_t position = 0;
        for (int line = 1;; ++line) {
            const std::size_t end = file.find('\n', position);
            if (end == std::string_view::npos)
                fail("line " + std::to_string(line), "the header has no end (an empty line)");
            const std::string_view text = trimmed(file.substr(position, end - position));
            position = end + 1;
            if (text.empty()) break;
            if (line == 1 || text.front() == '#') continue;
            const std::size_t colon = text.find(':');
            if (colon == std::string_view::npos) fail("line " + std::to_string(line), "it is not 'field: value'");
            if (colon + 1 < text.size() && text[colon + 1] == '=') continue; // a key/value pair of the user's
            fields_[std::string(trimmed(text.substr(0, colon)))] = std::string(trimmed(text.substr(colon + 1)));
        }
        dataStart_ = position;
    }

    [[nodiscard]] std::size_t dataStart() const { return dataStart_; }
    [[nodiscard]] const std::string* find(const std::string& field) const {
        const auto it = fields_.find(field);
        return it == fields_.end() ? nullptr : &it->second;
    }
    [[nodiscard]] const std::string& require(const std::string& field) const {
        const std::string* value = find(field);
        if (value == nullptr) fail("header", "the field '" + field + "' is missing");
        return *value;
    }
    [[noreturn]] void fail(const std::string& place, const std::string& why) const {
        throw DataError(name_, place + ": " + why,
                        "save it as a three-dimensional uint8 NRRD with raw encoding and an attached header");
    }
    /// All numbers in a field's value, whatever stands between them.
    [[nodiscard]] std::vector<double> numbers(const std::string& field) const {
        std::vector<double> result;
        std::string text = require(field);
        std::replace_if(
            text.begin(), text.end(), [](char c) { return c == '(' || c == ')' || c == ','; }, ' ');
        std::istringstream words(text);
        for (std::string word; words >> word;) {
            double value = 0.0;
            const auto parsed = std::from_chars(word.data(), word.data() + word.size(), value);
            if (parsed.ec != std::errc() || parsed.ptr != word.data() + word.size() || !std::isfinite(value))
                fail("field '" + field + "'", inQuotes(word) + " is not a number");
            result.push_back(value);
        }
        return result;
    }

private:
    std::string name_;
    std::map<std::string, std::string> fields_;
    std::size_t dataStart_ = 0;
};

glm::ivec3 readSizes(const Header& header) {
    const std::vector<double> sizes = header.numbers("sizes");
    if (header.numbers("dimension") != std::vector<double>{3.0} || sizes.size() != 3)
        header.fail("field 'sizes'", "the grid is not three-dimensional");
    double product = 1.0;
    for (const double size : sizes) {
        if (!(size >= 1.0) || size != std::floor(size))
            header.fail("field 'sizes'", "a size is not a whole number above 0");
        product *= size;
    }
    if (product > static_cast<double>(kMaxVoxels) || sizes[0] * sizes[2] > static_cast<double>(kMaxColumns))
        header.fail("field 'sizes'", "the grid has more than " + std::to_string(kMaxVoxels) + " voxels or " +
                                         std::to_string(kMaxColumns) + " columns");
    return {static_cast<int>(sizes[0]), static_cast<int>(sizes[1]), static_cast<int>(sizes[2])};
}

double readVoxelSize(const Header& header) {
    std::vector<double> sides;
    if (header.find("space directions") != nullptr) {
        const std::vector<double> m = header.numbers("space directions");
        if (m.size() != 9) header.fail("field 'space directions'", "it does not hold three vectors of three numbers");
        for (const std::size_t i : {1U, 2U, 3U, 5U, 6U, 7U})
            if (m[i] != 0.0) header.fail("field 'space directions'", "the axes are turned, which is not supported");
        sides = {m[0], m[4], m[8]};
    } else if (header.find("spacings") != nullptr) {
        sides = header.numbers("spacings");
    } else {
        return 1.0;
    }
    if (sides.size() != 3 || !(sides[0] > 0.0) || std::abs(sides[1] - sides[0]) > 1e-6 * sides[0] ||
        std::abs(sides[2] - sides[0]) > 1e-6 * sides[0])
        header.fail("voxel side", "the voxels are not cubes of a positive side");
    return sides[0];
}

} // namespace

std::vector<std::byte> writeNrrd(const ByteGrid& grid, const std::string& content) {
    const VoxelFrame& f = grid.frame;
    const std::string side = shortest(f.voxelSize);
    const glm::dvec3 first = f.centre(0, 0, 0);
    const std::string header = "NRRD0004\ntype: uint8\ndimension: 3\ncontent: " + content +
                               "\nsizes: " + std::to_string(f.dimensions.x) + " " + std::to_string(f.dimensions.y) +
                               " " + std::to_string(f.dimensions.z) + "\nspace dimension: 3\nspace directions: (" +
                               side + ",0,0) (0," + side + ",0) (0,0," + side + ")\nspace origin: (" +
                               shortest(first.x) + "," + shortest(first.y) + "," + shortest(first.z) +
                               ")\nspace units: \"m\" \"m\" \"m\"\nencoding: raw\n\n";
    std::vector<std::byte> file(header.size() + grid.values.size());
    std::memcpy(file.data(), header.data(), header.size());
    std::copy(reinterpret_cast<const std::byte*>(grid.values.data()),
              reinterpret_cast<const std::byte*>(grid.values.data()) + grid.values.size(),
              file.begin() + static_cast<std::ptrdiff_t>(header.size()));
    return file;
}

ByteGrid parseNrrd(std::span<const std::byte> bytes, const std::string& name) {
    const std::string_view file(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const Header header(file, name);
    if (header.find("data file") != nullptr || header.find("datafile") != nullptr)
        header.fail("field 'data file'", "the data lies in another file");
    const std::string& type = header.require("type");
    if (type != "uint8" && type != "unsigned char" && type != "uchar" && type != "uint8_t")
        header.fail("field 'type'", inQuotes(type) + " is not uint8");
    if (header.require("encoding") != "raw")
        header.fail("field 'encoding'", inQuotes(header.require("encoding")) + " is not raw");

    ByteGrid grid;
    grid.frame.dimensions = readSizes(header);
    grid.frame.voxelSize = readVoxelSize(header);
    glm::dvec3 first(0.0);
    if (header.find("space origin") != nullptr) {
        const std::vector<double> origin = header.numbers("space origin");
        if (origin.size() != 3) header.fail("field 'space origin'", "it does not hold three numbers");
        first = {origin[0], origin[1], origin[2]};
    }
    grid.frame.origin = glm::vec3(first - 0.5 * grid.frame.voxelSize);
    const std::size_t count = grid.frame.voxelCount();
    if (bytes.size() - header.dataStart() != count)
        header.fail("data", "it holds " + std::to_string(bytes.size() - header.dataStart()) +
                                " bytes where the sizes ask for " + std::to_string(count));
    grid.values.resize(count);
    std::memcpy(grid.values.data(), bytes.data() + header.dataStart(), count);
    return grid;
}

ByteGrid bytesOf(const VoxelFrame& frame, const BitColumns& bits) {
    ByteGrid grid{frame, {}};
    grid.values.reserve(frame.voxelCount());
    for (int z = 0; z < frame.dimensions.z; ++z)
        for (int y = 0; y < frame.dimensions.y; ++y)
            for (int x = 0; x < frame.dimensions.x; ++x) grid.values.push_back(bits.test(x, y, z) ? 1 : 0);
    return grid;
}

BitColumns bitsOf(const ByteGrid& grid) {
    BitColumns bits(grid.frame.dimensions);
    std::size_t i = 0;
    for (int z = 0; z < grid.frame.dimensions.z; ++z)
        for (int y = 0; y < grid.frame.dimensions.y; ++y)
            for (int x = 0; x < grid.frame.dimensions.x; ++x)
                if (grid.values[i++] != 0) bits.set(x, y, z);
    return bits;
}

} // namespace lumorph
