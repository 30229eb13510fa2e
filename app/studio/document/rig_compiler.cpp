#include "app/studio/document/rig_compiler.h"

#include <algorithm>
#include <utility>

#include "app/studio/document/state_rules.h"

namespace lumorph::studio {

namespace {

// Each may be some megabytes; who undoes more than this at once waits for a moment.
constexpr std::size_t kMostKnown = 16;

} // namespace

RigCompiler::RigCompiler(StudioDocument& document, Notices& notices, QObject* parent)
    : QObject(parent), document_(document), notices_(notices) {
    connect(&document, &StudioDocument::changed, this, [this](StateParts parts) {
        if (parts & (StatePart::rig | StatePart::rigEdited)) follow();
    });
}

RigCompiler::~RigCompiler() {
    thread_.request_stop();
    if (thread_.joinable()) thread_.join();
}

void RigCompiler::follow() {
    const StudioState::RigAsset asset = document_.state().rig;
    if (!asset.rig || asset.compiled) {
        if (!told_.isEmpty()) notices_.dismiss("rig", std::exchange(told_, {}));
        return;
    }
    const auto known = std::ranges::find_if(known_, [&](const Compiled& c) { return c.parts.lock() == asset.parts; });
    if (known != known_.end())
        document_.setCompiled(asset, known->rig);
    else
        ask(asset);
}

void RigCompiler::ask(const StudioState::RigAsset& asset) {
    {
        const std::scoped_lock lock(mutex_);
        if (wanted_ && wanted_->parts == asset.parts) return;
        wanted_ = asset;
    }
    if (!thread_.joinable()) thread_ = std::jthread([this](const std::stop_token& stop) { work(stop); });
    wake_.notify_one();
}

void RigCompiler::work(const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    while (wake_.wait(lock, stop, [this] { return wanted_.has_value(); })) {
        const StudioState::RigAsset asset = *std::exchange(wanted_, std::nullopt);
        lock.unlock();
        std::function<void()> report;
        try {
            report = [this, asset, rig = std::make_shared<const Rig>(*asset.parts)] { take(asset, rig); };
        } catch (const std::exception&) { // also what only the library says, such as that memory is short
            report = [this, asset, failure = std::current_exception()] { tell(asset, failure); };
        }
        QMetaObject::invokeMethod(this, std::move(report), Qt::QueuedConnection);
        lock.lock();
    }
}

void RigCompiler::take(const StudioState::RigAsset& of, const std::shared_ptr<const Rig>& rig) {
    keep(of, rig);
    document_.setCompiled(of, rig);
}

/// Only of parts that are still the newest: older ones nobody sees any more.
void RigCompiler::tell(const StudioState::RigAsset& of, const std::exception_ptr& failure) {
    if (document_.state().rig.parts != of.parts) return;
    if (!told_.isEmpty()) notices_.dismiss("rig", told_);
    try {
        std::rethrow_exception(failure);
    } catch (const std::exception& error) {
        const Notice notice = noticeOf(error);
        told_ = notice.subject;
        notices_.post("rig", notice);
    }
}

void RigCompiler::keep(const StudioState::RigAsset& of, const std::shared_ptr<const Rig>& rig) {
    std::erase_if(known_, [](const Compiled& compiled) { return compiled.parts.expired(); });
    known_.push_back({of.parts, rig});
    if (known_.size() > kMostKnown) known_.erase(known_.begin());
}

} // namespace lumorph::studio
