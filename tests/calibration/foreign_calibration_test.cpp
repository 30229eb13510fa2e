#include "calibration/report/foreign_calibration.h"

#include <cmath>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>

#include "calibration/report/calibrated_room.h"
#include "calibration/report/calibration_file.h"
#include "core/base/error.h"
#include "tests/core/temporary_folder.h"

// Calibrations as other programs write them, by the formats' public descriptions.

namespace lumorph::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// The figures that all texts here have.
constexpr double kFx = 1180.5, kFy = 1181.0, kCx = 642.25, kCy = 478.75;
constexpr double kProjectorF = 1700.0;

void expectCamera(const CalibratedDevice& camera, const std::string& what) {
    EXPECT_EQ(camera.lens[kFocalLength], kFx) << what;
    EXPECT_NEAR(camera.lens[kFocalLength] * camera.lens[kAspect], kFy, 1e-9) << what;
    EXPECT_EQ(camera.lens[kPrincipalX], kCx) << what;
    EXPECT_EQ(camera.lens[kPrincipalY], kCy) << what;
    EXPECT_EQ(camera.lens[kK1], -0.31) << what;
    EXPECT_EQ(camera.lens[kK2], 0.12) << what;
    EXPECT_EQ(camera.lens[kP1], 0.001) << what;
    EXPECT_EQ(camera.lens[kP2], -0.0005) << what;
}

void expectRig(const ProcamCalibration& result, const std::string& what) {
    EXPECT_EQ(result.projector.lens[kFocalLength], kProjectorF) << what;
    EXPECT_EQ(result.projector.lens[kPrincipalX], 960.0) << what;
    EXPECT_EQ(result.projector.lens[kPrincipalY], 900.0) << what;
    // A turn by 0.1 about y, and T.
    const PoseVector expected{0.0, 0.1, 0.0, -210.0, 12.0, 35.0};
    for (std::size_t i = 0; i < expected.size(); ++i)
        EXPECT_NEAR(result.projectorFromCamera[i], expected[i], 1e-6) << what << i;
}

std::string xmlMatrix(const std::string& key, int rows, int columns, const std::string& data) {
    return "<" + key + " type_id=\"opencv-matrix\">\n  <rows>" + std::to_string(rows) + "</rows>\n  <cols>" +
           std::to_string(columns) + "</cols>\n  <dt>d</dt>\n  <data>\n    " + data + "</data></" + key + ">\n";
}

const std::string kCameraData = "1180.5 0. 642.25 0. 1181. 478.75 0. 0. 1.";
const std::string kProjectorData = "1.7e+03 0. 960. 0. 1700. 900. 0. 0. 1.";
const std::string kTermData = "-0.31 0.12 0.001 -0.0005 0.";
const std::string kTurnData = "0.9950041652780258 0. 0.09983341664682815 0. 1. 0. -0.09983341664682815 0. "
                              "0.9950041652780258";

std::string xml(const std::string& inner) {
    return "<?xml version=\"1.0\"?>\n<!-- by hand -->\n<opencv_storage>\n" + inner + "</opencv_storage>\n";
}

TEST(ForeignCalibration, SlStudioIsReadWithItsSizesAndErrors) {
    const std::string text =
        xml(xmlMatrix("Kc", 3, 3, kCameraData) + xmlMatrix("kc", 1, 5, kTermData) +
            xmlMatrix("Kp", 3, 3, kProjectorData) + xmlMatrix("kp", 1, 5, "0. 0. 0. 0. 0.") +
            xmlMatrix("Rp", 3, 3, kTurnData) + xmlMatrix("Tp", 3, 1, "-210. 12. 35.") +
            "<cam_error>2.5e-01</cam_error>\n<proj_error>0.5</proj_error>\n<stereo_error>0.75</stereo_error>\n"
            "<frameWidth>1280</frameWidth>\n<frameHeight>960</frameHeight>\n<screenResX>1920</screenResX>\n"
            "<screenResY>1080</screenResY>\n");
    const CalibrationRecord record = parseForeignCalibration(text, "calibration.xml");
    const ProcamCalibration& result = record.result;
    expectCamera(result.camera, "SLStudio");
    expectRig(result, "SLStudio");
    EXPECT_EQ(result.camera.size, cv::Size(1280, 960));
    EXPECT_EQ(result.projector.size, cv::Size(1920, 1080));
    EXPECT_EQ(result.camera.rms, 0.25);
    EXPECT_EQ(result.projector.rms, 0.5);
    EXPECT_EQ(result.rms, 0.75);
    EXPECT_EQ(record.source.metresPerUnit, 0.001);
    EXPECT_TRUE(result.warnings.empty());
}

