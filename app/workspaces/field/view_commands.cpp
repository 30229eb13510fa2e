#include "app/workspaces/field/view_commands.h"

#include <array>
#include <utility>

#include <glm/vec3.hpp>

namespace lumorph::studio {

namespace {

constexpr std::array<const char*, 6> kViewCommands{"view.frameAll", "view.frameSelected", "view.front",
                                                   "view.right",    "view.top",           "view.orthographic"};

struct Words {
    const char* id;
    const char* text;
    const char* icon;
    const char* shortcut;
};

} // namespace

QAction* addViewCommands(Commands& commands, std::function<ViewportWidget*()> view) {
    const auto add = [&](const Words& words, bool checkable, auto run) {
        const Commands::Options options{words.icon, QKeySequence(words.shortcut), "View", "field", checkable};
        return commands.add(words.id, words.text, options, [view, run] {
            if (ViewportWidget* shown = view()) run(*shown);
        });
    };
    add({"view.frameAll", "Frame all", "frame", "Home"}, false, [](ViewportWidget& shown) { shown.frameAll(); });
    add({"view.frameSelected", "Frame selected", "target", "F"}, false,
        [](ViewportWidget& shown) { shown.frameSelected(); });
    add({"view.front", "From the front", "view-front", "1"}, false, [](ViewportWidget& shown) {
        shown.viewFrom({0.0F, 0.0F, 1.0F});
    });
    add({"view.right", "From the right", "view-right", "3"}, false, [](ViewportWidget& shown) {
        shown.viewFrom({1.0F, 0.0F, 0.0F});
    });
    add({"view.top", "From above", "view-top", "7"}, false, [](ViewportWidget& shown) {
        shown.viewFrom({0.0F, 1.0F, 0.0F});
    });
    add({"view.orthographic", "Orthographic", "ortho", "5"}, true,
        [](ViewportWidget& shown) { shown.setOrthographic(!shown.camera().orthographic); });
    QAction* gizmo = add({"view.gizmo", "Handles on the target", "move", "Ctrl+G"}, true, [](ViewportWidget&) {});
    gizmo->setToolTip("Show handles to move, turn and size the target when it is selected (Ctrl+G)");
    gizmo->setChecked(true);
    return gizmo;
}

void bindViewShortcuts(Commands& commands, ViewportWidget* view) {
    for (const char* id : kViewCommands) {
        QAction* action = commands.find(id);
        action->setShortcutContext(Qt::WidgetShortcut);
        view->addAction(action);
    }
    QAction* orthographic = commands.find("view.orthographic");
    const auto follow = [orthographic, view] { orthographic->setChecked(view->camera().orthographic); };
    QObject::connect(view, &ViewportWidget::cameraChanged, orthographic, follow);
    follow();
}

} // namespace lumorph::studio
