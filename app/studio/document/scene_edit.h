#pragma once

#include <functional>
#include <string>
#include <vector>

#include "app/studio/document/studio_document.h"

namespace lumorph::studio {

using SceneEdit = std::function<void(Scene&)>;
using InstallationEdit = std::function<void(Installation&)>;

/// An edit of the document's scene as one step of undo.
void editScene(StudioDocument& document, const QString& what, const SceneEdit& edit);
/// An edit while something is dragged; `StudioDocument::commitPreview` makes a step of undo of it.
void previewScene(StudioDocument& document, const SceneEdit& edit);

/// The same of what stands in the room.
void editInstallation(StudioDocument& document, const QString& what, const InstallationEdit& edit);
void previewInstallation(StudioDocument& document, const InstallationEdit& edit);

/// A state's own copy of its scene or installation, which others may share until then.
[[nodiscard]] Scene& sceneToEdit(StudioState& state);
[[nodiscard]] Installation& installationToEdit(StudioState& state);

/// Null when there is none.
[[nodiscard]] SceneItem* itemOf(Scene& scene, int id);
/// A name that no item has: "Box", "Box 2".
[[nodiscard]] std::string freeItemName(const Scene& scene, const std::string& wanted);
/// The item and all that it holds, as a group holds them.
[[nodiscard]] std::vector<int> itemsWithin(const Scene& scene, int id);

/// Each gives up, leaving the scene as it was, where an id is unknown.

/// At the end of a group (0: of the scene), with an id and a name of its own; gives the id.
int addItem(Scene& scene, SceneItem item, int parent = 0);
/// With all that it holds.
void removeItem(Scene& scene, int id);
/// A copy with all that it holds, behind it; gives its id, or 0.
int duplicateItem(Scene& scene, int id);
/// Into another group (0: none), before one of its members (0: at the end). It keeps its numbers, so it may be seen
/// elsewhere. False, and nothing moves, where it would lie within itself.
bool moveItem(Scene& scene, int id, int parent, int before = 0);
/// One item at a time moves the servos: whichever did before becomes light alone.
void setItemRole(Scene& scene, int id, ItemRole role);

} // namespace lumorph::studio
