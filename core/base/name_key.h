#pragma once

#include <string>
#include <string_view>

namespace lumorph {

/// What names of files have in common that differ in Unicode normal form or in case alone: "Prüfung" as macOS and as
/// Windows write it, and "PRÜFUNG". To be compared, not to be shown. Case: Latin, Greek and Cyrillic letters.
[[nodiscard]] std::u32string nameKey(std::string_view name);

} // namespace lumorph
