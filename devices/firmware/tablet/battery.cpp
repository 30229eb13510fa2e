#include "battery.h"

#include <avr/io.h>

#include "channels.h"

namespace {

// Measurements are told as a mean of 16: 0.3 s, longer than a servo's start pulls the voltage down.
constexpr uint8_t kMeasurements = 16;
constexpr uint8_t kSettling = 5; // frames until the reference stands after its capacitor was charged
uint16_t sum;
uint16_t lastSum;
uint8_t count;
uint8_t settled;

} // namespace

void batteryBegin() {
    ADMUX = _BV(REFS1) | _BV(REFS0); // internal 1.1 V, channel A0
    ADCSRA = _BV(ADEN) | _BV(ADSC) | _BV(ADPS2) | _BV(ADPS1) | (F_CPU > 8000000UL ? _BV(ADPS0) : 0); // 125 kHz
}

void batteryFrame() {
    if (ADCSRA & _BV(ADSC)) return;
    const uint16_t value = ADC;
    if (settled < kSettling) {
        ++settled;
        lastSum = value * kMeasurements;
    } else {
        sum += value;
        if (++count == kMeasurements) {
            lastSum = sum;
            sum = 0;
            count = 0;
        }
    }
    ADCSRA |= _BV(ADSC);
}

uint32_t batteryMillivolts() {
    // In steps that neither overflow nor lose; the converter rounds down, so half a step is added.
    const uint32_t pin = (uint32_t(lastSum) + kMeasurements / 2) * kReferenceMillivolts / 1024; // mV / 16
    constexpr uint32_t kRatio = (kBatteryTopOhms + kBatteryBottomOhms) * 64 / kBatteryBottomOhms;
    static_assert(kBatteryTopOhms / kBatteryBottomOhms < 100 && kBatteryTopOhms < 10000000, "a divider within reason");
    return (pin * kRatio + 512) / 1024;
}
