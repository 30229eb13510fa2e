#pragma once

#include <stdint.h>

// The battery's voltage on A0, through a divider. Measured against the chip's own 1.1 V, which does not sink when the
// battery does, as the supply would; it differs by up to 10 % from chip to chip, for which channels.h has a value.

void batteryBegin();
/// One measurement a frame.
void batteryFrame();
uint32_t batteryMillivolts();
