#include "app/studio/document/scene_edit.h"
#include "app/studio/shell/tour.h"

namespace lumorph::studio {
namespace {

void showBoth(Studio& studio) {
    studio.loop.setScenePlaying(true);
    editScene(studio.document, "Show both", [](Scene& scene) { scene.showing = Showing::both; });
}

void run(Studio& studio, const char* command) {
    if (QAction* action = studio.commands.find(command)) action->trigger();
}

} // namespace

std::vector<TourStep> tourSteps(Studio& studio) {
    return {
        {{"scene.stage"},
         "This is the show",
         "A sheet of paper over six flaps, each lifted by a servo, and a projector that paints it. Everything here is "
         "simulated, so nothing can break. Drag in a picture to lead the viewer around the device.",
         {},
         {}},
        {{"scene.showing"},
         "Servos, light, or both",
         "Try all three: Physical shows what the servos alone can do, Light what light alone can do. Together the "
         "servos "
         "take the coarse shape, and light adds all that is too fine or too fast for them.",
         "Show both",
         [&studio] { showBoth(studio); },
         "scene.stage"},
        {{"dock.scene.outliner"},
         "What is in the scene",
         "Things that light draws, and below them device, table, projector and viewer. Add more here, or drop a glTF "
         "model or a picture anywhere on the window.",
         "Add a box",
         [&studio] { run(studio, "scene.add.box"); },
         "scene.stage"},
        {{"dock.scene.inspector"},
         "Change what you choose",
         "Choose something in the outliner: all its numbers are here. Drag one sideways, or click and type it with its "
         "unit. Everything can be taken back with Ctrl+Z.",
         {},
         {},
         "dock.scene.outliner"},
        {{"tab.field"},
         "Match a shape",
         "In the Field workspace the device takes the shape of any 3D model, and you see how well it can. The Rig "
         "workspace tells what its actuators reach.",
         {},
         {}},
    };
}

} // namespace lumorph::studio
