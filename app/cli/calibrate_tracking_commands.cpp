#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "app/cli/calibrate_output.h"
#include "app/cli/commands.h"
#include "calibration/registration/hand_eye.h"
#include "calibration/registration/hand_eye_stations.h"
#include "calibration/registration/landmarks.h"
#include "calibration/registration/pivot.h"
#include "calibration/registration/pose_file.h"

// Tracked bodies: how they hang together, where a pointer's tip is, where a model lies on its body.

namespace lumorph::cli {

namespace {

constexpr double kMillimetres = 1000.0;

struct TrackingArguments {
    std::string first, second; ///< recordings
    std::string model;         ///< a table of points
    std::vector<double> tip{0.0, 0.0, 0.0};
    bool stations = false;        ///< poses that stood still
    std::string wFirst, inverted; ///< "a", "b" or "both"
    bool json = false;
};

std::string textOf(const std::string& path, const Session& session) {
    const std::vector<std::byte> bytes = session.readInput(path);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

PoseTrack readTrack(const std::string& path, const Session& session) {
    return parsePoseTrack(textOf(path, session), inputName(path));
}

nlohmann::json vectorOf(const glm::dvec3& v) { return {v.x, v.y, v.z}; }
nlohmann::json poseOf(const Pose& pose) {
    const glm::dquat& q = pose.rotation;
    return {{"position", vectorOf(pose.position)}, {"rotation", {q.x, q.y, q.z, q.w}}};
}

void printPose(const char* name, const Pose& pose) {
    const glm::dvec3 turn = kDegreesPerRadian * turnOf(pose.rotation);
    std::printf("%-20s %9.2f %9.2f %9.2f mm, turned %7.2f %7.2f %7.2f degrees\n", name, kMillimetres * pose.position.x,
                kMillimetres * pose.position.y, kMillimetres * pose.position.z, turn.x, turn.y, turn.z);
}

/// How the first or second recording was said to be written.
PoseReading readingOf(const TrackingArguments& arguments, bool second) {
    const auto isOf = [second](const std::string& which) { return which == "both" || which == (second ? "b" : "a"); };
    return {isOf(arguments.wFirst), isOf(arguments.inverted)};
}

HandEye solvedHandEye(const TrackingArguments& arguments, const Session& session) {
    if (!arguments.stations) {
        const PoseTrack a = readTrack(arguments.first, session), b = readTrack(arguments.second, session);
        return solveHandEye(readAs(a, readingOf(arguments, false)), readAs(b, readingOf(arguments, true)),
                            session.progress());
    }
    const auto stationsOf = [&](const std::string& path, PoseReading reading) {
        std::vector<Station> stations = parseStations(textOf(path, session), inputName(path));
        for (Station& station : stations) station.pose = readAs(station.pose, reading);
        return stations;
    };
    const std::vector<Station> a = stationsOf(arguments.first, readingOf(arguments, false));
    const std::vector<Station> b = stationsOf(arguments.second, readingOf(arguments, true));
    return solveHandEyeStations(a, b, session.progress());
}

void handEye(const TrackingArguments& arguments, const Session& session) {
    const HandEye result = orRefused(arguments.json, [&] { return solvedHandEye(arguments, session); });
    Session::endProgress();
    if (arguments.json) {
        nlohmann::json sigma = {{"rotationDegrees", kDegreesPerRadian * result.turnSigma},
                                {"positionMm", kMillimetres * result.shiftSigma}};
        nlohmann::json found = {{"bFromA", poseOf(result.bFromA)},
                                {"worldBFromWorldA", poseOf(result.worldBFromWorldA)},
                                {"residual",
                                 {{"rotationDegrees", {{"median", kDegreesPerRadian * result.medianTurn}}},
                                  {"positionMm", {{"median", kMillimetres * result.medianShift}}}}},
                                {"halvesDiffer",
                                 {{"rotationDegrees", kDegreesPerRadian * result.halvesTurn},
                                  {"positionMm", kMillimetres * result.halvesShift}}},
                                {arguments.stations ? "stations" : "poses", result.poses},
                                {"warnings", jsonOf(result.warnings)}};
        if (!arguments.stations) {
            found["timeOffset"] = result.timeOffset;
            found["clockDrift"] = result.clockDrift;
            sigma["timeOffset"] = result.offsetSigma;
            sigma["clockDrift"] = result.driftSigma;
        }
        found["sigma"] = std::move(sigma);
        printJson(found);
        return;
    }
    printPose("B from A", result.bFromA);
    printPose("world B from world A", result.worldBFromWorldA);
    if (arguments.stations) {
        std::printf("%zu stations differ by %.2f degrees, %.1f mm", result.poses, kDegreesPerRadian * result.medianTurn,
                    kMillimetres * result.medianShift);
        if (std::isfinite(result.halvesShift))
            std::printf("; every other one from the rest by %.2f degrees, %.1f mm",
                        kDegreesPerRadian * result.halvesTurn, kMillimetres * result.halvesShift);
        std::printf("\nsure to %.2f degrees, %.1f mm (one sigma)\n", kDegreesPerRadian * result.turnSigma,
                    kMillimetres * result.shiftSigma);
    } else {
        std::printf("clock of B minus A   %.4f s, drifting by %.1f ppm (one sigma: %.1f)\n", result.timeOffset,
                    1e6 * result.clockDrift, 1e6 * result.driftSigma);
        std::printf(
            "single poses differ by %.2f degrees, %.1f mm; the halves of the recording by %.2f degrees, %.1f mm\n",
            kDegreesPerRadian * result.medianTurn, kMillimetres * result.medianShift,
            kDegreesPerRadian * result.halvesTurn, kMillimetres * result.halvesShift);
        std::printf("sure to %.2f degrees, %.1f mm, %.1f ms (one sigma)\n", kDegreesPerRadian * result.turnSigma,
                    kMillimetres * result.shiftSigma, 1000.0 * result.offsetSigma);
    }
    printFindings(result.warnings);
}

void pivot(const TrackingArguments& arguments, const Session& session) {
    const Pivot result = orRefused(arguments.json, [&] { return solvePivot(readTrack(arguments.first, session)); });
    if (arguments.json) {
        printJson({{"tip", vectorOf(result.tip)},
                   {"rmsMm", kMillimetres * result.rms},
                   {"sigmaMm", vectorOf(kMillimetres * result.tipSigma)},
                   {"poses", result.poses},
                   {"warnings", jsonOf(result.warnings)}});
        return;
    }
    std::printf("tip  %.5f, %.5f, %.5f m in the pointer's frame\n", result.tip.x, result.tip.y, result.tip.z);
    std::printf("it strays by %.2f mm RMS; sure to %.2f, %.2f, %.2f mm (one sigma)\n", kMillimetres * result.rms,
                kMillimetres * result.tipSigma.x, kMillimetres * result.tipSigma.y, kMillimetres * result.tipSigma.z);
    printFindings(result.warnings);
}

void landmarks(const TrackingArguments& arguments, const Session& session) {
    const LandmarkFit result = orRefused(arguments.json, [&] {
        const PoseTrack pointer = readTrack(arguments.first, session);
        std::optional<PoseTrack> reference;
        if (!arguments.second.empty()) reference = readTrack(arguments.second, session);
        const auto model = parseNamedPoints(textOf(arguments.model, session), inputName(arguments.model));
        return fitLandmarks(pointer, reference, model, {arguments.tip[0], arguments.tip[1], arguments.tip[2]});
    });
    const std::string& worst = result.points[result.worst].name;
    if (arguments.json) {
        nlohmann::json points = nlohmann::json::array();
        for (const Landmark& at : result.points) {
            nlohmann::json point = {{"name", at.name}, {"touched", at.touched}};
            point["errorMm"] = at.touched ? nlohmann::json(kMillimetres * at.error) : nlohmann::json();
            point["leaveOneOutMm"] = at.touched ? nlohmann::json(kMillimetres * at.leaveOneOut) : nlohmann::json();
            points.push_back(std::move(point));
        }
        printJson({{"modelFromReference", poseOf(result.modelFromReference)},
                   {"rmsMm", kMillimetres * result.rms},
                   {"points", points},
                   {"worst", worst},
                   {"warnings", jsonOf(result.warnings)}});
        return;
    }
    printPose("model from reference", result.modelFromReference);
    std::printf("%.3f mm RMS\n", kMillimetres * result.rms);
    for (const Landmark& at : result.points)
        if (at.touched)
            std::printf("  %-20s %6.3f mm; leave-one-out %6.3f mm%s\n", at.name.c_str(), kMillimetres * at.error,
                        kMillimetres * at.leaveOneOut, at.name == worst ? "  (worst)" : "");
    printFindings(result.warnings);
}

constexpr const char* kPosesHelp = "Poses: time,x,y,z,qx,qy,qz,qw a line, in seconds and metres";

} // namespace

void addCalibrateTracking(CLI::App& group, Session& session) {
    auto bodies = std::make_shared<TrackingArguments>();
    CLI::App* command =
        group.add_subcommand("handeye", "Two bodies that are joined, each tracked in its own world by its own clock");
    command->add_option("a", bodies->first, kPosesHelp)->required();
    command->add_option("b", bodies->second, "The same of the other body")->required();
    command->add_flag(
        "--stations", bodies->stations,
        "Poses at which both stood still, a row of each file for each: x,y,z,qx,qy,qz,qw, with or without "
        "a name or time before them; 8 to 30");
    const CLI::IsMember which({"a", "b", "both"});
    command->add_option("--w-first", bodies->wFirst, "Whose quaternions are w,x,y,z: a, b or both")->check(which);
    command->add_option("--inverted", bodies->inverted, "Which has the world in the body's frame: a, b or both")
        ->check(which);
    command->add_flag("--json", bodies->json, "Print one JSON value");
    command->callback([bodies, &session] { handEye(*bodies, session); });

    auto swings = std::make_shared<TrackingArguments>();
    command = group.add_subcommand("pivot", "A pointer's tip, from swinging it about the tip");
    command->add_option("poses", swings->first, kPosesHelp)->required();
    command->add_flag("--json", swings->json, "Print one JSON value");
    command->callback([swings, &session] { pivot(*swings, session); });

    auto touches = std::make_shared<TrackingArguments>();
    command =
        group.add_subcommand("landmarks", "Where a model lies on its tracked body, from points that were touched");
    command->add_option("pointer", touches->first, std::string(kPosesHelp) + ", of the pointer")->required();
    command->add_option("--reference", touches->second, "The same of the body that the model is fixed to");
    command->add_option("--model", touches->model, "Points of the model: name,x,y,z a line, in metres")->required();
    command->add_option("--tip", touches->tip, "The pointer's tip in its own frame, X,Y,Z in metres")
        ->delimiter(',')
        ->expected(3);
    command->add_flag("--json", touches->json, "Print one JSON value");
    command->callback([touches, &session] { landmarks(*touches, session); });
}

} // namespace lumorph::cli
