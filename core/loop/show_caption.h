#pragma once

#include "core/base/words.h"

namespace lumorph {

/// What visitors may read beside the picture of an application. Nobody needs it to play.
struct ShowCaption {
    Words title;
    Words sentence; ///< what is to be seen or done; may be empty
};

} // namespace lumorph
