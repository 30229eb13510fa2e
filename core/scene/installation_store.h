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

/// Where a machine keeps the installation of its room: `installation.json` in a folder, and beside it, by date, the
/// last ten that stood there before. One thread at a time.
class InstallationStore {
public:
    static constexpr std::size_t kKept = 10;

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

    [[nodiscard]] std::filesystem::path file() const { return folder_ / "installation.json"; }

private:
    void putAside() const;

    std::filesystem::path folder_;
};

} // namespace lumorph
