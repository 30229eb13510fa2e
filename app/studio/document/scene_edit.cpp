#include "app/studio/document/scene_edit.h"

#include <algorithm>
#include <map>
#include <set>

namespace lumorph::studio {

namespace {

int freeId(const Scene& scene) {
    int highest = 0;
    for (const SceneItem& item : scene.items) highest = std::max(highest, item.id);
    return highest + 1;
}

/// "Box 2" goes on counting from "Box".
std::string withoutNumber(const std::string& name) {
    const std::size_t space = name.find_last_of(' ');
    if (space == std::string::npos || space == 0 || space + 1 == name.size()) return name;
    const bool number = std::all_of(name.begin() + static_cast<std::ptrdiff_t>(space) + 1, name.end(),
                                    [](char c) { return c >= '0' && c <= '9'; });
    return number ? name.substr(0, space) : name;
}

/// Takes the item with all it holds out of the list.
std::vector<SceneItem> takeOut(Scene& scene, int id) {
    const std::vector<int> within = itemsWithin(scene, id);
    const std::set<int> taken(within.begin(), within.end());
    std::vector<SceneItem> out;
    std::vector<SceneItem> rest;
    for (SceneItem& item : scene.items) (taken.contains(item.id) ? out : rest).push_back(std::move(item));
    scene.items = std::move(rest);
    return out;
}

/// Before an item, or behind all that the group holds.
std::ptrdiff_t placeOf(const Scene& scene, int parent, int before) {
    const auto& items = scene.items;
    const auto indexOf = [&items](int id) {
        return std::find_if(items.begin(), items.end(), [id](const SceneItem& item) { return item.id == id; }) -
               items.begin();
    };
    if (before != 0 && findItem(scene, before) != nullptr) return indexOf(before);
    if (parent == 0) return static_cast<std::ptrdiff_t>(items.size());
    std::ptrdiff_t last = indexOf(parent);
    for (const int id : itemsWithin(scene, parent)) last = std::max(last, indexOf(id));
    return last + 1;
}

void putIn(Scene& scene, std::vector<SceneItem> items, std::ptrdiff_t place) {
    scene.items.insert(scene.items.begin() + place, std::make_move_iterator(items.begin()),
                       std::make_move_iterator(items.end()));
}

} // namespace

Scene& sceneToEdit(StudioState& state) {
    auto scene = std::make_shared<Scene>(*state.scene);
    Scene& editable = *scene;
    state.scene = std::move(scene);
    return editable;
}

Installation& installationToEdit(StudioState& state) {
    auto installation = std::make_shared<Installation>(*state.installation);
    Installation& editable = *installation;
    state.installation = std::move(installation);
    return editable;
}

void editInstallation(StudioDocument& document, const QString& what, const InstallationEdit& edit) {
    document.change(what, [&edit](StudioState& state) { edit(installationToEdit(state)); });
}

void previewInstallation(StudioDocument& document, const InstallationEdit& edit) {
    document.preview([&edit](StudioState& state) { edit(installationToEdit(state)); });
}

void editScene(StudioDocument& document, const QString& what, const SceneEdit& edit) {
    document.change(what, [&edit](StudioState& state) { edit(sceneToEdit(state)); });
}

void previewScene(StudioDocument& document, const SceneEdit& edit) {
    document.preview([&edit](StudioState& state) { edit(sceneToEdit(state)); });
}

SceneItem* itemOf(Scene& scene, int id) {
    const auto found =
        std::find_if(scene.items.begin(), scene.items.end(), [id](const SceneItem& item) { return item.id == id; });
    return found == scene.items.end() ? nullptr : &*found;
}

std::string freeItemName(const Scene& scene, const std::string& wanted) {
    std::set<std::string> taken;
    for (const SceneItem& item : scene.items) taken.insert(item.name);
    if (!taken.contains(wanted)) return wanted;
    const std::string stem = withoutNumber(wanted);
    for (int number = 2;; ++number)
        if (const std::string name = stem + " " + std::to_string(number); !taken.contains(name)) return name;
}

std::vector<int> itemsWithin(const Scene& scene, int id) {
    if (findItem(scene, id) == nullptr) return {};
    std::vector<int> within{id};
    for (const SceneItem& item : scene.items) // a group stands before its members
        if (std::find(within.begin(), within.end(), item.parent) != within.end()) within.push_back(item.id);
    return within;
}

int addItem(Scene& scene, SceneItem item, int parent) {
    item.id = freeId(scene);
    item.parent = findItem(scene, parent) != nullptr ? parent : 0;
    item.name = freeItemName(scene, item.name);
    if (item.parent != 0) item.anchor = findItem(scene, parent)->anchor;
    const int id = item.id;
    const std::ptrdiff_t place = placeOf(scene, item.parent, 0);
    scene.items.insert(scene.items.begin() + place, std::move(item));
    return id;
}

void removeItem(Scene& scene, int id) { takeOut(scene, id); }

int duplicateItem(Scene& scene, int id) {
    const std::vector<int> within = itemsWithin(scene, id);
    if (within.empty()) return 0;
    const std::set<int> originals(within.begin(), within.end());
    std::vector<SceneItem> copies;
    std::map<int, int> renumbered;
    int next = freeId(scene);
    std::ptrdiff_t last = 0;
    for (std::size_t i = 0; i < scene.items.size(); ++i) {
        if (!originals.contains(scene.items[i].id)) continue;
        SceneItem copy = scene.items[i];
        renumbered[copy.id] = next;
        copy.id = next++;
        if (const auto group = renumbered.find(copy.parent); group != renumbered.end()) copy.parent = group->second;
        copy.role = ItemRole::virtualOnly; // one at a time moves the servos
        copies.push_back(std::move(copy));
        last = static_cast<std::ptrdiff_t>(i) + 1;
    }
    copies.front().name = freeItemName(scene, copies.front().name);
    const int id2 = copies.front().id;
    putIn(scene, std::move(copies), last);
    return id2;
}

bool moveItem(Scene& scene, int id, int parent, int before) {
    const std::vector<int> within = itemsWithin(scene, id);
    const auto isWithin = [&within](int other) {
        return std::find(within.begin(), within.end(), other) != within.end();
    };
    const SceneItem* group = findItem(scene, parent);
    if (within.empty() || before == id || (parent != 0 && group == nullptr) || isWithin(parent)) return false;
    if (group != nullptr && !std::holds_alternative<GroupItem>(group->kind)) return false;
    const std::optional<Anchor> anchor = group ? std::optional(group->anchor) : std::nullopt;
    std::vector<SceneItem> moved = takeOut(scene, id);
    moved.front().parent = parent;
    if (anchor)
        for (SceneItem& item : moved) item.anchor = *anchor;
    putIn(scene, std::move(moved), placeOf(scene, parent, before));
    return true;
}

void setItemRole(Scene& scene, int id, ItemRole role) {
    if (findItem(scene, id) == nullptr) return;
    for (SceneItem& item : scene.items)
        if (item.id == id)
            item.role = role;
        else if (role != ItemRole::virtualOnly)
            item.role = ItemRole::virtualOnly;
}

} // namespace lumorph::studio
