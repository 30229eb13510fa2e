#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "app/cli/calibrate_output.h"
#include "app/cli/commands.h"
#include "app/cli/project_frame.h"
#include "calibration/budget/error_budget.h"
#include "core/base/error.h"
#include "core/loop/pose_stream.h"
#include "core/show/project_contents.h"

namespace lumorph::cli {

namespace {

struct BudgetArguments {
    std::string project;
    double speed = 0.3, floats = 0.02;
    bool json = false;
};

const char* titleOf(BudgetPart part) {
    switch (part) {
    case BudgetPart::projector:
        return "projector's light";
    case BudgetPart::tracker:
        return "tracker in the room";
    case BudgetPart::device:
        return "device on its body";
    case BudgetPart::eye:
        return "eye in the head";
    case BudgetPart::servos:
        return "servos";
    case BudgetPart::delay:
        return "delay not known";
    case BudgetPart::pointer:
        return "pointer's tip, in all";
    case BudgetPart::prediction:
        break;
    }
    return "what prediction leaves";
}

const char* wordOf(ErrorSource source) {
    switch (source) {
    case ErrorSource::told:
        return "measured";
    case ErrorSource::measured:
        return "measured, usual size";
    case ErrorSource::simulated:
        return "simulated in the virtual lab";
    case ErrorSource::assumed:
        return "not measured, usual size";
    case ErrorSource::worked:
        break;
    }
    return "worked out";
}

const char* keyOf(ErrorSource source) {
    switch (source) {
    case ErrorSource::told:
        return "measured";
    case ErrorSource::measured:
        return "measuredUsual";
    case ErrorSource::simulated:
        return "simulated";
    case ErrorSource::assumed:
        return "assumed";
    case ErrorSource::worked:
        break;
    }
    return "workedOut";
}

nlohmann::json budgetJson(const ErrorBudget& budget, const BudgetArguments& arguments) {
    nlohmann::json parts = nlohmann::json::array(), advice = nlohmann::json::array();
    for (const BudgetItem& item : budget.items)
        parts.push_back({{"part", keyOf(item.part)},
                         {"millimetres", 1e3 * item.metres},
                         {"share", item.share},
                         {"source", keyOf(item.source)}});
    for (const BudgetAdvice& one : budget.advice)
        advice.push_back({{"part", keyOf(one.part)},
                          {"measuredBefore", !one.isFirst},
                          {"beforeMm", 1e3 * one.before},
                          {"afterMm", 1e3 * one.after}});
    return {{"handSpeed", arguments.speed},
            {"floats", arguments.floats},
            {"parts", parts},
            {"totalMm", 1e3 * budget.total},
            {"trackerPlaced", budget.isTrackerPlaced},
            {"simulated", budget.isSimulated},
            {"places", budget.places},
            {"lookAheadCutMs", 1e3 * budget.cutSeconds},
            {"lookAheadCutMm", 1e3 * budget.cutMetres},
            {"advice", advice}};
}

void printBudget(const ErrorBudget& budget, const BudgetArguments& arguments) {
    std::printf("On the device, as the viewer sees it, a hand carrying it at %.2f m/s:\n", arguments.speed);
    for (const BudgetItem& item : budget.items)
        std::printf("  %-23s %7.2f mm %4.0f %%  %s\n", titleOf(item.part), 1e3 * item.metres, 100.0 * item.share,
                    wordOf(item.source));
    std::printf("  %-23s %7.2f mm\n", "all together", 1e3 * budget.total);
    if (budget.cutSeconds > 0.0)
        std::printf(
            "Poses are predicted by at most %.0f ms; %.0f ms more, %.2f mm at this speed, are not compensated.\n",
            1e3 * PoseStream::kFarthestAhead, 1e3 * budget.cutSeconds, 1e3 * budget.cutMetres);
    if (!budget.isTrackerPlaced)
        std::printf("Nobody has said where the tracker's world lies; this counts as if it had been laid in by a "
                    "ruler.\n");
    if (budget.isSimulated)
        std::printf("What is simulated is as large as in the virtual lab, which says nothing of this room.\n");
    if (budget.advice.empty()) std::printf("No single part stands out.\n");
    for (const BudgetAdvice& one : budget.advice)
        std::printf("%s %s: %.2f -> %.2f mm\n", one.isFirst ? "Measure" : "Twice as good a measurement of",
                    titleOf(one.part), 1e3 * one.before, 1e3 * one.after);
}

void budget(const BudgetArguments& arguments, const Session& session) {
    const Progress progress = session.progress();
    const ProjectContents contents = readContents(projectFile(arguments.project), progress.part(0.0, 0.5));
    if (!contents.rig) throw InvalidInput(arguments.project, "it has no device", "give it a rig");
    const Installation& room = contents.project.installation;
    SlipView view;
    view.floats = arguments.floats;
    const SlipModel model = slipModelOf(*contents.rig, room, view, progress.part(0.5, 1.0));
    CarryingHand hand;
    hand.speed = arguments.speed;
    const ErrorBudget result =
        budgetOf(*contents.rig, model, errorsOf(room, *contents.rig, commandedOf(view, *contents.rig)), hand);
    Session::endProgress();
    if (arguments.json)
        printJson(budgetJson(result, arguments));
    else
        printBudget(result, arguments);
}

} // namespace

void addCalibrateBudget(CLI::App& group, Session& session) {
    auto arguments = std::make_shared<BudgetArguments>();
    CLI::App* command = group.add_subcommand(
        "budget", "Where the millimetres come from: each part's share of how far a picture slips, and what would help");
    command->add_option("project", arguments->project, "A project, or resource:projects/NAME.lumorph")->required();
    command->add_option("--speed", arguments->speed, "Of the hand that carries the device, metres a second")
        ->capture_default_str()
        ->check(CLI::Range(0.0, 10.0));
    command->add_option("--floats", arguments->floats, "How far what is shown floats before the surface, metres")
        ->capture_default_str()
        ->check(CLI::Range(0.0, 0.2));
    command->add_flag("--json", arguments->json, "Print one JSON value");
    command->callback([arguments, &session] { budget(*arguments, session); });
}

} // namespace lumorph::cli
