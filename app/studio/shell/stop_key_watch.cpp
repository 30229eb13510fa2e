#include "app/studio/shell/stop_key_watch.h"

#include <algorithm>
#include <cstdlib>
#include <mutex>
#include <optional>
#include <set>
#include <thread>
#include <utility>

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <xcb/xcb.h>
#include <xcb/xinput.h>

#include "app/studio/shell/press_twice.h"

namespace lumorph::studio {
namespace {

constexpr xcb_keysym_t kEscape = 0xff1b;
constexpr Microseconds kWindowAnswers{150'000}; ///< by then the window has said what a press closed

template <class T> using Reply = std::unique_ptr<T, decltype(&std::free)>;
template <class T> Reply<T> taken(T* reply) { return {reply, &std::free}; }

struct Disconnect {
    void operator()(xcb_connection_t* connection) const { xcb_disconnect(connection); }
};
using Connection = std::unique_ptr<xcb_connection_t, Disconnect>;

// A keyboard may have Esc on several keys.
std::set<std::uint32_t> escapeKeys(xcb_connection_t* connection) {
    const xcb_setup_t* setup = xcb_get_setup(connection);
    const auto count = static_cast<std::uint8_t>(setup->max_keycode - setup->min_keycode + 1);
    const auto reply = taken(xcb_get_keyboard_mapping_reply(
        connection, xcb_get_keyboard_mapping(connection, setup->min_keycode, count), nullptr));
    std::set<std::uint32_t> keys;
    if (!reply) return keys;
    const xcb_keysym_t* symbols = xcb_get_keyboard_mapping_keysyms(reply.get());
    const int each = reply->keysyms_per_keycode;
    for (int key = 0; key < count; ++key)
        if (std::find(symbols + key * each, symbols + (key + 1) * each, kEscape) != symbols + (key + 1) * each)
            keys.insert(static_cast<std::uint32_t>(setup->min_keycode + key));
    return keys;
}

// Raw events reach every client that asks for them, grabs or not: since version 2.1 of the extension.
bool askForRawKeys(xcb_connection_t* connection) {
    const auto version =
        taken(xcb_input_xi_query_version_reply(connection, xcb_input_xi_query_version(connection, 2, 2), nullptr));
    if (!version || version->major_version < 2 || (version->major_version == 2 && version->minor_version < 1))
        return false;
    const struct {
        xcb_input_event_mask_t head;
        std::uint32_t mask;
    } mask{{XCB_INPUT_DEVICE_ALL_MASTER, 1}, XCB_INPUT_XI_EVENT_MASK_RAW_KEY_PRESS};
    for (auto root = xcb_setup_roots_iterator(xcb_get_setup(connection)); root.rem > 0; xcb_screen_next(&root))
        xcb_input_xi_select_events(connection, root.data->root, 1, &mask.head);
    return xcb_flush(connection) > 0;
}

} // namespace

struct StopKeyWatch::Data {
    std::function<void()> pressed;
    QString why;
    Connection connection;
    std::uint8_t extension = 0;
    std::set<std::uint32_t> escapes;
    int wake = -1;
    std::jthread thread; ///< last, so that it ends before what it uses

    QString open();
    void listen(const std::stop_token& stop);
    void onEvent(const xcb_generic_event_t& event);
    void onEscape(Microseconds now);
    /// Milliseconds until a second press counts that waits; -1: none does.
    int wait(Microseconds now);
    std::mutex mutex; ///< guards what follows
    PressTwice twice;
    std::optional<Microseconds> due;
    bool somethingOpen = false;
};

// Empty when it listens.
QString StopKeyWatch::Data::open() {
    if (qEnvironmentVariableIsEmpty("DISPLAY") || qEnvironmentVariable("XDG_SESSION_TYPE") == "wayland")
        return "this desktop does not let a program hear other windows' keys";
    connection.reset(xcb_connect(nullptr, nullptr));
    if (xcb_connection_has_error(connection.get()) != 0) return "the display does not answer";
    const auto* input = xcb_get_extension_data(connection.get(), &xcb_input_id);
    if (input == nullptr || input->present == 0) return "the display has no XInput extension";
    extension = input->major_opcode;
    escapes = escapeKeys(connection.get());
    if (escapes.empty()) return "the keyboard has no Esc key";
    if (!askForRawKeys(connection.get())) return "the display's XInput extension is too old";
    wake = ::eventfd(0, EFD_CLOEXEC);
    return wake < 0 ? "the system has no free file numbers" : QString();
}

void StopKeyWatch::Data::onEvent(const xcb_generic_event_t& event) {
    if ((event.response_type & 0x7F) != XCB_GE_GENERIC) return;
    const auto& generic = reinterpret_cast<const xcb_ge_generic_event_t&>(event);
    if (generic.extension != extension || generic.event_type != XCB_INPUT_RAW_KEY_PRESS) return;
    const auto& key = reinterpret_cast<const xcb_input_raw_key_press_event_t&>(event);
    if ((key.flags & XCB_INPUT_KEY_EVENT_FLAGS_KEY_REPEAT) != 0) return;
    if (escapes.contains(key.detail)) return onEscape(SteadyClock().now());
    const std::scoped_lock lock(mutex);
    twice.reset();
}

void StopKeyWatch::Data::onEscape(Microseconds now) {
    {
        const std::scoped_lock lock(mutex);
        if (!twice.press(now)) return;
        if (somethingOpen) {
            due = now + kWindowAnswers;
            return;
        }
    }
    pressed();
}

int StopKeyWatch::Data::wait(Microseconds now) {
    {
        const std::scoped_lock lock(mutex);
        if (!due) return -1;
        if (now < *due) return 1 + static_cast<int>((*due - now).count() / 1000);
        due.reset();
    }
    pressed();
    return -1;
}

void StopKeyWatch::Data::listen(const std::stop_token& stop) {
    pollfd waits[] = {{xcb_get_file_descriptor(connection.get()), POLLIN, 0}, {wake, POLLIN, 0}};
    while (!stop.stop_requested() && xcb_connection_has_error(connection.get()) == 0) {
        while (const auto event = taken(xcb_poll_for_event(connection.get()))) onEvent(*event);
        ::poll(waits, std::size(waits), wait(SteadyClock().now()));
    }
}

StopKeyWatch::StopKeyWatch(std::function<void()> pressed) : data_(std::make_unique<Data>()) {
    data_->pressed = std::move(pressed);
    data_->why = data_->open();
    if (!listens()) return;
    data_->thread = std::jthread([data = data_.get()](const std::stop_token& stop) { data->listen(stop); });
}

StopKeyWatch::~StopKeyWatch() {
    if (data_->thread.joinable()) {
        data_->thread.request_stop();
        ::eventfd_write(data_->wake, 1);
        data_->thread.join();
    }
    if (data_->wake >= 0) ::close(data_->wake);
}

void StopKeyWatch::setSomethingOpen(bool open) {
    const std::scoped_lock lock(data_->mutex);
    data_->somethingOpen = open;
}

void StopKeyWatch::forget() {
    const std::scoped_lock lock(data_->mutex);
    data_->twice.reset();
    data_->due.reset();
}

bool StopKeyWatch::listens() const noexcept { return data_->why.isEmpty(); }
const QString& StopKeyWatch::why() const noexcept { return data_->why; }

} // namespace lumorph::studio
