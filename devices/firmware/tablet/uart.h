#pragma once

#include <stdint.h>

// The serial line. Of our own, since the core's interrupts are too long for the pulses' edges.

void uartBegin();
/// The next byte that came; -1: none.
int16_t uartRead();
/// Bytes came in faster than they were read, and some were dropped; true once.
bool uartLostBytes();
bool uartHasBytes();
/// Bytes that can be written now.
uint8_t uartRoom();
/// Only as many as there is room for.
void uartWrite(uint8_t byte);
bool uartHasUnsent();
/// Starts sending what was written.
void uartSend();
