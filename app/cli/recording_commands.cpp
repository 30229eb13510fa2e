#include <cstdio>
#include <memory>

#include "app/cli/commands.h"
#include "app/recording/recording.h"

namespace lumorph::cli {

namespace {

struct Arguments {
    std::string file;
    std::string folder;
    bool json = false;
};

void printInfo(const Arguments& arguments) {
    const Recording recording = readRecording(arguments.file);
    const double seconds = secondsOf(recording);
    if (arguments.json) {
        nlohmann::json facts(recording.facts);
        printJson({{"seconds", seconds},
                   {"frames", recording.frames.size()},
                   {"poses", recording.poses.size()},
                   {"events", recording.events.size()},
                   {"servoRows", recording.servo.size()},
                   {"facts", facts}});
        return;
    }
    std::printf("%s: a session of %.1f s\n", arguments.file.c_str(), seconds);
    std::printf("  %zu frames, %zu poses, %zu rows of servo traffic\n", recording.frames.size(), recording.poses.size(),
                recording.servo.size());
    for (const EventRow& event : recording.events)
        std::printf("  %8.2f s  %s%s%s\n", static_cast<double>(event.time.count()) / 1e6, event.text.c_str(),
                    event.remedy.empty() ? "" : "; ", event.remedy.c_str());
}

} // namespace

void addRecordingCommands(CLI::App& app) {
    CLI::App* group = app.add_subcommand("recording", "Look at recorded sessions");
    group->require_subcommand(1);
    auto arguments = std::make_shared<Arguments>();
    CLI::App* info = group->add_subcommand("info", "What a recording holds, and what happened in it");
    info->add_option("recording", arguments->file, "A .lumorphrec file")->required();
    info->add_flag("--json", arguments->json, "Print one JSON value");
    info->callback([arguments] { printInfo(*arguments); });
    CLI::App* table = group->add_subcommand("export", "Write a recording as tables for a study");
    table->add_option("recording", arguments->file, "A .lumorphrec file")->required();
    table->add_option("-o,--output", arguments->folder, "Folder for frames.csv, poses.csv, events.csv and servo.csv")
        ->required();
    table->callback([arguments] { exportCsv(readRecording(arguments->file), arguments->folder); });
}

} // namespace lumorph::cli
