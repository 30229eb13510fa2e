#include "tests/devices/hid/fake_hidapi.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <cwchar>
#include <thread>

#include <hidapi/hidapi.h>

namespace lumorph {

FakeHidBus& fakeHidBus() {
    static FakeHidBus bus;
    return bus;
}

} // namespace lumorph

using lumorph::fakeHidBus;
using lumorph::FakeHidDevice;

struct hid_device_ {
    FakeHidDevice* device;
};

extern "C" {

int hid_init() { return 0; }
int hid_exit() { return 0; }

hid_device_info* hid_enumerate(unsigned short vendor, unsigned short product) {
    const std::scoped_lock lock(fakeHidBus().mutex);
    hid_device_info* first = nullptr;
    hid_device_info** next = &first;
    for (FakeHidDevice& device : fakeHidBus().devices) {
        if (device.unplugged || (vendor && device.vendor != vendor) || (product && device.product != product)) continue;
        for (int usage = 0; usage < device.usages; ++usage) {
            *next = new hid_device_info{};
            (*next)->path = ::strdup(device.path.c_str());
            (*next)->vendor_id = device.vendor;
            (*next)->product_id = device.product;
            // The real one leaves out what the device does not tell.
            (*next)->serial_number = device.serialNumber.empty() ? nullptr : ::wcsdup(device.serialNumber.c_str());
            (*next)->product_string = device.productText.empty() ? nullptr : ::wcsdup(device.productText.c_str());
            next = &(*next)->next;
        }
    }
    return first;
}

void hid_free_enumeration(hid_device_info* info) {
    while (info) {
        hid_device_info* const next = info->next;
        ::free(info->path);
        ::free(info->serial_number);
        ::free(info->product_string);
        delete info;
        info = next;
    }
}

hid_device* hid_open_path(const char* path) {
    const std::scoped_lock lock(fakeHidBus().mutex);
    for (FakeHidDevice& device : fakeHidBus().devices) {
        if (device.path != path || device.unplugged) continue;
        if (device.openError.empty()) {
            ++fakeHidBus().open;
            return new hid_device_{&device};
        }
        const std::string text = "Failed to open a device with path '" + device.path + "': " + device.openError;
        fakeHidBus().error.assign(text.begin(), text.end());
        return nullptr;
    }
    fakeHidBus().error = L"No such file or directory";
    return nullptr;
}

int hid_write(hid_device* handle, const unsigned char* data, std::size_t length) {
    std::unique_lock lock(fakeHidBus().mutex);
    while (handle->device->deafForNow && !handle->device->unplugged) {
        lock.unlock();
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        lock.lock();
    }
    if (handle->device->unplugged) return -1;
    handle->device->written.emplace_back(data, data + length);
    return static_cast<int>(length);
}

int hid_read_timeout(hid_device* handle, unsigned char* data, std::size_t length, int) {
    const std::scoped_lock lock(fakeHidBus().mutex);
    ++fakeHidBus().reads;
    if (handle->device->unplugged) return -1;
    auto& waiting = handle->device->toRead;
    if (waiting.empty()) return 0;
    const std::size_t count = std::min(length, waiting.front().size());
    std::copy_n(waiting.front().begin(), count, data);
    waiting.pop_front();
    return static_cast<int>(count);
}

void hid_close(hid_device* handle) {
    const std::scoped_lock lock(fakeHidBus().mutex);
    --fakeHidBus().open;
    delete handle;
}

const wchar_t* hid_error(hid_device*) { return fakeHidBus().error.c_str(); }
}
