#pragma once

#include <filesystem>
#include <string>

#include "tests/bench/bench_report.h"

namespace lumorph::bench {

/// Which rows the user asked for: those whose name holds the text.
struct Filter {
    std::string text;
    [[nodiscard]] bool wants(const std::string& row) const { return row.find(text) != std::string::npos; }
};

// One function a group of rows; each measures what the filter lets through and adds it to the report.
void benchVoting(const Filter& filter, Report& report);
void benchVoxelize(const Filter& filter, Report& report);
void benchSheet(const Filter& filter, Report& report);
void benchBuild(const Filter& filter, Report& report);
void benchLoop(const Filter& filter, Report& report);
void benchLive(const Filter& filter, Report& report);
void benchRefine(const Filter& filter, Report& report);
void benchPlacement(const Filter& filter, Report& report);
void benchCertify(const Filter& filter, Report& report);
void benchPeers(const Filter& filter, Report& report);
void benchScaling(const Filter& filter, Report& report);
void benchFrame(const Filter& filter, Report& report);
void benchDevices(const Filter& filter, Report& report);
void benchApplications(const Filter& filter, Report& report);
void benchCalibration(const Filter& filter, Report& report);

} // namespace lumorph::bench