TEST(ForeignCalibration, ProcamCalibrationIsReadThoughItSaysNoSizeOfTheProjector) {
    const std::string text =
        xml(xmlMatrix("img_shape", 2, 1, "960. 1280.") + "<rms>4.5e-01</rms>\n" +
            xmlMatrix("cam_int", 3, 3, kCameraData) + xmlMatrix("cam_dist", 1, 5, kTermData) +
            xmlMatrix("proj_int", 3, 3, kProjectorData) + xmlMatrix("proj_dist", 1, 5, "0. 0. 0. 0. 0.") +
            xmlMatrix("rotation", 3, 3, kTurnData) + xmlMatrix("translation", 3, 1, "-210. 12. 35."));
    const ProcamCalibration result = parseForeignCalibration(text, "result.xml", {{}, {1920, 1080}}).result;
    expectCamera(result.camera, "procam-calibration");
    expectRig(result, "procam-calibration");
    EXPECT_EQ(result.camera.size, cv::Size(1280, 960)) << "rows come first in NumPy";
    EXPECT_EQ(result.projector.size, cv::Size(1920, 1080));
    EXPECT_EQ(result.rms, 0.45);
    EXPECT_EQ(whereSaid(result.camera.rms), std::nullopt) << "it says nothing of each";
    EXPECT_THROW((void)parseForeignCalibration(text, "result.xml"), DataError) << "no size is known";
}

TEST(ForeignCalibration, NodesOfTheirOwnAreReadInAllThreeSyntaxes) {
    const std::string yaml = "calibration:\n  camera:\n    K: [[1180.5, 0, 642.25], [0, 1181.0, 478.75], [0, 0, 1]]\n"
                             "    distortion: [-0.31, 0.12, 0.001, -0.0005, 0]\n    size: [1280, 960]\n"
                             "  projector:\n    K:\n    - [1700, 0, 960]   # a row\n    - [0, 1700, 900]\n"
                             "    - [0, 0, 1]\n    dist: [0, 0, 0, 0, 0]\n    width: 1920\n    height: 1080\n"
                             "  stereo: {R: [0, 0.1, 0], T: [-210, 12, 35]}\n";
    const std::string json = R"({"note": "a \"quoted, [text]", "camera": {"matrix": {"type_id": "opencv-matrix",
        "rows": 3, "cols": 3, "dt": "d", "data": [1180.5, 0.0, 642.25, 0.0, 1181.0, 478.75, 0.0, 0.0, 1.0]},
        "coeffs": [-0.31, 0.12, 0.001, -0.0005, 0.0], "resolution": [1280, 960]},
        "projector": {"intrinsics": [1700, 1700, 960, 900], "size": [1920, 1080]},
        "R": [[0.9950041652780258, 0, 0.09983341664682815], [0, 1, 0], [-0.09983341664682815, 0, 0.9950041652780258]],
        "T": [[-210], [12], [35]]})";
    const std::string tree = xml("<camera>" + xmlMatrix("K", 3, 3, kCameraData) + xmlMatrix("dist", 1, 5, kTermData) +
                                 "<size>1280 960</size></camera><projector>" + xmlMatrix("K", 3, 3, kProjectorData) +
                                 "<size>1920 1080</size></projector><extrinsics>" + xmlMatrix("R", 3, 3, kTurnData) +
                                 xmlMatrix("T", 3, 1, "-210. 12. 35.") + "</extrinsics>");
    for (const std::string& text : {yaml, json, tree}) {
        const ProcamCalibration result = parseForeignCalibration(text, "nested").result;
        expectCamera(result.camera, text);
        expectRig(result, text);
        EXPECT_EQ(result.camera.size, cv::Size(1280, 960)) << text;
        EXPECT_EQ(result.projector.size, cv::Size(1920, 1080)) << text;
        EXPECT_TRUE(result.warnings.empty()) << text;
    }
}

