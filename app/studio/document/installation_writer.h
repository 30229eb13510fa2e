#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <stop_token>
#include <thread>

#include "core/scene/installation.h"

namespace lumorph::studio {

/// Writes installations in a thread of its own, one after the other: of those that wait the newest is written and the
/// others never. A disk that takes seconds holds nothing up.
class InstallationWriter {
public:
    /// Throws where the disk refuses; called in the writer's thread.
    using Write = std::function<void(const Installation&)>;
    /// One was written, or what was thrown instead; called in the writer's thread.
    using Done = std::function<void(std::shared_ptr<const Installation>, std::exception_ptr)>;

    InstallationWriter(Write write, Done done);
    /// Writes what waits.
    ~InstallationWriter();
    InstallationWriter(const InstallationWriter&) = delete;
    InstallationWriter& operator=(const InstallationWriter&) = delete;

    /// Returns at once.
    void offer(std::shared_ptr<const Installation> installation);

private:
    void run(const std::stop_token& end);

    const Write write_;
    const Done done_;
    std::mutex mutex_; ///< of what follows; held for moments only
    std::condition_variable_any changed_;
    std::shared_ptr<const Installation> waiting_;
    std::jthread thread_; ///< last: it uses the rest
};

} // namespace lumorph::studio
