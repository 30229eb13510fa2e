#include "app/applications/field/field_demo.h"

#include "core/mdf/builder.h"

namespace lumorph {
namespace {

ProjectContents openField(const Progress& progress) {
    Project project;
    project.rig = "resource:models/tablet.glb";
    project.target = "resource:targets/bloom.glb";
    ProjectContents contents = readContents(std::move(project), {}, progress);
    // As large as fits: for that the field's frame is enough, which is known before the field is built.
    Field room;
    room.frame = frameOf(contents.rig->reach(), BuildOptions{}.resolution);
    room.restSurface = boundingBox(contents.rig->restMesh().positions).max.y;
    contents.project.placement = fitPlacement(room, contents.target->box);
    return contents;
}

} // namespace

Demo fieldDemo() {
    return {.name = "field",
            .title = {"A flower on six servos", "Eine Blume aus sechs Servos"},
            .sentence = {"A tablet follows an opening flower as well as it can; colour shows what is left out.",
                         "Ein Tablet folgt einer Blüte, die sich öffnet, so gut es kann; Farbe zeigt, was fehlt."},
            .thumbnail = "thumbnails/field.png",
            .workspace = "field",
            .open = openField,
            .forVisitors = false};
}

} // namespace lumorph
