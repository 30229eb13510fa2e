#pragma once

#include <filesystem>
#include <functional>

#include "app/studio/shell/studio.h"
#include "app/workspaces/scene/scene_form.h"

namespace lumorph::studio {

/// A slot for a picture with how it lies and moves, as rows of the form's present section. `prefix` begins the names of
/// its controls. `metres`: it is mapped in metres, else in texture coordinates.
void addTextureRows(SceneForm& form, Studio& studio, const QString& prefix, const QString& label,
                    const Part<SceneTexture>& part, const std::function<bool(const StudioState&)>& metres);

/// Shows which file is named and lets the user choose, clear and relink it. `write` gets a whole path, or nothing.
struct FileSlot {
    QString name;   ///< objectName
    QString label;  ///< what the user reads
    QString filter; ///< of the file dialog
    std::function<std::string(const StudioState&)> read;
    std::function<void(StudioState&, const std::string&)> write;
};
void addFileSlot(SceneForm& form, Studio& studio, const FileSlot& slot);

/// Asks for a file without blocking; remembers the folder.
void askForFile(Studio& studio, QWidget* parent, const QString& title, const QString& filter,
                const std::function<void(const std::filesystem::path&)>& chosen);
[[nodiscard]] QString pictureFilter();
[[nodiscard]] QString modelFilter();

} // namespace lumorph::studio