TEST(ForeignCalibration, RosIsReadAsFileMessageAndEcho) {
    const std::string file =
        "image_width: 1280\nimage_height: 960\ncamera_name: head: left\ncamera_matrix:\n  rows: 3\n"
        "  cols: 3\n  data: [1180.5, 0, 642.25, 0, 1181.0, 478.75, 0, 0, 1]\n"
        "distortion_model: plumb_bob\ndistortion_coefficients:\n  rows: 1\n  cols: 5\n"
        "  data: [-0.31, 0.12, 0.001, -0.0005, 0]\nrectification_matrix:\n  rows: 3\n  cols: 3\n"
        "  data: [1, 0, 0, 0, 1, 0, 0, 0, 1]\nprojection_matrix:\n  rows: 3\n  cols: 4\n"
        "  data: [1100, 0, 642, 0, 0, 1100, 478, 0, 0, 0, 1, 0]\n";
    const auto message = [](bool isSecond) {
        const std::string k = isSecond ? "k" : "K", d = isSecond ? "d" : "D", r = isSecond ? "r" : "R";
        return "header:\n  stamp:\n    sec: 7\n    nanosec: 9\n  frame_id: ''\nheight: 960\nwidth: 1280\n"
               "distortion_model: \"plumb_bob\"\n" +
               d + ": [-0.31, 0.12, 0.001, -0.0005, 0.0]\n" + k +
               ": [1180.5, 0.0, 642.25, 0.0, 1181.0, 478.75, 0.0, 0.0, 1.0]\n" + r +
               ": [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]\nbinning_x: 0\nroi:\n  x_offset: 0\n  height: 0\n"
               "  width: 0\n  do_rectify: false\n---\n";
    };
    std::string listed = "height: 960\nwidth: 1280\ndistortion_model: plumb_bob\nd:\n- -0.31\n- 0.12\n- 0.001\n"
                         "- -0.0005\n- 0.0\nk:\n";
    for (const char* number : {"1180.5", "0.0", "642.25", "0.0", "1181.0", "478.75", "0.0", "0.0", "1.0"})
        listed += std::string("- ") + number + "\n";
    for (const std::string& text : {file, message(false), message(true), message(false) + message(false), listed}) {
        const ProcamCalibration result = parseForeignCalibration(text, "ros.yaml").result;
        expectCamera(result.camera, text);
        EXPECT_EQ(result.camera.size, cv::Size(1280, 960)) << text;
        EXPECT_TRUE(result.projector.size.empty()) << text;
        EXPECT_TRUE(result.warnings.empty()) << text;
    }
    std::string other = message(false);
    other.replace(other.find("1180.5"), 6, "1190.5");
    const ProcamCalibration two = parseForeignCalibration(message(false) + other, "ros.yaml").result;
    expectCamera(two.camera, "the first of two");
    ASSERT_EQ(two.warnings.size(), 1U);
    EXPECT_EQ(two.warnings[0].cause, Cause::passedOver);
    EXPECT_THAT(two.warnings[0].file, HasSubstr("ros.yaml, line 28"));
}

