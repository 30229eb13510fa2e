#include "battery.h"

#include <avr/io.h>

#include "channels.h"

namespace {

// A sliding mean over 16 measurements, in sixteenths: 0.3 s, longer than a servo's start pulls the voltage down.
uint16_t sum;
uint8_t frames;
constexpr uint8_t kSettling = 5; // frames until the reference stands after its capacitor was charged

} // namespace

void batteryBegin() {
    ADMUX = _BV(REFS1) | _BV(REFS0); // internal 1.1 V, channel A0
    ADCSRA = _BV(ADEN) | _BV(ADSC) | _BV(ADPS2) | _BV(ADPS1) | (F_CPU > 8000000UL ? _BV(ADPS0) : 0); // 125 kHz
}

void batteryFrame() {
    if (ADCSRA & _BV(ADSC)) return;
    const uint16_t value = ADC;
    if (frames <= kSettling) {
        ++frames;
        sum = value * 16;
    } else {
        sum += value - (sum + 8) / 16;
    }
    ADCSRA |= _BV(ADSC);
}

uint32_t batteryMillivolts() {
    // In steps that neither overflow nor lose: the divider's ratio in thousandths.
    const uint32_t pin = uint32_t(sum) * kReferenceMillivolts / 1024; // sixteenths of a millivolt
    constexpr uint32_t kRatio = (kBatteryTopOhms + kBatteryBottomOhms) * 64 / kBatteryBottomOhms;
    return (pin * kRatio + 512) / 1024;
}
