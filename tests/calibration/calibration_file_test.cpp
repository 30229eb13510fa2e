#include "calibration/report/calibration_file.h"

#include <cmath>
#include <fstream>
#include <limits>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <opencv2/calib3d.hpp>

#include "core/base/error.h"
#include "tests/core/temporary_folder.h"

namespace lumorph::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

CalibrationRecord exampleRecord() {
    CalibrationRecord record;
    ProcamCalibration& result = record.result;
    const auto fill = [](CalibratedDevice& device, cv::Size size, double focal) {
        device.size = size;
        device.lens = {focal, 1.0 + 1.0 / 3.0e3, 512.25, 841.0 / 3.0, -0.1234567890123456, 1e-17, 2e-3, -3e-4, 0.1};
        device.sigma = {0.5, 1e-5, 0.7, 0.8, 1e-3, 2e-3, 3e-4, 4e-4, 0.0};
        device.free.fill(true);
        device.free[kK3] = false;
        device.rms = 0.123;
        device.model = "k1 k2 p1 p2";
    };
    fill(result.camera, {1280, 1024}, 1890.125);
    fill(result.projector, {1024, 768}, 2100.0 / 7.0 * 5.0);
    result.projectorFromCamera = {0.1, -0.4, 0.02, -623.5, 100.0 / 3.0, 12.0};
    result.projectorFromCameraSigma = {1e-3, 2e-3, 3e-3, 0.4, 0.5, 0.6};
    result.rms = 0.25;
    result.views = {{"pose \"1\" <b>", 0.1, 0.2, 0.3}, {"pose_2 \xC3\xA4", 0.15, 0.25, {}}};
    result.worstView = "pose_2 \xC3\xA4";
    result.halvesDiffer = 0.05;
    result.warnings = {{Cause::clipped, "pose_2", "shot.png", "is too bright", "expose less"}};
    result.state.cameraFromBoard = {{0.1, 0.2, 0.3, 1, 2, 1000}, {0.4, 0.5, 0.6, 3, 4, 1100}};
    record.source = {"2026-11-25T10:00:00Z", "chess:9x7:75", "graycode", {"/data/capture: 1", "b"}, 0.001};
    return record;
}

void expectNear(const Lens& one, const Lens& other) {
    for (std::size_t i = 0; i < one.size(); ++i) EXPECT_NEAR(one[i], other[i], 1e-12 * (1.0 + std::abs(one[i]))) << i;
}

void expectSameFigures(const ProcamCalibration& one, const ProcamCalibration& other) {
    expectNear(one.camera.lens, other.camera.lens);
    expectNear(one.projector.lens, other.projector.lens);
    EXPECT_EQ(one.camera.size, other.camera.size);
    EXPECT_EQ(one.projector.size, other.projector.size);
    EXPECT_EQ(one.camera.rms, other.camera.rms);
    EXPECT_EQ(one.projector.rms, other.projector.rms);
    EXPECT_EQ(one.rms, other.rms);
    for (std::size_t i = 0; i < 6; ++i)
        EXPECT_NEAR(one.projectorFromCamera[i], other.projectorFromCamera[i], 1e-9) << i;
}

TEST(CalibrationFile, WhatTheLabMadeStaysSimulated) {
    CalibrationRecord record = exampleRecord();
    EXPECT_EQ(calibrationText(record).find("simulated"), std::string::npos);
    record.source.isSimulated = true;
    EXPECT_TRUE(parseCalibration(calibrationText(record), "a.json").source.isSimulated);
    EXPECT_TRUE(parseCalibrationYaml(calibrationYaml(record), "a.yaml").source.isSimulated);
}

TEST(CalibrationFile, OurJsonComesBackAsItWas) {
    const CalibrationRecord record = exampleRecord();
    const std::string text = calibrationText(record);
    const CalibrationRecord back = parseCalibration(text, "a.json");
    expectSameFigures(record.result, back.result);
    EXPECT_EQ(record.source, back.source);
    const ProcamCalibration& result = back.result;
    ASSERT_EQ(result.views.size(), 2U);
    EXPECT_EQ(result.views[0].name, record.result.views[0].name);
    EXPECT_EQ(result.views[0].heldOut, 0.3);
    EXPECT_EQ(result.views[1].heldOut, std::nullopt);
    EXPECT_EQ(result.views[1].projectorRms, 0.25);
    EXPECT_EQ(result.worstView, record.result.worstView);
    EXPECT_EQ(result.halvesDiffer, 0.05);
    EXPECT_EQ(result.halvesAllowed, std::nullopt);
    EXPECT_EQ(result.warnings, record.result.warnings);
    EXPECT_EQ(result.state.cameraFromBoard, record.result.state.cameraFromBoard);
    EXPECT_EQ(result.camera.free, record.result.camera.free);
    EXPECT_EQ(result.camera.model, record.result.camera.model);
    for (std::size_t i = 0; i < kLensParameters; ++i)
        EXPECT_NEAR(result.projector.sigma[i], record.result.projector.sigma[i], 1e-9) << i;
    for (std::size_t i = 0; i < 6; ++i)
        EXPECT_NEAR(result.projectorFromCameraSigma[i], record.result.projectorFromCameraSigma[i], 1e-12);
}

