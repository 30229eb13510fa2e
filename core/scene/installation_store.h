#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/installation.h"

namespace lumorph {

/// Schema version of an installation's file that this program writes; newer ones are refused.
inline constexpr int kInstallationSchema = 1;

/// An installation from the text of its file (JSON: `lumorph` is "installation", `schemaVersion`, `installation`);
/// `name` stands in errors. What is not stated is as in the virtual lab. Throws DataError naming the key and the
/// remedy.
[[nodiscard]] Installation parseInstallation(std::string_view text, const std::string& name);

/// The text of its file; equal installations give equal bytes. Throws InvalidInput for one that `checkInstallation`
/// refuses.
[[nodiscard]] std::string installationText(const Installation& installation);

/// A figure that tells how good a result is: "camera RMS", 0.12, "px".
struct VersionFigure {
    std::string name;
    double value = 0.0;
    std::string unit; ///< empty: a plain number
    bool operator==(const VersionFigure&) const = default;
};

/// The installation as a measurement left it, and what is to be known of that.
struct InstallationVersion {
    std::string date;  ///< UTC, as in an Origin
    std::string title; ///< what was done: "Projector and camera by structured light"
    std::vector<VersionFigure> figures;
    std::vector<std::string> inputs; ///< what it was made of, a line each: folder, board, patterns
    std::string result;              ///< the whole result as the text of its own file, for reports; may be empty
    Installation installation;
    bool isSimulated = false; ///< what it adds was made in the virtual lab
    bool operator==(const InstallationVersion&) const = default;
};

/// A version that is kept, and where.
struct KeptVersion {
    std::filesystem::path file;
    InstallationVersion version;
};

/// A figure in two versions; empty where one does not have it.
struct FigureChange {
    std::string name;
    std::string unit;
    std::optional<double> before, after;
};
/// All figures of both, those of `after` first.
[[nodiscard]] std::vector<FigureChange> compareFigures(const InstallationVersion& before,
                                                       const InstallationVersion& after);

/// How far apart two installations have one projector or camera, known by its name.
struct DeviceChange {
    std::string name;
    double moved = 0.0;     ///< metres
    double turned = 0.0;    ///< radians
    double focal = 0.0;     ///< share by which the focal length grew
    double principal = 0.0; ///< pixels
};
/// Of projectors, then cameras that are in both.
[[nodiscard]] std::vector<DeviceChange> compareDevices(const Installation& before, const Installation& after);

/// Where a machine keeps the installation of its room: `installation.json` in a folder, and beside it, by date, the
/// last ten that stood there before; and the versions that measurements made of it, in `versions`. One thread at a
/// time.
class InstallationStore {
public:
    static constexpr std::size_t kKept = 10;
    static constexpr std::size_t kKeptVersions = 100;

    explicit InstallationStore(std::filesystem::path folder) : folder_(std::move(folder)) {}

    /// Empty where none has been kept yet. Throws DataError for a file that cannot be read; it stays where it is.
    [[nodiscard]] std::optional<Installation> load() const;

    /// Replaces it whole or not at all; what stood there before becomes an earlier one, where its figures were others.
    /// Throws DeviceError when the
    /// disk refuses, InvalidInput for an installation that is not sound.
    void keep(const Installation& installation);

    /// The files of earlier ones, the newest first.
    [[nodiscard]] std::vector<std::filesystem::path> earlier() const;
    [[nodiscard]] static Installation read(const std::filesystem::path& file);

    /// Keeps a version, whole or not at all, beside the installation, which stays as it is; the oldest beyond
    /// `kKeptVersions` go. Its date must be set. Throws as `keep`.
    std::filesystem::path keepVersion(const InstallationVersion& version);
    /// All that can be read, the newest first. `broken` gets why others cannot, a sentence each.
    [[nodiscard]] std::vector<KeptVersion> versions(std::vector<std::string>* broken = nullptr) const;
    /// Throws DataError naming the key and the remedy.
    [[nodiscard]] static InstallationVersion readVersion(const std::filesystem::path& file);
    /// Throws DeviceError where the disk refuses; one that is gone already is gone.
    static void removeVersion(const std::filesystem::path& file);

    [[nodiscard]] std::filesystem::path file() const { return folder_ / "installation.json"; }

private:
    void putAside() const;
    [[nodiscard]] std::vector<std::filesystem::path> versionFiles() const;

    std::filesystem::path folder_;
};

} // namespace lumorph
