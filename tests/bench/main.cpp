#include <cstdio>
#include <exception>
#include <string_view>

#include <CLI/CLI.hpp>

#include "tests/bench/bench_groups.h"
#include "tests/bench/field_measurement.h"

namespace {

using namespace lumorph::bench;

struct Group {
    const char* name;
    void (*run)(const Filter&, Report&);
};

constexpr Group kGroups[] = {{"voting", benchVoting},
                             {"voxelize", benchVoxelize},
                             {"sheet", benchSheet},
                             {"build", benchBuild},
                             {"loop", benchLoop},
                             {"live", benchLive},
                             {"refine", benchRefine},
                             {"placement", benchPlacement},
                             {"certify", benchCertify},
                             {"peers", benchPeers},
                             {"scaling", benchScaling},
                             {"frame", benchFrame},
                             {"devices", benchDevices},
                             {"calibration", benchCalibration},
                             {"applications", benchApplications}};

} // namespace

int main(int argc, char** argv) {
    try {
        if (argc == 3 && std::string_view(argv[1]) == kMeasureFlag) {
            measureFieldHere(argv[2]);
            return 0;
        }
        Filter filter;
        bool json = false;
        CLI::App app("Every speed bar of Lumorph, measured in one run.", "lumorph-bench");
        app.add_option("--filter", filter.text, "Only the rows whose name holds this");
        app.add_flag("--json", json, "Print one JSON value");
        CLI11_PARSE(app, argc, argv);

        Report report;
        for (const Group& group : kGroups) {
            try {
                group.run(filter, report);
            } catch (const std::exception& error) {
                report.fail(group.name, error.what());
            }
        }
        if (report.empty()) report.fail("filter", "no row's name holds '" + filter.text + "'");
        json ? report.printJson() : report.printText();
        return report.failed() ? 1 : 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "lumorph-bench: %s\n", error.what());
        return 1;
    }
}
