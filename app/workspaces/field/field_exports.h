#pragma once

#include <functional>
#include <memory>

#include <QWidget>

#include "app/studio/shell/studio.h"
#include "core/render/viewport/view_camera.h"
#include "core/render/viewport/viewport_scene.h"

namespace lumorph::studio {

/// What the Field workspace's viewport shows at this moment.
struct ExportView {
    std::shared_ptr<const ViewportScene> scene; ///< empty before the first frame
    ViewCamera camera;
    double ratio = 1.6; ///< width to height
};

/// What exports need of the workspace that offers them.
struct ExportContext {
    Studio& studio;
    std::function<ExportView()> view;
    QWidget* parent = nullptr; ///< of dialogs; the active window when null
};

/// Adds the commands export.mesh, export.field, export.grids, export.target, export.csv, export.picture and
/// export.turntable to the menu "File". Each asks for a file first, then works as a job of the place "export" that can
/// be cancelled, writes whole or not at all, and tells in a notice of that place what was written or what went wrong. A
/// command is enabled while there is something to export.
void addFieldExports(const ExportContext& context);

} // namespace lumorph::studio
