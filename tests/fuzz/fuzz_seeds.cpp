// Writes small valid files of every format into folders of the folder given, for the fuzzers to start from.
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <vector>

#include "calibration/report/calibration_file.h"
#include "calibration/stages/recording.h"
#include "core/geometry/mesh_writers.h"
#include "core/geometry/model.h"
#include "core/mdf/builder.h"
#include "core/mdf/field_file.h"
#include "core/rig/rig_file.h"
#include "core/scene/project.h"
#include "core/voxels/nrrd.h"
#include "core/voxels/solid.h"
#include "devices/protocol/natnet_writer.h"
#include "tests/core/scene/scenes.h"
#include "tests/fuzz/servo_trace_seeds.h"
#include "tests/fuzz/stage_recording_seeds.h"
#include "tests/support/full_model.h"
#include "tests/support/gltf_builder.h"
#include "tests/support/natnet_frames.h"
#include "tests/support/small_rigs.h"

namespace {

using lumorph::support::GltfBuilder;

GltfBuilder sparse() {
    GltfBuilder builder = GltfBuilder::triangle();
    const std::array<std::uint16_t, 2> indices = {0, 2};
    const std::array<float, 6> values = {1, 2, 3, 4, 5, 6};
    const int indexView = builder.view(indices.data(), sizeof(indices));
    const int valueView = builder.view(values.data(), sizeof(values));
    builder.document["accessors"][0]["sparse"] = {{"count", 2},
                                                  {"indices", {{"bufferView", indexView}, {"componentType", 5123}}},
                                                  {"values", {{"bufferView", valueView}}}};
    builder.document["images"] = {{{"uri", "data:image/png;base64,iVBORw=="}}};
    return builder;
}

GltfBuilder strip() {
    GltfBuilder builder = GltfBuilder::triangle();
    builder.primitive()["mode"] = 5;
    builder.primitive()["attributes"]["_LEVEL"] =
        builder.accessor(std::vector<std::uint8_t>{0, 128, 255}, "SCALAR", 5121);
    builder.document["accessors"].back()["normalized"] = true;
    builder.document["nodes"] = {{{"children", {1}}},
                                 {{"mesh", 0}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1}}}};
    return builder;
}

/// JSON, a zero byte and the binary data of a GLB.
std::vector<std::byte> partsOf(const std::vector<std::byte>& glb) {
    std::uint32_t jsonBytes = 0;
    std::memcpy(&jsonBytes, glb.data() + 12, sizeof(jsonBytes));
    const auto text = glb.begin() + 20;
    std::vector<std::byte> parts(text, text + jsonBytes);
    parts.push_back(std::byte{0});
    parts.insert(parts.end(), text + jsonBytes + 8, glb.end());
    return parts;
}

