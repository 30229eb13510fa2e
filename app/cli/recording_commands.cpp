#include <cstdio>
#include <memory>

#include "app/cli/commands.h"
#include "app/cli/recording_check.h"
#include "app/recording/recording.h"
#include "core/base/error.h"

namespace lumorph::cli {

namespace {

struct RecordingArguments {
    std::string file;
    std::string folder;
    bool json = false;
};

/// Read, and what is to be said of it said.
Recording opened(const std::string& file) {
    Recording recording = readRecording(file);
    printWarnings(recording.warnings);
    return recording;
}

/// When it began; what older versions recorded names no zone.
std::string beginOf(const Recording& recording) {
    const auto started = recording.facts.find("started");
    if (started == recording.facts.end()) return {};
    const std::size_t clock = started->second.find('T');
    const bool zoned = clock != std::string::npos && started->second.find_first_of("+-Z", clock) != std::string::npos;
    return ", begun " + started->second + (zoned ? "" : " by the clock of the machine that recorded it");
}

void printRecording(const RecordingArguments& arguments) {
    const Recording recording = opened(arguments.file);
    const double seconds = secondsOf(recording);
    if (arguments.json) {
        nlohmann::json facts(recording.facts);
        printJson({{"seconds", seconds},
                   {"closed", recording.closed},
                   {"frames", recording.frames.size()},
                   {"poses", recording.poses.size()},
                   {"events", recording.events.size()},
                   {"servoRows", recording.servo.size()},
                   {"facts", facts}});
        return;
    }
    std::printf("%s: a session of %.1f s%s\n", arguments.file.c_str(), seconds, beginOf(recording).c_str());
    std::printf("  %zu frames, %zu poses, %zu rows of servo traffic\n", recording.frames.size(), recording.poses.size(),
                recording.servo.size());
    for (const EventRow& event : recording.events)
        std::printf("  %8.2f s  %s%s%s\n", static_cast<double>(event.time.count()) / 1e6, event.text.c_str(),
                    event.remedy.empty() ? "" : "; ", event.remedy.c_str());
}

void printJsonOf(const RecordingCheck& check, std::size_t rows) {
    nlohmann::json difference;
    if (const auto& found = check.servos.difference)
        difference = {
            {"row", found->row}, {"seconds", 1e-6 * static_cast<double>(found->time.count())}, {"text", found->text}};
    printJson({{"equal", check.equal()},
               {"rows", rows},
               {"inputs", check.servos.inputs},
               {"bytesSent", check.servos.bytesSent},
               {"difference", difference},
               {"commands", check.commands},
               {"commandsOfFrames", check.framed}});
}

void printTextOf(const RecordingCheck& check, const RecordingArguments& arguments) {
    std::printf("%s: %llu inputs of the servos were run again, %llu bytes sent\n", arguments.file.c_str(),
                static_cast<unsigned long long>(check.servos.inputs),
                static_cast<unsigned long long>(check.servos.bytesSent));
    if (const auto& found = check.servos.difference)
        std::printf("  bytes: different in row %zu, at %.6f s: %s\n", found->row,
                    1e-6 * static_cast<double>(found->time.count()), found->text.c_str());
    else
        std::printf("  bytes: equal bit for bit\n");
    if (check.commands == 0)
        std::printf("  states: no frames were recorded together with commands\n");
    else if (check.framed == check.commands)
        std::printf("  states: all %llu commands are estimated states of the frames, bit for bit\n",
                    static_cast<unsigned long long>(check.commands));
    else
        std::printf("  states: %llu of %llu commands are estimated states of the frames; the first that is none: %s\n",
                    static_cast<unsigned long long>(check.framed), static_cast<unsigned long long>(check.commands),
                    check.firstOther.c_str());
}

void checkFile(const RecordingArguments& arguments) {
    const Recording recording = opened(arguments.file);
    RecordingCheck check;
    try {
        check = checkRecording(recording);
    } catch (const DataError& error) {
        throw DataError(arguments.file + ": " + error.subject(), error.why(), error.remedy());
    }
    if (arguments.json)
        printJsonOf(check, recording.servo.size());
    else
        printTextOf(check, arguments);
    if (check.servos.difference)
        throw DataError(arguments.file, "the same inputs give other bytes than those that were sent",
                        "the recording was changed, or made by another version of the program");
    if (!check.equal())
        throw DataError(arguments.file, "servos were told what no frame says",
                        "servos tested by hand are told so; else the recording was changed");
}

} // namespace

void addRecordingCommands(CLI::App& app) {
    CLI::App* group = app.add_subcommand("recording", "Look at recorded sessions");
    group->require_subcommand(1);
    auto arguments = std::make_shared<RecordingArguments>();
    CLI::App* info = group->add_subcommand("info", "What a recording holds, and what happened in it");
    info->add_option("recording", arguments->file, "A .lumorphrec file")->required();
    info->add_flag("--json", arguments->json, "Print one JSON value");
    info->callback([arguments] { printRecording(*arguments); });
    CLI::App* table = group->add_subcommand("export", "Write a recording as tables for a study");
    table->add_option("recording", arguments->file, "A .lumorphrec file")->required();
    table->add_option("-o,--output", arguments->folder, "Folder for frames.csv, poses.csv, events.csv and servo.csv")
        ->required();
    CLI::App* check = group->add_subcommand("check", "Run a recording's servos again, and compare bit for bit");
    check->add_option("recording", arguments->file, "A .lumorphrec file")->required();
    check->add_flag("--json", arguments->json, "Print one JSON value");
    check->callback([arguments] { checkFile(*arguments); });
    table->callback([arguments] { exportCsv(opened(arguments->file), arguments->folder); });
}

} // namespace lumorph::cli
