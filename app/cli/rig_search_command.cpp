#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <system_error>

#include "app/cli/checks.h"
#include "app/cli/commands.h"
#include "app/cli/target_arguments.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/text.h"
#include "core/rig/rig_file.h"
#include "core/rig/templates/sheet_outline.h"
#include "core/search/search_file.h"
#include "core/search/search_front.h"
#include "core/search/shared_batch.h"

namespace lumorph::cli {

namespace {

namespace fs = std::filesystem;

struct SearchOptions {
    std::string rig;
    LibraryArguments targets;
    int generations = 1000;
    int population = 64;
    std::uint64_t seed = 1;
    int most = 8;
    std::string cost = "servos";
    std::string output;
    bool json = false;
};

/// The rig whose sheet is searched, and that sheet with the lines it has.
struct Start {
    Rig rig;
    SheetDevice sheet;
};

Start startOf(const std::string& path) {
    if (!fs::path(path).extension().string().ends_with("svg")) {
        Rig rig = readRig(path);
        SheetDevice sheet = sheetDeviceOf(rig);
        return {std::move(rig), std::move(sheet)};
    }
    constexpr std::size_t kMostBytes = std::size_t{64} << 20U;
    const std::vector<std::byte> bytes = readFile(path, kMostBytes);
    SheetDevice sheet;
    sheet.name = fs::path(path).stem().string();
    sheet.outline = svgOutline(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()), path);
    glm::dvec2 low = sheet.outline.front();
    glm::dvec2 high = low;
    for (const glm::dvec2& p : sheet.outline) low = glm::min(low, p), high = glm::max(high, p);
    for (glm::dvec2& p : sheet.outline) p -= 0.5 * (low + high);
    return {sheetRig(sheet), sheet};
}

void makeFolder(const std::string& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error)
        throw DeviceError(folder, "it cannot be made (" + error.message() + ")", "choose a folder you may write to");
}

struct Found {
    std::vector<FrontDesign> front;
    std::vector<std::string> files; ///< names in the folder
    SearchState state;
};

/// Lets generations pass, each kept on the disk, so that a search that is ended goes on where it was.
SearchState search(const SheetDesigns& designs, const DesignScorer& scorer, const SheetDevice& start,
                   const SearchIdentity& identity, const SearchOptions& options, const Ranks* ranks,
                   const Session& session) {
    const Progress progress = session.progress();
    const ScoreBatch own = [&](const std::vector<DesignPoint>& points) { return scorer.batch(points, progress); };
    const ScoreBatch score = [&](const std::vector<DesignPoint>& points) {
        return ranks != nullptr ? ranks->score(points, own) : own(points);
    };
    const auto keep = [&](const SearchState& state) {
        std::exception_ptr failure;
        try {
            if (ranks == nullptr || ranks->first()) writeSearchState(options.output, identity, state);
        } catch (const Error&) {
            failure = std::current_exception();
        }
        // The others do not go on without the one that writes.
        const bool failed = ranks != nullptr ? ranks->any(failure != nullptr) : failure != nullptr;
        if (failure) std::rethrow_exception(failure);
        if (failed) throw Cancelled();
    };
    std::optional<SearchState> kept = readSearchState(options.output, identity);
    SearchState state = kept ? std::move(*kept)
                             : beginSearch(designs, options.population, options.seed, {designs.pointOf(start)}, score);
    try {
        if (!kept) keep(state);
        while (state.generation < options.generations) {
            nextGeneration(state, score); // asks whether it is to stop
            keep(state);
            char stage[64];
            std::snprintf(stage, sizeof stage, "generation %d of %d", state.generation, options.generations);
            progress.report(0.9 * state.generation / options.generations, stage);
        }
    } catch (const Cancelled&) {
        Session::endProgress();
        throw std::runtime_error("stopped after generation " + std::to_string(state.generation) + " of " +
                                 std::to_string(options.generations) + "; the same command goes on from there");
    }
    return state;
}

void writeFront(Found& found, const std::string& folder) {
    std::string csv = "servos,price,fit,file";
    if (!found.front.empty())
        for (const TargetFit& target : found.front.front().fit.targets) csv += "," + csvField(target.name);
    csv += "\n";
    for (const FrontDesign& design : found.front) {
        char name[48];
        std::snprintf(name, sizeof name, "front-%02zu.glb", found.files.size() + 1);
        found.files.emplace_back(name);
        writeOutput((fs::path(folder) / name).string(), writeRigGlb(design.rig));
        char line[96];
        std::snprintf(line, sizeof line, "%zu,%.2f,%.6f,%s", design.rig.actuatorCount(), design.price, design.fit.mean,
                      name);
        csv += line;
        for (const TargetFit& target : design.fit.targets) {
            std::snprintf(line, sizeof line, ",%.6f", target.iou);
            csv += line;
        }
        csv += "\n";
    }
    writeOutput((fs::path(folder) / "front.csv").string(), bytesOfText(csv));
}

