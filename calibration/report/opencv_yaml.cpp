#include "calibration/report/opencv_yaml.h"

#include <charconv>
#include <cmath>
#include <vector>

#include <opencv2/calib3d.hpp>

#include "core/base/error.h"

namespace lumorph {

namespace {

std::string exactText(double number) {
    char text[40];
    const auto end = std::to_chars(text, text + sizeof text, number);
    std::string written(text, end.ptr);
    // OpenCV takes a number without a point for a whole one.
    if (written.find_first_of(".e") == std::string::npos) written += '.';
    return written;
}

void addMatrix(std::string& text, const char* key, int rows, const std::vector<double>& numbers) {
    text += std::string(key) + ": !!opencv-matrix\n   rows: " + std::to_string(rows) +
            "\n   cols: " + std::to_string(static_cast<int>(numbers.size()) / rows) + "\n   dt: d\n   data: [ ";
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        if (!std::isfinite(numbers[i]))
            throw InvalidInput("calibration", "holds a number that is not finite", "calibrate again");
        text += (i == 0 ? "" : i % 3 == 0 ? ",\n       " : ", ") + exactText(numbers[i]);
    }
    text += " ]\n";
}

void addDevice(std::string& text, const CalibratedDevice& device, const char* matrix, const char* distortion) {
    const Lens& lens = device.lens;
    addMatrix(text, matrix, 3,
              {lens[kFocalLength], 0.0, lens[kPrincipalX], 0.0, lens[kFocalLength] * lens[kAspect], lens[kPrincipalY],
               0.0, 0.0, 1.0});
    addMatrix(text, distortion, 1, {lens[kK1], lens[kK2], lens[kP1], lens[kP2], lens[kK3]});
}

/// A text in double quotes that no reader can misread.
std::string quotedWord(const std::string& word) {
    std::string text = "\"";
    for (const char c : word) text += c == '"' || c == '\\' || static_cast<unsigned char>(c) < 32 ? '?' : c;
    return text + "\"";
}

} // namespace

std::string calibrationYaml(const CalibrationRecord& record) {
    const ProcamCalibration& result = record.result;
    std::string text = "%YAML:1.0\n---\n";
    const auto number = [&text](const char* key, double value) {
        text += std::string(key) + ": " + exactText(value) + "\n";
    };
    const auto error = [&number](const char* key, double value) {
        if (std::isfinite(value) && whereSaid(value)) number(key, value);
    };
    const auto size = [&text](const char* device, cv::Size pixels) {
        text += std::string(device) + "_width: " + std::to_string(pixels.width) + "\n" + device +
                "_height: " + std::to_string(pixels.height) + "\n";
    };
    if (!record.source.date.empty()) text += "calibration_time: " + quotedWord(record.source.date) + "\n";
    if (!record.source.board.empty()) text += "board: " + quotedWord(record.source.board) + "\n";
    number("metres_per_unit", record.source.metresPerUnit);
    if (record.source.isSimulated) number("simulated", 1.0);
    if (!result.camera.size.empty()) size("image", result.camera.size);
    addDevice(text, result.camera, "cameraMatrix1", "distCoeffs1");
    error("camera_rms", result.camera.rms);
    if (result.projector.size.empty()) return text;
    size("projector", result.projector.size);
    addDevice(text, result.projector, "cameraMatrix2", "distCoeffs2");
    error("projector_rms", result.projector.rms);
    const PoseVector& rig = result.projectorFromCamera;
    cv::Matx33d rotation;
    cv::Rodrigues(cv::Vec3d(rig[0], rig[1], rig[2]), rotation);
    addMatrix(text, "R", 3, {rotation.val, rotation.val + 9});
    addMatrix(text, "T", 3, {rig[3], rig[4], rig[5]});
    error("rms", result.rms);
    return text;
}

CalibrationRecord parseCalibrationYaml(std::string_view text, const std::string& name, const KnownSizes& sizes) {
    return parseForeignCalibration(text, name, sizes);
}

} // namespace lumorph
