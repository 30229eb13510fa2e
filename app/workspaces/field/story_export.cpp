#include "app/workspaces/field/story_export.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <QPointer>

#include "app/output/video_writer.h"
#include "app/workspaces/common/export_dialogs.h"
#include "app/workspaces/common/field_colors.h"
#include "app/workspaces/field/field_exports.h"
#include "app/workspaces/field/story_painter.h"
#include "app/workspaces/field/story_scene.h"

namespace lumorph::studio {

namespace {

constexpr double kStoryRate = 30.0;      ///< frames a second
constexpr double kLevelsSeconds = 4.0;   ///< in which all levels are run through
constexpr double kReadSeconds = 4.0;     ///< to read a page on
constexpr double kActuatorSeconds = 1.5; ///< for the votes of one more actuator
constexpr std::size_t kMostVotes = 8;    ///< actuators whose votes are shown one by one
constexpr QSize kVideoSize(1280, 720);

std::filesystem::path pathOfText(const QString& text) { return std::filesystem::path(text.toStdString()); }

FrameRequest viewRequest(const StoryShot& shot, StorySceneBuilder& builder, const PictureStyle& style) {
    PictureStyle beside = style;
    beside.size = viewOnPage(style.size).size();
    FrameRequest request = pictureRequest(builder.build(shot.picture), shot.camera, shot.ratio, beside);
    request.scale = std::max(1.0, style.size.height() / 900.0);
    return request;
}

QImage pageOf(const StoryShot& shot, const PictureStyle& style, const FrameRequest& request, QImage view) {
    addGridLabel(view, request, style);
    QImage page(style.size, QImage::Format_RGB32);
    QPainter painter(&page);
    paintPage(painter, shot.picture, view, style.size, paletteOf(style.theme));
    return page;
}

/// A page of the story, its scene made by `builder`.
QImage drawnPage(const StoryShot& shot, const PictureStyle& style, StorySceneBuilder& builder, const Painter& paint,
                 const Progress& progress) {
    const FrameRequest request = viewRequest(shot, builder, style);
    return pageOf(shot, style, request, paint(request, progress));
}

QString storyName(const StoryPicture& picture) {
    return QString::fromStdString(picture.story->rig->name()).replace('/', '-');
}

PreviewPainter previewOf(Studio& studio, const StoryShot& shot) {
    return [shot, renderer = QPointer<RenderThread>(&studio.renderer)](const PictureStyle& style,
                                                                       std::function<void(QImage)> done) {
        if (!renderer) return;
        StorySceneBuilder builder(fieldSceneColors(style.theme));
        const FrameRequest request = viewRequest(shot, builder, style);
        renderer->picture(request, [shot, style, request, done = std::move(done)](QImage view, const QString&) {
            if (!view.isNull()) done(pageOf(shot, style, request, std::move(view)));
        });
    };
}

} // namespace

QImage storyPage(const StoryShot& shot, const PictureStyle& style, const Painter& paint, const Progress& progress) {
    StorySceneBuilder builder(fieldSceneColors(style.theme));
    return drawnPage(shot, style, builder, paint, progress);
}

std::vector<StoryFrames> storyFrames(const StoryPicture& picture, double framesPerSecond) {
    const auto framesOf = [framesPerSecond](double seconds) {
        return std::max(1, static_cast<int>(std::lround(seconds * framesPerSecond)));
    };
    std::vector<StoryFrames> frames;
    const auto add = [&](StoryView view, double seconds) {
        StoryPicture one = picture;
        one.view = view;
        view.plane = one.view.plane = tellingPlane(one);
        if (canBeTold(one)) frames.push_back({view, framesOf(seconds)});
    };
    const int levels = picture.story->field->field.levels;
    StoryView view = picture.view;
    for (const StoryStep step : {StoryStep::states, StoryStep::field}) {
        view.step = step;
        for (view.level = 0; view.level < levels; ++view.level) add(view, kLevelsSeconds / levels);
        view.level = levels - 1;
        add(view, kReadSeconds);
    }
    for (const StoryStep step : {StoryStep::all, StoryStep::target}) {
        view.step = step;
        add(view, 1.5 * kReadSeconds);
    }
    view.step = StoryStep::votes;
    add(view, kReadSeconds);
    const std::size_t actuators = picture.story->rig->actuatorCount();
    for (std::size_t k = 1; k < std::min(actuators, kMostVotes); ++k) {
        StoryView other = view;
        other.actuator = (view.actuator + k) % actuators;
        add(other, kActuatorSeconds);
    }
    view.step = StoryStep::fit;
    add(view, 1.5 * kReadSeconds);
    return frames;
}

void writeStory(const StoryShot& shot, const PictureStyle& style, const Painter& paint,
                const std::filesystem::path& file, const Progress& progress) {
    PictureStyle even = style;
    const glm::ivec2 size = evenSize({style.size.width(), style.size.height()});
    even.size = QSize(size.x, size.y);
    const std::vector<StoryFrames> frames = storyFrames(shot.picture, kStoryRate);
    VideoWriter video(file, size, kStoryRate);
    StorySceneBuilder builder(fieldSceneColors(style.theme));
    for (std::size_t k = 0; k < frames.size(); ++k) {
        progress.throwIfCancelled();
        progress.report(static_cast<double>(k) / static_cast<double>(frames.size()), "drawing the story");
        StoryShot now = shot;
        now.picture.view = frames[k].view;
        const Image page = imageOf(drawnPage(now, even, builder, paint, progress));
        for (int frame = 0; frame < frames[k].frames; ++frame) {
            progress.throwIfCancelled();
            video.add(page);
        }
    }
    progress.throwIfCancelled();
    video.finish();
}

void exportStoryPicture(Studio& studio, QWidget* parent, const StoryShot& shot) {
    PictureStyle style{{1920, 1080}, studio.settings.theme(), true, false};
    const QPointer<QWidget> over = parent;
    askPicture(parent, style, 16.0 / 9.0, previewOf(studio, shot), [&studio, over, shot](const PictureStyle& chosen) {
        askFile(over, studio.settings, "export.story.picture", QObject::tr("Export this step as a picture"),
                storyName(shot.picture) + " " + nameOf(shot.picture.view.step).toLower(),
                {{QObject::tr("PNG picture"), "png"}}, [&studio, over, shot, chosen](const QString& file) {
                    runExport(
                        studio, QObject::tr("Drawing the picture"),
                        [&studio, over, shot] { exportStoryPicture(studio, over, shot); },
                        [shot, chosen, paint = painterOf(studio), path = pathOfText(file)](const Progress& progress) {
                            progress.report(0.1, "drawing");
                            const QImage page = storyPage(shot, chosen, paint, progress);
                            progress.report(0.7, "writing the file");
                            progress.throwIfCancelled();
                            writePng(imageOf(page), path);
                            return path;
                        });
                });
    });
}

void exportStoryVideo(Studio& studio, QWidget* parent, const StoryShot& shot) {
    const QPointer<QWidget> over = parent;
    askFile(parent, studio.settings, "export.story.video", QObject::tr("Export the whole story as a video"),
            storyName(shot.picture) + " " + QObject::tr("story"), {{QObject::tr("MP4 video"), "mp4"}},
            [&studio, over, shot](const QString& file) {
                const PictureStyle style{kVideoSize, studio.settings.theme(), true, false};
                runExport(
                    studio, QObject::tr("Drawing the story"),
                    [&studio, over, shot] { exportStoryVideo(studio, over, shot); },
                    [shot, style, paint = painterOf(studio), path = pathOfText(file)](const Progress& progress) {
                        writeStory(shot, style, paint, path, progress);
                        return path;
                    });
            });
}

} // namespace lumorph::studio
