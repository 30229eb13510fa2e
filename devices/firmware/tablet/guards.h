#pragma once

// What watches over the sketch itself.

void guardsBegin();
/// The main loop and the pulses' timer both live: called once a frame.
void guardsFrame();
/// The sketch was started anew because it hung.
bool restartedAfterHang();
/// Sleeps until the next interrupt unless there is something to do.
void sleepUntilNeeded();
