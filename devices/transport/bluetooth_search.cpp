#include "devices/transport/bluetooth_search.h"

#include <chrono>
#include <deque>
#include <exception>
#include <future>
#include <mutex>
#include <utility>

#include <QCoreApplication>
#include <QEvent>
#include <QEventLoop>
#include <QObject>
#include <QThread>

#include "devices/transport/bluetooth_scan.h"

namespace lumorph {

namespace {

constexpr QEvent::Type kWake = QEvent::User;
constexpr std::chrono::milliseconds kGrace{100}; // more than a thread needs that does not hang

/// Functions that one thread hands to another, which runs them in its event loop, in order.
class Mailbox {
public:
    /// From now on the calling thread runs what was posted.
    void open() {
        const std::scoped_lock lock(mutex_);
        reader_ = std::make_unique<Ear>(*this);
        for (std::size_t i = 0; i < words_.size(); ++i) wake();
    }
    /// In the thread that opened it: nothing is run any more, and nothing kept.
    void close() {
        const std::scoped_lock lock(mutex_);
        closed_ = true;
        words_.clear();
        reader_.reset();
    }
    void post(std::function<void()> word) {
        const std::scoped_lock lock(mutex_);
        if (closed_) return;
        words_.push_back(std::move(word));
        if (reader_) wake();
    }
    /// Instead of all that was not run yet.
    void postLast(std::function<void()> word) {
        {
            const std::scoped_lock lock(mutex_);
            words_.clear();
        }
        post(std::move(word));
    }

private:
    /// Lives in the thread that runs the words.
    struct Ear : QObject {
        explicit Ear(Mailbox& its) : box(its) {}
        bool event(QEvent* event) override { return box.onEvent(*event) || QObject::event(event); }
        Mailbox& box;
    };

    void wake() { QCoreApplication::postEvent(reader_.get(), new QEvent(kWake)); }

    /// Locks before it looks at the event: ThreadSanitizer does not see what Qt's own locks hand over.
    bool onEvent(const QEvent& event) {
        std::function<void()> word;
        {
            const std::scoped_lock lock(mutex_);
            if (event.type() != kWake) return false;
            if (words_.empty()) return true;
            word = std::move(words_.front());
            words_.pop_front();
        }
        word();
        return true;
    }

    std::mutex mutex_;
    std::deque<std::function<void()>> words_;
    std::unique_ptr<Ear> reader_;
    bool closed_ = false;
};

} // namespace

struct BluetoothSearch::Data {
    Data(Events its, Begin how) : begin(std::move(how)), events(std::move(its)) {}

    void work();
    void scanNow();
    void end(const LinkTrouble& trouble);

    const Begin begin;
    Mailbox toSearch, toOwner;
    std::promise<void> over; ///< kept when the search's thread needs nothing of this any more

    // Of the owner's thread alone.
    Events events;
    bool running = false;

    // Of the search's thread alone.
    std::unique_ptr<BluetoothScan> scan;
};

/// The search's thread.
void BluetoothSearch::Data::work() {
    QEventLoop loop;
    toSearch.open();
    loop.exec();
    scan.reset();
    toSearch.close();
    over.set_value();
}

void BluetoothSearch::Data::scanNow() {
    const auto found = [this](const FoundDevice& device) { toOwner.post([this, device] { events.found(device); }); };
    try {
        scan = begin({found, [this](const LinkTrouble& trouble) { end(trouble); }});
    } catch (const std::exception& error) {
        end({std::string("Bluetooth cannot be searched: ") + error.what(), "try again, or connect the device by USB"});
    }
}

void BluetoothSearch::Data::end(const LinkTrouble& trouble) {
    toSearch.post([this] { scan.reset(); }); // not inside its own call, and before the next one begins
    toOwner.post([this, trouble] {
        running = false;
        events.ended(trouble);
    });
}

BluetoothSearch::BluetoothSearch(Events events) : BluetoothSearch(std::move(events), beginBluetoothScan) {}

BluetoothSearch::BluetoothSearch(Events events, Begin begin)
    : data_(std::make_shared<Data>(std::move(events), std::move(begin))) {
    data_->toOwner.open();
}

BluetoothSearch::~BluetoothSearch() {
    data_->toOwner.close();
    data_->events = {}; // what they hold is the owner's, and may not end in the other thread
    if (!thread_.joinable()) return;
    data_->toSearch.postLast([] { QThread::currentThread()->quit(); });
    const bool over = data_->over.get_future().wait_for(kGrace) == std::future_status::ready;
    over ? thread_.join() : thread_.detach();
}

void BluetoothSearch::start() {
    if (data_->running) return;
    if (!thread_.joinable()) thread_ = std::thread([data = data_] { data->work(); });
    data_->running = true;
    data_->toSearch.post([data = data_.get()] { data->scanNow(); });
}

bool BluetoothSearch::running() const noexcept { return data_->running; }

} // namespace lumorph
