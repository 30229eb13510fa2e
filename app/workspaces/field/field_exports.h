#pragma once

#include <filesystem>
#include <functional>
#include <memory>

#include <QWidget>

#include "app/studio/shell/studio.h"
#include "app/workspaces/common/field_output.h"
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

/// Runs `write` as a job of the place "export"; it gives what was written, and a notice tells so, or what went wrong
/// and offers `again`: to ask for another place.
void runExport(Studio& studio, const QString& title, std::function<void()> again,
               std::function<std::filesystem::path(const Progress&)> write);

/// Draws by the render thread, called by a job. The window's thread hands the request over; a studio that is being
/// closed does not answer any more, and the job is cancelled.
[[nodiscard]] Painter painterOf(Studio& studio);

} // namespace lumorph::studio
