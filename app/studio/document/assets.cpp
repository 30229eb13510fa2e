#include "app/studio/document/assets.h"

#include <algorithm>
#include <string>

#include "app/studio/document/state_rules.h"
#include "core/base/file.h"
#include "core/geometry/mesh_file.h"
#include "core/geometry/model.h"
#include "core/mdf/builder.h"
#include "core/mdf/field_file.h"
#include "core/rig/rig_file.h"

namespace lumorph::studio {

namespace {

namespace fs = std::filesystem;

std::string extensionOf(const fs::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension;
}

bool holdsActuators(const Model& model) {
    const auto names = [](const nlohmann::json& extras) { return extras.is_object() && extras.contains("lumorph"); };
    return names(model.extras) ||
           std::any_of(model.nodes.begin(), model.nodes.end(), [&](const auto& node) { return names(node.extras); }) ||
           std::any_of(model.meshes.begin(), model.meshes.end(), [&](const auto& mesh) { return names(mesh.extras); });
}

void include(FileStamp& stamp, const fs::path& path) {
    std::error_code failed;
    const std::uintmax_t size = fs::file_size(path, failed);
    if (!failed) stamp.size += size;
    const fs::file_time_type time = fs::last_write_time(path, failed);
    if (!failed) stamp.time = std::max(stamp.time, time);
}

} // namespace

FileKind kindOf(const fs::path& path) {
    std::error_code ignored;
    if (fs::is_directory(path, ignored)) return FileKind::rig;
    const std::string extension = extensionOf(path);
    if (extension == ".lumorph") return FileKind::project;
    if (extension == ".mdf") return FileKind::field;
    if (extension == ".lumorphrec") return FileKind::recording;
    if (extension == ".nrrd") return FileKind::voxels;
    if (extension == ".glb" || extension == ".gltf")
        return holdsActuators(readModel(path)) ? FileKind::rig : FileKind::target;
    if (extension == ".obj" || extension == ".stl" || extension == ".ply" || extension == ".off")
        return FileKind::target;
    return FileKind::unknown;
}

FileStamp stampOf(const fs::path& path) {
    FileStamp stamp;
    std::error_code failed;
    const fs::file_status status = fs::status(path, failed);
    if (failed || !fs::exists(status)) return stamp;
    stamp.there = true;
    stamp.time = fs::file_time_type::min();
    include(stamp, path);
    if (fs::is_directory(status))
        for (fs::directory_iterator at(path, failed), end; !failed && at != end; at.increment(failed))
            include(stamp, at->path());
    return stamp;
}

void ReadFiles::remember(const std::shared_ptr<const void>& asset, const FileStamp& stamp) {
    std::erase_if(stamps_, [](const auto& entry) { return entry.first.expired(); });
    if (asset) stamps_[asset] = stamp;
}

void ReadFiles::remember(const StudioState& state, const AssetStamps& stamps) {
    if (stamps.rig) remember(state.rig.rig, *stamps.rig);
    if (stamps.field) remember(state.field.field, *stamps.field);
    if (stamps.target) remember(state.target.target, *stamps.target);
}

AssetStamps ReadFiles::of(const StudioState& state) const {
    // No file holds an edited rig.
    const auto rig = isEdited(state.rig) ? nullptr : state.rig.rig;
    return {find(rig), find(state.field.field), find(state.target.target)};
}

std::optional<FileStamp> ReadFiles::find(const std::shared_ptr<const void>& asset) const {
    const auto found = asset ? stamps_.find(asset) : stamps_.end();
    return found == stamps_.end() ? std::nullopt : std::optional(found->second);
}

Stamped<StudioState::RigAsset> readRigAsset(const fs::path& path) {
    const FileStamp stamp = stampOf(path);
    return {{path, std::make_shared<const Rig>(readRig(path))}, stamp};
}

Stamped<StudioState::FieldAsset> readFieldAsset(const fs::path& file) {
    const FileStamp stamp = stampOf(file);
    Field field = parseField(readFile(file, kMaxFileBytes), file.string());
    return {{file, std::make_shared<const MatchField>(std::move(field))}, stamp};
}

Stamped<StudioState::TargetAsset> readTargetAsset(const fs::path& file, std::optional<int> animation,
                                                  const Progress& progress) {
    const FileStamp stamp = stampOf(file);
    return {{file, readMatchTarget(file, animation, progress)}, stamp};
}

Placement placementThatFits(const Rig& rig, const MatchField* field, const Box& box, Angle yaw,
                            const glm::quat& orientation) {
    if (field) return fitPlacement(field->field, box, yaw, orientation);
    Field room; // fitting asks for the frame and the rest surface alone
    room.frame = frameOf(rig.reach(), BuildOptions{}.resolution);
    room.restSurface = boundingBox(rig.restMesh().positions).max.y;
    return fitPlacement(room, box, yaw, orientation);
}

} // namespace lumorph::studio
