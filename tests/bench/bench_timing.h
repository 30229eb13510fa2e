#pragma once

#include <algorithm>
#include <chrono>
#include <functional>
#include <vector>

#include <ctime>

#include "core/base/statistics.h"

namespace lumorph::bench {

using Seconds = std::chrono::duration<double>;

[[nodiscard]] inline double smallestOf(const std::vector<double>& values) {
    return *std::min_element(values.begin(), values.end());
}

[[nodiscard]] inline double meanOf(const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values) sum += value;
    return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

template <typename Work> [[nodiscard]] double secondsOf(Work&& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return Seconds(std::chrono::steady_clock::now() - start).count();
}

/// Processor seconds of this thread: what a work costs on one core, whoever else is using the machine.
[[nodiscard]] inline double threadSeconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Something to be timed; a short one is called several times in its turn, each call a sample.
struct TimedWork {
    std::function<void()> run;
    int callsPerTurn = 1;
};

/// Median processor seconds of each work, which must run on this thread alone. The works take turns, so that whatever
/// else the machine does meets all of them alike and their ratio stands.
[[nodiscard]] inline std::vector<double> interleavedMedians(int turns, const std::vector<TimedWork>& works) {
    std::vector<std::vector<double>> samples(works.size());
    for (int turn = 0; turn < turns; ++turn)
        for (std::size_t w = 0; w < works.size(); ++w)
            for (int call = 0; call < works[w].callsPerTurn; ++call) {
                const double start = threadSeconds();
                works[w].run();
                samples[w].push_back(threadSeconds() - start);
            }
    std::vector<double> medians;
    for (std::vector<double>& of : samples) medians.push_back(median(std::move(of)));
    return medians;
}

} // namespace lumorph::bench
