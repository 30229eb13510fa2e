#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include <QString>

#include "core/mdf/builder.h"
#include "core/mdf/field.h"
#include "core/rig/rig.h"

namespace lumorph::studio {

/// What a field is and how good it is, in words.
struct FieldSummary {
    struct Fact {
        QString name;
        QString value;
        QString why; ///< what it means, for a tooltip
    };
    std::vector<Fact> facts;
    std::vector<QString> warnings; ///< plain sentences, each with what to do
};
/// `file` is where the field was saved, or empty; `seconds` is how long it took to build, where that is known.
[[nodiscard]] FieldSummary summaryOf(const Field& field, const std::filesystem::path& file,
                                     std::optional<double> seconds);

/// "161,601", "1.2 million": a count as one says it.
[[nodiscard]] QString countText(std::uint64_t count);
/// "820 bytes", "2.1 MB".
[[nodiscard]] QString bytesText(std::uint64_t bytes);
/// Memory that a field takes while it is open.
[[nodiscard]] std::uint64_t bytesOf(const Field& field);

/// What a build with some options would give, before it is done.
struct BuildEstimate {
    VoxelFrame frame;
    std::uint64_t bytes = 0;    ///< of the field
    std::optional<double> work; ///< against that of the field in use: 2 is twice the time
};
/// `known` is the field in use, of the same rig, or null. Throws InvalidInput for a resolution beyond the limits of a
/// frame.
[[nodiscard]] BuildEstimate estimateOf(const Rig& rig, const BuildOptions& options, const Field* known);

} // namespace lumorph::studio
