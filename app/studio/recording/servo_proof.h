#pragma once

#include <cstdint>
#include <vector>

#include <QString>

#include "app/recording/session_rows.h"
#include "core/base/progress.h"

namespace lumorph::studio {

/// Whether a recording's servo traffic, run again, gives the same bytes.
struct ServoProof {
    std::uint64_t bytes = 0; ///< compared
    std::uint64_t links = 0; ///< so many traces
    QString difference;      ///< the first; empty: there is none
};

/// Runs each link's trace again, one after the other. Throws DataError for a trace that does not begin with its
/// profile; Cancelled.
[[nodiscard]] ServoProof proveServos(const std::vector<ServoRow>& rows, const Progress& progress = {});

/// "12,345 bytes equal bit for bit", or what differs.
[[nodiscard]] QString proofText(const ServoProof& proof);

} // namespace lumorph::studio