nlohmann::json foundJson(const Found& found, const SearchOptions& options) {
    nlohmann::json front = nlohmann::json::array();
    for (std::size_t k = 0; k < found.front.size(); ++k) {
        const FrontDesign& design = found.front[k];
        front.push_back({{"servos", design.rig.actuatorCount()},
                         {"price", design.price},
                         {"fit", design.fit.mean},
                         {"file", (fs::path(options.output) / found.files[k]).string()}});
    }
    return {{"front", front},
            {"csv", (fs::path(options.output) / "front.csv").string()},
            {"generations", found.state.generation},
            {"evaluations", found.state.evaluations},
            {"seed", options.seed}};
}

void printFound(const Found& found, const SearchOptions& options) {
    std::printf("%d generations, %llu designs looked at; nothing found is both cheaper and better than these:\n\n",
                found.state.generation, static_cast<unsigned long long>(found.state.evaluations));
    std::printf("  servos    price    fit\n");
    for (std::size_t k = 0; k < found.front.size(); ++k) {
        const FrontDesign& design = found.front[k];
        const std::string bar(static_cast<std::size_t>(20.0 * design.fit.mean), '=');
        std::printf("  %4zu   %6.2f EUR  %.3f |%-20s|  %s\n", design.rig.actuatorCount(), design.price, design.fit.mean,
                    bar.c_str(), (fs::path(options.output) / found.files[k]).c_str());
    }
    if (found.front.empty()) std::printf("  none: no bend line reaches any of the targets\n");
}

void rigSearch(const SearchOptions& options, const Session& session) {
    const std::optional<Ranks> ranks = Ranks::join(fs::read_symlink("/proc/self/exe").parent_path());
    const Start start = startOf(options.rig);
    std::vector<LibraryTarget> library = readTargetLibrary(options.targets.folder(), session.progress());
    const SearchTargets targets =
        placeForSearch(start.rig, start.sheet, std::move(library), options.targets.placing(), session.progress());
    const SheetDesigns designs(start.sheet, static_cast<std::size_t>(options.most));
    const SheetFit fit(designs.sheet(), designs.angle(), targets.targets, {}, session.progress());
    SearchIdentity identity{start.rig.name(),
                            fingerprint(start.sheet),
                            fingerprint(targets.targets),
                            options.seed,
                            usablePopulation(options.population),
                            designs.mostLines(),
                            options.cost == "price" ? SearchCost::price : SearchCost::servos};
    const DesignScorer scorer(designs, fit, identity.cost);
    makeFolder(options.output);
    Found found;
    found.state = search(designs, scorer, start.sheet, identity, options, ranks ? &*ranks : nullptr, session);
    if (ranks && !ranks->first()) return;
    found.front = buildFront(designs, scorer, identity.cost, found.state, targets, session.progress().part(0.9, 1.0));
    Session::endProgress();
    writeFront(found, options.output);
    options.json ? printJson(foundJson(found, options)) : printFound(found, options);
}

} // namespace

void addRigSearch(CLI::App& group, Session& session) {
    auto options = std::make_shared<SearchOptions>();
    CLI::App* command = group.add_subcommand(
        "search", "Propose bend lines for a sheet: few servos against a good fit over targets. A search that was ended "
                  "goes on with the same command");
    command->add_option("rig", options->rig, "A sheet device (.glb), with or without bend lines, or an outline (.svg)")
        ->required();
    options->targets.addTo(*command);
    command->add_option("--generations", options->generations, "How many; a folder with fewer goes on from there")
        ->check(CLI::Range(0, 1'000'000))
        ->capture_default_str();
    command->add_option("--population", options->population, "Designs in each; rounded up to a multiple of 4")
        ->check(CLI::Range(8, 10'000))
        ->capture_default_str();
    command->add_option("--seed", options->seed, "Which random numbers: the same seed finds the same front")
        ->check(seedNumber())
        ->capture_default_str();
    command->add_option("--servos", options->most, "At most so many servos")
        ->check(CLI::Range(1, static_cast<int>(kMaxBendLines)))
        ->capture_default_str();
    command
        ->add_option("--cost", options->cost,
                     "What counts beside the fit: servos, or the price of those that each "
                     "flap needs")
        ->check(CLI::IsMember({"servos", "price"}))
        ->capture_default_str();
    command
        ->add_option("-o,--output", options->output, "A folder for the front (front.csv, front-NN.glb) and the state")
        ->required();
    command->add_flag("--json", options->json, "Print one JSON value");
    command->callback([options, &session] { rigSearch(*options, session); });
}

} // namespace lumorph::cli
