#pragma once

// Firmata 2.5 as far as servos need it, and battery voltage: F0 02 F7 is answered by F0 02 b0 b1 b2 F7, millivolts in
// groups of seven bits, least first. F0 03 pin s0 s1 F7 says by how many microseconds its pulse may differ from one
// frame to the next, 0: by any. A value of 500 or more is microseconds, up to 180 it is degrees; what lies between is a
// mistake and moves nothing.

/// Tells version and name unasked, as after each start.
void firmataBegin();
/// Takes what came in. Messages that are broken off or too long change nothing.
void firmataRead();
/// Once a frame: lets all servos go after half a second without any byte.
void firmataFrame();
/// No byte has come for that long.
bool firmataIsSilent();
