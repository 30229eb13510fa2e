#include "guards.h"

#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/sleep.h>
#include <avr/wdt.h>

#include "pulses.h"
#include "uart.h"

namespace {

// Survive the start of the sketch, which sets all other memory to zero.
uint16_t hangMark __attribute__((section(".noinit")));
uint8_t resetCause __attribute__((section(".noinit")));
constexpr uint16_t kHung = 0x5EA1;
bool hung;

} // namespace

// Before anything else: a watchdog that reset the chip is still on, with its shortest time.
void stopWatchdogFirst() __attribute__((naked, used, section(".init3")));
void stopWatchdogFirst() {
    resetCause = MCUSR;
    MCUSR = 0;
    wdt_disable();
}

// The main loop hangs. First a start of our own after the frame's last pulse, since the bootloader of many a Pro Mini
// does not survive a reset by watchdog; where that fails too, the second alarm resets the chip.
ISR(WDT_vect) {
    hangMark = kHung;
    restartAfterThisFrame();
}

void guardsBegin() {
    hung = (hangMark == kHung && !(resetCause & _BV(PORF))) || (resetCause & _BV(WDRF));
    hangMark = 0;
    resetCause = 0;
    wdt_enable(WDTO_250MS);
    WDTCSR |= _BV(WDIE);
    set_sleep_mode(SLEEP_MODE_IDLE);
}

void guardsFrame() { wdt_reset(); }

bool restartedAfterHang() { return hung; }

void sleepUntilNeeded() {
    cli();
    if (!uartHasBytes() && !pulsesFrameWaits()) {
        sleep_enable();
        sei(); // the instruction after it is carried out before any interrupt: none can slip in between
        sleep_cpu();
        sleep_disable();
    }
    sei();
}
