#pragma once

#include <condition_variable>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>

#include <QObject>

#include "app/studio/base/notices.h"
#include "app/studio/document/studio_loop.h"

namespace lumorph::studio {

/// Keeps what applications want kept (ShowContent::keepsake), each in a file: taken from the loop's frames in its own
/// thread, made and written in another, the newest wins. What waits at the end is still written.
class KeepsakeKeeper : public QObject {
    Q_OBJECT
public:
    KeepsakeKeeper(StudioLoop& loop, Notices& notices);
    ~KeepsakeKeeper() override;

    /// From here on what `program` wants kept goes into `file`; of any other nothing is kept.
    void keep(const std::shared_ptr<ShowProgram>& program, const std::filesystem::path& file);

private:
    void take(const MatchFrame& frame); ///< in the loop's thread
    void run(const std::stop_token& stop);
    void write(const std::filesystem::path& file, const std::function<std::string()>& keepsake);

    StudioLoop& loop_;
    Notices& notices_;
    int tap_ = 0;
    std::mutex mutex_; ///< guards what follows
    std::condition_variable_any changed_;
    std::weak_ptr<const ShowProgram> program_;
    std::filesystem::path file_;
    std::map<std::filesystem::path, std::function<std::string()>> waiting_;
    std::jthread writer_; ///< last, so that it ends before what it uses
};

} // namespace lumorph::studio
