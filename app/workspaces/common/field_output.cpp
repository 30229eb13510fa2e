#include "app/workspaces/common/field_output.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <span>
#include <system_error>

#include <QPainter>

#include "app/output/video_writer.h"
#include "app/studio/look/palette.h"
#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/geometry/mesh_file.h"
#include "core/mdf/clip.h"
#include "core/mdf/field_export.h"
#include "core/mdf/field_file.h"
#include "core/render/viewport/viewport_renderer.h"
#include "core/voxels/nrrd.h"

namespace lumorph::studio {
namespace {

namespace fs = std::filesystem;

/// A name for a folder out of what a rig is called.
std::string fileNameOf(const std::string& text) {
    std::string name;
    for (const char c : text) name += (c == '/' || c == '\\' || static_cast<unsigned char>(c) < 32) ? '-' : c;
    while (!name.empty() && name.front() == '.') name.erase(name.begin());
    return name.empty() ? "field" : name.substr(0, 80);
}

/// A folder that is removed with all in it unless it was kept.
class HalfFolder {
public:
    explicit HalfFolder(fs::path folder) : folder_(std::move(folder)) {}
    HalfFolder(const HalfFolder&) = delete;
    HalfFolder& operator=(const HalfFolder&) = delete;
    ~HalfFolder() {
        std::error_code ignored;
        if (!folder_.empty()) fs::remove_all(folder_, ignored);
    }
    void keep() noexcept { folder_.clear(); }

private:
    fs::path folder_;
};

} // namespace

fs::path freshFolder(const fs::path& parent, const std::string& name) {
    fs::path folder = parent / name;
    for (int k = 2; fs::exists(fs::symlink_status(folder)); ++k) folder = parent / (name + " " + std::to_string(k));
    return folder;
}

void writeShape(const MatchFrame& frame, bool estimated, const fs::path& file) {
    writeMesh(deformed(*frame.rig, estimated ? frame.estimatedStrokes : frame.wantedStrokes), file);
}

void writeFieldFile(const Field& field, const fs::path& file) { writeFileAtomically(file, writeField(field)); }

fs::path writeFieldGrids(const Field& field, const fs::path& parent, const Progress& progress) {
    const std::string name = fileNameOf(field.rigName) + " field";
    const fs::path temporary = freshFolder(parent, "." + name + " being written");
    HalfFolder half(temporary);
    exportField(field, temporary, progress);
    progress.throwIfCancelled();
    const fs::path folder = freshFolder(parent, name);
    std::error_code error;
    fs::rename(temporary, folder, error);
    if (error)
        throw DeviceError(folder.string(), "cannot be written: " + error.message(),
                          "choose another place, or check its permissions");
    half.keep();
    return folder;
}

void writeTargetVoxels(const MatchFrame& frame, const fs::path& file) {
    if (!frame.field || !frame.target)
        throw InvalidInput("target voxels", "there is no field or no target", "open both first");
    Target target = frame.target->solid;
    target.mesh = meshAt(*frame.target, frame.seconds);
    for (glm::vec3& position : target.mesh.positions)
        position = glm::vec3(frame.deviceFromTarget * glm::vec4(position, 1.0F));
    const VoxelFrame& voxels = frame.field->field.frame;
    SolidVoxelizer voxelizer;
    BitColumns bits;
    if (frame.relief && frame.field->relief)
        voxelizeRelief(*frame.field->relief, target.mesh.positions, target.mesh.triangles, bits);
    else
        voxelizeTarget(voxels, target, voxelizer, bits);
    writeFileAtomically(file, writeNrrd(bytesOf(voxels, bits), "target"));
}

std::string tableOfNow(const MatchFrame& frame) {
    if (!frame.field) throw InvalidInput("table of the match", "there is no field", "build one first");
    ClipFrame now;
    now.seconds = frame.seconds;
    now.wanted = frame.wanted;
    now.strokes = frame.estimatedStrokes;
    now.iouWanted = frame.iouWanted;
    now.iouReached = frame.iouEstimated;
    return clipCsv(frame.field->field, {now});
}

std::string tableOfClip(const MatchFrame& frame, const Placement& placement, MatchMethod method, Microseconds budget,
                        const Progress& progress) {
    if (!frame.field || !frame.target || !frame.target->model || frame.target->animation < 0)
        throw InvalidInput("table of the animation", "there is no field or no animated target", "open both first");
    ClipOptions options;
    options.refined = method == MatchMethod::refined;
    options.budget = budget;
    options.placement = placement;
    const MatchField& field = *frame.field;
    const Model& model = *frame.target->model;
    return clipCsv(field.field,
                   matchClip(field.field, field.coverage, field.voting, model,
                             model.animations[static_cast<std::size_t>(frame.target->animation)], options, progress));
}

FrameRequest pictureRequest(const std::shared_ptr<const ViewportScene>& scene, const ViewCamera& camera, double ratio,
                            const PictureStyle& style) {
    auto drawn = std::make_shared<ViewportScene>(*scene);
    for (ViewportSurface& surface : drawn->surfaces) surface.outlined = false;
    drawn->theme = style.theme;
    drawn->grid = style.grid;
    FrameRequest request;
    request.scene = std::move(drawn);
    request.camera = camera;
    request.pixels = style.size;
    const double ownRatio = static_cast<double>(style.size.width()) / style.size.height();
    if (ownRatio < ratio) request.camera.distance *= ratio / ownRatio;
    // What is a line of 1.5 pixels in a window would vanish in a large picture.
    request.scale = std::max(1.0, style.size.height() / 900.0);
    return request;
}

void addGridLabel(QImage& picture, const FrameRequest& request, const PictureStyle& style) {
    if (!style.grid || !style.gridLabel) return;
    const glm::vec2 size(picture.width(), picture.height());
    QPainter painter(&picture);
    QFont font = painter.font();
    font.setPixelSize(std::max(9, picture.height() / 50));
    painter.setFont(font);
    painter.setPen(paletteOf(style.theme).textMuted);
    const int margin = font.pixelSize();
    painter.drawText(picture.rect().adjusted(margin, margin, -margin, -margin), Qt::AlignLeft | Qt::AlignBottom,
                     QObject::tr("Grid %1").arg(QString::fromStdString(gridOf(request.camera, size).label)));
}

Image imageOf(const QImage& picture) {
    const QImage rgba = picture.convertToFormat(QImage::Format_RGBA8888);
    Image image(glm::ivec2(rgba.width(), rgba.height()));
    const auto row = static_cast<std::size_t>(rgba.width());
    for (int y = 0; y < rgba.height(); ++y)
        std::memcpy(&image.pixels()[static_cast<std::size_t>(y) * row], rgba.constScanLine(y),
                    row * sizeof(Image::Pixel));
    return image;
}

QImage pictureOf(const Image& image) {
    QImage picture(image.size().x, image.size().y, QImage::Format_RGBA8888);
    const auto row = static_cast<std::size_t>(image.size().x);
    for (int y = 0; y < image.size().y; ++y)
        std::memcpy(picture.scanLine(y), &image.pixels()[static_cast<std::size_t>(y) * row],
                    row * sizeof(Image::Pixel));
    return picture;
}

int Turntable::frames() const noexcept { return std::max(1, static_cast<int>(std::lround(seconds * framesPerSecond))); }

void writeTurntable(const Turntable& turntable, const std::shared_ptr<const ViewportScene>& scene,
                    const ViewCamera& camera, double ratio, const Painter& paint, const fs::path& file,
                    const Progress& progress) {
    PictureStyle style = turntable.style;
    const glm::ivec2 size = evenSize({style.size.width(), style.size.height()});
    style.size = QSize(size.x, size.y);
    FrameRequest request = pictureRequest(scene, camera, ratio, style);
    const int frames = turntable.frames();
    VideoWriter video(file, size, turntable.framesPerSecond);
    for (int k = 0; k < frames; ++k) {
        progress.throwIfCancelled();
        progress.report(static_cast<double>(k) / frames, "drawing the turn");
        request.camera.yaw = Angle::radians(camera.yaw.inRadians() + 2.0 * std::numbers::pi * k / frames);
        QImage picture = paint(request, progress);
        addGridLabel(picture, request, style);
        video.add(imageOf(picture));
    }
    progress.throwIfCancelled();
    video.finish();
}

} // namespace lumorph::studio