TEST(ForeignCalibration, KalibrCamchainIsReadAndItsFurtherCamerasAreNamed) {
    const auto chain = [](const std::string& topic) {
        return "cam0:\n  cam_overlaps: [1]\n  camera_model: pinhole\n"
               "  distortion_coeffs: [-0.31, 0.12, 0.001, -0.0005]\n  distortion_model: radtan\n"
               "  intrinsics: [1180.5, 1181.0, 642.25, 478.75]\n  resolution: [1280, 960]\n  rostopic: "
               "/cam0/image_raw\n"
               "cam1:\n  T_cn_cnm1:\n  - [0.9950041652780258, 0.0, 0.09983341664682815, -0.21]\n"
               "  - [0.0, 1.0, 0.0, 0.012]\n  - [-0.09983341664682815, 0.0, 0.9950041652780258, 0.035]\n"
               "  - [0.0, 0.0, 0.0, 1.0]\n  cam_overlaps: [0]\n  camera_model: pinhole\n"
               "  distortion_coeffs: [0.0, 0.0, 0.0, 0.0]\n  distortion_model: radtan\n"
               "  intrinsics: [1700.0, 1700.0, 960.0, 900.0]\n  resolution: [1920, 1080]\n  rostopic: " +
               topic + "\n";
    };
    const ProcamCalibration cameras = parseForeignCalibration(chain("/cam1/image_raw"), "camchain.yaml").result;
    expectCamera(cameras.camera, "Kalibr");
    EXPECT_EQ(cameras.camera.size, cv::Size(1280, 960));
    EXPECT_TRUE(cameras.projector.size.empty()) << "another camera is no projector";
    ASSERT_EQ(cameras.warnings.size(), 1U);
    EXPECT_EQ(cameras.warnings[0].cause, Cause::passedOver);
    EXPECT_THAT(cameras.warnings[0].why, HasSubstr("'cam1'"));
    const CalibrationRecord both = parseForeignCalibration(chain("/projector/image"), "camchain.yaml");
    EXPECT_EQ(both.source.metresPerUnit, 1.0);
    expectRig(inMillimetres(both).result, "Kalibr's metres");
    // Each of a chain is placed by the one before it: a projector elsewhere would be put in a wrong place.
    std::string first = chain("/cam1/image_raw");
    first.replace(first.find("/cam0/"), 6, "/projector/");
    std::string third = chain("/cam1/image_raw");
    third += "cam2" + chain("/projector/image").substr(third.find("cam1") + 4);
    for (const std::string& text : {first, third}) {
        try {
            (void)parseForeignCalibration(text, "camchain.yaml");
            ADD_FAILURE() << text;
        } catch (const DataError& error) {
            EXPECT_THAT(error.what(), HasSubstr("second of the chain"));
        }
    }
}

TEST(ForeignCalibration, ErrorsThatAreNoNumbersAreUnknown) {
    for (const char* rms : {".Nan", "n/a", "-1", "[0.1, 0.2]"})
        for (const char* simulated : {"false", "0", "true"}) {
            const CalibrationRecord record = parseForeignCalibration(
                "image_width: 1280\nimage_height: 960\nrms: " + std::string(rms) + "\nsimulated: " + simulated +
                    "\nK: [1180.5, 0, 642.25, 0, 1181, 478.75, 0, 0, 1]\nD: [0, 0, 0, 0, 0]\n",
                "lens.yaml");
            EXPECT_EQ(record.result.rms, 0.0) << rms;
            EXPECT_EQ(record.source.isSimulated, std::string(simulated) == "true");
        }
}

std::string refusedModel(const std::string& text) {
    try {
        (void)parseForeignCalibration(text, "lens.yaml", {{1280, 960}, {}});
    } catch (const CaptureRefused& refused) {
        EXPECT_EQ(refused.finding().cause, Cause::lensModel);
        EXPECT_THAT(refused.finding().file, HasSubstr("lens.yaml, line "));
        return refused.finding().why;
    }
    return "read";
}