TEST(CalibrationFile, CameraAloneHasNoProjector) {
    CalibrationRecord record = exampleRecord();
    record.result.projector = {};
    EXPECT_FALSE(nlohmann::json::parse(calibrationText(record)).contains("R"));
    EXPECT_TRUE(parseCalibration(calibrationText(record), "a").result.projector.size.empty());
    EXPECT_TRUE(parseCalibrationYaml(calibrationYaml(record), "a").result.projector.size.empty());
}

TEST(CalibrationFile, OpenCvReadsOurYaml) {
    const CalibrationRecord record = exampleRecord();
    const cv::FileStorage storage(calibrationYaml(record), cv::FileStorage::READ | cv::FileStorage::MEMORY);
    const auto matrixOf = [&storage](const char* key) {
        cv::Mat matrix;
        storage[key] >> matrix;
        return matrix;
    };
    const ProcamCalibration& result = record.result;
    for (const auto& [matrix, distortion, device] : {std::tuple("cameraMatrix1", "distCoeffs1", &result.camera),
                                                     std::tuple("cameraMatrix2", "distCoeffs2", &result.projector)}) {
        const Lens& lens = device->lens;
        const cv::Mat intrinsics = matrixOf(matrix);
        EXPECT_EQ(intrinsics.at<double>(0, 0), lens[kFocalLength]);
        EXPECT_EQ(intrinsics.at<double>(1, 1), lens[kFocalLength] * lens[kAspect]);
        EXPECT_EQ(intrinsics.at<double>(0, 2), lens[kPrincipalX]);
        EXPECT_EQ(intrinsics.at<double>(1, 2), lens[kPrincipalY]);
        const cv::Mat terms = matrixOf(distortion);
        ASSERT_EQ(terms.total(), 5U);
        EXPECT_EQ(terms.at<double>(0), lens[kK1]);
        EXPECT_EQ(terms.at<double>(2), lens[kP1]);
        EXPECT_EQ(terms.at<double>(4), lens[kK3]);
    }
    cv::Mat vector;
    cv::Rodrigues(matrixOf("R"), vector);
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(vector.at<double>(i), result.projectorFromCamera[static_cast<std::size_t>(i)], 1e-12);
        EXPECT_EQ(matrixOf("T").at<double>(i), result.projectorFromCamera[static_cast<std::size_t>(i) + 3]);
    }
    EXPECT_EQ(static_cast<int>(storage["projector_width"]), 1024);
    EXPECT_EQ(static_cast<double>(storage["rms"]), 0.25);
    EXPECT_EQ(static_cast<std::string>(storage["board"]), "chess:9x7:75");
}

TEST(CalibrationFile, YamlComesBackAsItWas) {
    const CalibrationRecord record = exampleRecord();
    const CalibrationRecord back = parseCalibrationYaml(calibrationYaml(record), "a.yaml");
    expectSameFigures(record.result, back.result);
    EXPECT_EQ(back.source.date, record.source.date);
    EXPECT_EQ(back.source.board, record.source.board);
}

