#include "uart.h"

#include <avr/interrupt.h>
#include <avr/io.h>

#include "channels.h"

namespace {

constexpr uint32_t kDivisor = (F_CPU / 4 / kBaud - 1) / 2; // at double speed, rounded
constexpr uint32_t kTrueBaud = F_CPU / 8 / (kDivisor + 1);
static_assert(kDivisor < 4096 && kTrueBaud > kBaud - kBaud / 40 && kTrueBaud < kBaud + kBaud / 40,
              "this clock cannot make the baud rate of channels.h within 2.5 %; take 57600 or 9600");

constexpr uint8_t kSize = 128; // of each queue, a power of two
struct Queue {
    uint8_t bytes[kSize];
    volatile uint8_t head; // written next
    volatile uint8_t tail; // read next
};
Queue received;
Queue unsent;
volatile bool lost;

uint8_t after(uint8_t at) { return (at + 1) & (kSize - 1); }

} // namespace

ISR(USART_RX_vect) {
    const bool broken = UCSR0A & _BV(FE0);
    const uint8_t byte = UDR0;
    if (broken) return; // noise of an open line is nobody's voice
    const uint8_t next = after(received.head);
    if (next == received.tail) {
        lost = true;
        return;
    }
    received.bytes[received.head] = byte;
    received.head = next;
}

ISR(USART_UDRE_vect) {
    if (unsent.head == unsent.tail) {
        UCSR0B &= ~_BV(UDRIE0);
        return;
    }
    UDR0 = unsent.bytes[unsent.tail];
    unsent.tail = after(unsent.tail);
}

void uartBegin() {
    DDRD = (DDRD & ~_BV(0)) | _BV(1);
    PORTD |= _BV(0) | _BV(1); // an open line reads as silence
    UCSR0A = _BV(U2X0);
    UBRR0 = kDivisor;
    UCSR0C = _BV(UCSZ01) | _BV(UCSZ00);
    UCSR0B = _BV(RXCIE0) | _BV(RXEN0) | _BV(TXEN0);
}

bool uartHasBytes() { return received.head != received.tail; }

int16_t uartRead() {
    if (!uartHasBytes()) return -1;
    const uint8_t byte = received.bytes[received.tail];
    received.tail = after(received.tail);
    return byte;
}

bool uartLostBytes() {
    if (!lost) return false;
    lost = false;
    return true;
}

uint8_t uartRoom() { return (unsent.tail - unsent.head - 1) & (kSize - 1); }

void uartWrite(uint8_t byte) {
    if (uartRoom() == 0) return;
    unsent.bytes[unsent.head] = byte;
    unsent.head = after(unsent.head);
}

bool uartHasUnsent() { return unsent.head != unsent.tail; }

void uartSend() {
    if (uartHasUnsent()) UCSR0B |= _BV(UDRIE0); // no interrupt writes it while it is off
}
