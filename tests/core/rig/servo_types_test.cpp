#include "core/rig/servo_types.h"

#include <numbers>

#include <gtest/gtest.h>

#include "core/base/error.h"

namespace lumorph {
namespace {

TEST(ServoTypes, AreFoundByNameInAnyCase) {
    EXPECT_EQ(servoType("sg90").name, "SG90");
    EXPECT_EQ(servoType("hs-422").name, "HS-422");
    EXPECT_THROW((void)servoType("AX-12"), InvalidInput);
    EXPECT_EQ(findServo("mg996r"), &servoType("MG996R"));
    EXPECT_EQ(findServo("AX-12"), nullptr);
}

TEST(ServoTypes, AreInSiUnits) {
    // 1.8 kgf cm = 1.8 * 9.80665 N * 0.01 m; 60 degrees in 0.1 s.
    EXPECT_NEAR(servoType("SG90").stallTorque, 0.17652, 1e-5);
    EXPECT_NEAR(servoType("SG90").speed, std::numbers::pi / 0.3, 1e-9);
    for (const ServoType& type : servoTypes()) {
        EXPECT_GT(type.price, 0.0) << type.name;
        EXPECT_GT(type.mass, 0.005) << type.name;
        EXPECT_LT(type.mass, 0.1) << type.name;
        EXPECT_LT(type.pulseMin, 1000.0) << type.name;
        EXPECT_GT(type.pulseMax, 2000.0) << type.name;
        EXPECT_GT(type.size.x, type.size.y) << type.name;
    }
}

TEST(ServoTypes, CheapestIsStrongEnough) {
    EXPECT_EQ(cheapestServo(0.01)->name, "SG90");
    EXPECT_EQ(cheapestServo(0.3)->name, "MG996R"); // cheaper than the HS-422, and stronger
    EXPECT_EQ(cheapestServo(0.8)->name, "DS3218");
    EXPECT_EQ(cheapestServo(5.0), nullptr);
}

} // namespace
} // namespace lumorph
