#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "app/cli/calibrate_output.h"
#include "app/cli/commands.h"
#include "calibration/registration/pose_file.h"
#include "calibration/registration/time_unit.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/loop/prediction_replay.h"

// How well the prediction of poses does on a recording, beside constant velocity.

namespace lumorph::cli {

namespace {

struct ReplayArguments {
    std::string recording;
    std::string ahead = "50ms", noise = "1mm";
    std::uint32_t seed = 1;
    bool json = false;
};

struct UnitOfSize {
    std::string_view name;
    double size;
};

/// A number of 0 and more with one of two units, in the larger of both. Throws InvalidInput.
double sizeOf(const std::string& text, const char* option, const UnitOfSize& small, const UnitOfSize& large) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const std::string_view unit(end, static_cast<std::size_t>(text.data() + text.size() - end));
    const std::string units = std::string(small.name) + " or " + std::string(large.name);
    if (error != std::errc() || !std::isfinite(value) || value < 0.0 || (unit != small.name && unit != large.name))
        throw InvalidInput(option, inQuotes(text) + " is no number of 0 or more with its unit, " + units,
                           "write it as in 1" + std::string(small.name));
    return value * (unit == small.name ? small.size : large.size);
}

std::vector<PoseSample> samplesOf(const PoseTrack& track) {
    std::vector<PoseSample> samples;
    const double begin = track.poses.front().seconds;
    for (const TimedPose& pose : track.poses)
        samples.push_back({Microseconds(std::llround(1e6 * (pose.seconds - begin))), true, pose.pose});
    return samples;
}

nlohmann::json jsonOf(const PlaceError& error) { return {{"rmsMm", 1e3 * error.rms}, {"p95Mm", 1e3 * error.p95}}; }

nlohmann::json jsonOf(const PredictionReplay& replay) {
    nlohmann::json json = jsonOf(replay.predicted);
    json["constantVelocity"] = jsonOf(replay.constantVelocity);
    json["constantVelocity"]["windowMs"] = std::round(1e3 * replay.velocitySeconds);
    json["line"] = jsonOf(replay.line);
    json["line"]["windowMs"] = std::round(1e3 * replay.lineSeconds);
    json["turn"] = {{"rmsDegrees", kDegreesPerRadian * replay.turnRms},
                    {"constantVelocity", {{"rmsDegrees", kDegreesPerRadian * replay.constantTurnRms}}}};
    json["poses"] = replay.count;
    return json;
}

void printError(const char* name, const PlaceError& error, double window) {
    std::printf("%-30s %7.2f mm RMS, 95 %% within %7.2f mm", name, 1e3 * error.rms, 1e3 * error.p95);
    if (window > 0.0) std::printf(" (of the last %.0f ms, which serves best here)", 1e3 * window);
    std::printf("\n");
}

void replayTrack(const ReplayArguments& arguments, const Session& session) {
    const double ahead = sizeOf(arguments.ahead, "--ahead", {"ms", 1e-3}, {"s", 1.0});
    const double noise = sizeOf(arguments.noise, "--noise", {"mm", 1e-3}, {"m", 1.0});
    const std::vector<std::byte> bytes = session.readInput(arguments.recording);
    const std::string name = inputName(arguments.recording);
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const PoseTrack track = orRefused(arguments.json, [&] { return inKnownSeconds(parsePoseTrack(text, name), name); });
    const PredictionReplay replay = replayPrediction(samplesOf(track), ahead, noise, arguments.seed);
    if (ahead > PoseStream::kFarthestAhead) printWarnings({"nothing is predicted farther ahead than 150 ms"});
    if (arguments.json) {
        nlohmann::json json = jsonOf(replay);
        json["warnings"] = cli::jsonOf(track.warnings); // the one above hides it
        return printJson(json);
    }
    printError("predicted", replay.predicted, 0.0);
    printError("constant velocity", replay.constantVelocity, replay.velocitySeconds);
    printError("a straight line fitted", replay.line, replay.lineSeconds);
    std::printf("turns: %.2f degrees RMS predicted, %.2f by constant velocity; %zu poses\n",
                kDegreesPerRadian * replay.turnRms, kDegreesPerRadian * replay.constantTurnRms, replay.count);
    printFindings(track.warnings);
    finishOutput();
}

} // namespace

void addTrackReplay(CLI::App& group, Session& session) {
    CLI::App* command = group.add_subcommand("replay", "How well a recorded motion is predicted, beside constant "
                                                       "velocity");
    auto arguments = std::make_shared<ReplayArguments>();
    command
        ->add_option("poses", arguments->recording,
                     "Rows time,x,y,z,qx,qy,qz,qw (seconds, metres) with commas or blanks, or - for standard input")
        ->required();
    command->add_option("--ahead", arguments->ahead, "How far ahead, such as 50ms or 0.05s (default 50ms)");
    command->add_option("--noise", arguments->noise,
                        "Noise of the tracker that is added, standard deviation per axis, such as 1mm (default 1mm)");
    command->add_option("--seed", arguments->seed, "Of the noise (default 1)");
    command->add_flag("--json", arguments->json, "Print JSON");
    command->callback([arguments, &session] { replayTrack(*arguments, session); });
}

} // namespace lumorph::cli
