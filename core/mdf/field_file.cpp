#include "core/mdf/field_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>

#include <xxhash.h>
#include <zstd.h>

#include "core/base/error.h"
#include "core/base/units.h"

namespace lumorph {

static_assert(std::endian::native == std::endian::little, "the file is little-endian and is copied as it is");

namespace {

constexpr std::array<char, 16> kMagic{'L', 'U', 'M', 'O',  'R',  'P',  'H',  '\0',
                                      'M', 'D', 'F', '\0', '\0', '\0', '\0', '\0'};
constexpr std::uint32_t kVersion = 1;
constexpr std::size_t kMaxName = 4096;
constexpr std::size_t kMaxActuators = 65'000;
constexpr std::size_t kMaxRigBytes = std::size_t{256} << 20U;
/// Of all blocks together: sixteen bytes for each voxel of the largest frame, where a field has two or three.
constexpr std::uint64_t kMaxContentBytes = std::uint64_t{1} << 30U;

enum class Block : std::uint32_t { header = 1, rig = 2, body = 3, background = 4, actuator = 5 };

struct BlockHeader {
    std::uint32_t kind = 0;
    std::uint32_t reserved = 0;
    std::uint64_t size = 0;
    std::uint64_t storedSize = 0;
    std::uint64_t checksum = 0;
};

class Writer {
public:
    template <typename T> void put(const T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        const auto* first = reinterpret_cast<const std::byte*>(&value);
        bytes_.insert(bytes_.end(), first, first + sizeof(T));
    }
    template <typename T> void putAll(std::span<const T> values) {
        const auto bytes = std::as_bytes(values);
        bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    }
    void putText(const std::string& text) {
        put(static_cast<std::uint32_t>(text.size()));
        putAll(std::span<const char>(text));
    }
    [[nodiscard]] std::vector<std::byte> take() { return std::move(bytes_); }

private:
    std::vector<std::byte> bytes_;
};

/// Takes values out of untrusted bytes and refuses to run past their end.
class Reader {
public:
    Reader(std::span<const std::byte> bytes, std::string name, std::string place)
        : bytes_(bytes), name_(std::move(name)), place_(std::move(place)) {}

