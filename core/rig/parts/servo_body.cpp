#include "core/rig/parts/servo_body.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>

#include "core/base/error.h"
#include "core/base/text.h"

namespace lumorph {
namespace {

// The figures that are commonly published for these servos, of drawings and of models made after them. Cases differ by
// some tenths from maker to maker; these are the larger measures.
constexpr std::array kBodies{
    ServoBody{"SG90",
              "as commonly published for the SG90: case 22.2 to 22.8 x 11.8 to 12.2 x 22.7, tabs 32.2 x 2.5 at 15.9, "
              "31 overall; single-arm horn of 17.2 x 7 to 4",
              22.8, 12.2, 22.7, 5.9, 4.0, 32.2, 15.9, 2.5, 31.5, 7.0, 4.0, 13.7, 0.09},
    ServoBody{"MG996R",
              "as commonly published for the MG996R: case 40.7 x 19.7 x 36.6, tabs 54.5 x 2.5 at 26.6, 42.9 overall; "
              "single-arm horn of 32.5 x 13 to 6",
              40.7, 19.7, 36.6, 10.0, 4.0, 54.5, 26.6, 2.5, 45.7, 13.0, 6.0, 23.0, 0.09}};

std::string lower(std::string_view text) {
    std::string result(text);
    std::ranges::transform(result, result.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return result;
}

} // namespace

std::span<const ServoBody> servoBodies() { return kBodies; }

const ServoBody& servoBody(std::string_view name) {
    std::string names;
    for (const ServoBody& body : kBodies) {
        if (lower(body.name) == lower(name)) return body;
        names += (names.empty() ? "" : ", ") + std::string(body.name);
    }
    throw InvalidInput("servo " + inQuotes(name), "there is no drawing of it", "choose one of " + names);
}

} // namespace lumorph
