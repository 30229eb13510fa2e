#include "app/cli/stage_output.h"

#include <cmath>
#include <cstdio>
#include <string>
#include <type_traits>

namespace lumorph::cli {

nlohmann::json jsonOf(const Registration& result) {
    nlohmann::json points = nlohmann::json::array();
    for (const PointError& at : result.fresh.points)
        points.push_back({{"name", at.name}, {"errorMm", 1e3 * at.metres}});
    nlohmann::json json = {
        {"good", result.good()},
        {"summary", result.summary},
        {"rmsMm", 1e3 * result.rms},
        {"sigma", {{"mm", 1e3 * result.shiftSigma}, {"degrees", kDegreesPerRadian * result.turnSigma}}},
        {"fresh", {{"rmsMm", 1e3 * result.fresh.rms}, {"worstMm", 1e3 * result.fresh.worst}, {"points", points}}},
        {"warnings", jsonOf(result.warnings)}};
    json["refused"] = result.refusal ? jsonOf(*result.refusal) : nlohmann::json();
    return json;
}

namespace {

constexpr double kMetresOfMillimetre = 1e-3;

void print(const Registration& result) {
    std::printf("%s\n", result.summary.c_str());
    printFindings(result.warnings);
}

nlohmann::json heldOutJson(const HeldOutLight& light) {
    if (light.points == 0) return {};
    return {{"medianMm", 1e3 * light.median},
            {"p95Mm", 1e3 * light.most},
            {"medianPixels", light.medianPixels},
            {"p95Pixels", light.mostPixels},
            {"points", light.points}};
}

nlohmann::json figuresOf(const PlacedDevices& result) {
    nlohmann::json devices = nlohmann::json::array();
    for (const PlacedDevices::Device& device : result.devices) {
        nlohmann::json json = {{"name", device.name},
                               {"kind", device.isProjector ? "projector" : "camera"},
                               {"rms", device.rms},
                               {"sigma", {{"focal", device.focalSigma}, {"mm", 1e3 * device.shiftSigma}}}};
        if (device.isProjector) json["heldOut"] = heldOutJson(device.heldOut);
        devices.push_back(std::move(json));
    }
    nlohmann::json json = {{"good", result.good()},
                           {"summary", result.summary},
                           {"rms", result.rms},
                           {"devices", devices},
                           {"heldOut", heldOutJson(result.heldOut)},
                           {"warnings", jsonOf(result.warnings)}};
    json["refused"] = result.refusal ? jsonOf(*result.refusal) : nlohmann::json();
    return json;
}

void print(const PlacedDevices& result) {
    std::printf("%s\n", result.summary.c_str());
    for (const PlacedDevices::Device& device : result.devices) {
        std::printf("  %-18s %.3f pixels, focal length +- %.2f pixels, place +- %.2f mm", device.name.c_str(),
                    device.rms, device.focalSigma, 1e3 * device.shiftSigma);
        if (device.isProjector && device.heldOut.points > 0)
            std::printf("; held out %.2f pixels", device.heldOut.medianPixels);
        std::printf("\n");
    }
    printFindings(result.warnings);
}

nlohmann::json colorJson(const glm::vec3& color) { return {color.r, color.g, color.b}; }

nlohmann::json freshJson(const FreshLight& fresh) {
    return {{"median", fresh.median}, {"p95", fresh.most}, {"places", fresh.places}};
}

nlohmann::json figuresOf(const LightCalibration& result) {
    nlohmann::json projectors = nlohmann::json::array();
    if (result.good())
        for (const InstalledProjector& projector : result.room.projectors) {
            nlohmann::json curve = nlohmann::json::array();
            for (const InstalledProjector::ResponsePoint& point : projector.responseCurve)
                curve.push_back({{"value", point.value}, {"light", colorJson(point.light)}});
            projectors.push_back({{"name", projector.name},
                                  {"gain", colorJson(projector.gain)},
                                  {"black", colorJson(projector.black)},
                                  {"curve", curve}});
        }
    nlohmann::json json = {
        {"projectors", projectors},         {"whiteSheet", result.hasWhiteSheet}, {"assumption", result.assumption},
        {"fresh", freshJson(result.fresh)}, {"before", freshJson(result.before)}, {"cameraRms", result.responseRms},
        {"ambient", result.ambient},        {"photographs", result.photographs},  {"findings", jsonOf(result.warnings)},
        {"usable", result.good()}};
    json["refused"] = result.refusal ? jsonOf(*result.refusal) : nlohmann::json();
    json["deviceColor"] = result.good() ? colorJson(result.room.deviceColor) : nlohmann::json();
    json["tableColor"] = result.good() ? colorJson(result.room.tableColor) : nlohmann::json();
    return json;
}

void print(const LightCalibration& result) {
    std::printf("%d photographs of flat light\n", result.photographs);
    for (const std::string& figure : result.figures) std::printf("  %s\n", figure.c_str());
    const auto printColor = [](const char* what, const glm::vec3& color) {
        const glm::dvec3 c(color);
        std::printf("  %s: %.3f %.3f %.3f (sRGB)\n", what, c.r, c.g, c.b);
    };
    printColor("bare device", result.room.deviceColor);
    printColor("bare table", result.room.tableColor);
    std::printf("%s\n", result.assumption.c_str());
}

/// Null for one that was not recorded.
nlohmann::json delayJson(const MeasuredDelay& delay) {
    if (delay.events == 0) return {};
    return {{"ms", 1e3 * delay.seconds},
            {"sigmaMs", 1e3 * delay.sigma},
            {"halvesDifferMs", delay.halvesDiffer ? nlohmann::json(1e3 * *delay.halvesDiffer) : nlohmann::json()},
            {"events", delay.events}};
}

nlohmann::json slipJson(const LightSlip& slip) {
    return {{"rmsMm", 1e3 * slip.always}, {"atSpeedMm", 1e3 * slip.atSpeed}};
}

nlohmann::json figuresOf(const MeasuredDelays& delays) {
    nlohmann::json servos = nlohmann::json::array();
    for (const MeasuredDelays::Servo& servo : delays.servos) {
        nlohmann::json json = delayJson(servo.step.lag);
        json["actuator"] = servo.name;
        json["strokesPerSecond"] = servo.step.velocity;
        json["playStrokes"] = servo.step.play;
        servos.push_back(std::move(json));
    }
    return {{"light", delayJson(delays.light)},
            {"tracker", delayJson(delays.tracker)},
            {"movedMark", delayJson(delays.mark)},
            {"servos", servos},
            {"slip", delays.gain ? nlohmann::json{{"with", slipJson(delays.gain->with)},
                                                  {"without", slipJson(delays.gain->without)}}
                                 : nlohmann::json()},
            {"warnings", jsonOf(delays.warnings)},
            {"simulatedSeconds", delays.seconds}};
}

void printDelay(const char* name, const MeasuredDelay& delay) {
    std::printf("  %-22s %6.1f +- %.1f ms", name, 1e3 * delay.seconds, 1e3 * delay.sigma);
    delay.halvesDiffer ? std::printf(", halves differ by %.1f ms\n", 1e3 * *delay.halvesDiffer)
                       : std::printf(", halves differ by -\n");
}

void print(const MeasuredDelays& delays) {
    std::printf("%s It takes %.0f s.\n", delays.summary.c_str(), delays.seconds);
    printDelay("frame to light", delays.light);
    if (!delays.isOfLightAlone()) {
        printDelay("age of poses", delays.tracker);
        printDelay("a moved mark says", delays.mark);
    }
    for (const MeasuredDelays::Servo& servo : delays.servos) printDelay(servo.name.c_str(), servo.step.lag);
    printFindings(delays.warnings);
    if (delays.gain)
        std::printf("  carried at 30 cm/s     light lies %.1f mm beside instead of %.1f mm\n",
                    1e3 * delays.gain->with.atSpeed, 1e3 * delays.gain->without.atSpeed);
}

nlohmann::json servoJson(const ServoFinding& servo, const Rig& rig) {
    nlohmann::json curve = nlohmann::json::array();
    for (const MeasuredServo::Point& point : servo.curve.points)
        curve.push_back({{"commanded", point.commanded}, {"rising", point.rising}, {"falling", point.falling}});
    const bool measured = !servo.curve.points.empty();
    nlohmann::json json = {{"actuator", servo.curve.actuator},
                           {"strokeDegrees", servo.degrees},
                           {"moves", rig.actuators()[servo.moves].name},
                           {"curve", curve}};
    json["backlashDegrees"] = measured ? nlohmann::json(servo.backlashDegrees) : nlohmann::json();
    json["backlashSigmaDegrees"] = measured ? nlohmann::json(servo.backlashSigma) : nlohmann::json();
    json["curveSigmaDegrees"] = measured ? nlohmann::json(servo.curveSigma) : nlohmann::json();
    json["stopsAtCommand"] = jsonOf(servo.stopsAt);
    // The step response is measured together with the other delays.
    json["lagSeconds"] = servo.curve.lagSeconds > 0.0 ? nlohmann::json(servo.curve.lagSeconds) : nlohmann::json();
    return json;
}

nlohmann::json figuresOf(const ServoMeasurement& result, const StageView& view) {
    nlohmann::json servos = nlohmann::json::array();
    for (const ServoFinding& servo : result.measured.servos) servos.push_back(servoJson(servo, view.rig));
    nlohmann::json groups = nlohmann::json::array();
    for (const auto& group : result.plan.groups) {
        nlohmann::json names = nlohmann::json::array();
        for (const std::size_t i : group) names.push_back(view.rig.actuators()[i].name);
        groups.push_back(std::move(names));
    }
    nlohmann::json json = {
        {"servos", servos},
        {"groups", groups},
        {"passes", result.plan.steps.size()},
        {"simulatedSeconds", result.seconds},
        {"freshDegrees", {{"median", result.measured.freshDegrees}, {"worst", result.measured.freshWorst}}},
        {"rmsMm", 1e3 * result.measured.rms},
        {"findings", jsonOf(result.measured.findings)},
        {"usable", result.measured.usable}};
    json["iou"] = json["projectionOffMm"] = nullptr; // only by the lab's truth
    if (const auto& gain = view.servoGain) {
        json["iou"] = {{"wanted", gain->wanted}, {"before", gain->told}, {"after", gain->measured}};
        json["projectionOffMm"] = {{"before", 1e3 * gain->toldOff}, {"after", 1e3 * gain->measuredOff}};
    }
    return json;
}

void print(const ServoMeasurement& result, const StageView& view) {
    std::printf("%zu states in %.0f seconds, in %zu groups of servos; points lie %.2f mm off the surface\n",
                result.plan.steps.size(), result.seconds, result.plan.groups.size(), 1e3 * result.measured.rms);
    for (const ServoFinding& servo : result.measured.servos) {
        if (servo.curve.points.empty()) {
            std::printf("  %-22s no curve\n", servo.curve.actuator.c_str());
            continue;
        }
        double bent = 0.0;
        for (const MeasuredServo::Point& point : servo.curve.points) {
            const double off = 0.5 * (point.rising + point.falling) - point.commanded;
            if (std::abs(off) > std::abs(bent)) bent = off;
        }
        std::printf("  %-22s backlash %.2f +- %.2f degrees, %+.1f degrees from what it is told at most\n",
                    servo.curve.actuator.c_str(), servo.backlashDegrees, servo.backlashSigma, servo.degrees * bent);
    }
    printFindings(result.measured.findings);
    if (!result.measured.usable) {
        std::printf("Nothing is kept: remove what was found, then measure again.\n");
        return;
    }
    std::printf("  fresh states       %.2f degrees off (median), %.2f at worst\n", result.measured.freshDegrees,
                result.measured.freshWorst);
    if (!view.servoGain) return;
    const ServoGain& gain = *view.servoGain;
    std::printf("  IoU of the device  %.4f before, %.4f after; %.4f is wanted\n", gain.told, gain.measured,
                gain.wanted);
    std::printf("  projection lies    %.2f mm beside the surface before, %.2f mm after\n", 1e3 * gain.toldOff,
                1e3 * gain.measuredOff);
}

nlohmann::json summaryJson(const ErrorSummary& summary) {
    return {{"median", summary.median / kMetresOfMillimetre},
            {"p95", summary.most / kMetresOfMillimetre},
            {"worst", summary.worst / kMetresOfMillimetre},
            {"places", summary.places}};
}

nlohmann::json figuresOf(const VerifiedRoom& found) {
    const RoomCheck& check = found.check;
    nlohmann::json all = {{"verdict", wordOf(check.verdict)}, {"sentence", check.sentence}};
    if (check.obstacle) {
        all["obstacle"] = keyOf(check.obstacle->obstacle);
        return all;
    }
    nlohmann::json parts = nlohmann::json::array();
    for (std::size_t i = 0; i < check.names.size(); ++i)
        parts.push_back({{"part", check.names[i]},
                         {"millimetres", check.found.parts[i].beside / kMetresOfMillimetre},
                         {"sigmaMm", check.found.parts[i].sigma / kMetresOfMillimetre}});
    all["part"] = check.names.empty() ? nlohmann::json() : nlohmann::json(check.names.front());
    all["millimetres"] = check.names.empty() ? 0.0 : check.found.parts.front().beside / kMetresOfMillimetre;
    all["parts"] = std::move(parts);
    all["couldAlsoBe"] = check.couldAlsoBe;
    all["map"] = summaryJson(check.now);
    all["map"]["device"] = summaryJson(check.device);
    all["map"]["table"] = summaryJson(check.table);
    all["corrected"] = summaryJson(check.corrected);
    all["fresh"] = summaryJson(found.fresh);
    all["photographs"] = found.photographs;
    return all;
}

void print(const VerifiedRoom& found) {
    std::printf("%s\n", found.check.sentence.c_str());
    if (found.check.obstacle) return;
    const auto print = [](const char* what, const ErrorSummary& light) {
        std::printf("  %-22s %7.2f %7.2f %7.2f mm\n", what, light.median / kMetresOfMillimetre,
                    light.most / kMetresOfMillimetre, light.worst / kMetresOfMillimetre);
    };
    std::printf("  %-22s  median    95 %%   worst\n", "light lies beside");
    print("on the device", found.check.device);
    print("on the table", found.check.table);
    print("once corrected", found.check.corrected);
    for (const std::string& figure : found.figures) std::printf("  %s\n", figure.c_str());
}

} // namespace

nlohmann::json jsonOf(const StageResult& result, const StageView& view) {
    return std::visit(
        [&view](const auto& of) {
            if constexpr (std::is_same_v<std::decay_t<decltype(of)>, ServoMeasurement>)
                return figuresOf(of, view);
            else if constexpr (std::is_same_v<std::decay_t<decltype(of)>, Registration>)
                return jsonOf(of);
            else
                return figuresOf(of);
        },
        result);
}

void printResult(const StageResult& result, const StageView& view) {
    std::visit(
        [&view](const auto& of) {
            if constexpr (std::is_same_v<std::decay_t<decltype(of)>, ServoMeasurement>)
                print(of, view);
            else
                print(of);
        },
        result);
}

} // namespace lumorph::cli