/// A byte that chooses the version, and a datagram of it.
template <typename Write> void writeNatNet(Write write) {
    using namespace lumorph;
    constexpr std::size_t kVersions = test::kNatNetVersions.size();
    for (std::size_t i = 0; i < kVersions; ++i) {
        const natnet::Version version = test::kNatNetVersions[i];
        NatNetWriter writer(version);
        test::RandomFrames frames(i);
        natnet::ServerInfo info{"Motive", {2, 1, 0, 0}, version, {}};
        if (version.major >= 3) info.connection.emplace();
        const std::vector<std::byte> datagrams[] = {writer.frame(frames.frame(version)),
                                                    writer.frame(frames.frame(version)),
                                                    writer.models(test::allModels(version)), writer.serverInfo(info)};
        int number = 0;
        for (const std::vector<std::byte>& datagram : datagrams) {
            std::vector<std::byte> seed{std::byte(i)};
            seed.insert(seed.end(), datagram.begin(), datagram.end());
            write(("natnet/" + std::to_string(i) + "-" + std::to_string(number++)).c_str(), seed);
        }
    }
}

} // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: fuzz_seeds <folder>\n");
        return 2;
    }
    const std::filesystem::path root = argv[1];
    const auto write = [&](const char* name, std::span<const std::byte> bytes) {
        const std::filesystem::path file = root / name;
        std::filesystem::create_directories(file.parent_path());
        std::ofstream(file, std::ios::binary)
            .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    };
    const auto writeText = [&](const char* name, const std::string& text) {
        write(name, std::as_bytes(std::span(text)));
    };
    const auto writeBoth = [&](const std::string& name, const std::vector<std::byte>& glb) {
        write((name + ".glb").c_str(), glb);
        write((name + ".parts").c_str(), partsOf(glb));
    };
    using namespace lumorph;
    writeBoth("gltf/full", writeGlb(support::fullModel()));
    writeBoth("gltf/triangle", GltfBuilder::triangle().glb());
    writeBoth("gltf/sparse", sparse().glb());
    writeBoth("gltf/strip", strip().glb());

    writeBoth("rig/cushion", writeRigGlb(test::cushionRig()));
    writeBoth("rig/arm", writeRigGlb(test::armRig()));
    writeBoth("rig/model", writeGlb(support::fullModel()));

    const TriangleMesh box = test::boxMesh({0, 0, 0}, {1, 2, 3});
    writeText("obj/box.obj", writeObj(box));
    writeText("obj/rich.obj",
              "o part\nv 0 0 0 1 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\ng a\nf 1/1/1 2//1 3 -1\n");
    write("stl/box.stl", writeStl(box));
    writeText("stl/text.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
                              "0\nendloop\nendfacet\nendsolid a\n");
    writeText("off/box.off", "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n");
    writeText("ply/box.ply",
              "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
              "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    const VoxelFrame frame{{0, 0, 0}, 0.5, {2, 4, 6}};
    write("nrrd/box.nrrd", writeNrrd(bytesOf(frame, voxelizeSolid(frame, box)), "box"));
    BuildOptions options;
    options.resolution = 3;
    options.levels = 4;
    options.samples = 8;
    write("mdf/cushion.mdf", writeField(buildField(test::cushionRig(), options)));

    Project project;
    project.rig = "resource:models/tablet.glb";
    project.field = "p files/tablet.mdf";
    project.target = "p files/cow/cow.gltf";
    project.strokes = {0.0, 0.25, 1.0};
    project.view = {{"camera", {{"yaw", 0.5}}}};
    writeText("project/whole.lumorph", projectText(project));
    project.scene = test::fullScene();
    project.installation = test::fullInstallation();
    writeText("project/scene.lumorph", projectText(project));
    writeText("project/first.lumorph", R"({"schemaVersion": 1, "rig": "a.glb", "target": "cow.obj"})");
    writeText("project/bare.lumorph",
              R"({"schemaVersion": 2, "rig": "a.glb", "scene": {"items": [{"id": 1, "kind": "group"}, {"id": 2,
              "parent": 1, "kind": "heights", "heights": {"waves": [{"phaseDegrees": 1e-9}]}}], "projectors": []}})");
    writeText("project/draft.lumorph",
              R"({"model": "a.glb", "author": "b", "matching": {"driver": "hand", "more": [1]}})");

    RecordedTable touches{{"check", "x"}, {}, {}};
    touches.add("dot 1", {0.0, 0.25});
    touches.add("fresh \"dot\", 1", {1.0, -1e-3});
    const std::string table = tableText(touches);
    writeText("stage_recording/table.csv", "0" + table);
    writeText("stage_recording/bare.csv", std::string("0on,off\n0.5,0.625\n"));
    writeText("stage_recording/whole.json",
              "1{\"lumorph\":\"calibration recording\",\"version\":1,\"stage\":\"pointer\",\"method\":\"\","
              "\"device\":\"tablet\",\"source\":{\"kind\":\"table\",\"who\":\"a tracker\",\"date\":\"\","
              "\"seed\":0},\"files\":[{\"name\":\"touches.csv\",\"bytes\":" +
                  std::to_string(table.size()) + ",\"crc32\":1}]}\x1e" + table);
    for (const auto& [name, input] : stageRecordingSeeds()) writeText(("stage_recording/stage_" + name).c_str(), input);
    CalibrationRecord calibration;
    calibration.source = {"2026-11-24T17:05:00Z", "chess:9x7:75", "graycode", {"capture"}, 0.001};
    ProcamCalibration& result = calibration.result;
    result.camera = {{1280, 1024}, {1500, 1, 639, 511, -0.1, 0.01, 0, 0, 0}, {}, {1, 0, 1, 1}, 0.2, "k1 k2"};
    result.projector = {{1024, 768}, {1890, 1, 511, 840}, {}, {2, 0, 1, 1}, 0.3, "pinhole"};
    result.projectorFromCamera = {0.1, 0.2, 0.3, 400, 500, 60};
    result.views = {{"pose_0", 0.1, 0.2, 0.3}};
    result.state.cameraFromBoard = {{0.1, 0.2, 0.3, 1, 2, 900}};
    result.warnings = {{Cause::clipped, "pose_0", "a.png", "too bright", "expose less"}};
    writeText("calibration/own.json", "0" + calibrationText(calibration));
    writeText("calibration/opencv.yaml", "1" + calibrationYaml(calibration));
    writeText("calibration/lists.yaml", "1camera_matrix:\n- - 1000.0\n  - 0\n  - 320\n- [0, 1000, 240]\n- [0, 0, 1]\n"
                                        "dist_coeffs: [[0.1, 0, 0, 0, 0]]\nimage_size: [640, 480]\n");
    writeText("capture_order/gray", "column bit 9\ncolumn bit 9 inverse # stripes\nrow bit 0\nwhite\nblack\nunused\n");
    writeText("capture_order/phase", "column phase 16 step 0 of 3\n\nrow phase 1 step 2 of 3\n");

    const auto writeBytes = [&](const char* name, const std::vector<std::uint8_t>& bytes) {
        write(name, std::as_bytes(std::span(bytes)));
    };
    writeBytes("firmata/board", {5,    0xF9, 0x02, 0x05, 0xF0, 0x79, 0x02, 0x05, 0x61, 0x00, 0xF7, 0xF0, 0x6C,
                                 0x7F, 0x04, 0x0E, 0x7F, 0xF7, 0xF0, 0x6E, 0x09, 0x04, 0x5C, 0x0B, 0xF7, 0xF0,
                                 0x71, 0x6E, 0x00, 0xF7, 0xF0, 0x02, 0x68, 0x39, 0x00, 0xF7, 0xE3, 0x7F, 0x07});
    writeBytes("lewansoul/board", {5,    0x55, 0x55, 0x04, 0x0F, 0xE8, 0x1C, 0x55, 0x55, 0x09, 0x15, 0x02, 0x01,
                                   0xF4, 0x01, 0x02, 0xFB, 0xFF, 0x00, 0x55, 0x55, 0x05, 0x08, 0x01, 0x01, 0x00});
    writeBytes("maestro/board", {0, 2, 3, 0x70, 0x17, 0x28, 0x00});
    for (const std::vector<std::uint8_t>& seed : servoTraceSeeds())
        writeBytes(("servo_trace/" + std::to_string(seed.front())).c_str(), seed);
    writeNatNet(write);
    write("opentrack/rest", std::vector<std::byte>(48));
    using namespace std::string_literals;
    const std::string position = "/tracking/trackers/head/position\0\0\0\0,fff\0\0\0\0\x3f\x80\0\0\x40\0\0\0\0\0\0\0"s;
    writeText("osc/position", position);
    writeText("osc/bundle", "#bundle\0\0\0\0\0\0\0\0\x01\0\0\0\x38"s + position);
    return 0;
}
