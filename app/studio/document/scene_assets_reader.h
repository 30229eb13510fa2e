#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <QObject>

#include "app/studio/document/assets.h"
#include "app/studio/document/job_slots.h"
#include "app/studio/document/studio_document.h"

namespace lumorph::studio {

/// Reads what the document's scene names, whenever an edit or undo names something else, and says what cannot be read.
class SceneAssetsReader : public QObject {
    Q_OBJECT
public:
    SceneAssetsReader(StudioDocument& document, JobSlots& jobs, Notices& notices);

    /// Another project is there: nothing is known of its scene's files, or what came with it.
    void reset();
    void takeOpened();
    /// The file has changed on disk.
    void readAgain(const std::string& asset);
    void tellVanished(const std::string& asset);
    /// Names another file instead, by one step of undo.
    void relink(const std::string& asset, const std::filesystem::path& file);
    /// How the scene's files looked when they were read.
    [[nodiscard]] std::map<std::string, FileStamp> stamps();

signals:
    /// The remedy of a notice: ask for another file instead of this one.
    void assetWanted(const QString& asset);

private:
    void readMissing();
    void read(std::shared_ptr<const SceneAssets> before);
    void take(const std::shared_ptr<const SceneAssets>& assets);
    [[nodiscard]] Notice::Action offerRelink(const std::string& asset);

    StudioDocument& document_;
    JobSlots& jobs_;
    Notices& notices_;
    std::vector<std::string> reading_; ///< what the scene names of which is being read
    std::map<std::string, FileStamp> stamps_;
};

} // namespace lumorph::studio
