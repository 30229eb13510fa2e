#pragma once

#include <QWidget>

#include "app/studio/shell/studio.h"
#include "app/studio/widgets/throttle.h"
#include "app/workspaces/field/fit_certificate.h"

namespace lumorph::studio {

/// The content of the dock "dock.match": how well the device fits the target, what is left out and what sticks out, how
/// it is matched, and what Eq. 1 says for each actuator. Uses the commands target.open, target.autoPlace, field.build,
/// match.live, match.refined and match.voting. Shows the newest frame whenever `numbers` are due; these and the
/// certificate outlive the dock.
[[nodiscard]] QWidget* makeMatchDock(Studio& studio, Throttle& numbers, const FitCertificate& certificate);

} // namespace lumorph::studio