TEST(ForeignCalibration, FisheyesAreRefusedByTheirName) {
    const std::string matrix = "K: [1180.5, 0, 642.25, 0, 1181, 478.75, 0, 0, 1]\n";
    const std::string terms = "D: [-0.012, 0.004, 0.0021, -0.0009]\n";
    for (const char* name : {"equidistant", "fisheye", "kannala_brandt", "KANNALA_BRANDT4", "fov", "Kannala-Brandt"})
        EXPECT_THAT(refusedModel(matrix + "distortion_model: " + name + "\n" + terms),
                    HasSubstr("'" + std::string(name) + "'"));
    EXPECT_THAT(refusedModel(matrix + terms + "fisheye_model: 1\n"), HasSubstr("OpenCV's fisheye"));
    EXPECT_THAT(refusedModel("camera:\n  model: omni\n  " + matrix + "  " + terms), HasSubstr("'omni'"));
    EXPECT_THAT(refusedModel("cam0:\n  camera_model: pinhole\n  distortion_model: equidistant\n"
                             "  intrinsics: [1180.5, 1181, 642.25, 478.75]\n"
                             "  distortion_coeffs: [-0.01, 0.004, 0.002, -0.0009]\n"),
                HasSubstr("'equidistant'"));
    EXPECT_THAT(refusedModel(matrix + "distortion_model: lattice\n"), HasSubstr("'lattice'"));
    EXPECT_THAT(refusedModel(matrix + "D: [0, 0, 0, 0, 0, 0.1, 0, 0]\n"), HasSubstr("beyond k1"));
    for (const char* sound : {"distortion_model: plumb_bob\n", "distortion_model: rational_polynomial\n",
                              "fisheye_model: 0\ndistortion_model: radtan\n", "camera_model: Canon EOS\n"})
        EXPECT_EQ(refusedModel(matrix + sound + terms), "read") << sound;
}

TEST(ForeignCalibration, FourTermsWithoutAModelAreReadAndSaid) {
    const std::string text = "K: [1180.5, 0, 642.25, 0, 1181, 478.75, 0, 0, 1]\nD: [-0.31, 0.12, 0.001, -0.0005]\n"
                             "image_size: [1280, 960]\n";
    const ProcamCalibration result = parseForeignCalibration(text, "a.yaml").result;
    expectCamera(result.camera, "unnamed");
    ASSERT_EQ(result.warnings.size(), 1U);
    EXPECT_EQ(result.warnings[0].cause, Cause::lensModel);
    EXPECT_THAT(result.warnings[0].why, HasSubstr("is not named"));
}

std::string procamYaml(const std::string& more, const std::string& shift) {
    return "cameraMatrix1: [1180.5, 0, 642.25, 0, 1181, 478.75, 0, 0, 1]\n"
           "distCoeffs1: [-0.31, 0.12, 0.001, -0.0005, 0]\n"
           "cameraMatrix2: [1700, 0, 960, 0, 1700, 900, 0, 0, 1]\nR: [0, 0.1, 0]\nT: [" +
           shift + "]\nprojector_size: [1920, 1080]\n" + more;
}

TEST(ForeignCalibration, LengthsAreTakenInTheirUnit) {
    const auto recordOf = [](const std::string& more, const std::string& shift) {
        return inMillimetres(parseForeignCalibration(procamYaml(more + "image_size: [1280, 960]\n", shift), "u.yaml"));
    };
    EXPECT_TRUE(recordOf("", "-210, 12, 35").result.warnings.empty());
    expectRig(recordOf("", "-210, 12, 35").result, "millimetres, as usual");
    expectRig(recordOf("metres_per_unit: 1\n", "-0.21, 0.012, 0.035").result, "metres, said");
    expectRig(recordOf("metres_per_unit: 0.01\n", "-21, 1.2, 3.5").result, "centimetres, said");
    const CalibrationRecord guessed = recordOf("", "-0.21, 0.012, 0.035");
    expectRig(guessed.result, "metres, since no camera stands a fifth of a millimetre from its projector");
    ASSERT_EQ(guessed.result.warnings.size(), 1U);
    EXPECT_EQ(guessed.result.warnings[0].cause, Cause::unlikelyLength);
    EXPECT_THAT(guessed.result.warnings[0].why, HasSubstr("0.213"));
}