/// What OpenCV's own FileStorage writes under the names that people use.
TEST(CalibrationFile, CommonSpellingsOfOpenCvAreRead) {
    struct Names {
        const char *k1, *d1, *k2, *d2, *r, *t;
    };
    const ProcamCalibration expected = exampleRecord().result;
    const auto matrixOf = [](const Lens& lens) {
        return cv::Mat((cv::Mat_<double>(3, 3) << lens[0], 0, lens[2], 0, lens[0] * lens[1], lens[3], 0, 0, 1));
    };
    const auto termsOf = [](const Lens& lens) {
        return cv::Mat((cv::Mat_<double>(1, 5) << lens[kK1], lens[kK2], lens[kP1], lens[kP2], lens[kK3]));
    };
    cv::Mat rotation;
    const PoseVector& rig = expected.projectorFromCamera;
    cv::Rodrigues(cv::Vec3d(rig[0], rig[1], rig[2]), rotation);
    const cv::Mat shift = (cv::Mat_<double>(3, 1) << rig[3], rig[4], rig[5]);
    for (const Names& names :
         {Names{"K1", "D1", "K2", "D2", "R", "T"}, Names{"M1", "D1", "M2", "D2", "R", "T"},
          Names{"cameraMatrix1", "distCoeffs1", "cameraMatrix2", "distCoeffs2", "R", "T"},
          Names{"camera_matrix_1", "dist_coeffs_1", "camera_matrix_2", "dist_coeffs_2", "rotation", "translation"},
          Names{"cam_K", "cam_kc", "proj_K", "proj_kc", "R", "T"},
          Names{"camera_matrix", "distortion_coefficients", "projector_matrix", "projector_distortion", "R", "T"},
          Names{"Camera_Matrix", "Distortion_Coefficients", "projMatrix", "projDistCoeffs", "Rotation_Matrix", "T"}})
        for (const bool asFloat : {false, true}) {
            cv::FileStorage storage("x.yml", cv::FileStorage::WRITE | cv::FileStorage::MEMORY);
            const auto write = [&](const char* key, cv::Mat matrix) {
                if (asFloat) matrix.convertTo(matrix, CV_32F);
                storage << key << matrix;
            };
            storage << "note"
                    << "written by: a test [of] names";
            storage << "flags" << 0 << "nested"
                    << "{"
                    << "a" << 1 << "b"
                    << "[" << 1 << 2 << "]"
                    << "}";
            write("E", cv::Mat::eye(3, 3, CV_64F));
            write("image_points", cv::Mat::ones(200, 2, CV_64F));
            write(names.k1, matrixOf(expected.camera.lens));
            write(names.d1, termsOf(expected.camera.lens));
            write(names.k2, matrixOf(expected.projector.lens));
            write(names.d2, termsOf(expected.projector.lens));
            write(names.r, rotation);
            write(names.t, shift);
            storage << "image_width" << 1280 << "image_height" << 1024;
            storage << "projectorSize" << cv::Size(1024, 768);
            const ProcamCalibration result = parseCalibrationYaml(storage.releaseAndGetString(), "theirs.yml").result;
            const double tolerance = asFloat ? 1e-6 : 1e-12;
            for (std::size_t i = 0; i < kLensParameters; ++i) {
                EXPECT_NEAR(result.camera.lens[i], expected.camera.lens[i], tolerance * 2000) << names.k1 << i;
                EXPECT_NEAR(result.projector.lens[i], expected.projector.lens[i], tolerance * 2000) << names.k2 << i;
            }
            for (std::size_t i = 0; i < 6; ++i)
                EXPECT_NEAR(result.projectorFromCamera[i], rig[i], tolerance * 1000) << names.r;
            EXPECT_EQ(result.camera.size, cv::Size(1280, 1024));
            EXPECT_EQ(result.projector.size, cv::Size(1024, 768));
        }
}

/// As PyYAML and people write matrices.
TEST(CalibrationFile, MatricesInOtherStylesOfYamlAreRead) {
    const char* const kTexts[] = {
        "# by hand\ncamera_matrix: [[1000, 0, 320], [0, 1001., 240.5], [0, 0, 1]]\ndist_coeff: [[-0.1, 2e-2, 0, 0]]\n"
        "image_size: [640, 480]\n",
        "camera_matrix:\n- - 1000.0\n  - 0.0\n  - 320.0\n- - 0.0\n  - 1001\n  - 240.5\n- - 0\n  - 0\n  - 1\n"
        "dist_coeff:\n- - -0.1\n  - 0.02\n  - 0.0\n  - 0.0\nimage_width: 640\nimage_height: 480\n",
        "image_width: 640\r\nimage_height: 480\r\ncamera_name: 'narrow: stereo'\r\ncamera_matrix:\r\n  rows: 3\r\n"
        "  cols: 3\r\n  data: [1000, 0, 320,\r\n   0, 1001, 240.5,\r\n 0, 0, 1]\r\ndistortion_model: plumb_bob\r\n"
        "distortion_coefficients:\r\n  rows: 1\r\n  cols: 4\r\n  data: [-0.1, 0.02, 0, 0]\r\n",
    };
    for (const char* text : kTexts) {
        const CalibratedDevice camera = parseCalibrationYaml(text, "a.yaml").result.camera;
        EXPECT_EQ(camera.lens[kFocalLength], 1000.0) << text;
        EXPECT_NEAR(camera.lens[kFocalLength] * camera.lens[kAspect], 1001.0, 1e-9);
        EXPECT_EQ(camera.lens[kPrincipalY], 240.5);
        EXPECT_EQ(camera.lens[kK1], -0.1);
        EXPECT_EQ(camera.lens[kK2], 0.02);
        EXPECT_EQ(camera.size, cv::Size(640, 480));
    }
}

