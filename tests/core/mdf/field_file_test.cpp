#include "core/mdf/field_file.h"

#include <algorithm>
#include <cstring>
#include <random>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/mdf/builder.h"
#include "tests/support/small_rigs.h"

namespace lumorph {
namespace {

Field smallField() {
    BuildOptions options;
    options.resolution = 10;
    options.levels = 7;
    options.samples = 30;
    return buildField(test::cushionRig(), options);
}

// R13
TEST(FieldFile, ComesBackAsItWas) {
    const Field field = smallField();
    ASSERT_GT(field.report.changedVoxels, 500U);
    const Field read = parseField(writeField(field), "cushion.mdf");
    EXPECT_EQ(read, field);
}

void expectRefused(const std::vector<std::byte>& file, const std::string& what) {
    try {
        (void)parseField(file, "bad.mdf");
        ADD_FAILURE() << what << " was accepted";
    } catch (const DataError& error) {
        EXPECT_EQ(error.subject(), "bad.mdf") << what;
        EXPECT_FALSE(error.remedy().empty()) << what;
    }
}

TEST(FieldFile, TruncatedAnywhereItIsRefused) {
    const std::vector<std::byte> file = writeField(smallField());
    for (std::size_t size = 0; size < file.size(); size += 1 + size / 7)
        expectRefused({file.begin(), file.begin() + static_cast<std::ptrdiff_t>(size)},
                      "cut at " + std::to_string(size));
    std::vector<std::byte> longer = file;
    longer.push_back(std::byte{0});
    expectRefused(longer, "a byte too many");
}

TEST(FieldFile, AnyFlippedByteIsNoticed) {
    const std::vector<std::byte> file = writeField(smallField());
    std::mt19937 random(8);
    for (int round = 0; round < 400; ++round) {
        // The four reserved bytes of headers carry nothing; every other byte counts.
        const std::size_t at = round < 24 ? static_cast<std::size_t>(round) : random() % file.size();
        std::vector<std::byte> changed = file;
        changed[at] ^= std::byte{0x41};
        try {
            EXPECT_EQ(parseField(changed, "bad.mdf"), parseField(file, "good.mdf")) << "byte " << at;
        } catch (const DataError&) {
            // noticed
        }
    }
}

TEST(FieldFile, WrongMagicAndVersionAreNamed) {
    std::vector<std::byte> file = writeField(smallField());
    std::vector<std::byte> magic = file;
    magic[0] = std::byte{'X'};
    expectRefused(magic, "magic");
    file[16] = std::byte{9};
    try {
        (void)parseField(file, "new.mdf");
        FAIL();
    } catch (const DataError& error) {
        EXPECT_NE(error.why().find("version is 9"), std::string::npos);
    }
}

/// A length that claims terabytes must not be believed.
TEST(FieldFile, CoverageInsideTheBodyIsRefused) {
    const auto refuses = [](const Field& field, const std::string& place) {
        try {
            (void)parseField(writeField(field), "bad.mdf");
            ADD_FAILURE() << place << " was accepted";
        } catch (const DataError& error) {
            EXPECT_NE(error.why().find(place), std::string::npos) << error.why();
            EXPECT_NE(error.why().find("inside the body"), std::string::npos) << error.why();
        }
    };
    Field covered = smallField();
    const auto inside = std::find(covered.background.begin(), covered.background.end(), 0);
    const auto voxel = static_cast<std::size_t>(inside - covered.background.begin());
    const auto height = static_cast<std::size_t>(covered.frame.dimensions.y);
    const auto width = static_cast<std::size_t>(covered.frame.dimensions.x);
    covered.body.set(static_cast<int>(voxel / height % width), static_cast<int>(voxel % height),
                     static_cast<int>(voxel / height / width));
    ASSERT_EQ(parseField(writeField(covered), "good.mdf"), covered);
    *inside = 1;
    refuses(covered, "background");

    Field changed = smallField();
    const ActuatorField::Run& run = changed.actuators[0].runs[0];
    std::size_t first = 0;
    while (changed.actuators[0].ramps[run.firstRamp + first].v0 == kUnchanged) ++first;
    const std::size_t y = run.firstY + first;
    changed.body.set(static_cast<int>(run.column % width), static_cast<int>(y), static_cast<int>(run.column / width));
    changed.background[run.column * height + y] = 0;
    refuses(changed, "actuator 0");
}

TEST(FieldFile, HostileLengthsDoNotTakeMemory) {
    const std::vector<std::byte> file = writeField(smallField());
    for (const std::size_t offset : {std::size_t{24 + 8}, std::size_t{24 + 16}}) {
        for (const std::uint64_t value : {std::uint64_t{1} << 30, std::uint64_t{1} << 40, ~std::uint64_t{0}}) {
            std::vector<std::byte> changed = file;
            std::memcpy(&changed[offset], &value, sizeof value);
            expectRefused(changed, "length " + std::to_string(value));
        }
    }
}

/// Where the heads of a file's blocks stand.
std::vector<std::size_t> blockHeads(const std::vector<std::byte>& file) {
    std::vector<std::size_t> heads;
    for (std::size_t at = 24; at < file.size();) {
        heads.push_back(at);
        std::uint64_t stored = 0;
        std::memcpy(&stored, &file[at + 16], sizeof stored);
        at += 32 + stored;
    }
    return heads;
}

// Each block may be as large as the frame allows, and a few megabytes of zstd may hold thousands of them.
TEST(FieldFile, PromisesOfAllBlocksTogetherAreBoundedBeforeAnyIsUnpacked) {
    std::vector<std::byte> file = writeField(smallField());
    const std::vector<std::size_t> heads = blockHeads(file);
    ASSERT_GE(heads.size(), 5U);
    file[heads[0] + 24] ^= std::byte{1}; // its checksum: who unpacks the first block trips over it
    for (std::size_t i = 1; i < heads.size(); ++i) {
        const std::uint64_t promised = std::uint64_t{300} << 20U;
        std::memcpy(&file[heads[i] + 8], &promised, sizeof promised);
    }
    try {
        (void)parseField(file, "bomb.mdf");
        ADD_FAILURE() << "was accepted";
    } catch (const DataError& error) {
        EXPECT_EQ(error.subject(), "bomb.mdf");
        EXPECT_NE(error.why().find("block 5"), std::string::npos) << error.why();
        EXPECT_NE(error.why().find("1024 MiB"), std::string::npos) << error.why();
        EXPECT_FALSE(error.remedy().empty());
    }
}

} // namespace
} // namespace lumorph