TEST(ForeignCalibration, SizesThatContradictTheMatrixAreSaidWithBothNumbers) {
    const auto warningsOf = [](const std::string& size, const std::string& more = "") {
        return parseForeignCalibration(procamYaml("image_size: " + size + "\n" + more, "-210, 12, 35"), "s.yaml")
            .result.warnings;
    };
    EXPECT_TRUE(warningsOf("[1280, 960]").empty());
    for (const char* size : {"[640, 480]", "[700, 520]", "[2560, 1920]"}) {
        const std::vector<Finding> warnings = warningsOf(size);
        ASSERT_EQ(warnings.size(), 1U) << size;
        EXPECT_EQ(warnings[0].cause, Cause::imageSize);
        EXPECT_THAT(warnings[0].why, HasSubstr("column 642."));
    }
    EXPECT_THAT(warningsOf("[640, 480]")[0].why, HasSubstr("640 x 480"));
    // A projector's lens shift puts its centre near the picture's edge, or outside, and is no contradiction.
    std::string half = procamYaml("image_size: [1280, 960]\n", "-210, 12, 35");
    half.replace(half.find("[1920, 1080]"), 12, "[800, 600]");
    const std::vector<Finding> projector = parseForeignCalibration(half, "s.yaml").result.warnings;
    ASSERT_EQ(projector.size(), 1U);
    EXPECT_EQ(projector[0].cause, Cause::projectorSize);
    EXPECT_THAT(projector[0].why, HasSubstr("column 960.0"));
}

TEST(ForeignCalibration, CameraOfAProjectorNeedsNoSize) {
    const std::string text = procamYaml("", "-210, 12, 35");
    const CalibrationRecord record = parseForeignCalibration(text, "p.yaml");
    EXPECT_TRUE(record.result.camera.size.empty());
    expectRig(record.result, "without the camera's size");
    // It stays unknown when it is written and read again.
    EXPECT_TRUE(parseCalibration(calibrationText(record), "p.json").result.camera.size.empty());
    const std::string again = calibrationText(record);
    for (const char* key : {"\"rms\"", "\"sigma\""}) EXPECT_EQ(again.find(key), std::string::npos) << key;
    EXPECT_TRUE(parseForeignCalibration(calibrationYaml(record), "p.yaml").result.camera.size.empty());
}

TEST(ForeignCalibration, BrokenTextsAreRefusedWithTheirLine) {
    const std::pair<std::string, const char*> wrong[] = {
        {"<?xml version=\"1.0\"?>\n<a>\n<b>1</c></a>", "line 3: closes another element than 'b'"},
        {"<?xml version=\"1.0\"?>\n<K>1 2</Kx>", "line 2: closes another element than 'K'"},
        {"<a>\n<b>", "ends within 'b'"},
        {"<!DOCTYPE a [<!ENTITY e \"x\">]>\n<a/>", "declares entities"},
        {"<a/>", "camera's matrix"},
        {std::string("<a>") +
             [] {
                 std::string deep;
                 for (int i = 0; i < 500; ++i) deep += "<a>";
                 return deep;
             }(),
         "nests deeper"},
        {"{\"K\": [1, 2", "JSON"},
        {xml(xmlMatrix("Kc", 3, 3, "1180.5 0 x 0 1181 478.75 0 0 1")), "'x' is no number"},
        {xml(xmlMatrix("Kc", 3, 3, "1180.5 0 642")), "has 3 numbers, not 9"},
        {"a:\n  b:\n   c\n- d\nK [\n", "line 5"},
    };
    for (const auto& [text, told] : wrong) {
        try {
            (void)parseForeignCalibration(text, "bad");
            ADD_FAILURE() << text.substr(0, 80);
        } catch (const DataError& error) {
            EXPECT_THAT(error.what(), HasSubstr(told)) << text.substr(0, 80);
        }
    }
}

