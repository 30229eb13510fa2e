#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include <QImage>
#include <QSize>

#include "app/studio/rendering/render_thread.h"
#include "core/base/image.h"
#include "core/base/progress.h"
#include "core/loop/match_frame.h"
#include "core/loop/match_wish.h"

namespace lumorph::studio {

/// What the exports of the Field workspace write, without any window. Each function writes whole or not at all and
/// throws what core throws: DeviceError when the disk refuses, InvalidInput for what cannot be, Cancelled.

/// The device as a mesh by the file's ending (.obj, .glb, .stl), device metres: where it stands (`estimated`), or where
/// it is asked to be.
void writeShape(const MatchFrame& frame, bool estimated, const std::filesystem::path& file);

/// The field as an .mdf file.
void writeFieldFile(const Field& field, const std::filesystem::path& file);

/// A folder of this name inside `parent` that is not there yet: the name, then "name 2", "name 3" and so on.
[[nodiscard]] std::filesystem::path freshFolder(const std::filesystem::path& parent, const std::string& name);

/// The field as NRRD files in a new folder inside `parent`, named after the rig; gives that folder. Nothing that is
/// there is replaced.
[[nodiscard]] std::filesystem::path writeFieldGrids(const Field& field, const std::filesystem::path& parent,
                                                    const Progress& progress = {});

/// The target of a frame, where it stood, as 0 and 1 in the field's frame (NRRD, x fastest). Needs field and target.
void writeTargetVoxels(const MatchFrame& frame, const std::filesystem::path& file);

/// The match of one frame as a table of one line, in the columns of `clipCsv`. Needs a field.
[[nodiscard]] std::string tableOfNow(const MatchFrame& frame);
/// The whole animation of the frame's target where it is placed, matched frame by frame, as `clipCsv`. Needs a field
/// and an animated target.
[[nodiscard]] std::string tableOfClip(const MatchFrame& frame, const Placement& placement, MatchMethod method,
                                      Microseconds budget, const Progress& progress = {});

/// How a picture or a video is drawn.
struct PictureStyle {
    QSize size{1920, 1200}; ///< pixels
    Theme theme = Theme::dark;
    bool grid = true;      ///< the grid on the ground
    bool gridLabel = true; ///< how large its squares are, written into the lower left corner
    bool operator==(const PictureStyle&) const = default;
};

/// The scene of a view as a picture: in the style's theme, without the marks of editing, and from so far away that what
/// a view of `ratio` (width to height) shows is all there.
[[nodiscard]] FrameRequest pictureRequest(const std::shared_ptr<const ViewportScene>& scene, const ViewCamera& camera,
                                          double ratio, const PictureStyle& style);
/// Writes the grid's label into a drawn picture where the style asks for it.
void addGridLabel(QImage& picture, const FrameRequest& request, const PictureStyle& style);
/// The same pixels as core's picture, and back.
[[nodiscard]] Image imageOf(const QImage& picture);
[[nodiscard]] QImage pictureOf(const Image& image);

/// Draws one picture while a job waits for it. Throws DeviceError when it could not be drawn, Cancelled.
using Painter = std::function<QImage(const FrameRequest&, const Progress&)>;

struct Turntable {
    PictureStyle style{{1280, 720}, Theme::dark, true, false};
    double seconds = 6.0; ///< for one turn
    double framesPerSecond = 30.0;
    [[nodiscard]] int frames() const noexcept;
};
/// The camera circles the scene once; MP4. Sides are made even.
void writeTurntable(const Turntable& turntable, const std::shared_ptr<const ViewportScene>& scene,
                    const ViewCamera& camera, double ratio, const Painter& paint, const std::filesystem::path& file,
                    const Progress& progress = {});

} // namespace lumorph::studio
