#include "calibration/registration/pose_file.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <vector>

#include <gtest/gtest.h>

// Tables of poses as other programs write them: the numbers that come out, or the line that is wrong.

namespace lumorph {
namespace {

constexpr glm::dvec3 kPlace(0.36, -1.25, 2.5);
const glm::dquat kTurn(0.8, 0.2, -0.4, 0.4); // w first

void expectPose(const TimedPose& found, double seconds, const std::string& what) {
    EXPECT_NEAR(found.seconds, seconds, 1e-6) << what;
    EXPECT_LT(glm::distance(found.pose.position, kPlace), 1e-9) << what;
    EXPECT_LT(angleOf(glm::conjugate(found.pose.rotation) * kTurn), 1e-7) << what;
}

TEST(PoseFile, FormatsOfOtherProgramsGiveTheSamePoses) {
    const struct {
        const char* what;
        const char* text;
        double first = 12.5, second = 12.52;
        std::size_t warnings = 0;
    } rows[] = {
        {"commas", "12.5,0.36,-1.25,2.5,0.2,-0.4,0.4,0.8\n12.52,0.36,-1.25,2.5,0.2,-0.4,0.4,0.8\n"},
        {"a byte order mark", "\xEF\xBB\xBF"
                              "12.5,0.36,-1.25,2.5,0.2,-0.4,0.4,0.8\n12.52,0.36,-1.25,2.5,0.2,-0.4,0.4,0.8"},
        {"a head row",
         "time,x,y,z,qx,qy,qz,qw\n12.5,0.36,-1.25,2.5,0.2,-0.4,0.4,0.8\n12.52,0.36,-1.25,2.5,0.2,-0.4,0.4,0.8\n"},
        {"a mark and a head row, ends of Windows", "\xEF\xBB\xBFtime,x,y,z,qx,qy,qz,qw\r\n12.5,0.36,-1.25,2.5,0.2,-0.4,"
                                                   "0.4,0.8\r\n12.52,0.36,-1.25,2.5,0.2,-0.4,0.4,0.8\r\n"},
        {"ends of an old Macintosh", "12.5,0.36,-1.25,2.5,0.2,-0.4,0.4,0.8\r12.52,0.36,-1.25,2.5,0.2,-0.4,0.4,0.8\r"},
        {"names without meaning",
         "c1,c2,c3,c4,c5,c6,c7,c8\n12.5,0.36,-1.25,2.5,0.2,-0.4,0.4,0.8\n12.52,0.36,-1.25,2.5,0.2,-0.4,0.4,0.8\n"},
        {"w first by name",
         "time,x,y,z,qw,qx,qy,qz\n12.5,0.36,-1.25,2.5,0.8,0.2,-0.4,0.4\n12.52,0.36,-1.25,2.5,0.8,0.2,-0.4,0.4\n"},
        {"TUM", "# timestamp tx ty tz qx qy qz qw\n12.5 0.36 -1.25 2.5 0.2 -0.4 0.4 0.8\n12.52  0.36 -1.25 2.5 0.2 "
                "-0.4 0.4 0.8 \n"},
        {"tabs", "12.5\t0.36\t-1.25\t2.5\t0.2\t-0.4\t0.4\t0.8\n12.52\t0.36\t-1.25\t2.5\t0.2\t-0.4\t0.4\t0.8\n"},
        {"semicolons", "12.5;0.36;-1.25;2.5;0.2;-0.4;0.4;0.8\n12.52; 0.36; -1.25; 2.5; 0.2; -0.4; 0.4; 0.8;\n"},
        {"decimal commas",
         "Zeit;x;y;z;qx;qy;qz;qw\n12,5;0,36;-1,25;2,5;0,2;-0,4;0,4;0,8\n12,52;0,36;-1,25;2,5;0,2;-0,4;0,4;0,8\n"},
        {"tabs and decimal commas",
         "12,5\t0,36\t-1,25\t2,5\t0,2\t-0,4\t0,4\t0,8\n12,52\t0,36\t-1,25\t2,5\t0,2\t-0,4\t0,4\t0,8\n"},
        {"commas and blanks", "12.5, 0.36 -1.25 2.5, 0.2 -0.4 0.4 0.8\n12.52 , 0.36 -1.25 2.5 , 0.2 -0.4 0.4 0.8\n"},
        {"a body's name with blanks", "time,body,x,y,z,qx,qy,qz,qw\n12.5,Rigid Body 1,0.36,-1.25,2.5,0.2,-0.4,0.4,0.8\n"
                                      "12.52,Rigid Body 1,0.36,-1.25,2.5,0.2,-0.4,0.4,0.8\n"},
        {"quotes and signs", "\"12.5\",\"+0.36\",\"-1.25\",\"2.5\",\"0.2\",\"-0.4\",\"0.4\",\"0.8\"\n12.52,0.36,-1.25,+"
                             "2.5,0.2,-0.4,0.4,0.8\n"},
        {"units by name",
         "time_ms,x [mm],y [mm],z "
         "[mm],qx,qy,qz,qw\n12500,360,-1250,2500,0.2,-0.4,0.4,0.8\n12520,360,-1250,2500,0.2,-0.4,0.4,0.8\n"},
        {"EuRoC",
         "#timestamp [ns], p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z [], "
         "v_RS_R_x [m s^-1], b_w_RS_S_x [rad s^-1]\n"
         "1403636580838555648,0.36,-1.25,2.5,0.8,0.2,-0.4,0.4,-0.03,0.1\n1403636580858555648,0.36,-1.25,2.5,0.8,0.2,-0."
         "4,0.4,-0.03,0.1\n",
         1403636580.838555648, 1403636580.858555648},
        {"rostopic",
         "%time,field.header.seq,field.header.stamp,field.header.frame_id,field.pose.position.x,field.pose.position.y,"
         "field.pose.position.z,field.pose.orientation.x,field.pose.orientation.y,field.pose.orientation.z,field.pose."
         "orientation.w\n"
         "1403636580838555648,7,1403636580838555600,map,0.36,-1.25,2.5,0.2,-0.4,0.4,0.8\n1403636580858555648,8,"
         "1403636580858555600,map,0.36,-1.25,2.5,0.2,-0.4,0.4,0.8\n",
         1403636580.838555648, 1403636580.858555648, 1},
        {"microseconds since 1970",
         "1403636580838555,0.36,-1.25,2.5,0.2,-0.4,0.4,0.8\n1403636580858555,0.36,-1.25,2.5,0.2,-0.4,0.4,0.8\n",
         1403636580.838555, 1403636580.858555, 1},
        {"frames beside times", "Frame,Time "
                                "(Seconds),x,y,z,qx,qy,qz,qw\n1,12.5,0.36,-1.25,2.5,0.2,-0.4,0.4,0.8\n2,12.52,0.36,-1."
                                "25,2.5,0.2,-0.4,0.4,0.8\n"},
    };
    for (const auto& row : rows) {
        const PoseTrack track = parsePoseTrack(row.text, "poses.csv");
        ASSERT_EQ(track.poses.size(), 2U) << row.what;
        expectPose(track.poses[0], row.first, row.what);
        expectPose(track.poses[1], row.second, row.what);
        EXPECT_EQ(track.warnings.size(), row.warnings) << row.what;
        for (const Finding& warning : track.warnings) EXPECT_EQ(keyOf(warning.cause), "time_unit") << row.what;
    }
}

std::string messageOf(const std::string& text) {
    try {
        (void)parsePoseTrack(text, "poses.csv");
    } catch (const DataError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(PoseFile, WhatIsNoTableOfPosesIsSaidByLine) {
    const std::string good = "0,0,0,0,0,0,0,1\n0.02,0,0,0,0,0,0,1\n";
    EXPECT_NE(messageOf(good + "0.04,0,0,0,0,0,1\n").find("line 3: it has no time"), std::string::npos);
    EXPECT_NE(messageOf(good + "time,x,y,z,qx,qy,qz,qw\n").find("line 3"), std::string::npos) << "a head at the end";
    EXPECT_NE(messageOf("0,0,,0,0,0,0,1\n" + good).find("line 1"), std::string::npos) << "an empty field";
    EXPECT_NE(messageOf("time,x\n" + good).find("line 1"), std::string::npos);
    EXPECT_NE(messageOf(std::string("\xFF\xFE") + "0\0,\0" + good).find("UTF-16"), std::string::npos);
    EXPECT_NE(messageOf("time,x,y,z,qw,qx,qy,qz\n0,0,0,0,1,0,0\n").find("line 2"), std::string::npos);
}

/// A body that moves by 0.5 m/s, a row each 10 ms; rows in this order.
std::string rowsOf(const std::vector<std::pair<double, double>>& timesAndPlaces) {
    std::string text;
    for (const auto& [time, place] : timesAndPlaces) {
        std::array<char, 100> line{};
        std::snprintf(line.data(), line.size(), "%.4f,%.5f,1,0,0,0,0,1\n", time, 0.5 * place);
        text += line.data();
    }
    return text;
}

TEST(PoseFile, RowsThatComeLateAreSortedAndSaid) {
    std::vector<std::pair<double, double>> rows;
    for (int i = 0; i < 200; ++i) rows.emplace_back(0.01 * i, 0.01 * i);
    for (std::size_t i = 10; i + 3 < rows.size(); i += 10)
        std::rotate(rows.begin() + std::ptrdiff_t(i), rows.begin() + std::ptrdiff_t(i) + 1,
                    rows.begin() + std::ptrdiff_t(i) + 4);
    const PoseTrack track = parsePoseTrack(rowsOf(rows), "poses.csv");
    ASSERT_EQ(track.poses.size(), 200U);
    for (std::size_t i = 0; i < 200; ++i) {
        EXPECT_NEAR(track.poses[i].seconds, 0.01 * double(i), 1e-9);
        EXPECT_NEAR(track.poses[i].pose.position.x, 0.005 * double(i), 1e-9);
    }
    ASSERT_EQ(track.warnings.size(), 1U);
    EXPECT_EQ(keyOf(track.warnings[0].cause), "rows_out_of_order");
    EXPECT_EQ(track.warnings[0].why, "19 rows stand behind later ones, by up to 30 ms, first poses.csv, line 14");
}

TEST(PoseFile, TwoRecordingsOfOneMotionAppendedAreMerged) {
    std::vector<std::pair<double, double>> rows;
    for (int i = 0; i < 200; i += 2) rows.emplace_back(0.01 * i, 0.01 * i);
    for (int i = 1; i < 200; i += 2) rows.emplace_back(0.01 * i, 0.01 * i);
    const PoseTrack track = parsePoseTrack(rowsOf(rows), "poses.csv");
    ASSERT_EQ(track.poses.size(), 200U);
    EXPECT_NEAR(track.poses[101].pose.position.x, 0.505, 1e-9);
    ASSERT_EQ(track.warnings.size(), 1U);
    EXPECT_EQ(keyOf(track.warnings[0].cause), "rows_out_of_order");
}

TEST(PoseFile, AClockThatWasSetBackIsRefused) {
    std::vector<std::pair<double, double>> rows;
    for (int i = 0; i < 200; ++i) rows.emplace_back(0.01 * i - (i < 100 ? 0.0 : 0.15), 0.01 * i);
    EXPECT_NE(messageOf(rowsOf(rows)).find("line 101: its clock goes back by 0.14 s"), std::string::npos)
        << messageOf(rowsOf(rows));
    for (auto& [time, place] : rows) place = 0.0; // at rest nothing tells, and a long way back is a clock
    for (std::size_t i = 100; i < 200; ++i) rows[i].first -= 0.3;
    EXPECT_NE(messageOf(rowsOf(rows)).find("line 101"), std::string::npos);
}

TEST(PoseFile, StationsNeedNoTime) {
    const std::vector<Station> bare =
        parseStations("x y z qx qy qz qw\n0.36 -1.25 2.5 0.2 -0.4 0.4 0.8\n0 0 0 0 0 0 1\n", "a.csv");
    ASSERT_EQ(bare.size(), 2U);
    EXPECT_EQ(bare[1].name, "2");
    expectPose({0.0, bare[0].pose}, 0.0, "bare");
    const std::vector<Station> named =
        parseStations("left front,0.36,-1.25,2.5,0.2,-0.4,0.4,0.8\nright,0,0,0,0,0,0,1\n", "a");
    EXPECT_EQ(named[0].name, "left front");
    expectPose({0.0, named[0].pose}, 0.0, "named");
    EXPECT_THROW((void)parseStations("a,0,0,0,0,0,0,1\na,0,0,0,0,0,0,1\n", "a"), DataError);
    EXPECT_THROW((void)parseStations("0,0,0,0,0,1\n", "a"), DataError);
    EXPECT_THROW((void)parseStations("0,0,0,0,0,0,2\n", "a"), DataError);
}

TEST(PoseFile, PointsMayHaveTabsAndSemicolons) {
    for (const char* text : {"a,1,2,3\nb,4,5,6\n", "a\t1\t2\t3\nb\t4\t5\t6\n", "a;1,0;2,0;3,0\nb;4;5;6\n"}) {
        const std::vector<NamedPoint> points = parseNamedPoints(text, "model.csv");
        ASSERT_EQ(points.size(), 2U) << text;
        EXPECT_EQ(points[0].name, "a");
        EXPECT_EQ(points[0].place, glm::dvec3(1, 2, 3)) << text;
    }
}

} // namespace
} // namespace lumorph
