#include "tests/fuzz/servo_trace_seeds.h"

#include "tests/devices/engine_bench.h"
#include "tests/fuzz/servo_trace_input.h"

namespace lumorph {
namespace {

namespace in = servo_input;

std::vector<std::uint8_t> seedOf(std::uint8_t board) {
    EngineBench bench(servo_trace_input::profileOf(board));
    bench.connect();
    bench.tell(in::Arm{true});
    bench.run(0.5);
    bench.tell(in::Command{{0.8, 0.3}});
    bench.run(0.2);
    bench.tell(in::Stop{});
    bench.run(0.1);
    bench.tell(in::Arm{false});
    bench.tell(in::Wiggle{1});
    bench.run(0.3);
    bench.tell(in::Quit{});
    bench.run(0.5);

    std::vector<std::uint8_t> seed{board};
    Microseconds last = bench.rows.front().time;
    for (const ServoTraceRow& row : bench.rows) {
        if (row.kind == servo_trace::kMachine) continue;
        servo_trace_input::append(seed, row, row.time - last);
        last = row.time;
    }
    return seed;
}

} // namespace

std::vector<std::vector<std::uint8_t>> servoTraceSeeds() {
    std::vector<std::vector<std::uint8_t>> seeds;
    for (std::uint8_t board = 0; board < test::kSimulatedDevices.size(); ++board) seeds.push_back(seedOf(board));
    return seeds;
}

} // namespace lumorph