TEST(ForeignCalibration, FilesAreReadByWhatIsInThem) {
    const TemporaryFolder folder;
    const std::string slStudio = xml(xmlMatrix("Kc", 3, 3, kCameraData) + xmlMatrix("kc", 1, 5, kTermData) +
                                     "<frameWidth>1280</frameWidth><frameHeight>960</frameHeight>");
    for (const char* name : {"a.xml", "b.XML", "c.yaml", "d.txt", "e.json"}) {
        std::ofstream(folder / name) << slStudio;
        expectCamera(readCalibration(folder / name).result.camera, name);
    }
}

/// Ours, as from the virtual lab: the device's projector 2 m above the table.
CalibrationRecord roomRecord(double metresPerUnit) {
    const Installation room = defaultInstallation();
    const CalibratedCamera& projector = room.projectors.front().camera;
    CalibrationRecord record;
    record.source.metresPerUnit = metresPerUnit;
    record.source.board = metresPerUnit == 1.0 ? "chess:9x7:0.025" : "chess:9x7:25";
    ProcamCalibration& result = record.result;
    result.projector.size = {projector.size.x, projector.size.y};
    result.projector.lens = {projector.focal.x,       projector.focal.y / projector.focal.x,
                             projector.principal.x,   projector.principal.y,
                             projector.distortion[0], projector.distortion[1],
                             projector.distortion[2], projector.distortion[3],
                             projector.distortion[4]};
    result.camera = result.projector;
    // The camera stands 300 mm beside the projector and looks the same way; the board lies on the table.
    result.projectorFromCamera = {0.0, 0.0, 0.0, 0.3 / metresPerUnit, 0.0, 0.0};
    glm::dmat4 worldFromBoard(1.0);
    worldFromBoard[1] = {0.0, 0.0, 1.0, 0.0};
    worldFromBoard[2] = {0.0, -1.0, 0.0, 0.0};
    worldFromBoard[3] = {-0.1, 0.0, -0.075, 1.0}; // its middle at the world's origin
    const glm::dmat4 projectorFromBoard = projector.cameraFromWorld * worldFromBoard;
    cv::Matx33d turn;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) turn(row, column) = projectorFromBoard[column][row];
    cv::Vec3d vector;
    cv::Rodrigues(turn, vector);
    const glm::dvec3 shift = (glm::dvec3(projectorFromBoard[3]) - glm::dvec3(0.3, 0.0, 0.0)) / metresPerUnit;
    result.views = {{"flat", 0.1, 0.1, 0.4}};
    result.state.cameraFromBoard = {{vector[0], vector[1], vector[2], shift.x, shift.y, shift.z}};
    return record;
}

TEST(ForeignCalibration, FilesInMetresPutTheProjectorWhereThoseInMillimetresDo) {
    const Installation believed = defaultInstallation();
    const glm::dvec3 truth = positionOf(believed.projectors.front().camera);
    std::vector<double> within;
    for (const double unit : {0.001, 1.0, 0.01}) {
        const std::string text = calibrationText(roomRecord(unit));
        const CalibrationRecord record = inMillimetres(parseCalibration(text, "room.json"));
        EXPECT_EQ(record.source.board, unit == 0.01 ? "chess:9x7:250" : "chess:9x7:25") << unit;
        const Installation room = withImport(believed, record.result, parseCalibrationBoard("chess:9x7:25"));
        const glm::dvec3 at = positionOf(room.projectors.front().camera);
        EXPECT_LT(glm::length(at - truth), 1e-6) << unit;
        ASSERT_TRUE(heldOutMillimetresOf(record.result)) << unit;
        within.push_back(*heldOutMillimetresOf(record.result));
        EXPECT_TRUE(hasSameFigures(room, believed, true, 0)) << unit;
    }
    // 0.4 pixels at the board's distance by the focal length, 95 of 100.
    const PoseVector pose = roomRecord(0.001).result.state.cameraFromBoard[0];
    const double expected =
        1.731 * 0.4 * std::hypot(pose[3], pose[4], pose[5]) / believed.projectors.front().camera.focal.x;
    for (const double one : within) EXPECT_NEAR(one, expected, 1e-9);
}

