#include "core/base/file.h"

#include <cstring>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "tests/core/file_size_limit.h"
#include "tests/core/temporary_folder.h"

namespace lumorph {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

std::span<const std::byte> bytesOf(std::string_view text) { return std::as_bytes(std::span(text)); }

std::string textIn(const fs::path& file) {
    const std::vector<std::byte> bytes = readFile(file, 1'000'000);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::size_t filesIn(const fs::path& folder) {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(ReadFile, GivesAllBytes) {
    const TemporaryFolder folder;
    for (const std::size_t size : {0U, 1U, 5000U, 3'000'000U}) {
        std::string text(size, 'x');
        for (std::size_t i = 0; i < size; ++i) text[i] = static_cast<char>(i % 251);
        std::ofstream(folder / "file", std::ios::binary) << text;
        const std::vector<std::byte> bytes = readFile(folder / "file", 3'000'000);
        ASSERT_EQ(bytes.size(), size);
        EXPECT_EQ(std::memcmp(bytes.data(), text.data(), size), 0);
    }
}

TEST(ReadFile, NamesTheFileAndTheCause) {
    const TemporaryFolder folder;
    std::ofstream(folder / "large") << "123456";
    EXPECT_EQ(readFile(folder / "large", 6).size(), 6U);
    const struct {
        fs::path file;
        const char* cause;
    } cases[] = {
        {folder / "missing", "No such file"},
        {folder.path(), "is a folder"},
        {folder / "large", "larger than 5 bytes"},
        {"/dev/zero", "larger than 5 bytes"},
    };
    for (const auto& c : cases) {
        try {
            (void)readFile(c.file, 5);
            ADD_FAILURE() << c.file << " was read";
        } catch (const DataError& error) {
            EXPECT_EQ(error.subject(), c.file.string());
            EXPECT_THAT(error.why(), HasSubstr(c.cause));
            EXPECT_FALSE(error.remedy().empty());
        }
    }
}

TEST(WriteFileAtomically, ReplacesTheOldFileAndKeepsItsPermissions) {
    const TemporaryFolder folder;
    writeFileAtomically(folder / "file", bytesOf("old"));
    fs::permissions(folder / "file", fs::perms::owner_read | fs::perms::owner_write);
    writeFileAtomically(folder / "file", bytesOf("new content"));
    EXPECT_EQ(textIn(folder / "file"), "new content");
    EXPECT_EQ(fs::status(folder / "file").permissions(), fs::perms::owner_read | fs::perms::owner_write);
    EXPECT_EQ(filesIn(folder.path()), 1U);
}

TEST(WriteFileAtomically, LeavesTheOldFileWhenTheDiskIsFull) {
    const TemporaryFolder folder;
    writeFileAtomically(folder / "file", bytesOf("old"));
    {
        const FileSizeLimit limit(4096);
        EXPECT_THROW(writeFileAtomically(folder / "file", bytesOf(std::string(10'000, 'x'))), DeviceError);
    }
    EXPECT_EQ(textIn(folder / "file"), "old");
    EXPECT_EQ(filesIn(folder.path()), 1U);
}

TEST(WriteFileAtomically, NamesTheFileAndTheReason) {
    const TemporaryFolder folder;
    const struct {
        fs::path file;
        const char* reason;
    } cases[] = {
        {folder / "no" / "such" / "folder", "No such file or directory"},
        {folder.path(), "Is a directory"},
        {"/dev/full", "No space left on device"},
    };
    for (const auto& c : cases) {
        try {
            writeFileAtomically(c.file, bytesOf("text"));
            ADD_FAILURE() << c.file << " was written";
        } catch (const DeviceError& error) {
            EXPECT_EQ(error.subject(), c.file.string());
            EXPECT_THAT(error.why(), HasSubstr(c.reason));
        }
    }
    EXPECT_EQ(filesIn(folder.path()), 0U);
    struct stat device {};
    ASSERT_EQ(::stat("/dev/full", &device), 0);
    EXPECT_TRUE(S_ISCHR(device.st_mode)) << "the device itself was replaced";
}

TEST(WriteFileAtomically, WritesThroughALinkAndUnderALongName) {
    const TemporaryFolder folder;
    writeFileAtomically(folder / "target", bytesOf("old"));
    fs::create_symlink("target", folder / "link");
    writeFileAtomically(folder / "link", bytesOf("new"));
    EXPECT_TRUE(fs::is_symlink(folder / "link"));
    EXPECT_EQ(textIn(folder / "target"), "new");
    const std::string longName(255, 'n');
    writeFileAtomically(folder / longName, bytesOf("text"));
    EXPECT_EQ(textIn(folder / longName), "text");
}

} // namespace
} // namespace lumorph
