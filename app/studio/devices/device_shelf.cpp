#include "app/studio/devices/device_shelf.h"

#include <QDir>
#include <QFileInfo>

#include "core/base/error.h"

namespace lumorph::studio {
namespace {

constexpr int kLongestName = 60;

} // namespace

QString fileNameOf(const QString& name) {
    QString safe;
    for (const QChar letter : name.trimmed().left(kLongestName))
        safe += letter.isLetterOrNumber() || QStringLiteral(" -_.").contains(letter) ? letter : QChar('_');
    while (safe.startsWith('.')) safe.remove(0, 1); // else the file is hidden
    return safe.isEmpty() ? QString("Device") : safe;
}

std::filesystem::path DeviceShelf::fileOf(const QString& name) const {
    return folder_ / (fileNameOf(name) + ".json").toStdString();
}

QStringList DeviceShelf::names() const {
    QStringList names;
    const QDir folder(QString::fromStdString(folder_.string()));
    for (const QFileInfo& file : folder.entryInfoList({"*.json"}, QDir::Files, QDir::Name))
        names << file.completeBaseName();
    return names;
}

bool DeviceShelf::has(const QString& name) const { return std::filesystem::exists(fileOf(name)); }

DeviceProfile DeviceShelf::load(const QString& name) const {
    DeviceProfile profile = readProfile(fileOf(name));
    profile.name = fileNameOf(name).toStdString();
    return profile;
}

void DeviceShelf::save(const DeviceProfile& profile) const {
    std::error_code error;
    std::filesystem::create_directories(folder_, error);
    if (error)
        throw DataError(folder_.string(), "the folder cannot be made (" + error.message() + ")",
                        "check who may write there");
    writeProfile(profile, fileOf(QString::fromStdString(profile.name)));
}

} // namespace lumorph::studio
