#pragma once

#include <functional>
#include <vector>

#include <QFileDialog>

#include "app/studio/base/bundled_files.h"

namespace lumorph::studio {

/// Puts a row of pictures below the list of a file dialog of Qt's own: a click on one closes the dialog and opens that
/// file. Files without a picture show their name alone.
void addBundledShelf(QFileDialog& dialog, const QString& title, const std::vector<BundledFile>& files,
                     const std::function<void(const std::filesystem::path&)>& open);

} // namespace lumorph::studio
