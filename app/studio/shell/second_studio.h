#pragma once

#include "app/studio/shell/studio.h"

namespace lumorph::studio {

/// Whether another studio of this user has the sessions, or the settings with the room's installation.
[[nodiscard]] bool isSecond(const Studio& studio);

/// Reports in "home" that another studio runs and what this means here, and that it has ended. Ends with `owner`.
void reportOtherStudio(Studio& studio, QObject& owner);
/// The report again, for who has dismissed it.
void postOtherStudio(Studio& studio);

} // namespace lumorph::studio
