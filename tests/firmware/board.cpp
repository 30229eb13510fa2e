#include "tests/firmware/board.h"

#include <array>
#include <cstdlib>
#include <deque>
#include <stdexcept>
#include <utility>

#include <simavr/avr_adc.h>
#include <simavr/avr_extint.h>
#include <simavr/avr_ioport.h>
#include <simavr/avr_uart.h>
#include <simavr/sim_avr.h>
#include <simavr/sim_cycle_timers.h>
#include <simavr/sim_elf.h>

namespace lumorph::firmware_test {

namespace {

constexpr int kPins = 20;
constexpr double kBaud = 57600.0;

std::pair<char, int> portOf(int pin) {
    if (pin < 8) return {'D', pin};
    if (pin < 14) return {'B', pin - 8};
    return {'C', pin - 14};
}

} // namespace

struct Board::Data {
    avr_t* avr = nullptr;
    double hertz = 0.0;
    std::size_t flashBytes = 0;
    std::deque<std::uint8_t> line; // to be sent
    bool sending = false;
    avr_cycle_count_t byteCycles = 0;
    Bytes said;
    std::function<void(std::uint8_t)> say;
    std::vector<Pulse> pulses;
    struct WatchedPin {
        Data* data = nullptr;
        int number = 0;
        bool high = false;
        avr_cycle_count_t rise = 0;
    };
    std::array<WatchedPin, kPins> pins;

    ~Data() {
        if (avr == nullptr) return;
        avr_terminate(avr);
        std::free(avr);
    }

    static void pinChanged(avr_irq_t* /*irq*/, std::uint32_t value, void* parameter) {
        auto& pin = *static_cast<WatchedPin*>(parameter);
        Data& data = *pin.data;
        const bool high = (value & 1U) != 0;
        if (high == pin.high) return;
        pin.high = high;
        const avr_cycle_count_t now = data.avr->cycle;
        if (high)
            pin.rise = now;
        else
            data.pulses.push_back({pin.number, 1e3 * static_cast<double>(pin.rise) / data.hertz,
                                   1e6 * static_cast<double>(now - pin.rise) / data.hertz});
    }

    static void byteSaid(avr_irq_t* /*irq*/, std::uint32_t value, void* parameter) {
        Data& data = *static_cast<Data*>(parameter);
        data.said.push_back(static_cast<std::uint8_t>(value));
        if (data.say) data.say(static_cast<std::uint8_t>(value));
    }

