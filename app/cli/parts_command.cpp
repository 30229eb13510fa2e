#include <charconv>
#include <cmath>
#include <cstdio>
#include <memory>

#include "app/cli/checks.h"
#include "app/cli/commands.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/rig/parts/build_files.h"
#include "core/rig/rig_file.h"
#ifdef LUMORPH_WITH_DEVICES
#include "devices/firmware/part_board.h"
#endif

namespace lumorph::cli {

namespace {

struct PartsFlags {
    std::string rig;
    std::string output;
    std::string fitted;
    std::string servo;
    std::string tolerance = "0.2mm";
    std::string bed = "220mm";
    bool json = false;
};

/// "0.2mm", "22cm", or a number of millimetres. Throws InvalidInput naming the option.
double parseMillimetres(const std::string& text, const char* option) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const std::string_view unit(end, static_cast<std::size_t>(text.data() + text.size() - end));
    if (error != std::errc() || !std::isfinite(value) || (!unit.empty() && unit != "mm" && unit != "cm"))
        throw InvalidInput(std::string(option) + " " + inQuotes(text), "it is no length", "write it as 0.2mm or 22cm");
    return unit == "cm" ? 10.0 * value : value;
}

nlohmann::json planJson(const BuildPlan& plan) {
    nlohmann::json parts = nlohmann::json::array();
    for (const PrintPart& part : plan.parts) {
        const glm::vec3 size = boundingBox(part.solid.mesh.positions).size();
        parts.push_back({{"name", part.name},
                         {"count", part.count},
                         {"size", {size.x, size.y, size.z}},
                         {"volume", signedVolume(part.solid.mesh)},
                         {"triangles", part.solid.mesh.triangles.size()}});
    }
    nlohmann::json wiring = nlohmann::json::array();
    for (const WiringRow& row : plan.wiring)
        wiring.push_back({{"actuator", row.actuator},
                          {"channel", row.channel},
                          {"pin", row.pin},
                          {"pulse", {row.pulseMin, row.pulseMax}},
                          {"pulseCurve", row.curve},
                          {"reversed", row.reversed}});
    return {{"device", plan.device}, {"parts", parts}, {"wiring", wiring}, {"notes", plan.notes}};
}

void printPlan(const BuildPlan& plan, const std::string& folder) {
    std::printf("%s: %zu parts to print, %zu servos, in %s\n\n", plan.device.c_str(), plan.parts.size(),
                plan.wiring.size(), folder.c_str());
    for (const PrintPart& part : plan.parts) {
        const glm::vec3 size = boundingBox(part.solid.mesh.positions).size();
        std::printf("  %3d x %-18s %6.1f x %5.1f x %5.1f mm  %s\n", part.count, part.name.c_str(),
                    static_cast<double>(size.x), static_cast<double>(size.y), static_cast<double>(size.z),
                    part.use.c_str());
    }
    std::printf("\n");
    for (const std::string& note : plan.notes) std::printf("  ! %s\n", note.c_str());
}

void exportParts(const PartsFlags& flags, const Session& session) {
    PartOptions options;
    if (!flags.servo.empty()) options.servo = servoBody(flags.servo);
    options.tolerance = parseMillimetres(flags.tolerance, "--tolerance");
    options.bed = parseMillimetres(flags.bed, "--bed");
    const Rig rig = readRig(flags.rig);
    const BuildPlan plan = buildPlanOf(rig, options, session.progress());
    const auto addMore = [&]([[maybe_unused]] const std::filesystem::path& folder) {
#ifdef LUMORPH_WITH_DEVICES
        addBoardFiles(rig, plan, folder);
#endif
    };
    writeBuildFolder(buildFiles(plan), flags.output, addMore, session.progress());
    if (!flags.fitted.empty()) writeOutput(flags.fitted, writeRigGlb(Rig(withLevers(rig, plan))));
    Session::endProgress();
    flags.json ? printJson(planJson(plan)) : printPlan(plan, flags.output);
}

} // namespace

void addPartsCommand(CLI::App& group, Session& session) {
    auto flags = std::make_shared<PartsFlags>();
    CLI::App* command = group.add_subcommand(
        "parts", "Write what is needed to build the device: parts to print, lists, wiring, sketch, assembly");
    command->add_option("rig", flags->rig, "The rig")->required();
    std::string names;
    for (const ServoBody& body : servoBodies()) names += (names.empty() ? "" : ", ") + std::string(body.name);
    command->add_option("--servo", flags->servo, "What the seats hold: " + names + " (default: the first)");
    command
        ->add_option("--tolerance", flags->tolerance, "Between a part and what goes into it, on every side: 0 to 1 mm")
        ->capture_default_str();
    command->add_option("--bed", flags->bed, "Sides of the printer's bed; larger parts come in pieces")
        ->capture_default_str();
    command->add_option("--fitted", flags->fitted,
                        "Also write the rig as its levers move it: ranges, pulses and their curves");
    command->add_flag("--json", flags->json, "Print parts, wiring and notes as one JSON value");
    command->add_option("-o,--output", flags->output, "A new or an empty folder")->required();
    command->callback([flags, &session] { exportParts(*flags, session); });
}

} // namespace lumorph::cli
