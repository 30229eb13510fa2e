#pragma once

#include <span>
#include <string>

#include "app/applications/demo.h"

/// The one place that knows the demonstrations.
namespace lumorph {

/// All demonstrations in the order in which they are offered. The first is shown to who starts for the first time.
[[nodiscard]] std::span<const Demo> demos();

/// Throws InvalidInput for a name that none has, with those there are.
[[nodiscard]] const Demo& demoNamed(const std::string& name);

/// "water, techniques, ..."
[[nodiscard]] std::string demoNames();

} // namespace lumorph
