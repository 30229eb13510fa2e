#include "app/studio/document/installation_writer.h"

#include <utility>

namespace lumorph::studio {

InstallationWriter::InstallationWriter(Write write, Done done)
    : write_(std::move(write)), done_(std::move(done)), thread_([this](const std::stop_token& end) { run(end); }) {}

InstallationWriter::~InstallationWriter() = default;

void InstallationWriter::offer(std::shared_ptr<const Installation> installation) {
    {
        const std::scoped_lock lock(mutex_);
        waiting_ = std::move(installation);
    }
    changed_.notify_all();
}

void InstallationWriter::run(const std::stop_token& end) {
    std::unique_lock lock(mutex_);
    // What waits is written even where the end was asked for.
    while (changed_.wait(lock, end, [this] { return waiting_ != nullptr; })) {
        std::shared_ptr<const Installation> installation = std::exchange(waiting_, nullptr);
        lock.unlock();
        std::exception_ptr failure;
        try {
            write_(*installation);
        } catch (...) {
            failure = std::current_exception();
        }
        done_(std::move(installation), failure);
        lock.lock();
    }
}

} // namespace lumorph::studio
