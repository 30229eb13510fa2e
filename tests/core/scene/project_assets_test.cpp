#include "core/scene/project_assets.h"

#include <algorithm>
#include <fstream>
#include <span>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/resources.h"
#include "core/geometry/gltf_reader.h"
#include "core/rig/rig_file.h"
#include "tests/core/file_size_limit.h"
#include "tests/core/temporary_folder.h"
#include "tests/support/gltf_builder.h"
#include "tests/support/small_rigs.h"

namespace lumorph {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using support::GltfBuilder;
using testing::ElementsAre;
using testing::HasSubstr;

/// A place to take things from, and a project's folder to take them into.
class TakeAsset : public testing::Test {
protected:
    TakeAsset() {
        fs::create_directories(source);
        fs::create_directories(home);
    }

    static void write(const fs::path& file, const std::string& text) {
        fs::create_directories(file.parent_path());
        std::ofstream(file, std::ios::binary) << text;
    }
    static std::string textOf(const fs::path& file) {
        const std::vector<std::byte> bytes = readFile(file, 100'000'000);
        return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
    }
    /// A triangle with its buffer and a picture beside it; the names are percent-encoded in the JSON.
    void writeGltf(const fs::path& file, const std::string& picture = "picture") const {
        GltfBuilder builder = GltfBuilder::triangle();
        builder.document["buffers"] = {{{"byteLength", builder.binary.size()}, {"uri", "my%20data.bin"}}};
        builder.document["images"] = {{{"uri", "textures/skin.png"}},
                                      {{"uri", "textures/skin.png"}},
                                      {{"uri", "data:image/png;base64,iVBORw=="}}};
        write(file, builder.document.dump());
        write(file.parent_path() / "my data.bin",
              {reinterpret_cast<const char*>(builder.binary.data()), builder.binary.size()});
        write(file.parent_path() / "textures/skin.png", picture);
    }
    /// Everything in the project's folder, relative to it, sorted.
    [[nodiscard]] std::vector<std::string> contents() const {
        std::vector<std::string> names;
        for (const auto& entry : fs::recursive_directory_iterator(home))
            if (!entry.is_directory()) names.push_back(entry.path().lexically_relative(home).string());
        std::ranges::sort(names);
        return names;
    }

