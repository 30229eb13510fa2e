#pragma once

namespace lumorph {

enum class Theme { dark, light };

} // namespace lumorph