TEST(ForeignCalibration, LensesAloneMoveNothingInTheRoom) {
    const Installation before = defaultInstallation();
    const ProcamCalibration both =
        parseForeignCalibration(procamYaml("image_size: [1280, 960]\n", "-210, 12, 35"), "p.yaml").result;
    const Installation after = withImport(before, both, {});
    EXPECT_EQ(after.projectors[0].camera.focal.x, kProjectorF);
    EXPECT_EQ(after.projectors[0].camera.cameraFromWorld, before.projectors[0].camera.cameraFromWorld);
    EXPECT_EQ(after.projectors[0].lens.method, "read from a file");
    EXPECT_EQ(after.projectors[0].pose, before.projectors[0].pose);
    EXPECT_EQ(after.cameras.size(), before.cameras.size()) << "nothing says where it stands";
    EXPECT_FALSE(hasSameFigures(before, after, true, 0));
    EXPECT_TRUE(hasSameFigures(after, withImport(after, both, {}), true, 0));
    ProcamCalibration alone = both;
    alone.projector = {};
    const Installation seen = withImport(before, alone, {});
    EXPECT_EQ(seen.projectors, before.projectors);
    ASSERT_EQ(seen.cameras.size(), 1U);
    EXPECT_EQ(seen.cameras[0].camera.focal.x, kFx);
}

/// The small inputs that were read wrongly, where they are there.
TEST(ForeignCalibration, SharedCasesGiveTheirRightValues) {
    const fs::path cases = fs::path(LUMORPH_SHARED_DIR) / "data/cases/import";
    if (!fs::exists(cases)) GTEST_SKIP() << "without ../shared/data/cases";
    for (const char* name : {"mm.json", "metres-otherdate.json"}) {
        const CalibrationRecord record = inMillimetres(readCalibration(cases / name));
        const Installation room =
            withImport(defaultInstallation(), record.result, parseCalibrationBoard(record.source.board));
        const glm::dvec3 at = positionOf(room.projectors.front().camera);
        EXPECT_LT(glm::length(at - glm::dvec3(0.0, 1.996, 0.399)), 0.001) << name << at.x << " " << at.y << " " << at.z;
        ASSERT_TRUE(heldOutMillimetresOf(record.result));
        EXPECT_NEAR(*heldOutMillimetresOf(record.result), 0.13, 0.005) << name;
    }
    try {
        (void)readCalibration(cases / "ros-equidistant.yaml");
        ADD_FAILURE() << "a fisheye is read";
    } catch (const CaptureRefused& refused) {
        EXPECT_EQ(refused.finding().cause, Cause::lensModel);
        EXPECT_THAT(refused.finding().why, HasSubstr("equidistant"));
    }
    const ProcamCalibration half = readCalibration(cases / "size-half.yaml").result;
    ASSERT_EQ(half.warnings.size(), 1U);
    EXPECT_EQ(half.warnings[0].cause, Cause::imageSize);
    EXPECT_THAT(half.warnings[0].why, HasSubstr("642.2"));
    EXPECT_THAT(half.warnings[0].why, HasSubstr("640 x 480"));
}

} // namespace
} // namespace lumorph::test
