// Writes the header of the twelve servos that the sketch is also tested with.

#include <fstream>

#include "devices/firmware/pin_header.h"
#include "tests/firmware/twelve.h"

int main(int count, char** arguments) {
    if (count != 2) return 2;
    std::ofstream file(arguments[1]);
    file << lumorph::channelsHeader(lumorph::firmware_test::twelveServos());
    return file.flush() ? 0 : 1;
}
