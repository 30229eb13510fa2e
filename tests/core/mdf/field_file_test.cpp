#include "core/mdf/field_file.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <random>
#include <stdexcept>

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

/// Written with checksums that are right: what is wrong is said by the numbers alone.
TEST(FieldFile, WellFormedButImpossibleFieldsAreRefusedWithTheirPlace) {
    struct Case {
        const char* what;
        const char* place; ///< part of the message
        void (*spoil)(Field& field);
    };
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    static const auto firstRamp = [](Field& field) -> Ramp& {
        for (Ramp& ramp : field.actuators[1].ramps)
            if (ramp.v0 != kUnchanged) return ramp;
        throw std::logic_error("no ramp");
    };
    const Case cases[] = {
        {"a body above the frame", "body",
         [](Field& f) { f.body.words().front() |= std::uint64_t{1} << (f.frame.dimensions.y % 64); }},
        {"a body far above the frame", "body", [](Field& f) { f.body.words().back() |= std::uint64_t{1} << 63; }},
        {"a ramp that ends after the last level", "actuator 1",
         [](Field& f) { firstRamp(f).v1 = static_cast<std::uint8_t>(f.levels); }},
        {"a ramp that begins before its first step", "actuator 1", [](Field& f) { firstRamp(f).v0 = 0; }},
        {"a ramp that ends before it begins", "actuator 1",
         [](Field& f) {
             firstRamp(f) = {3, 2, 0, 255};
         }},
        {"a ramp that does not rise", "actuator 1",
         [](Field& f) {
             firstRamp(f) = {2, 3, 77, 77};
         }},
        {"a ramp that falls", "actuator 1",
         [](Field& f) {
             firstRamp(f) = {2, 3, 78, 77};
         }},
        {"a column that is not there", "actuator 1",
         [](Field& f) { f.actuators[1].runs.back().column = static_cast<std::uint32_t>(f.body.columnCount()); }},
        {"a column twice", "actuator 1",
         [](Field& f) { f.actuators[1].runs[1].column = f.actuators[1].runs[0].column; }},
        {"a run past the top", "actuator 1",
         [](Field& f) {
             f.actuators[1].runs[0].firstY =
                 static_cast<std::uint16_t>(f.frame.dimensions.y - f.actuators[1].runs[0].count + 1);
         }},
        {"an empty run", "actuator 1",
         [](Field& f) {
             ActuatorField::Run& run = f.actuators[1].runs.back();
             f.actuators[1].ramps.resize(f.actuators[1].ramps.size() - run.count);
             run.count = 0;
         }},
        {"a run that skips a ramp", "actuator 1", [](Field& f) { ++f.actuators[1].runs[1].firstRamp; }},
        {"a ramp too many", "actuator 1",
         [](Field& f) {
             f.actuators[1].ramps.push_back({1, 1, 0, 255});
         }},
        {"a ramp too few", "actuator 1", [](Field& f) { f.actuators[1].ramps.pop_back(); }},
        {"one level", "header", [](Field& f) { f.levels = 1; }},
        {"too many levels", "header", [](Field& f) { f.levels = kMaxLevels + 1; }},
        {"no voxel side", "header", [](Field& f) { f.frame.voxelSize = 0.0; }},
        {"an endless voxel side", "header",
         [](Field& f) { f.frame.voxelSize = std::numeric_limits<double>::infinity(); }},
        {"no origin", "header", [](Field& f) { f.frame.origin.y = kNan; }},
        {"no rest surface", "header", [](Field& f) { f.restSurface = kNan; }},
        {"no ramp error", "header", [](Field& f) { f.report.rampErrorMax = static_cast<double>(kNan); }},
        {"a flat frame", "header", [](Field& f) { f.frame.dimensions.z = 0; }},
        {"a frame below nothing", "header", [](Field& f) { f.frame.dimensions.x = -f.frame.dimensions.x; }},
        {"a background too small", "background", [](Field& f) { f.background.pop_back(); }},
        {"a background too large", "background", [](Field& f) { f.background.push_back(0); }},
    };
    const Field good = smallField();
    ASSERT_LT(good.frame.dimensions.y, 63);
    for (const Case& one : cases) {
        Field field = good;
        one.spoil(field);
        try {
            (void)parseField(writeField(field), "bad.mdf");
            ADD_FAILURE() << one.what << " was accepted";
        } catch (const DataError& error) {
            const bool ofItsBlock =
                error.why().find(one.place) != std::string::npos || error.why().find("block") != std::string::npos;
            EXPECT_TRUE(ofItsBlock) << one.what << ": " << error.why();
        }
    }
}

/// A block's kind stands before what its checksum guards.
TEST(FieldFile, BlocksOfAnotherKindAreRefused) {
    const std::vector<std::byte> file = writeField(smallField());
    for (const std::uint32_t kind : {0U, 2U, 3U, 9U}) {
        std::vector<std::byte> changed = file;
        std::memcpy(&changed[24], &kind, sizeof kind);
        expectRefused(changed, "a header of kind " + std::to_string(kind));
    }
}

/// The last level of a ramp is the last level of the field.
TEST(FieldFile, ARampMayEndAtTheLastLevel) {
    Field field = smallField();
    for (Ramp& ramp : field.actuators[0].ramps)
        if (ramp.v0 != kUnchanged) ramp.v1 = static_cast<std::uint8_t>(field.levels - 1);
    EXPECT_EQ(parseField(writeField(field), "good.mdf"), field);
}

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

/// A length that claims terabytes must not be believed.
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

} // namespace
} // namespace lumorph
