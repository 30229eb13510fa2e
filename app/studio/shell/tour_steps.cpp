#include "app/studio/shell/tour.h"

#include "core/base/error.h"
#include "core/base/resources.h"

namespace lumorph::studio {
namespace {

void openBundledTarget(Studio& studio) {
    try {
        studio.desk.openTarget(resourceFile("targets/bloom.glb"));
    } catch (const Error& error) {
        studio.notices.post("target", noticeOf(error));
    }
}

void matchLive(Studio& studio) {
    studio.loop.setDancing(false);
    studio.loop.resume();
    studio.document.change("Match live", [](StudioState& state) {
        state.matching.live = true;
        state.playback.playing = true;
    });
}

} // namespace

std::vector<TourStep> tourSteps(Studio& studio) {
    return {
        {{"field.viewport"},
         "This is the tablet",
         "A sheet of paper over six flaps, each lifted by a servo. Everything here is simulated, so nothing can break. "
         "Drag to turn it, scroll to come closer.",
         {},
         {}},
        {{"dock.target"},
         "Give it a shape",
         "Drop a 3D model anywhere on the window, or open one here. It becomes the target: the shape that the tablet "
         "tries to take.",
         "Use petals that open and close",
         [&studio] { openBundledTarget(studio); }},
        {{"dock.match"},
         "Watch it match",
         "These numbers say how well the tablet takes the target's shape right now, and how long finding it took. "
         "Colour on the model shows what is left out.",
         "Match live",
         [&studio] { matchLive(studio); }},
        {{"dock.actuators"},
         "Move it by hand",
         "Each actuator has a slider. Pull one: the tablet stops following the target and holds what you set.",
         "Let it dance",
         [&studio] { studio.loop.setDancing(true); }},
        {{"dock.field"},
         "Look into the field",
         "The field knows which places each actuator reaches at which level. Show it as voxels, cut it open, and click "
         "a voxel to see its ramp.",
         {},
         {}},
    };
}

} // namespace lumorph::studio
