#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>

#include "app/studio/document/studio_state.h"
#include "core/base/progress.h"

namespace lumorph::studio {

enum class FileKind { project, field, rig, target, voxels, recording, unknown };

/// What a file is to the studio, by its name and, of a glTF, by what it holds: one with actuators is a rig. Throws
/// DataError for a glTF that cannot be read.
[[nodiscard]] FileKind kindOf(const std::filesystem::path& path);

/// What a file (or the files of a folder) looked like from outside; another stamp means other contents.
struct FileStamp {
    bool there = false;
    std::uintmax_t size = 0;
    std::filesystem::file_time_type time{};
    bool operator==(const FileStamp&) const = default;
};
[[nodiscard]] FileStamp stampOf(const std::filesystem::path& path);

/// How the files of a state's assets looked when they were read; empty for what came from no file.
struct AssetStamps {
    std::optional<FileStamp> rig, field, target;
};

/// Remembers the stamps of everything that was read and still lives, also of what only undo holds.
class ReadFiles {
public:
    void remember(const std::shared_ptr<const void>& asset, const FileStamp& stamp);
    void remember(const StudioState& state, const AssetStamps& stamps);
    [[nodiscard]] AssetStamps of(const StudioState& state) const;

private:
    [[nodiscard]] std::optional<FileStamp> find(const std::shared_ptr<const void>& asset) const;
    std::map<std::weak_ptr<const void>, FileStamp, std::owner_less<>> stamps_;
};

/// An asset and the stamp its file had just before it was read.
template <class Asset> struct Stamped {
    Asset asset;
    FileStamp stamp;
};

/// Each throws what the reader of its kind throws: DataError naming file, place and remedy; Cancelled.
[[nodiscard]] Stamped<StudioState::RigAsset> readRigAsset(const std::filesystem::path& path);
[[nodiscard]] Stamped<StudioState::FieldAsset> readFieldAsset(const std::filesystem::path& file);
[[nodiscard]] Stamped<StudioState::TargetAsset> readTargetAsset(const std::filesystem::path& file,
                                                                std::optional<int> animation, const Progress& progress);

/// Where a target of this box stands on the rig when it is as large as fits; for a rig without a field yet, as in a
/// field of usual resolution. Throws InvalidInput when it cannot.
[[nodiscard]] Placement placementThatFits(const Rig& rig, const MatchField* field, const Box& box, Angle yaw,
                                          const glm::quat& orientation = {1.0F, 0.0F, 0.0F, 0.0F});

} // namespace lumorph::studio
