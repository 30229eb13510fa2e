#include "app/studio/document/field_cache.h"

#include <algorithm>
#include <span>
#include <vector>

#include <QCryptographicHash>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/resources.h"
#include "core/geometry/mesh_file.h"
#include "core/mdf/field_file.h"
#include "core/rig/rig_file.h"

namespace lumorph::studio {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostFields = 8;

fs::path fileOf(const fs::path& folder, std::span<const std::byte> rigGlb) {
    const QByteArray bytes =
        QByteArray::fromRawData(reinterpret_cast<const char*>(rigGlb.data()), static_cast<qsizetype>(rigGlb.size()));
    return folder / (QCryptographicHash::hash(bytes, QCryptographicHash::Sha1).toHex().toStdString() + ".mdf");
}

void dropOldest(const fs::path& folder) {
    std::vector<std::pair<fs::file_time_type, fs::path>> files;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder))
        if (entry.path().extension() == ".mdf") files.emplace_back(entry.last_write_time(), entry.path());
    std::sort(files.rbegin(), files.rend());
    for (std::size_t i = kMostFields; i < files.size(); ++i) fs::remove(files[i].second);
}

std::shared_ptr<const MatchField> read(const fs::path& file, const std::vector<std::byte>& rigGlb) {
    auto field = std::make_shared<const MatchField>(parseField(readFile(file, kMaxFileBytes), file.string()));
    return field->field.rigGlb == rigGlb ? field : nullptr;
}

/// The field that is bundled with the tablet, so that a first start matches at once.
std::shared_ptr<const MatchField> bundledField(const Rig& rig, const std::vector<std::byte>& rigGlb) {
    if (!rig.parts().sheet) return nullptr;
    try {
        return read(resourceFile("models/tablet.mdf"), rigGlb);
    } catch (const Error&) {
        return nullptr;
    }
}

} // namespace

std::shared_ptr<const MatchField> FieldCache::find(const Rig& rig) const {
    const std::vector<std::byte> glb = writeRigGlb(rig);
    const fs::path file = fileOf(folder_, glb);
    std::error_code ignored;
    if (!fs::exists(file, ignored)) return bundledField(rig, glb);
    try {
        auto field = read(file, glb);
        if (!field) return nullptr;
        fs::last_write_time(file, fs::file_time_type::clock::now(), ignored);
        return field;
    } catch (const Error&) {
        fs::remove(file, ignored);
        return nullptr;
    }
}

void FieldCache::keep(const Field& field) const {
    try {
        fs::create_directories(folder_);
        writeFileAtomically(fileOf(folder_, field.rigGlb), writeField(field));
        dropOldest(folder_);
    } catch (const Error&) { // it can be built again
    } catch (const fs::filesystem_error&) {
    }
}

} // namespace lumorph::studio