    template <typename T> T get() {
        T value;
        std::memcpy(&value, take(sizeof(T)).data(), sizeof(T));
        return value;
    }
    template <typename T> std::vector<T> getAll(std::uint64_t count) {
        if (count > bytes_.size() / sizeof(T)) fail("it ends too early");
        const auto from = take(static_cast<std::size_t>(count) * sizeof(T));
        std::vector<T> values(static_cast<std::size_t>(count));
        if (!values.empty()) std::memcpy(values.data(), from.data(), from.size());
        return values;
    }
    std::string getText() {
        const auto size = get<std::uint32_t>();
        if (size > kMaxName) fail("a name is too long");
        const std::vector<char> text = getAll<char>(size);
        return {text.begin(), text.end()};
    }
    std::span<const std::byte> take(std::size_t size) {
        if (size > bytes_.size()) fail("it ends too early");
        const auto taken = bytes_.first(size);
        bytes_ = bytes_.subspan(size);
        return taken;
    }
    [[nodiscard]] bool atEnd() const { return bytes_.empty(); }
    void expectEnd() const {
        if (!bytes_.empty()) fail("it is longer than its content");
    }
    void expect(bool condition, const char* why) const {
        if (!condition) fail(why);
    }
    [[noreturn]] void fail(const std::string& why) const {
        throw DataError(name_, place_ + ": " + why, "build the field again with 'lumorph mdf build'");
    }

private:
    std::span<const std::byte> bytes_;
    std::string name_;
    std::string place_;
};

void putBlock(Writer& file, Block kind, std::vector<std::byte> content) {
    std::vector<std::byte> packed(ZSTD_compressBound(content.size()));
    // Level 9 costs about a second for the largest fields; higher levels gain little on ramps.
    const std::size_t size = ZSTD_compress(packed.data(), packed.size(), content.data(), content.size(), 9);
    if (ZSTD_isError(size)) throw DeviceError("mdf file", ZSTD_getErrorName(size), "free some memory and try again");
    packed.resize(size);
    file.put(BlockHeader{static_cast<std::uint32_t>(kind), 0, content.size(), packed.size(),
                         XXH64(packed.data(), packed.size(), 0)});
    file.putAll(std::span<const std::byte>(packed));
}

/// Unpacks piece by piece, so that memory follows what is really there and not what a length claims.
/// Gives up (and returns less than `limit`) on damaged data; stops at `limit`.
std::vector<std::byte> unpacked(std::span<const std::byte> packed, std::size_t limit) {
    const std::unique_ptr<ZSTD_DStream, decltype(&ZSTD_freeDStream)> stream(ZSTD_createDStream(), &ZSTD_freeDStream);
    std::vector<std::byte> content;
    ZSTD_inBuffer in{packed.data(), packed.size(), 0};
    std::size_t remaining = 1;
    while (remaining != 0 && content.size() <= limit) {
        const std::size_t start = content.size();
        content.resize(start + ZSTD_DStreamOutSize());
        ZSTD_outBuffer out{content.data() + start, content.size() - start, 0};
        remaining = ZSTD_decompressStream(stream.get(), &out, &in);
        content.resize(start + out.pos);
        if (ZSTD_isError(remaining) || (out.pos == 0 && in.pos == in.size)) return {};
    }
    return content;
}

std::string inMebibytes(std::uint64_t bytes) { return std::to_string(bytes >> 20U) + " MiB"; }

/// Refuses a file by what the heads of its blocks promise, before any of them is unpacked.
void checkPromises(Reader file) {
    std::uint64_t promised = 0;
    for (std::size_t block = 1; !file.atEnd(); ++block) {
        const auto header = file.get<BlockHeader>();
        const std::uint64_t left = kMaxContentBytes - promised;
        if (header.size > left)
            file.fail("block " + std::to_string(block) + " brings what the file promises to unpack to more than " +
                      inMebibytes(kMaxContentBytes) + ", the limit");
        promised += header.size;
        file.expect(header.storedSize <= std::numeric_limits<std::size_t>::max(), "a block is too large");
        file.take(static_cast<std::size_t>(header.storedSize));
    }
}

/// The next block's content, which must be of this kind and unpack to at most `limit` bytes.
std::vector<std::byte> getBlock(Reader& file, Block kind, std::uint64_t limit) {
    const auto header = file.get<BlockHeader>();
    file.expect(header.kind == static_cast<std::uint32_t>(kind), "a block is missing or out of order");
    file.expect(header.size <= limit, "a block claims to be larger than its content can be");
    file.expect(header.storedSize <= std::numeric_limits<std::size_t>::max(), "a block is too large");
    const auto packed = file.take(static_cast<std::size_t>(header.storedSize));
    file.expect(XXH64(packed.data(), packed.size(), 0) == header.checksum, "a checksum is wrong: the file is damaged");
    std::vector<std::byte> content = unpacked(packed, static_cast<std::size_t>(header.size));
    file.expect(content.size() == header.size, "a block cannot be unpacked");
    return content;
}

std::vector<std::byte> headerContent(const Field& field) {
    Writer w;
    w.put(field.frame.origin);
    w.put(field.frame.voxelSize);
    w.put(field.frame.dimensions);
    w.put(static_cast<std::int32_t>(field.levels));
    w.put(field.restSurface);
    w.put(field.seed);
    w.put(field.samples);
    w.put(static_cast<std::uint32_t>(field.exhaustive ? 1 : 0));
    w.put(field.report.rampErrorMean);
    w.put(field.report.rampErrorMax);
    w.put(field.report.changedVoxels);
    w.put(field.report.monotonicityViolations);
    w.putText(field.rigName);
    w.put(static_cast<std::uint32_t>(field.actuators.size()));
    for (const ActuatorField& actuator : field.actuators) w.putText(actuator.name);
    return w.take();
}

void readHeader(Reader r, Field& field) {
    field.frame.origin = r.get<glm::vec3>();
    field.frame.voxelSize = r.get<double>();
    field.frame.dimensions = r.get<glm::ivec3>();
    field.levels = r.get<std::int32_t>();
    field.restSurface = r.get<float>();
    field.seed = r.get<std::uint64_t>();
    field.samples = r.get<std::uint32_t>();
    field.exhaustive = r.get<std::uint32_t>() != 0;
    field.report.rampErrorMean = r.get<double>();
    field.report.rampErrorMax = r.get<double>();
    field.report.changedVoxels = r.get<std::uint64_t>();
    field.report.monotonicityViolations = r.get<std::uint64_t>();
    field.rigName = r.getText();
    const auto actuators = r.get<std::uint32_t>();
    r.expect(actuators <= kMaxActuators, "it names too many actuators");
    for (std::uint32_t i = 0; i < actuators; ++i) field.actuators.push_back({r.getText(), {}, {}});
    r.expectEnd();

    const glm::ivec3& d = field.frame.dimensions;
    r.expect(d.x > 0 && d.y > 0 && d.z > 0, "the frame is empty");
    r.expect(fitsLimits(d) && d.y <= 65535, "the frame is too large");
    r.expect(std::isfinite(field.frame.voxelSize) && field.frame.voxelSize > 0.0, "the voxel side is not positive");
    r.expect(std::isfinite(field.frame.origin.x + field.frame.origin.y + field.frame.origin.z),
             "the origin is not finite");
    r.expect(std::isfinite(field.restSurface), "the rest surface is not finite");
    r.expect(field.levels >= 2 && field.levels <= kMaxLevels, "the level count is out of range");
    r.expect(std::isfinite(field.report.rampErrorMean) && std::isfinite(field.report.rampErrorMax),
             "the report is not finite");
}

void readBody(Reader r, Field& field) {
    field.body = BitColumns(field.frame.dimensions);
    const auto words = r.getAll<std::uint64_t>(field.body.words().size());
    r.expectEnd();
    std::copy(words.begin(), words.end(), field.body.words().begin());
    const int tail = field.frame.dimensions.y % 64;
    if (tail == 0) return;
    for (std::size_t i = 0; i < words.size(); ++i)
        if ((i + 1) % static_cast<std::size_t>(field.body.wordsPerColumn()) == 0)
            r.expect((words[i] >> tail) == 0, "the body has voxels outside the frame");
}

std::vector<std::byte> actuatorContent(const ActuatorField& actuator) {
    Writer w;
    w.put(static_cast<std::uint64_t>(actuator.runs.size()));
    w.put(static_cast<std::uint64_t>(actuator.ramps.size()));
    for (const ActuatorField::Run& run : actuator.runs) w.put(run);
    // Each of the four numbers in a row of its own: neighbouring voxels are alike, which packs well.
    for (const auto part : {&Ramp::v0, &Ramp::v1, &Ramp::base, &Ramp::top})
        for (const Ramp& ramp : actuator.ramps) w.put(ramp.*part);
    return w.take();
}

bool insideBody(const Field& field, std::uint32_t column, int y) {
    const auto width = static_cast<std::uint32_t>(field.frame.dimensions.x);
    return field.body.test(static_cast<int>(column % width), y, static_cast<int>(column / width));
}

void readBackground(Reader r, Field& field) {
    field.background = r.getAll<std::uint8_t>(field.frame.voxelCount());
    r.expectEnd();
    const auto height = static_cast<std::size_t>(field.frame.dimensions.y);
    for (std::size_t v = 0; v < field.background.size(); ++v)
        r.expect(field.background[v] == 0 ||
                     !insideBody(field, static_cast<std::uint32_t>(v / height), static_cast<int>(v % height)),
                 "it covers voxels inside the body");
}

void readActuator(Reader r, const Field& field, ActuatorField& actuator) {
    const auto runs = r.get<std::uint64_t>();
    const auto ramps = r.get<std::uint64_t>();
    actuator.runs = r.getAll<ActuatorField::Run>(runs);
    r.expect(ramps <= field.frame.voxelCount(), "it has more ramps than the frame has voxels");
    actuator.ramps.resize(static_cast<std::size_t>(ramps));
    for (const auto part : {&Ramp::v0, &Ramp::v1, &Ramp::base, &Ramp::top}) {
        const auto values = r.getAll<std::uint8_t>(ramps);
        for (std::size_t i = 0; i < values.size(); ++i) actuator.ramps[i].*part = values[i];
    }
    r.expectEnd();

    std::uint64_t next = 0;
    std::int64_t lastColumn = -1;
    for (const ActuatorField::Run& run : actuator.runs) {
        r.expect(run.column < field.body.columnCount() && static_cast<std::int64_t>(run.column) > lastColumn,
                 "a column is out of order");
        r.expect(run.count > 0 && run.firstY + run.count <= field.frame.dimensions.y, "a run leaves the frame");
        r.expect(run.firstRamp == next, "a run does not follow the one before it");
        lastColumn = run.column;
        next += run.count;
        for (int i = 0; i < run.count && next <= ramps; ++i) {
            const Ramp& ramp = actuator.ramps[run.firstRamp + static_cast<std::size_t>(i)];
            if (ramp.v0 == kUnchanged) continue;
            r.expect(ramp.v0 >= 1 && ramp.v0 <= ramp.v1 && ramp.v1 < field.levels && ramp.base < ramp.top,
                     "a ramp is out of range");
            r.expect(!insideBody(field, run.column, run.firstY + i), "a ramp lies inside the body");
        }
    }
    r.expect(next == ramps, "its runs and ramps do not agree");
}

} // namespace

std::vector<std::byte> writeField(const Field& field) {
    Writer file;
    file.put(kMagic);
    file.put(kVersion);
    file.put(std::uint32_t{0});
    putBlock(file, Block::header, headerContent(field));
    putBlock(file, Block::rig, field.rigGlb);
    Writer body;
    body.putAll(field.body.words());
    putBlock(file, Block::body, body.take());
    Writer background;
    background.putAll(std::span<const std::uint8_t>(field.background));
    putBlock(file, Block::background, background.take());
    std::uint64_t content = 0;
    for (const ActuatorField& actuator : field.actuators) {
        std::vector<std::byte> part = actuatorContent(actuator);
        content += part.size();
        if (content > kMaxContentBytes / 2)
            throw InvalidInput("field of '" + field.rigName + "'",
                               "its ramps take more than " + inMebibytes(kMaxContentBytes / 2) +
                                   ", the limit of a file",
                               "build it with larger voxels");
        putBlock(file, Block::actuator, std::move(part));
    }
    return file.take();
}

Field parseField(std::span<const std::byte> bytes, const std::string& name) {
    Reader file(bytes, name, "file");
    if (bytes.size() < kMagic.size() || std::memcmp(bytes.data(), kMagic.data(), kMagic.size()) != 0)
        throw DataError(name, "it is not a .mdf file", "give a file made by 'lumorph mdf build'");
    file.take(kMagic.size());
    const auto version = file.get<std::uint32_t>();
    if (version != kVersion)
        throw DataError(name,
                        "its format version is " + std::to_string(version) + ", this program reads version " +
                            std::to_string(kVersion),
                        "build the field again with 'lumorph mdf build'");
    file.get<std::uint32_t>();
    checkPromises(file);

    Field field;
    const auto header = getBlock(file, Block::header, 256 + (kMaxActuators + 1) * (kMaxName + 4));
    readHeader(Reader(header, name, "header"), field);
    field.rigGlb = getBlock(file, Block::rig, kMaxRigBytes);
    const std::uint64_t voxels = field.frame.voxelCount();
    const auto words = (static_cast<std::uint64_t>(field.frame.dimensions.y) + 63) / 64;
    const std::uint64_t columns = voxels / static_cast<std::uint64_t>(field.frame.dimensions.y);
    const auto body = getBlock(file, Block::body, 8 * words * columns);
    readBody(Reader(body, name, "body"), field);
    const auto background = getBlock(file, Block::background, voxels);
    readBackground(Reader(background, name, "background"), field);
    for (std::size_t i = 0; i < field.actuators.size(); ++i) {
        const std::uint64_t limit = 16 + sizeof(ActuatorField::Run) * field.body.columnCount() + sizeof(Ramp) * voxels;
        const auto content = getBlock(file, Block::actuator, limit);
        readActuator(Reader(content, name, "actuator " + std::to_string(i)), field, field.actuators[i]);
    }
    file.expectEnd();
    return field;
}

} // namespace lumorph
