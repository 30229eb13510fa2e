#pragma once

#include <span>
#include <string>
#include <vector>

#include "app/applications/demo.h"

/// The one place that knows the demonstrations.
namespace lumorph {

/// All demonstrations in the order in which they are offered. The first is shown to who starts for the first time.
[[nodiscard]] std::span<const Demo> demos();

/// Throws InvalidInput for a name that none has, with those there are.
[[nodiscard]] const Demo& demoNamed(const std::string& name);

/// The options of all of them, each name once.
[[nodiscard]] std::vector<DemoOption> demoOptions();

/// "water, techniques, ..."
[[nodiscard]] std::string demoNames();

} // namespace lumorph
