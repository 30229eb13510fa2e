#pragma once

// The poses of poses.h one after the other, without a computer: from a button's press on (a second press while they
// play lets the servos go), or from power on, when three seconds pass without a byte. Servos that are off start one
// after the other, from where they were last or from the first row. Whatever comes in from a computer ends it at once:
// all servos are let go, as that computer expects to find them.

void sequenceBegin();
/// Once a frame, before it is laid out.
void sequenceFrame();
/// Servos are on because of it.
bool sequencePlays();
/// A byte has come in.
void sequenceTakenOver();
