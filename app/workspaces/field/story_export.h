#pragma once

#include <QWidget>

#include "app/studio/shell/studio.h"
#include "app/workspaces/common/field_output.h"
#include "app/workspaces/field/story.h"
#include "core/render/viewport/view_camera.h"

namespace lumorph::studio {

/// What of the story is to be kept: a picture of it and how its three-dimensional view is looked at.
struct StoryShot {
    StoryPicture picture;
    ViewCamera camera;
    double ratio = 1.6; ///< of the view, width to height
};

/// A page of the story. Throws what `paint` throws.
[[nodiscard]] QImage storyPage(const StoryShot& shot, const PictureStyle& style, const Painter& paint,
                               const Progress& progress = {});

/// The pictures of a video of the whole story, and for how many frames each stands.
struct StoryFrames {
    StoryView view;
    int frames = 1;
};
[[nodiscard]] std::vector<StoryFrames> storyFrames(const StoryPicture& picture, double framesPerSecond);
/// The whole story as MP4, `style.size` made even; it begins with the shot's actuator. Throws DeviceError, Cancelled.
void writeStory(const StoryShot& shot, const PictureStyle& style, const Painter& paint,
                const std::filesystem::path& file, const Progress& progress = {});

/// Asks how and where, then writes as a job of the place "export".
void exportStoryPicture(Studio& studio, QWidget* parent, const StoryShot& shot);
void exportStoryVideo(Studio& studio, QWidget* parent, const StoryShot& shot);

} // namespace lumorph::studio
