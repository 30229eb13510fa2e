#include "app/table/screen_eye.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <span>
#include <thread>
#include <tuple>
#include <utility>

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/ipc.h>
#include <sys/shm.h>
#include <unistd.h>

#include "core/base/error.h"

// After ours: Xlib has macros of common words.
#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <X11/extensions/XShm.h>
#include <X11/extensions/Xdamage.h>
#include <X11/extensions/Xfixes.h>
#include <X11/extensions/Xrandr.h>

namespace lumorph::table {

namespace {

constexpr Microseconds kRemembered{500'000};
constexpr std::chrono::milliseconds kLeastPause{10};
constexpr Microseconds kPointerMoves{100'000}; ///< without damage: looked at again
constexpr std::chrono::seconds kMostWaiting{1};

struct CloseDisplay {
    void operator()(Display* display) const noexcept { XCloseDisplay(display); }
};
using OpenDisplay = std::unique_ptr<Display, CloseDisplay>;

OpenDisplay openDisplay() {
    OpenDisplay display(XOpenDisplay(nullptr));
    if (!display)
        throw DeviceError("X display", "it cannot be opened", "start where the studio is seen, with DISPLAY set");
    return display;
}

/// A picture of a part of the display in memory that the server writes to.
class SharedPicture {
public:
    SharedPicture(Display* display, const Screen& screen) : display_(display) {
        if (XShmQueryExtension(display) == 0)
            throw DeviceError("X display", "it shares no memory", "start on the machine of the display");
        const int number = DefaultScreen(display);
        image_ = XShmCreateImage(display, DefaultVisual(display, number),
                                 static_cast<unsigned>(DefaultDepth(display, number)), ZPixmap, nullptr, &memory_,
                                 static_cast<unsigned>(screen.size.x), static_cast<unsigned>(screen.size.y));
        if (image_ == nullptr || image_->bits_per_pixel != 32)
            throw DeviceError("screen " + screen.name, "its pixels have no 8 bits a colour",
                              "set the display to 24 bits of colour");
        const std::size_t bytes =
            static_cast<std::size_t>(image_->bytes_per_line) * static_cast<std::size_t>(image_->height);
        memory_.shmid = shmget(IPC_PRIVATE, bytes, IPC_CREAT | 0600);
        memory_.shmaddr = memory_.shmid < 0 ? nullptr : static_cast<char*>(shmat(memory_.shmid, nullptr, 0));
        if (memory_.shmid < 0 || memory_.shmaddr == reinterpret_cast<char*>(-1)) {
            XDestroyImage(image_);
            throw DeviceError("screen " + screen.name, "there is no shared memory for its picture",
                              "raise the limits of shared memory");
        }
        image_->data = memory_.shmaddr;
        memory_.readOnly = False;
        XShmAttach(display, &memory_);
        XSync(display, False);
        shmctl(memory_.shmid, IPC_RMID, nullptr); // gone with the last who has it
    }
    ~SharedPicture() {
        XShmDetach(display_, &memory_);
        image_->data = nullptr;
        XDestroyImage(image_);
        shmdt(memory_.shmaddr);
    }
    SharedPicture(const SharedPicture&) = delete;
    SharedPicture& operator=(const SharedPicture&) = delete;

    [[nodiscard]] Image take(const Screen& screen) {
        XShmGetImage(display_, DefaultRootWindow(display_), image_, screen.place.x, screen.place.y, AllPlanes);
        Image picture(screen.size);
        for (int y = 0; y < screen.size.y; ++y) {
            const auto* row = reinterpret_cast<const std::uint8_t*>(image_->data + y * image_->bytes_per_line);
            Image::Pixel* to = &picture.at(0, y);
            for (int x = 0; x < screen.size.x; ++x, row += 4) to[x] = {row[2], row[1], row[0], 255};
        }
        return picture;
    }

private:
    Display* display_;
    XShmSegmentInfo memory_{};
    XImage* image_ = nullptr;
};

/// The mouse pointer is not part of what the server gives.
void drawPointer(Display* display, const Screen& screen, Image& picture) {
    XFixesCursorImage* cursor = XFixesGetCursorImage(display);
    if (cursor == nullptr) return;
    for (int y = 0; y < cursor->height; ++y)
        for (int x = 0; x < cursor->width; ++x) {
            const glm::ivec2 at(cursor->x - cursor->xhot + x - screen.place.x,
                                cursor->y - cursor->yhot + y - screen.place.y);
            if (at.x < 0 || at.y < 0 || at.x >= screen.size.x || at.y >= screen.size.y) continue;
            const unsigned long argb = cursor->pixels[y * cursor->width + x]; // its colours are multiplied by alpha
            const unsigned long rest = 255 - (argb >> 24 & 255);
            Image::Pixel& pixel = picture.at(at.x, at.y);
            for (int channel = 0; channel < 3; ++channel)
                pixel[static_cast<std::size_t>(channel)] = static_cast<std::uint8_t>(std::min(
                    255UL, (argb >> (16 - 8 * channel) & 255) + pixel[static_cast<std::size_t>(channel)] * rest / 255));
        }
    XFree(cursor);
}

} // namespace

struct ScreenEye::Data {
    std::vector<Screen> screens;
    SteadyClock clock;
    mutable std::mutex mutex; ///< of what follows
    mutable std::condition_variable_any seen;
    std::vector<std::deque<Shown>> shown;
    Microseconds known{0};                               ///< until when nothing changed unseen
    int wake = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK); ///< somebody wants to know until later
    std::jthread thread;

    ~Data() { ::close(wake); }
    void look(const std::stop_token& stop);
    void takeAll(Display* display, std::vector<std::unique_ptr<SharedPicture>>& pictures, Microseconds changed);
    void isKnownUntil(Microseconds time) {
        const std::scoped_lock lock(mutex);
        known = std::max(known, time);
        seen.notify_all();
    }
};

std::vector<Screen> ScreenEye::screens() {
    const OpenDisplay display = openDisplay();
    int count = 0;
    XRRMonitorInfo* monitors = XRRGetMonitors(display.get(), DefaultRootWindow(display.get()), True, &count);
    std::ranges::sort(std::span(monitors, static_cast<std::size_t>(std::max(count, 0))), {},
                      [](const XRRMonitorInfo& one) { return std::tuple(one.primary == 0, one.x, one.y); });
    std::vector<Screen> found;
    for (int i = 0; i < count; ++i) {
        const XRRMonitorInfo& one = monitors[i];
        char* name = XGetAtomName(display.get(), one.name);
        found.push_back({name, {one.x, one.y}, {one.width, one.height}});
        XFree(name);
    }
    if (monitors != nullptr) XRRFreeMonitors(monitors);
    if (found.empty()) throw DeviceError("X display", "it has no screen", "switch one on");
    return found;
}

/// `changed` is when the display was told to show something else.
void ScreenEye::Data::takeAll(Display* display, std::vector<std::unique_ptr<SharedPicture>>& pictures,
                              Microseconds changed) {
    const Microseconds begun = clock.now();
    for (std::size_t k = 0; k < screens.size(); ++k) {
        Image picture = pictures[k]->take(screens[k]);
        drawPointer(display, screens[k], picture);
        const std::scoped_lock lock(mutex);
        std::deque<Shown>& past = shown[k];
        if (!past.empty() && past.back().picture->pixels() == picture.pixels()) continue;
        past.push_back({std::make_shared<const Image>(std::move(picture)), std::clamp(changed, known, begun)});
        while (past.size() > 1 && past[1].since < begun - kRemembered) past.pop_front();
    }
    isKnownUntil(begun);
}

void ScreenEye::Data::look(const std::stop_token& stop) {
    const OpenDisplay display = openDisplay();
    std::vector<std::unique_ptr<SharedPicture>> pictures;
    for (const Screen& screen : screens) pictures.push_back(std::make_unique<SharedPicture>(display.get(), screen));
    int damaged = 0, errors = 0;
    const bool tells = XDamageQueryExtension(display.get(), &damaged, &errors) != 0;
    const Damage damage =
        tells ? XDamageCreate(display.get(), DefaultRootWindow(display.get()), XDamageReportNonEmpty) : 0;
    XFixesSelectCursorInput(display.get(), DefaultRootWindow(display.get()), XFixesDisplayCursorNotifyMask);
    std::optional<Microseconds> changed;
    /// Whether the display has told that something changed before it was asked.
    const auto isTold = [&] {
        bool told = !tells;
        XSync(display.get(), False);
        while (XPending(display.get()) > 0) {
            XEvent event;
            XNextEvent(display.get(), &event);
            told = true;
            if (event.type != damaged + XDamageNotify || changed) continue;
            // The server's clock is this machine's, in milliseconds that fit 32 bits.
            const auto now = static_cast<std::uint32_t>(clock.now().count() / 1000);
            const std::uint32_t ago =
                now - static_cast<std::uint32_t>(reinterpret_cast<const XDamageNotifyEvent&>(event).timestamp);
            changed = clock.now() - Microseconds(std::int64_t{1000} * ago);
        }
        return told;
    };
    while (!stop.stop_requested()) {
        // Before it is looked at, so that what changes meanwhile is told again.
        if (tells) XDamageSubtract(display.get(), damage, None, None);
        takeAll(display.get(), pictures, changed.value_or(clock.now()));
        changed.reset();
        std::this_thread::sleep_for(kLeastPause);
        const Microseconds again = clock.now() + kPointerMoves;
        while (!stop.stop_requested() && clock.now() < again) {
            const Microseconds asked = clock.now();
            if (isTold()) break;
            isKnownUntil(asked);
            pollfd said[] = {{ConnectionNumber(display.get()), POLLIN, 0}, {wake, POLLIN, 0}};
            ::poll(said, std::size(said), static_cast<int>(kPointerMoves.count() / 1000));
            eventfd_t times = 0;
            (void)::eventfd_read(wake, &times);
        }
    }
}

ScreenEye::ScreenEye(std::vector<Screen> screens) : data_(std::make_unique<Data>()) {
    data_->screens = std::move(screens);
    data_->shown.resize(data_->screens.size());
    // What cannot be looked at is said here, not in the thread.
    const OpenDisplay display = openDisplay();
    for (const Screen& screen : data_->screens) {
        std::vector<std::unique_ptr<SharedPicture>> pictures;
        pictures.push_back(std::make_unique<SharedPicture>(display.get(), screen));
        data_->shown[static_cast<std::size_t>(&screen - data_->screens.data())].push_back(
            {std::make_shared<const Image>(pictures.front()->take(screen)), data_->clock.now()});
    }
    data_->thread = std::jthread([data = data_.get()](const std::stop_token& stop) { data->look(stop); });
}

ScreenEye::~ScreenEye() {
    data_->thread.request_stop();
    data_->thread.join();
}

const std::vector<Screen>& ScreenEye::watched() const noexcept { return data_->screens; }

ScreenEye::Shown ScreenEye::at(std::size_t screen, Microseconds time) const {
    std::unique_lock lock(data_->mutex);
    if (data_->known < time) (void)::eventfd_write(data_->wake, 1);
    data_->seen.wait_for(lock, kMostWaiting, [&] { return data_->known >= time; });
    const std::deque<Shown>& past = data_->shown.at(screen);
    const auto after = std::ranges::upper_bound(past, time, {}, &Shown::since);
    return after == past.begin() ? past.front() : *(after - 1);
}

} // namespace lumorph::table