    static avr_cycle_count_t nextByte(avr_t* avr, avr_cycle_count_t when, void* parameter) {
        Data& data = *static_cast<Data*>(parameter);
        if (data.line.empty()) {
            data.sending = false;
            return 0;
        }
        avr_raise_irq(avr_io_getirq(avr, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_INPUT), data.line.front());
        data.line.pop_front();
        return when + data.byteCycles;
    }
};

Board::Board(const std::string& sketch, int megahertz) : data_(std::make_unique<Data>()) {
    Data& data = *data_;
    const std::string path = LUMORPH_SKETCH_DIR "/" + sketch + std::to_string(megahertz) + "/tablet.elf";
    elf_firmware_t firmware{};
    if (elf_read_firmware(path.c_str(), &firmware) != 0) throw std::runtime_error("no sketch in " + path);
    data.avr = avr_make_mcu_by_name("atmega328p");
    if (data.avr == nullptr) throw std::runtime_error("simavr knows no ATmega328P");
    avr_init(data.avr);
    data.avr->log = LOG_NONE;
    data.avr->sleep = [](avr_t*, avr_cycle_count_t) {}; // costs no time of ours
    firmware.frequency = static_cast<std::uint32_t>(megahertz) * 1'000'000U;
    avr_load_firmware(data.avr, &firmware);
    data.flashBytes = firmware.flashsize;
    // Interrupts of low pins, which nobody uses, would be looked for in every cycle.
    avr_extint_set_strict_lvl_trig(data.avr, 0, 0);
    avr_extint_set_strict_lvl_trig(data.avr, 1, 0);
    data.hertz = 1e6 * megahertz;
    // simavr's own receiver takes eleven bits a byte, and what comes faster piles up in it.
    data.byteCycles = static_cast<avr_cycle_count_t>(data.hertz * 11.0 / kBaud * 1.01) + 1;

    std::uint32_t flags = 0;
    avr_ioctl(data.avr, AVR_IOCTL_UART_SET_FLAGS('0'), &flags);
    avr_irq_register_notify(avr_io_getirq(data.avr, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_OUTPUT), Data::byteSaid,
                            &data);
    for (int pin = 2; pin < kPins; ++pin) {
        data.pins[pin] = {&data, pin, false, 0};
        const auto [port, bit] = portOf(pin);
        avr_irq_register_notify(avr_io_getirq(data.avr, AVR_IOCTL_IOPORT_GETIRQ(port), bit), Data::pinChanged,
                                &data.pins[pin]);
    }
}

Board::~Board() = default;

void Board::run(double milliseconds) {
    const auto end = data_->avr->cycle + static_cast<avr_cycle_count_t>(milliseconds * 1e-3 * data_->hertz);
    while (data_->avr->cycle < end) {
        const int state = avr_run(data_->avr);
        if (state == cpu_Done || state == cpu_Crashed) throw std::runtime_error("the processor stopped");
    }
}

void Board::send(std::span<const std::uint8_t> bytes) {
    data_->line.insert(data_->line.end(), bytes.begin(), bytes.end());
    if (data_->sending || data_->line.empty()) return;
    data_->sending = true;
    avr_cycle_timer_register(data_->avr, 1, Data::nextByte, data_.get());
}

void Board::send(std::initializer_list<int> bytes) {
    Bytes whole;
    for (const int byte : bytes) whole.push_back(static_cast<std::uint8_t>(byte));
    send(whole);
}

void Board::runUntilSent() {
    while (isSending()) run(0.2);
    run(1.0);
}

bool Board::isSending() const { return data_->sending; }
double Board::now() const { return 1e3 * static_cast<double>(data_->avr->cycle) / data_->hertz; }
Bytes Board::takeSaid() { return std::exchange(data_->said, {}); }
std::vector<Pulse> Board::takePulses() { return std::exchange(data_->pulses, {}); }
bool Board::isHigh(int pin) const { return data_->pins[static_cast<std::size_t>(pin)].high; }
std::size_t Board::flashBytes() const { return data_->flashBytes; }

void Board::setButton(int pin, bool down) {
    const auto [port, bit] = portOf(pin);
    avr_ioport_external_t external{};
    external.name = static_cast<unsigned long>(port);
    external.mask = 1UL << static_cast<unsigned>(bit);
    external.value = down ? 0UL : external.mask;
    avr_ioctl(data_->avr, AVR_IOCTL_IOPORT_SET_EXTERNAL(port), &external);
    avr_raise_irq(avr_io_getirq(data_->avr, AVR_IOCTL_IOPORT_GETIRQ(port), bit), down ? 0U : 1U);
}

void Board::onSaid(std::function<void(std::uint8_t)> say) { data_->say = std::move(say); }

void Board::setPinMillivolts(int millivolts) {
    avr_raise_irq(avr_io_getirq(data_->avr, AVR_IOCTL_ADC_GETIRQ, ADC_IRQ_ADC0),
                  static_cast<std::uint32_t>(millivolts));
}

void Board::hang(bool timerRuns) {
    // `rjmp .-2` where no code is; the main loop is between two instructions.
    constexpr std::uint32_t kFree = 0x7000;
    data_->avr->flash[kFree] = 0xFF;
    data_->avr->flash[kFree + 1] = 0xCF;
    while (data_->avr->sreg[S_I] == 0) avr_run(data_->avr); // not within an interrupt
    if (data_->avr->state == cpu_Sleeping) data_->avr->state = cpu_Running;
    data_->avr->pc = kFree;
    constexpr std::size_t kTimsk1 = 0x6F;
    if (!timerRuns) data_->avr->data[kTimsk1] = 0;
}

} // namespace lumorph::firmware_test
