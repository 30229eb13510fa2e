#pragma once

#include <QIcon>
#include <QString>

namespace lumorph::studio {

/// An icon of the set in resources/icons by its name, in the colours of the theme in use (normal, disabled, checked),
/// sharp at any desktop scale. Throws DataError when there is no such icon.
[[nodiscard]] QIcon icon(const QString& name);

} // namespace lumorph::studio
