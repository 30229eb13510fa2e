#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>

#include "app/cli/checks.h"
#include "app/cli/commands.h"
#include "app/cli/field_input.h"
#include "app/cli/match_picture.h"
#include "core/base/error.h"
#include "core/base/statistics.h"
#include "core/geometry/gltf_reader.h"
#include "core/geometry/mesh_file.h"
#include "core/mdf/auto_place.h"
#include "core/mdf/certify.h"
#include "core/mdf/clip.h"
#include "core/mdf/refine.h"
#include "core/mdf/voting.h"
#include "core/rig/rig_file.h"

namespace lumorph::cli {

namespace {

struct MatchArguments {
    std::string field;
    TargetArguments target;
    std::string method = "voting";
    double budgetMilliseconds = 10.0;
    double certifySeconds = 0.0; ///< 0: no certificate
    bool autoPlace = false;
    std::string relief = "auto";
    std::string animation;
    double framesPerSecond = 30.0;
    double lookAhead = ClipOptions{}.lookAhead;
    std::string csv;
    std::string picture;
    bool json = false;
};

/// Everything a match needs of a field, made once.
struct Matcher {
    Field field;
    Coverage coverage;
    Voting voting;

    Matcher(const Session& session, const std::string& path)
        : field(readFieldFile(session, path)),
          coverage(readRigGlb(field.rigGlb, inputName(path)), field.frame, field.levels), voting(field) {
        if (coverage.rig().actuatorCount() != field.actuators.size())
            throw DataError(inputName(path), "the field and the rig in it do not agree",
                            "build the field again with 'lumorph mdf build'");
    }
};

struct Result {
    Votes votes;
    State state;
    FitQuality quality;
    std::size_t unreachable = 0; ///< target voxels that no actuator can cover
    std::optional<Refinement> refinement;
    std::optional<Certificate> certificate;
    std::optional<AutoPlacement> placement;
    double voxelizeMilliseconds = 0.0;
    double matchMilliseconds = 0.0;
    double refineMilliseconds = 0.0;
    std::vector<std::string> warnings;
};

template <typename Work> double medianMilliseconds(int repeat, const Session& session, Work&& work) {
    std::vector<double> times;
    for (int i = 0; i < repeat; ++i) {
        session.throwIfCancelled();
        const auto start = std::chrono::steady_clock::now();
        work();
        times.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    }
    return median(std::move(times));
}

/// Tells the author what the device cannot show of this target (R42).
void addWarnings(const Matcher& matcher, const BitColumns& wanted, bool autoPlaced, Result& result) {
    const std::size_t voxels = result.votes.targetVoxels;
    if (voxels == 0) {
        result.warnings.emplace_back(
            "The target does not overlap the space above the device; place it there or use --fit.");
        return;
    }
    const std::size_t reachable = wanted.countAnd(reachableVoxels(matcher.field));
    result.unreachable = voxels - reachable;
    if (100 * result.unreachable >= voxels)
        result.warnings.push_back(std::to_string(100 * result.unreachable / voxels) +
                                  " % of the target lies where no actuator reaches" +
                                  (autoPlaced ? "." : "; try --auto-place."));
    for (std::size_t i = 0; i < result.votes.actuators.size(); ++i)
        if (!result.votes.actuators[i].reached)
            result.warnings.push_back("The target does not meet what '" + matcher.field.actuators[i].name +
                                      "' can change; it rests.");
}

/// Bounds what any state of the device reaches. Refinement takes a better state that is found on the way.
void certify(const Matcher& matcher, const BitColumns& wanted, const MatchArguments& arguments, const Session& session,
             Result& result) {
    constexpr Microseconds kSlice{20'000}; // between looks at whether it was interrupted
    const SteadyClock clock;
    const Microseconds end = clock.now() + Microseconds(static_cast<std::int64_t>(1e6 * arguments.certifySeconds));
    Certifier certifier(matcher.coverage);
    certifier.start(wanted, result.state);
    Certificate certificate;
    do {
        session.throwIfCancelled();
        certificate = certifier.tighten(std::clamp(end - clock.now(), Microseconds{0}, kSlice), clock);
    } while (!certificate.done && clock.now() < end);
    if (result.refinement) {
        result.state = certificate.best;
        result.quality = certificate.quality;
    }
    result.certificate = std::move(certificate);
}

Result matchVoxels(const Matcher& matcher, const TargetVoxels& target, const MatchArguments& arguments,
                   const std::optional<AutoPlacement>& placement, const Session& session) {
    Result result;
    result.placement = placement;
    result.warnings = target.warnings;
    result.voxelizeMilliseconds = target.voxelizeMilliseconds;
    BitColumns wanted = target.bits;
    wanted &= matcher.coverage.domain();
    Voting::Workspace workspace;
    const int repeat = arguments.target.repeat;
    result.matchMilliseconds =
        medianMilliseconds(repeat, session, [&] { matcher.voting.match(wanted, result.votes, workspace); });
    result.state = result.votes.state();
    Refiner refiner(matcher.coverage);
    if (arguments.method == "refined") {
        const SteadyClock clock;
        const Microseconds budget(static_cast<std::int64_t>(1000.0 * arguments.budgetMilliseconds));
        result.refineMilliseconds = medianMilliseconds(
            repeat, session, [&] { result.refinement = refiner.refine(wanted, result.votes.state(), budget, clock); });
        if (placement) { // its own search may have come further
            const Refinement again = refiner.refine(wanted, placement->state, budget, clock);
            if (again.after.iou() > result.refinement->after.iou()) {
                result.refinement->state = again.state;
                result.refinement->after = again.after;
            }
        }
        result.state = result.refinement->state;
        result.quality = result.refinement->after;
    } else {
        result.quality = refiner.qualityOf(wanted, result.state);
    }
    if (arguments.certifySeconds > 0.0) certify(matcher, wanted, arguments, session, result);
    addWarnings(matcher, wanted, arguments.autoPlace, result);
    return result;
}

nlohmann::json stateJson(const State& state) {
    nlohmann::json levels = nlohmann::json::array();
    for (const Level level : state) levels.push_back(level.index);
    return levels;
}

nlohmann::json placementJson(const Placement& p) {
    return {{"scale", p.scale},
            {"yawDegrees", p.yaw.inDegrees()},
            {"relief", p.relief},
            {"orientation", {p.orientation.x, p.orientation.y, p.orientation.z, p.orientation.w}},
            {"translation", {p.translation.x, p.translation.y, p.translation.z}}};
}

nlohmann::json resultJson(const Matcher& matcher, const Result& result, const MatchArguments& arguments) {
    const double volume = matcher.field.frame.voxelVolume();
    nlohmann::json actuators = nlohmann::json::array();
    for (std::size_t i = 0; i < result.votes.actuators.size(); ++i) {
        const ActuatorVote& vote = result.votes.actuators[i];
        actuators.push_back({{"name", matcher.field.actuators[i].name},
                             {"level", result.state[i].index},
                             {"voted", vote.level.index},
                             {"reached", vote.reached},
                             {"errors", vote.errors},
                             {"intersections", vote.intersections}});
    }
    nlohmann::json json = {{"method", arguments.method},
                           {"state", stateJson(result.state)},
                           {"actuators", actuators},
                           {"iou", result.quality.iou()},
                           {"targetVoxels", result.votes.targetVoxels},
                           {"unreachableVolume", static_cast<double>(result.unreachable) * volume},
                           {"unmatchedVolume", static_cast<double>(result.quality.unmatched) * volume},
                           {"overfilledVolume", static_cast<double>(result.quality.overfilled) * volume},
                           {"ms",
                            {{"voxelize", {{"median", result.voxelizeMilliseconds}}},
                             {"match", {{"median", result.matchMilliseconds}}},
                             {"refine", {{"median", result.refineMilliseconds}}}}},
                           {"warnings", result.warnings}};
    if (result.refinement) {
        json["iouBefore"] = result.refinement->before.iou();
        json["statesSeen"] = result.refinement->statesSeen;
        json["converged"] = result.refinement->converged;
    }
    if (result.certificate) {
        const Certificate& known = *result.certificate;
        json["upperBound"] = known.upperBound;
        json["gap"] = known.upperBound - result.quality.iou();
        json["certificate"] = {{"exact", known.exact},
                               {"bestState", stateJson(known.best)},
                               {"bestIou", known.quality.iou()},
                               {"boxes", known.boxes}};
        if (!known.note.empty()) json["certificate"]["note"] = known.note;
    }
    if (result.placement) {
        const Placement& p = result.placement->placement;
        json["placement"] = placementJson(p);
        json["placement"]["iouAtFit"] = result.placement->iouAtFit;
        json["placement"]["iouPlain"] = result.placement->iouPlain;
        json["placement"]["iouModel"] = result.placement->alternatives.front().iouModel;
        json["placement"]["placementsSeen"] = result.placement->placementsSeen;
        json["alternatives"] = nlohmann::json::array();
        for (const PlacementCandidate& one : result.placement->alternatives)
            json["alternatives"].push_back({{"iou", one.iou},
                                            {"iouModel", one.iouModel},
                                            {"state", stateJson(one.state)},
                                            {"placement", placementJson(one.placement)}});
    }
    return json;
}

void printCertificate(const Certificate& known, double iou) {
    // Rounded up: the bound holds as it is printed.
    const double bound = std::min(1.0, std::ceil(1000.0 * known.upperBound - 1e-9) / 1000.0);
    if (known.exact && iou == known.quality.iou())
        std::printf("  no state of this device comes nearer: this is the best possible\n");
    else
        std::printf("  no state of this device comes nearer than %.3f; this one is at most %.3f from the best "
                    "possible\n",
                    bound, bound - iou + 5e-4);
    if (!known.note.empty()) std::printf("  %s\n", known.note.c_str());
}

void printResult(const Matcher& matcher, const Result& result) {
    const int top = matcher.field.levels - 1;
    constexpr std::size_t kMost = 24;
    for (std::size_t i = 0; i < std::min(kMost, result.state.size()); ++i) {
        const int level = result.state[i].index;
        const std::string bar(static_cast<std::size_t>(20 * level / top), '=');
        std::printf("  %-22s %3d of %d  |%-20s|%s\n", matcher.field.actuators[i].name.c_str(), level, top, bar.c_str(),
                    result.votes.actuators[i].reached ? "" : "  not reached");
    }
    if (result.state.size() > kMost) std::printf("  ... and %zu more\n", result.state.size() - kMost);
    const double cubicCentimetres = 1e6 * matcher.field.frame.voxelVolume();
    std::printf("\n  IoU %.3f; %.1f cm3 of the target unmatched, %.1f cm3 overfilled\n", result.quality.iou(),
                static_cast<double>(result.quality.unmatched) * cubicCentimetres,
                static_cast<double>(result.quality.overfilled) * cubicCentimetres);
    std::printf("  voxelise %.3f ms, match %.3f ms", result.voxelizeMilliseconds, result.matchMilliseconds);
    if (result.refinement)
        std::printf(", refine %.3f ms over %d states (IoU %.3f by voting)", result.refineMilliseconds,
                    result.refinement->statesSeen, result.refinement->before.iou());
    std::printf("\n");
    if (result.certificate) printCertificate(*result.certificate, result.quality.iou());
}

const Model::Animation& chooseAnimation(const Model& model, const std::string& path, const std::string& name) {
    if (model.animations.empty())
        throw DataError(path, "it holds no animation", "export it from the modeller with its animation");
    for (const Model::Animation& animation : model.animations)
        if (animation.name == name || name == "first") return animation;
    throw InvalidInput("--animation '" + name + "'", "the file has no animation of that name",
                       "use 'first' or '" + model.animations.front().name + "'");
}

void matchAnimation(const Matcher& matcher, const MatchArguments& arguments, const Session& session) {
    const ReadModel read = readModelFile(arguments.target.path);
    const Model& model = read.model;
    const Model::Animation& animation = chooseAnimation(model, arguments.target.path, arguments.animation);
    printWarnings(read.warnings);
    ClipOptions options;
    options.framesPerSecond = arguments.framesPerSecond;
    options.refined = arguments.method == "refined";
    options.lookAhead = arguments.lookAhead;
    options.budget = Microseconds(static_cast<std::int64_t>(1000.0 * arguments.budgetMilliseconds));
    const auto frames =
        matchClip(matcher.field, matcher.coverage, matcher.voting, model, animation, options, session.progress());
    Session::endProgress();
    if (!arguments.csv.empty()) writeOutput(arguments.csv, bytesOfText(clipCsv(matcher.field, frames)));
    double wanted = 0.0;
    double reached = 0.0;
    nlohmann::json list = nlohmann::json::array();
    for (const ClipFrame& frame : frames) {
        wanted += frame.iouWanted / static_cast<double>(frames.size());
        reached += frame.iouReached / static_cast<double>(frames.size());
        list.push_back({{"seconds", frame.seconds},
                        {"state", stateJson(frame.wanted)},
                        {"commands", frame.commands},
                        {"strokes", frame.strokes},
                        {"iouWanted", frame.iouWanted},
                        {"iouReached", frame.iouReached}});
    }
    if (arguments.json)
        printJson({{"animation", animation.name},
                   {"lookAhead", arguments.lookAhead},
                   {"frames", list},
                   {"iouWanted", wanted},
                   {"iouReached", reached}});
    else if (arguments.csv != "-")
        std::printf("  %zu frames of '%s': mean IoU %.3f wanted, %.3f reached under the velocity limits\n",
                    frames.size(), animation.name.c_str(), wanted, reached);
}

void checkArguments(const MatchArguments& arguments) {
    if (arguments.json && arguments.csv == "-")
        throw InvalidInput("--json", "standard output would hold the table and the JSON value",
                           "name a file with --csv");
    if (arguments.picture == "-")
        throw InvalidInput("--picture", "a picture is not written to standard output", "name a .png file");
    for (const std::string& output : {arguments.csv, arguments.picture})
        if (!output.empty()) checkOutput(output, arguments.target.path);
}

void match(const MatchArguments& arguments, const Session& session) {
    checkArguments(arguments);
    const Matcher matcher(session, arguments.field);
    if (!arguments.animation.empty()) {
        matchAnimation(matcher, arguments, session);
        return;
    }
    std::optional<AutoPlacement> placement;
    TargetVoxels target;
    if (arguments.autoPlace) {
        const Target mesh = readTargetMesh(session, arguments.target.path);
        AutoPlaceOptions options;
        options.relief = arguments.relief == "auto"     ? ReliefChoice::automatic
                         : arguments.relief == "always" ? ReliefChoice::always
                                                        : ReliefChoice::never;
        placement = autoPlace(matcher.field, matcher.coverage, matcher.voting, mesh, options, session.progress());
        Session::endProgress();
        target = voxelsOf(session, matcher.field, mesh, placement->placement, arguments.target.repeat);
    } else {
        target = readTarget(session, matcher.field, arguments.target);
    }
    Result result = matchVoxels(matcher, target, arguments, placement, session);
    if (placement && placement->iou < kFitsNowhere) {
        char text[96];
        std::snprintf(text, sizeof text, "This target fits nowhere on this device: IoU %.2f at its best place.",
                      placement->iou);
        result.warnings.emplace_back(text);
    }
    printWarnings(result.warnings);
    if (!arguments.picture.empty())
        drawMatch(matcher.coverage.rig(), target.mesh,
                  strokesOf(matcher.coverage.rig(), result.state, matcher.field.levels), result.quality.iou(),
                  result.matchMilliseconds, arguments.picture);
    arguments.json ? printJson(resultJson(matcher, result, arguments)) : printResult(matcher, result);
}

} // namespace

void addMatchCommand(CLI::App& app, Session& session) {
    auto a = std::make_shared<MatchArguments>();
    CLI::App* command = app.add_subcommand("match", "Find the state in which the device looks most like a target");
    command->add_option("field", a->field, "A .mdf file")->required();
    command
        ->add_option("target", a->target.path, "A mesh, or an .nrrd grid in the field's frame (- for standard input)")
        ->required();
    command->add_flag("--fit", a->target.fit, "Largest scale inside the frame, centred, standing on the rest surface");
    CLI::Option* place =
        command->add_flag("--auto-place", a->autoPlace, "Search orientation, scale and position for the best IoU");
    place->excludes("--fit");
    command
        ->add_option("--relief", a->relief,
                     "Show the target as on a coin, its heights compressed to the device's: auto (where nothing else "
                     "fits), never or always")
        ->check(CLI::IsMember({"auto", "never", "always"}))
        ->needs(place)
        ->capture_default_str();
    command->add_option("--method", a->method, "voting or refined")
        ->check(CLI::IsMember({"voting", "refined"}))
        ->capture_default_str();
    command->add_option("--budget-ms", a->budgetMilliseconds, "Time for refinement")
        ->check(numberBetween(0.001, 1e6))
        ->capture_default_str();
    command
        ->add_option("--certify", a->certifySeconds,
                     "Seconds to find out how much better any state of the device could be")
        ->check(numberBetween(0.001, 3600.0));
    command->add_option("--repeat", a->target.repeat, "Repeat each stage and give the median")
        ->check(CLI::Range(1, 100000))
        ->capture_default_str();
    command->add_option("--animation", a->animation, "Match an animation of the file over time: its name, or first")
        ->excludes("--auto-place")
        ->excludes("--certify");
    command->add_option("--fps", a->framesPerSecond, "Frames a second of that")
        ->check(numberBetween(1.0, 240.0))
        ->capture_default_str();
    command->add_option("--look-ahead", a->lookAhead, "Seconds that commands look ahead in it; 0: frame by frame")
        ->needs("--animation")
        ->check(numberBetween(0.0, kMostLookAhead))
        ->capture_default_str();
    command->add_option("--csv", a->csv, "Write the matched animation as a table, or -")->needs("--animation");
    command->add_option("--picture", a->picture, "Write a picture of rest, target and fit (.png)")
        ->excludes("--animation");
    command->add_flag("--json", a->json, "Print one JSON value");
    command->callback([a, &session] { match(*a, session); });
}

} // namespace lumorph::cli
