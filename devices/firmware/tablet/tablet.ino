// LumorphTablet: up to twelve servos on an Arduino Pro Mini (ATmega328P, 5 V/16 MHz or 3.3 V/8 MHz), spoken to in
// Firmata 2.5. A servo gets its pulse before it is switched on, so that it does not jump; when the studio falls silent,
// all servos are let go. Pins, limits, baud rate and the battery's divider stand in channels.h. Without a computer it
// shows the poses of poses.h.

#include "battery.h"
#include "firmata.h"
#include "guards.h"
#include "pulses.h"
#include "sequence.h"
#include "uart.h"

void setup() {
    TIMSK0 = 0; // the core's millis() is not used, and its interrupt would stand in the way of an edge
    uartBegin();
    batteryBegin();
    pulsesBegin();
    guardsBegin();
    firmataBegin();
    sequenceBegin();
}

void loop() {
    firmataRead();
    if (pulsesFrameIsDue()) {
        firmataFrame();
        sequenceFrame();
        batteryFrame();
        pulsesPlan();
        guardsFrame();
    }
    uartSend();
    sleepUntilNeeded();
}
