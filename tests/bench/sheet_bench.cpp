#include <benchmark/benchmark.h>

#include <numeric>

#include "core/mdf/sampling.h"
#include "core/rig/compiled_sheet.h"
#include "tests/bench/bench_groups.h"
#include "tests/bench/bench_timing.h"
#include "tests/support/lifted_sheet.h"

namespace lumorph::bench {

void benchSheet(const Filter& filter, Report& report) {
    const std::string top = "sheet-top", whole = "sheet-rig", made = "sheet-compile";
    if (!filter.wants(top) && !filter.wants(whole) && !filter.wants(made)) return;
    const RigParts parts = test::liftedSheetParts();
    const Rig rig(parts);
    const SheetModes& modes = parts.sheet->modes;
    std::vector<std::vector<double>> strokes;
    for (const State& state : quasiRandomStates(rig.actuatorCount(), 200, 64, 3)) // hardly any on the grid
        strokes.push_back(strokesOf(rig, state, 200));
    std::vector<std::uint32_t> topVertices(modes.rowCount());
    std::iota(topVertices.begin(), topVertices.end(), 0U);
    const Rig::Subset subset = rig.subset(topVertices);
    std::vector<glm::vec3> topPositions(topVertices.size()), positions(rig.restMesh().positions.size());
    std::vector<float> coefficients(modes.modeCount);
    std::size_t next = 0;
    const auto state = [&]() -> const std::vector<double>& { return strokes[++next % strokes.size()]; };
    const std::vector<double> medians = interleavedMedians(100, {{[&] { subset.deform(state(), topPositions); }, 10},
                                                                 {[&] { rig.deform(state(), positions); }, 10},
                                                                 {[&] {
                                                                      modeCoefficients(modes, state(), coefficients);
                                                                      benchmark::DoNotOptimize(coefficients.data());
                                                                  },
                                                                  10}});
    const std::vector<double> compiling = interleavedMedians(3, {{[&] { (void)Rig(parts); }}});
    const std::string size = std::to_string(modes.stateCount()) + " states of the grid, " +
                             std::to_string(modes.modeCount) + " modes; their coefficients take " +
                             fixed(1e6 * medians[2], 1) + " us";
    if (filter.wants(top))
        report.add(Row{top,
                       "one joint state of a sheet's top of " + std::to_string(topVertices.size()) + " vertices",
                       1e6 * medians[0],
                       "us",
                       {},
                       atMost(50.0),
                       {size}});
    if (filter.wants(whole))
        report.add(Row{whole,
                       "the whole rig of " + std::to_string(positions.size()) + " vertices with its skirt",
                       1e6 * medians[1],
                       "us",
                       {},
                       {},
                       {std::to_string(CompiledSheet(*parts.sheet, parts.actuators).paths().size()) +
                        " sets of coefficients: skirt shares, and levers taken into account"}});
    if (filter.wants(made))
        report.add(Row{made, "compiling the rig: dependencies and proven boxes", 1e3 * compiling[0], "ms", {}, {}, {}});
}

} // namespace lumorph::bench
