#include "app/cli/calibrate_output.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include "calibration/report/calibration_record.h"
#include "core/base/error.h"

namespace lumorph::cli {

nlohmann::json jsonOf(const Finding& finding) {
    const auto orNull = [](const std::string& text) { return text.empty() ? nlohmann::json() : nlohmann::json(text); };
    return {{"cause", std::string(keyOf(finding.cause))},
            {"view", orNull(finding.view)},
            {"file", orNull(finding.file)},
            {"sentence", sentenceOf(finding)}};
}

nlohmann::json jsonOf(const std::optional<double>& number) {
    return number ? nlohmann::json(*number) : nlohmann::json();
}

nlohmann::json jsonOf(const CalibratedDevice& device) {
    const Lens& lens = device.lens;
    const Lens& sigma = device.sigma;
    const double fy = lens[kFocalLength] * lens[kAspect];
    const double fySigma = std::hypot(sigma[kFocalLength] * lens[kAspect], lens[kFocalLength] * sigma[kAspect]);
    const bool hasSigma = std::ranges::any_of(sigma, [](double one) { return one != 0.0; });
    nlohmann::json all = {
        {"K", {{lens[kFocalLength], 0.0, lens[kPrincipalX]}, {0.0, fy, lens[kPrincipalY]}, {0.0, 0.0, 1.0}}},
        {"distortion", {lens[kK1], lens[kK2], lens[kP1], lens[kP2], lens[kK3]}},
        {"size", {device.size.width, device.size.height}},
        {"rms", jsonOf(whereSaid(device.rms))},
        {"model", device.model},
        {"sigma",
         {{"fx", sigma[kFocalLength]},
          {"fy", fySigma},
          {"cx", sigma[kPrincipalX]},
          {"cy", sigma[kPrincipalY]},
          {"k1", sigma[kK1]},
          {"k2", sigma[kK2]},
          {"p1", sigma[kP1]},
          {"p2", sigma[kP2]},
          {"k3", sigma[kK3]}}}};
    // Of a file of another program, what it does not say.
    if (!hasSigma) all["sigma"] = nullptr;
    if (device.size.empty()) all["size"] = nullptr;
    return all;
}

nlohmann::json jsonOf(const std::vector<Finding>& findings) {
    nlohmann::json all = nlohmann::json::array();
    for (const Finding& finding : findings) all.push_back(jsonOf(finding));
    return all;
}

nlohmann::json rotationOf(const PoseVector& pose) {
    const glm::dmat3 rotation = Rigid::exp(pose).rotation;
    nlohmann::json rows = nlohmann::json::array();
    for (int row = 0; row < 3; ++row) rows.push_back({rotation[0][row], rotation[1][row], rotation[2][row]});
    return rows;
}

nlohmann::json poseSigmaOf(const PoseVector& sigma) {
    return {
        {"rotationDegrees", {kDegreesPerRadian * sigma[0], kDegreesPerRadian * sigma[1], kDegreesPerRadian * sigma[2]}},
        {"T", {sigma[3], sigma[4], sigma[5]}}};
}

nlohmann::json jsonOf(const ProcamCalibration& result) {
    const PoseVector& rig = result.projectorFromCamera;
    const PoseVector& sigma = result.projectorFromCameraSigma;
    nlohmann::json views = nlohmann::json::array();
    for (const ViewQuality& view : result.views)
        views.push_back({{"name", view.name},
                         {"cameraRms", view.cameraRms},
                         {"projectorRms", view.projectorRms},
                         {"heldOutTransfer", jsonOf(view.heldOut)}});
    return {{"camera", jsonOf(result.camera)},
            {"projector", jsonOf(result.projector)},
            {"R", rotationOf(rig)},
            {"T", {rig[3], rig[4], rig[5]}},
            {"sigma", poseSigmaOf(sigma)},
            {"rms", result.rms},
            {"views", views},
            {"worstView", result.worstView},
            {"halvesDiffer", jsonOf(result.halvesDiffer)},
            {"halvesAllowed", jsonOf(result.halvesAllowed)},
            {"model", "camera: " + result.camera.model + "; projector: " + result.projector.model},
            {"warnings", jsonOf(result.warnings)},
            {"degenerate", result.degenerate}};
}

void LabApply::addTo(CLI::App& command, const char* what) {
    command.add_flag("--apply", apply, what);
    command.add_flag("--simulated", simulated,
                     "Apply it also where the room holds something measured or entered; it stays marked as simulated");
}

void LabApply::checkProject(const std::string& project) const {
    if (apply && project.starts_with("resource:"))
        throw InvalidInput("--apply", "a bundled project cannot be written", "copy it first");
}

void LabApply::checkRoom(const std::string& project, const Installation& room) const {
    if (!apply || simulated) return;
    const std::vector<std::string> real = realParts(room);
    if (real.empty()) return;
    constexpr std::size_t kNamed = 3;
    std::string names;
    for (std::size_t i = 0; i < std::min(real.size(), kNamed); ++i) names += (i > 0 ? ", " : "") + real[i];
    if (real.size() > kNamed) names += ", ...";
    throw InvalidInput("--apply " + project,
                       "its room holds what was measured or entered (" + names +
                           "), and what the virtual lab makes is simulated",
                       "add --simulated to apply it all the same, marked as simulated");
}

void printDevice(const char* name, const CalibratedDevice& device) {
    const Lens& lens = device.lens;
    const Lens& sigma = device.sigma;
    const auto figure = [](double value, double uncertainty, const char* format) {
        std::array<char, 80> text{};
        const int length = std::snprintf(text.data(), text.size(), format, value);
        const auto rest = text.size() - static_cast<std::size_t>(length);
        if (whereSaid(uncertainty)) std::snprintf(text.data() + length, rest, " +- %.2f", uncertainty);
        return std::string(text.data());
    };
    const std::string size = device.size.empty()
                                 ? "size unknown"
                                 : std::to_string(device.size.width) + " x " + std::to_string(device.size.height);
    const std::string rms = whereSaid(device.rms) ? figure(device.rms, 0.0, "%.3f pixels") : "unknown";
    std::printf("%-10s %s, model %s, RMS %s\n", name, size.c_str(), device.model.c_str(), rms.c_str());
    std::printf("  focal length    %s pixels\n", figure(lens[kFocalLength], sigma[kFocalLength], "%9.2f").c_str());
    std::printf("  principal point %s, %s pixels\n", figure(lens[kPrincipalX], sigma[kPrincipalX], "%9.2f").c_str(),
                figure(lens[kPrincipalY], sigma[kPrincipalY], "%.2f").c_str());
    std::printf("  k1 %.4f  k2 %.4f  p1 %.5f  p2 %.5f  k3 %.4f\n", lens[kK1], lens[kK2], lens[kP1], lens[kP2],
                lens[kK3]);
}

void printFindings(const std::vector<Finding>& warnings) {
    std::vector<std::string> sentences;
    sentences.reserve(warnings.size());
    for (const Finding& warning : warnings) sentences.push_back(sentenceOf(warning));
    printWarnings(sentences);
}

void printProcam(const ProcamCalibration& result) {
    printDevice("camera", result.camera);
    printDevice("projector", result.projector);
    const PoseVector& rig = result.projectorFromCamera;
    std::printf("%-10s at (%.2f, %.2f, %.2f) in the projector's frame, in the board's unit\n", "camera", rig[3], rig[4],
                rig[5]);
    for (const ViewQuality& view : result.views)
        std::printf("  %-20s camera %.3f  projector %.3f  held out %.3f pixels%s\n", view.name.c_str(), view.cameraRms,
                    view.projectorRms, view.heldOut.value_or(0.0), view.name == result.worstView ? "  (worst)" : "");
    if (result.halvesDiffer && result.halvesAllowed)
        std::printf("two halves of the poses differ by %.3f pixels; noise allows %.3f\n", *result.halvesDiffer,
                    *result.halvesAllowed);
    printFindings(result.warnings);
}

} // namespace lumorph::cli
