#pragma once

#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>
#include <vector>

#include <QObject>
#include <QString>

#include "app/studio/base/notices.h"
#include "app/studio/document/studio_document.h"

namespace lumorph::studio {

/// Compiles the document's rig while it is edited, in a thread of its own: of many edits the newest that has come when
/// the one before is done, so that a drag shows what it can and never queues. Parts that do not fit together leave the
/// last rig in place, with a notice at "rig" until they do.
class RigCompiler : public QObject {
    Q_OBJECT
public:
    RigCompiler(StudioDocument& document, Notices& notices, QObject* parent = nullptr);
    ~RigCompiler() override;

private:
    struct Compiled {
        std::weak_ptr<const RigParts> parts;
        std::shared_ptr<const Rig> rig;
    };
    void follow();
    void ask(const StudioState::RigAsset& asset);
    void work(const std::stop_token& stop); ///< in the thread
    void take(const StudioState::RigAsset& of, const std::shared_ptr<const Rig>& rig);
    void tell(const StudioState::RigAsset& of, const std::exception_ptr& failure);
    void keep(const StudioState::RigAsset& of, const std::shared_ptr<const Rig>& rig);

    StudioDocument& document_;
    Notices& notices_;
    std::vector<Compiled> known_; ///< of parts that undo may bring back, oldest first
    QString told_;                ///< subject of the notice about parts that do not fit together
    std::mutex mutex_;
    std::condition_variable_any wake_;
    std::optional<StudioState::RigAsset> wanted_;
    std::jthread thread_; ///< from the first edit on
};

} // namespace lumorph::studio