    TemporaryFolder folder;
    const fs::path source = folder / "downloads";
    const fs::path home = folder / "home";
    const fs::path project = home / "fish.lumorph";
};

TEST_F(TakeAsset, CopiesAFileFromElsewhere) {
    write(source / "cow.obj", "v 0 0 0\n");
    EXPECT_EQ(takeAsset(project, source / "cow.obj"), "fish files/cow.obj");
    EXPECT_EQ(textOf(assetPath(project, "fish files/cow.obj")), "v 0 0 0\n");
    EXPECT_THAT(contents(), ElementsAre("fish files/cow.obj"));
    EXPECT_TRUE(fs::exists(source / "cow.obj"));
}

TEST_F(TakeAsset, NamesWhatLiesInTheProjectAlready) {
    write(home / "models/cow.obj", "v 0 0 0\n");
    write(home / "resource:x.obj", "v 0 0 0\n");
    EXPECT_EQ(takeAsset(project, home / "models/cow.obj"), "models/cow.obj");
    EXPECT_EQ(takeAsset(project, home / "models/../models"), "models");
    fs::create_directory_symlink(home, folder / "shortcut");
    EXPECT_EQ(takeAsset(folder / "shortcut/fish.lumorph", folder / "shortcut/models/cow.obj"), "models/cow.obj");
    const std::string odd = takeAsset(project, home / "resource:x.obj");
    EXPECT_EQ(assetPath(project, odd), fs::canonical(home / "resource:x.obj"));
    EXPECT_THAT(contents(), ElementsAre("models/cow.obj", "resource:x.obj"));
}

TEST_F(TakeAsset, NamesABundledResource) {
    EXPECT_EQ(takeAsset(project, resourceFile("models/tablet.glb")), "resource:models/tablet.glb");
    EXPECT_EQ(assetPath(project, "resource:models/tablet.glb"), fs::canonical(resourceFile("models/tablet.glb")));
    EXPECT_TRUE(contents().empty());
}

TEST_F(TakeAsset, CopiesWhatALinkInTheProjectLeadsTo) {
    write(source / "cow.obj", "v 1 2 3\n");
    fs::create_symlink(source / "cow.obj", home / "link.obj");
    EXPECT_EQ(takeAsset(project, home / "link.obj"), "fish files/link.obj");
    EXPECT_FALSE(fs::is_symlink(home / "fish files/link.obj"));
    EXPECT_EQ(textOf(home / "fish files/link.obj"), "v 1 2 3\n");
}

TEST_F(TakeAsset, TheSameContentsAreNotCopiedTwiceAndOthersGetANumber) {
    for (const char* text : {"first", "second", "third"}) {
        write(source / "cow.obj", text);
        const std::string name = takeAsset(project, source / "cow.obj");
        EXPECT_EQ(textOf(home / name), text);
        EXPECT_EQ(takeAsset(project, source / "cow.obj"), name);
    }
    write(source / "cow.obj", "second");
    EXPECT_EQ(takeAsset(project, source / "cow.obj"), "fish files/cow 2.obj");
    EXPECT_THAT(contents(), ElementsAre("fish files/cow 2.obj", "fish files/cow 3.obj", "fish files/cow.obj"));
    EXPECT_EQ(textOf(home / "fish files/cow.obj"), "first");
}

TEST_F(TakeAsset, WhatIsInMemoryAloneGoesByTheSameRules) {
    const auto take = [&](const std::string& text) {
        return takeAsset(project, "cow.glb", std::as_bytes(std::span(text)));
    };
    EXPECT_EQ(take("first"), "fish files/cow.glb");
    EXPECT_EQ(take("second"), "fish files/cow 2.glb");
    EXPECT_EQ(take("fir"), "fish files/cow 3.glb") << "the beginning of another";
    EXPECT_EQ(take("first"), "fish files/cow.glb");
    EXPECT_THAT(contents(), ElementsAre("fish files/cow 2.glb", "fish files/cow 3.glb", "fish files/cow.glb"));
    EXPECT_EQ(textOf(home / "fish files/cow 2.glb"), "second");
    fs::create_symlink(source / "elsewhere", home / "fish files/bull.glb");
    EXPECT_EQ(takeAsset(project, "bull.glb", std::as_bytes(std::span("bull", 4))), "fish files/bull 2.glb")
        << "a link is not written through";
    EXPECT_FALSE(fs::exists(source / "elsewhere"));
}

TEST_F(TakeAsset, AGltfBringsItsBuffersAndImages) {
    writeGltf(source / "cow.gltf");
    EXPECT_EQ(takeAsset(project, source / "cow.gltf"), "fish files/cow/cow.gltf");
    const std::vector<std::string> copied = {"fish files/cow/cow.gltf", "fish files/cow/my data.bin",
                                             "fish files/cow/textures/skin.png"};
    EXPECT_EQ(contents(), copied);
    EXPECT_TRUE(readModel(home / "fish files/cow/cow.gltf") == readModel(source / "cow.gltf"));
    EXPECT_EQ(takeAsset(project, source / "cow.gltf"), "fish files/cow/cow.gltf");
    EXPECT_EQ(contents(), copied);

    // The glTF itself is the same; a picture is not.
    writeGltf(source / "cow.gltf", "another picture");
    EXPECT_EQ(takeAsset(project, source / "cow.gltf"), "fish files/cow 2/cow.gltf");
    EXPECT_EQ(textOf(home / "fish files/cow/textures/skin.png"), "picture");
    EXPECT_EQ(textOf(home / "fish files/cow 2/textures/skin.png"), "another picture");
}

TEST_F(TakeAsset, AGltfThatIsWholeStaysOneFile) {
    const std::vector<std::byte> glb = GltfBuilder::triangle().glb();
    write(source / "cow.glb", {reinterpret_cast<const char*>(glb.data()), glb.size()});
    EXPECT_EQ(takeAsset(project, source / "cow.glb"), "fish files/cow.glb");
}

TEST_F(TakeAsset, AGltfBringsNothingFromOutsideItsFolder) {
    write(folder / "secret.bin", "secret");
    fs::create_symlink(folder / "secret.bin", source / "link.bin");
    for (const char* uri : {"../secret.bin", "%2e%2e/secret.bin", "textures/../../secret.bin", "/etc/passwd",
                            "%2Fetc%2Fpasswd", "file:///etc/passwd", "link.bin", "missing.bin", "textures", "a%00b"}) {
        for (const char* list : {"buffers", "images"}) {
            SCOPED_TRACE(std::string(list) + " " + uri);
            fs::create_directories(source / "textures");
            GltfBuilder builder = GltfBuilder::triangle();
            builder.document[list] = {{{"byteLength", 6}, {"uri", uri}}};
            write(source / "cow.gltf", builder.document.dump());
            // A picture that is not there is left behind, and the model taken without it.
            const bool leftBehind = list == std::string("images") &&
                                    (uri == std::string("missing.bin") || uri == std::string("file:///etc/passwd"));
            if (leftBehind) {
                EXPECT_EQ(takeAsset(project, source / "cow.gltf"), "fish files/cow.gltf");
                EXPECT_THAT(contents(), ElementsAre("fish files/cow.gltf"));
                fs::remove_all(home / "fish files");
                continue;
            }
            EXPECT_THROW((void)takeAsset(project, source / "cow.gltf"), DataError);
            EXPECT_TRUE(fs::is_empty(home));
        }
    }
}

TEST_F(TakeAsset, AGltfBringsWhatItNamesInAnotherFormOrCase) {
    fs::create_directories(source / "Textures");
    write(source / "Textures/Ma\u0308rz.png", "picture"); // decomposed, as macOS keeps it
    GltfBuilder builder = GltfBuilder::triangle();
    write(source / "mesh.BIN", {reinterpret_cast<const char*>(builder.binary.data()), builder.binary.size()});
    builder.document["buffers"] = {{{"byteLength", builder.binary.size()}, {"uri", "mesh.bin"}}};
    builder.document["images"] = {{{"uri", "textures\\M\u00E4rz.png"}}};
    write(source / "cow.gltf", builder.document.dump());
    EXPECT_EQ(takeAsset(project, source / "cow.gltf"), "fish files/cow/cow.gltf");
    EXPECT_TRUE(readModel(home / "fish files/cow/cow.gltf") == readModel(source / "cow.gltf"));
    EXPECT_THAT(readModelFile(home / "fish files/cow/cow.gltf").warnings, ::testing::IsEmpty());
}

TEST_F(TakeAsset, AnAssetIsFoundInAnotherFormOrCaseAndItsNearNameTold) {
    write(home / "Models/Ku\u0308ste.glb", "coast");
    write(home / "dunes.glb", "dunes");
    for (const char* asset : {"Models/Ku\u0308ste.glb", "Models/K\u00FCste.glb", "models/K\u00DCSTE.GLB",
                              "models\\K\u00FCste.glb", "a/../Models/K\u00FCste.glb"})
        EXPECT_EQ(assetPath(project, asset), fs::canonical(home / "Models/Ku\u0308ste.glb")) << asset;
    try {
        (void)assetPath(project, "fish files/dunes.glb");
        ADD_FAILURE() << "was found";
    } catch (const DataError& error) {
        EXPECT_THAT(error.why(), HasSubstr("is not there, but 'dunes.glb' lies beside the project"));
    }
}

TEST_F(TakeAsset, AFolderOfStatesBringsItsMeshesOnly) {
    const std::string rest = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    const std::string moved = "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    write(source / "flap/rest.obj", rest);
    write(source / "flap/left_1.OBJ", moved);
    write(source / "flap/notes.txt", "private");
    write(source / "flap/deeper/other.obj", rest);
    EXPECT_EQ(takeAsset(project, source / "flap/"), "fish files/flap");
    EXPECT_THAT(contents(), ElementsAre("fish files/flap/left_1.OBJ", "fish files/flap/rest.obj"));
    EXPECT_EQ(readRig(assetPath(project, "fish files/flap")).actuators().front().name, "left");
    EXPECT_EQ(takeAsset(project, source / "flap"), "fish files/flap");
    write(source / "flap/left_2.obj", moved);
    EXPECT_EQ(takeAsset(project, source / "flap"), "fish files/flap 2");
    write(source / "empty/notes.txt", "no mesh");
    EXPECT_THROW((void)takeAsset(project, source / "empty"), DataError);
}

/// A folder is a rig of one mesh a state: one more file in the copy is another rig.
TEST_F(TakeAsset, AFolderThatHoldsMoreIsNotTheSame) {
    const std::string rest = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    write(source / "flap/rest.obj", rest);
    write(source / "flap/left_1.obj", rest);
    ASSERT_EQ(takeAsset(project, source / "flap"), "fish files/flap");
    write(home / "fish files/flap/left_2.obj", rest);
    EXPECT_EQ(takeAsset(project, source / "flap"), "fish files/flap 2");
    write(home / "fish files/flap 2/deeper/left_2.obj", rest);
    EXPECT_EQ(takeAsset(project, source / "flap"), "fish files/flap 3");
    EXPECT_EQ(takeAsset(project, source / "flap"), "fish files/flap 3");
    fs::remove(home / "fish files/flap 3/left_1.obj");
    EXPECT_EQ(takeAsset(project, source / "flap"), "fish files/flap 4");
    write(home / "fish files/flap 4/left_1.obj", "v 0 0 0\n");
    EXPECT_EQ(takeAsset(project, source / "flap"), "fish files/flap 5");
    // One that a link stands for may change without us.
    fs::remove(home / "fish files/flap 5/left_1.obj");
    fs::create_symlink(source / "flap/left_1.obj", home / "fish files/flap 5/left_1.obj");
    EXPECT_EQ(takeAsset(project, source / "flap"), "fish files/flap 6");
}

TEST_F(TakeAsset, LeavesNothingWhenTheDiskIsFull) {
    writeGltf(source / "cow.gltf", std::string(100'000, 'p'));
    write(source / "cow.obj", std::string(100'000, 'v'));
    for (const char* name : {"cow.gltf", "cow.obj"}) {
        const FileSizeLimit limit(50'000);
        try {
            (void)takeAsset(project, source / name);
            ADD_FAILURE() << name << " was copied";
        } catch (const DeviceError& error) {
            EXPECT_THAT(error.subject(), HasSubstr("fish files/cow"));
            EXPECT_THAT(error.why(), HasSubstr("cannot be written"));
        }
        EXPECT_TRUE(fs::is_empty(home)) << name;
    }
}

TEST_F(TakeAsset, ReportsProgressAndStopsWhenAsked) {
    write(source / "cow.obj", std::string(5'000'000, 'v'));
    std::stop_source stop;
    std::vector<double> fractions;
    const Progress counting([&](double fraction, std::string_view) { fractions.push_back(fraction); });
    const Progress stopping([&](double, std::string_view) { stop.request_stop(); }, stop.get_token());
    EXPECT_THROW((void)takeAsset(project, source / "cow.obj", stopping), Cancelled);
    EXPECT_TRUE(fs::is_empty(home));
    EXPECT_EQ(takeAsset(project, source / "cow.obj", counting), "fish files/cow.obj");
    EXPECT_GE(fractions.size(), 4U);
    EXPECT_TRUE(std::ranges::is_sorted(fractions));
    EXPECT_EQ(fractions.back(), 1.0);
}

TEST_F(TakeAsset, RefusesSourcesAndPlacesThatCannotServe) {
    EXPECT_THROW((void)takeAsset(project, source / "missing.obj"), DataError);
    EXPECT_THROW((void)takeAsset(project, "/dev/zero"), DataError);
    write(source / "broken.gltf", "{");
    EXPECT_THROW((void)takeAsset(project, source / "broken.gltf"), DataError);
    write(source / "\xff.obj", "v 0 0 0\n");
    EXPECT_THROW((void)takeAsset(project, source / "\xff.obj"), DataError);
    EXPECT_TRUE(fs::is_empty(home));

    write(source / "cow.obj", "v 0 0 0\n");
    EXPECT_THROW((void)takeAsset(folder / "nowhere/fish.lumorph", source / "cow.obj"), DeviceError);
    EXPECT_FALSE(fs::exists(folder / "nowhere"));
    write(home / "fish files", "a file");
    EXPECT_THROW((void)takeAsset(project, source / "cow.obj"), DeviceError);
    fs::remove(home / "fish files");
    fs::create_directory_symlink(source, home / "fish files");
    EXPECT_THROW((void)takeAsset(project, source / "cow.obj"), DataError);
    EXPECT_TRUE(fs::is_symlink(home / "fish files"));
}

TEST(AssetPath, NamesWhatIsNotThere) {
    const TemporaryFolder folder;
    for (const char* asset : {"missing.glb", "resource:models/missing.glb", "", "../a.glb"}) {
        try {
            (void)assetPath(folder / "p.lumorph", asset);
            ADD_FAILURE() << asset << " was found";
        } catch (const DataError& error) {
            EXPECT_EQ(error.subject(), (folder / "p.lumorph").string());
            EXPECT_FALSE(error.remedy().empty());
        }
    }
}

} // namespace
} // namespace lumorph