TEST(CalibrationFile, SizesThatAFileLacksCanBeGiven) {
    const char* const kText = "K: [1000, 0, 320, 0, 1000, 240, 0, 0, 1]\n";
    EXPECT_EQ(parseCalibrationYaml(kText, "a", {{640, 480}, {}}).result.camera.size, cv::Size(640, 480));
    try {
        (void)parseCalibrationYaml(kText, "a.yaml");
        ADD_FAILURE() << "its size is not known";
    } catch (const DataError& error) {
        EXPECT_THAT(error.what(), HasSubstr("camera_width"));
    }
}

std::string yamlRefusal(const std::string& text) {
    try {
        (void)parseCalibrationYaml(text, "bad.yaml");
    } catch (const DataError& error) {
        EXPECT_THAT(error.subject(), HasSubstr("bad.yaml"));
        EXPECT_FALSE(error.remedy().empty());
        return error.what();
    }
    return "read";
}

TEST(CalibrationFile, BrokenYamlIsRefusedWithItsLine) {
    const std::string sound = calibrationYaml(exampleRecord());
    const auto with = [&sound](const std::string& what, const std::string& by) {
        std::string text = sound;
        const auto at = text.find(what);
        EXPECT_NE(at, std::string::npos) << what;
        return text.replace(at, what.size(), by);
    };
    EXPECT_EQ(yamlRefusal(sound), "read");
    EXPECT_THAT(yamlRefusal(with("1890.125", ".Nan")), HasSubstr("line 12: '.Nan' is no number"));
    EXPECT_THAT(yamlRefusal(with("1890.125", "1e99")), HasSubstr("is no number"));
    EXPECT_THAT(yamlRefusal(with("1890.125", "-1890.125")), HasSubstr("focal lengths"));
    EXPECT_THAT(yamlRefusal(with("1890.125, 0.", "1890.125, 3.5")), HasSubstr("skew"));
    EXPECT_THAT(yamlRefusal(with("1890.125,", "")), HasSubstr("has 8 numbers, not 9"));
    EXPECT_THAT(yamlRefusal(with("rows: 3", "rows: 3000000000")), HasSubstr("is no number of rows"));
    EXPECT_THAT(yamlRefusal(with("cameraMatrix2", "cameraMatrix1")), HasSubstr("says again what line"));
    EXPECT_THAT(yamlRefusal(with("\nR:", "\nQ:")), HasSubstr("projector's place"));
    EXPECT_THAT(yamlRefusal(with("data: [ 1890.125", "data: [ [ 1890.125")), HasSubstr("line 15"));
    EXPECT_THAT(yamlRefusal(with("data: [ 1890.125", "data: ] 1890.125")), HasSubstr("not opened"));
    EXPECT_THAT(yamlRefusal(with("projector_width: 1024", "projector_width: -4")), HasSubstr("width and height"));
    EXPECT_THAT(yamlRefusal("nonsense\n"), HasSubstr("line 1"));
    EXPECT_THAT(yamlRefusal(""), HasSubstr("camera's matrix"));
    EXPECT_THAT(yamlRefusal(std::string(100'000, '[')), HasSubstr("line 1"));
    EXPECT_THAT(yamlRefusal("K: " + std::string(100'000, '[') + "\n"), HasSubstr("ends within a list"));
    std::string many = "K: [";
    for (int i = 0; i < 5000; ++i) many += "1, ";
    EXPECT_THAT(yamlRefusal(many + "]\n"), HasSubstr("more numbers than"));
    EXPECT_THAT(yamlRefusal("K: [1000, 0, 320, 0, 1000, 240, 0, 0, 1]\nD: [0, 0, 0, 0, 0, 0.1, 0, 0]\n"),
                HasSubstr("beyond k1"));
    std::string twisted = sound;
    const auto at = twisted.find("R: !!opencv-matrix");
    const auto data = twisted.find("[ ", at);
    twisted.replace(data, 3, "[ 9");
    EXPECT_THAT(yamlRefusal(twisted), HasSubstr("is no rotation"));
}

TEST(CalibrationFile, BrokenJsonIsRefusedWithItsKey) {
    using nlohmann::json;
    const json sound = json::parse(calibrationText(exampleRecord()));
    struct Case {
        const char* pointer;
        json value;
        const char* told;
    };
    const Case cases[] = {
        {"/lumorph", "project", "is no calibration of Lumorph"},
        {"/schemaVersion", 2, "newer Lumorph"},
        {"/schemaVersion", -1, "schemaVersion"},
        {"/camera", 7, "camera: is not an object"},
        {"/camera/K", json::array({1, 2}), "camera.K: is not three rows"},
        {"/camera/K/0/0", "x", "camera.K"},
        {"/camera/K/0/0", -5, "camera.K: has no focal lengths"},
        {"/camera/K/0/0", 1e300, "camera.K"},
        {"/camera/K/0/1", 7.0, "skew"},
        {"/camera/distortion", json::array({0, 0, 0, 0, 0, 1}), "beyond k1"},
        {"/camera/distortion/0", nullptr, "camera.distortion[0]"},
        {"/camera/size", json::array({-1, 5}), "camera.size"},
        {"/camera/size/0", 1.5, "camera.size"},
        {"/projector/size", json::array({1e8, 5}), "projector.size"},
        {"/R/0/0", 4.0, "R: is no rotation"},
        {"/T", json::array({1, 2}), "T: is not a list"},
        {"/views", 4, "views: is not a list"},
        {"/views/1/cameraRms", -1, "views[1].cameraRms"},
        {"/inputs", json::array({1}), "inputs"},
        {"/metresPerUnit", 0, "metresPerUnit"},
    };
    for (const Case& one : cases) {
        json broken = sound;
        broken[json::json_pointer(one.pointer)] = one.value;
        try {
            (void)parseCalibration(broken.dump(), "bad.json");
            ADD_FAILURE() << one.pointer;
        } catch (const DataError& error) {
            EXPECT_THAT(error.what(), HasSubstr(one.told)) << one.pointer;
            EXPECT_THAT(error.subject(), HasSubstr("bad.json"));
        }
    }
    for (const std::string& text : {std::string("{"), std::string("[]"), std::string(20'000'000, ' '),
                                    std::string(50, '[') + std::string(50, ']'), std::string("\xFF")})
        EXPECT_THROW((void)parseCalibration(text, "bad.json"), DataError);
    CalibrationRecord infinite = exampleRecord();
    infinite.result.camera.lens[kK1] = std::numeric_limits<double>::infinity();
    EXPECT_THROW((void)calibrationText(infinite), InvalidInput);
    EXPECT_THROW((void)calibrationYaml(infinite), InvalidInput);
}

/// Every cut and many changed bytes: read or refused, and never anything else.
TEST(CalibrationFile, DamagedFilesAreReadOrRefused) {
    std::mt19937 random(3);
    for (const bool yaml : {false, true}) {
        const std::string sound = yaml ? calibrationYaml(exampleRecord()) : calibrationText(exampleRecord());
        const auto isRefused = [yaml](const std::string& text) {
            try {
                const CalibrationRecord record = yaml ? parseCalibrationYaml(text, "a") : parseCalibration(text, "a");
                for (const double number : record.result.camera.lens) EXPECT_TRUE(std::isfinite(number));
                return false;
            } catch (const DataError&) {
                return true;
            }
        };
        int refused = 0;
        for (std::size_t length = 0; length + 1 < sound.size(); length += 7)
            refused += isRefused(sound.substr(0, length));
        EXPECT_GT(refused, static_cast<int>(sound.size() / 7 / 2));
        for (int i = 0; i < 3000; ++i) {
            std::string text = sound;
            for (int k = 0; k < 3; ++k) text[random() % text.size()] = static_cast<char>(random() % 256);
            refused += isRefused(text);
        }
        EXPECT_GT(refused, 500);
    }
}

TEST(CalibrationFile, IsWrittenWholeByItsEnding) {
    const TemporaryFolder folder;
    const CalibrationRecord record = exampleRecord();
    for (const char* name : {"a.json", "b.yaml", "c.YML"}) {
        writeCalibration(record, folder / name);
        expectSameFigures(record.result, readCalibration(folder / name).result);
    }
    EXPECT_THROW(writeCalibration(record, folder / "d.txt"), InvalidInput);
    EXPECT_THROW(writeCalibration(record, folder / "d.xml"), InvalidInput);
    EXPECT_THROW((void)readCalibration(folder / "d.pdf"), InvalidInput);
    EXPECT_THROW((void)readCalibration(folder / "d.xml"), Error);
    EXPECT_THROW((void)readCalibration(folder / "absent.json"), DataError);
    EXPECT_THROW(writeCalibration(record, folder / "no/such/a.json"), DeviceError);
    CalibrationRecord broken = record;
    broken.result.rms = std::nan("");
    EXPECT_THROW(writeCalibration(broken, folder / "a.json"), InvalidInput);
    expectSameFigures(record.result, readCalibration(folder / "a.json").result);
}

} // namespace
} // namespace lumorph::test
