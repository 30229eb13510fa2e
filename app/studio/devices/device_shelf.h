#pragma once

#include <filesystem>
#include <string>

#include <QStringList>

#include "devices/controllers/device_profile.h"

namespace lumorph::studio {

/// Device profiles by name, a file each in one folder.
class DeviceShelf {
public:
    explicit DeviceShelf(std::filesystem::path folder) : folder_(std::move(folder)) {}

    [[nodiscard]] QStringList names() const;
    [[nodiscard]] bool has(const QString& name) const;
    /// Throws DataError.
    [[nodiscard]] DeviceProfile load(const QString& name) const;
    /// Under the name that it has. Throws DataError.
    void save(const DeviceProfile& profile) const;
    [[nodiscard]] std::filesystem::path fileOf(const QString& name) const;

private:
    std::filesystem::path folder_;
};

/// A name that may be one of a file: letters, digits, spaces and `-_.`, not empty, not long.
[[nodiscard]] QString fileNameOf(const QString& name);

} // namespace lumorph::studio
