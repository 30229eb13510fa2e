#include "app/studio/base/bundled_files.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/base/resources.h"

namespace lumorph::studio {
namespace {

std::vector<BundledFile> bundledIn(const char* folder) {
    std::vector<BundledFile> all;
    try {
        const std::filesystem::path resources = resourcesFolder();
        for (const auto& entry : std::filesystem::directory_iterator(resources / folder)) {
            if (entry.path().extension() != ".glb") continue;
            const std::string name = entry.path().stem().string();
            QString title = QString::fromStdString(name).replace('_', ' ');
            title[0] = title[0].toUpper();
            const auto picture = resources / "thumbnails" / folder / (name + ".png");
            all.push_back({title, entry.path(), std::filesystem::exists(picture) ? picture : ""});
        }
    } catch (const Error&) {                             // an installation without them is told of elsewhere
    } catch (const std::filesystem::filesystem_error&) { // so is a folder that cannot be read
    }
    std::ranges::sort(all, {}, &BundledFile::title);
    return all;
}

} // namespace

std::vector<BundledFile> bundledRigs() { return bundledIn("models"); }
std::vector<BundledFile> bundledTargets() { return bundledIn("targets"); }

} // namespace lumorph::studio
